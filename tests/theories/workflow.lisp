;;;; A workflow: sequence, parallel split, join, choice.
;;;;
;;;; Source: N. K. Cicekli, Y. Yildirim, Formalizing workflows using the event calculus, 2000; E.
;;;; Mueller, Commonsense Reasoning, 2006, chapter 14.
;;;; Expected: 1 model: A 0-1, then B 2-3 and C 2-4, then D 5-6 when both are completed, then E 7-8
;;;; because the order is urgent (otherwise F).  Sentences speak of the timepoint before, so they
;;;; have no instance at 0.

(define-theory workflow
  "An activity starts one timepoint after those that it waits for have ended."
  (:sorts (activity a b c d e f))
  (:fluents (active activity) (completed activity) (urgent))
  (:events (start activity) (end activity))
  (:axioms
   (initiates (start ?activity) (active ?activity) ?time)
   (terminates (end ?activity) (active ?activity) ?time)
   (initiates (end ?activity) (completed ?activity) ?time)
   (one-unit (implies (and (happens (start ?activity) (- ?time 1)) (/= ?activity c))
                      (happens (end ?activity) ?time)))
   (two-units-for-c (implies (happens (start c) (- ?time 2)) (happens (end c) ?time)))
   (split (implies (and (happens (end a) (- ?time 1)) (or (= ?activity b) (= ?activity c)))
                   (happens (start ?activity) ?time)))
   (join (implies (and (holds-at (completed b) ?time) (holds-at (completed c) ?time)
                       (not (and (holds-at (completed b) (- ?time 1))
                                 (holds-at (completed c) (- ?time 1)))))
                  (happens (start d) ?time)))
   (choice (implies (and (happens (end d) (- ?time 1)) (holds-at (urgent) ?time))
                    (happens (start e) ?time)))
   (otherwise (implies (and (happens (end d) (- ?time 1)) (not (holds-at (urgent) ?time)))
                       (happens (start f) ?time))))
  (:facts
   (initially (urgent))
   (initially (forall (?activity) (not (active ?activity))))
   (initially (forall (?activity) (not (completed ?activity)))))
  (:narrative (happens (start a) 0))
  (:completion happens)
  (:time 0 9))
