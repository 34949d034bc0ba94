;;;; The bus ride scenario: a disjunctive event axiom, explained by an observation.
;;;;
;;;; Source: G. Kartha, Two counterexamples related to Baker's approach to the frame problem, 1994;
;;;; in the event calculus: M. Shanahan, Solving the Frame Problem, 1997.
;;;; Expected: 1 model: the red bus was boarded at 1.  By completion a bus is boarded only if
;;;; boarding happens and the other bus is not boarded, so there are two models without the
;;;; observation.

(define-theory bus-ride
  "Whoever boards takes the red or the yellow bus; with a ticket only."
  (:fluents (has-ticket) (on-red) (on-yellow))
  (:events (buy-ticket) (board) (board-red) (board-yellow))
  (:axioms
   (initiates (buy-ticket) (has-ticket) ?time)
   (initiates (board-red) (on-red) ?time)
   (initiates (board-yellow) (on-yellow) ?time)
   (implies (happens (board-red) ?time) (holds-at (has-ticket) ?time))
   (implies (happens (board-yellow) ?time) (holds-at (has-ticket) ?time))
   (one-bus (not (and (holds-at (on-red) ?time) (holds-at (on-yellow) ?time))))
   (which-bus :label delta
    (implies (happens (board) ?time)
             (or (happens (board-red) ?time) (happens (board-yellow) ?time)))))
  (:facts
   (initially (not (has-ticket)))
   (initially (not (on-red)))
   (initially (not (on-yellow)))
   (seen-in-the-red-bus (holds-at (on-red) 2)))
  (:narrative
   (buying :label delta (happens (buy-ticket) 0))
   (boarding :label delta (happens (board) 1)))
  (:completion (delta happens))
  (:time 0 2))
