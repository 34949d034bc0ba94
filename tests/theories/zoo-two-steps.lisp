;;;; A small zoo: what can happen at two timepoints?
;;;;
;;;; Source: V. Akman, S. Erdogan, J. Lee, V. Lifschitz, H. Turner, Representing the Zoo World and
;;;; the Traffic World in the language of the Causal Calculator, 2004; the Zoo World is E.
;;;; Sandewall's.  Here there are four positions in a row, P1 and P2 in the cage, P3 and P4 outside,
;;;; a gate between P2 and P3, an elephant at P1 and its keeper at P3; the gate is closed.
;;;; Expected: 35 models.  After the first step: keeper at P3 (gate closed or opened) or P4,
;;;; elephant at P1 or P2.  Second steps: gate closed, keeper at P3: 3 x 2 for each place of the
;;;; elephant; keeper at P4: 2 x 2 for each; gate open: the keeper stays, moves to P4 or P2, or
;;;; closes the gate, the elephant at P1 stays or moves to P2, 4 x 2 less the one where both come to
;;;; P2; the elephant at P2 stays, moves to P1 or to P3, 4 x 3 less staying or closing at P3 while
;;;; the elephant comes there, less coming to P2 where it stays, less swapping.  12 + 8 + 7 + 8 =
;;;; 35.

(define-theory zoo-two-steps
  "Two steps."
  (:sorts (animal elephant) (human (:parent animal) keeper)
          (position p1 p2 p3 p4) (gate gate1))
  (:predicates (neighbor position position) (passage gate position position)
               (done-by event animal))
  (:fluents (at animal position) (opened gate))
  (:events (move animal position) (open human gate) (close human gate))
  (:axioms
   (done-by
    (iff (done-by ?event ?animal)
         (or (exists (?position) (= ?event (move ?animal ?position)))
             (exists (?gate) (= ?event (open ?animal ?gate)))
             (exists (?gate) (= ?event (close ?animal ?gate))))))
   (one-event-of-an-animal
    (implies (and (happens ?event1 ?time) (happens ?event2 ?time)
                  (done-by ?event1 ?animal) (done-by ?event2 ?animal))
             (= ?event1 ?event2)))

   (initiates (move ?animal ?position) (at ?animal ?position) ?time)
   (implies (and (holds-at (at ?animal ?position1) ?time) (/= ?position1 ?position2))
            (terminates (move ?animal ?position2) (at ?animal ?position1) ?time))
   (initiates (open ?human ?gate) (opened ?gate) ?time)
   (terminates (close ?human ?gate) (opened ?gate) ?time)

   (only-to-neighbors
    (implies (and (happens (move ?animal ?position2) ?time)
                  (holds-at (at ?animal ?position1) ?time))
             (neighbor ?position1 ?position2)))
   (gate-must-be-open
    (implies (and (happens (move ?animal ?position2) ?time)
                  (holds-at (at ?animal ?position1) ?time)
                  (passage ?gate ?position1 ?position2))
             (holds-at (opened ?gate) ?time)))
   (hand-on-the-gate
    (implies (or (happens (open ?human ?gate) ?time) (happens (close ?human ?gate) ?time))
             (exists (?position1 ?position2)
                     (and (holds-at (at ?human ?position1) ?time)
                          (passage ?gate ?position1 ?position2)))))
   (implies (happens (open ?human ?gate) ?time) (not (holds-at (opened ?gate) ?time)))
   (implies (happens (close ?human ?gate) ?time) (holds-at (opened ?gate) ?time))

   (somewhere (exists (?position) (holds-at (at ?animal ?position) ?time)))
   (implies (and (holds-at (at ?animal ?position1) ?time)
                 (holds-at (at ?animal ?position2) ?time))
            (= ?position1 ?position2))
   (one-to-a-position
    (implies (and (holds-at (at ?animal1 ?position) ?time)
                  (holds-at (at ?animal2 ?position) ?time))
             (= ?animal1 ?animal2)))
   (no-swapping
    (implies (and (holds-at (at ?animal1 ?position1) ?time)
                  (holds-at (at ?animal2 ?position2) ?time)
                  (/= ?animal1 ?animal2)
                  (holds-at (at ?animal1 ?position2) (+ ?time 1)))
             (not (holds-at (at ?animal2 ?position1) (+ ?time 1))))))
  (:facts
   (iff (neighbor ?position1 ?position2)
        (or (and (= ?position1 p1) (= ?position2 p2)) (and (= ?position1 p2) (= ?position2 p1))
            (and (= ?position1 p2) (= ?position2 p3)) (and (= ?position1 p3) (= ?position2 p2))
            (and (= ?position1 p3) (= ?position2 p4)) (and (= ?position1 p4) (= ?position2 p3))))
   (iff (passage ?gate ?position1 ?position2)
        (or (and (= ?position1 p2) (= ?position2 p3)) (and (= ?position1 p3) (= ?position2 p2))))
   (holds-at (at keeper p3) 0)
   (holds-at (at elephant p1) 0)
   (not (holds-at (opened gate1) 0)))
  (:time 0 2))
