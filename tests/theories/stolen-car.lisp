;;;; The stolen car scenario: explain why a parked car is gone.
;;;;
;;;; Source: H. Kautz, The logic of persistence, 1986; as abduction in M. Shanahan, Solving the
;;;; Frame Problem, 1997.
;;;; Expected: 1 model: the theft happens at 1.  Events are open (nothing is completed).  At 0 the
;;;; car is not parked, so it cannot be stolen; that it is parked at 0 and gone at 2 leaves only the
;;;; timepoint 1 for the theft, and a parked car cannot be parked.

(define-theory stolen-car
  "The car is parked at 0 and not there at 2: what happened?"
  (:fluents (parked))
  (:events (park) (steal))
  (:axioms
   (initiates (park) (parked) ?time)
   (terminates (steal) (parked) ?time)
   (implies (happens (park) ?time) (not (holds-at (parked) ?time)))
   (implies (happens (steal) ?time) (holds-at (parked) ?time)))
  (:facts
   (not (holds-at (parked) 0))
   (happens (park) 0)
   (not (holds-at (parked) 2)))
  (:time 0 2))
