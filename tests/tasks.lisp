;;;; Tasks: determinism, deadlocks, many and deep tasks, threads, interrupts, images.
;;;;
;;;; What each operator does in its corner cases is shown, and tested, by docs/plan-language.md.

(in-package #:discrepancy-finder.tests)

(def-suite tasks :in all)
(in-suite tasks)

(defun plan-threads ()
  "Return the number of the threads that run strands of plans or wait to."
  (count "strand of a plan" (sb-thread:list-all-threads)
         :key #'sb-thread:thread-name :test #'equal))

(defun idle-workers ()
  (length discrepancy-finder.plan-language::*idle-workers*))

(defun busy-threads ()
  "Return the number of threads of plans that are not idle, once those that are ending have ended."
  (loop repeat 1000
        for busy = (- (plan-threads) (idle-workers))
        until (zerop busy) do (sleep 1/1000)
        finally (return busy)))

;;; The same events every time

(defun eventful-plan ()
  "Run a plan with all that may go wrong."
  (plan:top-level
    (let ((door (plan:make-fluent :name "door"))
          (tries 0))
      (plan:with-failure-handling
          ((plan:gripper-goal-not-reached ()
             (note-event (list :handled tries (plan:now)))
             (if (< tries 2) (plan:retry) (return :given-up))))
        (incf tries)
        (plan:par
          (plan:pursue
            (progn (plan:wait-for door :timeout 2) (note-event :door))
            (unwind-protect (plan:sleep* 5) (note-event :cleanup)))
          (plan:par-loop (x '(1 2))
            (note-event (fetch-something x)))
          (progn (plan:sleep* 1/2)
                 (note-event (plan:try-all (plan:fail) (plan:fail "x") (fetch-something 4)))
                 (setf (plan:value door) tries))
          (progn (plan:sleep* 1) (fetch-something 3)))))))

(test the-same-events-every-time
  (let ((events (events-of #'eventful-plan)))
    (is (< 15 (length events)))
    (is (loop repeat (if *long* 10000 1000)
              always (equal events (events-of #'eventful-plan))))))

(test the-same-events-for-each-seed
  (flet ((events (seed)
           (let ((plan:*scheduling-seed* seed)) (events-of #'eventful-plan))))
    (loop for seed in '(1 2 1234567)
          for events = (events seed)
          do (is (loop repeat (if *long* 10000 100) always (equal events (events seed)))))
    (is (< 5 (length (remove-duplicates (loop for seed below 20 collect (events seed))
                                        :test #'equal))))))

(test seeds-give-all-orders
  (let ((orders (loop for seed from 1 to 200
                      collect (let ((plan:*scheduling-seed* seed))
                                (events-of (lambda ()
                                             (plan:top-level
                                               (plan:par (note-event 1) (note-event 2)
                                                         (note-event 3)))))))))
    (is (= 6 (length (remove-duplicates orders :test #'equal))))))

;;; Deadlock

(test a-deadlock-names-each-task-and-what-it-waits-for
  (signals-with (plan:deadlock "par branch 1 waits for the fluent door"
                               "par branch 2 waits for a fluent without a name"
                               "the top-level waits for the end of par branch 1, par branch 2")
    (plan:top-level
      (plan:par (plan:wait-for (plan:make-fluent :name "door"))
                (plan:wait-for (plan:make-fluent)))))
  (handler-case (plan:top-level (plan:wait-for (plan:make-fluent :name "door")))
    (plan:deadlock (condition)
      (is (equal '(("the top-level" . "the fluent door")) (plan:deadlock-waiting condition))))))

(test a-deadlock-runs-cleanup-forms
  (is (equal '(:outer :inner)
             (events-of (lambda ()
                          (signals plan:deadlock
                            (plan:top-level
                              (unwind-protect
                                   (plan:par (unwind-protect (plan:wait-for (plan:make-fluent))
                                               (note-event :inner))
                                             1)
                                (note-event :outer)))))))
      "the cleanup forms of a task before those of its children, as when it evaporates")
  (is (= 0 (busy-threads))))

;;; Many and deep

(defun nested-pars (depth)
  (if (plusp depth)
      (1+ (plan:par (nested-pars (1- depth)) (plan:sleep* 1)))
      0))

(test nested-pars-are-limited-by-threads-only
  ;; Each level has two strands beside that of its parent.
  (let ((depth (if *long* 1000 100)))
    (is (= depth (plan:top-level (nested-pars depth))))
    (is (= 0 (busy-threads)))))

(test thousands-of-pars-one-after-the-other
  (is (= 3000 (plan:top-level (loop repeat 3000 sum (plan:par 1 (plan:par 2 3)))))))

(test a-thousand-branches
  (let ((elements (loop for i below 1000 collect i)))
    (is (equal elements
               (events-of (lambda ()
                            (plan:top-level
                              (plan:par-loop (i elements) (plan:sleep* 1) (note-event i))))))))
  (is (= 0 (busy-threads)))
  (is (<= (plan-threads) discrepancy-finder.plan-language::*idle-worker-limit*)))

(plan:def-cram-function count-deep (n)
  (if (plusp n) (1+ (count-deep (1- n))) 0))

(plan:def-cram-function fail-deep (n)
  (if (plusp n) (fail-deep (1- n)) (plan:fail 'plan:torso-goal-not-reached)))

(test deep-recursion
  (is (= 1000 (plan:top-level (count-deep 1000))))
  (is (= 200 (plan:top-level (plan:par (count-deep 200) (plan:sleep* 1)))))
  (signals plan:torso-goal-not-reached (plan:top-level (fail-deep 1000)))
  (signals plan:torso-goal-not-reached
    (plan:top-level (plan:par (fail-deep 200) (plan:sleep* 1))))
  (is (= 0 (busy-threads))))

(test no-end-to-a-recursion
  "A stack that is full ends the plan with an error; the next plan runs."
  (signals plan:tasks-nested-too-deeply (plan:top-level (count-deep 1000000)))
  (is (= 10 (plan:top-level (count-deep 10)))))

(test top-levels-leave-nothing-behind
  (flet ((run-them (count)
           (loop repeat count
                 do (plan:top-level
                      (plan:par 1 (plan:pursue (plan:sleep* 1) (plan:sleep* 2)))))))
    (run-them 100)
    (sb-ext:gc :full t)
    (let ((bytes (sb-kernel:dynamic-usage)))
      (run-them (if *long* 10000 1000))
      (is (<= (plan-threads) discrepancy-finder.plan-language::*idle-worker-limit*))
      (is (= 0 (busy-threads)))
      (sb-ext:gc :full t)
      (is (< (- (sb-kernel:dynamic-usage) bytes) 4000000)))))

(defun perform-often (count)
  "Perform a motion COUNT times and return the recorder that has performed it."
  (let ((recorder (make-instance 'recorder)))
    (plan:with-executive (recorder)
      (plan:named-top-level (:name :many)
        (loop repeat count do (plan:perform (plan:a motion (type going))))))
    recorder))

(test many-performs-are-linear
  "The memory that n performs take grows as n does."
  (flet ((bytes-a-perform (count)
           (let ((before (sb-ext:get-bytes-consed)))
             (perform-often count)
             (/ (- (sb-ext:get-bytes-consed) before) count))))
    (bytes-a-perform 100)
    (let ((few (bytes-a-perform 1000))
          (many (bytes-a-perform (if *long* 100000 20000))))
      (is (< many (* 1.5 few)) "~d bytes a perform, then ~d" (round few) (round many)))))

(test many-performs-have-a-node-each
  (let ((count (if *long* 100000 5000)))
    (is (= count (length (performed (perform-often count)))))
    (let ((children (plan:task-tree-node-children (plan:get-top-level-task-tree :many))))
      (is (= count (length children)))
      (is (equal (list :call count)
                 (first (plan:task-tree-node-path (first (last children)))))))))

;;; Threads

(test two-top-levels-in-two-threads
  (flet ((log-of (seed)
           (let ((plan:*scheduling-seed* seed) (log '()))
             (plan:top-level
               (plan:par-loop (x '(1 2 3 4))
                 (dotimes (i 20)
                   (plan:sleep* (/ x 10))
                   (push (list x i (plan:now)) log))))
             log)))
    (let ((expected (list (log-of 0) (log-of 5))))
      (loop repeat 20
            do (let ((threads (list (sb-thread:make-thread #'log-of :arguments (list 0))
                                    (sb-thread:make-thread #'log-of :arguments (list 5)))))
                 (is (equal expected (mapcar #'sb-thread:join-thread threads))))))))

(test a-top-level-in-a-thread-that-a-plan-starts
  "It is a program of its own."
  (is (= 7 (plan:top-level
             (plan:par (sb-thread:join-thread
                        (sb-thread:make-thread (lambda () (plan:top-level (plan:par 7 8)))))
                       1)))))

;;; Interrupts, as C-c and aborting from the debugger

(defun call-interrupted (begun-p function)
  "Call FUNCTION in a thread and, when the function BEGUN-P returns true, interrupt the thread so
that it is left.  Return :LEFT if that has happened, else what FUNCTION returns or signals."
  (let ((thread (sb-thread:make-thread
                 (lambda ()
                   (catch 'abort-to-prompt
                     (handler-case (funcall function)
                       (error (condition) condition)))))))
    (loop until (funcall begun-p) do (sleep 1/1000))
    (sb-thread:interrupt-thread thread (lambda () (throw 'abort-to-prompt :left)))
    (sb-thread:join-thread thread)))

(defun check-interrupted (begun-p function expected)
  "Interrupt FUNCTION, in which the events EXPECTED are to happen meanwhile, in some order."
  (setf *events* '())
  (is (eq :left (call-interrupted begun-p function)))
  (is (null (set-exclusive-or expected *events*)) "~a happened, not ~a" *events* expected)
  (is (= 0 (busy-threads)))
  (is (equal '(1 2) (multiple-value-list (plan:top-level (plan:par (values 1 2) 3))))))

(defclass slow-clock (plan:virtual-clock) ()
  (:documentation "A clock whose seconds take a while."))

(defmethod plan:let-time-pass ((clock slow-clock) seconds)
  (loop repeat 1000 do (sleep 1/100)))

(defclass slow-executive () ())

(defmethod plan:executive-clock ((executive slow-executive))
  (make-instance 'slow-clock))

(test interrupting-a-plan-in-which-time-passes
  (let ((begun nil))
    (check-interrupted
     (lambda () begun)
     (lambda ()
       (plan:with-executive ((make-instance 'slow-executive))
         (plan:top-level
           (plan:par (unwind-protect (plan:sleep* 1) (note-event 1))
                     (unwind-protect (progn (setf begun t) (plan:sleep* 2)) (note-event 2))))))
     '(1 2))))

(test interrupting-a-plan-whose-first-task-computes
  (let ((begun nil))
    (check-interrupted
     (lambda () begun)
     (lambda ()
       (plan:top-level
         (plan:pursue (progn (plan:wait-for (plan:make-fluent))) 1)
         (unwind-protect (loop (setf begun t)) (note-event :cleanup))))
     '(:cleanup))))

(test interrupting-a-plan-one-of-whose-branches-computes
  (let ((begun nil))
    (check-interrupted
     (lambda () begun)
     (lambda ()
       (plan:top-level
         (unwind-protect
              (plan:par (unwind-protect (plan:sleep* 1) (note-event 1))
                        (unwind-protect (loop (setf begun t)) (note-event 2)))
           (note-event 3))))
     '(1 2 3))))

(test interrupting-a-plan-in-a-child-of-a-branch
  (let ((begun nil))
    (check-interrupted
     (lambda () begun)
     (lambda ()
       (plan:top-level
         (plan:par (plan:sleep* 1)
                   (unwind-protect
                        (plan:par (unwind-protect (plan:call-in-task
                                                   'child '(child)
                                                   (lambda () (loop (setf begun t))))
                                    (note-event 1)))
                     (note-event 2)))))
     '(1 2))))

(test interrupting-again-and-again
  (loop repeat 50
        do (let ((begun nil))
             (is (eq :left (call-interrupted
                            (lambda () begun)
                            (lambda ()
                              (plan:top-level
                                (loop (plan:par (setf begun t) (plan:sleep* 1)))))))))
           (is (= 0 (busy-threads)))))

;;; Images

(test an-image-is-saved-after-pars
  (uiop:with-temporary-file (:pathname core)
    (let ((script "(progn
  (plan:top-level (plan:par (plan:sleep* 1) (plan:sleep* 2)))
  (sb-ext:save-lisp-and-die ~s :toplevel
    (lambda ()
      (prin1 (multiple-value-list
              (plan:top-level (plan:par (values :saved (plan:now)) (plan:sleep* 1)))))
      (terpri)
      (finish-output)
      (sb-ext:exit))))"))
      (flet ((run-sbcl (&rest arguments)
               (uiop:run-program (list* sb-ext:*runtime-pathname* "--noinform" arguments)
                                 :output :string :error-output :output)))
        (run-sbcl "--non-interactive" "--no-userinit"
                  "--eval" "(require :asdf)"
                  "--eval" (format nil "(asdf:load-asd ~s)" (root-file "discrepancy-finder.asd"))
                  "--eval" "(asdf:load-system \"discrepancy-finder/plan-language\")"
                  "--eval" (string-replace-nicknames (format nil script (namestring core))))
        (is (string= "(:SAVED 0.0d0)" (string-trim '(#\Newline)
                                                   (run-sbcl "--core" (namestring core)))))))))

(defun string-replace-nicknames (text)
  "Return TEXT with the nickname that this package has for the plan language spelled out."
  (replace-all text "plan:" "discrepancy-finder.plan-language:"))

;;; Errors in branches

(test errors-of-branches
  (signals division-by-zero (plan:top-level (plan:par 1 (error 'division-by-zero))))
  (signals type-error (plan:top-level (plan:pursue (plan:sleep* 9) (the-car 1))))
  (signals plan:composite-failure
    (plan:top-level (plan:try-all (error 'division-by-zero) (the-car 1))))
  (is (equal '(type-error division-by-zero)
             (handler-case
                 (plan:top-level (plan:try-all (error 'division-by-zero) (error 'type-error)))
               (plan:composite-failure (failure)
                 (mapcar (lambda (envelope) (type-of (plan:envelop-error envelope)))
                         (plan:composite-failures failure))))))
  (is (= 0 (busy-threads))))

(defun the-car (thing)
  (car thing))

(test warnings-of-branches-are-handled-where-they-are-signaled
  (is (equal '(:muffled :done)
             (events-of (lambda ()
                          (handler-bind ((warning (lambda (warning)
                                                    (note-event :muffled)
                                                    (muffle-warning warning))))
                            (plan:top-level (plan:par (progn (warn "Careful.")
                                                             (note-event :done))
                                                      1))))))))
