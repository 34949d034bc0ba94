;;;; A coin is thrown onto a chess board: it comes to lie on black, on white, or on both.
;;;;
;;;; Source: R. Reiter's example, in M. Shanahan, Solving the Frame Problem, 1997, on
;;;; non-deterministic effects; with determining fluents as in Shanahan, The event calculus
;;;; explained, 1999.
;;;; Expected: 3 models: black, white, both.  The determining fluents are released at all times, so
;;;; each timepoint would have its own three choices; they are fixed at 0 and 2, where they
;;;; determine nothing.

(define-theory chess-board
  "Where the coin lies is determined by two free fluents of which one at least is true."
  (:fluents (on-black) (on-white))
  (:non-inertial-fluents (falls-on-black) (falls-on-white))
  (:events (throw))
  (:axioms
   (somewhere (or (holds-at (falls-on-black) ?time) (holds-at (falls-on-white) ?time)))
   (implies (holds-at (falls-on-black) ?time) (initiates (throw) (on-black) ?time))
   (implies (holds-at (falls-on-white) ?time) (initiates (throw) (on-white) ?time)))
  (:facts
   (not (holds-at (on-black) 0))
   (not (holds-at (on-white) 0))
   (holds-at (falls-on-black) 0)
   (holds-at (falls-on-white) 0)
   (holds-at (falls-on-black) 2)
   (holds-at (falls-on-white) 2))
  (:narrative (happens (throw) 1))
  (:completion happens)
  (:time 0 2))
