;;;; The types that the values of properties have.
;;;;
;;;; The predicate PROPERTY (predicates.lisp) is DESIG-PROP with these types checked, if prolog's
;;;; *BREAK-ON-LISP-ERRORS* is true; if it is false, it is DESIG-PROP, as in CRAM.

(in-package #:discrepancy-finder.designators)

(defparameter *property-types*
  '((:motion
     (location :target :left-target :right-target)
     (object :object :objects)
     (string :frame)
     (number :effort :joint-angle)
     ((keyword list) :gripper :direction :arm)
     (list :left-configuration :right-configuration))
    (:action
     (location :target :location)
     (list :left-poses :right-poses)
     ((keyword list) :gripper :arm :direction :grasp :camera :type)
     (object :object :on-object :with-object)
     (number :position :effort :distance)
     ((keyword object) :for))
    (:location
     (pose :pose)
     (object :object)
     (keyword :arm))
    (:object
     (keyword :type :part-of)
     (symbol :name :urdf-name)))
  "For each designator class, types or lists of them and the keys whose values are of such a type.
LOCATION and OBJECT are designators, POSE is what DESIGNATED-POSE takes for one.")

(defun property-types (class key)
  "Return the list of the types, one of which the values of KEY of designators of CLASS have, or NIL
if they are free."
  (loop for (types . keys) in (rest (assoc class *property-types*))
        when (member key keys) return (alexandria:ensure-list types)))

(defun value-of-type-p (value type)
  (ecase type
    (location (typep value 'location-designator))
    (object (typep value 'object-designator))
    (pose (and (designated-pose value) t))
    (string (stringp value))
    (number (numberp value))
    (keyword (keywordp value))
    (list (listp value))
    (symbol (symbolp value))))

(defun check-property-type (designator key value)
  "Return true.  While prolog's *BREAK-ON-LISP-ERRORS* is true, signal PROPERTY-TYPE-ERROR if VALUE
is not of a type that values of KEY of DESIGNATOR have."
  (when *break-on-lisp-errors*
    (let ((types (property-types (designator-class-keyword designator) key)))
      (unless (or (null types)
                  (some (lambda (type) (value-of-type-p value type)) types))
        (error 'property-type-error :designator designator :key key :value value
                                    :expected types))))
  t)
