;;;; Conditions about plans as programs.  Failures, which plans signal and handle while they run,
;;;; stand in failures.lisp.

(in-package #:discrepancy-finder.plan-language)

(define-condition plan-error (error)
  ()
  (:documentation "Root of the errors in the use of the plan language."))

(define-condition plan-not-found (plan-error)
  ((name :initarg :name :reader plan-not-found-name
         :documentation "The name for which there is no plan.")
   (known :initarg :known :initform '() :reader plan-not-found-known
          :documentation "The names, strings, of the plans that files in plans/ define, or NIL."))
  (:report (lambda (condition stream)
             (let ((name (plan-not-found-name condition)))
               (if (and (symbolp name) (fboundp name))
                   (format stream "The function ~(~a~) is no plan with a source: such a one is ~
                                   defined by def-top-level-cram-function or def-cram-function, ~
                                   outside of other forms." name)
                   (format stream "There is no plan named ~(~a~); it would be defined by ~
                                   def-top-level-cram-function or def-cram-function~@[, and the ~
                                   files in plans/ define ~{~a~^, ~}~]."
                           name (plan-not-found-known condition))))))
  (:documentation "Signaled when a plan is asked for that was never defined."))

(defun short-form (form)
  "Return FORM as a text of one line."
  (let ((*print-pretty* nil) (*print-length* 8) (*print-level* 4))
    (prin1-to-string form)))

(define-condition malformed-plan-form (plan-error)
  ((form :initarg :form :reader malformed-plan-form-form
         :documentation "The form that is not well-formed.")
   (plan :initarg :plan :initform nil :reader malformed-plan-form-plan
         :documentation "The name of the plan that it stands in, or NIL.")
   (expected :initarg :expected :reader malformed-plan-form-expected
             :documentation "What was expected, as a string."))
  (:report (lambda (condition stream)
             (let ((form (malformed-plan-form-form condition)))
               (format stream "In ~a~@[ of the plan ~(~a~)~]~@[ (~a)~], ~a was expected."
                       (short-form form) (malformed-plan-form-plan condition)
                       (source:form-position form) (malformed-plan-form-expected condition)))))
  (:documentation "Signaled when a form of the plan language is expanded that is not well-formed."))

(define-condition misplaced-retry (style-warning)
  ((form :initarg :form :reader misplaced-retry-form :documentation "The call.")
   (plan :initarg :plan :initform nil :reader misplaced-retry-plan
         :documentation "The name of the plan that it stands in, or NIL."))
  (:report (lambda (condition stream)
             (format stream "~a~@[ of the plan ~(~a~)~] is outside of any handler of ~
                             with-failure-handling."
                     (short-form (misplaced-retry-form condition))
                     (misplaced-retry-plan condition))))
  (:documentation "Signaled when a call of RETRY is compiled that no handler is around."))

(define-condition nested-top-level (plan-error)
  ()
  (:report "top-level calls cannot be nested.")
  (:documentation "Signaled when a top-level is entered while another one runs."))

(define-condition not-in-top-level (plan-error type-error)
  ((form :initarg :form :reader not-in-top-level-form
         :documentation "What was to be evaluated."))
  (:default-initargs :datum nil :expected-type 'task)
  (:report (lambda (condition stream)
             (format stream "~a needs a task: it can be evaluated only inside of a top-level."
                     (short-form (not-in-top-level-form condition)))))
  (:documentation "Signaled by what is possible only inside of a top-level.  A TYPE-ERROR, as in
CRAM, where NIL is found in the place of a task."))

(define-condition deadlock (plan-error)
  ((waiting :initarg :waiting :reader deadlock-waiting
            :documentation "List of (task . what it waits for), both in words."))
  (:report (lambda (condition stream)
             (format stream "Deadlock: ~{~{~a waits for ~a~}~^, ~}."
                     (loop for (task . what) in (deadlock-waiting condition)
                           collect (list task what)))))
  (:documentation "Signaled by a top-level all of whose tasks wait for something that cannot
happen any more."))

(define-condition top-level-interrupted (plan-error)
  ()
  (:report "The plan was interrupted, and one of its cleanup forms waited for another task.")
  (:documentation "Signaled by a top-level that was left by a jump out of it, while a cleanup form
of the plan did what can be done only as long as the plan runs."))

(define-condition too-many-tasks (plan-error)
  ((task :initarg :task :reader too-many-tasks-task
         :documentation "The task that was to begin, in words.")
   (limit :initarg :limit :reader too-many-tasks-limit
          :documentation "The number of parallel tasks that can be under way."))
  (:report (lambda (condition stream)
             (format stream "~a cannot begin: ~d parallel tasks are under way already."
                     (too-many-tasks-task condition) (too-many-tasks-limit condition))))
  (:documentation "Signaled by a top-level with too many parallel tasks at the same time; recursion
without end in a parallel branch leads to it."))

(define-condition tasks-nested-too-deeply (storage-condition)
  ()
  (:report "Tasks are nested so deeply that they fill the control stack: does a plan call itself?")
  (:documentation "Signaled where a task begins inside of others on the same stack, and little of
that is left."))

(define-condition fluent-not-settable (plan-error)
  ((fluent :initarg :fluent :reader fluent-not-settable-fluent
           :documentation "What was to be set."))
  (:report (lambda (condition stream)
             (format stream "~a has no value that can be set."
                     (short-form (fluent-not-settable-fluent condition)))))
  (:documentation "Signaled when a value is set of what is computed from other fluents, or no
fluent."))

(define-condition wait-for-nil (plan-error)
  ()
  (:report "wait-for called with nil argument.")
  (:documentation "Signaled by WAIT-FOR for NIL, which will never be true."))

(define-condition task-not-found (plan-error)
  ((path :initarg :path :reader task-not-found-path :documentation "The path."))
  (:report (lambda (condition stream)
             (format stream "There is no task with the path ~a."
                     (short-form (task-not-found-path condition)))))
  (:documentation "Signaled by TASK and SUB-TASK for a path that no task has."))

(define-condition process-module-not-found (plan-error)
  ((name :initarg :name :reader process-module-not-found-name :documentation "The name."))
  (:report (lambda (condition stream)
             (format stream "There is no process module named ~(~a~); it would be defined by ~
                             def-process-module."
                     (process-module-not-found-name condition))))
  (:documentation "Signaled when a process module is to run that was never defined."))

(define-condition goal-already-reached (warning)
  ((designator :initarg :designator :reader goal-already-reached-designator
               :documentation "The action designator.")
   (goal :initarg :goal :reader goal-already-reached-goal :documentation "The occasion."))
  (:report (lambda (condition stream)
             (format stream "~a is not performed: its goal ~a holds already."
                     (goal-already-reached-designator condition)
                     (short-form (goal-already-reached-goal condition)))))
  (:documentation "Signaled by PERFORM for an action whose goal holds already."))

(define-condition designator-not-understood (plan-error)
  ((designator :initarg :designator :reader designator-not-understood-designator
               :documentation "The designator in question.")
   (executive :initarg :executive :reader designator-not-understood-executive
              :documentation "Who was to perform it.")
   (reason :initarg :reason :reader designator-not-understood-reason
           :documentation "Why it is not understood, as a string."))
  (:report (lambda (condition stream)
             (format stream "~a does not understand ~a: ~a."
                     (designator-not-understood-executive condition)
                     (designator-not-understood-designator condition)
                     (designator-not-understood-reason condition))))
  (:documentation "Signaled when an executive is asked to perform a designator that it cannot
interpret."))
