;;;; Workers: pooled threads for the strands of plans.
;;;;
;;;; A strand that runs beside others needs a stack of its own, hence a thread.  EMPLOY gives it an
;;;; idle worker or a new one.  Idle workers wait; DISMISS-WORKERS ends them, which an image must do
;;;; before it is saved.

(in-package #:discrepancy-finder.plan-language)

(defstruct (worker (:copier nil))
  "A thread that runs one job, a function, after the other.  JOB is NIL to end it."
  (semaphore (sb-thread:make-semaphore :name "job") :read-only t)
  (job nil)
  (thread nil))

(defparameter *idle-worker-limit* 32
  "So many workers are kept for later use.")

(sb-ext:defglobal *idle-workers* '()
  "The workers that wait for a job.")
(sb-ext:defglobal *idle-workers-lock* (sb-thread:make-mutex :name "idle workers"))

(defun work (worker)
  (loop
    (sb-thread:wait-on-semaphore (worker-semaphore worker))
    (let ((job (worker-job worker)))
      (unless job (return))
      (setf (worker-job worker) nil)
      (funcall (the function job)))))

(defun employ (job note)
  "Let a worker run the function JOB; before it begins NOTE is called with it."
  (let ((worker (or (sb-thread:with-mutex (*idle-workers-lock*) (pop *idle-workers*))
                    (make-worker))))
    (setf (worker-job worker) job)
    (unless (worker-thread worker)
      (setf (worker-thread worker)
            (sb-thread:make-thread #'work :arguments (list worker) :name "strand of a plan")))
    (funcall note worker)
    (sb-thread:signal-semaphore (worker-semaphore worker))))

(defun rest-worker (worker)
  "Take WORKER, whose job is about to end, back into the pool."
  (unless (sb-thread:with-mutex (*idle-workers-lock*)
            (when (< (length *idle-workers*) *idle-worker-limit*)
              (push worker *idle-workers*)))
    ;; Nobody gives it a job any more: it finds none and ends.
    (sb-thread:signal-semaphore (worker-semaphore worker))))

(defun dismiss-workers ()
  "End all idle threads of the pool."
  (let ((workers (sb-thread:with-mutex (*idle-workers-lock*)
                   (shiftf *idle-workers* '()))))
    (dolist (worker workers)
      (sb-thread:signal-semaphore (worker-semaphore worker)))
    (dolist (worker workers)
      (sb-thread:join-thread (worker-thread worker) :default nil))))

(pushnew 'dismiss-workers sb-ext:*save-hooks*)
(pushnew 'dismiss-workers sb-ext:*exit-hooks*)
