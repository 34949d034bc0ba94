;;;; Functions of the plan language: what its macros call, and fluents.
;;;;
;;;; The control functions hand on what the functions return that they are given: these may return
;;;; symbolic values.  Fluents hold none, for compiled code waits for them; what a plan sets a
;;;; fluent to is forgotten after the run.

(in-package #:discrepancy-finder.symbolic-execution)

(defun control-argument (argument description)
  "Return ARGUMENT, an argument of a control function, as that can take it: functions, also in a
list, as what may return symbolic values, all else decided."
  (cond ((interpreted-function-p argument) (interpreted-function-code argument))
        ((and (consp argument) (alexandria:proper-list-p argument)
              (every #'interpreted-function-p argument))
         (mapcar #'interpreted-function-code argument))
        (t (decided argument description))))

(dolist (name plan:*control-functions*)
  (let ((function (fdefinition name)) (description (describe-decision name)))
    (declare (function function))
    (register-lifted name :transparent
                     (lambda (&rest arguments)
                       (apply function (loop for argument in arguments
                                             collect (control-argument argument description))))
                     t)))

(define-transparent (plan::call-par-loop) (function sequence any-body)
  (plan::call-par-loop (code-of function)
                       (settled-sequence sequence "an argument of par-loop") any-body))

;;; Fluents

(defun note-fluent (fluent)
  "Note that FLUENT, and those that depend on it, are to be as they are after the run."
  (when (and *path* (plan:fluentp fluent))
    (dolist (slot (sb-mop:class-slots (class-of fluent)))
      (note-slot fluent (sb-mop:slot-definition-name slot)))
    (mapc #'note-fluent (plan::live-dependents fluent))))

(define-transparent ((setf plan:value)) (any-value fluent)
  (let ((fluent (settled fluent "a fluent")))
    (note-fluent fluent)
    (setf (plan:value fluent) (decided any-value "the value of a fluent"))))

(define-transparent (plan:pulse) (fluent)
  (let ((fluent (settled fluent "a fluent")))
    (note-fluent fluent)
    (plan:pulse fluent)))

(define-transparent (plan:wait-for) (fluent &rest keywords)
  (let ((fluent (decided fluent "what a task waits for")))
    (note-fluent fluent)
    (apply #'plan:wait-for fluent (settled-each keywords "how long a task waits"))))
