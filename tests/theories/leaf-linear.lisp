;;;; A leaf hangs for a while and falls at a constant speed.
;;;;
;;;; Source: E. Mueller, A tool for satisfiability-based commonsense reasoning in the event
;;;; calculus, 2004 (the falling leaf).
;;;; Expected: 1 model; height 4 until 2, then 3, 2, 1, 0, hitting the ground at 6.

(define-theory leaf-linear
  "The leaf comes off at 2 and loses one unit of height a timepoint."
  (:sorts (object leaf) (height (:range 0 4)))
  (:fluents (falling object) (height object height))
  (:events (start-falling object) (hit-ground object))
  (:axioms
   (initiates (start-falling ?object) (falling ?object) ?time)
   (releases (start-falling ?object) (height ?object ?height) ?time)
   (terminates (hit-ground ?object) (falling ?object) ?time)
   (implies (holds-at (height ?object ?height) ?time)
            (initiates (hit-ground ?object) (height ?object ?height) ?time))
   (implies (and (holds-at (height ?object ?height1) ?time)
                 (= ?height2 (- ?height1 ?offset)))
            (trajectory (falling ?object) ?time (height ?object ?height2) ?offset))
   (implies (and (holds-at (height ?object ?height1) ?time)
                 (holds-at (height ?object ?height2) ?time))
            (= ?height1 ?height2))
   (implies (and (holds-at (falling ?object) ?time) (holds-at (height ?object 0) ?time))
            (happens (hit-ground ?object) ?time)))
  (:facts
   (initially (not (falling leaf)))
   (initially (height leaf 4)))
  (:narrative (happens (start-falling leaf) 2))
  (:completion happens)
  (:time 0 7)
  (:offset 1 7))
