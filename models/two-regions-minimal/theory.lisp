;;;; What a theory of the two regions says before anything is known of the actions.
;;;;
;;;; This file is data: reading it evaluates nothing.

(define-theory two-regions-minimal
  "Where everything can be, and where it is in the beginning.  No action has an effect or needs
anything: what they do is left to be found out, see docs/refinement.md."
  (:sorts (region r1 r2))
  (:fluents (robot-in region) (box-in region) (holding-box))
  (:events (move region) (pick-up) (put-down region))
  (:axioms
   (robot-starts-in-r1 (initially (robot-in r1)))
   (box-starts-in-r2 (initially (box-in r2)))
   (hand-starts-empty (initially (not (holding-box))))

   (robot-somewhere (exists (?region) (holds-at (robot-in ?region) ?time)))
   (robot-in-one-region
    (implies (and (holds-at (robot-in ?region1) ?time) (holds-at (robot-in ?region2) ?time))
             (= ?region1 ?region2)))
   (box-somewhere (exists (?region) (holds-at (box-in ?region) ?time)))
   (box-in-one-region
    (implies (and (holds-at (box-in ?region1) ?time) (holds-at (box-in ?region2) ?time))
             (= ?region1 ?region2)))))
