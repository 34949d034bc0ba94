;;;; Taking apart data that a user wrote.

(in-package #:discrepancy-finder.source)

(defmacro destructuring-or (lambda-list form otherwise &body body)
  "Bind the variables of LAMBDA-LIST to the parts of FORM's value and evaluate BODY; evaluate
OTHERWISE instead if the value does not fit LAMBDA-LIST.  Errors in BODY are not touched."
  `(funcall (handler-case (destructuring-bind ,lambda-list ,form (lambda () ,@body))
              (error () (lambda () ,otherwise)))))
