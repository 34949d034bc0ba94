;;;; An event that initiates and terminates the same fluent.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 2, on inconsistency in the event
;;;; calculus.
;;;; Expected: 0 models.  By DEC9 and DEC10 the fluent is true and false at 1.

(define-theory inconsistency-1
  "Contradictory effects of one event."
  (:fluents (f))
  (:events (e))
  (:axioms
   (initiates (e) (f) ?time)
   (terminates (e) (f) ?time))
  (:narrative (happens (e) 0))
  (:completion happens)
  (:time 0 1))
