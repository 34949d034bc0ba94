;;;; Quaternions x i + y j + z k + w, read-only.
;;;;
;;;; A rotation is a quaternion of any length but zero: ROTATE and all that build on it are
;;;; indifferent to the length, so that 0 0 0.7 0.7 in a plan turns by a right angle.  A quaternion
;;;; and its negative are the same rotation.

(in-package #:discrepancy-finder.transforms)

(define-component w "a quaternion"
  "Return the real part of a quaternion, a double float.")

(defclass quaternion ()
  ((x :initarg :x :initform 0d0 :reader x :documentation "The x part.")
   (y :initarg :y :initform 0d0 :reader y :documentation "The y part.")
   (z :initarg :z :initform 0d0 :reader z :documentation "The z part.")
   (w :initarg :w :initform 1d0 :reader w :documentation "The real part."))
  (:documentation "A quaternion, which stands for a rotation; MAKE-QUATERNION makes one."))

(defmethod initialize-instance :after ((quaternion quaternion) &key)
  (with-slots (x y z w) quaternion
    (setf x (finite-double x "the x of a quaternion")
          y (finite-double y "the y of a quaternion")
          z (finite-double z "the z of a quaternion")
          w (finite-double w "the w of a quaternion"))))

(defmethod print-object ((quaternion quaternion) stream)
  (print-unreadable-object (quaternion stream)
    (format stream "QUATERNION (~a ~a ~a ~a)"
            (x quaternion) (y quaternion) (z quaternion) (w quaternion))))

(defmethod make-load-form ((quaternion quaternion) &optional environment)
  (make-load-form-saving-slots quaternion :environment environment))

(defun make-quaternion (x y z w)
  "Return the QUATERNION with the imaginary parts X, Y, Z and the real part W, all reals, as they
are: it is not normalized.  Signals UNSUITABLE-VALUE if one is no finite real number."
  (make-instance 'quaternion :x x :y y :z z :w w))

(defun make-identity-rotation ()
  "Return the QUATERNION of the rotation that turns nothing."
  (make-quaternion 0d0 0d0 0d0 1d0))

(defun copy-quaternion (quaternion &key x y z w)
  "Return a QUATERNION like QUATERNION, but with the parts X, Y, Z, W that are given."
  (make-quaternion (or x (x quaternion)) (or y (y quaternion))
                   (or z (z quaternion)) (or w (w quaternion))))

(defun q+ (quaternion &rest quaternions)
  "Return the sum of QUATERNION and QUATERNIONS, part by part."
  (reduce (lambda (a b)
            (make-quaternion (+ (x a) (x b)) (+ (y a) (y b)) (+ (z a) (z b)) (+ (w a) (w b))))
          quaternions :initial-value quaternion))

(defun q- (quaternion &rest quaternions)
  "Return QUATERNION less all QUATERNIONS, part by part; its negative if there are none."
  (if quaternions
      (reduce (lambda (a b)
                (make-quaternion (- (x a) (x b)) (- (y a) (y b)) (- (z a) (z b)) (- (w a) (w b))))
              quaternions :initial-value quaternion)
      (q-scaled quaternion -1d0)))

(defun q* (quaternion &rest quaternions)
  "Return the product of QUATERNION and QUATERNIONS: the rotation that turns by the last one first."
  (reduce (lambda (a b)
            (let ((ax (x a)) (ay (y a)) (az (z a)) (aw (w a))
                  (bx (x b)) (by (y b)) (bz (z b)) (bw (w b)))
              (make-quaternion (+ (* aw bx) (* ax bw) (* ay bz) (- (* az by)))
                               (+ (* aw by) (- (* ax bz)) (* ay bw) (* az bx))
                               (+ (* aw bz) (* ax by) (- (* ay bx)) (* az bw))
                               (- (* aw bw) (* ax bx) (* ay by) (* az bz)))))
          quaternions :initial-value quaternion))

(defun q-dot (a b)
  "Return the scalar product of the quaternions A and B, a double float."
  (+ (* (x a) (x b)) (* (y a) (y b)) (* (z a) (z b)) (* (w a) (w b))))

(defun q-norm (quaternion)
  "Return the length of QUATERNION, a double float; that of a rotation is usually 1."
  (sqrt (q-dot quaternion quaternion)))

(defun q-scaled (quaternion factor)
  (make-quaternion (* factor (x quaternion)) (* factor (y quaternion))
                   (* factor (z quaternion)) (* factor (w quaternion))))

(defun positive-square (quaternion)
  "Return the square of the length of QUATERNION.  Signals ZERO-LENGTH if it is zero."
  (let ((square (q-dot quaternion quaternion)))
    (if (zerop square)
        (error 'zero-length :kind "quaternion")
        square)))

(defun q-inv (quaternion)
  "Return the inverse of QUATERNION: the rotation back.  Signals ZERO-LENGTH if it is zero."
  (let ((square (positive-square quaternion)))
    (make-quaternion (- (/ (x quaternion) square)) (- (/ (y quaternion) square))
                     (- (/ (z quaternion) square)) (/ (w quaternion) square))))

(defun normalize-quaternion (quaternion)
  "Return QUATERNION divided by its length; itself if the length is 1 but for rounding.
Signals ZERO-LENGTH if it is zero."
  (let ((square (positive-square quaternion)))
    ;; That a unit quaternion keeps its bits makes conversions to and fro exact.
    (if (< (abs (- square 1)) 1d-12)
        quaternion
        (q-scaled quaternion (/ (sqrt square))))))

(defun normalize (thing)
  "Return the quaternion or 3d-vector of length 1 that points where THING does.  Signals ZERO-LENGTH
if THING is zero."
  (typecase thing
    (quaternion (normalize-quaternion thing))
    (3d-vector (normalize-vector thing))
    (t (unsuitable thing "what is normalized" "a quaternion or a 3d-vector"))))

(defun rotate (quaternion vector)
  "Return VECTOR turned by the rotation QUATERNION.  Signals ZERO-LENGTH if that is zero."
  (let ((square (positive-square quaternion))
        (turned (q* quaternion
                    (make-quaternion (x vector) (y vector) (z vector) 0d0)
                    (make-quaternion (- (x quaternion)) (- (y quaternion)) (- (z quaternion))
                                     (w quaternion)))))
    (make-3d-vector (/ (x turned) square) (/ (y turned) square) (/ (z turned) square))))

(defun angle-between-quaternions (a b)
  "Return the angle (rad) in [0, pi] of the rotation that leads from A to B.  Signals ZERO-LENGTH if
one of them is zero."
  (nth-value 1 (quaternion->axis-angle (q* (q-inv a) b))))

(defun slerp (from to ratio)
  "Return the unit quaternion at the real RATIO of the shorter turn from FROM (ratio 0) to TO (1).
It lies on the side of FROM, so that at 1 it is TO or its negative, which is the same rotation.
Signals ZERO-LENGTH if one of the quaternions is zero."
  (let* ((ratio (finite-double ratio "the ratio of slerp"))
         (from (normalize-quaternion from))
         (to (normalize-quaternion to))
         (to (if (minusp (q-dot from to)) (q- to) to))
         ;; The chords give the angle well where the arc cosine would not, near zero.
         (angle (* 2 (atan (q-norm (q- to from)) (q-norm (q+ to from)))))
         (sine (sin angle)))
    (if (< sine 1d-8)
        (normalize-quaternion (q+ (q-scaled from (- 1 ratio)) (q-scaled to ratio)))
        (q+ (q-scaled from (/ (sin (* (- 1 ratio) angle)) sine))
            (q-scaled to (/ (sin (* ratio angle)) sine))))))
