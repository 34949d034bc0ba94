;;;; What plans use of the package cram-tf: comparing poses, poses as lists, moving and turning
;;;; them, products of stamped transforms, poses in other frames.

(in-package #:discrepancy-finder.transforms)

;;; Comparing

(defun poses-equal-p (pose-1 pose-2 &key (position-threshold 0.025d0)
                                      (angle-threshold (* 5 (/ pi 180))))
  "Return true if the poses are no farther apart than POSITION-THRESHOLD (m) and turned against each
other by no more than ANGLE-THRESHOLD (rad).  Stamped poses in different frames are compared in the
world.  Signals UNKNOWN-FRAME and ZERO-LENGTH."
  (if (and (typep pose-1 'pose-stamped) (typep pose-2 'pose-stamped)
           (string/= (bare-frame-name (frame-id pose-1)) (bare-frame-name (frame-id pose-2))))
      (poses-equal-p (pose-from-geometry (geometry-pose pose-1))
                     (pose-from-geometry (geometry-pose pose-2))
                     :position-threshold position-threshold :angle-threshold angle-threshold)
      (and (<= (v-dist (origin pose-1) (origin pose-2)) position-threshold)
           (<= (angle-between-quaternions (orientation pose-1) (orientation pose-2))
               angle-threshold))))

(defun values-converged (values goal-values deltas)
  "Return true if VALUES are no farther from GOAL-VALUES than DELTAS.  They are lists of reals of
the same length, or VALUES and GOAL-VALUES single reals; one real for DELTAS goes for all.  Signals
UNSUITABLE-VALUE if the lengths differ."
  (let* ((values (if (listp values) values (list values)))
         (goals (if (listp goal-values) goal-values (list goal-values)))
         (deltas (if (listp deltas)
                     deltas
                     (make-list (length values) :initial-element deltas))))
    (flet ((check-length (list role)
             (unless (= (length list) (length values))
               (unsuitable list role (format nil "~r value~:p long" (length values))))))
      (check-length goals "the list of goal values")
      (check-length deltas "the list of deltas"))
    (every (lambda (value goal delta) (<= (abs (- value goal)) delta)) values goals deltas)))

;;; Lists

(defun 3d-vector->list (vector)
  "Return the list of the coordinates x, y, z (m) of VECTOR."
  (list (x vector) (y vector) (z vector)))

(defun pose->flat-list (pose)
  "Return the list of the numbers of POSE: x, y, z (m), and x, y, z, w of the quaternion."
  (let ((turn (orientation pose)))
    (append (3d-vector->list (origin pose)) (list (x turn) (y turn) (z turn) (w turn)))))

(defun flat-list->pose (list)
  "Return the POSE whose POSE->FLAT-LIST is LIST.  Signals UNSUITABLE-VALUE if LIST is none."
  (unless (and (listp list) (eql 7 (list-length list)))
    (unsuitable list "a pose as a list" "seven numbers x y z qx qy qz qw"))
  (destructuring-bind (x y z qx qy qz qw) list
    (make-pose (make-3d-vector x y z) (make-quaternion qx qy qz qw))))

(defun pose->list (pose)
  "Return the list ((x y z) (qx qy qz qw)) of the numbers of POSE (m)."
  (let ((flat (pose->flat-list pose)))
    (list (subseq flat 0 3) (subseq flat 3))))

(defun list->pose (list)
  "Return the POSE whose POSE->LIST is LIST.  Signals UNSUITABLE-VALUE if LIST is none."
  (unless (and (listp list) (every #'listp list)
               (equal '(3 4) (mapcar #'list-length list)))
    (unsuitable list "a pose as a list" "a list ((x y z) (qx qy qz qw))"))
  (flat-list->pose (append (first list) (second list))))

;;; Moving and turning

(defgeneric with-parts (thing vector quaternion)
  (:documentation "Return a pose or transform of the kind and in the frames of THING, with the parts
VECTOR and QUATERNION.")
  (:method ((thing pose) vector quaternion)
    (make-pose vector quaternion))
  (:method ((thing transform) vector quaternion)
    (make-transform vector quaternion))
  (:method ((thing pose-stamped) vector quaternion)
    (copy-pose-stamped thing :origin vector :orientation quaternion))
  (:method ((thing transform-stamped) vector quaternion)
    (copy-transform-stamped thing :translation vector :rotation quaternion)))

(defun axis-turn (axis angle)
  "Return the quaternion that turns by ANGLE about AXIS, which is :x, :y or :z."
  (case axis
    (:x (euler->quaternion :ax angle))
    (:y (euler->quaternion :ay angle))
    (:z (euler->quaternion :az angle))
    (t (unsuitable axis "the axis of a rotation" ":x, :y or :z"))))

(defun translate-pose (pose &key (x-offset 0d0) (y-offset 0d0) (z-offset 0d0)
                              (x 0d0) (y 0d0) (z 0d0))
  "Return POSE, stamped or not, moved along the axes of the frame in which it is given by X-OFFSET,
Y-OFFSET and Z-OFFSET (m).  X, Y and Z are other names for the same."
  (with-parts pose
              (v+ (origin pose)
                  (make-3d-vector x-offset y-offset z-offset)
                  (make-3d-vector x y z))
              (orientation pose)))

(defun rotate-pose (pose axis angle)
  "Return POSE, stamped or not, turned on the spot by ANGLE (rad) about the axis :x, :y or :z of the
frame in which it is given."
  (with-parts pose (origin pose) (q* (axis-turn axis angle) (orientation pose))))

(defun rotate-pose-in-own-frame (pose axis angle)
  "Return POSE, stamped or not, turned on the spot by ANGLE (rad) about its own axis :x, :y or :z."
  (with-parts pose (origin pose) (q* (orientation pose) (axis-turn axis angle))))

(defun translate-transform-stamped (transform &key (x-offset 0d0) (y-offset 0d0) (z-offset 0d0))
  "Return TRANSFORM with X-OFFSET, Y-OFFSET and Z-OFFSET (m) added to its translation."
  (with-parts transform
              (v+ (translation transform) (make-3d-vector x-offset y-offset z-offset))
              (rotation transform)))

(defun rotate-transform-in-own-frame (transform axis angle)
  "Return TRANSFORM with its rotation preceded by one by ANGLE (rad) about the axis :x, :y or :z."
  (with-parts transform
              (translation transform)
              (q* (rotation transform) (axis-turn axis angle))))

;;; Stamped transforms

(defun transform-stamped-inv (transform)
  "Return the inverse of the transform-stamped TRANSFORM: from its frame to its child frame."
  (transform->transform-stamped (child-frame-id transform) (frame-id transform) (stamp transform)
                                (transform-inv transform)))

(defun strip-transform-stamped (transform)
  "Return the POSE-STAMPED of the child frame of the transform-stamped TRANSFORM."
  (transform-stamped->pose-stamped transform))

(defun warn-of-mismatch (operation expected found)
  (unless (string= (bare-frame-name expected) (bare-frame-name found))
    (warn 'frame-mismatch :operation operation :expected expected :found found)))

(defun product-as (kind x-frame z-frame left right)
  (let ((product (transform left right))
        (stamp (min (stamp left) (stamp right))))
    (case kind
      (:transform (transform->transform-stamped x-frame z-frame stamp product))
      (:pose (transform->pose-stamped x-frame stamp product))
      (t (unsuitable kind "the result-as-pose-or-transform" ":pose or :transform")))))

(defun multiply-transform-stampeds (x-frame z-frame x-y-transform y-z-transform
                                    &key (result-as-pose-or-transform :transform))
  "Return the product of the stamped transforms X-Y-TRANSFORM and Y-Z-TRANSFORM with the earlier of
their stamps: with RESULT-AS-POSE-OR-TRANSFORM :transform the TRANSFORM-STAMPED from Z-FRAME to
X-FRAME, with :pose the POSE-STAMPED of Z-FRAME in X-FRAME.  Warns by FRAME-MISMATCH where the
frames of the transforms are not these or do not meet, and goes on."
  (flet ((check (expected found)
           (warn-of-mismatch 'multiply-transform-stampeds expected found)))
    (check x-frame (frame-id x-y-transform))
    (check (child-frame-id x-y-transform) (frame-id y-z-transform))
    (check z-frame (child-frame-id y-z-transform)))
  (product-as result-as-pose-or-transform x-frame z-frame x-y-transform y-z-transform))

(defun apply-transform (left-hand-side-transform right-hand-side-transform
                        &key (result-as-pose-or-transform :transform))
  "Return the product of two stamped transforms: MULTIPLY-TRANSFORM-STAMPEDS from the frame of the
left one to the child frame of the right one."
  (warn-of-mismatch 'apply-transform (child-frame-id left-hand-side-transform)
                    (frame-id right-hand-side-transform))
  (product-as result-as-pose-or-transform
              (frame-id left-hand-side-transform) (child-frame-id right-hand-side-transform)
              left-hand-side-transform right-hand-side-transform))

;;; Poses in other frames

(defun ensure-pose-in-frame (pose frame &key use-current-ros-time use-zero-time)
  "Return POSE as a POSE-STAMPED in the frame named FRAME, by what *TRANSFORMER* knows; NIL if POSE
is NIL.  A pose without a frame is taken as one of *FIXED-FRAME* at time 0.  With USE-ZERO-TIME true
the stamp is 0, else it stays; USE-CURRENT-ROS-TIME has no effect.  Signals UNKNOWN-FRAME."
  (declare (ignore use-current-ros-time))
  (when pose
    (let ((stamped (if (typep pose 'pose-stamped)
                       pose
                       (pose->pose-stamped *fixed-frame* 0d0 pose))))
      (transform-pose-stamped *transformer* :target-frame frame
                                            :pose (if use-zero-time
                                                      (copy-pose-stamped stamped :stamp 0d0)
                                                      stamped)))))

(defun ensure-point-in-frame (point frame &key use-current-ros-time use-zero-time)
  "Return the 3d-vector POINT as a POINT-STAMPED in the frame named FRAME, by what *TRANSFORMER*
knows.  A point without a frame is taken as one of *FIXED-FRAME* at time 0.  With USE-ZERO-TIME true
the stamp is 0, else it stays; USE-CURRENT-ROS-TIME has no effect.  Signals UNKNOWN-FRAME."
  (declare (ignore use-current-ros-time))
  (let ((stamped (if (typep point 'point-stamped)
                     point
                     (make-point-stamped *fixed-frame* 0d0 point))))
    (transform-point-stamped *transformer* :target-frame frame
                                           :point (if use-zero-time
                                                      (copy-point-stamped stamped :stamp 0d0)
                                                      stamped))))

(defun frame-to-pose-in-fixed-frame (frame-name)
  "Return the POSE-STAMPED in *FIXED-FRAME* of the frame named FRAME-NAME, by what *TRANSFORMER*
knows, with stamp 0.  Signals UNKNOWN-FRAME."
  (pose->pose-stamped *fixed-frame* 0d0 (pose-from-geometry (lookup-frame frame-name))))

(defun robot-current-pose ()
  "Return the POSE-STAMPED in *FIXED-FRAME* of the robot's base, by what *TRANSFORMER* knows, with
stamp 0.  Signals UNKNOWN-FRAME."
  (frame-to-pose-in-fixed-frame *robot-base-frame*))
