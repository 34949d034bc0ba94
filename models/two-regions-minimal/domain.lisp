;;;; The domain two-regions with a theory in which no action has an effect.  The actions require
;;;; nothing, so that in this theory none of them can fail.

(in-package #:discrepancy-finder-user)

(define-abstraction two-regions-minimal
  "Scene, regions and observers are those of two-regions."
  (:extends "../two-regions/domain.lisp")
  (:theory "theory.lisp"))

(define-action (motion going) (pose target)
  (:domain two-regions-minimal)
  (:event (move (region-of (or pose target)))))

(define-action (action picking-up) ()
  (:domain two-regions-minimal)
  (:event (pick-up))
  (:failure manipulation-low-level-failure))

(define-action (action placing) (target)
  (:domain two-regions-minimal)
  (:event (put-down (region-of target)))
  (:failure manipulation-low-level-failure))
