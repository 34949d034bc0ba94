;;;; The robot: a planar base with a tree of links, posed by forward kinematics.
;;;;
;;;; A ROBOT holds the pose of its base and the positions of its joints, one for each link.  Its
;;;; links have numbers, parents first: FRAME-NUMBER finds them by the name of the link or of the
;;;; joint that moves it, or by a role that the scene gives.  Fixtures and items are built by the same
;;;; means; they just stay where they are put.

(in-package #:discrepancy-finder.projection)

(defstruct (link-frame (:copier nil))
  "A link of a robot: JOINT connects it to the link with the number PARENT (both NIL for the root).
NAME is the name of its body."
  (link nil :type urdf-link :read-only t)
  (joint nil :type (or null urdf-joint) :read-only t)
  (parent nil :type (or null fixnum) :read-only t)
  (name "" :type string :read-only t))

(defclass robot ()
  ((part :initarg :part :reader robot-part :type scene-part)
   (base-pose :initarg :base-pose :accessor base-pose :type pose
              :documentation "The pose of the root link.")
   (frames :reader robot-frames :type simple-vector
           :documentation "The link frames, parents first.")
   (positions :accessor joint-positions :type (simple-array double-float (*))
              :documentation "For each frame the position (m or rad) of its joint.")
   (bodies :reader robot-bodies :type simple-vector
           :documentation "For each frame its body in the world, or NIL.")
   (poses :reader link-poses :type simple-vector
          :documentation "For each frame its pose in the world, by the last UPDATE-POSES."))
  (:documentation "The robot of a projection."))

(defun make-frames (part)
  (let ((model (scene-part-model part)) (frames '()) (names '()))
    (flet ((add (name joint)
             (push (make-link-frame :link (find name (urdf-model-links model)
                                                :key #'urdf-link-name :test #'string=)
                                    :joint joint
                                    :parent (and joint (position (urdf-joint-parent joint)
                                                                 (reverse names) :test #'string=))
                                    :name (format nil "~(~a~)/~a" (scene-part-name part) name))
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
  (with-slots (frames positions poses bodies) robot
    (setf frames (make-frames (robot-part robot))
          positions (map '(simple-array double-float (*))
                         (lambda (frame) (initial-position (link-frame-joint frame)))
                         frames)
          bodies (make-array (length frames) :initial-element nil)
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

(defun named-frame-number (robot name)
  "Return the number of the frame of ROBOT whose link, or else whose joint, has the NAME, a string,
or NIL."
  (or (position name (robot-frames robot) :test #'string=
                                          :key (lambda (frame)
                                                 (urdf-link-name (link-frame-link frame))))
      (position-if (lambda (frame)
                     (and (link-frame-joint frame)
                          (string= name (urdf-joint-name (link-frame-joint frame)))))
                   (robot-frames robot))))

(defun role-name (robot role)
  "Return the name of the joint or link that has ROLE, a keyword, in ROBOT, or NIL."
  (getf (scene-part-roles (robot-part robot)) role))

(defun frame-number (robot role-or-name)
  "Return the number of the frame whose link, or whose joint, is ROLE-OR-NAME in ROBOT: a role (a
keyword such as :LIFT, :TORSO, :PAN or :CAMERA) or the name of a link or joint (a string).  NIL if
there is none."
  (let ((name (if (stringp role-or-name) role-or-name (role-name robot role-or-name))))
    (and name (named-frame-number robot name))))

(defun find-joint (robot role-or-name)
  "Return the joint that FRAME-NUMBER finds for ROLE-OR-NAME in ROBOT."
  (link-frame-joint (svref (robot-frames robot) (frame-number robot role-or-name))))

(defun joint-position (robot role-or-name)
  "Return the position (m or rad) of the joint that is ROLE-OR-NAME in ROBOT."
  (aref (joint-positions robot) (frame-number robot role-or-name)))

(defun robot-link-pose (robot role-or-name)
  "Return the pose in the world of the link that FRAME-NUMBER finds in ROBOT."
  (svref (update-poses robot) (frame-number robot role-or-name)))

(defun robot-arm (robot name)
  "Return the ARM-ROLES of the arm NAME, a symbol, of ROBOT, or NIL."
  (part-arm (robot-part robot) name))

(defun robot-arm-names (robot)
  "Return the names (keywords) of the arms of ROBOT that the scene names."
  (mapcar #'arm-roles-name (scene-part-arms (robot-part robot))))

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
        for index from 0
        for pose across (update-poses robot)
        for link = (link-frame-link frame)
        when (urdf-link-shape link)
          collect (setf (svref (robot-bodies robot) index)
                        (bullet:add-body world (link-frame-name frame)
                                         (urdf-link-shape link) pose
                                         :kind kind
                                         :mass (if (eq kind :dynamic)
                                                   (urdf-link-mass link)
                                                   0d0)))))

(defun link-bodies (robot)
  "Return the bodies of ROBOT's links."
  (remove nil (coerce (robot-bodies robot) 'list)))

(defun robot-link-body (robot role-or-name)
  "Return the body of the link that FRAME-NUMBER finds in ROBOT, or NIL if it has none."
  (let ((number (frame-number robot role-or-name)))
    (and number (svref (robot-bodies robot) number))))

(defun update-links (robot)
  "Move the bodies of ROBOT's links to their poses; Bullet derives their velocities."
  (let ((poses (update-poses robot)))
    (declare (simple-vector poses))
    (loop for body across (the simple-vector (robot-bodies robot))
          for pose across poses
          when body do (bullet:move-body body pose))))

(defun gripper-body (robot)
  (robot-link-body robot :gripper))
