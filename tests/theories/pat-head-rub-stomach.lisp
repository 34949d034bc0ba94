;;;; Patting one's head while rubbing one's stomach.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 8, on concurrency constraints.
;;;; Expected: 0 models.  Nobody can do both at once, and the narrative says that somebody does.

(define-theory pat-head-rub-stomach
  "A narrative that a concurrency constraint forbids."
  (:sorts (agent nathan))
  (:events (pat-head agent) (rub-stomach agent))
  (:axioms
   (not-both (not (and (happens (pat-head ?agent) ?time) (happens (rub-stomach ?agent) ?time)))))
  (:narrative
   (happens (pat-head nathan) 0)
   (happens (rub-stomach nathan) 0))
  (:completion happens)
  (:time 0 1))
