;;;; Functions of the plan language: what its macros call, and fluents.
;;;;
;;;; The control functions hand on what the functions return that they are given: these may return
;;;; symbolic values.  Fluents hold none, for compiled code waits for them; what a plan sets a
;;;; fluent to is forgotten after the run.

(in-package #:discrepancy-finder.symbolic-execution)

(defun codes-within (argument)
  "Return ARGUMENT, an argument of a control function, with the codes of interpreted functions in
their place, also in a list of them."
  (cond ((interpreted-function-p argument) (interpreted-function-code argument))
        ((and (consp argument) (alexandria:proper-list-p argument)
              (every #'interpreted-function-p argument))
         (mapcar #'interpreted-function-code argument))
        (t argument)))

(dolist (name plan:*control-functions*)
  (let ((function (fdefinition name)))
    (declare (function function))
    (register-lifted name :transparent
                     (lambda (&rest arguments)
                       (apply function (mapcar #'codes-within arguments)))
                     t)))

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
