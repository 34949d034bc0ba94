;;;; The README shows real output.

(in-package #:discrepancy-finder.tests)

(def-suite readme :in all)
(in-suite readme)

(defun readme-block (beginning)
  (text-block "README.md" beginning))

(defun text-block (file beginning)
  "Return the lines of the code block in FILE that has a line which begins with BEGINNING."
  (let ((block '()) (inside nil))
    (dolist (line (uiop:read-file-lines (root-file file)))
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

(defun unfinished-p (text)
  "Return true if the form in TEXT goes on."
  (handler-case (let ((*package* (find-package '#:discrepancy-finder-user)))
                  (read-from-string text)
                  nil)
    (end-of-file () t)))

(defun transcript-entries (lines)
  "Return the list of (form-text expected-output) of the REPL transcript LINES, whose prompt is *."
  (let ((entries '()))
    (dolist (line lines (nreverse entries))
      (cond ((uiop:string-prefix-p "* " line) (push (list (subseq line 2) "") entries))
            ((and (uiop:string-prefix-p " " line) (unfinished-p (first (first entries))))
             (setf (first (first entries)) (format nil "~a ~a" (first (first entries)) line)))
            (t (setf (second (first entries))
                     (format nil "~@[~a~%~]~a"
                             (let ((before (second (first entries))))
                               (and (string/= before "") before))
                             line)))))))

(defun entry-output (text)
  "Return what the REPL shows for the form TEXT: what it prints, and its values."
  (let* ((values '())
         (printed (with-output-to-string (*standard-output*)
                    (let ((*print-right-margin* 1000))
                      (setf values (multiple-value-list
                                    (eval (let ((*read-default-float-format* 'single-float))
                                            (read-from-string text)))))))))
    (setf * (first values))
    (let ((*print-right-margin* 1000))
      (string-right-trim '(#\Newline) (format nil "~@[~a~%~]~{~s~^~%~}"
                                              (and (string/= printed "")
                                                   (string-trim '(#\Newline) printed))
                                              values)))))

(defun check-entries (entries)
  (let ((* nil) (*package* (find-package '#:discrepancy-finder-user)))
    (loop for (text expected) in entries
          do (let ((output (entry-output text)))
               (is (string= expected output) "~a~%shows ~a~%the text ~a" text output expected)))))

(test the-readme-shows-the-repl
  (let ((entries (transcript-entries (readme-block "* (asdf:load-system"))))
    (is (= 9 (length entries)))
    (check-entries (cddr entries))))

(test the-text-on-theories-shows-the-repl
  (let ((entries (transcript-entries (text-block "docs/theories.md" "* (define-theory yale"))))
    (is (= 6 (length entries)))
    (check-entries entries)))

(defun without-numbers (text)
  (remove-if (lambda (character) (find character "0123456789.-d")) text))

(test the-text-on-projection-shows-the-repl
  "Where exactly things end up is not this test's business."
  (let ((entries (transcript-entries (text-block "docs/projection.md" "* (load-scene")))
        (* nil)
        (*package* (find-package '#:discrepancy-finder-user))
        (*default-pathname-defaults* (asdf:system-source-directory "discrepancy-finder")))
    (is (= 4 (length entries)))
    (loop for (text expected) in entries
          do (is (string= (without-numbers expected) (without-numbers (entry-output text)))))))

(test the-text-on-symbolic-execution-shows-the-repl
  (let ((entries (transcript-entries (text-block "docs/symbolic-execution.md"
                                                 "* (define-theory tidy"))))
    (is (= 17 (length entries)))
    (check-entries entries)))

(test the-text-on-symbolic-execution-shows-a-coverage
  (let ((text (with-output-to-string (stream)
                (df:print-coverage
                 (df:coverage (df:explore-plan 'discrepancy-finder-user::find-object
                                               :domain :table-top :coverage t))
                 stream))))
    (dolist (line (text-block "docs/symbolic-execution.md" "Coverage of find-object"))
      (is (or (string= line "...") (search (format nil "~a~%" line) text))
          "~s is not in~%~a" line text))))
