;;; A plan for the projection: poses as plans of CRAM make them.

(defpackage :drive-plans
  (:use :cpl))

(in-package :drive-plans)

(defparameter *log* '())

(def-top-level-cram-function drive (x y)
  (let* ((?pose (cl-transforms-stamped:make-pose-stamped
                 cram-tf:*fixed-frame* (roslisp:ros-time)
                 (cl-transforms:make-3d-vector x y 0)
                 (cl-transforms:make-identity-rotation)))
         (?location (desig:a location (pose ?pose))))
    (exe:perform (desig:a motion (type going) (target ?location)))
    (push (roslisp:ros-time) *log*)
    (desig:desig-prop-value ?location :pose)))
