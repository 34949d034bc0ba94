;;;; The domain of Example 1: how the theory's words map to the scene, and what the plan's actions
;;;; mean in the theory.

(in-package #:discrepancy-finder-user)

(define-abstraction two-regions
  "Regions bound x only.  The robot stands on the line y = 0, along which it drives, and looks along
it give or take 0.1 rad.  The box lies on the bench, at y = 0.4 m give or take 2 cm, turned anyhow."
  (:theory "theory.lisp")
  (:scene "scene.lisp")
  (:region r1 (interval :x 0 1))
  (:region r2 (interval :x 1 2))
  (:placement (robot-in ?region) :body robot :coordinates (x (yaw -0.1 0.1)))
  (:placement (box-in ?region) :body box
              :coordinates (x (y 0.38 0.42) (yaw -3.14159 3.14159)))
  (:attachment (holding-box) :item box))

(define-action (motion going) (pose target)
  (:domain two-regions)
  (:event (move (region-of (or pose target)))))

(define-action (action picking-up) ()
  (:domain two-regions)
  (:event (pick-up))
  (:requires (and (not (holding-box))
                  (exists (?region) (and (robot-in ?region) (box-in ?region)))))
  (:failure manipulation-pose-unreachable))

(define-action (action placing) (target)
  (:domain two-regions)
  (:event (put-down (region-of target)))
  (:requires (and (holding-box) (robot-in (region-of target))))
  (:failure manipulation-pose-unreachable))
