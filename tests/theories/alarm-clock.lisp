;;;; An alarm clock is set and beeps at the time it is set to.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 4, on triggered events.
;;;; Expected: 1 model.  Set at 0 to 2, it begins to beep at 2, beeps from 3 on and is silenced at
;;;; 3.  The trigger fires once, since only one timepoint is the alarm time.  A timepoint is the
;;;; argument of a fluent here.

(define-theory alarm-clock
  "The alarm time is a functional fluent."
  (:sorts (clock clock1))
  (:fluents (alarm-time clock time) (alarm-on clock) (beeping clock))
  (:events (set-alarm-time clock time) (turn-on-alarm clock) (turn-off-alarm clock)
           (start-beeping clock))
  (:axioms
   (initiates (set-alarm-time ?clock ?time2) (alarm-time ?clock ?time2) ?time)
   (implies (and (holds-at (alarm-time ?clock ?time1) ?time) (/= ?time1 ?time2))
            (terminates (set-alarm-time ?clock ?time2) (alarm-time ?clock ?time1) ?time))
   (initiates (turn-on-alarm ?clock) (alarm-on ?clock) ?time)
   (terminates (turn-off-alarm ?clock) (alarm-on ?clock) ?time)
   (initiates (start-beeping ?clock) (beeping ?clock) ?time)
   (terminates (turn-off-alarm ?clock) (beeping ?clock) ?time)
   (implies (and (holds-at (alarm-time ?clock ?time1) ?time)
                 (holds-at (alarm-time ?clock ?time2) ?time))
            (= ?time1 ?time2))
   (trigger
    (implies (and (holds-at (alarm-time ?clock ?time) ?time) (holds-at (alarm-on ?clock) ?time))
             (happens (start-beeping ?clock) ?time))))
  (:facts
   (holds-at (alarm-time clock1 0) 0)
   (not (holds-at (alarm-on clock1) 0))
   (not (holds-at (beeping clock1) 0)))
  (:narrative
   (happens (set-alarm-time clock1 2) 0)
   (happens (turn-on-alarm clock1) 1)
   (happens (turn-off-alarm clock1) 3))
  (:completion happens)
  (:time 0 4))
