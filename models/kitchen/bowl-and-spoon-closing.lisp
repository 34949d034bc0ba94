;;;; The domain of the plan bowl-and-spoon-closing: bowl and spoon, with the theory that has learnt
;;;; from two discrepancies.

(in-package #:discrepancy-finder-user)

(define-abstraction bowl-and-spoon-closing
  "The domain bowl-and-spoon, where an object may be lost and an open drawer blocks the way."
  (:extends "bowl-and-spoon.lisp")
  (:theory "bowl-and-spoon-closing-theory.lisp"))

(define-action (motion going) (pose)
  (:domain bowl-and-spoon-closing)
  (:event (navigate (region-of pose 'place)))
  (:requires (and (parked left) (parked right)
                  (forall (?drawer)
                    (implies (blocks ?drawer (region-of pose 'place)) (not (open ?drawer))))))
  (:failure navigation-low-level-failure))
