;;;; Programs that the evaluator and SBCL's compiler must agree on.
;;;;
;;;; DEFINE-PROGRAMS collects forms by topic (programs-*.lisp).  Each is run by both; values, output
;;;; and the kind of the error, if there is one, must be the same.  What a program changes it also
;;;; returns.

(in-package #:discrepancy-finder.tests)

(defvar *program-topics* '()
  "A list of (topic . programs).")

(defmacro define-programs (topic &body programs)
  "Let PROGRAMS, forms, be run by the tests of the evaluator."
  `(setf *program-topics* (append (remove ',topic *program-topics* :key #'first)
                                  '((,topic ,@programs)))))

(defparameter *condition-kinds*
  '(sb-sys:interactive-interrupt division-by-zero arithmetic-error unbound-variable unbound-slot
    undefined-function cell-error control-error program-error type-error end-of-file stream-error
    file-error package-error parse-error print-not-readable storage-condition simple-error error
    warning condition)
  "Kinds of conditions, the special ones first.")

(defun condition-kind (condition)
  (find-if (lambda (kind) (typep condition kind)) *condition-kinds*))

(defun program-result (function)
  "Return the list of the values of FUNCTION and what it prints, or (:signals kind) and that."
  (let ((result nil))
    (let ((output (with-output-to-string (*standard-output*)
                    (let ((*random-state* (sb-ext:seed-random-state 1))
                          (*gensym-counter* 1)
                          (*error-output* (make-broadcast-stream))
                          (*package* (find-package '#:discrepancy-finder.tests)))
                      (setf result
                            (handler-case (handler-bind ((warning #'muffle-warning))
                                            (multiple-value-list (funcall function)))
                              (error (condition)
                                (list :signals (condition-kind condition)))))))))
      (values result output))))

(defun same-value-p (one other)
  "Return true if ONE and OTHER look the same; functions do, as do symbols without a package."
  (typecase one
    (cons (and (consp other)
               (same-value-p (car one) (car other)) (same-value-p (cdr one) (cdr other))))
    ((or string bit-vector pathname) (equal one other))
    (array (and (arrayp other) (equal (array-dimensions one) (array-dimensions other))
                (loop for index below (array-total-size one)
                      always (same-value-p (row-major-aref one index)
                                           (row-major-aref other index)))))
    (function (functionp other))
    (hash-table (and (hash-table-p other)
                     (same-value-p (alexandria:hash-table-alist one)
                                   (alexandria:hash-table-alist other))))
    (symbol (or (eq one other)
                (and (symbolp other) (null (symbol-package one)) (null (symbol-package other)))))
    ((or number character) (eql one other))
    (condition (eq (condition-kind one) (condition-kind other)))
    (t (eq (type-of one) (type-of other)))))

(defun program-mismatch (program)
  "Return NIL if the evaluator does with PROGRAM what SBCL does, else what either says."
  (multiple-value-bind (expected expected-output) (program-result (lambda () (eval program)))
    (multiple-value-bind (found output)
        (program-result (lambda () (symbolic:evaluate program)))
      (unless (and (same-value-p expected found) (string= expected-output output))
        (format nil "~s~%  is ~s ~s,~%  and the evaluator says ~s ~s" program
                expected expected-output found output)))))

(def-suite programs :in all)
(in-suite programs)

(test programs-do-what-they-do-compiled
  (loop for (topic . programs) in *program-topics*
        do (dolist (program programs)
             (let ((mismatch (program-mismatch program)))
               (is (null mismatch) "~(~a~): ~a" topic mismatch)))))

(test there-are-enough-programs
  (is (<= 400 (loop for (nil . programs) in *program-topics* sum (length programs)))))
