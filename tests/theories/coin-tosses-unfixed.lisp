;;;; Two tosses of a coin whose determining fluent is fixed nowhere.
;;;;
;;;; Source: as coin-tosses; a test of which atoms exist.
;;;; Expected: 8 models.  The determining fluent occurs in the instances of the effect axioms at 0,
;;;; 1 and 2, whether something is tossed there or not, so it is an atom and free there: at 1 and 2
;;;; it decides the tosses, at 0 it makes models that differ in nothing else.  At 3, the last
;;;; timepoint, no event happens, no sentence has an instance with the fluent, and there is no atom
;;;; to count.

(define-theory coin-tosses-unfixed
  "A fluent that no sentence mentions at a timepoint is not counted there."
  (:fluents (heads))
  (:non-inertial-fluents (its-heads))
  (:events (toss))
  (:axioms
   (implies (holds-at (its-heads) ?time) (initiates (toss) (heads) ?time))
   (implies (not (holds-at (its-heads) ?time)) (terminates (toss) (heads) ?time)))
  (:facts (holds-at (heads) 0))
  (:narrative
   (happens (toss) 1)
   (happens (toss) 2))
  (:completion happens)
  (:time 0 3))
