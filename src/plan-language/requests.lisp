;;;; Requests: what has to be done on the thread of the top-level.
;;;;
;;;; Solvers and physics, the user's handlers, restarts and debugger belong to the thread that has
;;;; entered the top-level.  It has nothing to do while a strand runs on a worker's thread, so this
;;;; strand can ask it, by CALL-ON-MAIN, to call a function there, in the dynamic environment around
;;;; the top-level.  Executives run all their machinery so.

(in-package #:discrepancy-finder.plan-language)

(defstruct (request (:constructor make-request (strand function)) (:copier nil))
  "What STRAND asks for.  RESULT is the list of the values of FUNCTION, FAILURE the plan failure
that it ended with."
  (strand nil :read-only t)
  (function nil :read-only t)
  (result '() :type list)
  (failure nil))

(defun serve (scheduler request)
  "On the thread of the top-level of SCHEDULER, do what REQUEST says and tell who has asked."
  (call-hiding
   0 (scheduler-outside scheduler)
   (lambda ()
     (let ((*current-task* nil)
           (sb-kernel:*handler-clusters* (scheduler-outside-handlers scheduler))
           (sb-kernel:*restart-clusters* (scheduler-outside-restarts scheduler)))
       (handler-case
           (setf (request-result request)
                 (multiple-value-list (funcall (the function (request-function request)))))
         (plan-failure (failure)
           (setf (request-failure request) failure))))))
  (sb-thread:signal-semaphore (strand-semaphore (request-strand request))))

(defun call-on-main (function)
  "Call FUNCTION without arguments on the thread that has entered the top-level, and return its
values.  When this is not the current thread, that happens in the dynamic environment around the
top-level, and a plan failure in it is one of the caller."
  (let* ((strand (and *current-task* (current-strand)))
         (scheduler (and strand (strand-scheduler strand))))
    (if (or (null strand) (eq strand (scheduler-main scheduler)))
        (funcall (the function function))
        (let ((request (make-request strand function))
              (state (shiftf (strand-state strand) :requesting)))
          (setf (scheduler-request scheduler) request)
          (sb-thread:signal-semaphore (strand-semaphore (scheduler-main scheduler)))
          (sb-thread:wait-on-semaphore (strand-semaphore strand))
          (setf (strand-state strand) state)
          ;; One that gives the baton on only asks who is next.
          (cond ((eq state :done))
                ((scheduler-leaving scheduler) (throw strand nil))
                ((eq state :running) (check-events strand)))
          (if (request-failure request)
              (fail (request-failure request))
              (values-list (request-result request)))))))
