;;;; The perception process module: motions of type detecting.
;;;;
;;;; An item is detected if the part of it that is seen (seeing.lisp) is at least the scene's
;;;; visible-fraction.  Which item is meant is said by :type and :name of the object designator, and
;;;; by its :location if that is (a location (on part)) or (in part) of a fixture.  Of several, the
;;;; first in the order of the scene is detected; the quantifier ALL asks for the list of all that
;;;; are seen.
;;;; Where an item is reported to be is where it is plus the perception error, a tolerance of the
;;;; scene: perception-error-x, -y and -z (m, in the frame of the world).

(in-package #:discrepancy-finder.projection)

(defun perceived-pose (projection name)
  "Return where the item NAME, a symbol, is in PROJECTION as the camera has it."
  (let ((pose (observed-pose projection name)))
    (flet ((erring (coordinate parameter)
             (+ coordinate (projection-parameter projection parameter))))
      (quaternion-pose (erring (pose-x pose) :perception-error-x)
                       (erring (pose-y pose) :perception-error-y)
                       (erring (pose-z pose) :perception-error-z)
                       (pose-qx pose) (pose-qy pose) (pose-qz pose) (pose-qw pose)))))

(defun detected-object (projection designator name)
  "Return a new object designator: the description of DESIGNATOR, by which the item NAME was sought,
with the item's type, name and pose.  Tells of it by an event."
  (let ((object (plan:make-designator
                 :object
                 `((:type ,(scene-item-type (projection-scene projection) name))
                   (:name ,name)
                   ,@(remove-if (lambda (property)
                                  (member (first property) '(:type :name :pose)))
                                (plan:properties designator))
                   (:pose ,(perceived-pose projection name))))))
    (plan:on-event (make-instance 'plan:object-perceived-event
                                  :object-designator object :perception-source :projection))
    object))

(defun fail-to-detect (projection designator seen)
  "Signal PERCEPTION-OBJECT-NOT-FOUND for the object DESIGNATOR; SEEN is a list of (item . part)."
  (plan:fail 'plan:perception-object-not-found
             :object designator
             :description
             (if seen
                 (format nil "~a is not seen: ~{~a~^, ~}, where ~,1f % are needed"
                         designator
                         (loop for (name . part) in seen
                               collect (format nil "~,1f % of ~(~a~)" (* 100 part) name))
                         (* 100 (projection-parameter projection :visible-fraction)))
                 (format nil "~a is not seen: there is no such item~:[~; there~]"
                         designator (plan:desig-prop-value designator :location)))))

(defun sought-items (projection designator)
  "Return the names of the items that the object DESIGNATOR may mean, in the order of the scene."
  (let ((location (plan:desig-prop-value designator :location)))
    (remove-if-not (lambda (name) (item-at-location-p projection name location))
                   (designated-items projection designator))))

(defun detect (projection designator)
  "Return the object designators of the items that the object DESIGNATOR means and that are seen in
PROJECTION: the first one, or all if that is its quantifier.  Signals PERCEPTION-OBJECT-NOT-FOUND if
there is none."
  (let ((all (eq (desig:quantifier designator) :all))
        (enough (projection-parameter projection :visible-fraction))
        (missed '())
        (found '()))
    (loop for name in (sought-items projection designator)
          until (and found (not all))
          do (let ((part (visible-part projection name :enough enough)))
               (if (>= part enough)
                   (push (detected-object projection designator name) found)
                   (push (cons name part) missed))))
    (cond ((null found) (fail-to-detect projection designator (nreverse missed)))
          (all (nreverse found))
          (t (first found)))))

(defmethod execute-designator ((projection projection) (class (eql :motion))
                               (type (eql :detecting)) designator)
  (check-robot-part projection :camera :camera)
  (let ((object (plan:desig-prop-value designator :object)))
    (unless (and (typep object 'plan:object-designator)
                 (or (plan:desig-prop-value object :type) (plan:desig-prop-value object :name)))
      (misunderstood designator "a motion of type detecting needs an object with a type or a name"))
    (detect projection object)))
