;;;; Projection environments under CRAM's names.
;;;;
;;;; In CRAM a projection environment says which process modules take the place of the robot's and
;;;; which special variables get other values meanwhile.  That is all here, too: the world is that
;;;; of the executive, if one is there.

(in-package #:discrepancy-finder.cram-compat)

(define-condition unknown-projection-environment (plan:plan-error)
  ((name :initarg :name :reader unknown-projection-environment-name
         :documentation "The name for which there is no environment."))
  (:report (lambda (condition stream)
             (format stream "There is no projection environment named ~(~a~); it would be defined ~
                             by define-projection-environment."
                     (unknown-projection-environment-name condition))))
  (:documentation "Signaled when a plan is to be projected in an environment that was never
defined."))

(plan:define-task-variable *projection-environment* nil
  "The name of the projection environment in which the plan runs, NIL outside of any.")

(defvar *environments* (make-hash-table :test 'eq)
  "The function of a function that is each environment.")

(defmacro define-projection-environment (name &key special-variable-initializers
                                                process-module-definitions startup shutdown)
  "Define the projection environment NAME.  SPECIAL-VARIABLE-INITIALIZERS is a list of (variable
form), PROCESS-MODULE-DEFINITIONS one of names of process modules or (alias name); STARTUP and
SHUTDOWN are forms that are evaluated around a projection."
  `(progn
     ,@(loop for (variable) in special-variable-initializers
             collect `(pushnew ',variable plan::*task-variables*))
     (setf (gethash ',name *environments*)
           (lambda (body)
             (progv ',(mapcar #'first special-variable-initializers)
                 (list ,@(mapcar #'second special-variable-initializers))
               (plan:with-process-modules-running ,process-module-definitions
                 ,startup
                 (unwind-protect (funcall body)
                   ,shutdown)))))
     ',name))

(defun call-with-projection-environment (name body)
  (let ((environment (or (gethash name *environments*)
                         (error 'unknown-projection-environment :name name)))
        (*projection-environment* name))
    (funcall environment body)))

(defmacro with-projection-environment (name &body body)
  "Evaluate BODY in the projection environment NAME and return its values.  Signals
UNKNOWN-PROJECTION-ENVIRONMENT."
  `(call-with-projection-environment ',name (lambda () ,@body)))

;; What a process module of the robot asks, so as not to be available in a projection.
(def-fact-group projection-environments (plan:projection-running)
  (<- (plan:projection-running ?environment)
    (symbol-value *projection-environment* ?environment)
    (prolog:lisp-pred identity ?environment)))
