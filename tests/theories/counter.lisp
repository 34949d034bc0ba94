;;;; A counter that counts to three and begins again.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, exercises.
;;;; Expected: 1 model; values 0, 1, 2, 3, 0, 1 at 0 to 5 and 0, by a reset, at 6; overflown from 4
;;;; on.

(define-theory counter
  "Arithmetic modulo 4 in the argument of a fluent."
  (:sorts (counter counter1) (value (:range 0 3)))
  (:fluents (count counter value) (overflown counter))
  (:events (increment counter) (reset counter))
  (:axioms
   (implies (holds-at (count ?counter ?value) ?time)
            (initiates (increment ?counter) (count ?counter (mod (+ ?value 1) 4)) ?time))
   (implies (holds-at (count ?counter ?value) ?time)
            (terminates (increment ?counter) (count ?counter ?value) ?time))
   (implies (holds-at (count ?counter 3) ?time)
            (initiates (increment ?counter) (overflown ?counter) ?time))
   (initiates (reset ?counter) (count ?counter 0) ?time)
   (implies (and (holds-at (count ?counter ?value) ?time) (/= ?value 0))
            (terminates (reset ?counter) (count ?counter ?value) ?time)))
  (:facts
   (iff (holds-at (count counter1 ?value) 0) (= ?value 0))
   (not (holds-at (overflown counter1) 0)))
  (:narrative
   (implies (< ?time 5) (happens (increment counter1) ?time))
   (happens (reset counter1) 5))
  (:completion happens)
  (:time 0 6))
