;;;; An apple is dropped and hits the ground.
;;;;
;;;; Source: E. Mueller, Event calculus reasoning through satisfiability, 2004, and Commonsense
;;;; Reasoning, 2006, chapter 7; M. Shanahan 1990.
;;;; Expected: 1 model; heights 3, 2, 1, 0 at 0 to 3; it hits the ground at 3, once, and does not
;;;; fall at 4, when its height is 0 and inertial again.

(define-theory falling-object
  "A falling object loses one unit of height a timepoint."
  (:sorts (agent nathan) (object apple) (height (:range 0 3)))
  (:fluents (falling object) (height object height))
  (:events (drop agent object) (hit-ground object))
  (:axioms
   (initiates (drop ?agent ?object) (falling ?object) ?time)
   (releases (drop ?agent ?object) (height ?object ?height) ?time)
   (terminates (hit-ground ?object) (falling ?object) ?time)
   (implies (holds-at (height ?object ?height) ?time)
            (initiates (hit-ground ?object) (height ?object ?height) ?time))
   (implies (and (holds-at (height ?object ?height1) ?time)
                 (= ?height2 (- ?height1 ?offset)))
            (trajectory (falling ?object) ?time (height ?object ?height2) ?offset))
   (one-height
    (implies (and (holds-at (height ?object ?height1) ?time)
                  (holds-at (height ?object ?height2) ?time))
             (= ?height1 ?height2)))
   (ground :label delta
    (implies (and (holds-at (falling ?object) ?time) (holds-at (height ?object 0) ?time))
             (happens (hit-ground ?object) ?time))))
  (:facts
   (not (holds-at (falling apple) 0))
   (holds-at (height apple 3) 0))
  (:narrative (dropped :label delta (happens (drop nathan apple) 0)))
  (:completion (delta happens))
  (:time 0 5)
  (:offset 1 5))
