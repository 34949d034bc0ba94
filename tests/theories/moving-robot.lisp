;;;; A robot with two wheels.
;;;;
;;;; Source: M. Shanahan, Solving the Frame Problem, 1997, on concurrent events (the robot with two
;;;; wheels of his and R. Miller's); E. Mueller, Commonsense Reasoning, 2006, chapter 8.
;;;; Expected: 1 model; at the end the robot is at (2,1) and looks in direction 1, north.  Both
;;;; wheels take it forwards, to (2,0); the right wheel alone turns it left; both take it north, to
;;;; (2,1).  Steps out of the range of coordinates have no ground instance; none is reached.

(define-theory moving-robot
  "Directions are 0 east, 1 north, 2 west, 3 south; the steps they make are tabulated."
  (:sorts (robot robot1) (direction (:range 0 3)) (coordinate (:range 0 3)) (step (:range 0 1)))
  (:functions ((east direction) step) ((west direction) step)
              ((north direction) step) ((south direction) step))
  (:fluents (direction robot direction) (location robot coordinate coordinate))
  (:events (move-left-wheel robot) (move-right-wheel robot))
  (:axioms
   (right-alone-turns-left
    (implies (and (not (happens (move-left-wheel ?robot) ?time))
                  (holds-at (direction ?robot ?direction1) ?time)
                  (= ?direction2 (mod (+ ?direction1 1) 4)))
             (initiates (move-right-wheel ?robot) (direction ?robot ?direction2) ?time)))
   (implies (and (not (happens (move-left-wheel ?robot) ?time))
                 (holds-at (direction ?robot ?direction) ?time))
            (terminates (move-right-wheel ?robot) (direction ?robot ?direction) ?time))
   (left-alone-turns-right
    (implies (and (not (happens (move-right-wheel ?robot) ?time))
                  (holds-at (direction ?robot ?direction1) ?time)
                  (= ?direction2 (mod (+ ?direction1 3) 4)))
             (initiates (move-left-wheel ?robot) (direction ?robot ?direction2) ?time)))
   (implies (and (not (happens (move-right-wheel ?robot) ?time))
                 (holds-at (direction ?robot ?direction) ?time))
            (terminates (move-left-wheel ?robot) (direction ?robot ?direction) ?time))
   (both-move-forwards
    (implies (and (happens (move-left-wheel ?robot) ?time)
                  (holds-at (location ?robot ?coordinate1 ?coordinate2) ?time)
                  (holds-at (direction ?robot ?direction) ?time)
                  (= ?coordinate3 (- (+ ?coordinate1 (east ?direction)) (west ?direction)))
                  (= ?coordinate4 (- (+ ?coordinate2 (north ?direction)) (south ?direction))))
             (initiates (move-right-wheel ?robot) (location ?robot ?coordinate3 ?coordinate4)
                        ?time)))
   (implies (and (happens (move-left-wheel ?robot) ?time)
                 (holds-at (location ?robot ?coordinate1 ?coordinate2) ?time))
            (terminates (move-right-wheel ?robot) (location ?robot ?coordinate1 ?coordinate2)
                        ?time))
   (implies (and (holds-at (direction ?robot ?direction1) ?time)
                 (holds-at (direction ?robot ?direction2) ?time))
            (= ?direction1 ?direction2))
   (implies (and (holds-at (location ?robot ?coordinate1 ?coordinate2) ?time)
                 (holds-at (location ?robot ?coordinate3 ?coordinate4) ?time))
            (and (= ?coordinate1 ?coordinate3) (= ?coordinate2 ?coordinate4))))
  (:facts
   (= (east 0) 1) (= (east 1) 0) (= (east 2) 0) (= (east 3) 0)
   (= (west 0) 0) (= (west 1) 0) (= (west 2) 1) (= (west 3) 0)
   (= (north 0) 0) (= (north 1) 1) (= (north 2) 0) (= (north 3) 0)
   (= (south 0) 0) (= (south 1) 0) (= (south 2) 0) (= (south 3) 1)
   (holds-at (location robot1 1 0) 0)
   (holds-at (direction robot1 0) 0))
  (:narrative
   (happens (move-left-wheel robot1) 0)
   (happens (move-right-wheel robot1) 0)
   (happens (move-right-wheel robot1) 1)
   (happens (move-left-wheel robot1) 2)
   (happens (move-right-wheel robot1) 2))
  (:completion happens)
  (:time 0 3))
