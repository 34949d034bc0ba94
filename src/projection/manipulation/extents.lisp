;;;; How far shapes reach in a direction, and frames made of two axes.
;;;;
;;;; Vectors are lists of three numbers.  SUPPORT is how far a shape reaches; a gripper's frame is
;;;; given by the direction in which it approaches (x) and the one in which it closes (y).

(in-package #:discrepancy-finder.projection)

(defun cross (a b)
  (destructuring-bind ((ax ay az) (bx by bz)) (list a b)
    (list (- (* ay bz) (* az by)) (- (* az bx) (* ax bz)) (- (* ax by) (* ay bx)))))

(defun stretched (vector factor)
  (mapcar (lambda (number) (* number factor)) vector))

(defun unit (vector)
  (stretched vector (/ (sqrt (dot vector vector)))))

(defun pose-position (pose)
  (list (pose-x pose) (pose-y pose) (pose-z pose)))

(defun turned (pose vector)
  "Return VECTOR, of the frame of POSE, in the frame in which POSE is given."
  (let ((tip (compose pose (apply #'make-pose vector))))
    (mapcar #'- (pose-position tip) (pose-position pose))))

(defun moved (pose vector)
  "Return POSE moved by VECTOR, along the axes of the frame in which POSE is given."
  (destructuring-bind (x y z) (mapcar #'+ (pose-position pose) vector)
    (quaternion-pose (float x 1d0) (float y 1d0) (float z 1d0)
                     (pose-qx pose) (pose-qy pose) (pose-qz pose) (pose-qw pose))))

(defun advanced (pose distance)
  "Return POSE moved by DISTANCE (m) along its own x axis."
  (compose pose (make-pose distance 0 0)))

(defun axes-pose (position x y)
  "Return the pose at POSITION with the x axis X and the y axis nearest to Y; X is a unit vector."
  (let* ((z (unit (cross x y)))
         (y (cross z x))
         ;; The rotation matrix has the axes as its columns.
         (xx (first x)) (yy (second y)) (zz (third z)) (trace (+ xx yy zz)))
    (flet ((quaternion (qx qy qz qw)
             (destructuring-bind (px py pz) position
               (let ((norm (sqrt (+ (* qx qx) (* qy qy) (* qz qz) (* qw qw)))))
                 (apply #'quaternion-pose
                        (mapcar (lambda (number) (float number 1d0))
                                (list px py pz (/ qx norm) (/ qy norm) (/ qz norm)
                                      (/ qw norm))))))))
      (let ((yx (second x)) (zx (third x)) (xy (first y)) (zy (third y)) (xz (first z))
            (yz (second z)))
        ;; Each branch is four times a component of the quaternion, which must not be small.
        (cond ((> trace 0) (quaternion (- zy yz) (- xz zx) (- yx xy) (+ 1 trace)))
              ((and (>= xx yy) (>= xx zz))
               (quaternion (+ 1 (- xx yy zz)) (+ xy yx) (+ xz zx) (- zy yz)))
              ((>= yy zz)
               (quaternion (+ xy yx) (+ 1 (- yy xx zz)) (+ yz zy) (- xz zx)))
              (t (quaternion (+ xz zx) (+ yz zy) (+ 1 (- zz xx yy)) (- yx xy))))))))

(defun support (shape direction)
  "Return how far (m) SHAPE reaches from its origin along the unit vector DIRECTION."
  (destructuring-bind (kind . arguments) shape
    (ecase kind
      (:box (loop for size in arguments for d in direction sum (* 1/2 size (abs d))))
      (:sphere (first arguments))
      (:cylinder (destructuring-bind ((radius length) (x y z)) (list arguments direction)
                   (+ (* radius (sqrt (+ (* x x) (* y y)))) (* 1/2 length (abs z)))))
      (:hull (loop for point in arguments maximize (dot point direction)))
      (:compound (loop for (pose part) in arguments
                       maximize (placed-support part pose direction))))))

(defun placed-support (shape pose direction)
  "Return how far (m) SHAPE, at POSE, reaches along the unit vector DIRECTION from the origin of the
frame in which POSE is given."
  (+ (dot (pose-position pose) direction)
     (support shape (turned (inverse (moved pose (stretched (pose-position pose) -1))) direction))))
