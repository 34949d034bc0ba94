;;;; The Yale shooting scenario, with the sneeze that Shanahan puts between loading and shooting.
;;;;
;;;; Source: S. Hanks, D. McDermott, Nonmonotonic logic and temporal projection, 1987; the narrative
;;;; is that of M. Shanahan, Solving the Frame Problem, 1997, chapter 1.
;;;; Expected: 1 model.  The gun stays loaded during the sneeze, so the turkey dies by the shot: it
;;;; is not alive, and the gun is empty, at 3.  All events and the initial state are given and
;;;; nothing is ever released, so that there is nothing to choose.

(define-theory yale-shooting
  "A gun is loaded, somebody sneezes, the gun is fired at a turkey."
  (:sorts (bird turkey))
  (:fluents (loaded) (alive bird))
  (:events (load) (sneeze) (shoot bird))
  (:axioms
   (loading-loads (initiates (load) (loaded) ?time))
   (shot-kills (implies (holds-at (loaded) ?time) (terminates (shoot ?bird) (alive ?bird) ?time)))
   (shot-empties (terminates (shoot ?bird) (loaded) ?time)))
  (:facts
   (initially (alive turkey))
   (initially (not (loaded))))
  (:narrative
   (happens (load) 0)
   (happens (sneeze) 1)
   (happens (shoot turkey) 2))
  (:completion happens)
  (:time 0 3))
