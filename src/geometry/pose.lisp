;;;; Poses: the position and orientation of a body, or of one frame in another.
;;;;
;;;; A POSE is a read-only value.  Users make one from a position and fixed-axis roll, pitch and
;;;; yaw (MAKE-POSE, the convention of URDF), the physics layer from a quaternion
;;;; (QUATERNION-POSE).  COMPOSE and INVERSE make poses a group: (compose a b) is the pose of b's
;;;; frame, given in a, as seen from the frame in which a is given.

(in-package #:discrepancy-finder.geometry)

(defun decimal-double (number)
  "Return the real NUMBER as a double float.  A single float stands for the shortest decimal that it
prints as, so that 0.1 typed at a REPL that reads single floats means 0.1d0."
  (float (if (typep number 'single-float) (rationalize number) number) 1d0))

(declaim (inline %make-pose quaternion-pose))
(defstruct (pose (:constructor %make-pose (x y z qx qy qz qw)) (:copier nil))
  "A position (m) and a unit quaternion."
  (x 0d0 :type double-float :read-only t)
  (y 0d0 :type double-float :read-only t)
  (z 0d0 :type double-float :read-only t)
  (qx 0d0 :type double-float :read-only t)
  (qy 0d0 :type double-float :read-only t)
  (qz 0d0 :type double-float :read-only t)
  (qw 1d0 :type double-float :read-only t))

(setf (documentation 'pose-p 'function)
      "Return true if its argument is a POSE."
      (documentation 'pose-x 'function)
      "Return the x coordinate (m) of a pose."
      (documentation 'pose-y 'function)
      "Return the y coordinate (m) of a pose."
      (documentation 'pose-z 'function)
      "Return the z coordinate (m) of a pose."
      (documentation 'pose-qx 'function)
      "Return the x part of the unit quaternion of a pose."
      (documentation 'pose-qy 'function)
      "Return the y part of the unit quaternion of a pose."
      (documentation 'pose-qz 'function)
      "Return the z part of the unit quaternion of a pose."
      (documentation 'pose-qw 'function)
      "Return the real part of the unit quaternion of a pose.")

(defun unprintable-p (number)
  (or (sb-ext:float-nan-p number) (> (abs number) 1d100)))

(defmethod print-object ((pose pose) stream)
  (print-unreadable-object (pose stream :type t)
    (let ((numbers (pose-components pose)))
      ;; A pose that some function refuses is printed in its message; to compute with it may trap.
      (if (notany #'unprintable-p numbers)
          (format stream "x ~,3f y ~,3f z ~,3f yaw ~,3f"
                  (pose-x pose) (pose-y pose) (pose-z pose) (pose-yaw pose))
          (format stream "~{~s~^ ~}" numbers)))))

(defmethod make-load-form ((pose pose) &optional environment)
  (make-load-form-saving-slots pose :environment environment))

(defun make-pose (x y z &key (roll 0d0) (pitch 0d0) (yaw 0d0))
  "Return the pose at position X, Y, Z (m), turned by ROLL, PITCH and YAW (rad) about the fixed
axes x, y and z, in this order, as URDF has it.  The arguments are reals."
  (let* ((r (/ (decimal-double roll) 2)) (p (/ (decimal-double pitch) 2))
         (w (/ (decimal-double yaw) 2))
         (cr (cos r)) (sr (sin r)) (cp (cos p)) (sp (sin p)) (cy (cos w)) (sy (sin w)))
    (%make-pose (decimal-double x) (decimal-double y) (decimal-double z)
                (- (* sr cp cy) (* cr sp sy))
                (+ (* cr sp cy) (* sr cp sy))
                (- (* cr cp sy) (* sr sp cy))
                (+ (* cr cp cy) (* sr sp sy)))))

(defun quaternion-pose (x y z qx qy qz qw)
  "Return the pose at X, Y, Z (m) with the unit quaternion QX, QY, QZ, QW; all double floats."
  (%make-pose x y z qx qy qz qw))

(defun identity-pose ()
  "Return the pose of a frame in itself."
  (%make-pose 0d0 0d0 0d0 0d0 0d0 0d0 1d0))

(defun pose-yaw (pose)
  "Return the angle (rad) in ]-pi, pi] by which POSE turns the x axis about the vertical."
  (with-accessors ((qx pose-qx) (qy pose-qy) (qz pose-qz) (qw pose-qw)) pose
    (atan (* 2 (+ (* qw qz) (* qx qy)))
          (- 1 (* 2 (+ (* qy qy) (* qz qz)))))))

(defun pose-components (pose)
  "Return the list of the seven numbers of POSE: x, y, z (m), qx, qy, qz, qw."
  (list (pose-x pose) (pose-y pose) (pose-z pose)
        (pose-qx pose) (pose-qy pose) (pose-qz pose) (pose-qw pose)))

(defun components-pose (components)
  "Return the pose whose POSE-COMPONENTS are the list COMPONENTS of seven double floats."
  (destructuring-bind (x y z qx qy qz qw) components
    (%make-pose x y z qx qy qz qw)))

;;; Composition is in the inner loop of every simulation: forward kinematics at each step.

(declaim (inline multiply-quaternions rotate))

(defun multiply-quaternions (ax ay az aw bx by bz bw)
  (declare (double-float ax ay az aw bx by bz bw))
  (values (+ (* aw bx) (* ax bw) (* ay bz) (- (* az by)))
          (+ (* aw by) (- (* ax bz)) (* ay bw) (* az bx))
          (+ (* aw bz) (* ax by) (- (* ay bx)) (* az bw))
          (- (* aw bw) (* ax bx) (* ay by) (* az bz))))

(defun rotate (pose x y z)
  "Return, as three values, the vector X, Y, Z turned by the orientation of POSE."
  (declare (type pose pose) (double-float x y z))
  (let ((qx (pose-qx pose)) (qy (pose-qy pose)) (qz (pose-qz pose)) (qw (pose-qw pose)))
    (multiple-value-bind (tx ty tz tw) (multiply-quaternions qx qy qz qw x y z 0d0)
      (multiple-value-bind (rx ry rz) (multiply-quaternions tx ty tz tw (- qx) (- qy) (- qz) qw)
        (values rx ry rz)))))

(defun compose (outer inner)
  "Return the pose of INNER, which is given in the frame of OUTER, in the frame in which OUTER is
given."
  (declare (type pose outer inner) (optimize speed))
  (multiple-value-bind (x y z) (rotate outer (pose-x inner) (pose-y inner) (pose-z inner))
    (multiple-value-bind (qx qy qz qw)
        (multiply-quaternions (pose-qx outer) (pose-qy outer) (pose-qz outer) (pose-qw outer)
                              (pose-qx inner) (pose-qy inner) (pose-qz inner) (pose-qw inner))
      (%make-pose (+ (pose-x outer) x) (+ (pose-y outer) y) (+ (pose-z outer) z) qx qy qz qw))))

(defun inverse (pose)
  "Return the pose that, composed with POSE, gives the identity."
  (let ((turn (%make-pose 0d0 0d0 0d0 (- (pose-qx pose)) (- (pose-qy pose)) (- (pose-qz pose))
                          (pose-qw pose))))
    (multiple-value-bind (x y z) (rotate turn (pose-x pose) (pose-y pose) (pose-z pose))
      (%make-pose (- x) (- y) (- z) (pose-qx turn) (pose-qy turn) (pose-qz turn) (pose-qw turn)))))

(defun pose= (a b)
  "Return true if the poses A and B have the same bits."
  (every #'eql (pose-components a) (pose-components b)))

(defun planar-distance (a b)
  "Return the horizontal distance (m) between the positions of the poses A and B."
  (let ((dx (- (pose-x a) (pose-x b))) (dy (- (pose-y a) (pose-y b))))
    (sqrt (+ (* dx dx) (* dy dy)))))
