;;;; Control over tasks: what one task can do to another.
;;;;
;;;; EVAPORATE ends a task: it is left where it blocks, its cleanup forms run, then its children
;;;; evaporate.  SUSPEND makes it pause where it blocks, WAKE-UP lets it go on; both hold for its
;;;; children, too.  A busy loop that never blocks is neither evaporated nor suspended, as in CRAM.

(in-package #:discrepancy-finder.plan-language)

(defun status (task)
  "Return the fluent of the status of TASK: :created, :running, :waiting, :suspended, :succeeded,
:failed or :evaporated."
  (or (task-status-fluent task)
      (setf (task-status-fluent task)
            (make-fluent :name (format nil "status of ~a" (task-text task))
                         :value (task-status task)))))

(defun task-alive (task)
  "Return a fluent that is true as long as TASK has not ended."
  (fl-not (task-dead task)))

(defun task-dead (task)
  "Return a fluent that is true when TASK has ended."
  (fl-funcall (lambda (status) (and (dead-status-p status) t)) (status task)))

;;; Events

(defun evaporating-task (strand)
  "Return the outermost task of STRAND that is asked to evaporate, or NIL.  One around a task that
is just coming to its end waits for that."
  (let ((evaporating nil))
    (loop for task = (strand-task strand) then (task-parent task)
          while (and task (eq (task-strand task) strand)
                     (not (eq (task-evaporation task) :under-way)))
          do (when (eq (task-evaporation task) :requested)
               (setf evaporating task)))
    evaporating))

(defun check-events (strand)
  "Do what has been asked of the tasks of STRAND, the current one: leave the plan, evaporate, pause.
Called wherever a strand gets the baton."
  (let ((scheduler (strand-scheduler strand)))
    (loop
      (when (scheduler-leaving scheduler)
        (if (eq strand (scheduler-main scheduler))
            (leave-main scheduler)
            (throw strand nil)))
      (let ((evaporating (evaporating-task strand)))
        (when evaporating
          (setf (task-evaporation evaporating) :under-way)
          (throw evaporating :evaporated)))
      (if (and (plusp (scheduler-suspensions scheduler))
               (suspended-task (strand-task strand)))
          (pause strand)
          (return)))))

(defun evaporation-target-p (task)
  "Return true if TASK runs on the current strand, around or as the current task."
  (and (eq (task-strand task) (current-strand))
       (within-p *current-task* task)))

(defun evaporate (task &key reason (sync t))
  "End TASK and its children.  With SYNC return when they have ended.  REASON is for the reader."
  (declare (ignore reason))
  (need-task '(evaporate))
  (cond ((task-dead-p task))
        ((null (task-strand task))      ; a tag that was never reached
         (finish-task task :evaporated))
        ((task-evaporation task))
        ((strand-function (task-strand task)) ; it has not begun
         (let ((strand (task-strand task)))
           (setf (strand-function strand) nil
                 (scheduler-live (task-scheduler task))
                 (delete strand (scheduler-live (task-scheduler task)))
                 (strand-state strand) :done)
           (remove-ready strand)
           (finish-task task :evaporated)))
        (t
         (setf (task-evaporation task) :requested)
         (if (evaporation-target-p task)
             (check-events (current-strand))
             (wake (task-strand task)))))
  (when (and sync (not (within-p *current-task* task)))
    (wait-for-tasks (list task) (lambda () (task-dead-p task))))
  task)

(defun remove-ready (strand)
  (let* ((queue (scheduler-ready (strand-scheduler strand)))
         (position (position strand (queue-head queue))))
    (when position
      (dequeue queue position))))

;;; Suspension

(defun suspended-task (task)
  "Return the outermost of TASK and the tasks above it that is to be suspended, or NIL."
  (loop with suspended = nil
        for candidate = task then (task-parent candidate)
        while candidate
        when (task-suspended candidate) do (setf suspended candidate)
        finally (return suspended)))

(defun strand-tasks-below (strand suspended)
  "Return the tasks of STRAND from the innermost one to SUSPENDED or the strand's last."
  (loop for task = (strand-task strand) then (task-parent task)
        while (and task (eq (task-strand task) strand))
        collect task
        until (eq task suspended)))

(defun pause (strand)
  "Let the suspended tasks of STRAND, the current one, pause until they are woken up."
  (let* ((suspended (suspended-task (strand-task strand)))
         (tasks (strand-tasks-below strand suspended)))
    (dolist (task tasks)
      (unless (eq (task-status task) :suspended)
        (set-status task :suspended)
        (dolist (handler (task-suspension-handlers task))
          (funcall (the function handler)))))
    (dolist (joiner (shiftf (task-joiners suspended) '()))
      (wake (car joiner)))
    (await-turn strand "being woken up")
    (unless (suspended-task (strand-task strand))
      (dolist (task tasks)
        (when (eq (task-status task) :suspended)
          (set-status task :running))))))

(defun strands-within (task)
  "Return the strands on which TASK and tasks below it run, the oldest first."
  (sort (remove-if-not (lambda (strand) (within-p (strand-task strand) task))
                       (scheduler-live (task-scheduler task)))
        #'< :key #'strand-number))

(defun suspend (task &key reason (sync t))
  "Let TASK and its children pause where they block, until WAKE-UP.  With SYNC return when it does.
REASON is for the reader."
  (declare (ignore reason))
  (need-task '(suspend))
  (unless (or (task-dead-p task) (task-suspended task))
    (setf (task-suspended task) t)
    (incf (scheduler-suspensions (task-scheduler task)))
    (if (within-p *current-task* task)
        (check-events (current-strand))
        (mapc #'wake (strands-within task)))
    (when (and sync (not (within-p *current-task* task)))
      (wait-for-tasks (list task)
                      (lambda ()
                        (or (task-dead-p task)
                            (not (task-suspended task))
                            (member (task-status task) '(:suspended :created)))))))
  task)

(defun wake-up (task &key reason sync)
  "Let TASK, which was suspended, and its children go on.  REASON is for the reader, SYNC without
effect: the task is ready when this returns."
  (declare (ignore reason sync))
  (need-task '(wake-up))
  (when (task-suspended task)
    (setf (task-suspended task) nil)
    (decf (scheduler-suspensions (task-scheduler task)))
    (mapc #'wake (strands-within task)))
  task)

(defun call-with-task-suspended (task reason function)
  (suspend task :reason reason)
  (unwind-protect (funcall function)
    (wake-up task)))

(defmacro with-task-suspended ((task &key reason) &body body)
  "Evaluate BODY while TASK is suspended, and wake it up afterwards.  Return the values of BODY."
  `(call-with-task-suspended ,task ,reason (lambda () ,@body)))

(defun call-with-suspension-handler (handler function)
  (let ((task (need-task '(on-suspension))))
    (push handler (task-suspension-handlers task))
    (unwind-protect (funcall function)
      (setf (task-suspension-handlers task) (delete handler (task-suspension-handlers task)
                                                    :count 1)))))

(defmacro on-suspension (when-suspended-form &body body)
  "Evaluate BODY and return its values.  Each time the current task is suspended meanwhile,
WHEN-SUSPENDED-FORM is evaluated in it."
  `(call-with-suspension-handler (lambda () ,when-suspended-form) (lambda () ,@body)))

(defun call-retrying-after-suspension (function)
  (loop
    (let ((again (list :again)))
      (catch again
        (return (call-with-suspension-handler (lambda () (throw again nil)) function)))
      ;; The task pauses here, out of BODY, until it is woken up.
      (check-events (current-strand)))))

(defmacro retry-after-suspension (&body body)
  "Evaluate BODY and return its values.  When the current task is suspended meanwhile, BODY is left,
and begins anew when the task is woken up."
  `(call-retrying-after-suspension (lambda () ,@body)))

(defun call-uninterrupted (flag function)
  (let* ((strand (task-strand (need-task '(without-scheduling))))
         (before (strand-uninterrupted strand)))
    (setf (strand-uninterrupted strand) flag)
    (unwind-protect (funcall function)
      (setf (strand-uninterrupted strand) before))))

(defmacro without-scheduling (&body body)
  "Evaluate BODY, in which no other task gets its turn unless BODY waits for something."
  `(call-uninterrupted t (lambda () ,@body)))

(defmacro with-scheduling (&body body)
  "Inside WITHOUT-SCHEDULING, evaluate BODY, in which other tasks may get their turn."
  `(call-uninterrupted nil (lambda () ,@body)))
