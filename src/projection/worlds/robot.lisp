;;;; The robot: a planar base with a tree of links, posed by forward kinematics.
;;;;
;;;; A ROBOT holds the pose of its base and the positions of its joints, one for each link; its
;;;; links are kinematic bodies, which a mechanism of the Bullet layer moves.  Links have numbers,
;;;; parents first: FRAME-NUMBER finds them by the name of the link or of the joint that moves it,
;;;; or by a role that the scene gives.

(in-package #:discrepancy-finder.projection)

(defclass robot ()
  ((part :initarg :part :reader robot-part :type scene-part)
   (blueprint :initarg :blueprint :reader robot-blueprint :type blueprint)
   (base-pose :initarg :base-pose :accessor base-pose :type pose
              :documentation "The pose of the root link.")
   (standing-height :initarg :standing-height :reader standing-height :type double-float
                    :documentation "The height (m) of the root link on level ground.")
   (positions :initarg :positions :accessor joint-positions
              :type (simple-array double-float (*))
              :documentation "For each link the position (m or rad) of its joint.")
   (bodies :initarg :bodies :reader robot-bodies :type simple-vector
           :documentation "For each link its body in the world, or NIL.")
   (mechanism :initarg :mechanism :reader robot-mechanism
              :documentation "The mechanism of the Bullet layer."))
  (:documentation "The robot of a projection."))

(defmethod print-object ((robot robot) stream)
  (print-unreadable-object (robot stream :type t)
    (format stream "~(~a~) at ~a" (scene-part-name (robot-part robot)) (base-pose robot))))

(defun robot-frames (robot)
  "Return the vector of the link frames of ROBOT, parents first."
  (blueprint-frames (robot-blueprint robot)))

;;; Links and joints

(defun role-name (robot role)
  "Return the name of the joint or link that has ROLE, a keyword, in ROBOT, or NIL."
  (getf (scene-part-roles (robot-part robot)) role))

(defun named-frame-number (robot name)
  "Return the number of the link of ROBOT that has the NAME, a string, or whose joint has; or NIL."
  (values (gethash name (blueprint-numbers (robot-blueprint robot)))))

(defun frame-number (robot role-or-name)
  "Return the number of the link of ROBOT that is ROLE-OR-NAME, or whose joint is: a role (a keyword
such as :LIFT, :TORSO, :PAN or :CAMERA) or the name of a link or joint (a string).  NIL if there is
none."
  (let ((name (if (stringp role-or-name) role-or-name (role-name robot role-or-name))))
    (and name (named-frame-number robot name))))

(defun find-joint (robot role-or-name)
  "Return the joint that FRAME-NUMBER finds for ROLE-OR-NAME in ROBOT."
  (link-frame-joint (svref (robot-frames robot) (frame-number robot role-or-name))))

(defun joint-position (robot role-or-name)
  "Return the position (m or rad) of the joint that is ROLE-OR-NAME in ROBOT."
  (aref (joint-positions robot) (frame-number robot role-or-name)))

(defun robot-arm (robot name)
  "Return the ARM-ROLES of the arm NAME, a symbol, of ROBOT, or NIL."
  (part-arm (robot-part robot) name))

