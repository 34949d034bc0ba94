;;;; The robot: a planar base with a tree of links, posed by forward kinematics.
;;;;
;;;; A ROBOT holds the pose of its base and the positions of its joints.  Its links are kinematic
;;;; bodies; UPDATE-LINKS moves them to where forward kinematics puts them.
;;;; The arm is a carriage that lifts a shoulder that turns a telescopic arm, so that inverse
;;;; kinematics is in closed form: ARM-CONFIGURATION.

(in-package #:discrepancy-finder.projection)

(defstruct (link-frame (:copier nil))
  "A link of a robot: JOINT connects it to the link with the number PARENT (both NIL for the root),
BODY is its body in the world, NIL if it has no shape."
  (link nil :type urdf-link :read-only t)
  (joint nil :type (or null urdf-joint) :read-only t)
  (parent nil :type (or null fixnum) :read-only t)
  (body nil))

(defclass robot ()
  ((part :initarg :part :reader robot-part :type scene-part)
   (base-pose :initarg :base-pose :accessor base-pose :type pose)
   (frames :reader robot-frames :type simple-vector
           :documentation "The link frames, parents first.")
   (positions :reader joint-positions :type (simple-array double-float (*))
              :documentation "For each frame the position (m or rad) of its joint.")
   (poses :reader link-poses :type simple-vector
          :documentation "For each frame its pose in the world, by the last UPDATE-POSES."))
  (:documentation "The robot of a projection."))

(defun make-frames (model)
  (let ((frames '()) (names '()))
    (flet ((add (name joint)
             (push (make-link-frame :link (find name (urdf-model-links model)
                                                :key #'urdf-link-name :test #'string=)
                                    :joint joint
                                    :parent (and joint (position (urdf-joint-parent joint)
                                                                 (reverse names) :test #'string=)))
                   frames)
             (push name names)))
      (add (urdf-model-root model) nil)
      (dolist (joint (urdf-model-joints model))
        (add (urdf-joint-child joint) joint)))
    (coerce (nreverse frames) 'simple-vector)))

(defun initial-position (joint)
  "Return the position of JOINT that is nearest to 0 within its limits."
  (if joint
      (max (or (urdf-joint-lower joint) 0d0) (min 0d0 (or (urdf-joint-upper joint) 0d0)))
      0d0))

(defmethod initialize-instance :after ((robot robot) &key)
  (with-slots (frames positions poses) robot
    (setf frames (make-frames (scene-part-model (robot-part robot)))
          positions (map '(simple-array double-float (*))
                         (lambda (frame) (initial-position (link-frame-joint frame)))
                         frames)
          poses (make-array (length frames)))
    (update-poses robot)))

;;; Forward kinematics

(defun joint-motion (joint position)
  "Return the pose of JOINT's child in its origin frame at POSITION."
  (declare (double-float position))
  (destructuring-bind (ax ay az) (urdf-joint-axis joint)
    (declare (double-float ax ay az))
    (ecase (urdf-joint-type joint)
      (:prismatic (quaternion-pose (* ax position) (* ay position) (* az position)
                                   0d0 0d0 0d0 1d0))
      ((:revolute :continuous)
       (let ((sine (sin (/ position 2))))
         (quaternion-pose 0d0 0d0 0d0 (* ax sine) (* ay sine) (* az sine)
                          (cos (/ position 2))))))))

(defun update-poses (robot)
  "Compute the poses of all links of ROBOT from its base pose and joint positions; return them."
  (let ((poses (link-poses robot)) (positions (joint-positions robot)))
    (declare (simple-vector poses) (type (simple-array double-float (*)) positions))
    (loop for frame across (the simple-vector (robot-frames robot))
          for index of-type fixnum from 0
          for joint = (link-frame-joint frame)
          do (setf (svref poses index)
                   (if joint
                       (let ((origin (compose (svref poses (link-frame-parent frame))
                                              (urdf-joint-origin joint))))
                         (if (eq (urdf-joint-type joint) :fixed)
                             origin
                             (compose origin (joint-motion joint (aref positions index)))))
                       (base-pose robot))))
    poses))

(defun frame-number (robot role)
  "Return the number of the frame whose link, or whose joint, has ROLE in ROBOT."
  (let ((name (getf (scene-part-roles (robot-part robot)) role)))
    (position-if (lambda (frame)
                   (or (string= name (urdf-link-name (link-frame-link frame)))
                       (and (link-frame-joint frame)
                            (string= name (urdf-joint-name (link-frame-joint frame))))))
                 (robot-frames robot))))

(defun find-joint (robot role)
  "Return the joint that has ROLE (:lift, :shoulder, :extension, :pan or :tilt) in ROBOT."
  (link-frame-joint (svref (robot-frames robot) (frame-number robot role))))

(defun joint-position (robot role)
  "Return the position (m or rad) of the joint with ROLE in ROBOT."
  (aref (joint-positions robot) (frame-number robot role)))

(defun gripper-pose (robot)
  "Return the pose of the tip of ROBOT's gripper."
  (svref (update-poses robot) (frame-number robot :gripper)))

(defun camera-pose (robot)
  "Return the pose of ROBOT's camera, which looks along its x axis."
  (svref (update-poses robot) (frame-number robot :camera)))

;;; Bodies

(defun add-links (robot world kind)
  "Add the links of ROBOT, or of another model, to WORLD as bodies of KIND, with their own masses if
that is :DYNAMIC.  Return the bodies."
  (loop for frame across (robot-frames robot)
        for pose across (update-poses robot)
        for link = (link-frame-link frame)
        when (urdf-link-shape link)
          collect (setf (link-frame-body frame)
                        (bullet:add-body world
                                         (format nil "~(~a~)/~a"
                                                 (scene-part-name (robot-part robot))
                                                 (urdf-link-name link))
                                         (urdf-link-shape link) pose
                                         :kind kind
                                         :mass (if (eq kind :dynamic) (urdf-link-mass link) 0d0)))))

(defun link-bodies (robot)
  "Return the bodies of ROBOT's links."
  (loop for frame across (robot-frames robot)
        when (link-frame-body frame) collect it))

(defun update-links (robot)
  "Move the bodies of ROBOT's links to their poses; Bullet derives their velocities."
  (let ((poses (update-poses robot)))
    (declare (simple-vector poses))
    (loop for frame across (the simple-vector (robot-frames robot))
          for index of-type fixnum from 0
          for body = (link-frame-body frame)
          when body do (bullet:move-body body (svref poses index)))))

(defun gripper-body (robot)
  (link-frame-body (svref (robot-frames robot) (frame-number robot :gripper))))

;;; Inverse kinematics of the arm

(defun shoulder-distance (robot pose)
  "Return the horizontal distance (m) from ROBOT's shoulder to the position of POSE."
  (planar-distance (svref (update-poses robot) (frame-number robot :shoulder)) pose))

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
