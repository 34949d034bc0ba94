;;;; A derived fluent that is left inertial.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 2, on inconsistency in the event
;;;; calculus.
;;;; Expected: 0 models.  The event makes f true at 1; g is false at 0 and, by DEC6, at 1, which the
;;;; constraint forbids.  With g declared non-inertial there would be one model.

(define-theory inconsistency-4
  "A state constraint at odds with inertia."
  (:fluents (f) (g))
  (:events (e))
  (:axioms
   (initiates (e) (f) ?time)
   (iff (holds-at (f) ?time) (holds-at (g) ?time)))
  (:facts (not (holds-at (f) 0)))
  (:narrative (happens (e) 0))
  (:completion happens)
  (:time 0 1))
