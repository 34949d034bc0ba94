;;;; The shooting scenario with a derived fluent: to be dead is not to be alive.
;;;;
;;;; Source: M. Shanahan, Solving the Frame Problem, 1997, on state constraints (after A. Baker
;;;; 1991).
;;;; Expected: 1 model.  The victim is dead from 3 on.  Dead is not inertial, but the constraint
;;;; fixes it at every timepoint, so that it adds no models; were it inertial, the theory would be
;;;; inconsistent, since no event terminates it.

(define-theory dead-or-alive
  "Whoever is not alive is dead."
  (:sorts (person sam))
  (:fluents (loaded) (alive person))
  (:non-inertial-fluents (dead person))
  (:events (load) (wait) (shoot person))
  (:axioms
   (dead-or-alive (iff (holds-at (dead ?person) ?time) (not (holds-at (alive ?person) ?time))))
   (initiates (load) (loaded) ?time)
   (implies (holds-at (loaded) ?time) (terminates (shoot ?person) (alive ?person) ?time))
   (terminates (shoot ?person) (loaded) ?time))
  (:facts
   (holds-at (alive sam) 0)
   (not (holds-at (loaded) 0)))
  (:narrative
   (happens (load) 0)
   (happens (wait) 1)
   (happens (shoot sam) 2))
  (:completion happens)
  (:time 0 3))
