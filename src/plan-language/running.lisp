;;;; Running a task: its border, its end, and leaving the whole plan.
;;;;
;;;; RUN-TASK evaluates the body of a task on the current strand behind a border: the condition
;;;; handlers, restarts and LET-bound special variables of the tasks above are not visible, and a
;;;; failure that nobody handles in the task ends it.  CALL-IN-TASK makes a child, waits for it and
;;;; returns its values or fails like it.  Where no other strand is there the child runs on the
;;;; strand of its parent, which costs no switch; else it gets a strand of its own, so that parent
;;;; and child can be evaporated apart from each other.
;;;;
;;;; An executive leaves a plan by LEAVE-PLAN, past all cleanup that the scheduler would do.

(in-package #:discrepancy-finder.plan-language)

(defvar *debug-on-lisp-errors* nil
  "If true, an error in a task that is not handled there opens the debugger (in the place where it
happened if that is on the thread of the top-level) with a restart RETHROW that ends the task with
it.  If false the task ends with it at once.")

(defun make-task (name parent &key node)
  "Return a new task.  NAME is a symbol, a list or a function that returns a text."
  (%make-task :name name :parent parent :scheduler (task-scheduler parent) :node node))

(defun set-status (task status)
  (setf (task-status task) status)
  (when (task-status-fluent task)
    (setf (value (task-status-fluent task)) status)))

(defun fail-task (task condition)
  "End TASK, on whose strand this is called, with the failure CONDITION."
  (setf (task-result task) condition)
  (throw task :failed))

(defun envelope (condition)
  "Return CONDITION as a failure: itself, or in an envelope if it is none."
  (if (typep condition 'plan-failure)
      condition
      (make-condition 'common-lisp-error-envelope :error condition)))

(defun open-envelope (condition)
  (if (typep condition 'common-lisp-error-envelope)
      (envelop-error condition)
      condition))

(defun debug-error (condition hook)
  "Let the user look at CONDITION, an error in a task.  HOOK is the debugger hook around the
top-level."
  (with-simple-restart (rethrow "End the task with this failure.")
    (let ((*machinery* t)
          (sb-ext:*invoke-debugger-hook* hook))
      (invoke-debugger condition))))

(deftype plan-trouble ()
  "What ends a task if nobody handles it there.  All else, such as an interrupt by the user or a
timeout around the top-level, is no business of the plan."
  '(or error plan-failure policy-condition storage-condition))

(defun debugger-hook (outer-hook)
  "Return a function for *INVOKE-DEBUGGER-HOOK* that ends the current task with an error that nobody
handles.  All else is for OUTER-HOOK."
  (lambda (condition hook)
    (when (and *current-task* (not *machinery*)
               (typep condition 'plan-trouble))
      (when *debug-on-lisp-errors*
        (let ((hook (scheduler-outside-debugger-hook (task-scheduler *current-task*))))
          (call-on-main (lambda () (debug-error condition hook)))))
      (setf (task-broken *current-task*) (envelope condition))
      (fail-task *current-task* (task-broken *current-task*)))
    (if outer-hook
        (funcall outer-hook condition hook)
        ;; What the user tries in the debugger is not the plan's either.
        (let ((*machinery* t)
              (sb-ext:*invoke-debugger-hook* nil))
          (invoke-debugger condition)))))

(defun border-handlers (outside)
  "Return condition handlers for the tasks of a top-level.  OUTSIDE are those in force around it:
they may handle warnings and the like where these are signaled, while failures and errors have to
pass the tasks first."
  ;; A cluster is a list of (test . handler).  HANDLER-BIND would make it on the stack.
  (list (list (cons (constantly t)
                    (lambda (condition)
                      (unless (typep condition 'plan-trouble)
                        (signal-outside condition outside)))))))

(defun signal-outside (condition handlers)
  "Signal CONDITION for HANDLERS on the thread of the top-level, whose handlers may leave it.  Of
the restarts here they see those of the names that Common Lisp has."
  (let* ((restarts (compute-restarts condition))
         (choice (call-on-main
                  (lambda ()
                    (with-handlers (handlers)
                      (call-with-restarts-for restarts (lambda () (signal condition) nil)))))))
    (when choice
      (apply #'invoke-restart choice))))

(defun call-with-restarts-for (restarts function)
  "Call FUNCTION.  If a restart is invoked meanwhile that has the name of one of RESTARTS, return
this and the list of the arguments."
  (macrolet ((with-names (names form)
               `(restart-case ,form
                  ,@(loop for name in names
                          collect `(,name (&rest arguments)
                                    :test (lambda (condition)
                                            (declare (ignore condition))
                                            (find ',name restarts :key #'restart-name))
                                    (cons (find ',name restarts :key #'restart-name)
                                          arguments))))))
    (with-names (muffle-warning continue use-value store-value) (funcall function))))

(defun call-behind-border (task function)
  "Call FUNCTION for TASK with the dynamic environment of a new task."
  (let ((values (mapcar #'symbol-value *task-variables*))
        (scheduler (task-scheduler task))
        (parent (task-parent task)))
    (call-hiding (if (and parent (eq (task-strand parent) (task-strand task)))
                     (task-depth parent)
                     (binding-depth))
                 (scheduler-outside scheduler)
                 (lambda ()
                   (progv *task-variables* values
                     (let ((*current-task* task)
                           (*machinery* nil)
                           (sb-kernel:*handler-clusters* (scheduler-handlers scheduler))
                           (sb-kernel:*restart-clusters*
                             (if (eq (task-strand task) (scheduler-main scheduler))
                                 (scheduler-outside-restarts scheduler)
                                 '())))
                       (setf (task-depth task) (binding-depth))
                       (funcall (the function function))))))))

(defun run-task (task function)
  "Evaluate FUNCTION as the body of TASK on the current strand, and note how it ended."
  (let* ((parent (task-parent task))
         (strand (task-strand task))
         (outer (strand-task strand))
         (outcome nil))
    (setf (strand-task strand) task)
    (unwind-protect
         (setf outcome
               (catch task
                 (call-behind-border
                  task
                  (lambda ()
                    (await-constraints task)
                    (set-status task :running)
                    (check-events strand)
                    (setf (task-result task) (multiple-value-list (funcall function)))
                    (check-escape task)
                    (when (task-broken task)
                      ;; A cleanup form has left in another way than the error was going to.
                      (fail-task task (task-broken task)))
                    :succeeded))))
      (when outcome
        (finish-task task outcome))
      (setf (strand-task strand) outer)
      (cond (outcome)
            ((or (null parent) (being-left-p task))
             (abandon-task task :evaporated))
            ((eq (task-strand parent) strand)
             (setf (task-escaped parent) task)
             (abandon-task task :evaporated))
            (t
             ;; A jump out of the thread: it would unwind all of it, so it ends here.
             (setf (task-result task) (envelope (left-by-jump task)))
             (abandon-task task :failed)
             (throw strand nil))))))

(defun left-by-jump (task)
  (make-condition 'task-left-by-jump :task (task-text task)))

(defun being-left-p (task)
  "Return true if TASK is being left because the plan is or because it evaporates."
  (or (scheduler-leaving (task-scheduler task))
      (loop for candidate = task then (task-parent candidate)
            while candidate
              thereis (eq (task-evaporation candidate) :under-way))))

(defun check-escape (task)
  "Fail if a child of TASK was left by a jump: a task can only be left by its end."
  (let ((child (shiftf (task-escaped task) nil)))
    (when child
      (fail (left-by-jump child)))))

(defun finish-task (task status)
  "Let the children of TASK end, then give it its last STATUS and tell those who wait for it."
  (let ((scheduler (task-scheduler task)))
    (unless (or (null (task-children task)) (scheduler-leaving scheduler))
      ;; What befalls the task now must not disturb its end.
      (setf (task-evaporation task) :under-way)
      (let ((*current-task* task))
        (dolist (child (task-children task))
          (evaporate child :sync nil))
        (wait-for-tasks (task-children task)
                        (lambda () (every #'task-dead-p (task-children task))))))
    (when (eq status :evaporated)
      (setf (task-result task) nil))
    (when (task-suspended task)
      (setf (task-suspended task) nil)
      (decf (scheduler-suspensions scheduler)))
    (setf (task-children task) '())
    (set-status task status)
    (loop for (strand . predicate) in (shiftf (task-joiners task) '())
          do (when (funcall (the function predicate)) (wake strand)))
    status))

(defun abandon-task (task status)
  "Note that TASK was left by a jump and has STATUS now.  Its children evaporate when they have
their turns; the parent of TASK will wait for that."
  (let ((*current-task* task)
        (parent (task-parent task)))
    (dolist (child (task-children task))
      (evaporate child :sync nil)
      (when parent
        (push child (task-children parent))))
    (setf (task-children task) '())
    (finish-task task status)))

(defun wait-for-tasks (tasks predicate)
  "Block until PREDICATE is true, which depends on the states of TASKS."
  (let ((strand (current-strand)))
    (loop until (funcall (the function predicate))
          do (dolist (task tasks)
               (unless (or (task-dead-p task) (find predicate (task-joiners task) :key #'cdr))
                 (push (cons strand predicate) (task-joiners task))))
             (block-strand (lambda ()
                             (format nil "the end of ~{~a~^, ~}"
                                     (mapcar #'task-text
                                             (remove-if #'task-dead-p tasks))))))))

;;; Children

(defun start-strand (task function)
  "Let TASK run FUNCTION on a strand of its own; it is ready, but does not run yet."
  (let* ((scheduler (task-scheduler task))
         (parent (task-parent task))
         (strand (make-strand :scheduler scheduler :task task
                              :number (incf (scheduler-count scheduler))))
         (task-values (mapcar #'symbol-value *task-variables*)))
    (setf (task-strand task) strand
          (strand-function strand)
          (lambda () (run-strand strand task task-values function)))
    (push strand (scheduler-live scheduler))
    (push task (task-children parent))
    (make-ready strand)
    task))

(defun run-strand (strand task task-values function)
  "Be the job of a worker: run TASK and give the baton on."
  (let ((scheduler (strand-scheduler strand)))
    (call-with-captured
     (scheduler-outside scheduler)
     (lambda ()
       (setf (sb-vm:floating-point-modes) (scheduler-float-modes scheduler))
       (let ((sb-ext:*invoke-debugger-hook* (strand-debugger-hook strand)))
         (progv *task-variables* task-values
           (let ((*current-task* task))
             (catch strand
               (unwind-protect
                    (progn
                      (setf (strand-catching strand) t)
                      (run-task task function))
                 (setf (strand-catching strand) nil))))))))
    ;; Who is next is the executive's business.
    (progv *task-variables* task-values
      (end-strand strand))))

(defun strand-debugger-hook (strand)
  "Return a function for *INVOKE-DEBUGGER-HOOK* on the thread of a worker.  What is not the plan's
is signaled again on the thread of the top-level, which the user sees."
  (debugger-hook (lambda (condition hook)
                   (declare (ignore hook))
                   (if (typep condition 'error)
                       (leave-with strand (list :error condition))
                       ;; A break, for example: the user goes on from there.
                       (call-on-main (lambda () (show-user condition))))
                   (let ((continue (find-restart 'continue condition)))
                     (when continue
                       (invoke-restart continue))))))

(defun show-user (condition)
  "Enter the debugger with CONDITION, which a task has signaled, on the thread of the top-level."
  (with-simple-restart (continue "Go on in the task.")
    (invoke-debugger condition)))

(defun end-strand (strand)
  "Take STRAND out of its scheduler and give the baton on."
  (let ((scheduler (strand-scheduler strand))
        (worker (strand-worker strand)))
    (setf (strand-state strand) :done
          (scheduler-live scheduler) (delete strand (scheduler-live scheduler)))
    (decf (scheduler-begun scheduler))
    (let ((next (if (scheduler-leaving scheduler)
                    (scheduler-main scheduler)
                    (let ((*current-task* (strand-task strand)))
                      (next-strand scheduler)))))
      (rest-worker worker)
      (hand-over next))))

(defun conclude (child)
  "Return the values of CHILD, which has ended, or fail as it did.  An evaporated one has no value."
  (ecase (task-status child)
    (:succeeded (values-list (task-result child)))
    (:failed (fail (task-result child)))
    (:evaporated nil)))

(defconstant +stack-reserve+ 250000
  "So many bytes of the control stack are left for what a task does by itself.")

(defun check-stack ()
  "Signal TASKS-NESTED-TOO-DEEPLY if little is left of the control stack.  SBCL notices by itself
where none is left, but ends the process if that is in the middle of an allocation."
  (when (< (sb-sys:sap- (sb-kernel:current-sp)
                        (sb-di::descriptor-sap sb-vm:*control-stack-start*))
           +stack-reserve+)
    (error 'tasks-nested-too-deeply)))

(defun run-child (child function)
  "Run FUNCTION as the body of CHILD, a new task, and return its values or fail as it does."
  (let* ((parent (task-parent child))
         (scheduler (task-scheduler child)))
    (check-escape parent)
    (cond ((task-dead-p child))         ; a tag that has evaporated before it was reached
          ((or (alone-p scheduler) (strand-uninterrupted (task-strand parent)))
           (check-stack)
           (setf (task-strand child) (task-strand parent))
           (check-events (task-strand parent))
           (run-task child function)
           ;; What was asked of the parent meanwhile.
           (check-events (task-strand parent)))
          (t
           (start-strand child function)
           (let ((ended nil))
             (unwind-protect
                  (progn (wait-for-tasks (list child) (lambda () (task-dead-p child)))
                         (setf ended t))
               (if ended
                   (setf (task-children parent) (delete child (task-children parent)))
                   (evaporate child :sync nil))))))
    (conclude child)))

;;; Leaving

(defun leave-with (strand leaving)
  "Leave the plan that STRAND, the current one, belongs to."
  (let ((scheduler (strand-scheduler strand)))
    (setf (scheduler-leaving scheduler) leaving)
    (if (eq strand (scheduler-main scheduler))
        (leave-main scheduler)
        (throw strand nil))))

(defun leave-main (scheduler)
  "On the main strand, go where the plan is left to."
  (destructuring-bind (kind &optional tag value) (scheduler-leaving scheduler)
    (if (eq kind :tag)
        (throw tag value)
        (throw scheduler nil))))

(defun leave-plan (tag &optional value)
  "Leave the plan that runs, all its tasks included, and return VALUE from the CATCH of TAG around
it.  Executives do this; no handler of the plan sees it."
  ;; A request is served without a current task, on the thread of the top-level.
  (if *current-task*
      (leave-with (current-strand) (list :tag tag value))
      (throw tag value)))
