;;;; Poses of cl-transforms in designators, and the time of a run in stamps and log lines.
;;;;
;;;; The layer of designators knows the poses of the geometry layer only, that of transforms nothing
;;;; of designators; this file sees both.  So (a location (pose ?pose-stamped)) means a place for
;;;; every executive.

(in-package #:discrepancy-finder.cram-compat)

(defmethod desig:designated-pose ((thing transforms:pose))
  (transforms:geometry-pose thing))

(defmethod desig:designated-pose ((thing transforms:transform))
  (transforms:geometry-pose thing))

(defun numbers-text (vector)
  (format nil "~{~,3f~^ ~}" (transforms:3d-vector->list vector)))

(defmethod desig:description-text ((value transforms:3d-vector))
  (numbers-text value))

(defmethod desig:description-text ((value transforms:pose))
  (numbers-text (transforms:origin value)))

(defmethod desig:description-text ((value transforms:transform))
  (numbers-text (transforms:translation value)))

(defun run-time ()
  "Return the time (s) of the plan that runs, 0 outside of any."
  (if (plan:current-task) (plan:now) 0d0))

(setf roslisp:*ros-clock* #'run-time
      desig:*timestamp-function* #'run-time)
