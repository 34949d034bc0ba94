;;;; Thielscher's circuit with trigger axioms: every effect takes a timepoint.
;;;;
;;;; Source: M. Thielscher, Ramification and causality, 1997; E. Mueller, Commonsense Reasoning,
;;;; 2006, chapter 6, where this writing shows what causal constraints are needed for.
;;;; Expected: 1 model, with the anomaly that the lamp is lit at 2 and 3, since opening S2 comes two
;;;; timepoints after closing S1; it is off at 4.  The relay stays active: its loop is S1 and S3.

(define-theory thielscher-circuit-delays
  "The lamp's loop is S1 and S2, the relay's S1 and S3; the active relay opens S2."
  (:sorts (switch s1 s2 s3))
  (:fluents (closed switch) (lit) (activated))
  (:events (close switch) (open switch) (light) (unlight) (activate) (deactivate))
  (:axioms
   (initiates (close ?switch) (closed ?switch) ?time)
   (terminates (open ?switch) (closed ?switch) ?time)
   (initiates (light) (lit) ?time)
   (terminates (unlight) (lit) ?time)
   (initiates (activate) (activated) ?time)
   (terminates (deactivate) (activated) ?time)
   (implies (and (not (holds-at (lit) ?time))
                 (holds-at (closed s1) ?time) (holds-at (closed s2) ?time))
            (happens (light) ?time))
   (implies (and (holds-at (lit) ?time)
                 (or (not (holds-at (closed s1) ?time)) (not (holds-at (closed s2) ?time))))
            (happens (unlight) ?time))
   (implies (and (not (holds-at (activated) ?time))
                 (holds-at (closed s1) ?time) (holds-at (closed s3) ?time))
            (happens (activate) ?time))
   (implies (and (holds-at (activated) ?time)
                 (or (not (holds-at (closed s1) ?time)) (not (holds-at (closed s3) ?time))))
            (happens (deactivate) ?time))
   (implies (and (holds-at (activated) ?time) (holds-at (closed s2) ?time))
            (happens (open s2) ?time)))
  (:facts
   (initially (and (not (closed s1)) (closed s2) (closed s3) (not (lit)) (not (activated)))))
  (:narrative (happens (close s1) 0))
  (:completion happens)
  (:time 0 5))
