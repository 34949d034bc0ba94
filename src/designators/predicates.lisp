;;;; Designators in prolog: the predicates with which CRAM's groundings are written.
;;;;
;;;;   (desig-prop ?designator (?key ?value))   each property, by unification
;;;;   (property ?designator (?key ?value))     the same, with the types of values checked
;;;;   (current-designator ?d ?current)         the youngest of the chain
;;;;   (designator-groundings ?d ?solutions)    the lazy list of its solutions, for MEMBER
;;;;   (action-grounding ?d ?solution), (motion-grounding ?d ?solution),
;;;;   (location-grounding ?d ?pose)            what designators mean; fact groups add to these.

(in-package #:discrepancy-finder.designators)

(defmethod unify-p ((first designator) (second designator))
  (desig-equal first second))

(defun groundings-or-nil (designator)
  (handler-case (designator-groundings designator)
    (designator-error () nil)))

(defun reference-or-nil (designator)
  (handler-case (reference designator)
    (designator-error () nil)))

(def-fact-group designator-classes ()
  (<- (designator? ?designator)
    (lisp-type ?designator designator))
  (<- (action-desig? ?designator)
    (lisp-type ?designator action-designator))
  (<- (motion-desig? ?designator)
    (lisp-type ?designator motion-designator))
  (<- (loc-desig? ?designator)
    (lisp-type ?designator location-designator))
  (<- (obj-desig? ?designator)
    (lisp-type ?designator object-designator))
  (<- (human-desig? ?designator)
    (lisp-type ?designator human-designator)))

(def-fact-group designator-properties (desig-location-prop)
  (<- (desig-prop ?designator ?property)
    (lisp-type ?designator designator)
    (lisp-fun properties ?designator ?properties)
    (member ?property ?properties))

  (<- (property ?designator (?key ?value))
    (desig-prop ?designator (?key ?value))
    (lisp-pred property-of-type-p ?designator ?key ?value))

  ;; The pose that a location or an object bears in its description.
  (<- (desig-location-prop ?designator ?pose)
    (or (loc-desig? ?designator) (obj-desig? ?designator))
    (desig-prop ?designator (:pose ?value))
    (lisp-fun designated-pose ?value ?pose)
    (lisp-pred identity ?pose)))

(def-fact-group designator-chains ()
  (<- (designator ?class ?description ?designator)
    (bound ?class)
    (bound ?description)
    (lisp-fun make-designator ?class ?description ?designator))

  (<- (current-designator ?designator ?current)
    (lisp-type ?designator designator)
    (lisp-fun current-desig ?designator ?current))

  (<- (desig-equal ?first ?second)
    (lisp-pred desig-equal ?first ?second)))

(def-fact-group designator-solutions (action-grounding motion-grounding location-grounding)
  (<- (designator-groundings ?designator ?solutions)
    (lisp-type ?designator designator)
    (lisp-fun groundings-or-nil ?designator ?solutions)
    (lisp-pred identity ?solutions))

  (<- (desig-solution ?designator ?solution)
    (designator-groundings ?designator ?solutions)
    (member ?solution ?solutions))

  (<- (desig-reference ?designator ?solution)
    (lisp-type ?designator designator)
    (lisp-fun reference-or-nil ?designator ?solution)
    (lisp-pred identity ?solution))

  (<- (desig-solution-not-rejected ?designator ?solution)
    (loc-desig? ?designator)
    (bound ?solution)
    (lisp-pred validate-location-designator-solution ?designator ?solution)))
