;;;; Leaving a check when its thread is interrupted or its time is over.
;;;;
;;;; A check can take hours, and nothing may unwind through Z3's frames.  So the check runs without
;;;; interrupts, in the calling thread, and announces itself in its foreign context.  Meanwhile one
;;;; other thread, the watcher, looks every 20 ms whether an interrupt waits for the checking thread
;;;; (C-c, a timer, SB-THREAD:INTERRUPT-THREAD) and if so tells Z3 to stop.  The check returns, and
;;;; the interrupt runs, in Lisp.  If it returns, too (CONTINUE in the debugger), the check is made
;;;; again from the start; with each repetition the watcher's patience doubles, so that frequent
;;;; timers delay a long check but cannot prevent its end.
;;;;
;;;; Timeouts are the watcher's business, too: the timer of libz3 4.8.12 can end in a deadlock of
;;;; the checking thread, which nothing but SIGKILL ends, and doubles the time of a small check.
;;;;
;;;; The watcher is started by a check and ends after a second without one, or before an image is
;;;; saved.  Entry point: CALL-INTERRUPTIBLY.

(in-package #:discrepancy-finder.z3)

(defconstant +poll-interval+ 20000000
  "The time (ns) between two looks of the watcher.")

(defconstant +idle-polls+ 50
  "After so many looks without a check the watcher ends.")

(sb-ext:defglobal **watcher** nil
  "The thread that is the watcher, or NIL.")

(sb-ext:defglobal **watcher-lock** (sb-thread:make-mutex :name "Z3 watcher"))

;;; The watcher's side

(defun interrupt-waits-p (thread)
  "Return true if THREAD has been interrupted while it could not be.  An interrupt that comes by
INTERRUPT-THREAD is queued there; a signal that comes directly only sets the other mark."
  (or (sb-thread::thread-interruptions thread)
      (sb-thread:symbol-value-in-thread 'sb-unix::*interrupt-pending* thread nil)))

(defun reason-to-stop (foreign thread)
  "Return why the check in FOREIGN, made by THREAD, should end now, or NIL."
  (let ((age (- (foreign:monotonic-nanoseconds) (foreign-context-started foreign))))
    (cond ((and (>= age (foreign-context-patience foreign)) (interrupt-waits-p thread))
           :interrupt)
          ((>= age (foreign-context-time-limit foreign)) :timeout))))

(defun stop-if-needed (foreign)
  "Stop the check in FOREIGN if its thread has been interrupted or its time is over.  Return true if
there is a check."
  (let ((thread (foreign-context-checker foreign)))
    (when (typep thread 'sb-thread:thread)
      (let ((reason (reason-to-stop foreign thread)))
        (when reason
          (sb-sys:without-interrupts
            ;; From here on the check cannot return and so the context cannot be deleted.
            (when (eq (sb-ext:compare-and-swap (foreign-context-checker foreign)
                                               thread :interrupting)
                      thread)
              (setf (foreign-context-stopped foreign) reason)
              (z3-interrupt (foreign-context-pointer foreign))
              (setf (foreign-context-checker foreign) thread)))))
      t)))

(defun look-after-checks ()
  "Stop the checks that are to be stopped.  Return true if a check is running; the second value
changes whenever a check is made."
  (let ((running nil) (count 0))
    (dolist (foreign **open-contexts** (values running count))
      (incf count (foreign-context-check-count foreign))
      (when (stop-if-needed foreign)
        (setf running t)))))

(defun retire-watcher ()
  "End the office of the current thread as the watcher unless a check has just begun; return true
if it is over."
  (sb-thread:with-mutex (**watcher-lock**)
    (when (eq **watcher** sb-thread:*current-thread*)
      ;; A check announces itself first and looks for a watcher then; here it is the other way
      ;; round, so one of the two sees the other.
      (setf **watcher** nil)
      (sb-thread:barrier (:memory))
      (when (look-after-checks)
        (setf **watcher** sb-thread:*current-thread*)))
    (null **watcher**)))

(defun watch ()
  (sb-thread:with-mutex (**watcher-lock**)) ; until the starter has made this thread the watcher
  (unwind-protect
       (loop with idle = 0 and last-count = 0
             while (eq **watcher** sb-thread:*current-thread*)
             do (sleep (/ +poll-interval+ 1000000000))
                (multiple-value-bind (running count) (look-after-checks)
                  (setf idle (if (or running (/= count last-count)) 0 (1+ idle))
                        last-count count))
                (when (and (> idle +idle-polls+) (retire-watcher))
                  (return)))
    ;; The thread may have been terminated from outside.
    (sb-ext:compare-and-swap (symbol-value '**watcher**) sb-thread:*current-thread* nil)))

(defun start-watcher ()
  (sb-thread:with-mutex (**watcher-lock**)
    (unless **watcher**
      (setf **watcher** (sb-thread:make-thread #'watch :name "Z3 watcher")))))

(defun stop-watcher ()
  "End the watcher; a later check starts another."
  (let ((watcher (sb-thread:with-mutex (**watcher-lock**) (shiftf **watcher** nil))))
    (when watcher
      (sb-thread:join-thread watcher :default nil))))

(pushnew 'stop-watcher sb-ext:*save-hooks*)

;;; The check's side

(defun announce-check (foreign patience time-limit)
  "Tell the watcher that this thread begins a check in FOREIGN.  Return true if nobody else is in
one."
  (when (null (sb-ext:compare-and-swap (foreign-context-checker foreign) nil :starting))
    (setf (foreign-context-stopped foreign) nil
          (foreign-context-patience foreign) patience
          (foreign-context-time-limit foreign) time-limit
          (foreign-context-started foreign) (foreign:monotonic-nanoseconds))
    (incf (foreign-context-check-count foreign))
    (setf (foreign-context-checker foreign) sb-thread:*current-thread*)
    (sb-thread:barrier (:memory))
    (unless **watcher**
      (start-watcher))
    t))

(defun time-limit (seconds)
  "Return SECONDS, a real or NIL for ever, in nanoseconds."
  (if seconds
      (min most-positive-fixnum (ceiling (* 1000000000 (rational seconds))))
      most-positive-fixnum))

(defvar *on-check* nil
  "NIL, or a function of the wall-clock time (s, a double float) of a check, called after each that
this thread makes, in whatever context.")

(defun end-check (foreign)
  "Tell the watcher that the check in FOREIGN is over, once it has its hands off it."
  (let ((time (- (foreign:monotonic-nanoseconds) (foreign-context-started foreign))))
    (incf (foreign-context-check-time foreign) time)
    (when *on-check*
      (funcall *on-check* (* 1d-9 time))))
  (loop until (eq (sb-ext:compare-and-swap (foreign-context-checker foreign)
                                           sb-thread:*current-thread* nil)
                  sb-thread:*current-thread*)
        do (sb-thread:thread-yield)))

(defun call-interruptibly (context function timeout)
  "Call FUNCTION, which makes one check in CONTEXT, without interrupts; return its two values, of
which the first is :UNKNOWN if Z3 gave no answer.  After TIMEOUT seconds (NIL: never) it is stopped
within a fiftieth of a second, and the second value is \"timeout\".  If an interrupt came, it runs
after the call; if it returns, and Z3 gave no answer, FUNCTION is called again.  Signals Z3-ERROR if
CONTEXT is in use by another thread."
  (loop with foreign = (context-foreign context)
        with time-limit = (time-limit timeout)
        ;; Where the caller has shut out interrupts they are shut out of the check, too.
        for patience = (if sb-sys:*interrupts-enabled* 0 most-positive-fixnum)
          then (max +poll-interval+ (* 2 patience))
        do (multiple-value-bind (answer reason)
               (sb-sys:without-interrupts
                 (if (announce-check foreign patience time-limit)
                     (unwind-protect (funcall function)
                       (end-check foreign))
                     (foreign-context-checker foreign)))
             (case answer
               (:closed (misuse :closed-context "the context is closed"))
               ((:sat :unsat) (return answer))
               (:unknown (case (foreign-context-stopped foreign)
                           ((nil) (return (values answer reason)))
                           (:timeout (return (values answer "timeout")))))
               (t (misuse :busy-context "the context is in use by another thread"))))))
