;;;; A commuter turns back once and gets to work at the second attempt: a compound event.
;;;;
;;;; Source: M. Shanahan, The event calculus explained, 1999, on compound events (the commuter).
;;;; Expected: 1 model.  The journey is the event from leaving to arriving that nothing interrupts.
;;;; Of the two timepoints of leaving, 0 and 3, only the second begins a journey that ends at 5: the
;;;; first is clipped by turning back at 1.

(define-theory commuter
  "A durative event is a predicate of two timepoints."
  (:predicates (journey time time))
  (:fluents (travelling) (at-work))
  (:events (leave) (turn-back) (arrive))
  (:axioms
   (initiates (leave) (travelling) ?time)
   (terminates (turn-back) (travelling) ?time)
   (terminates (arrive) (travelling) ?time)
   (initiates (arrive) (at-work) ?time)
   (implies (happens (arrive) ?time) (holds-at (travelling) ?time))
   (journey
    (iff (journey ?time1 ?time2)
         (and (happens (leave) ?time1) (happens (arrive) ?time2) (< ?time1 ?time2)
              (not (clipped ?time1 (travelling) ?time2))))))
  (:facts
   (not (holds-at (travelling) 0))
   (not (holds-at (at-work) 0)))
  (:narrative
   (leaving :label delta (happens (leave) 0))
   (turning-back :label delta (happens (turn-back) 1))
   (leaving-again :label delta (happens (leave) 3))
   (arriving :label delta (happens (arrive) 5)))
  (:completion (delta happens))
  (:time 0 6))
