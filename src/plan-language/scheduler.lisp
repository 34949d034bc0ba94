;;;; The scheduler: one strand runs at a time, and which one is a function of program and seed.
;;;;
;;;; There is one baton in a top-level.  A strand keeps it until it blocks (BLOCK-STRAND), gives way
;;;; (YIELD) or ends; then the strand gets it that has been ready for longest or, with a seed other
;;;; than 0, one that a generator of random numbers picks.  When every strand waits, time passes
;;;; until the first deadline; when there is none either, the program is in a DEADLOCK.
;;;;
;;;; A strand that gets the baton back looks first whether its tasks are to be left (an executive
;;;; leaves the plan, the task evaporates) or suspended: CHECK-EVENTS in task-control.lisp.

(in-package #:discrepancy-finder.plan-language)

(defstruct (scheduler (:copier nil))
  "The state of a top-level.  READY is a queue of strands, SLEEPERS a list of (deadline ticket .
strand) in the order of deadlines, LIVE the strands that have not ended.  LEAVING is NIL or a list:
(:tag tag value) or (:error condition) or (:abort).  HANDLERS are for all tasks.  OUTSIDE are the
bindings, OUTSIDE-HANDLERS and OUTSIDE-RESTARTS what was in force around the top-level.  REQUEST is
what a strand asks the thread of the top-level to do (requests.lisp)."
  (main nil)
  (current nil)
  (ready (make-queue))
  (sleepers '() :type list)
  (live '() :type list)
  (count 0 :type fixnum)
  (begun 0 :type fixnum)
  (idle-since nil)
  (clock nil)
  (random nil)
  (suspensions 0 :type fixnum)
  (leaving nil)
  (handlers '())
  (outside '())
  (outside-handlers '())
  (outside-restarts '())
  (outside-debugger-hook nil)
  (request nil)
  (float-modes '()))

(defmethod print-object ((scheduler scheduler) stream)
  (print-unreadable-object (scheduler stream :type t :identity t)
    (format stream "~d strand~:p" (length (scheduler-live scheduler)))))

(defparameter *scheduling-seed* 0
  "The seed of the order in which tasks take turns.  With 0 they take turns in a fixed order, the
one that has been ready for longest first; other seeds pick at random, each always in the same
way.")

(defparameter *strand-limit* 6000
  "So many parallel tasks of a top-level can be under way at the same time; each has a thread.")

(defparameter *idle-limit* 3600
  "When nothing but policy checks has run for so many seconds of the clock, it is a deadlock.")

;;; Queues

(defstruct (queue (:copier nil))
  (head '() :type list)
  (tail '() :type list))

(defun enqueue (item queue)
  (let ((cell (list item)))
    (if (queue-head queue)
        (setf (rest (queue-tail queue)) cell)
        (setf (queue-head queue) cell))
    (setf (queue-tail queue) cell)))

(defun dequeue (queue position)
  "Remove the item at POSITION from QUEUE and return it."
  (if (zerop position)
      (pop (queue-head queue))
      (let* ((before (nthcdr (1- position) (queue-head queue)))
             (item (second before)))
        (when (eq (rest before) (queue-tail queue))
          (setf (queue-tail queue) before))
        (setf (rest before) (cddr before))
        item)))

;;; Choosing the next strand

(defgeneric choose-strand (executive scheduler count)
  (:documentation "Return which of the COUNT ready strands of SCHEDULER, 0 to COUNT - 1 in the order
in which they became ready, gets the baton.  An executive that explores all orders has a method.")
  (:method (executive scheduler count)
    (declare (ignore executive))
    (if (scheduler-random scheduler)
        (random count (scheduler-random scheduler))
        0)))

(defgeneric begin-turn (executive strand)
  (:documentation "Called when STRAND, a ready one, was chosen to get the baton.")
  (:method (executive strand) (declare (ignore executive strand))))

(defun ready-strands (scheduler)
  "Return the strands of SCHEDULER that are ready, in the order in which they became so."
  (queue-head (scheduler-ready scheduler)))

(defun make-ready (strand)
  (setf (strand-state strand) :ready)
  (enqueue strand (scheduler-ready (strand-scheduler strand))))

(defun wake-sleepers (scheduler)
  "Make the strands whose deadline is past ready."
  (when (scheduler-sleepers scheduler)
    (let ((now (clock-time (scheduler-clock scheduler))))
      (loop while (and (scheduler-sleepers scheduler)
                       (<= (first (first (scheduler-sleepers scheduler))) now))
            do (destructuring-bind (ticket . strand) (rest (pop (scheduler-sleepers scheduler)))
                 (when (and (eq (strand-state strand) :waiting) (eql ticket (strand-ticket strand)))
                   (setf (strand-timed-out strand) t)
                   (make-ready strand)))))))

(defun next-deadline (scheduler)
  "Return the deadline of the strand that sleeps for the shortest time, or NIL if none sleeps."
  (loop while (and (scheduler-sleepers scheduler)
                   (destructuring-bind (ticket . strand) (rest (first (scheduler-sleepers
                                                                       scheduler)))
                     (not (and (eq (strand-state strand) :waiting)
                               (eql ticket (strand-ticket strand))))))
        do (pop (scheduler-sleepers scheduler)))
  (first (first (scheduler-sleepers scheduler))))

(defun idle-too-long-p (scheduler strand)
  "Note that STRAND goes on.  Return true if only pollers have for too long."
  (let ((now (clock-time (scheduler-clock scheduler))))
    (cond ((not (strand-poller strand))
           (setf (scheduler-idle-since scheduler) nil))
          ((null (scheduler-idle-since scheduler))
           (setf (scheduler-idle-since scheduler) now)
           nil)
          (t (and (> now (+ (scheduler-idle-since scheduler) *idle-limit*))
                  (notany (lambda (sleeper) (not (strand-poller (cddr sleeper))))
                          (scheduler-sleepers scheduler)))))))

(defun pick-ready (scheduler)
  "Remove the strand that goes on next from the ready ones and return it."
  (let* ((ready (scheduler-ready scheduler))
         (strands (queue-head ready))
         (position (if (rest strands)
                       ;; Nobody chooses for a plan that is being left.
                       (or (choose-strand *executive* scheduler (length strands)) 0)
                       0)))
    (begin-turn *executive* (nth position strands))
    (dequeue ready position)))

(defun next-strand (scheduler)
  "Return the strand that goes on next.  In a deadlock, or when too many strands are at work at the
same time, that is the main one, which is told."
  (flet ((give-up (condition)
           (setf (scheduler-leaving scheduler) (list :error condition))
           (return-from next-strand (scheduler-main scheduler))))
    (loop
      (wake-sleepers scheduler)
      (if (queue-head (scheduler-ready scheduler))
          (let ((strand (pick-ready scheduler)))
            (cond ((idle-too-long-p scheduler strand)
                   (give-up (make-deadlock scheduler)))
                  ((and (strand-function strand)
                        (>= (incf (scheduler-begun scheduler)) *strand-limit*))
                   (give-up (make-condition 'too-many-tasks
                                            :task (task-text (strand-task strand))
                                            :limit *strand-limit*))))
            (return strand))
          (let ((deadline (next-deadline scheduler)))
            (unless deadline
              (give-up (make-deadlock scheduler)))
            (pass-time scheduler (- deadline (clock-time (scheduler-clock scheduler)))))))))

(defun pass-time (scheduler seconds)
  "Let SECONDS pass.  A clock that is a simulation is no business of the plan."
  (let ((clock (scheduler-clock scheduler)))
    (if (typep clock 'virtual-clock)
        (let-time-pass clock seconds)
        (call-on-main (lambda ()
                        (with-handlers ((scheduler-outside-handlers scheduler))
                          (let-time-pass clock seconds)))))))

(defun make-deadlock (scheduler)
  (make-condition 'deadlock
                  :waiting (loop for strand in (reverse (scheduler-live scheduler))
                                 when (eq (strand-state strand) :waiting)
                                   collect (cons (task-text (strand-task strand))
                                                 (waiting-text (strand-waiting strand))))))

(defun waiting-text (waiting)
  (if (functionp waiting) (funcall waiting) (princ-to-string waiting)))

;;; The baton

(defun hand-over (strand)
  "Give the baton to STRAND, another one than that of the caller."
  (let ((scheduler (strand-scheduler strand)))
    (setf (scheduler-current scheduler) strand
          (strand-state strand) :running)
    (if (strand-function strand)
        (employ (shiftf (strand-function strand) nil)
                (lambda (worker) (setf (strand-worker strand) worker)))
        (sb-thread:signal-semaphore (strand-semaphore strand)))))

(defun pass-baton (strand next)
  "Give the baton of STRAND to NEXT and return when STRAND has it again."
  (let ((scheduler (strand-scheduler strand)))
    (if (eq strand (scheduler-main scheduler))
        (pass-baton-of-main scheduler next)
        (progn (hand-over next)
               (sb-thread:wait-on-semaphore (strand-semaphore strand))))))

(defun pass-baton-of-main (scheduler next)
  "Give the baton of the main strand to NEXT, serve the requests of others, and return when the main
strand has it again.  Left in another way, by a handler around the top-level or by the user, it
takes the baton back before the stack is unwound any further."
  (let* ((main (scheduler-main scheduler))
         (semaphore (strand-semaphore main))
         (back nil))
    (unwind-protect
         (progn
           (sb-sys:without-interrupts (hand-over next))
           (loop
             (sb-thread:wait-on-semaphore semaphore)
             (let ((request (shiftf (scheduler-request scheduler) nil)))
               (cond (request (serve scheduler request))
                     ;; A signal may be left over from a wait that was interrupted.
                     ((eq (scheduler-current scheduler) main)
                      (setf back t)
                      (return))))))
      (unless back
        (sb-sys:without-interrupts (take-baton-back scheduler))))))

(defun switch (strand)
  "Let the next strand run, and return when STRAND, the caller's, has the baton again."
  (let ((next (next-strand (strand-scheduler strand))))
    (if (eq next strand)
        (setf (strand-state strand) :running)
        (pass-baton strand next))))

(defun current-strand ()
  (task-strand *current-task*))

(defun await-turn (strand waiting &optional deadline)
  "Let STRAND, the current one, wait until somebody wakes it or DEADLINE is past."
  (setf (strand-state strand) :waiting
        (strand-waiting strand) waiting
        (strand-timed-out strand) nil)
  (incf (strand-ticket strand))
  (when deadline
    (let ((scheduler (strand-scheduler strand)))
      (setf (scheduler-sleepers scheduler)
            (merge 'list (scheduler-sleepers scheduler)
                   (list (list* deadline (strand-ticket strand) strand))
                   #'< :key #'first))))
  (switch strand)
  (when (and deadline (not (strand-timed-out strand)))
    ;; Woken before: else the sleeps of ended strands would pile up.
    (let ((scheduler (strand-scheduler strand)))
      (setf (scheduler-sleepers scheduler)
            (delete strand (scheduler-sleepers scheduler) :key #'cddr))))
  (setf (strand-waiting strand) nil))

(defun block-strand (waiting &key deadline)
  "Let other strands run until somebody wakes the current one or, if there is a DEADLINE (s), this
is past.  WAITING says for what, in words or as a function that returns them.  Return false if the
deadline is past.  A strand may also be woken without reason."
  (let ((strand (current-strand)))
    (check-events strand)
    (await-turn strand waiting deadline)
    (check-events strand)
    (not (strand-timed-out strand))))

(defun wake (strand)
  "Make STRAND ready if it waits."
  (when (eq (strand-state strand) :waiting)
    (make-ready strand)))

(defun alone-p (scheduler)
  "Return true if no other strand than the current one is there."
  (null (rest (scheduler-live scheduler))))

(defun yield ()
  "Let the strands go on that are ready, if there are some, before the current one does."
  (when *current-task*
    (let* ((strand (current-strand))
           (scheduler (strand-scheduler strand)))
      (cond ((strand-uninterrupted strand))
            ((and (alone-p scheduler) (null (scheduler-leaving scheduler))
                  (zerop (scheduler-suspensions scheduler))
                  (null (task-evaporation *current-task*))))
            (t
             (wake-sleepers scheduler)
             (when (queue-head (scheduler-ready scheduler))
               (make-ready strand)
               (switch strand))
             (check-events strand))))))
