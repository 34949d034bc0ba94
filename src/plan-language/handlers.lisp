;;;; Condition handlers from outside of a plan.
;;;;
;;;; An executive runs its own machinery with them: otherwise a plan's handler for all errors would
;;;; handle what is wrong with the executive.

(in-package #:discrepancy-finder.plan-language)

(defvar *machinery* nil
  "True while an executive runs its own machinery: what goes wrong in it is not the plan's.")

(defun current-handlers ()
  "Return the condition handlers that are in force, for WITH-HANDLERS."
  sb-kernel:*handler-clusters*)

(defmacro with-handlers ((handlers) &body body)
  "Evaluate BODY with HANDLERS, a value of CURRENT-HANDLERS, in the place of those in force."
  `(let ((sb-kernel:*handler-clusters* ,handlers)
         (*machinery* t))
     ,@body))
