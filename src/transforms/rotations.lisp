;;;; Rotations in other notations than quaternions: angles about the fixed axes, an axis with an
;;;; angle, matrices; and plane angles.

(in-package #:discrepancy-finder.transforms)

;;; Plane angles

(defun normalize-angle (angle)
  "Return the angle in ]-pi, pi] that is ANGLE (rad) but for full turns, a double float."
  (let ((rest (rem (finite-double angle "an angle") (* 2 pi))))
    (cond ((> rest pi) (- rest (* 2 pi)))
          ((<= rest (- pi)) (+ rest (* 2 pi)))
          (t rest))))

(defun shortest-angular-distance (from to)
  "Return the angle in ]-pi, pi] by which to turn from the angle FROM to the angle TO (rad)."
  (normalize-angle (- (finite-double to "an angle") (finite-double from "an angle"))))

;;; Matrices

(defun quaternion->matrix (quaternion)
  "Return the 3 x 3 array, rows first, of double floats by which QUATERNION turns column vectors.
Signals ZERO-LENGTH if it is zero."
  (let* ((s (/ 2 (positive-square quaternion)))
         (x (x quaternion)) (y (y quaternion)) (z (z quaternion)) (w (w quaternion)))
    (make-array '(3 3)
                :element-type 'double-float
                :initial-contents
                `((,(- 1 (* s (+ (* y y) (* z z)))) ,(* s (- (* x y) (* w z)))
                   ,(* s (+ (* x z) (* w y))))
                  (,(* s (+ (* x y) (* w z))) ,(- 1 (* s (+ (* x x) (* z z))))
                   ,(* s (- (* y z) (* w x))))
                  (,(* s (- (* x z) (* w y))) ,(* s (+ (* y z) (* w x)))
                   ,(- 1 (* s (+ (* x x) (* y y)))))))))

(defun matrix-columns (matrix)
  "Return the list of the first three columns of MATRIX, to row three, as vectors."
  (unless (and (typep matrix '(array * (* *)))
               (member (array-dimensions matrix) '((3 3) (4 4)) :test #'equal))
    (unsuitable matrix "a matrix" "a 3 x 3 or 4 x 4 array"))
  (loop for column below 3
        collect (make-3d-vector (aref matrix 0 column) (aref matrix 1 column)
                                (aref matrix 2 column))))

(defun matrix->quaternion (matrix)
  "Return the unit QUATERNION of the rotation by the 3 x 3 or 4 x 4 array MATRIX, rows first; its
real part is not negative.  Signals UNSUITABLE-VALUE if MATRIX is none or turns nothing rigidly."
  (apply #'column-vectors->quaternion (matrix-columns matrix)))

(defun rotation-columns-p (a b c)
  "Return true if A, B and C are orthogonal unit vectors of a right-handed system, to within 1e-3."
  (flet ((near (value goal) (< (abs (- value goal)) 1d-3)))
    (and (near (v-norm a) 1) (near (v-norm b) 1) (near (v-norm c) 1)
         (near (dot-product a b) 0)
         (< (v-dist (cross-product a b) c) 2d-3))))

(defun column-vectors->quaternion (a b c)
  "Return the unit QUATERNION of the rotation that takes the axes x, y and z to the vectors A, B and
C; its real part is not negative.  Signals UNSUITABLE-VALUE if these are no orthogonal unit vectors
of a right-handed system, to within 1e-3."
  (unless (rotation-columns-p a b c)
    (unsuitable (list a b c) "the columns of a rotation matrix"
                "orthogonal unit vectors of a right-handed system"))
  (let* ((xx (x a)) (yy (y b)) (zz (z c))
         ;; Four times the square of each part; the largest is divided by, which keeps precision.
         (4x (+ 1 xx (- yy) (- zz))) (4y (+ 1 yy (- xx) (- zz)))
         (4z (+ 1 zz (- xx) (- yy))) (4w (+ 1 xx yy zz))
         (largest (max 4x 4y 4z 4w))
         (quaternion
           (cond ((= largest 4w)
                  (make-quaternion (- (z b) (y c)) (- (x c) (z a)) (- (y a) (x b)) 4w))
                 ((= largest 4x)
                  (make-quaternion 4x (+ (x b) (y a)) (+ (x c) (z a)) (- (z b) (y c))))
                 ((= largest 4y)
                  (make-quaternion (+ (x b) (y a)) 4y (+ (y c) (z b)) (- (x c) (z a))))
                 (t
                  (make-quaternion (+ (x c) (z a)) (+ (y c) (z b)) 4z (- (y a) (x b)))))))
    (normalize-quaternion (if (minusp (w quaternion)) (q- quaternion) quaternion))))

;;; Angles about the fixed axes

(defun euler->quaternion (&key (ax 0d0) (ay 0d0) (az 0d0))
  "Return the QUATERNION of the rotation by AX about the axis x, then by AY about y, then by AZ
about z (rad): the axes are fixed, so that these are roll, pitch and yaw."
  (let* ((r (/ (finite-double ax "ax") 2)) (p (/ (finite-double ay "ay") 2))
         (w (/ (finite-double az "az") 2))
         (cr (cos r)) (sr (sin r)) (cp (cos p)) (sp (sin p)) (cy (cos w)) (sy (sin w)))
    (make-quaternion (- (* sr cp cy) (* cr sp sy))
                     (+ (* cr sp cy) (* sr cp sy))
                     (- (* cr cp sy) (* sr sp cy))
                     (+ (* cr cp cy) (* sr sp sy)))))

(defun quaternion->euler (quaternion &key just-values)
  "Return the list (:ax roll :ay pitch :az yaw) of the angles (rad) from which EULER->QUATERNION
makes the rotation QUATERNION; with JUST-VALUES true the list (roll pitch yaw).  Pitch is in
[-pi/2, pi/2], the others in [-pi, pi].  Where the pitch is straight up or down only the sum of the
other turns is given: then the roll is 0.  Signals ZERO-LENGTH if QUATERNION is zero."
  (let* ((matrix (quaternion->matrix quaternion))
         (level (abs (complex (aref matrix 0 0) (aref matrix 1 0))))
         (pitch (atan (- (aref matrix 2 0)) level))
         (locked (< level 1d-12))
         (yaw (if locked
                  (atan (- (aref matrix 0 1)) (aref matrix 1 1))
                  (atan (aref matrix 1 0) (aref matrix 0 0))))
         ;; Roll is what is left after the yaw, which is ill-defined near the lock: so the three
         ;; fit together there too.
         (roll (if locked
                   0d0
                   (atan (- (* (sin yaw) (aref matrix 0 2)) (* (cos yaw) (aref matrix 1 2)))
                         (- (* (cos yaw) (aref matrix 1 1)) (* (sin yaw) (aref matrix 0 1)))))))
    (if just-values
        (list roll pitch yaw)
        (list :ax roll :ay pitch :az yaw))))

(defun get-yaw (quaternion)
  "Return the angle (rad) in [-pi, pi] by which QUATERNION turns about the vertical: the :AZ of
QUATERNION->EULER."
  (getf (quaternion->euler quaternion) :az))

;;; Axis and angle

(defun axis-angle->quaternion (axis angle)
  "Return the unit QUATERNION of the rotation by ANGLE (rad) about the vector AXIS, of any length.
Signals ZERO-LENGTH if AXIS is zero."
  (let* ((half (/ (finite-double angle "the angle of axis-angle->quaternion") 2))
         (part (v* (normalize-vector axis) (sin half))))
    (make-quaternion (x part) (y part) (z part) (cos half))))

(defun quaternion->axis-angle (quaternion)
  "Return, as two values, the unit vector of the axis and the angle (rad) in [0, pi] of the rotation
QUATERNION; the axis is x if it turns nothing.  Signals ZERO-LENGTH if QUATERNION is zero."
  (positive-square quaternion)
  (let* ((part (make-3d-vector (x quaternion) (y quaternion) (z quaternion)))
         (sine (v-norm part))
         (w (w quaternion)))
    (if (zerop sine)
        (values (make-3d-vector 1 0 0) 0d0)
        (values (v* part (/ (if (minusp w) -1 1) sine))
                (* 2 (atan sine (abs w)))))))
