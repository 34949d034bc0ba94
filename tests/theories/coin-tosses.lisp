;;;; Three tosses of a coin.
;;;;
;;;; Source: G. Kartha 1994, in M. Shanahan, Solving the Frame Problem, 1997; with a determining
;;;; fluent as in Shanahan, The event calculus explained, 1999.
;;;; Expected: 8 models, two outcomes for each of the tosses at 1, 2 and 3.  The determining fluent
;;;; is free at every timepoint, so it is fixed at 0 and 4, where nothing is tossed.

(define-theory coin-tosses
  "A toss makes the coin show what the fluent its-heads says at that timepoint."
  (:sorts (coin coin1))
  (:fluents (heads coin))
  (:non-inertial-fluents (its-heads coin))
  (:events (toss coin))
  (:axioms
   (implies (holds-at (its-heads ?coin) ?time) (initiates (toss ?coin) (heads ?coin) ?time))
   (implies (not (holds-at (its-heads ?coin) ?time)) (terminates (toss ?coin) (heads ?coin) ?time)))
  (:facts
   (holds-at (heads coin1) 0)
   (holds-at (its-heads coin1) 0)
   (holds-at (its-heads coin1) 4))
  (:narrative
   (happens (toss coin1) 1)
   (happens (toss coin1) 2)
   (happens (toss coin1) 3))
  (:completion happens)
  (:time 0 4))
