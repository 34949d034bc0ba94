;;;; Containers: actions of type opening and closing with an object.
;;;;
;;;; A container is what a movable joint of a fixture carries: a drawer, a door.  A hand takes hold
;;;; of its handle, the link fixed to it that has "handle" in its name, and moves as the joint lets
;;;; it. The motor of the joint follows the hand, with the force that the fingers can bear; the
;;;; world is stepped all along, so that the contents come along by friction and by the walls, and
;;;; whatever is in the way stops the container.

(in-package #:discrepancy-finder.projection)

(defstruct (container (:copier nil))
  "The movable part of a FIXTURE (a name): its JOINT in the world, the joint of the model
URDF-JOINT, the link HANDLE of the model."
  (fixture nil :type keyword :read-only t)
  (joint nil :read-only t)
  (urdf-joint nil :type urdf-joint :read-only t)
  (handle nil :type urdf-link :read-only t))

(defun container-name (container)
  (urdf-joint-child (container-urdf-joint container)))

;;; Which one

(defun name-means-p (name joint)
  "Return true if NAME is that of JOINT or of the link that it moves, give or take an ending."
  (let ((name (plain-name name)))
    (loop for candidate in (list (urdf-joint-name joint) (urdf-joint-child joint))
            thereis (loop for ending in '("" "_joint" "_main" "_link")
                            thereis (string= (plain-name candidate)
                                             (concatenate 'string name ending))))))

(defun fixed-below (model link)
  "Return the links of MODEL that are fixed to LINK, a name, itself first."
  (cons (find-urdf-link model link)
        (loop for joint in (urdf-model-joints model)
              when (and (string= (urdf-joint-parent joint) link)
                        (eq (urdf-joint-type joint) :fixed))
                append (fixed-below model (urdf-joint-child joint)))))

(defun handle-of (model joint)
  "Return the link to hold on to when what JOINT of MODEL carries is moved, or NIL."
  (let ((links (remove nil (fixed-below model (urdf-joint-child joint)) :key #'urdf-link-shape)))
    (or (find-if (lambda (link) (search "handle" (urdf-link-name link))) links)
        (first links))))

(defun find-containers (projection designator)
  "Return the containers that the object DESIGNATOR means, by :urdf-name, :name, or else :type."
  (let ((name (or (plan:desig-prop-value designator :urdf-name)
                  (plan:desig-prop-value designator :name)))
        (type (plan:desig-prop-value designator :type))
        (whole (plan:desig-prop-value designator :part-of)))
    (loop for (fixture joint-name . joint) in (projection-joints projection)
          for model = (scene-part-model (scene-part (projection-scene projection) fixture))
          for urdf-joint = (find-urdf-joint model joint-name)
          for handle = (handle-of model urdf-joint)
          when (and handle
                    (or (not (symbolp whole)) (null whole)
                        (not (find (source:name-keyword whole)
                                   (parts-of-kind (projection-scene projection) :fixture)
                                   :key #'scene-part-name))
                        (eq (source:name-keyword whole) fixture))
                    (cond (name (name-means-p name urdf-joint))
                          (type (search (plain-name type) (plain-name joint-name)))))
            collect (make-container :fixture fixture :joint joint :urdf-joint urdf-joint
                                    :handle handle))))

(defun designated-container (projection designator)
  "Return the container that the action DESIGNATOR is about."
  (let ((object (designated-object designator)))
    (or (first (find-containers projection object))
        (misunderstood designator "the scene has no such container"))))

;;; Where the handle is

(defun handle-pose (projection container)
  "Return the pose of the link of CONTAINER's handle."
  (fixture-link-pose projection (urdf-link-name (container-handle container))
                     (container-fixture container)))

(defun container-body (projection container)
  (fixture-link-body projection (urdf-link-name (container-handle container))
                     (container-fixture container)))

(defun joint-frame (projection container)
  "Return the pose of the origin of CONTAINER's joint."
  (let ((joint (container-urdf-joint container)))
    (compose (fixture-link-pose projection (urdf-joint-parent joint)
                                (container-fixture container))
             (urdf-joint-origin joint))))

(defun carried-along (projection container pose distance)
  "Return POSE, of something that moves with CONTAINER, after its joint has moved by DISTANCE."
  (let* ((frame (joint-frame projection container))
         (motion (joint-motion (container-urdf-joint container) distance)))
    (compose frame (compose motion (compose (inverse frame) pose)))))

(defun outward (projection container pose)
  "Return the direction in which POSE moves first as CONTAINER opens, a unit vector."
  (let ((way (mapcar #'- (pose-position (carried-along projection container pose 1d-3))
                     (pose-position pose))))
    (unit way)))

(defparameter *handle-slant* 0.8d0
  "The least cosine of the angle between the way in which a hand comes to a handle and the way in
which that moves.")

(defun handle-candidates (projection arm container distance)
  "Return grasps of CONTAINER's handle for ARM that move it by DISTANCE, as FIND-REACH takes them."
  (let* ((pose (handle-pose projection container))
         (outward (outward projection container pose))
         (pieces (max 1 (ceiling (abs distance) *line-step*)))
         (rated (loop for grasp in (fitting-grasps (hand-of projection arm)
                                                   (urdf-link-shape (container-handle container)))
                      for tool = (compose pose (grasp-tool grasp))
                      for alignment = (- (dot outward (turned tool '(1d0 0d0 0d0))))
                      when (> alignment *handle-slant*)
                        collect (cons (- alignment)
                                      (list grasp tool (advanced tool (- (grasp-depth grasp)))
                                            (loop for piece from 1 to pieces
                                                  collect (carried-along
                                                           projection container tool
                                                           (* distance (/ piece pieces)))))))))
    (let ((sorted (mapcar #'cdr (stable-sort rated #'< :key #'car))))
      (subseq sorted 0 (min *grasps-tried* (length sorted))))))

;;; Moving it

(defparameter *container-speed* 0.4d0
  "The speed (m/s or rad/s) at which containers are opened and closed.")

(defparameter *container-acceleration* 1.5d0
  "The acceleration (m/s^2 or rad/s^2) with which containers are opened and closed.")

(defparameter *slip-distance* 0.02d0
  "A hand has slipped off a handle that lags behind it by more than this (m or rad).")

(defun haul (projection container way distance)
  "Move along WAY, whose configurations are equally far apart, while the joint of CONTAINER
follows over DISTANCE.  Return NIL, or why it was not done, a string."
  (let* ((joint (container-joint container))
         (force (* 2 (projection-parameter projection :finger-friction)
                   (projection-parameter projection :grip-force)))
         (before (bullet:joint-position joint))
         (body (container-body projection container)))
    (flet ((follow-hand (last count)
             (bullet:set-motor joint
                               (/ (- (+ before (* distance last)) (bullet:joint-position joint))
                                  (* count +time-step+))
                               force)
             (bullet:wake body))
           (slipped (last)
             (let ((lag (- (+ before (* distance last)) (bullet:joint-position joint))))
               (and (> (abs lag) *slip-distance*)
                    "the hand has slipped off the handle"))))
      (unwind-protect
           (multiple-value-bind (problem bodies)
               (run-in-parts projection (with-present-grippers projection way)
                             (profile-fractions (make-profile (abs distance) *container-speed*
                                                              *container-acceleration*))
                             :before #'follow-hand :after #'slipped
                             :watched (watched-bodies projection :allow-hand)
                             :obstacles (remove body (solid-bodies projection)))
             (if (eq problem :contact) (contact-text bodies) problem))
        (bullet:set-motor joint 0d0 (or (urdf-joint-friction (container-urdf-joint container))
                                        0d0))))))

(defun wanted-distance (designator container sign)
  "Return by how much (m or rad) the joint of CONTAINER is to move: positive to open."
  (let ((distance (plan:desig-prop-value designator :distance))
        (position (bullet:joint-position (container-joint container)))
        (joint (container-urdf-joint container)))
    (cond ((and (realp distance) (plusp distance)) (* sign (decimal-double distance)))
          (distance (misunderstood designator "a distance is a positive number"))
          ((plusp sign) (- (or (urdf-joint-upper joint) 0d0) position))
          (t (- (or (urdf-joint-lower joint) 0d0) position)))))

(defun move-container (projection designator sign)
  "Open, or close if SIGN is negative, the container of the action DESIGNATOR.  Return by how much
(m or rad) its joint has moved."
  (forget-lost-grasps projection)
  (let* ((container (designated-container projection designator))
         (distance (wanted-distance designator container sign))
         (names (mapcar #'arm-name (designated-arms projection designator :arm)))
         (what (format nil "the handle of ~a" (container-name container)))
         (reason :unreachable)
         (arms (free-arms projection names (handle-pose projection container))))
    (when (< (abs distance) 1d-3)
      (return-from move-container 0d0))
    (unless arms
      (plan:fail 'plan:gripper-goal-not-reached
                 :action :opening :description (format nil "no free arm is left for ~a" what)))
    (dolist (arm arms (plan:fail 'plan:environment-unreachable
                                 :description (reach-problem reason arms what)))
      (multiple-value-bind (reach why)
          (find-reach projection arm (handle-candidates projection arm container distance)
                      :target (list (container-body projection container)))
        (when (eq why :collision) (setf reason why))
        (when reach
          (return (open-along projection arm reach container distance)))))))

(defun open-along (projection arm reach container distance)
  "Move CONTAINER by DISTANCE with ARM as REACH has it."
  (let* ((joint (container-joint container))
         (before (bullet:joint-position joint)))
    (follow projection arm (reach-way reach) :opening t)
    (follow projection arm (reach-line reach) :watch :allow-hand :smoothly t)
    (grip projection arm)
    (let ((problem (haul projection container (reach-leaving reach) distance)))
      (open-gripper projection arm)
      (let ((moved (- (bullet:joint-position joint) before)))
        (plan:on-event
         (make-instance (if (plusp distance)
                            'plan:container-opening-event
                            'plan:container-closing-event)
                        :joint-name (urdf-joint-name (container-urdf-joint container))
                        :side (arm-name arm) :environment (container-fixture container)
                        :distance (abs moved)))
        (when problem
          (plan:fail 'plan:manipulation-goal-not-reached
                     :description (format nil "~a stopped after ~,3f of ~,3f: ~a"
                                          (container-name container) (abs moved) (abs distance)
                                          problem)))
        (settle projection)
        (retreat projection arm)
        moved))))
