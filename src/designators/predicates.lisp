;;;; Designators in prolog: the predicates with which CRAM's groundings are written.
;;;;
;;;;   (desig-prop ?designator (?key ?value))   each property, by unification
;;;;   (property ?designator (?key ?value))     the same, with the types of values checked
;;;;   (current-designator ?d ?current)         the youngest of the chain
;;;;   (designator-groundings ?d ?solutions)    the lazy list of its solutions, for MEMBER
;;;;   (action-grounding ?d ?solution), (motion-grounding ?d ?solution),
;;;;   (location-grounding ?d ?pose)            what designators mean; fact groups add to these.
;;;;   (default-action-grounding ?d ?solution)  what an action means that has no action-grounding.

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
    (lisp-pred check-property-type ?designator ?key ?value))

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

(def-fact-group designator-solutions (action-grounding default-action-grounding
                                      motion-grounding location-grounding)
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

(macrolet ((document (&rest entries)
             `(progn
                ,@(loop for (name text) on entries by #'cddr
                        collect `(setf (documentation ',name 'predicate) ,text)))))
  (document
   action-grounding "(action-grounding designator solution): the action DESIGNATOR means SOLUTION,
the list of a function and its arguments.  Fact groups add to it."
   default-action-grounding "(default-action-grounding designator solution): the action DESIGNATOR
means SOLUTION, the list of a function and its arguments, if ACTION-GROUNDING has no solution for
it.  What executes plans adds to it."
   motion-grounding "(motion-grounding designator solution): the motion DESIGNATOR means SOLUTION,
the list of a command and its arguments.  Fact groups add to it."
   location-grounding "(location-grounding designator pose): POSE is a place that the location
DESIGNATOR describes.  Fact groups add to it."
   desig-prop "(desig-prop designator property): DESIGNATOR has PROPERTY, (key value)."
   property "(property designator (key value)): like DESIG-PROP; signals PROPERTY-TYPE-ERROR for a
value of a wrong type while *BREAK-ON-LISP-ERRORS* is true."
   desig-location-prop "(desig-location-prop designator pose): the description of DESIGNATOR, a
location or an object, has POSE as its :pose.  Fact groups add to it."
   current-designator "(current-designator designator current): CURRENT is the youngest designator
in the chain of DESIGNATOR."
   designator-groundings "(designator-groundings designator solutions): SOLUTIONS is the lazy list
of the solutions of DESIGNATOR, of which there is one."
   desig-solution "(desig-solution designator solution): SOLUTION is one of the solutions of
DESIGNATOR."
   desig-reference "(desig-reference designator solution): SOLUTION is what REFERENCE returns for
DESIGNATOR."
   desig-solution-not-rejected "(desig-solution-not-rejected designator pose): the validation
functions accept POSE for the location DESIGNATOR."
   designator "(designator class description designator): DESIGNATOR is a new one of CLASS with
DESCRIPTION."
   desig-equal "(desig-equal first second): the two designators are in one chain."
   designator? "(designator? object): OBJECT is a designator."
   action-desig? "(action-desig? object): OBJECT is an action designator."
   motion-desig? "(motion-desig? object): OBJECT is a motion designator."
   loc-desig? "(loc-desig? object): OBJECT is a location designator."
   obj-desig? "(obj-desig? object): OBJECT is an object designator."
   human-desig? "(human-desig? object): OBJECT is a human designator."))
