;;;; The theory of bowl and spoon after two discrepancies: an object can be lost when it is lifted
;;;; or on the way, and an open drawer blocks the way.
;;;;
;;;; Whether something is lost is open: the fluent `slips` is in no way determined, at no timepoint,
;;;; and effects depend on it.  So an event has one effect or another, as the world has it.  Where
;;;; things fall is open in the same way: back to where they were, elsewhere, or to the floor.
;;;;
;;;; This file is data: reading it evaluates nothing.

(define-theory bowl-and-spoon-closing
  "What a modeller writes who has seen an object lost, and the robot stopped by a drawer."
  (:extends "bowl-and-spoon-theory.lisp")
  (:without pick-up-holds pick-up-lifts-off pick-up-takes-out)
  (:predicates (blocks drawer place))
  (:non-inertial-fluents
   ;; what nobody knows beforehand
   (slips item) (lands-on item surface) (lands-in item drawer))
  (:axioms
   ;; Picking up may fail to hold the item; then it is where it falls.
   (pick-up-holds-unless-it-slips
    (implies (not (holds-at (slips ?item) ?time))
             (initiates (pick-up ?arm ?item) (holding ?arm ?item) ?time)))
   (pick-up-lifts-off-unless-it-falls-back
    (implies (not (and (holds-at (slips ?item) ?time)
                       (holds-at (lands-on ?item ?surface) ?time)))
             (terminates (pick-up ?arm ?item) (on ?item ?surface) ?time)))
   (pick-up-takes-out-unless-it-falls-back
    (implies (not (and (holds-at (slips ?item) ?time)
                       (holds-at (lands-in ?item ?drawer) ?time)))
             (terminates (pick-up ?arm ?item) (in ?item ?drawer) ?time)))

   ;; Moving the torso, the arm or the base may lose what is held.
   (moving-the-torso-may-lose
    (implies (and (holds-at (holding ?arm ?item) ?time) (holds-at (slips ?item) ?time))
             (terminates (move-torso ?height) (holding ?arm ?item) ?time)))
   (parking-may-lose
    (implies (and (holds-at (holding ?arm ?item) ?time) (holds-at (slips ?item) ?time))
             (terminates (park ?arm) (holding ?arm ?item) ?time)))
   (navigating-may-lose
    (implies (and (holds-at (holding ?arm ?item) ?time) (holds-at (slips ?item) ?time))
             (terminates (navigate ?place) (holding ?arm ?item) ?time)))

   ;; What is lost so may fall onto a surface or into a drawer, else it is on the floor.
   (lost-with-the-torso-onto-a-surface
    (implies (and (holds-at (held ?item) ?time) (holds-at (slips ?item) ?time)
                  (holds-at (lands-on ?item ?surface) ?time))
             (initiates (move-torso ?height) (on ?item ?surface) ?time)))
   (lost-with-the-torso-into-a-drawer
    (implies (and (holds-at (held ?item) ?time) (holds-at (slips ?item) ?time)
                  (holds-at (lands-in ?item ?drawer) ?time))
             (initiates (move-torso ?height) (in ?item ?drawer) ?time)))
   (lost-in-parking-onto-a-surface
    (implies (and (holds-at (holding ?arm ?item) ?time) (holds-at (slips ?item) ?time)
                  (holds-at (lands-on ?item ?surface) ?time))
             (initiates (park ?arm) (on ?item ?surface) ?time)))
   (lost-in-parking-into-a-drawer
    (implies (and (holds-at (holding ?arm ?item) ?time) (holds-at (slips ?item) ?time)
                  (holds-at (lands-in ?item ?drawer) ?time))
             (initiates (park ?arm) (in ?item ?drawer) ?time)))
   (lost-on-the-way-onto-a-surface
    (implies (and (holds-at (held ?item) ?time) (holds-at (slips ?item) ?time)
                  (holds-at (lands-on ?item ?surface) ?time))
             (initiates (navigate ?place) (on ?item ?surface) ?time)))
   (lost-on-the-way-into-a-drawer
    (implies (and (holds-at (held ?item) ?time) (holds-at (slips ?item) ?time)
                  (holds-at (lands-in ?item ?drawer) ?time))
             (initiates (navigate ?place) (in ?item ?drawer) ?time)))

   ;; Open, the middle drawer is where the robot would stand before the workspace.
   (middle-drawer-blocks-the-workspace
    (iff (blocks ?drawer ?place) (and (= ?drawer drawer-2) (= ?place before-workspace))))
   (navigate-needs-a-place-that-no-drawer-blocks
    (implies (and (happens (navigate ?place) ?time) (blocks ?drawer ?place))
             (not (holds-at (open ?drawer) ?time))))))
