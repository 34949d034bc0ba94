;;;; Terrain: the ground under the base.
;;;;
;;;; Parts of fixtures that are lower than the parameter step-height, such as a door sill, are driven
;;;; over.  The base stands on four wheels near the corners of its root link; each is lifted by what
;;;; is under it, along a smooth step as long as the parameter suspension, so that the base rises and
;;;; pitches with finite accelerations.

(in-package #:discrepancy-finder.projection)

(defstruct (terrain (:constructor %make-terrain (sills wheels suspension reach)) (:copier nil))
  "SILLS are the pieces that are driven over, WHEELS the places (x . y) of the wheels in the frame of
the base: front left and right, rear left and right; no one feels a sill farther than REACH (m) from
the middle of the base."
  (sills '() :type list :read-only t)
  (wheels '() :type list :read-only t)
  (suspension 0.05d0 :type double-float :read-only t)
  (reach 0d0 :type double-float :read-only t))

(defun make-terrain (sills wheels suspension)
  "Return the terrain with the pieces SILLS for a base with WHEELS."
  (%make-terrain sills wheels suspension
                 (+ suspension (loop for (x . y) in wheels
                                     maximize (sqrt (+ (* x x) (* y y)))))))

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

(defun outside-distance (piece x y)
  "Return a lower bound of how far (m) the point X, Y is outside of PIECE; it is exact, and negative,
inside."
  (let ((point (make-array 2 :element-type 'double-float)))
    (setf (aref point 0) x (aref point 1) y)
    (gap-along-edges piece point 0d0 0d0)))

(defun smooth-step (fraction)
  "Return the smooth step from 0 to 1 that has no velocity and no acceleration at its ends."
  (cond ((<= fraction 0) 0d0)
        ((>= fraction 1) 1d0)
        (t (* fraction fraction fraction (+ 10 (* fraction (- (* 6 fraction) 15)))))))

(defun ground-height (terrain x y)
  "Return the height (m) of the ground of TERRAIN for a wheel at X, Y."
  (let ((length (terrain-suspension terrain)))
    (loop for sill in (terrain-sills terrain)
          maximize (* (piece-high sill)
                      (smooth-step (- 0.5d0 (/ (outside-distance sill x y) length)))))))

(defun level-at-p (terrain x y)
  "Return true if no wheel of a base at X, Y can stand on anything but the ground of TERRAIN."
  (declare (double-float x y))
  (loop for sill in (terrain-sills terrain)
        always (> (outside-distance sill x y) (terrain-reach terrain))))

(defun ground-pose (terrain x y z yaw)
  "Return the pose of the base at X, Y, turned by YAW, at the height Z above the ground of TERRAIN."
  (if (level-at-p terrain x y)
      (make-pose x y z :yaw yaw)
      (let ((sine (sin yaw)) (cosine (cos yaw)))
        (destructuring-bind (front-left front-right rear-left rear-right)
            (loop for (a . b) in (terrain-wheels terrain)
                  collect (ground-height terrain
                                         (+ x (- (* cosine a) (* sine b)))
                                         (+ y (+ (* sine a) (* cosine b)))))
          (destructuring-bind ((front . left) right rear &rest last) (terrain-wheels terrain)
            (declare (ignore last))
            (let ((rise (/ (+ front-left front-right rear-left rear-right) 4)))
              (if (zerop rise)
                  (make-pose x y z :yaw yaw)
                  (make-pose x y (+ z rise)
                             :yaw yaw
                             :pitch (atan (- (+ rear-left rear-right) front-left front-right)
                                          (* 2 (- front (car rear))))
                             :roll (atan (- (+ front-left rear-left) front-right rear-right)
                                         (* 2 (- left (cdr right))))))))))))
