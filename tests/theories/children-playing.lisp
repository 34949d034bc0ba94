;;;; Two children play: what must have happened?
;;;;
;;;; Source: S. Frank, M. Koppen, L. Noordman, W. Vonk, Modeling knowledge-based inferences in story
;;;; comprehension, 2003 (the story world of Bob and Jilly), as constraints between timepoints.
;;;; Expected: 1 model.  Nothing is inertial and nothing happens; sentences about a timepoint and
;;;; the one before connect the states.  Bob won at 1, so a game that can be won was played at 0,
;;;; and not the computer game, since they were outside: soccer.  It rains at 1, so they are inside,
;;;; and play neither soccer nor, it is said, hide-and-seek: the computer game.

(define-theory children-playing
  "Exactly one weather and one game at each timepoint."
  (:sorts (child bob jilly))
  (:non-inertial-fluents (sunny) (raining) (outside) (soccer) (hide-and-seek) (computer-game)
                         (win child))
  (:axioms
   (implies (holds-at (raining) ?time) (not (holds-at (outside) ?time)))
   (implies (holds-at (soccer) ?time) (holds-at (outside) ?time))
   (implies (holds-at (computer-game) ?time) (not (holds-at (outside) ?time)))
   (not (and (holds-at (win bob) ?time) (holds-at (win jilly) ?time)))
   (a-game-before
    (implies (holds-at (win ?child) ?time)
             (or (holds-at (soccer) (- ?time 1)) (holds-at (computer-game) (- ?time 1))))))
  (:xor (sunny raining) (soccer hide-and-seek computer-game))
  (:facts
   (holds-at (outside) 0)
   (not (holds-at (win ?child) 0))
   (holds-at (win bob) 1)
   (holds-at (raining) 1)
   (not (holds-at (hide-and-seek) 1)))
  (:time 0 1))
