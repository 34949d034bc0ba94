;;;; The executive: who performs what a plan asks for.
;;;;
;;;; PERFORM hands a designator to the executive of the plan that runs, in a task of its own.  An
;;;; executive is any object with a method on PERFORM-WITH: a projection world executes motions, a
;;;; symbolic executive consults a theory.  So one plan source serves both.  What an executive does
;;;; not know, and what is performed without one, goes CRAM's way (GENERIC-PERFORM): an action
;;;; designator is resolved to a plan, which is called, a motion designator is given to a process
;;;; module that runs.

(in-package #:discrepancy-finder.plan-language)

(defgeneric perform-with (executive designator position)
  (:documentation "Let EXECUTIVE perform the action or motion DESIGNATOR and return the result.
POSITION is the source position of the perform form, or NIL where unknown.  Signals a PLAN-FAILURE
if that fails, DESIGNATOR-NOT-UNDERSTOOD if EXECUTIVE cannot interpret DESIGNATOR.")
  (:method (executive designator position)
    (declare (ignore executive position))
    (generic-perform designator)))

(defun current-executive ()
  "Return the executive of the plan that runs, NIL if there is none.  For what resolves designators
by what the executive knows; a plan has no need to ask."
  *executive*)

(defgeneric gives-way-p (executive)
  (:documentation "Return true if a task lets others have their turns before and after each PERFORM.
One that performs in a task of its own is a turn in any case.")
  (:method (executive) (declare (ignore executive)) t))

(defgeneric call-plan-function (executive name arguments)
  (:documentation "Call the plan named NAME with the list ARGUMENTS, for EXECUTIVE.")
  (:method (executive name arguments)
    (declare (ignore executive))
    (apply name arguments)))

(define-condition designator-reference-failure (simple-plan-failure desig:designator-error)
  ((result :initarg :result :initform nil :reader designator-reference-failure-result
           :documentation "What the designator was resolved to, if that is of no use."))
  (:documentation "Signaled by PERFORM for a designator that cannot be resolved."))

(define-condition designator-goal-parsing-failure (simple-plan-failure desig:designator-error)
  ()
  (:documentation "Signaled by PERFORM for an action with a goal that is no occasion."))

(defun reference-failure (designator control &rest arguments)
  "Fail because of DESIGNATOR; the text says in which plan."
  (fail 'designator-reference-failure
        :designator designator :format-control "~?~@[  (In the plan ~(~a~).)~]"
        :format-arguments (list control arguments (current-plan-name))))

(defun try-reference-designator (designator)
  "Return what DESIGNATOR is resolved to.  Signals DESIGNATOR-REFERENCE-FAILURE if it cannot be."
  (handler-case (reference designator)
    (desig:designator-error (condition)
      (reference-failure designator "~a" condition))))

(defun plan-known-p (designator)
  "Return true if DESIGNATOR can be performed by GENERIC-PERFORM: if it is an action that is
resolved to a call of a plan, or a motion for which a process module runs."
  (typecase designator
    (action-designator
     (handler-case (let ((solution (reference designator)))
                     (and (consp solution) (symbolp (first solution))
                          (fboundp (first solution))))
       (desig:designator-error () nil)))
    (motion-designator (and (matching-process-modules designator) t))))

(defun perform-action (designator)
  "Resolve the action DESIGNATOR, by its first solution, and call the plan."
  (let ((solution (try-reference-designator designator)))
    (unless (and (consp solution) (symbolp (first solution)))
      (reference-failure designator "~a is resolved to ~s, which is no call of a plan."
                         designator solution))
    (destructuring-bind (name . arguments) solution
      (unless (fboundp name)
        (fail "~a is resolved to a call of ~(~s~), which is no function." designator name))
      (call-plan-function *executive* name arguments))))

(defgeneric generic-perform (designator)
  (:documentation "Perform DESIGNATOR as CRAM does: an action by its plan, a motion by a process
module that runs.  Signals DESIGNATOR-REFERENCE-FAILURE, SIMPLE-PLAN-FAILURE and what plan or
process module fail with.")
  (:method ((designator t))
    (fail "~s is no designator of an action or a motion." designator))
  (:method ((designator action-designator))
    (perform-action designator))
  (:method ((designator motion-designator))
    (perform-motion designator)))

;;; Goals of actions

(defun occasion-name (name)
  "Return the occasion that NAME means: designators make keywords of what is written in them."
  (if (keywordp name)
      (multiple-value-bind (symbol status)
          (find-symbol (symbol-name name) '#:discrepancy-finder.plan-language)
        (and (eq status :external) symbol))
      (and (symbolp name) name)))

(defun goal-occasion (designator)
  "Return the occasion that the action DESIGNATOR has for a goal, or NIL.  Signals
DESIGNATOR-GOAL-PARSING-FAILURE for what is none."
  (let* ((goal (and (typep designator 'action-designator) (desig-prop-value designator :goal)))
         (name (and (consp goal) (occasion-name (first goal)))))
    (cond (name (cons name (rest goal)))
          (goal (fail 'designator-goal-parsing-failure
                      :designator designator
                      :format-control "The goal ~s of ~a is no occasion."
                      :format-arguments (list goal designator))))))

(defun call-with-goal (designator function)
  "Call FUNCTION, which performs DESIGNATOR.  If this has a goal that holds already, warn and return
NIL instead; if it does not hold afterwards, fail."
  (let ((goal (goal-occasion designator)))
    (cond ((null goal) (funcall function))
          ((holds goal)
           (warn 'goal-already-reached :designator designator :goal goal)
           nil)
          (t
           (multiple-value-prog1 (funcall function)
             (unless (holds goal)
               (fail "The goal ~s of ~a was not reached." goal designator)))))))

(defun perform (designator &optional position)
  "Perform the action or motion DESIGNATOR in a task of its own and return the result.  POSITION,
where in the source this is, is filled in by the compiler for plans that were loaded with LOAD-PLAN.
Signals a PLAN-FAILURE if that fails, NOT-IN-TOP-LEVEL outside of a top-level."
  (need-task `(perform ,designator))
  (when (gives-way-p *executive*) (yield))
  (multiple-value-prog1
      (call-in-task (lambda () (format nil "perform ~a" designator))
                    '(goal (perform ?designator))
                    (lambda ()
                      (call-with-goal designator
                                      (lambda ()
                                        (perform-with *executive* designator position))))
                    :parameters (lambda () (list designator)))
    (when (gives-way-p *executive*) (yield))))

(defun perform-task-p (task)
  "Return true if TASK is that of a PERFORM."
  (equal (node-head (task-node task)) '(goal (perform ?designator))))

(define-compiler-macro perform (&whole form designator &optional position)
  (let ((found (and (null position) (source:form-position form))))
    (if found
        `(perform ,designator ,found)
        form)))

;;; What the macros of the plan language expand into

(defparameter *control-functions*
  '(call-with-failure-handlers call-in-top-level call-in-task run-child ensure-top-level
    call-par call-par-loop call-pursue call-try-all call-try-in-order
    call-with-policy call-with-task-suspended call-with-suspension-handler
    call-retrying-after-suspension call-uninterrupted call-with-process-modules
    call-with-executive)
  "Functions that the macros of the plan language expand into.  They call the functions that they
are given and hand on what these return, whatever it is.")

(defun call-with-executive (executive function)
  "Call FUNCTION without arguments; what it performs is performed by EXECUTIVE."
  (let ((*executive* executive))
    (funcall function)))

(defmacro with-executive ((executive) &body body)
  "Evaluate BODY; what it performs is performed by EXECUTIVE."
  `(call-with-executive ,executive (lambda () ,@body)))
