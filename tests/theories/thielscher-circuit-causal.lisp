;;;; Thielscher's circuit with causal constraints: indirect effects at the same timepoint.
;;;;
;;;; Source: M. Thielscher, Ramification and causality, 1997; E. Mueller, Commonsense Reasoning,
;;;; 2006, chapter 6; started, stopped, initiated and terminated are Shanahan's (1999).
;;;; Expected: 1 model.  Closing S1 at 0 activates the relay and opens S2 at 0, too, so that S2 is
;;;; terminated, never initiated, and the lamp is never lit.  Only the switching on is axiomatized
;;;; here; thielscher-circuit-shanahan has both directions.

(define-theory thielscher-circuit-causal
  "The lamp's loop is S1 and S2, the relay's S1 and S3; the active relay opens S2."
  (:extends causal-constraints)
  (:sorts (switch s1 s2 s3) (light lamp) (relay relay1))
  (:fluents (closed switch) (lit light) (activated relay))
  (:events (close switch) (open switch) (light light) (activate relay))
  (:axioms
   (initiates (close ?switch) (closed ?switch) ?time)
   (terminates (open ?switch) (closed ?switch) ?time)
   (initiates (light ?light) (lit ?light) ?time)
   (initiates (activate ?relay) (activated ?relay) ?time)
   (lamp :label delta
    (implies (and (stopped (lit lamp) ?time)
                  (initiated (closed s1) ?time)
                  (initiated (closed s2) ?time))
             (happens (light lamp) ?time)))
   (relay-opens-s2 :label delta
    (implies (and (started (closed s2) ?time) (initiated (activated relay1) ?time))
             (happens (open s2) ?time)))
   (relay :label delta
    (implies (and (stopped (activated relay1) ?time)
                  (initiated (closed s1) ?time)
                  (initiated (closed s3) ?time))
             (happens (activate relay1) ?time))))
  (:facts
   (initially (not (closed s1)))
   (initially (closed s2))
   (initially (closed s3))
   (initially (not (lit lamp)))
   (initially (not (activated relay1))))
  (:narrative (closing :label delta (happens (close s1) 0)))
  (:completion (delta happens))
  (:time 0 3))
