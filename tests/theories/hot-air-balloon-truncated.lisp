;;;; A hot-air balloon that leaves the range of heights.
;;;;
;;;; Source: as hot-air-balloon; a test of ground instances that are dropped.
;;;; Expected: 16 models.  The heater stays on.  Heights 1 and 2 at 1 and 2 are those of the
;;;; trajectory; its instances for heights 3 and 4 are dropped, since the range ends at 2.  So at 3
;;;; and at 4 the released height is free: 0, 1, 2 or, since no sentence demands one, none; 4 x 4
;;;; models.

(define-theory hot-air-balloon-truncated
  "Heights from 0 to 2, and a flight to 4."
  (:sorts (height (:range 0 2)))
  (:fluents (heater-on))
  (:non-inertial-fluents (height height))
  (:events (turn-heater-on))
  (:axioms
   (initiates (turn-heater-on) (heater-on) ?time)
   (implies (holds-at (height ?height) ?time)
            (trajectory (heater-on) ?time (height (+ ?height ?offset)) ?offset))
   (implies (and (holds-at (height ?height1) ?time) (holds-at (height ?height2) ?time))
            (= ?height1 ?height2)))
  (:facts
   (holds-at (height 0) 0)
   (not (holds-at (heater-on) 0)))
  (:narrative (happens (turn-heater-on) 0))
  (:completion happens)
  (:time 0 4)
  (:offset 1 4))
