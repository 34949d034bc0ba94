;;;; A bowl of soup is lifted at both sides at once.
;;;;
;;;; Source: M. Gelfond, V. Lifschitz, A. Rabinov, What are the limitations of the situation
;;;; calculus?, 1991; in the event calculus: R. Miller, M. Shanahan, 1999.
;;;; Expected: 1 model.  Lifting left and right at 0 raises the bowl and spills nothing.

(define-theory bowl
  "Lifted at one side only, a full bowl is spilt."
  (:sorts (vessel bowl))
  (:fluents (raised vessel) (spilt vessel))
  (:events (lift-left vessel) (lift-right vessel))
  (:axioms
   (implies (happens (lift-right ?vessel) ?time)
            (initiates (lift-left ?vessel) (raised ?vessel) ?time))
   (implies (not (happens (lift-right ?vessel) ?time))
            (initiates (lift-left ?vessel) (spilt ?vessel) ?time))
   (implies (not (happens (lift-left ?vessel) ?time))
            (initiates (lift-right ?vessel) (spilt ?vessel) ?time)))
  (:facts
   (not (holds-at (raised bowl) 0))
   (not (holds-at (spilt bowl) 0)))
  (:narrative
   (happens (lift-left bowl) 0)
   (happens (lift-right bowl) 0))
  (:completion happens)
  (:time 0 1))
