;;;; A circuit with a light and a relay that opens a switch of the light's loop.
;;;;
;;;; Source: M. Shanahan, The event calculus explained, 1999; E. Mueller, Commonsense Reasoning,
;;;; 2006, chapter 6, as trigger axioms.
;;;; Expected: 1 model.  Closing S1 at 0 lights the lamp and activates the relay at 1 (true from 2),
;;;; the relay opens S2 at 2 (open from 3), the broken loop switches both off at 3 (false at 4).
;;;; All follows from triggers that stop themselves by their effects.

(define-theory shanahan-circuit
  "Lamp and relay hang in the loop of S1, S2 and S3; the active relay opens S2."
  (:sorts (switch s1 s2 s3) (light lamp) (relay relay1))
  (:fluents (closed switch) (lit light) (activated relay))
  (:events (close switch) (open switch) (light light) (unlight light)
           (activate relay) (deactivate relay))
  (:axioms
   (initiates (close ?switch) (closed ?switch) ?time)
   (terminates (open ?switch) (closed ?switch) ?time)
   (initiates (light ?light) (lit ?light) ?time)
   (terminates (unlight ?light) (lit ?light) ?time)
   (initiates (activate ?relay) (activated ?relay) ?time)
   (terminates (deactivate ?relay) (activated ?relay) ?time)
   (light-goes-on
    (implies (and (not (holds-at (lit ?light) ?time))
                  (forall (?switch) (holds-at (closed ?switch) ?time)))
             (happens (light ?light) ?time)))
   (light-goes-off
    (implies (and (holds-at (lit ?light) ?time)
                  (exists (?switch) (not (holds-at (closed ?switch) ?time))))
             (happens (unlight ?light) ?time)))
   (relay-goes-on
    (implies (and (not (holds-at (activated ?relay) ?time))
                  (forall (?switch) (holds-at (closed ?switch) ?time)))
             (happens (activate ?relay) ?time)))
   (relay-goes-off
    (implies (and (holds-at (activated ?relay) ?time)
                  (exists (?switch) (not (holds-at (closed ?switch) ?time))))
             (happens (deactivate ?relay) ?time)))
   (relay-opens-s2
    (implies (and (holds-at (closed s2) ?time) (holds-at (activated relay1) ?time))
             (happens (open s2) ?time))))
  (:facts
   (initially (and (not (closed s1)) (closed s2) (closed s3)))
   (initially (and (not (lit lamp)) (not (activated relay1)))))
  (:narrative (happens (close s1) 0))
  (:completion happens)
  (:time 0 5))
