;;;; A hungry cat revises its plan when the chair is pushed away.
;;;;
;;;; Source: M. Winikoff, L. Padgham, J. Harland, J. Thangarajah, Declarative and procedural goals
;;;; in intelligent agent systems, 2002; E. Mueller, Commonsense Reasoning, 2006, chapter 11
;;;; (beliefs, goals and plans as fluents whose arguments are reified beliefs).
;;;; Expected: 1 model.  The cat adopts plan P1 (floor, chair, shelf, eat Food1) at 0 and jumps onto
;;;; the chair at 1, when the chair is shifted; at 2 it believes that the shelf is out of reach and
;;;; drops P1, at 3 it adopts P1A (chair, table, eat Food2), jumps at 4, eats at 5 and drops the
;;;; plan of the attained goal at 6.  Beliefs are those of the true initial state, and every event
;;;; but the shift is triggered, so that nothing is open.

(define-theory hungry-cat
  "Beliefs follow the events; a plan is dropped when it is believed unsound or unnecessary."
  (:sorts (object)
          (agent (:parent object) cat)
          (food (:parent object) food1 food2)
          (surface floor chair shelf table)
          (plan p1 p1a)
          (belief (:terms (b-on object surface) (b-can-jump surface surface) (b-satiated agent))))
  (:fluents (on object surface) (can-jump surface surface) (satiated agent)
            (believe agent belief) (goal agent belief) (plan agent belief plan))
  (:events (add-plan agent belief plan) (drop-plan agent belief plan)
           (jump agent surface surface) (eat agent food) (shift-chair))
  (:axioms
   ;; The world.
   (initiates (jump ?agent ?surface1 ?surface2) (on ?agent ?surface2) ?time)
   (terminates (jump ?agent ?surface1 ?surface2) (on ?agent ?surface1) ?time)
   (initiates (eat ?agent ?food) (satiated ?agent) ?time)
   (implies (holds-at (on ?food ?surface) ?time)
            (terminates (eat ?agent ?food) (on ?food ?surface) ?time))
   (terminates (shift-chair) (can-jump chair shelf) ?time)
   (initiates (shift-chair) (can-jump chair table) ?time)
   (implies (happens (jump ?agent ?surface1 ?surface2) ?time)
            (and (holds-at (on ?agent ?surface1) ?time)
                 (holds-at (can-jump ?surface1 ?surface2) ?time)))
   (implies (happens (eat ?agent ?food) ?time)
            (exists (?surface) (and (holds-at (on ?agent ?surface) ?time)
                                    (holds-at (on ?food ?surface) ?time))))

   ;; Beliefs about it.
   (initiates (jump ?agent ?surface1 ?surface2) (believe ?agent (b-on ?agent ?surface2)) ?time)
   (terminates (jump ?agent ?surface1 ?surface2) (believe ?agent (b-on ?agent ?surface1)) ?time)
   (initiates (eat ?agent ?food) (believe ?agent (b-satiated ?agent)) ?time)
   (implies (holds-at (believe ?agent (b-on ?food ?surface)) ?time)
            (terminates (eat ?agent ?food) (believe ?agent (b-on ?food ?surface)) ?time))
   (terminates (shift-chair) (believe ?agent (b-can-jump chair shelf)) ?time)
   (initiates (shift-chair) (believe ?agent (b-can-jump chair table)) ?time)

   ;; Plans.
   (initiates (add-plan ?agent ?belief ?plan) (plan ?agent ?belief ?plan) ?time)
   (terminates (drop-plan ?agent ?belief ?plan) (plan ?agent ?belief ?plan) ?time)
   (adopt-p1
    (implies (and (holds-at (goal ?agent (b-satiated ?agent)) ?time)
                  (not (holds-at (believe ?agent (b-satiated ?agent)) ?time))
                  (forall (?plan) (not (holds-at (plan ?agent (b-satiated ?agent) ?plan) ?time)))
                  (holds-at (believe ?agent (b-on ?agent floor)) ?time)
                  (holds-at (believe ?agent (b-can-jump floor chair)) ?time)
                  (holds-at (believe ?agent (b-can-jump chair shelf)) ?time)
                  (holds-at (believe ?agent (b-on food1 shelf)) ?time))
             (happens (add-plan ?agent (b-satiated ?agent) p1) ?time)))
   (adopt-p1a
    (implies (and (holds-at (goal ?agent (b-satiated ?agent)) ?time)
                  (not (holds-at (believe ?agent (b-satiated ?agent)) ?time))
                  (forall (?plan) (not (holds-at (plan ?agent (b-satiated ?agent) ?plan) ?time)))
                  (holds-at (believe ?agent (b-on ?agent chair)) ?time)
                  (holds-at (believe ?agent (b-can-jump chair table)) ?time)
                  (holds-at (believe ?agent (b-on food2 table)) ?time))
             (happens (add-plan ?agent (b-satiated ?agent) p1a) ?time)))
   (drop-unsound-p1
    (implies (and (holds-at (plan ?agent (b-satiated ?agent) p1) ?time)
                  (not (holds-at (believe ?agent (b-can-jump chair shelf)) ?time)))
             (happens (drop-plan ?agent (b-satiated ?agent) p1) ?time)))
   (drop-unnecessary
    (implies (and (holds-at (plan ?agent ?belief ?plan) ?time)
                  (holds-at (believe ?agent ?belief) ?time))
             (happens (drop-plan ?agent ?belief ?plan) ?time)))
   (step1-of-p1
    (implies (and (holds-at (plan ?agent (b-satiated ?agent) p1) ?time)
                  (holds-at (believe ?agent (b-can-jump chair shelf)) ?time)
                  (holds-at (believe ?agent (b-on ?agent floor)) ?time))
             (happens (jump ?agent floor chair) ?time)))
   (step2-of-p1
    (implies (and (holds-at (plan ?agent (b-satiated ?agent) p1) ?time)
                  (holds-at (believe ?agent (b-can-jump chair shelf)) ?time)
                  (holds-at (believe ?agent (b-on ?agent chair)) ?time))
             (happens (jump ?agent chair shelf) ?time)))
   (step3-of-p1
    (implies (and (holds-at (plan ?agent (b-satiated ?agent) p1) ?time)
                  (not (holds-at (believe ?agent (b-satiated ?agent)) ?time))
                  (holds-at (believe ?agent (b-on ?agent shelf)) ?time))
             (happens (eat ?agent food1) ?time)))
   (step1-of-p1a
    (implies (and (holds-at (plan ?agent (b-satiated ?agent) p1a) ?time)
                  (holds-at (believe ?agent (b-on ?agent chair)) ?time))
             (happens (jump ?agent chair table) ?time)))
   (step2-of-p1a
    (implies (and (holds-at (plan ?agent (b-satiated ?agent) p1a) ?time)
                  (not (holds-at (believe ?agent (b-satiated ?agent)) ?time))
                  (holds-at (believe ?agent (b-on ?agent table)) ?time))
             (happens (eat ?agent food2) ?time))))
  (:facts
   (iff (holds-at (on ?agent ?surface) 0) (= ?surface floor))
   (iff (holds-at (on ?food ?surface) 0)
        (or (and (= ?food food1) (= ?surface shelf)) (and (= ?food food2) (= ?surface table))))
   (iff (holds-at (can-jump ?surface1 ?surface2) 0)
        (or (and (= ?surface1 floor) (= ?surface2 chair))
            (and (= ?surface1 chair) (= ?surface2 shelf))))
   (not (holds-at (satiated ?agent) 0))
   (iff (holds-at (believe ?agent (b-on ?object ?surface)) 0) (holds-at (on ?object ?surface) 0))
   (iff (holds-at (believe ?agent (b-can-jump ?surface1 ?surface2)) 0)
        (holds-at (can-jump ?surface1 ?surface2) 0))
   (not (holds-at (believe ?agent1 (b-satiated ?agent2)) 0))
   (iff (holds-at (goal ?agent ?belief) 0) (= ?belief (b-satiated ?agent)))
   (not (holds-at (plan ?agent ?belief ?plan) 0)))
  (:narrative (happens (shift-chair) 1))
  (:completion happens)
  (:time 0 7))
