;;;; A clock that is set rings later, unless something is wrong with it.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default events.
;;;; Expected: 1 model.  Both clocks are set at 0 to ring after 3 timepoints; only the first one
;;;; rings, at 3, because the battery of the second is empty.  Ann wakes up and Ben sleeps on.

(define-theory default-event
  "An event at one timepoint causes another one later, by default."
  (:sorts (agent ann ben) (clock clock1 clock2))
  (:predicates (ab1 clock time) (clock-of agent clock))
  (:fluents (asleep agent) (battery-empty clock))
  (:events (set-clock agent clock) (ring clock) (wake-up agent))
  (:axioms
   (terminates (wake-up ?agent) (asleep ?agent) ?time)
   (rings :label delta
    (implies (and (happens (set-clock ?agent ?clock) ?time1)
                  (< ?time1 ?time2)
                  (= ?time2 (+ ?time1 3))
                  (not (ab1 ?clock ?time2)))
             (happens (ring ?clock) ?time2)))
   (wakes :label delta
    (implies (and (happens (ring ?clock) ?time) (clock-of ?agent ?clock)
                  (holds-at (asleep ?agent) ?time))
             (happens (wake-up ?agent) ?time)))
   (empty-is-abnormal :label theta
    (implies (holds-at (battery-empty ?clock) ?time) (ab1 ?clock ?time))))
  (:facts
   (iff (clock-of ?agent ?clock)
        (or (and (= ?agent ann) (= ?clock clock1)) (and (= ?agent ben) (= ?clock clock2))))
   (holds-at (asleep ?agent) 0)
   (iff (holds-at (battery-empty ?clock) 0) (= ?clock clock2)))
  (:narrative
   (ann-sets :label delta (happens (set-clock ann clock1) 0))
   (ben-sets :label delta (happens (set-clock ben clock2) 0)))
  (:completion (delta happens) (theta ab1))
  (:time 0 4))
