;;;; The monkey and the bananas: postdiction.
;;;;
;;;; Source: E. Giunchiglia, J. Lee, V. Lifschitz, N. McCain, H. Turner, Nonmonotonic causal
;;;; theories, 2004.
;;;; Expected: 1 model; the monkey walked to L3 and pushed the box from there, so the box was at L3
;;;; at 0.  The box's initial place is the only thing left open.

(define-theory monkey-postdiction
  "Where was the box?"
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
                                       (holds-at (at bananas ?place) ?time))))))
  (:facts
   (holds-at (at monkey l1) 0)
   (holds-at (at bananas l2) 0)
   (not (holds-at (on-box) 0))
   (not (holds-at (has-bananas) 0)))
  (:narrative
   (happens (walk l3) 0)
   (happens (push-box l2) 1))
  (:completion happens)
  (:time 0 2))
