;;;; The domain of the plans in the kitchen: how the theory's words map to the scene, and what the
;;;; plans' motions and actions mean in the theory.
;;;;
;;;; A place is a square of 20 cm around where the plans stand.  Surfaces and drawers are as large
;;;; as they are, but for the height: an item that the robot holds over the table, or lifts out of a
;;;; drawer, is not on it or in it any more.  Nothing is below the table, so that its region goes on
;;;; there; that leaves room for the predictions of the confidence rules.
;;;;
;;;; Samples have the bowl, the cereal and the milk apart from each other, each where it is seen and
;;;; reached from before the workspace, and the spoon in the middle of its drawer, where it is seen
;;;; and reached from before it: so what goes wrong is something else.

(in-package #:discrepancy-finder-user)

(define-abstraction kitchen
  "Places are where the robot may stand for what it is to do.  Items are on a surface or in a
drawer, wherever on it or in it."
  (:theory "theory.lisp")
  (:scene "scene.lisp")
  (:region start (box (x -0.8 -0.7) (y -0.05 0.05)))
  (:region before-workspace (box (x -1.47 -1.27) (y 0.04 0.24)))
  (:region before-table (box (x -0.4 -0.2) (y -0.1 0.1)))
  (:region before-drawer-1 (box (x -1.22 -1.02) (y -0.8 -0.6)))
  (:region before-drawer-2 (box (x -1.22 -1.02) (y -0.2 0.0)))
  (:region before-drawer-3 (box (x -1.22 -1.02) (y 0.4 0.6)))
  (:region workspace (box (x -2.5 -1.9) (y -1 1) (z 0.85 0.98)))
  (:region table (box (x 0.1 0.9) (y -0.8 0.8) (z 0.6 0.89)))
  (:region drawer-1 (box (x -2.4 -1.5) (y -0.85 -0.35) (z 0.58 0.7)))
  (:region drawer-2 (box (x -2.4 -1.5) (y -0.25 0.25) (z 0.58 0.7)))
  (:region drawer-3 (box (x -2.4 -1.5) (y 0.35 0.85) (z 0.58 0.7)))
  (:placement (robot-at ?place) :body robot :coordinates (x y (yaw 3.09 3.19)))
  (:placement (on bowl ?surface) :body bowl
              :coordinates ((x -2.15 -2.05) (y -0.4 -0.3) (z 0.8835) (yaw -0.5 0.5)))
  (:placement (on cereal ?surface) :body cereal
              :coordinates ((x -2.15 -2.05) (y 0.25 0.33) (z 0.962) (yaw -0.3 0.3)))
  (:placement (on milk ?surface) :body milk
              :coordinates ((x -2.18 -2.1) (y -0.03 0.07) (z 0.947) (yaw -0.3 0.3)))
  (:placement (on spoon ?surface) :body spoon :coordinates ((x 0.2) (y -0.3) (z 0.7645)))
  (:placement (in spoon ?drawer) :body spoon
              :coordinates ((x -2.14 -2.1) (y (middle 0.06)) (z 0.6105) (yaw 1.47 1.67)))
  (:joint (open drawer-1) :joint "drawer_1_joint" :range (0.3 0.41) :otherwise (0 0))
  (:joint (open drawer-2) :joint "drawer_2_joint" :range (0.3 0.41) :otherwise (0 0))
  (:joint (open drawer-3) :joint "drawer_3_joint" :range (0.3 0.41) :otherwise (0 0))
  (:attachment (holding ?arm ?item) :arm ?arm :item ?item))

(define-action (motion going) (pose)
  (:domain kitchen)
  (:event (navigate (region-of pose 'place)))
  (:requires (and (parked left) (parked right)))
  (:failure navigation-low-level-failure))

(define-action (motion looking) (pose)
  (:domain kitchen)
  (:event (look (if (region-of pose 'surface) 'surface-view 'drawer-view))))

(define-action (motion detecting) (object)
  (:domain kitchen)
  (:event (detect (desig-prop-value object :type)))
  (:requires (visible (desig-prop-value object :type)))
  (:failure perception-object-not-found)
  (:returns object))

(define-action (motion moving-torso) (joint-angle)
  (:domain kitchen)
  (:event (move-torso (if (< joint-angle 0.15) 'low 'high))))

(define-action (motion opening) (gripper)
  (:domain kitchen)
  (:event (open-gripper gripper))
  (:requires (free gripper))
  (:failure gripper-goal-not-reached))

(define-action (action parking-arms) (arms)
  (:domain kitchen)
  (:event (park (first arms))))

(define-action (action picking-up) (object arm)
  (:domain kitchen)
  (:event (pick-up arm (desig-prop-value object :type)))
  (:requires (and (reachable (desig-prop-value object :type))
                  (detected (desig-prop-value object :type))
                  (gripper-open arm)))
  (:failure manipulation-low-level-failure))

(define-action (action placing) (object arm)
  (:domain kitchen)
  (:event (put-down arm (desig-prop-value object :type)))
  (:requires (holding arm (desig-prop-value object :type)))
  (:failure manipulation-low-level-failure))

(define-action (action opening) (object arm)
  (:domain kitchen)
  (:event (open-drawer arm (desig-prop-value object :name)))
  (:requires (free arm))
  (:failure manipulation-low-level-failure))

(define-action (action closing) (object arm)
  (:domain kitchen)
  (:event (close-drawer arm (desig-prop-value object :name))))
