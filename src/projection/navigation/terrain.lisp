;;;; Terrain: the ground under the base.
;;;;
;;;; Parts of fixtures that are lower than the parameter step-height, such as a door sill, are
;;;; driven over.  The base stands on four wheels near the corners of its root link; each is lifted
;;;; by what is under it, along a smooth step as long as the parameter suspension, so that the base
;;;; rises and pitches with finite accelerations.

(in-package #:discrepancy-finder.projection)

(defstruct (terrain (:constructor make-terrain (sills wheels suspension)) (:copier nil))
  "SILLS are the pieces that are driven over, WHEELS the places (x . y) of the wheels in the frame
of the base: front left and right, rear left and right."
  (sills '() :type list :read-only t)
  (wheels '() :type list :read-only t)
  (suspension 0.05d0 :type double-float :read-only t))

(defparameter *wheel-inset* 0.08d0
  "The distance (m) of the wheels from the edges of the base.")

(defun wheel-places (piece)
  "Return the places of the wheels of a base with the outline PIECE."
  (flet ((extent (offset)
           (loop for i from offset below (length (piece-polygon piece)) by 2
                 for value = (aref (piece-polygon piece) i)
                 minimize value into low maximize value into high
                 finally (return (let ((inset (min *wheel-inset* (/ (- high low) 4))))
                                   (list (+ low inset) (- high inset)))))))
    (destructuring-bind ((rear front) (right left)) (list (extent 0) (extent 1))
      (list (cons front left) (cons front right) (cons rear left) (cons rear right)))))

(declaim (inline smooth-step))
(defun smooth-step (fraction)
  "Return the smooth step from 0 to 1 that has no velocity and no acceleration at its ends."
  (declare (double-float fraction))
  (cond ((<= fraction 0d0) 0d0)
        ((>= fraction 1d0) 1d0)
        (t (* fraction fraction fraction (+ 10 (* fraction (- (* 6 fraction) 15)))))))

(defun outside-distance (piece x y)
  "Return a lower bound of how far (m) the point X, Y is outside of PIECE; it is exact, and
negative, inside."
  (declare (double-float x y) (optimize speed (safety 1)))
  (let ((edges (piece-edges piece)) (distance -1d9))
    (declare (type doubles edges) (double-float distance))
    (loop for i of-type fixnum below (length edges) by 3
          do (setf distance (max distance (- (+ (* (aref edges i) x) (* (aref edges (+ i 1)) y))
                                             (aref edges (+ i 2))))))
    distance))

(defun ground-height (terrain x y)
  "Return the height (m) of the ground of TERRAIN for a wheel at X, Y."
  (declare (double-float x y) (optimize speed (safety 1)))
  (let ((length (terrain-suspension terrain)) (height 0d0))
    (declare (double-float height))
    (dolist (sill (terrain-sills terrain) height)
      (let ((distance (outside-distance sill x y)))
        (declare (double-float distance))
        (when (< distance length)
          (setf height (max height (* (the double-float (piece-high sill))
                                      (smooth-step (- 0.5d0 (/ distance length)))))))))))

(defun wheel-heights (terrain x y yaw)
  "Return how high (m) the ground of TERRAIN is under the four wheels of a base at X, Y, turned by
YAW, as four values, and whether it is 0 under all."
  (declare (double-float x y yaw) (optimize speed (safety 1)))
  (let ((sine (sin yaw)) (cosine (cos yaw)))
    (flet ((height (wheel)
             (destructuring-bind (a . b) wheel
               (declare (double-float a b))
               (ground-height terrain (+ x (- (* cosine a) (* sine b)))
                              (+ y (+ (* sine a) (* cosine b)))))))
      (if (terrain-sills terrain)
          (destructuring-bind (front-left front-right rear-left rear-right)
              (terrain-wheels terrain)
            (let ((a (height front-left)) (b (height front-right))
                  (c (height rear-left)) (d (height rear-right)))
              (declare (double-float a b c d))
              (values a b c d (= 0d0 a b c d))))
          (values 0d0 0d0 0d0 0d0 t)))))

(defun ground-pose (terrain x y z yaw)
  "Return the pose of the base at X, Y, turned by YAW, at the height Z above the ground of TERRAIN."
  (multiple-value-bind (front-left front-right rear-left rear-right level)
      (wheel-heights terrain x y yaw)
    (if level
        (make-pose x y z :yaw yaw)
        (destructuring-bind ((front . left) right rear &rest last) (terrain-wheels terrain)
          (declare (ignore last))
          (make-pose x y (+ z (/ (+ front-left front-right rear-left rear-right) 4))
                     :yaw yaw
                     :pitch (atan (- (+ rear-left rear-right) front-left front-right)
                                  (* 2 (- front (car rear))))
                     :roll (atan (- (+ front-left rear-left) front-right rear-right)
                                 (* 2 (- left (cdr right)))))))))
