;;;; Example 1 of the paper as a theory of the Discrete Event Calculus: a robot, a box, two regions.
;;;;
;;;; This file is data: reading it evaluates nothing.

(define-theory two-regions
  "A robot that carries a box between two regions.  The model knows regions and nothing of distances
within them: wherever the box lies in the robot's region, the robot can pick it up."
  (:sorts (region r1 r2))
  (:fluents (robot-in region) (box-in region) (holding-box))
  (:events (move region) (pick-up) (put-down region))
  (:axioms
   ;; The initial state of Example 1.
   (robot-starts-in-r1 (initially (robot-in r1)))
   (box-starts-in-r2 (initially (box-in r2)))
   (hand-starts-empty (initially (not (holding-box))))

   ;; Everything is in one place.
   (robot-somewhere (exists (?region) (holds-at (robot-in ?region) ?time)))
   (robot-in-one-region
    (implies (and (holds-at (robot-in ?region1) ?time) (holds-at (robot-in ?region2) ?time))
             (= ?region1 ?region2)))
   (box-somewhere (exists (?region) (holds-at (box-in ?region) ?time)))
   (box-in-one-region
    (implies (and (holds-at (box-in ?region1) ?time) (holds-at (box-in ?region2) ?time))
             (= ?region1 ?region2)))

   ;; Moving.
   (move-arrives (initiates (move ?region) (robot-in ?region) ?time))
   (move-leaves
    (implies (/= ?region1 ?region2)
             (terminates (move ?region1) (robot-in ?region2) ?time)))
   (move-carries-there
    (implies (holds-at (holding-box) ?time)
             (initiates (move ?region) (box-in ?region) ?time)))
   (move-carries-away
    (implies (and (holds-at (holding-box) ?time) (/= ?region1 ?region2))
             (terminates (move ?region1) (box-in ?region2) ?time)))

   ;; Picking up.
   (pick-up-holds (initiates (pick-up) (holding-box) ?time))
   (pick-up-needs-empty-hand
    (implies (happens (pick-up) ?time) (not (holds-at (holding-box) ?time))))
   (pick-up-needs-box-here
    (implies (and (happens (pick-up) ?time) (holds-at (robot-in ?region) ?time))
             (holds-at (box-in ?region) ?time)))

   ;; Putting down.
   (put-down-releases (terminates (put-down ?region) (holding-box) ?time))
   (put-down-needs-box
    (implies (happens (put-down ?region) ?time) (holds-at (holding-box) ?time)))
   (put-down-here
    (implies (happens (put-down ?region) ?time) (holds-at (robot-in ?region) ?time)))))

(define-state-constraint box-delivered (?time)
  "The box is in r1 after a placing action."
  (and (exists (?region) (happens (put-down ?region) ?time))
       (holds-at (box-in r1) (+ ?time 1))))
