;;;; Approval and disapproval at the same time confuse.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 8, on concurrent events.
;;;; Expected: 1 model.  The child is confused at 1, neither glad nor sad: each event cancels the
;;;; effect of the other and both together have one of their own.

(define-theory approve
  "One parent approves, the other disapproves."
  (:sorts (agent mother father child))
  (:fluents (glad agent) (sad agent) (confused agent))
  (:events (approve-of agent agent) (disapprove-of agent agent))
  (:axioms
   (implies (not (exists (?agent3) (happens (disapprove-of ?agent3 ?agent2) ?time)))
            (initiates (approve-of ?agent1 ?agent2) (glad ?agent2) ?time))
   (implies (not (exists (?agent3) (happens (approve-of ?agent3 ?agent2) ?time)))
            (initiates (disapprove-of ?agent1 ?agent2) (sad ?agent2) ?time))
   (implies (happens (disapprove-of ?agent3 ?agent2) ?time)
            (initiates (approve-of ?agent1 ?agent2) (confused ?agent2) ?time)))
  (:facts
   (not (holds-at (glad ?agent) 0))
   (not (holds-at (sad ?agent) 0))
   (not (holds-at (confused ?agent) 0)))
  (:narrative
   (happens (approve-of mother child) 0)
   (happens (disapprove-of father child) 0))
  (:completion happens)
  (:time 0 2))
