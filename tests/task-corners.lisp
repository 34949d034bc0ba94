;;;; Corners of tasks and fluents in which several mechanisms meet.

(in-package #:discrepancy-finder.tests)

(def-suite task-corners :in all)
(in-suite task-corners)

(test a-net-over-pulses-notices-each
  (is (equal '(1 2 3)
             (events-of
              (lambda ()
                (plan:top-level
                  (let* ((bell (plan:make-fluent :name 'bell))
                         (net (plan:fl-and (plan:fl-pulsed bell) t))
                         (rounds 0))
                    (plan:pursue
                      (plan:whenever (net) (note-event (incf rounds)))
                      (dotimes (time 3 (plan:sleep* 1))
                        (plan:sleep* 1)
                        (plan:pulse bell))))))))))

(test a-net-that-nobody-uses-is-not-computed
  "Whether the garbage collector has found it makes no difference."
  (is (equal '(:waited :set)
             (events-of
              (lambda ()
                (plan:top-level
                  (let ((level (plan:make-fluent :name 'level :value 0)))
                    (plan:par (progn (plan:wait-for (plan:fl> level 3)) (note-event :waited))
                              (progn (plan:sleep* 1) (setf (plan:value level) 4)))
                    (setf (plan:value level) :done)
                    (note-event :set))))))))

(test sleeps-that-are-over-leave-nothing
  (signals-with (plan:deadlock "never")
    (plan:top-level
      (plan:pursue (plan:sleep* 1d7) (plan:sleep* 1))
      (plan:with-policy plan::(named-policy 'timeout-policy) (1d9)
        (plan:wait-for (plan:make-fluent :name 'never))))))

(test timeouts-around-a-top-level
  (is (eq :timeout (handler-case
                       (sb-ext:with-timeout 0.2
                         (plan:top-level (plan:par (loop) (plan:sleep* 1))))
                     (sb-ext:timeout () :timeout))))
  (is (= 0 (busy-threads))))

(test an-inner-task-that-ends-is-not-cut-short
  "Its last child asks for the evaporation of the task around it."
  (is (equal '(:cleaned (:after 2.1d0 :evaporated :succeeded))
             (events-of
              (lambda ()
                (let (outer inner)
                  (plan:top-level
                    (plan:call-in-task
                     'outer '(outer)
                     (lambda ()
                       (setf outer (plan:current-task))
                       (plan:call-in-task
                        'inner '(inner)
                        (lambda ()
                          (setf inner (plan:current-task))
                          (plan:with-failure-handling ((plan:plan-failure () (return)))
                            (plan:par (progn (plan:sleep* 0.1d0) (plan:fail))
                                      (unwind-protect (plan:sleep* 10)
                                        (plan:sleep* 1)
                                        (plan:evaporate outer :sync nil)
                                        (plan:sleep* 1)
                                        (note-event :cleaned))))))))
                    (note-event (list :after (plan:now) (plan:value (plan:status outer))
                                      (plan:value (plan:status inner)))))))))))

(test without-scheduling-is-a-matter-of-one-task
  (is (equal '(:other :first :second)
             (events-of
              (lambda ()
                (plan:top-level
                  (plan:par (plan:without-scheduling (plan:sleep* 1) (note-event :first))
                            (plan:without-scheduling (plan:sleep* 2) (note-event :second))
                            (progn (plan:sleep* 0.5) (note-event :other)))))))))

(test an-inner-and-an-outer-task-are-suspended-apart
  (is (equal '((:suspended :suspended) (:suspended :suspended) (:running :running))
             (let (outer inner)
               (flet ((states ()
                        (list (plan:value (plan:status inner)) (plan:value (plan:status outer)))))
                 (plan:top-level
                   (plan:pursue
                     (plan:without-scheduling
                       (plan:call-in-task
                        'outer '(outer)
                        (lambda ()
                          (setf outer (plan:current-task))
                          (plan:call-in-task 'inner '(inner)
                                             (lambda ()
                                               (setf inner (plan:current-task))
                                               (plan:sleep* 10))))))
                     (progn
                       (plan:sleep* 1)
                       (plan:suspend inner)
                       (plan:suspend outer)
                       (list (states)
                             (progn (plan:wake-up inner) (plan:sleep* 1) (states))
                             (progn (plan:wake-up outer) (plan:sleep* 1) (states)))))))))))

(test retries-of-parallel-forms-leave-nothing
  (let ((rounds 0) (children 0))
    (plan:top-level
      (plan:with-failure-handling
          ((plan:plan-failure ()
             (setf children (length (plan::task-children (plan:current-task))))
             (when (< (incf rounds) 500) (plan:retry))
             (return)))
        (plan:par (plan:fail) (plan:sleep* 1))))
    (is (= 500 rounds))
    (is (<= children 8) "~d children are kept" children)))
