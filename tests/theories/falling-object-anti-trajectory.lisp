;;;; An apple loses its support and falls to the ground: falling as an antitrajectory.
;;;;
;;;; Source: E. Mueller, Event calculus reasoning through satisfiability, 2004 (falling object with
;;;; an antitrajectory); antitrajectories are R. Miller's and M. Shanahan's, 1999.
;;;; Expected: 1 model, the same as falling-object: heights 3, 2, 1, 0 at 0 to 3, hitting the ground
;;;; at 3, not falling at 4.  The fluent whose end starts the motion is the support.

(define-theory falling-object-anti-trajectory
  "What is not supported falls; the ground supports."
  (:sorts (object apple) (height (:range 0 3)))
  (:fluents (supported object) (height object height))
  (:non-inertial-fluents (falling object))
  (:events (let-go object) (hit-ground object))
  (:axioms
   (terminates (let-go ?object) (supported ?object) ?time)
   (releases (let-go ?object) (height ?object ?height) ?time)
   (initiates (hit-ground ?object) (supported ?object) ?time)
   (implies (holds-at (height ?object ?height) ?time)
            (initiates (hit-ground ?object) (height ?object ?height) ?time))
   (iff (holds-at (falling ?object) ?time) (not (holds-at (supported ?object) ?time)))
   (implies (and (holds-at (height ?object ?height1) ?time)
                 (= ?height2 (- ?height1 ?offset)))
            (anti-trajectory (supported ?object) ?time (height ?object ?height2) ?offset))
   (implies (and (holds-at (height ?object ?height1) ?time)
                 (holds-at (height ?object ?height2) ?time))
            (= ?height1 ?height2))
   (implies (and (holds-at (falling ?object) ?time) (holds-at (height ?object 0) ?time))
            (happens (hit-ground ?object) ?time)))
  (:facts
   (holds-at (supported apple) 0)
   (holds-at (height apple 3) 0))
  (:narrative (happens (let-go apple) 0))
  (:completion happens)
  (:time 0 5)
  (:offset 1 5))
