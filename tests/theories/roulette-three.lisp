;;;; A roulette wheel with three numbers is spun.
;;;;
;;;; Source: E. Mueller, A tool for satisfiability-based commonsense reasoning in the event
;;;; calculus, 2004, and Commonsense Reasoning, 2006, chapter 9 (determining fluents are Shanahan's,
;;;; 1999).
;;;; Expected: 3 models, one a number.  The determining fluent has one value at every timepoint; it
;;;; is fixed at 1 and 2, where nothing is spun.

(define-theory roulette-three
  "The spin makes the ball lie on the number that is determined at that timepoint."
  (:sorts (wheel wheel1) (number (:range 0 2)))
  (:fluents (ball-on wheel number))
  (:non-inertial-fluents (falls-on wheel number))
  (:events (spin wheel))
  (:axioms
   (exists (?number) (holds-at (falls-on ?wheel ?number) ?time))
   (implies (and (holds-at (falls-on ?wheel ?number1) ?time)
                 (holds-at (falls-on ?wheel ?number2) ?time))
            (= ?number1 ?number2))
   (implies (holds-at (falls-on ?wheel ?number) ?time)
            (initiates (spin ?wheel) (ball-on ?wheel ?number) ?time))
   (implies (and (holds-at (falls-on ?wheel ?number1) ?time)
                 (holds-at (ball-on ?wheel ?number2) ?time)
                 (/= ?number1 ?number2))
            (terminates (spin ?wheel) (ball-on ?wheel ?number2) ?time)))
  (:facts
   (iff (holds-at (ball-on wheel1 ?number) 0) (= ?number 0))
   (holds-at (falls-on wheel1 0) 1)
   (holds-at (falls-on wheel1 0) 2))
  (:narrative (happens (spin wheel1) 0))
  (:completion happens)
  (:time 0 2))
