;;; The world, as far as the process modules pretend that there is one.

(in-package :ts-plans)

(defvar *base-pose* nil "Where the robot is.")
(defvar *held* nil "What it holds: a list of (arm . object name).")
(defvar *things* nil "Names, types and poses of the things around.")
(defvar *events* nil "The events that were told, the last one first.")
(defvar *blindness* 0 "How often nothing will be seen.")

(defparameter *origin*
  (cl-transforms-stamped:make-pose-stamped
   cram-tf:*fixed-frame* 0.0
   (cl-transforms:make-identity-vector)
   (cl-transforms:make-identity-rotation)))

(defun at (x y &optional (z 0.8))
  (cl-transforms-stamped:make-pose-stamped
   cram-tf:*fixed-frame* 0.0
   (cl-transforms:make-3d-vector x y z)
   (cl-transforms:axis-angle->quaternion (cl-transforms:make-3d-vector 0 0 1) (/ pi 2))))

(defstruct thing name type pose)

(defun reset-world (&key (blindness 0))
  (setf *base-pose* *origin*
        *held* '()
        *events* '()
        *blindness* blindness
        *things* (list (make-thing :name 'bowl-1 :type :bowl :pose (at 1.0 0.5))
                       (make-thing :name 'cup-1 :type :cup :pose (at 2.0 0.5)))))

(defun near-p (pose other-pose &key (threshold 1.0))
  (declare (type cl-transforms:pose pose other-pose))
  (let ((difference (cl-transforms:v- (cl-transforms:origin pose)
                                      (cl-transforms:origin other-pose))))
    (< (cl-transforms:v-norm (cl-transforms:copy-3d-vector difference :z 0.0)) threshold)))

(roslisp-utilities:register-ros-init-function 'reset-world)

(defmethod coe:on-event note-event ((event cpoe:object-gripper-event))
  (push (list (class-name (class-of event)) (cpoe:event-object-name event)) *events*))
