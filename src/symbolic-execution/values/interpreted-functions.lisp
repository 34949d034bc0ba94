;;;; Interpreted functions: real functions whose bodies the evaluator runs.
;;;;
;;;; An interpreted function can be called in two ways.  Its CODE, a compiled closure, takes and
;;;; returns symbolic values: so calls the evaluator, and so do the lifted functions.  The function
;;;; itself, which is what compiled code calls, returns nothing symbolic.

(in-package #:discrepancy-finder.symbolic-execution)

(defclass interpreted-function (sb-mop:funcallable-standard-object)
  ((name :initarg :name :initform nil :reader interpreted-function-name)
   (code :initarg :code :type function))
  (:metaclass sb-mop:funcallable-standard-class)
  (:documentation "A function whose body the evaluator runs; it may be given symbolic values."))

(defmethod print-object ((function interpreted-function) stream)
  (print-unreadable-object (function stream :type t :identity t)
    (princ (interpreted-function-name function) stream)))

(defun interpreted-function-code (function)
  "Return the compiled closure that takes and returns symbolic values for FUNCTION, interpreted."
  (the function (sb-mop:funcallable-standard-instance-access function 1)))

(defun make-interpreted-function (name function)
  "Return an interpreted function with the code FUNCTION."
  (let ((instance (make-instance 'interpreted-function :name name :code function)))
    (sb-mop:set-funcallable-instance-function
     instance
     (lambda (&rest arguments)
       (declare (dynamic-extent arguments) (function function))
       (if *path*
           (multiple-value-call #'decided-values (apply function arguments))
           (apply function arguments))))
    instance))

(defun decided-values (&rest values)
  "Return VALUES with nothing symbolic in them."
  (declare (dynamic-extent values))
  (if (symbolic-run-p)
      (values-list (loop for value in values
                         collect (decided value "what a function returns to compiled code")))
      (values-list values)))
