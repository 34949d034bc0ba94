;;;; Happiness as a derived fluent.
;;;;
;;;; Source: M. Shanahan, The event calculus explained, 1999, on state constraints.
;;;; Expected: 1 model.  Fred is fed at 1 and happy at 2; before he is hungry and not happy.

(define-theory happy
  "Who is neither hungry nor cold is happy."
  (:sorts (person fred))
  (:fluents (hungry person) (cold person))
  (:non-inertial-fluents (happy person))
  (:events (feed person) (clothe person))
  (:axioms
   (iff (holds-at (happy ?person) ?time)
        (and (not (holds-at (hungry ?person) ?time)) (not (holds-at (cold ?person) ?time))))
   (terminates (feed ?person) (hungry ?person) ?time)
   (terminates (clothe ?person) (cold ?person) ?time))
  (:facts
   (holds-at (hungry fred) 0)
   (not (holds-at (cold fred) 0)))
  (:narrative (happens (feed fred) 1))
  (:completion happens)
  (:time 0 2))
