;;;; An event that releases and initiates the same fluent.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 2, on inconsistency in the event
;;;; calculus.
;;;; Expected: 0 models.  By DEC11 and DEC12 the fluent is and is not released at 1.

(define-theory inconsistency-2
  "Contradictory effects of one event."
  (:fluents (f))
  (:events (e))
  (:axioms
   (releases (e) (f) ?time)
   (initiates (e) (f) ?time))
  (:narrative (happens (e) 0))
  (:completion happens)
  (:time 0 1))
