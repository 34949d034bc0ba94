;;;; Running the suites.  RUN-ALL-TESTS is what ASDF:TEST-SYSTEM calls: it signals TESTS-FAILED if
;;;; a check fails.  REPORT-ALL-TESTS prints the counts in its last line.

(in-package #:discrepancy-finder.tests)

(def-suite all :description "All tests.")

(defvar *long* nil
  "True if the tests that take long are to be run, too.")

(defvar *browser* nil
  "True if the tests that look at reports in a browser are to be run, too.")

(define-condition tests-failed (error)
  ((passed :initarg :passed :reader tests-failed-passed)
   (failed :initarg :failed :reader tests-failed-failed))
  (:report (lambda (condition stream)
             (format stream "~d check~:p passed, ~d failed."
                     (tests-failed-passed condition) (tests-failed-failed condition))))
  (:documentation "Signaled when a check of a test fails."))

(defun run-and-count (suite stream)
  "Run SUITE, explain failures on STREAM, and return how many checks passed and how many failed.
A suite without any check counts as one failure."
  (let* ((*print-length* 20) (*print-level* 6)
         (results (let ((*test-dribble* stream)) (run suite)))
         (failed (count-if (lambda (result) (typep result 'fiveam::test-failure)) results))
         (passed (count-if (lambda (result) (typep result 'fiveam::test-passed)) results)))
    (when (plusp failed)
      (let ((*test-dribble* stream)) (explain! results)))
    (values passed (if (null results) 1 failed))))

(defun run-all-tests (&key (suite 'all) (stream *standard-output*))
  "Run SUITE and return the number of checks that passed.  Signals TESTS-FAILED if one failed."
  (multiple-value-bind (passed failed) (run-and-count suite stream)
    (if (zerop failed)
        passed
        (error 'tests-failed :passed passed :failed failed))))

(defun report-all-tests (&key long browser)
  "Run all suites, with the long tests if LONG is true, with those in a browser if BROWSER is, and
print the counts.  Return true if no check failed."
  (let ((*long* (and long t))
        (*browser* (and browser t)))
    (multiple-value-bind (passed failed) (run-and-count 'all *standard-output*)
      (format t "~&~d passed, ~d failed~%" passed failed)
      (zerop failed))))

(def-suite running :in all)
(in-suite running)

(def-suite deliberately-failing
  :description "Not below ALL: the test below shows that its failure is not overlooked.")

(test (two-and-two-is-five :suite deliberately-failing)
  (is (= 5 (+ 2 2))))

(test a-failing-check-is-an-error
  (signals tests-failed
    (run-all-tests :suite 'deliberately-failing :stream (make-broadcast-stream)))
  (is (= 0 (run-and-count 'deliberately-failing (make-broadcast-stream)))))
