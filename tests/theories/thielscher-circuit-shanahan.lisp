;;;; Thielscher's circuit with causal constraints in both directions.
;;;;
;;;; Source: M. Shanahan, The ramification problem in the event calculus, 1999; the circuit is M.
;;;; Thielscher's, Ramification and causality, 1997.
;;;; Expected: 1 model: relay on and second switch open from 1 on, the light never on.  At 0: switch
;;;; 1 and switch 3 are initiated and the relay is stopped, so it is switched on; it is thereby
;;;; initiated while switch 2 is started, so switch 2 is opened and is not initiated.  No conclusion
;;;; supports itself, so that the completion has the same models as the circumscription.

(define-theory thielscher-circuit-shanahan
  "Switching on and off of light and relay by causal constraints."
  (:extends causal-constraints)
  (:fluents (switch1) (switch2) (switch3) (relay) (light))
  (:events (close1) (open1) (close2) (open2) (light-on) (light-off) (relay-on) (relay-off))
  (:axioms
   (initiates (close1) (switch1) ?time)
   (terminates (open1) (switch1) ?time)
   (initiates (close2) (switch2) ?time)
   (terminates (open2) (switch2) ?time)
   (initiates (light-on) (light) ?time)
   (terminates (light-off) (light) ?time)
   (initiates (relay-on) (relay) ?time)
   (terminates (relay-off) (relay) ?time)
   (light-goes-on :label delta
    (implies (and (stopped (light) ?time) (initiated (switch1) ?time) (initiated (switch2) ?time))
             (happens (light-on) ?time)))
   (light-goes-off :label delta
    (implies (and (started (light) ?time)
                  (or (terminated (switch1) ?time) (terminated (switch2) ?time)))
             (happens (light-off) ?time)))
   (relay-goes-on :label delta
    (implies (and (stopped (relay) ?time) (initiated (switch1) ?time) (initiated (switch3) ?time))
             (happens (relay-on) ?time)))
   (relay-goes-off :label delta
    (implies (and (started (relay) ?time)
                  (or (terminated (switch1) ?time) (terminated (switch3) ?time)))
             (happens (relay-off) ?time)))
   (relay-opens-switch2 :label delta
    (implies (and (started (switch2) ?time) (initiated (relay) ?time))
             (happens (open2) ?time))))
  (:facts
   (initially (and (not (switch1)) (switch2) (switch3)))
   (initially (and (not (relay)) (not (light)))))
  (:narrative (closing :label delta (happens (close1) 0)))
  (:completion (delta happens))
  (:time 0 3))
