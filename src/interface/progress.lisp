;;;; Progress: what a command is doing, in one line on a terminal.
;;;;
;;;; The line is on standard error, is written over again and again, and is gone at the end.  Where
;;;; standard error is no terminal nothing is written.  CALL-WITH-PROGRESS is for a search, which
;;;; tells how far it is; while it runs, C-c and SIGTERM let it end after the simulation it is at,
;;;; with what it has found; the second time they end the process.  TELLING is for all else: a
;;;; thread of its own writes the line.

(in-package #:discrepancy-finder)

(defparameter *progress-interval* 0.1d0
  "The least time (s) between two changes of the line in one phase.")

(defparameter *phase-texts*
  '((:explore . "exploring the plan") (:reuse . "retrying stored discrepancies")
    (:generate . "simulating") (:target . "simulating where it may fail")
    (:confirm . "confirming") (:shrink . "shrinking") (:explain . "explaining")
    (:store . "storing"))
  "What the phases of a search are called in the line.")

(defun terminal-p (stream)
  "Return true if STREAM is a terminal on which a line can be written over."
  (and (interactive-stream-p stream)
       (not (equal (uiop:getenv "TERM") "dumb"))))

(defun progress-text (&key phase trace (simulations 0) (discrepancies 0) (seconds 0)
                        &allow-other-keys)
  "Return the line for what a search reports, see the option PROGRESS of FIND-DISCREPANCIES."
  (format nil "~a~@[, trace ~d~], ~d simulation~:p~@[, ~d kind~:p of discrepancies~], ~d s"
          (or (cdr (assoc phase *phase-texts*)) (string-downcase phase))
          (and trace (plusp trace) trace) simulations
          (and (plusp discrepancies) discrepancies) (floor seconds)))

(defun write-progress (text stream)
  "Write TEXT, at most 78 characters of it, over the line on STREAM."
  (format stream "~c~a~c[K" #\Return (subseq text 0 (min 78 (length text))) #\Escape)
  (finish-output stream))

(defun clear-progress (stream)
  (write-progress "" stream))

(defun progress-function (stream)
  "Return a function for the option PROGRESS of a search that writes its line on STREAM, or NIL if
that is no terminal."
  (when (terminal-p stream)
    (let ((last nil) (last-phase nil))
      (lambda (&rest report)
        (let ((now (foreign:monotonic-seconds)) (phase (getf report :phase)))
          (when (or (null last) (not (eq phase last-phase))
                    (>= (- now last) *progress-interval*))
            (setf last now last-phase phase)
            (write-progress (apply #'progress-text report) stream)))))))

;;; Interruption

(defun call-stopping-on-signals (function)
  "Call FUNCTION; SIGINT and SIGTERM ask searches to end with what they have found, and end the
process the second time."
  (let ((asked nil))
    (flet ((handler (status)
             (lambda (&rest signal)
               (declare (ignore signal))
               (when asked (leave status))
               (setf asked t)
               (format *error-output* "~&interrupted: the search ends after this simulation~%")
               (finish-output *error-output*)
               (discrepancy:request-stop))))
      (sb-sys:enable-interrupt sb-unix:sigint (handler 130))
      (sb-sys:enable-interrupt sb-unix:sigterm (handler 143))
      (unwind-protect (funcall function)
        (sb-sys:enable-interrupt sb-unix:sigint #'sb-unix::sigint-handler)
        (sb-sys:enable-interrupt sb-unix:sigterm #'terminate)))))

(defun call-with-progress (function)
  "Call FUNCTION with a function for the option PROGRESS of a search, or NIL, and return its values;
signals are taken as above."
  (let ((progress (progress-function *error-output*)))
    (unwind-protect (call-stopping-on-signals (lambda () (funcall function progress)))
      (when progress
        (clear-progress *error-output*)))))

;;; What is no search

(defun call-telling (what function)
  "Call FUNCTION and return its values.  On a terminal, from the first second on, a line tells WHAT
is being done, a string or a function that returns one, with how many simulations and how long."
  (let ((stream *error-output*) (start (foreign:monotonic-seconds))
        (meter (discrepancy:make-meter)) (done (sb-thread:make-semaphore)))
    (flet ((tell ()
             (loop until (sb-thread:wait-on-semaphore done :timeout 1)
                   for simulations = (discrepancy:meter-simulations meter)
                   do (write-progress
                       (format nil "~a~@[, ~d simulation~:p~], ~d s"
                               (if (functionp what) (funcall what) what)
                               (and (plusp simulations) simulations)
                               (floor (- (foreign:monotonic-seconds) start)))
                       stream))))
      (if (terminal-p stream)
          (let ((teller (sb-thread:make-thread #'tell :name "progress")))
            (unwind-protect (discrepancy:with-meter (meter) (funcall function))
              (sb-thread:signal-semaphore done)
              (sb-thread:join-thread teller)
              (clear-progress stream)))
          (funcall function)))))

(defmacro telling ((what) &body body)
  "Evaluate BODY while a line on a terminal tells WHAT is being done."
  `(call-telling ,what (lambda () ,@body)))
