;;;; The Russian turkey scenario: spinning the chamber of the gun makes it unknown whether it is
;;;; loaded.
;;;;
;;;; Source: E. Sandewall, Features and Fluents, 1994; in the event calculus with releases: M.
;;;; Shanahan, The event calculus explained, 1999.
;;;; Expected: 2 models.  The spin at 2 releases (loaded), which is therefore free at 3, and only
;;;; there: the shot at 3 terminates it, so that it is inertial and false again from 4 on.  Where it
;;;; is true at 3 the turkey dies, where it is false the turkey lives.

(define-theory russian-turkey
  "Load, spin, shoot: the turkey may live."
  (:sorts (bird turkey))
  (:fluents (loaded) (alive bird))
  (:events (load) (spin) (shoot bird))
  (:axioms
   (initiates (load) (loaded) ?time)
   (releases (spin) (loaded) ?time)
   (implies (holds-at (loaded) ?time) (terminates (shoot ?bird) (alive ?bird) ?time))
   (terminates (shoot ?bird) (loaded) ?time))
  (:facts
   (initially (and (alive turkey) (not (loaded)))))
  (:narrative
   (happens (load) 1)
   (happens (spin) 2)
   (happens (shoot turkey) 3))
  (:completion happens)
  (:time 0 5))
