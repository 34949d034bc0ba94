;;;; A leaf falls faster and faster.
;;;;
;;;; Source: E. Mueller, Event calculus reasoning through satisfiability, 2004 (the falling leaf).
;;;; Expected: 1 model; heights 9, 8, 5, 0 at 0 to 3, hitting the ground at 3.  The law of motion is
;;;; quadratic in the time since the fall began.

(define-theory leaf-quadratic
  "The height lost is the square of the time."
  (:sorts (object leaf) (height (:range 0 9)))
  (:fluents (falling object) (height object height))
  (:events (start-falling object) (hit-ground object))
  (:axioms
   (initiates (start-falling ?object) (falling ?object) ?time)
   (releases (start-falling ?object) (height ?object ?height) ?time)
   (terminates (hit-ground ?object) (falling ?object) ?time)
   (implies (holds-at (height ?object ?height) ?time)
            (initiates (hit-ground ?object) (height ?object ?height) ?time))
   (implies (and (holds-at (height ?object ?height1) ?time)
                 (= ?height2 (- ?height1 (* ?offset ?offset))))
            (trajectory (falling ?object) ?time (height ?object ?height2) ?offset))
   (implies (and (holds-at (height ?object ?height1) ?time)
                 (holds-at (height ?object ?height2) ?time))
            (= ?height1 ?height2))
   (implies (and (holds-at (falling ?object) ?time) (holds-at (height ?object 0) ?time))
            (happens (hit-ground ?object) ?time)))
  (:facts
   (initially (not (falling leaf)))
   (initially (height leaf 9)))
  (:narrative (happens (start-falling leaf) 0))
  (:completion happens)
  (:time 0 4)
  (:offset 1 4))
