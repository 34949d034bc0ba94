;;;; The stuffy room scenario: an indirect effect of closing the second of two vents.
;;;;
;;;; Source: M. Ginsberg, D. Smith, Reasoning about action I: a possible worlds approach, 1988; in
;;;; the event calculus: M. Shanahan, Solving the Frame Problem, 1997.
;;;; Expected: 1 model; stuffy at 2, after the second vent is blocked, and not before.  The derived
;;;; fluent is fixed by the constraint at every timepoint.

(define-theory stuffy-room
  "With both vents blocked the room is stuffy."
  (:sorts (vent vent1 vent2))
  (:fluents (blocked vent))
  (:non-inertial-fluents (stuffy))
  (:events (start) (close vent))
  (:axioms
   (implies (= ?vent vent1) (initiates (start) (blocked ?vent) ?time))
   (implies (/= ?vent vent1) (terminates (start) (blocked ?vent) ?time))
   (initiates (close ?vent) (blocked ?vent) ?time)
   (iff (holds-at (stuffy) ?time) (forall (?vent) (holds-at (blocked ?vent) ?time))))
  (:facts (initially (forall (?vent) (not (blocked ?vent)))))
  (:narrative
   (happens (start) 0)
   (happens (close vent2) 1))
  (:completion happens)
  (:time 0 3))
