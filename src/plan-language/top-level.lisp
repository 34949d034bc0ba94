;;;; Top-levels: a plan's program as a whole.
;;;;
;;;; TOP-LEVEL makes a scheduler and runs its body as the first task, on the thread of the caller.
;;;; What the body fails with is signaled there again, by ERROR, as the same condition.

(in-package #:discrepancy-finder.plan-language)

(defun make-top-level-scheduler ()
  (let* ((seed *scheduling-seed*)
         (scheduler (make-scheduler
                     :seed seed
                     :random (and (not (eql seed 0)) (sb-ext:seed-random-state seed))
                     :clock (or (executive-clock *executive*) (make-instance 'virtual-clock))
                     :handlers (border-handlers (current-handlers))
                     :outside (captured-bindings)
                     :outside-handlers (current-handlers)
                     :outside-restarts sb-kernel:*restart-clusters*
                     :thread sb-thread:*current-thread*
                     :float-modes (sb-vm:floating-point-modes)))
         (main (make-strand :scheduler scheduler :state :running
                            :semaphore (sb-thread:make-semaphore :name "top-level"))))
    (setf (scheduler-main scheduler) main
          (scheduler-current scheduler) main
          (scheduler-live scheduler) (list main))
    scheduler))

(defun stop-strand (scheduler strand)
  "Let STRAND, which is not the main one, leave its tasks and wait until it has ended."
  (cond ((strand-function strand)       ; it has not begun
         (setf (scheduler-live scheduler) (delete strand (scheduler-live scheduler))))
        (t
         (cond ((eq (strand-state strand) :requesting)
                (sb-thread:signal-semaphore (strand-semaphore strand)))
               ((eq (scheduler-current scheduler) strand)
                (sb-thread:interrupt-thread (worker-thread (strand-worker strand))
                                            (lambda () (throw strand nil))))
               (t (hand-over strand)))
         (sb-thread:wait-on-semaphore (strand-semaphore (scheduler-main scheduler))))))

(defun stop-current-strand (scheduler)
  "Stop the strand that has the baton, which is not the main one; then this has it."
  (unless (scheduler-leaving scheduler)
    (setf (scheduler-leaving scheduler) (list :abort)))
  (stop-strand scheduler (scheduler-current scheduler))
  (setf (scheduler-current scheduler) (scheduler-main scheduler)))

(defun end-scheduler (scheduler)
  "End all strands of SCHEDULER but the main one, if there are any left."
  (let ((main (scheduler-main scheduler)))
    (when (rest (scheduler-live scheduler))
      (unless (scheduler-leaving scheduler)
        (setf (scheduler-leaving scheduler) (list :abort)))
      (loop for strand = (find main (scheduler-live scheduler) :test-not #'eq)
            while strand
            do (stop-strand scheduler strand)))))

(defun call-in-top-level (function &optional name)
  "Call FUNCTION as the body of a new top-level, whose task tree is kept under NAME if it is not
NIL, and return its values."
  (when *current-task*
    (error 'nested-top-level))
  (let* ((scheduler (make-top-level-scheduler))
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
        (end-scheduler scheduler)))
    (case (first (scheduler-leaving scheduler))
      (:error (error (second (scheduler-leaving scheduler))))
      ;; A cleanup form has waited for something: where to was lost.
      (:abort (error 'top-level-interrupted)))
    (ecase (task-status task)
      (:succeeded (values-list (task-result task)))
      (:failed (error (open-envelope (task-result task))))
      (:evaporated nil))))

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
