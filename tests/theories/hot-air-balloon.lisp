;;;; A hot-air balloon rises while its heater is on and sinks while it is off.
;;;;
;;;; Source: R. Miller, M. Shanahan, The event calculus in classical logic, 1999 (antitrajectories);
;;;; E. Mueller, Commonsense Reasoning, 2006, chapter 7.
;;;; Expected: 1 model; heights 0, 1, 2, 1 at 0 to 3.  The height is never inertial, but at each
;;;; timepoint the trajectory or the antitrajectory gives one height and the others are excluded.

(define-theory hot-air-balloon
  "Heater on from 0 to 2."
  (:sorts (balloon montgolfier) (height (:range 0 4)))
  (:fluents (heater-on balloon))
  (:non-inertial-fluents (height balloon height))
  (:events (turn-heater-on balloon) (turn-heater-off balloon))
  (:axioms
   (initiates (turn-heater-on ?balloon) (heater-on ?balloon) ?time)
   (terminates (turn-heater-off ?balloon) (heater-on ?balloon) ?time)
   (rises (implies (and (holds-at (height ?balloon ?height1) ?time)
                        (= ?height2 (+ ?height1 ?offset)))
                   (trajectory (heater-on ?balloon) ?time (height ?balloon ?height2) ?offset)))
   (sinks (implies (and (holds-at (height ?balloon ?height1) ?time)
                        (= ?height2 (- ?height1 ?offset)))
                   (anti-trajectory (heater-on ?balloon) ?time (height ?balloon ?height2)
                                    ?offset)))
   (implies (and (holds-at (height ?balloon ?height1) ?time)
                 (holds-at (height ?balloon ?height2) ?time))
            (= ?height1 ?height2)))
  (:facts
   (holds-at (height montgolfier 0) 0)
   (not (holds-at (heater-on montgolfier) 0)))
  (:narrative
   (happens (turn-heater-on montgolfier) 0)
   (happens (turn-heater-off montgolfier) 2))
  (:completion happens)
  (:time 0 3)
  (:offset 1 3))
