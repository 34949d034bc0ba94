;;;; Top-levels: a plan's program as a whole.
;;;;
;;;; TOP-LEVEL makes a scheduler and runs its body as the first task, on the thread of the caller.
;;;; What the body fails with is signaled there again, by ERROR, as the same condition.

(in-package #:discrepancy-finder.plan-language)

(defun make-top-level-scheduler ()
  (let* ((seed *scheduling-seed*)
         (scheduler (make-scheduler
                     :random (and (not (eql seed 0)) (sb-ext:seed-random-state seed))
                     :clock (or (executive-clock *executive*) (make-instance 'virtual-clock))
                     :handlers (border-handlers (current-handlers))
                     :outside (captured-bindings)
                     :outside-handlers (current-handlers)
                     :outside-restarts sb-kernel:*restart-clusters*
                     :outside-debugger-hook sb-ext:*invoke-debugger-hook*
                     :float-modes (sb-vm:floating-point-modes)))
         (main (make-strand :scheduler scheduler :state :running)))
    (setf (scheduler-main scheduler) main
          (scheduler-current scheduler) main
          (scheduler-live scheduler) (list main))
    scheduler))

;;; Ending strands from outside.  Once LEAVING is set, whoever gets the baton leaves its tasks and
;;; gives it to the main strand; one that is at work has to be interrupted.

(defun await-main-baton (scheduler)
  "Wait until the main strand has the baton.  Requests are not served any more."
  (let ((main (scheduler-main scheduler)))
    (loop until (eq (scheduler-current scheduler) main)
          do (sb-thread:wait-on-semaphore (strand-semaphore main))
             (let ((request (shiftf (scheduler-request scheduler) nil)))
               (when request
                 (sb-thread:signal-semaphore (strand-semaphore (request-strand request))))))))

(defun interrupt-strand (scheduler strand)
  "Let STRAND, which is at work on its worker's thread, leave its tasks."
  (let ((worker (strand-worker strand)))
    ;; Without a worker it is about to begin, and then leaves by itself.
    (when worker
      (handler-case
          (sb-thread:interrupt-thread
           (worker-thread worker)
           (lambda ()
             ;; It may have given the baton on, or have ended, before this is called.
             (when (and (strand-catching strand) (eq (scheduler-current scheduler) strand))
               (throw strand nil))))
        ;; The thread has ended: the strand has, too.
        (sb-thread:interrupt-thread-error () nil)))))

(defun take-baton-back (scheduler)
  "Stop the strand that has the baton, unless this is the main one; then that has it."
  (let ((main (scheduler-main scheduler)))
    (unless (eq (scheduler-current scheduler) main)
      (unless (scheduler-leaving scheduler)
        (setf (scheduler-leaving scheduler) (list :abort)))
      ;; Who gets the baton from now on sees that; who has it now may be at work.
      (let ((strand (scheduler-current scheduler)))
        (unless (eq strand main)
          (interrupt-strand scheduler strand)))
      (await-main-baton scheduler))))

(defun stop-strand (scheduler strand)
  "Let STRAND, which waits for the baton, leave its tasks, and return when it has ended."
  (cond ((null (strand-worker strand))  ; it has not begun
         (setf (scheduler-live scheduler) (delete strand (scheduler-live scheduler))))
        (t (hand-over strand)
           (await-main-baton scheduler))))

(defun end-scheduler (scheduler)
  "End all strands of SCHEDULER but the main one, if there are any left."
  (let ((main (scheduler-main scheduler)))
    (when (rest (scheduler-live scheduler))
      (unless (scheduler-leaving scheduler)
        (setf (scheduler-leaving scheduler) (list :abort)))
      (loop for strand = (find main (scheduler-live scheduler) :test-not #'eq)
            while strand
            do (stop-strand scheduler strand)))))

(defvar *implicit-task* nil
  "The task of an implicit top-level while the code that it is around runs, but in no task of
that.")

(defun outside-of-tasks-p ()
  "Return true where a top-level can be made: outside of any, or directly in an implicit one."
  (or (null *current-task*) (eq *current-task* *implicit-task*)))

(defun call-in-top-level (function &optional name)
  "Call FUNCTION as the body of a new top-level, whose task tree is kept under NAME if it is not
NIL, and return its values."
  (unless (outside-of-tasks-p)
    (error 'nested-top-level))
  (let* ((*current-task* nil)
         (scheduler (make-top-level-scheduler))
         (main (scheduler-main scheduler))
         (node (make-root-node name))
         (task (%make-task :name (or name "the top-level") :scheduler scheduler :strand main
                           :node node)))
    (push task (node-tasks node))
    (when name
      (setf (gethash name *top-level-trees*) node))
    (catch scheduler
      (unwind-protect
           (let ((sb-ext:*invoke-debugger-hook* (debugger-hook sb-ext:*invoke-debugger-hook*)))
             (run-task task function))
        (sb-sys:without-interrupts (end-scheduler scheduler))))
    (case (first (scheduler-leaving scheduler))
      (:error (error (second (scheduler-leaving scheduler))))
      ;; A cleanup form has waited for something: where to was lost.
      (:abort (error 'top-level-interrupted)))
    (ecase (task-status task)
      (:succeeded (values-list (task-result task)))
      (:failed (error (open-envelope (task-result task))))
      (:evaporated nil))))

(defun call-in-implicit-top-level (function)
  "Call FUNCTION, which may perform and may also make top-levels, and return its values: in a
top-level that gives way to those, unless one runs already.  FUNCTION itself is no plan: handlers
around it see what it signals at once, and an error of a task that it started as that error."
  (if *current-task*
      (funcall function)
      (let ((handlers (current-handlers)))
        (call-in-top-level (lambda ()
                             (let ((*implicit-task* *current-task*))
                               (with-handlers (handlers)
                                 (handler-bind ((common-lisp-error-envelope
                                                  (lambda (envelope)
                                                    (error (open-envelope envelope)))))
                                   (funcall function)))))))))

(defmacro top-level (&body body)
  "Evaluate BODY as a program of its own and return its values.  What it fails with is signaled
again by ERROR.  Top-levels cannot be nested: NESTED-TOP-LEVEL."
  `(call-in-top-level (lambda () ,@body)))

(defmacro named-top-level ((&key name) &body body)
  "The same as TOP-LEVEL; the task tree is kept under NAME, a symbol that is not evaluated, for
GET-TOP-LEVEL-TASK-TREE."
  `(call-in-top-level (lambda () ,@body) ',name))

(defmacro seq (&body body)
  "Evaluate the forms of BODY one after the other; return the values of the last."
  `(progn ,@body))
