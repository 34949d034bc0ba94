;;;; Arms: chains of joints that end in a gripper.
;;;;
;;;; An ARM is what the scene says of one (ARM-ROLES), with the numbers of the robot's frames in the
;;;; place of names.  POSITIONS are vectors with a position (m or rad) for each frame of the robot,
;;;; as in JOINT-POSITIONS.  A configuration is free if the arm and what it holds touch nothing
;;;; there.

(in-package #:discrepancy-finder.projection)

(defstruct (arm (:copier nil))
  "An arm of a robot: numbers of frames.  LINKS are all that its joints move, HAND-LINKS those
behind the last one, BLOCKERS the other links of the robot that it could touch; TORSO is NIL
without one."
  (name nil :type keyword :read-only t)
  (joints '() :type list :read-only t)
  (tool 0 :type fixnum :read-only t)
  (gripper 0 :type fixnum :read-only t)
  (fingers '() :type list :read-only t)
  (links '() :type list :read-only t)
  (hand-links '() :type list :read-only t)
  (blockers '() :type list :read-only t)
  (torso nil :type (or null fixnum) :read-only t)
  (parked '() :type list :read-only t)
  (hand nil :type (or null hand)))

(defun below-p (frames number ancestor)
  "Return true if the link NUMBER of FRAMES is ANCESTOR or moves with it."
  (loop for index = number then (link-frame-parent (svref frames index))
        while index thereis (= index ancestor)))

(defun frames-below (robot ancestor)
  (let ((frames (robot-frames robot)))
    (loop for number below (length frames)
          when (below-p frames number ancestor) collect number)))

(defun build-arm (robot roles)
  "Return the arm of ROBOT that ROLES, an ARM-ROLES, describes."
  (flet ((number (name) (frame-number robot name)))
    (let* ((joints (mapcar #'number (arm-roles-joints roles)))
           (links (frames-below robot (first joints))))
      (make-arm :name (arm-roles-name roles) :joints joints
                :tool (number (arm-roles-tool roles))
                :gripper (number (arm-roles-gripper roles))
                :fingers (mapcar #'number (arm-roles-fingers roles))
                :links links
                :hand-links (frames-below robot (first (last joints)))
                :blockers (loop for number below (length (robot-frames robot))
                                unless (member number links) collect number)
                :torso (frame-number robot :torso)
                :parked (arm-roles-parked roles)))))

(defvar *arms* (make-hash-table :test #'eq :weakness :key :synchronized t)
  "For each robot of a scene, a SCENE-PART, the list of its arms.")

(defun robot-arms (robot)
  "Return the list of the arms of ROBOT, in the order of the scene."
  (let ((part (robot-part robot)))
    (multiple-value-bind (arms known-p) (gethash part *arms*)
      (if known-p
          arms
          (setf (gethash part *arms*)
                (mapcar (lambda (roles) (build-arm robot roles)) (scene-part-arms part)))))))

(defun find-arm (projection name)
  "Return the arm NAME, a keyword, of PROJECTION's robot, or NIL."
  (find name (robot-arms (projection-robot projection)) :key #'arm-name))

(defun arm-bodies (projection numbers)
  "Return the bodies of the links NUMBERS of PROJECTION's robot."
  (loop with bodies = (robot-bodies (projection-robot projection))
        for number in numbers
        when (svref bodies number) collect it))

(defun tool-pose (projection arm &optional positions)
  "Return the pose of the tool of ARM in PROJECTION, now or at POSITIONS."
  (let ((robot (projection-robot projection)))
    (bullet:forward-kinematics (robot-mechanism robot) (base-pose robot)
                               (or positions (joint-positions robot)) (arm-tool arm))))

;;; The hand

(defun finger-inner-side (pose shape side)
  "Return how far from the tool the inner side of a finger is, on the SIDE 1 or -1 of its y axis."
  (- (placed-support shape pose (list 0d0 (- (float side 1d0)) 0d0))))

(defun measure-hand (robot arm)
  "Return the HAND of ARM: the shapes of its links while it is open."
  (let* (;; Not the present ones: the same hand to the last bit, whenever it is measured.
         (positions (make-array (length (robot-frames robot)) :element-type 'double-float
                                                              :initial-element 0d0))
         (mechanism (robot-mechanism robot))
         (frames (robot-frames robot)))
    (setf (aref positions (arm-gripper arm))
          (urdf-joint-upper (link-frame-joint (svref frames (arm-gripper arm)))))
    (flet ((placed (number)
             (bullet:forward-kinematics mechanism (identity-pose) positions number)))
      (let ((outside (inverse (placed (arm-tool arm)))))
        (flet ((parts (numbers)
                 (loop for number in numbers
                       for shape = (urdf-link-shape (link-frame-link (svref frames number)))
                       when shape collect (list (compose outside (placed number)) shape))))
          (let ((fingers (parts (arm-fingers arm)))
                (palm (parts (remove-if (lambda (number) (member number (arm-fingers arm)))
                                        (arm-hand-links arm)))))
            (flet ((reach (parts)
                     (loop for (pose shape) in parts
                           maximize (placed-support shape pose '(1d0 0d0 0d0)))))
              (make-hand :palm palm :fingers fingers
                         :opening (loop for (pose shape) in fingers
                                        sum (abs (finger-inner-side
                                                  pose shape (if (plusp (pose-y pose)) 1 -1))))
                         :reach (- (+ (reach palm) *tip-clearance*))
                         :tip (reach fingers)))))))))

(defun hand-of (projection arm)
  "Return the HAND of ARM."
  (or (arm-hand arm)
      (setf (arm-hand arm) (measure-hand (projection-robot projection) arm))))

;;; Inverse kinematics

(defun torso-heights (projection arm)
  "Return the positions of the torso to try for ARM, the present one first; NIL without a torso."
  (let ((torso (arm-torso arm)) (robot (projection-robot projection)))
    (and torso
         (let* ((joint (link-frame-joint (svref (robot-frames robot) torso)))
                (now (aref (joint-positions robot) torso))
                (lower (urdf-joint-lower joint)) (upper (urdf-joint-upper joint)))
           (cons now
                 (sort (loop for step to 4
                             for height = (+ lower (* (/ step 4) (- upper lower)))
                             unless (< (abs (- height now)) 1d-3) collect height)
                       #'< :key (lambda (height) (abs (- height now)))))))))

(defun reaching-positions (projection arm &optional height)
  "Return a copy of the present positions, with the torso at HEIGHT unless that is NIL, and with the
gripper of ARM open if it holds nothing."
  (let ((positions (copy-seq (joint-positions (projection-robot projection)))))
    (when height (setf (aref positions (arm-torso arm)) height))
    (unless (held-item projection (arm-name arm))
      (setf (aref positions (arm-gripper arm)) (nth-value 1 (gripper-limits projection arm))))
    positions))

(defun nearest-turns (robot joints solution start)
  "Return SOLUTION with the positions of the continuous JOINTS nearest to those in START."
  (let ((solution (copy-seq solution)))
    (dolist (joint joints solution)
      (when (eq (urdf-joint-type (link-frame-joint (svref (robot-frames robot) joint)))
                :continuous)
        (decf (aref solution joint)
              (* 2 pi (round (- (aref solution joint) (aref start joint)) (* 2 pi))))))))

(defun solve (projection arm pose start &key (count 1) (restarts 12))
  "Return a list of up to COUNT vectors of positions with the tool of ARM at POSE, the nearest to
START first; they are START but for the arm's joints."
  (let* ((robot (projection-robot projection))
         (found (bullet:inverse-kinematics
                 (robot-mechanism robot) :base (base-pose robot) :link (arm-tool arm)
                 :target pose :joints (arm-joints arm) :start start
                 :restarts restarts :count count))
         (solutions (loop for solution in (if (listp found) found (list found))
                          collect (nearest-turns robot (arm-joints arm) solution start))))
    (flet ((way (solution)
             (loop for joint in (arm-joints arm)
                   maximize (abs (- (aref solution joint) (aref start joint))))))
      (stable-sort solutions #'< :key #'way))))

;;; Freedom

(defun carried-bodies (projection arm)
  "Return the list of the body that ARM holds, or NIL."
  (let ((attachment (grasp-attachment projection (arm-name arm))))
    (and attachment (list (bullet:attachment-child attachment)))))

(defun arm-obstacles (projection arm &key ignored)
  "Return the bodies that ARM must not touch: all but its own links, what it holds, and the bodies
IGNORED."
  (let ((ignored (append ignored (carried-bodies projection arm))))
    (remove-if (lambda (body) (member body ignored))
               (append (projection-fixtures projection)
                       (mapcar #'cdr (projection-items projection))
                       (arm-bodies projection (arm-blockers arm))))))

(defparameter *planning-clearance* 1.5d-3
  "Configurations in which an arm is nearer than this (m) to something are not chosen.")

(defun free-p (projection arm positions &key ignored (carried t))
  "Return true if the links of ARM but its first two, which turn in the torso's sides, touch nothing
at POSITIONS but the bodies IGNORED, and with CARRIED what it holds neither."
  (let ((robot (projection-robot projection)))
    (> (bullet:mechanism-clearance (robot-mechanism robot) (base-pose robot) positions
                                   (append (arm-bodies projection (cddr (arm-links arm)))
                                           (and carried (carried-bodies projection arm)))
                                   (arm-obstacles projection arm :ignored ignored)
                                   (* 2 *planning-clearance*))
       *planning-clearance*)))

(defun way-free-p (projection arm start goal)
  "Return true if ARM can go straight in joint space from START to GOAL.  It keeps away from
everything, as the search along the way may overlook a slight contact on which the motion would
stop; but it may come from where it is nearer, and then must not touch what it leaves."
  (let* ((robot (projection-robot projection))
         (mechanism (robot-mechanism robot))
         (base (base-pose robot))
         (watched (append (arm-bodies projection (cddr (arm-links arm)))
                          (carried-bodies projection arm)))
         (obstacles (arm-obstacles projection arm)))
    (flet ((free-at-p (distance)
             (not (bullet:path-contact mechanism base start goal watched obstacles
                                       :contact-distance distance))))
      (and (free-at-p *planning-clearance*)
           (or (> (bullet:mechanism-clearance mechanism base start watched obstacles
                                              (* 2 *planning-clearance*))
                  *planning-clearance*)
               (free-at-p 0d0))))))
