;;;; Plan failures: what goes wrong in the world.
;;;;
;;;; A failure is a condition below PLAN-FAILURE, which is a serious condition and not an error, as
;;;; in CRAM.  FAIL signals one: handlers of the current task have it first, on top of the failing
;;;; stack; then the task ends with it and its parent fails in the same way.  What handles it stands
;;;; in failure-handling.lisp, the classes of CRAM's package common-fail in failure-classes.lisp.

(in-package #:discrepancy-finder.plan-language)

(define-condition plan-failure (serious-condition)
  ()
  (:documentation "Root of all failures that plans signal and handle."))

(define-condition simple-plan-failure (plan-failure simple-condition)
  ()
  (:default-initargs :format-control "Plan failure.")
  (:documentation "A failure that is described by a format control and its arguments."))

(define-condition composite-failure (plan-failure)
  ((failures :initarg :failures :initform '() :reader composite-failures
             :documentation "The list of the failures."))
  (:report (lambda (condition stream)
             (format stream "All of ~d tasks failed~{~^: ~@{~a~^; ~}~}"
                     (length (composite-failures condition))
                     (mapcar #'princ-to-string (composite-failures condition)))))
  (:documentation "Signaled when all of several ways have failed."))

(define-condition common-lisp-error-envelope (plan-failure)
  ((error :initarg :error :reader envelop-error
          :documentation "The condition that ended a task."))
  (:report (lambda (condition stream)
             (format stream "A task ended with an error: ~a" (envelop-error condition))))
  (:documentation "An error of Lisp on its way up from the task in which it happened: a failure of
that task.  A clause of WITH-FAILURE-HANDLING for the class of the error handles it."))

(define-condition policy-condition (condition)
  ()
  (:documentation "Root of what policies signal: neither a plan failure nor an error, as in CRAM."))

(define-condition policy-not-found (policy-condition)
  ((name :initarg :name :reader policy-not-found-name :documentation "The name."))
  (:report (lambda (condition stream)
             (format stream "There is no policy named ~(~a~)." (policy-not-found-name condition))))
  (:documentation "Signaled when no policy has the name that was given."))

(define-condition policy-failure (policy-condition)
  ((policy :initarg :policy :reader policy-failure-policy :documentation "The policy.")
   (parameters :initarg :parameters :initform '() :reader policy-failure-parameters
               :documentation "The list of its arguments."))
  (:report (lambda (condition stream)
             (format stream "~(~a~) of ~a with the arguments ~s."
                     (type-of condition) (policy-failure-policy condition)
                     (policy-failure-parameters condition))))
  (:documentation "Root of the failures of policies."))

(define-condition policy-init-failed (policy-failure) ()
  (:documentation "Signaled when the :INIT part of a policy returns NIL."))
(define-condition policy-check-condition-met (policy-failure) ()
  (:documentation "Signaled when the :CHECK part of a policy has become true."))

(define-condition task-left-by-jump (plan-error control-error)
  ((task :initarg :task :reader task-left-by-jump-task
         :documentation "What the task was, in words."))
  (:report (lambda (condition stream)
             (format stream "~a was left by a jump; a task ends only by its own end or by a ~
                             failure."
                     (task-left-by-jump-task condition))))
  (:documentation "Signaled in a task after a RETURN-FROM, GO or THROW out of one of its
children."))

(define-task-variable *break-on-plan-failures* nil
  "A type: when a plan failure of it is signaled by FAIL the debugger is entered first, with a
restart to go on.  T stands for all, NIL for none.")

(defun failure-from (arguments)
  "Return the condition that ARGUMENTS of FAIL mean."
  (let ((datum (first arguments)))
    (typecase datum
      (null (make-condition 'simple-plan-failure))
      (string (make-condition 'simple-plan-failure :format-control datum
                                                   :format-arguments (rest arguments)))
      (condition datum)
      (t (if (and (symbolp datum) (subtypep datum 'condition))
             (apply #'make-condition datum (rest arguments))
             (error 'malformed-plan-form
                    :form `(fail ,@arguments) :plan (current-plan-name)
                    :expected "nothing, a text, the class of a condition or a condition"))))))

(define-hook on-fail (failure)
  "Called with each FAILURE that FAIL signals, before it does.")

(defun fail (&rest arguments)
  "Signal a plan failure; never returns.  Without ARGUMENTS it is a SIMPLE-PLAN-FAILURE, with a
string and arguments for it one with this text, with a class name and initargs one of this class,
with a condition just that.  Inside of a task a plan failure that nobody handles ends the task;
anything else is signaled by ERROR."
  (let ((failure (failure-from arguments)))
    (on-fail failure)
    (when (and *break-on-plan-failures* (typep failure *break-on-plan-failures*))
      (call-on-main (lambda () (break "~a" failure))))
    (cond ((and *current-task* (not *machinery*) (typep failure 'plan-failure))
           (signal failure)
           (fail-task *current-task* failure))
          (t (error failure)))))
