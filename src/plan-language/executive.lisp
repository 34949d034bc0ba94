;;;; The executive: who performs what a plan asks for.
;;;;
;;;; PERFORM hands a designator to the executive of the plan that runs.  An executive is any object
;;;; with a method on PERFORM-WITH: a projection world executes motions, a symbolic executive
;;;; consults a theory.  So one plan source serves both.

(in-package #:discrepancy-finder.plan-language)

(defvar *executive* nil
  "The executive of the running plan.  Plan code cannot pass it on, hence a variable.")

(defgeneric perform-with (executive designator position)
  (:documentation "Let EXECUTIVE perform the action or motion DESIGNATOR and return the result.
POSITION is the source position of the perform form, or NIL where unknown.  Signals a PLAN-FAILURE
if that fails, DESIGNATOR-NOT-UNDERSTOOD if EXECUTIVE cannot interpret DESIGNATOR.")
  (:method ((executive null) designator position)
    (declare (ignore position))
    (error 'no-executive :designator designator)))

(defun perform (designator &optional position)
  "Perform the action or motion DESIGNATOR and return the result.  POSITION, where in the source
this is, is filled in by the compiler for plans that were loaded with LOAD-PLAN.  Signals a
PLAN-FAILURE if that fails, NO-EXECUTIVE outside of any executive."
  (perform-with *executive* designator position))

(define-compiler-macro perform (&whole form designator &optional position)
  (let ((found (and (null position) (source:form-position form))))
    (if found
        `(perform ,designator ,found)
        form)))

(defun call-with-executive (executive function)
  "Call FUNCTION without arguments; what it performs is performed by EXECUTIVE."
  (let ((*executive* executive))
    (funcall function)))

(defun current-handlers ()
  "Return the condition handlers that are in force, for WITH-HANDLERS."
  sb-kernel:*handler-clusters*)

(defmacro with-handlers ((handlers) &body body)
  "Evaluate BODY with HANDLERS, a value of CURRENT-HANDLERS, in the place of those in force.  An
executive runs its own machinery so, with the handlers from outside the plan: otherwise a plan's
handler for all errors would handle what is wrong with the executive."
  `(let ((sb-kernel:*handler-clusters* ,handlers))
     ,@body))

(defmacro with-executive ((executive) &body body)
  "Evaluate BODY; what it performs is performed by EXECUTIVE."
  `(call-with-executive ,executive (lambda () ,@body)))
