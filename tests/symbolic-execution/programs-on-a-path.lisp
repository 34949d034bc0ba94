;;;; The programs once more, this time during a symbolic run.
;;;;
;;;; Nothing in them is symbolic, but something could be: the versions of functions that understand
;;;; symbolic values, note what they change, and run a plan's methods must do what the functions do.
;;;; Forms that are no Lisp are left out: on a path they end the exploration.

(in-package #:discrepancy-finder.tests)

(def-suite programs-on-a-path :in all)
(in-suite programs-on-a-path)

(defun understood-programs ()
  "Return the programs of all topics, and some random ones, that are not malformed."
  (remove-if (lambda (program)
               (equal '(:signals program-error)
                      (program-result (lambda () (symbolic:evaluate program)))))
             (append (loop for (nil . programs) in *program-topics* append programs)
                     (loop for seed from 1 to 100 collect (some-program seed)))))

(defvar *programs-to-run* '()
  "What RUN-PROGRAMS runs.")

(defvar *mismatches* '()
  "What RUN-PROGRAMS has found.")

(defun run-programs ()
  "Run the programs on the path on which this is called."
  (assert (symbolic::symbolic-run-p))
  (setf *mismatches* (loop for program in *programs-to-run*
                           for mismatch = (program-mismatch program)
                           when mismatch collect mismatch))
  nil)

(test programs-do-the-same-on-a-path
  (setf *programs-to-run* (understood-programs)
        *mismatches* :not-run)
  (is (< 900 (length *programs-to-run*)))
  (explore-text "
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::run-programs)
  (if ?flag 1 2))"
                :constraint 'anything :arguments '((discrepancy-finder-user::?flag boolean)))
  (is (null *mismatches*) "~{~a~%~}" *mismatches*))
