;;;; To go somewhere is to run there or to drive there.
;;;;
;;;; Source: R. Miller, M. Shanahan, Some alternative formulations of the event calculus, 2002, on
;;;; disjunctive event axioms; E. Mueller, Commonsense Reasoning, 2006, chapter 9.
;;;; Expected: 1 model.  He is tired at 1, which running makes and driving does not: he ran.

(define-theory running-and-driving-1
  "Running makes tired."
  (:sorts (agent james) (place home bookstore))
  (:fluents (tired agent) (at agent place))
  (:events (go agent place) (run agent place) (drive agent place))
  (:axioms
   (initiates (run ?agent ?place) (tired ?agent) ?time)
   (initiates (go ?agent ?place) (at ?agent ?place) ?time)
   (implies (/= ?place1 ?place2) (terminates (go ?agent ?place1) (at ?agent ?place2) ?time))
   (how :label delta
    (implies (happens (go ?agent ?place) ?time)
             (or (happens (run ?agent ?place) ?time) (happens (drive ?agent ?place) ?time)))))
  (:facts
   (initially (at james home))
   (initially (not (at james bookstore)))
   (not (holds-at (tired james) 0))
   (holds-at (tired james) 1))
  (:narrative (going :label delta (happens (go james bookstore) 0)))
  (:completion (delta happens))
  (:time 0 1))
