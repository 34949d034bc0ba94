;;;; The plan language: what a perform, a failure with retry, a task cost.
;;;;
;;;; The peer of a task is a thread that is made and joined, which is what a task is in CRAM; the
;;;; peer of a round of WITH-FAILURE-HANDLING and RETRY is the same written by hand in Common Lisp.

(in-package #:discrepancy-finder.bench)

(defclass no-op () ()
  (:documentation "An executive that performs everything at once."))

(defmethod plan:perform-with ((executive no-op) designator position)
  (declare (ignore designator position))
  nil)

(plan:def-cram-function failing-child ()
  (plan:fail 'plan:navigation-goal-not-reached))

(defun perform-rounds (count)
  "Perform a motion COUNT times in one top-level."
  (plan:with-executive ((make-instance 'no-op))
    (plan:top-level
      (dotimes (index count)
        (plan:perform (plan:a motion (type nothing)))))))

;;; The whole way of CRAM: matching, grounding, a process module.

(prolog:def-fact-group no-op-motions (plan:matching-process-module plan:available-process-module
                                      desig:motion-grounding)
  (prolog:<- (desig:motion-grounding ?motion (nothing))
    (desig:desig-prop ?motion (:type :nothing)))
  (prolog:<- (plan:matching-process-module ?motion no-op-module)
    (desig:desig-prop ?motion (:type :nothing)))
  (prolog:<- (plan:available-process-module no-op-module)))

(plan:def-process-module no-op-module (motion)
  (desig:reference motion))

(defun module-rounds (count)
  "Perform a motion by a process module COUNT times in one top-level."
  (plan:top-level
    (plan:with-process-modules-running (no-op-module)
      (dotimes (index count)
        (plan:perform (plan:a motion (type nothing)))))))

(defun parallel-module-rounds (count)
  "The same in a branch of a PURSUE, beside a task that waits."
  (plan:top-level
    (plan:with-process-modules-running (no-op-module)
      (plan:pursue (dotimes (index count)
                     (plan:perform (plan:a motion (type nothing))))
                   (plan:wait-for (plan:make-fluent))))))

(defun handled-rounds (count function)
  "Call FUNCTION, which fails, and retry, COUNT times in one task."
  (declare (function function))
  (plan:top-level
    (let ((rounds 0))
      (declare (fixnum rounds))
      (plan:with-failure-handling
          ((plan:navigation-low-level-failure ()
             (when (< (incf rounds) count)
               (plan:retry))
             (return)))
        (funcall function)))))

(defun retry-rounds (count)
  "Fail and retry COUNT times in one task."
  (handled-rounds count (lambda () (plan:fail 'plan:navigation-goal-not-reached))))

(defun child-failure-rounds (count)
  "Let a plan that another one calls fail, and retry, COUNT times."
  (handled-rounds count #'failing-child))

(defun plain-retry-rounds (count)
  "The same in Common Lisp."
  (let ((rounds 0))
    (declare (fixnum rounds))
    (block nil
      (tagbody
       again
         (handler-bind ((plan:navigation-low-level-failure
                          (lambda (condition)
                            (declare (ignore condition))
                            (when (< (incf rounds) count)
                              (go again))
                            (return))))
           (error 'plan:navigation-goal-not-reached))))))

(defun par-rounds (count)
  "Do two things in parallel COUNT times."
  (plan:top-level (dotimes (index count) (plan:par 1 2))))

(defun thread-rounds (count)
  "Make and join COUNT threads, one after the other."
  (dotimes (index count)
    (sb-thread:join-thread (sb-thread:make-thread (lambda () nil)))))

(defun compare-rounds (ours count theirs their-count &key (rounds 9))
  "Return the median microseconds a round of OURS and of THEIRS, functions of a number of rounds,
and the median ratio of their times, pair by pair."
  (funcall ours count)
  (funcall theirs their-count)
  (let ((our-times '()) (their-times '()))
    (loop repeat rounds
          do (push (/ (seconds-of (lambda () (funcall ours count))) count 1d-6) our-times)
             (push (/ (seconds-of (lambda () (funcall theirs their-count))) their-count 1d-6)
                   their-times))
    (values (median our-times) (median their-times)
            (median (mapcar #'/ our-times their-times)))))

(defun print-plan-benchmarks (stream)
  (flet ((report (what ours count peer theirs their-count)
           (multiple-value-bind (us them ratio) (compare-rounds ours count theirs their-count)
             (format stream "~25a ~,2f us, ~a ~,2f us, time ratio ~,3f~%"
                     what us peer them ratio))))
    (report "perform, process module" #'module-rounds 1000 "a thread" #'thread-rounds 100)
    (report "the same in a branch" #'parallel-module-rounds 1000 "a thread" #'thread-rounds 100)
    (report "perform, no-op executive" #'perform-rounds 1000 "a thread" #'thread-rounds 100)
    (report "the same, 100 000 of them" #'perform-rounds 100000 "1000 of them"
            #'perform-rounds 1000)
    (report "fail and retry" #'retry-rounds 10000 "in plain Lisp" #'plain-retry-rounds 10000)
    (report "failure of a child, retry" #'child-failure-rounds 1000 "a thread"
            #'thread-rounds 100)
    (report "par of two" #'par-rounds 300 "a thread" #'thread-rounds 100)))
