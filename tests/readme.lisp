;;;; The README shows real output.

(in-package #:discrepancy-finder.tests)

(def-suite readme :in all)
(in-suite readme)

(defun readme-block (beginning)
  "Return the lines of the README's code block that has a line which begins with BEGINNING."
  (let ((block '()) (inside nil))
    (dolist (line (uiop:read-file-lines (root-file "README.md")))
      (cond ((not (uiop:string-prefix-p "```" line)) (when inside (push line block)))
            ((not inside) (setf inside t block '()))
            ((find beginning block :test #'uiop:string-prefix-p) (return (nreverse block)))
            (t (setf inside nil))))))

(test the-readme-shows-the-demo
  (let ((shown (format nil "~{~a~%~}" (readme-block "--- an arm"))))
    (is (string= (string-right-trim '(#\Newline) (golden-text "demo"))
                 (string-right-trim '(#\Newline)
                                    (replace-all (without-times shown)
                                                 "./discrepancy-finder" "discrepancy-finder"))))))

(defun replace-all (text old new)
  (with-output-to-string (stream)
    (loop for start = 0 then (+ position (length old))
          for position = (search old text :start2 start)
          do (write-string text stream :start start :end position)
          while position
          do (write-string new stream))))

(defun transcript-entries (lines)
  "Return the list of (form-text expected-output) of the REPL transcript LINES, whose prompt is *."
  (let ((entries '()))
    (dolist (line lines (nreverse entries))
      (cond ((uiop:string-prefix-p "* " line) (push (list (subseq line 2) "") entries))
            ((uiop:string-prefix-p " " line)
             (setf (first (first entries)) (format nil "~a ~a" (first (first entries)) line)))
            (t (setf (second (first entries))
                     (format nil "~@[~a~%~]~a"
                             (let ((before (second (first entries))))
                               (and (string/= before "") before))
                             line)))))))

(test the-readme-shows-the-repl
  (let ((entries (transcript-entries (readme-block "* (asdf:load-system")))
        (* nil))
    (is (= 9 (length entries)))
    (let ((*package* (find-package '#:discrepancy-finder-user)))
      (loop for (text expected) in (cddr entries)
            do (let ((values (multiple-value-list
                              (eval (let ((*read-default-float-format* 'single-float))
                                      (read-from-string text)))))
                     (*print-right-margin* 1000))
                 (setf * (first values))
                 (is (string= expected (format nil "~{~s~^~%~}" values))
                     "~a~%shows ~{~s~%~}README ~a" text values expected))))))
