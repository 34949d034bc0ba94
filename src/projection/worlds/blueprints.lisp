;;;; Blueprints: what the worlds of a scene have in common.
;;;;
;;;; A world is built anew for every sample; what does not depend on the sample is worked out once
;;;; for each part of a scene and kept there.  A LINK-FRAME is a link of a model with its place in
;;;; the tree, parents first; a BODY-PLAN describes a body.  Of a fixture every link that stands
;;;; fast is a body of its own, while links that move together are one; so are those of an item.

(in-package #:discrepancy-finder.projection)

(defstruct (link-frame (:copier nil))
  "A link of a model: JOINT connects it to the link with the number PARENT (both NIL for the root).
NAME is that of its body, REST its pose in the frame of the root when all joints are where they
are at first."
  (link nil :type urdf-link :read-only t)
  (joint nil :type (or null urdf-joint) :read-only t)
  (parent nil :type (or null fixnum) :read-only t)
  (name "" :type string :read-only t)
  (rest nil :type pose :read-only t))

(defstruct (body-plan (:copier nil))
  "A body: its NAME, SHAPE, mass properties, and POSE in the frame of the part when the joints are
at 0.  PIECES are the outlines of a body that stands fast, where the scene has it.  MEMBERS is the
list of (link name . pose in the frame of the body) of its links; JOINT and FRAME are the joint that
moves it and that joint's pose, with the x axis along the joint's, in the frame of the part; BASES
are the plans of the bodies to which the joint connects it."
  (name "" :type string :read-only t)
  (shape nil :type list :read-only t)
  (mass 0d0 :type double-float :read-only t)
  (inertia nil :type list :read-only t)
  (inertial-pose nil :type pose :read-only t)
  (pose nil :type pose :read-only t)
  (members '() :type list :read-only t)
  (joint nil :type (or null urdf-joint) :read-only t)
  (frame nil :type (or null pose) :read-only t)
  (bases '() :type list :read-only t)
  (pieces '() :type list))

(defstruct (solid (:constructor make-solid (body top pieces)) (:copier nil))
  "The BODY of a fixture in a world, with its outlines PIECES, or NIL if it can move; TOP is the
height (m) of the highest one."
  (body nil :read-only t)
  (top 0d0 :type double-float :read-only t)
  (pieces '() :type list :read-only t))

(defstruct (blueprint (:copier nil))
  "FRAMES is the vector of a part's link frames; NUMBERS finds their numbers by the names of links
and of joints; POSITIONS are those of the joints at first.  PLANS are the BODY-PLANs of a fixture or
an item."
  (frames #() :type simple-vector :read-only t)
  (numbers nil :type hash-table :read-only t)
  (positions nil :type doubles :read-only t)
  (plans '() :type list))

(defun body-name-of (part link-name)
  (format nil "~(~a~)/~a" (scene-part-name part) link-name))

;;; Frames

(defun initial-position (joint)
  "Return the position of JOINT that is nearest to 0 within its limits."
  (if joint
      (max (or (urdf-joint-lower joint) 0d0) (min 0d0 (or (urdf-joint-upper joint) 0d0)))
      0d0))

(defun parked-position (part joint)
  "Return the position at which an arm of PART has JOINT parked, or NIL."
  (loop for arm in (scene-part-arms part)
        for index = (position (urdf-joint-name joint) (arm-roles-joints arm) :test #'string=)
        when index return (nth index (arm-roles-parked arm))))

(defun first-position (part joint)
  "Return the position of JOINT, or of the link without one, of PART at first."
  (cond ((null joint) 0d0)
        ((urdf-joint-mimic joint)
         (destructuring-bind (name multiplier offset) (urdf-joint-mimic joint)
           (+ offset
              (* multiplier
                 (first-position part (find-urdf-joint (scene-part-model part) name))))))
        ((parked-position part joint))
        (t (initial-position joint))))

(defun joint-motion (joint position)
  "Return the pose of JOINT's child in its origin frame at POSITION."
  (declare (double-float position))
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

(defun make-frames (part)
  "Return the vector of the link frames of PART."
  (let ((model (scene-part-model part)) (frames '()) (count 0)
        (numbers (make-hash-table :test #'equal)))
    (flet ((add (name joint)
             (let ((parent (and joint (gethash (urdf-joint-parent joint) numbers))))
               (push (make-link-frame
                      :link (find-urdf-link model name) :joint joint :parent parent
                      :name (body-name-of part name)
                      :rest (if joint
                                (compose (compose (link-frame-rest
                                                   (nth (- count 1 parent) frames))
                                                  (urdf-joint-origin joint))
                                         (joint-motion joint (first-position part joint)))
                                (identity-pose)))
                     frames)
               (setf (gethash name numbers) count)
               (incf count))))
      (add (urdf-model-root model) nil)
      (dolist (joint (urdf-model-joints model))
        (add (urdf-joint-child joint) joint)))
    (coerce (nreverse frames) 'simple-vector)))

(defun frame-numbers (frames)
  "Return a table from the names of the links of FRAMES, and of the joints, to numbers."
  (let ((numbers (make-hash-table :test #'equal)))
    (loop for frame across frames
          for number from 0
          for joint = (link-frame-joint frame)
          when joint do (setf (gethash (urdf-joint-name joint) numbers) number))
    (loop for frame across frames
          for number from 0
          do (setf (gethash (urdf-link-name (link-frame-link frame)) numbers) number))
    numbers))

;;; Bodies of fixtures and items

(defun turn-of-x-to (axis)
  "Return the pose, at the origin, whose x axis is AXIS, a list that is a unit vector."
  (destructuring-bind (x y z) axis
    (cond ((> x (- 1 1d-12)) (identity-pose))
          ((< x (- 1d-12 1)) (quaternion-pose 0d0 0d0 0d0 0d0 0d0 1d0 0d0))
          (t
           ;; Half way between the x axis and AXIS lies the rotation: (1 + x, (1 0 0) x AXIS).
           (let ((norm (sqrt (* 2 (+ 1 x)))))
             (quaternion-pose 0d0 0d0 0d0
                              0d0 (/ (- z) norm) (/ y norm) (/ norm 2)))))))

(defun moving-plan (part group poses plans)
  "Return the BODY-PLAN of GROUP of PART as one body.  POSES is an association list of the poses of
the groups, PLANS of their plans."
  (let* ((joint (rigid-group-joint group))
         (parent (rigid-group-parent group))
         (name (urdf-link-name (rigid-group-link group)))
         (above (and joint (cdr (assoc (urdf-joint-parent joint)
                                       (rigid-group-members parent)
                                       :key #'urdf-link-name :test #'string=)))))
    (make-body-plan
     :name (body-name-of part name) :shape (rigid-group-shape group)
     :mass (rigid-group-mass group) :inertia (rigid-group-inertia group)
     :inertial-pose (rigid-group-inertial-pose group)
     :pose (cdr (assoc group poses)) :joint joint
     :members (loop for (link . pose) in (rigid-group-members group)
                    collect (cons (urdf-link-name link) pose))
     :frame (and joint
                 (compose (compose (compose (cdr (assoc parent poses)) above)
                                   (urdf-joint-origin joint))
                          (turn-of-x-to (urdf-joint-axis joint))))
     :bases (and parent (cdr (assoc parent plans))))))

(defun standing-plans (part group pose)
  "Return the BODY-PLANs of GROUP of PART, which stands fast at POSE: one for each link with a
shape."
  (loop for (link . offset) in (rigid-group-members group)
        for place = (compose pose offset)
        when (urdf-link-shape link)
          collect (make-body-plan
                   :name (body-name-of part (urdf-link-name link))
                   :shape (urdf-link-shape link) :inertial-pose (identity-pose) :pose place
                   :members (list (cons (urdf-link-name link) (identity-pose)))
                   :pieces (shape-pieces (urdf-link-shape link)
                                         (compose (scene-part-pose part) place)))))

(defun group-pose (group poses)
  "Return the pose of GROUP in the frame of its part when the joints are at 0; POSES is an
association list of those of the groups before."
  (let ((joint (rigid-group-joint group)) (parent (rigid-group-parent group)))
    (if joint
        (compose (compose (cdr (assoc parent poses))
                          (cdr (assoc (urdf-joint-parent joint) (rigid-group-members parent)
                                      :key #'urdf-link-name :test #'string=)))
                 (urdf-joint-origin joint))
        (identity-pose))))

(defun part-plans (part)
  "Return the list of the BODY-PLANs of PART, a fixture or an item."
  (let ((poses '()) (plans '()))
    (dolist (group (rigid-groups (scene-part-model part)))
      (let ((pose (group-pose group poses)))
        (push (cons group pose) poses)
        (push (cons group
                    (cond ((null (rigid-group-shape group)) '())
                          ((and (eq (scene-part-kind part) :fixture)
                                (null (rigid-group-joint group)))
                           (standing-plans part group pose))
                          (t (list (moving-plan part group poses plans)))))
              plans)))
    (loop for (nil . group-plans) in (reverse plans) append group-plans)))

;;; Blueprints

(defun make-part-blueprint (part)
  (let ((frames (make-frames part)))
    (make-blueprint
     :frames frames :numbers (frame-numbers frames)
     :positions (map 'doubles (lambda (frame) (first-position part (link-frame-joint frame)))
                     frames)
     :plans (if (eq (scene-part-kind part) :robot) '() (part-plans part)))))

(defun part-blueprint (part)
  "Return the BLUEPRINT of PART, which is made when it is first asked for."
  (or (scene-part-prepared part)
      (setf (scene-part-prepared part) (make-part-blueprint part))))
