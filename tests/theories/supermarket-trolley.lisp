;;;; The supermarket trolley: pushed and pulled at the same time it spins.
;;;;
;;;; Source: M. Shanahan, Solving the Frame Problem, 1997, and The event calculus explained, 1999,
;;;; on concurrent events with cumulative and cancelling effects.
;;;; Expected: 1 model.  Push and pull at 5, and again at 10, make it spin from 6 on; it never moves
;;;; forwards or backwards, because each event cancels the effect of the other.

(define-theory supermarket-trolley
  "Pushing moves it forwards, pulling backwards, both at once make it spin."
  (:fluents (forwards) (backwards) (spinning))
  (:events (push) (pull))
  (:axioms
   (push-alone (implies (not (happens (pull) ?time)) (initiates (push) (forwards) ?time)))
   (implies (not (happens (pull) ?time)) (terminates (push) (backwards) ?time))
   (implies (not (happens (pull) ?time)) (terminates (push) (spinning) ?time))
   (pull-alone (implies (not (happens (push) ?time)) (initiates (pull) (backwards) ?time)))
   (implies (not (happens (push) ?time)) (terminates (pull) (forwards) ?time))
   (implies (not (happens (push) ?time)) (terminates (pull) (spinning) ?time))
   (both (implies (happens (push) ?time) (initiates (pull) (spinning) ?time)))
   (implies (happens (push) ?time) (terminates (pull) (forwards) ?time))
   (implies (happens (push) ?time) (terminates (pull) (backwards) ?time)))
  (:facts
   (not (holds-at (forwards) 0))
   (not (holds-at (backwards) 0))
   (not (holds-at (spinning) 0)))
  (:narrative
   (happens (push) 5)
   (happens (pull) 5)
   (happens (push) 10)
   (happens (pull) 10))
  (:completion happens)
  (:time 0 12))
