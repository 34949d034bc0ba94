;;;; An alarm clock with a snooze button.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, exercises of chapter 4.
;;;; Expected: 1 model.  It beeps from 2 on (alarm at 1), is silenced by the snooze button at 2,
;;;; begins again two timepoints later, at 4, and is turned off at 5, for good.

(define-theory snooze-alarm
  "The snooze button makes a later event happen, if the alarm is still on then."
  (:sorts (clock clock1))
  (:fluents (alarm-on clock) (beeping clock))
  (:events (start-beeping clock) (snooze clock) (turn-off clock))
  (:axioms
   (initiates (start-beeping ?clock) (beeping ?clock) ?time)
   (terminates (snooze ?clock) (beeping ?clock) ?time)
   (terminates (turn-off ?clock) (beeping ?clock) ?time)
   (terminates (turn-off ?clock) (alarm-on ?clock) ?time)
   (again
    (implies (and (happens (snooze ?clock) ?time1) (< ?time1 ?time2) (= (- ?time2 ?time1) 2)
                  (holds-at (alarm-on ?clock) ?time2))
             (happens (start-beeping ?clock) ?time2))))
  (:facts
   (holds-at (alarm-on clock1) 0)
   (not (holds-at (beeping clock1) 0)))
  (:narrative
   (happens (start-beeping clock1) 1)
   (happens (snooze clock1) 2)
   (happens (turn-off clock1) 5))
  (:completion happens)
  (:time 0 7))
