;;;; The monkey and the bananas: planning.
;;;;
;;;; Source: J. McCarthy 1963; E. Giunchiglia, J. Lee, V. Lifschitz, N. McCain, H. Turner,
;;;; Nonmonotonic causal theories, 2004.
;;;; Expected: 1 model, the plan walk to L3, push the box to L2, climb on, grasp.  Events are open
;;;; and at most one happens at a timepoint; the four steps are needed, so nothing else fits into 4
;;;; timepoints.  The bananas' place is released by the grasp at 3; at 4 the constraints fix it.

(define-theory monkey-planning
  "The bananas are to be had at 4."
  (:sorts (object monkey bananas box) (place l1 l2 l3))
  (:fluents (at object place) (on-box) (has-bananas))
  (:events (walk place) (push-box place) (climb-on) (climb-off) (grasp-bananas))
  (:axioms
   (one-place (implies (and (holds-at (at ?object ?place1) ?time)
                            (holds-at (at ?object ?place2) ?time))
                       (= ?place1 ?place2)))
   (on-the-box-is-at-it (implies (and (holds-at (on-box) ?time) (holds-at (at box ?place) ?time))
                                 (holds-at (at monkey ?place) ?time)))
   (held-bananas-move-along
    (implies (and (holds-at (has-bananas) ?time) (holds-at (at monkey ?place) ?time))
             (holds-at (at bananas ?place) ?time)))

   (initiates (walk ?place) (at monkey ?place) ?time)
   (implies (/= ?place1 ?place2) (terminates (walk ?place1) (at monkey ?place2) ?time))
   (implies (happens (walk ?place) ?time)
            (and (not (holds-at (at monkey ?place) ?time)) (not (holds-at (on-box) ?time))))

   (initiates (push-box ?place) (at box ?place) ?time)
   (initiates (push-box ?place) (at monkey ?place) ?time)
   (implies (/= ?place1 ?place2) (terminates (push-box ?place1) (at box ?place2) ?time))
   (implies (/= ?place1 ?place2) (terminates (push-box ?place1) (at monkey ?place2) ?time))
   (implies (happens (push-box ?place) ?time)
            (and (exists (?place1) (and (holds-at (at monkey ?place1) ?time)
                                        (holds-at (at box ?place1) ?time)))
                 (not (holds-at (at monkey ?place) ?time))
                 (not (holds-at (on-box) ?time))))

   (initiates (climb-on) (on-box) ?time)
   (implies (happens (climb-on) ?time)
            (and (not (holds-at (on-box) ?time))
                 (exists (?place) (and (holds-at (at monkey ?place) ?time)
                                       (holds-at (at box ?place) ?time)))))
   (terminates (climb-off) (on-box) ?time)
   (implies (happens (climb-off) ?time) (holds-at (on-box) ?time))

   (initiates (grasp-bananas) (has-bananas) ?time)
   (releases (grasp-bananas) (at bananas ?place) ?time)
   (implies (happens (grasp-bananas) ?time)
            (and (not (holds-at (has-bananas) ?time))
                 (holds-at (on-box) ?time)
                 (exists (?place) (and (holds-at (at monkey ?place) ?time)
                                       (holds-at (at bananas ?place) ?time)))))
   (one-event-at-a-time
    (implies (and (happens ?event1 ?time) (happens ?event2 ?time)) (= ?event1 ?event2))))
  (:facts
   (holds-at (at monkey l1) 0)
   (holds-at (at bananas l2) 0)
   (holds-at (at box l3) 0)
   (not (holds-at (on-box) 0))
   (not (holds-at (has-bananas) 0))
   (goal (holds-at (has-bananas) 4)))
  (:time 0 4))
