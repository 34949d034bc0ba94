;;;; A telephone call, from picking up to hanging up.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 3 (the telephone), after work on the
;;;; specification of telephone services.
;;;; Expected: 1 model; dial tone at 1, ringing at 2, connected at 3, idle and disconnected at 4,
;;;; both idle at 5.  Every effect depends on the state of the telephones, which is given at 0.

(define-theory telephone
  "The state of a telephone decides what an event does to it."
  (:sorts (agent ann ben) (phone phone1 phone2))
  (:fluents (idle phone) (dial-tone phone) (busy-signal phone) (ringing phone phone)
            (connected phone phone) (disconnected phone))
  (:events (pick-up agent phone) (set-down agent phone) (dial agent phone phone))
  (:axioms
   (implies (holds-at (idle ?phone) ?time)
            (initiates (pick-up ?agent ?phone) (dial-tone ?phone) ?time))
   (implies (holds-at (idle ?phone) ?time)
            (terminates (pick-up ?agent ?phone) (idle ?phone) ?time))
   (implies (or (holds-at (dial-tone ?phone) ?time) (holds-at (busy-signal ?phone) ?time)
                (holds-at (disconnected ?phone) ?time))
            (initiates (set-down ?agent ?phone) (idle ?phone) ?time))
   (terminates (set-down ?agent ?phone) (dial-tone ?phone) ?time)
   (terminates (set-down ?agent ?phone) (busy-signal ?phone) ?time)
   (implies (holds-at (disconnected ?phone) ?time)
            (terminates (set-down ?agent ?phone) (disconnected ?phone) ?time))
   (implies (and (holds-at (dial-tone ?phone1) ?time) (holds-at (idle ?phone2) ?time))
            (initiates (dial ?agent ?phone1 ?phone2) (ringing ?phone1 ?phone2) ?time))
   (implies (and (holds-at (dial-tone ?phone1) ?time) (holds-at (idle ?phone2) ?time))
            (terminates (dial ?agent ?phone1 ?phone2) (idle ?phone2) ?time))
   (implies (and (holds-at (dial-tone ?phone1) ?time) (not (holds-at (idle ?phone2) ?time)))
            (initiates (dial ?agent ?phone1 ?phone2) (busy-signal ?phone1) ?time))
   (implies (holds-at (dial-tone ?phone1) ?time)
            (terminates (dial ?agent ?phone1 ?phone2) (dial-tone ?phone1) ?time))
   (implies (holds-at (ringing ?phone1 ?phone2) ?time)
            (initiates (pick-up ?agent ?phone2) (connected ?phone1 ?phone2) ?time))
   (implies (holds-at (ringing ?phone1 ?phone2) ?time)
            (terminates (pick-up ?agent ?phone2) (ringing ?phone1 ?phone2) ?time))
   (implies (holds-at (connected ?phone1 ?phone2) ?time)
            (initiates (set-down ?agent ?phone1) (idle ?phone1) ?time))
   (implies (holds-at (connected ?phone1 ?phone2) ?time)
            (initiates (set-down ?agent ?phone1) (disconnected ?phone2) ?time))
   (implies (holds-at (connected ?phone1 ?phone2) ?time)
            (terminates (set-down ?agent ?phone1) (connected ?phone1 ?phone2) ?time))
   (not (and (holds-at (idle ?phone) ?time) (holds-at (dial-tone ?phone) ?time)))
   (implies (or (holds-at (ringing ?phone1 ?phone2) ?time)
                (holds-at (connected ?phone1 ?phone2) ?time))
            (and (not (holds-at (idle ?phone1) ?time)) (not (holds-at (idle ?phone2) ?time)))))
  (:facts
   (holds-at (idle ?phone) 0)
   (not (holds-at (dial-tone ?phone) 0))
   (not (holds-at (busy-signal ?phone) 0))
   (not (holds-at (disconnected ?phone) 0))
   (not (holds-at (ringing ?phone1 ?phone2) 0))
   (not (holds-at (connected ?phone1 ?phone2) 0)))
  (:narrative
   (happens (pick-up ann phone1) 0)
   (happens (dial ann phone1 phone2) 1)
   (happens (pick-up ben phone2) 2)
   (happens (set-down ann phone1) 3)
   (happens (set-down ben phone2) 4))
  (:completion happens)
  (:time 0 5))