(defun robot-arm-names (robot)
  "Return the names (keywords) of the arms of ROBOT that the scene names."
  (mapcar #'arm-roles-name (scene-part-arms (robot-part robot))))

;;; Forward kinematics

(defun numbered-link-pose (robot number)
  "Return the pose in the world of the link NUMBER of ROBOT, where base and joints have it now."
  (bullet:forward-kinematics (robot-mechanism robot) (base-pose robot) (joint-positions robot)
                             number))

(defun robot-link-pose (robot role-or-name)
  "Return the pose in the world of the link that FRAME-NUMBER finds in ROBOT."
  (numbered-link-pose robot (frame-number robot role-or-name)))

(defun update-poses (robot)
  "Return the vector of the poses of all links of ROBOT from its base pose and joint positions."
  (let ((poses (make-array (length (robot-frames robot)))))
    (dotimes (number (length poses) poses)
      (setf (svref poses number) (numbered-link-pose robot number)))))

(defun gripper-pose (robot)
  "Return the pose of the tip of ROBOT's gripper."
  (robot-link-pose robot :gripper))

(defun camera-pose (robot)
  "Return the pose of ROBOT's camera, which looks along its x axis."
  (robot-link-pose robot :camera))

;;; Bodies

(defun link-bodies (robot)
  "Return the bodies of ROBOT's links."
  (remove nil (coerce (robot-bodies robot) 'list)))

(defun robot-link-body (robot role-or-name)
  "Return the body of the link that FRAME-NUMBER finds in ROBOT, or NIL if it has none."
  (let ((number (frame-number robot role-or-name)))
    (and number (svref (robot-bodies robot) number))))

(defun gripper-body (robot)
  (robot-link-body robot :gripper))

(defun link-below-p (robot number ancestor)
  "Return true if the link NUMBER of ROBOT is the link ANCESTOR or hangs on it."
  (loop for candidate = number then (link-frame-parent (svref (robot-frames robot) candidate))
        while candidate
          thereis (= candidate ancestor)))

(defun hand-bodies (robot arm)
  "Return the bodies of the hand of ARM, the name of an arm of ROBOT: of the child of the arm's last
joint and all that hangs on it."
  (let ((wrist (frame-number robot (first (last (arm-roles-joints (robot-arm robot arm)))))))
    (loop for body across (robot-bodies robot)
          for number from 0
          when (and body (link-below-p robot number wrist))
            collect body)))

;;; Making

(defun link-specs (frames numbers bodies)
  "Return the vector of what BULLET:MAKE-MECHANISM wants to know of the links FRAMES with BODIES."
  (map 'simple-vector
       (lambda (frame body)
         (let ((joint (link-frame-joint frame))
               (name (urdf-link-name (link-frame-link frame))))
           (if joint
               (bullet:link-spec name (link-frame-parent frame) (urdf-joint-type joint)
                                 (urdf-joint-origin joint) (urdf-joint-axis joint)
                                 (urdf-joint-lower joint) (urdf-joint-upper joint)
                                 (let ((mimic (urdf-joint-mimic joint)))
                                   (and mimic
                                        (cons (gethash (first mimic) numbers) (rest mimic))))
                                 body)
               (bullet:link-spec name nil :fixed (identity-pose) '(1d0 0d0 0d0) nil nil nil
                                 body))))
       frames bodies))

(defun add-robot (scene part world base-pose)
  "Add PART, the robot of SCENE, to WORLD with its base at BASE-POSE and return the ROBOT."
  (let* ((blueprint (part-blueprint part))
         (frames (blueprint-frames blueprint))
         (surface (part-surface scene part))
         (bodies (map 'simple-vector
                      (lambda (frame)
                        (let ((shape (urdf-link-shape (link-frame-link frame))))
                          (and shape
                               (apply #'bullet:add-body world (link-frame-name frame) shape
                                      (compose base-pose (link-frame-rest frame))
                                      :kind :kinematic surface))))
                      frames))
         (mechanism (bullet:make-mechanism
                     world (link-specs frames (blueprint-numbers blueprint) bodies))))
    (make-instance 'robot :part part :blueprint blueprint :base-pose base-pose
                          :standing-height (pose-z base-pose)
                          :positions (copy-seq (blueprint-positions blueprint))
                          :bodies bodies :mechanism mechanism)))

(defun teleport-robot (robot)
  "Put the bodies of ROBOT's links, and what they hold, to where base and joints have them, at
rest."
  (bullet:pose-mechanism (robot-mechanism robot) (base-pose robot) (joint-positions robot)
                         :teleport t))
