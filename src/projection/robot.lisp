;;;; The robot: a planar base with a tree of links, posed by forward kinematics.
;;;;
;;;; A ROBOT holds the pose of its base and the positions of its joints.  Its links are kinematic
;;;; bodies; UPDATE-LINKS moves them to where forward kinematics puts them, PLACE-LINKS teleports.
;;;; The arm is a carriage that lifts a shoulder that turns a telescopic arm, so that inverse
;;;; kinematics is in closed form: ARM-CONFIGURATION.

(in-package #:discrepancy-finder.projection)

(defclass robot ()
  ((part :initarg :part :reader robot-part :type scene-part)
   (base-pose :initarg :base-pose :accessor base-pose :type pose)
   (positions :reader joint-positions :type hash-table
              :documentation "The position (m or rad) of each joint that moves, by its name.")
   (bodies :initform '() :accessor link-bodies
           :documentation "List of (link-name . body) for the links that have a shape."))
  (:documentation "The robot of a projection."))

(defun robot-model (robot)
  (scene-part-model (robot-part robot)))

(defun movable-p (joint)
  (not (eq (urdf-joint-type joint) :fixed)))

(defmethod initialize-instance :after ((robot robot) &key)
  (let ((positions (make-hash-table :test 'equal)))
    (dolist (joint (urdf-model-joints (robot-model robot)))
      (when (movable-p joint)
        (setf (gethash (urdf-joint-name joint) positions)
              (max 0d0 (or (urdf-joint-lower joint) 0d0)))))
    (setf (slot-value robot 'positions) positions)))

(defun role (robot name)
  "Return the name of the joint or link that has the role NAME in ROBOT."
  (getf (scene-part-roles (robot-part robot)) name))

(defun joint-position (robot role)
  "Return the position of the joint with ROLE (:lift, :shoulder or :extension) of ROBOT."
  (gethash (role robot role) (joint-positions robot)))

(defun (setf joint-position) (value robot role)
  (setf (gethash (role robot role) (joint-positions robot)) value))

(defun find-joint (robot role)
  (find (role robot role) (urdf-model-joints (robot-model robot))
        :key #'urdf-joint-name :test #'string=))

;;; Forward kinematics

(defun joint-motion (joint position)
  "Return the pose of JOINT's child in its origin frame at POSITION."
  (destructuring-bind (ax ay az) (urdf-joint-axis joint)
    (declare (double-float ax ay az))
    (ecase (urdf-joint-type joint)
      (:fixed (identity-pose))
      (:prismatic (quaternion-pose (* ax position) (* ay position) (* az position)
                                   0d0 0d0 0d0 1d0))
      ((:revolute :continuous)
       (let ((sine (sin (/ position 2))))
         (quaternion-pose 0d0 0d0 0d0 (* ax sine) (* ay sine) (* az sine)
                          (cos (/ position 2))))))))

(defun map-link-poses (function robot)
  "Call FUNCTION with the name of each link of ROBOT and its pose in the world."
  (let ((poses (list (cons (urdf-model-root (robot-model robot)) (base-pose robot)))))
    (funcall function (car (first poses)) (cdr (first poses)))
    (dolist (joint (urdf-model-joints (robot-model robot)))
      (let* ((parent (cdr (assoc (urdf-joint-parent joint) poses :test #'eq)))
             (parent (or parent (cdr (assoc (urdf-joint-parent joint) poses :test #'string=))))
             (origin (compose parent (urdf-joint-origin joint)))
             (pose (if (movable-p joint)
                       (compose origin
                                (joint-motion joint (gethash (urdf-joint-name joint)
                                                             (joint-positions robot))))
                       origin)))
        (push (cons (urdf-joint-child joint) pose) poses)
        (funcall function (urdf-joint-child joint) pose)))))

(defun link-pose (robot link-name)
  "Return the pose of the link LINK-NAME of ROBOT in the world."
  (map-link-poses (lambda (name pose)
                    (when (string= name link-name)
                      (return-from link-pose pose)))
                  robot))

(defun gripper-pose (robot)
  "Return the pose of the tip of ROBOT's gripper."
  (link-pose robot (role robot :gripper)))

;;; Bodies

(defun add-robot-links (robot world)
  "Add the links of ROBOT to WORLD as kinematic bodies."
  (let ((links (urdf-model-links (robot-model robot))))
    (map-link-poses
     (lambda (name pose)
       (let ((link (find name links :key #'urdf-link-name :test #'string=)))
         (when (urdf-link-shape link)
           (push (cons name (bullet:add-body world (link-body-name robot name)
                                             (urdf-link-shape link) pose :kind :kinematic))
                 (link-bodies robot)))))
     robot)
    (setf (link-bodies robot) (nreverse (link-bodies robot)))))

(defun link-body-name (robot link-name)
  (format nil "~(~a~)/~a" (scene-part-name (robot-part robot)) link-name))

(defun update-links (robot)
  "Move the bodies of ROBOT's links to their poses; Bullet derives their velocities."
  (map-link-poses (lambda (name pose)
                    (let ((entry (assoc name (link-bodies robot) :test #'eq)))
                      (when entry (bullet:move-body (cdr entry) pose))))
                  robot))

(defun gripper-body (robot)
  (cdr (assoc (role robot :gripper) (link-bodies robot) :test #'string=)))

;;; Inverse kinematics of the arm

(defun shoulder-distance (robot pose)
  "Return the horizontal distance (m) from ROBOT's shoulder to the position of POSE."
  (planar-distance (link-pose robot (urdf-joint-child (find-joint robot :shoulder))) pose))

(defun within-limits-p (joint position)
  (and (<= (or (urdf-joint-lower joint) position) position)
       (<= position (or (urdf-joint-upper joint) position))))

(defun arm-configuration (robot target)
  "Return lift, shoulder and extension that bring the tip of ROBOT's gripper to the position of
TARGET, as a list, or NIL if a joint limit forbids it."
  (let* ((local (compose (inverse (base-pose robot)) target))
         (tip (compose (inverse (base-pose robot)) (gripper-pose robot)))
         (configuration (list (+ (joint-position robot :lift) (- (pose-z local) (pose-z tip)))
                              (atan (pose-y local) (pose-x local))
                              (sqrt (+ (expt (pose-x local) 2) (expt (pose-y local) 2))))))
    (and (every (lambda (role position) (within-limits-p (find-joint robot role) position))
                '(:lift :shoulder :extension) configuration)
         configuration)))
