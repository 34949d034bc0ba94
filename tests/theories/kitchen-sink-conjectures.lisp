;;;; The kitchen sink with its rim at 3.
;;;;
;;;; Source: E. Mueller, G. Sutcliffe, Reasoning in the event calculus using first-order automated
;;;; theorem proving, 2005: problems CSR001 to CSR014 of the TPTP library; the domain is Shanahan's.
;;;; Expected: 1 model, in which all conjectures hold: levels 1, 2, 3 at 1, 2, 3; overflow at 3;
;;;; filling until 3 and not at 4; spilling at 4; level 3 at 4.

(define-theory kitchen-sink-conjectures
  "The tap is opened at 0, the rim is at height 3."
  (:sorts (height (:range 0 4)))
  (:fluents (filling) (spilling) (water-level height))
  (:events (tap-on) (tap-off) (overflow))
  (:axioms
   (tap-on-fills (initiates (tap-on) (filling) ?time))
   (tap-on-frees-level (releases (tap-on) (water-level ?height) ?time))
   (tap-off-stops (terminates (tap-off) (filling) ?time))
   (tap-off-keeps-level
    (implies (holds-at (water-level ?height) ?time)
             (initiates (tap-off) (water-level ?height) ?time)))
   (overflow-stops (terminates (overflow) (filling) ?time))
   (overflow-keeps-level
    (implies (holds-at (water-level ?height) ?time)
             (initiates (overflow) (water-level ?height) ?time)))
   (overflow-spills (initiates (overflow) (spilling) ?time))
   (rising
    (implies (and (holds-at (water-level ?height1) ?time) (= ?height2 (+ ?height1 ?offset)))
             (trajectory (filling) ?time (water-level ?height2) ?offset)))
   (one-level
    (implies (and (holds-at (water-level ?height1) ?time) (holds-at (water-level ?height2) ?time))
             (= ?height1 ?height2)))
   (full-sink-overflows
    (implies (and (holds-at (water-level 3) ?time) (holds-at (filling) ?time))
             (happens (overflow) ?time))))
  (:facts
   (holds-at (water-level 0) 0)
   (not (holds-at (filling) 0))
   (not (holds-at (spilling) 0)))
  (:narrative (happens (tap-on) 0))
  (:completion happens)
  (:time 0 5)
  (:offset 1 5))
