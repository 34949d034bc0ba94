;;;; Searches that are resumed.

(in-package #:discrepancy-finder.tests)

(def-suite journal :in all)
(in-suite journal)

(defun outline (result)
  "Return what RESULT found, without how long it took."
  (list (discrepancy:result-status result) (discrepancy:result-reason result)
        (discrepancy:result-simulations result)
        (mapcar #'discrepancy:phase-simulations (discrepancy:result-phases result))
        (loop for trace in (discrepancy:result-traces result)
              collect (list (discrepancy:trace-result-status trace)
                            (discrepancy:trace-result-reason trace)
                            (discrepancy:trace-result-blind trace)
                            (discrepancy:trace-result-targeted trace)
                            (discrepancy:trace-result-rejected trace)
                            (loop for (run . judgement) in (discrepancy:trace-result-runs trace)
                                  collect (list (discrepancy:run-hash run)
                                                (discrepancy:run-final-state run)
                                                (map 'list #'princ-to-string
                                                     (discrepancy:run-steps run))
                                                (discrepancy:judgement-verdict judgement)))))
        (loop for discrepancy in (discrepancy:result-discrepancies result)
              collect (list (discrepancy:discrepancy-text discrepancy)
                            (discrepancy:discrepancy-occurrences discrepancy)
                            (discrepancy:discrepancy-kind discrepancy)))))

(defun executions (function)
  "Return the values of FUNCTION and the number of the samples that it has executed."
  (let ((count 0))
    (sb-int:encapsulate 'discrepancy:execute-sample 'counting
                        (lambda (function &rest arguments)
                          (incf count)
                          (apply function arguments)))
    (unwind-protect (values (funcall function) count)
      (sb-int:unencapsulate 'discrepancy:execute-sample 'counting))))

(defmacro with-journal-file ((file) &body body)
  `(with-folder (folder)
     (let ((,file (format nil "~asearch.jsonl" folder)))
       ,@body)))

(test a-resumed-search-ends-as-an-uninterrupted-one
  (loop for (reach . options) in '((0.8d0 :rule :sound :targets t)
                                   (0.8d0 :rule :sound :sampler :stratified)
                                   (0.5d0 :rule :sound :keep-going t :targets t))
        do (flet ((find-with (&rest more)
                    (apply #'find-in-example reach (append more options '(:budget 150)))))
             (let ((whole (find-with)))
               (with-journal-file (file)
                 (multiple-value-bind (part first)
                     (executions (lambda () (find-with :budget 30 :resume file)))
                   (is (= 30 (- (discrepancy:result-simulations part)
                                (discrepancy:phase-simulations (phase-of-result part :confirm)))))
                   (multiple-value-bind (resumed second)
                       (executions (lambda () (find-with :resume file)))
                     (is (equal (outline whole) (outline resumed)))
                     (let ((confirmed (discrepancy:phase-simulations
                                       (phase-of-result whole :confirm)))
                           (all (nth-value 1 (executions #'find-with))))
                       (is (= (+ all confirmed) (+ first second))
                           "no sample is executed twice, but to confirm a discrepancy"))))
                 (multiple-value-bind (again count)
                     (executions (lambda () (find-with :resume file)))
                   (is (equal (outline whole) (outline again)))
                   (is (= count (length (discrepancy:result-discrepancies whole))))))))))

(test what-is-found-by-a-resumed-search-is-explained
  ;; Edits are checked against runs whose designators are texts, and forbid what some of them did.
  (with-journal-file (file)
    (flet ((explained ()
             (discrepancy:explanation-text
              (discrepancy:discrepancy-explanation
               (df:result-discrepancy
                (find-in-example 0.5 :seed 3 :explain t :resume file))))))
      (is (string= (explained) (explained))))))

(test a-journal-is-of-one-search
  (with-journal-file (file)
    (find-in-example 0.8 :resume file)
    (signals-with (discrepancy:journal-error file "another search" "seed")
      (find-in-example 0.8 :resume file :seed 2))
    (signals-with (discrepancy:journal-error file "another search" "parameters")
      (find-in-example 0.5 :resume file))
    (is (eq :certified (discrepancy:result-status (find-in-example 0.8 :resume file :budget 7)))
        "budgets may differ")
    (is (every (lambda (hash) (= 16 (length hash) (count-if (lambda (c) (digit-char-p c 16)) hash)))
               (json:get-key (json:parse (first (uiop:read-file-lines file))) "files"))
        "where the files lie does not matter"))
  (with-file (file (format nil "{}~%") "jsonl")
    (signals-with (discrepancy:journal-error file "no journal")
      (find-in-example 0.8 :resume file)))
  (with-file (file (format nil "#.(print 1)~%") "jsonl")
    (signals-with (discrepancy:journal-error file "no journal")
      (find-in-example 0.8 :resume file)))
  (signals-with (discrepancy:journal-error "/no/such/folder" "cannot be written")
    (find-in-example 0.8 :resume "/no/such/folder/j.jsonl")))

(test a-run-depends-on-the-files-that-a-plan-loads
  (with-folder (folder)
    (flet ((file (name text)
             (with-open-file (stream (format nil "~a~a" folder name) :direction :output)
               (format stream "(in-package #:discrepancy-finder-user)~%~a" text))
             (format nil "~a~a" folder name)))
      (file "below.lisp" "(defun a-number-below () (a-number-above)) (defun a-number-above () 1)")
      (file "beside.lisp" "(def-cram-function not-mentioned () nil)")
      (file "middle.lisp" "(load-plan (merge-pathnames \"below.lisp\" *load-truename*))
                           (load-plan (merge-pathnames \"beside.lisp\" *load-truename*))
                           (def-cram-function middle-plan () (funcall #'a-number-below))")
      (let ((plan (first (last (plan:load-plan
                                (file "upper.lisp" "(load-plan (merge-pathnames \"middle.lisp\"
                                                                              *load-truename*))
                                                    (def-top-level-cram-function upper-plan ()
                                                      (middle-plan))"))))))
        (is (equal '("upper" "middle" "below" "domain")
                   (loop for name in (discrepancy::source-files plan (two-regions))
                         repeat 4 collect (pathname-name name))))))))

(test a-line-that-was-cut-off-is-run-again
  (with-journal-file (file)
    (let* ((whole (find-in-example 0.8 :resume file))
           (text (uiop:read-file-string file)))
      (with-open-file (stream file :direction :output :if-exists :supersede)
        (write-string (subseq text 0 (- (length text) 100)) stream))
      (multiple-value-bind (again count)
          (executions (lambda () (find-in-example 0.8 :resume file)))
        (is (equal (outline whole) (outline again)))
        (is (= 1 count)))
      (is (string= text (uiop:read-file-string file))))))

(test a-damaged-line-is-told
  (with-journal-file (file)
    (let ((whole (outline (find-in-example 0.8 :resume file)))
          (lines (uiop:read-file-lines file)))
      (flet ((refused (damaged)
               "Check what a search says whose third line is the text that DAMAGED makes of it."
               (with-open-file (stream file :direction :output :if-exists :supersede)
                 (format stream "~{~a~%~}"
                         (append (subseq lines 0 2) (list (funcall damaged (third lines)))
                                 (nthcdr 3 lines))))
               (signals-with (discrepancy:journal-error file "line 3 is no run of a search")
                 (find-in-example 0.8 :resume file)))
             (without (part line)
               (let ((start (search part line)))
                 (concatenate 'string (subseq line 0 start)
                              (subseq line (+ start (length part)))))))
        (refused (lambda (line) (subseq line 0 (- (length line) 9))))
        (refused (lambda (line) (without "\"hash\":" line)))
        (refused (lambda (line) (without "\"key\":" line)))
        (refused (lambda (line) (substitute #\x #\1 line :start (search "\"initial\":" line)))))
      (with-open-file (stream file :direction :output :if-exists :supersede)
        (format stream "~{~a~%~}" lines))
      (is (equal whole (outline (find-in-example 0.8 :resume file)))))))
