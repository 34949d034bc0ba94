;;;; The kitchen sink: water rises while the tap is on, until it overflows.
;;;;
;;;; Source: M. Shanahan, Representing continuous change in the event calculus, 1990, and The event
;;;; calculus explained, 1999 (trajectories); the numbers are those of T.-W. Kim, J. Lee, R. Palla,
;;;; Circumscriptive event calculus as answer set programming, 2009.
;;;; Expected: 1 model; the tap is opened at 5, the sink overflows at 15, once: overflowing ends the
;;;; filling and fixes the level at the rim.  Between 6 and 15 the levels are released, but the
;;;; trajectory gives one of them at each timepoint and the constraint excludes the others.

(define-theory kitchen-sink
  "Filling begins at 5, the rim is at height 10."
  (:sorts (height (:range 0 10)))
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
    (implies (and (holds-at (water-level 10) ?time) (holds-at (filling) ?time))
             (happens (overflow) ?time))))
  (:facts
   (holds-at (water-level 0) 0)
   (not (holds-at (filling) 0))
   (not (holds-at (spilling) 0)))
  (:narrative (happens (tap-on) 5))
  (:completion happens)
  (:time 0 25)
  (:offset 1 25))
