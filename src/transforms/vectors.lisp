;;;; Vectors of space, read-only: positions and directions, in metres.

(in-package #:discrepancy-finder.transforms)

(define-component x "a 3d-vector or a quaternion"
  "Return the x coordinate of a 3d-vector (m) or the x part of a quaternion, a double float.")
(define-component y "a 3d-vector or a quaternion"
  "Return the y coordinate of a 3d-vector (m) or the y part of a quaternion, a double float.")
(define-component z "a 3d-vector or a quaternion"
  "Return the z coordinate of a 3d-vector (m) or the z part of a quaternion, a double float.")

(defclass 3d-vector ()
  ((x :initarg :x :initform 0d0 :reader x :documentation "The x coordinate (m).")
   (y :initarg :y :initform 0d0 :reader y :documentation "The y coordinate (m).")
   (z :initarg :z :initform 0d0 :reader z :documentation "The z coordinate (m)."))
  (:documentation "A point or a direction of space; MAKE-3D-VECTOR makes one."))

(deftype point ()
  "A 3D-VECTOR that means a position."
  '3d-vector)

(defmethod initialize-instance :after ((vector 3d-vector) &key)
  (with-slots (x y z) vector
    (setf x (finite-double x "the x of a 3d-vector")
          y (finite-double y "the y of a 3d-vector")
          z (finite-double z "the z of a 3d-vector"))))

(defmethod print-object ((vector 3d-vector) stream)
  (print-unreadable-object (vector stream)
    (format stream "3D-VECTOR (~a ~a ~a)" (x vector) (y vector) (z vector))))

(defmethod make-load-form ((vector 3d-vector) &optional environment)
  (make-load-form-saving-slots vector :environment environment))

(defun make-3d-vector (x y z)
  "Return the 3D-VECTOR with the coordinates X, Y, Z (m), which are reals.  Signals UNSUITABLE-VALUE
if one is no finite real number."
  (make-instance '3d-vector :x x :y y :z z))

(defun make-identity-vector ()
  "Return the 3D-VECTOR of length zero."
  (make-3d-vector 0d0 0d0 0d0))

(defun copy-3d-vector (vector &key x y z)
  "Return a 3D-VECTOR like VECTOR, but with the coordinates X, Y, Z (m) that are given."
  (make-3d-vector (or x (x vector)) (or y (y vector)) (or z (z vector))))

(defun v+ (vector &rest vectors)
  "Return the sum of VECTOR and VECTORS."
  (reduce (lambda (a b)
            (make-3d-vector (+ (x a) (x b)) (+ (y a) (y b)) (+ (z a) (z b))))
          vectors :initial-value vector))

(defun v- (vector &rest vectors)
  "Return VECTOR less all VECTORS; its negative if there are none."
  (if vectors
      (reduce (lambda (a b)
                (make-3d-vector (- (x a) (x b)) (- (y a) (y b)) (- (z a) (z b))))
              vectors :initial-value vector)
      (v-inv vector)))

(defun v* (vector factor)
  "Return VECTOR times the real FACTOR."
  (let ((factor (finite-double factor "the factor of v*")))
    (make-3d-vector (* factor (x vector)) (* factor (y vector)) (* factor (z vector)))))

(defun v-inv (vector)
  "Return the negative of VECTOR."
  (make-3d-vector (- (x vector)) (- (y vector)) (- (z vector))))

(defun dot-product (a b)
  "Return the scalar product of the vectors A and B (m2), a double float."
  (+ (* (x a) (x b)) (* (y a) (y b)) (* (z a) (z b))))

(defun cross-product (a b)
  "Return the vector product of the vectors A and B."
  (make-3d-vector (- (* (y a) (z b)) (* (z a) (y b)))
                  (- (* (z a) (x b)) (* (x a) (z b)))
                  (- (* (x a) (y b)) (* (y a) (x b)))))

(defun v-norm (vector)
  "Return the length (m) of VECTOR, a double float."
  (sqrt (dot-product vector vector)))

(defun v-dist (a b)
  "Return the distance (m) between the points A and B, a double float."
  (v-norm (v- a b)))

(defun normalize-vector (vector)
  "Return the vector of length 1 in the direction of VECTOR.  Signals ZERO-LENGTH if it has none."
  (let ((norm (v-norm vector)))
    (if (zerop norm)
        (error 'zero-length :kind "vector")
        (v* vector (/ norm)))))
