;;;; Tasks: what a plan does, as objects.
;;;;
;;;; Every TOP-LEVEL, every call of a plan, every PERFORM, every branch of a PAR and every :TAG is a
;;;; task.  A task has a parent, a status and a result: the values of its body, or the failure that
;;;; ended it.  A STRAND is a line of execution: tasks that run one within the other share one, a
;;;; branch that runs beside others has its own.  The SCHEDULER of a top-level (scheduler.lisp) lets
;;;; one strand run at a time; this file has the data and what can be asked.

(in-package #:discrepancy-finder.plan-language)

(deftype task-status ()
  '(member :created :running :waiting :suspended :succeeded :failed :evaporated))

(defstruct (task (:constructor %make-task) (:copier nil))
  "A task.  RESULT is a list of values or a failure; CHILDREN are those with strands of their own;
DEPTH is that of the binding stack when the body began.  EVAPORATION is :REQUESTED, then :UNDER-WAY;
BROKEN is the error that it ends with, in its envelope; ESCAPED is a child that was left by a jump."
  (name nil :read-only t)
  (parent nil :type (or null task))
  (scheduler nil :read-only t)
  (node nil)
  (strand nil)
  (status :created :type task-status)
  (status-fluent nil)
  (result nil)
  (children '() :type list)
  (joiners '() :type list)
  (constraints '() :type list)
  (depth 0 :type fixnum)
  (evaporation nil)
  (suspended nil)
  (suspension-handlers '() :type list)
  (broken nil)
  (escaped nil))

(defmethod print-object ((task task) stream)
  (print-unreadable-object (task stream :type t :identity t)
    (format stream "~(~a~) ~(~a~)" (task-text task) (task-status task))))

(defvar *current-task* nil
  "The task that runs, NIL outside of any top-level.")

(defvar *executive* nil
  "The executive of the running plan.  Plan code cannot pass it on, hence a variable.")

(defvar *task-variables* '(*current-task* *executive*)
  "The special variables whose value a task inherits from its parent.")

(defmacro define-task-variable (name &optional value documentation)
  "Define the special variable NAME, whose value a task inherits from the task that starts it; a
task that sets it sets its own."
  `(progn
     (defvar ,name ,value ,@(and documentation (list documentation)))
     (pushnew ',name *task-variables*)
     ',name))

(defun current-task ()
  "Return the TASK that runs, or NIL outside of any top-level."
  *current-task*)

(defun task-text (task)
  "Return what TASK is, in words: the name of a plan, a designator, a tag."
  (let ((name (task-name task)))
    (cond ((functionp name) (princ-to-string (funcall name)))
          ((consp name) (format nil "~(~{~a~^ ~}~)" name))
          ((symbolp name) (string-downcase name))
          (t (princ-to-string name)))))

(defun dead-status-p (status)
  (member status '(:succeeded :failed :evaporated)))

(defun task-dead-p (task)
  "Return true if TASK has ended, one way or another."
  (and (dead-status-p (task-status task)) t))

(defun task-running-p (task)
  "Return true if TASK is running."
  (eq (task-status task) :running))

(defun task-done-p (task)
  "Return true if TASK has succeeded."
  (eq (task-status task) :succeeded))

(defun task-failed-p (task)
  "Return true if TASK has failed."
  (eq (task-status task) :failed))

(defun result (task)
  "Return the list of the values of TASK if it has succeeded, its failure if it has failed, else
NIL."
  (and (member (task-status task) '(:succeeded :failed)) (task-result task)))

(defun within-p (task other)
  "Return true if TASK is OTHER or was started, directly or not, by OTHER."
  (loop for candidate = task then (task-parent candidate)
        while candidate
          thereis (eq candidate other)))

(defun need-task (form)
  "Signal NOT-IN-TOP-LEVEL for FORM outside of any top-level; else return the current task."
  (or *current-task* (error 'not-in-top-level :form form)))

;;; Strands

(defstruct (strand (:copier nil))
  "A line of execution.  TASK is the innermost one that runs on it.  WORKER is the pooled thread
that it uses, NIL before it begins and on the thread of the top-level itself; SEMAPHORE hands it the
baton.  WAITING says for what it waits; TICKET tells its present sleep from earlier ones.
UNINTERRUPTED is true inside of WITHOUT-SCHEDULING, POLLER if all that it does is to look at
something again and again, CATCHING while it can be left."
  (scheduler nil :read-only t)
  (number 0 :type fixnum :read-only t)
  (task nil :type (or null task))
  (function nil)
  (worker nil)
  (semaphore (sb-thread:make-semaphore :name "baton") :read-only t)
  (state :ready :type (member :ready :running :waiting :requesting :done))
  (waiting nil)
  (ticket 0 :type fixnum)
  (timed-out nil)
  (uninterrupted nil)
  (poller nil)
  (catching nil))

(defmethod print-object ((strand strand) stream)
  (print-unreadable-object (strand stream :type t)
    (format stream "~d ~(~a~)~@[ for ~a~]" (strand-number strand) (strand-state strand)
            (strand-waiting strand))))

(setf (documentation 'strand-number 'function)
      "Return the number of a strand: 0 for that of the top-level itself, the others in the order in
which they were started."
      (documentation 'strand-task 'function)
      "Return the innermost task that runs on a strand."
      (documentation 'task-parent 'function)
      "Return the task that has started a task, or NIL."
      (documentation 'task-strand 'function)
      "Return the strand that a task runs on, or NIL if it has not begun.")

;;; Which plan this is

(defun current-plan-name ()
  "Return the name of the innermost plan that runs, or NIL."
  (loop for task = *current-task* then (task-parent task)
        while task
        when (and (symbolp (task-name task)) (plan-source (task-name task)))
          return (task-name task)))
