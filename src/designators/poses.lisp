;;;; The pose that a thing means.

(in-package #:discrepancy-finder.designators)

(defun location-pose (designator)
  "Return the pose that the location DESIGNATOR resolves to, or NIL."
  (handler-case (designated-pose (reference designator))
    (designator-error () nil)))

(defgeneric designated-pose (thing)
  (:documentation "Return the pose that THING means, or NIL if it means none: a pose itself; of a
location designator the value of :pose or, without one, what REFERENCE returns; of an object
designator the value of :pose or, without one, the pose of its data; of a list of properties such as
((:pose pose) (:transform transform)) the value of :pose.  Other layers add methods for their
poses.")
  (:method (thing) (declare (ignore thing)) nil)
  (:method ((thing pose)) thing)
  (:method ((thing location-designator))
    (let ((pose (desig-prop-value thing :pose)))
      (if pose (designated-pose pose) (location-pose thing))))
  (:method ((thing object-designator))
    (let ((pose (desig-prop-value thing :pose)))
      (designated-pose (or pose (data thing)))))
  (:method ((thing cons))
    (let ((entry (and (alexandria:proper-list-p thing)
                      (find-if (lambda (entry) (and (consp entry) (eq (first entry) :pose)))
                               thing))))
      (and entry (consp (rest entry)) (designated-pose (second entry))))))

;;; What perception knows of an object

(defclass object-designator-data ()
  ((object-identifier :initarg :object-identifier :initform nil :reader object-identifier
                      :documentation "The name by which perception knows the object.")
   (pose :initarg :pose :initform nil :reader object-pose
         :documentation "Where it was seen, a pose, or NIL."))
  (:documentation "What perception stores in the slot DATA of an object designator."))

(defmethod print-object ((data object-designator-data) stream)
  (print-unreadable-object (data stream :type t)
    (format stream "~(~a~)~@[ at ~a~]" (object-identifier data)
            (and (object-pose data) (description-text (object-pose data))))))

(defmethod designated-pose ((thing object-designator-data))
  (designated-pose (object-pose thing)))
