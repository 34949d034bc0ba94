;;;; The domain of plans that look into drawers: the kitchen with nothing but the spoon, which may
;;;; lie anywhere in its drawer, and with wider places before the drawers.

(in-package #:discrepancy-finder-user)

(define-abstraction kitchen-drawers
  "The spoon lies across a drawer, in the middle, at a side, or far in front or back, as far as the
drawer's walls permit.  All poses from which the plan looks into a drawer are in one region."
  (:extends "domain.lisp")
  (:theory "drawers-theory.lisp")
  (:items spoon)
  (:region before-drawer-1 (box (x -1.25 -0.95) (y -0.8 -0.3)))
  (:region before-drawer-2 (box (x -1.25 -0.95) (y -0.2 0.3)))
  (:region before-drawer-3 (box (x -1.25 -0.95) (y 0.4 0.9)))
  (:placement (in spoon ?drawer) :body spoon
              :coordinates ((x -2.285 -1.955) (y (middle 0.24)) (z 0.6105) (yaw 1.47 1.67))))
