;;;; Vectors, quaternions, poses, transforms: laws by random trials against the geometry layer,
;;;; exact values where rotations are awkward, texts.

(in-package #:discrepancy-finder.tests)

(def-suite transforms :in all)
(in-suite transforms)

(defun vector-of (x y z)
  (transforms:make-3d-vector x y z))

(defun quaternion-of (x y z w)
  (transforms:make-quaternion x y z w))

(defun vector-near-p (a b &optional (tolerance 1d-12))
  (< (transforms:v-dist a b) tolerance))

(defun quaternion-parts (quaternion)
  (list (transforms:x quaternion) (transforms:y quaternion)
        (transforms:z quaternion) (transforms:w quaternion)))

(defun same-rotation-p (a b &optional (tolerance 1d-12))
  "Return true if the quaternions A and B are the same rotation, whatever their length and sign."
  (let ((a (transforms:normalize a))
        (b (transforms:normalize b)))
    (or (< (transforms:q-norm (transforms:q- a b)) tolerance)
        (< (transforms:q-norm (transforms:q+ a b)) tolerance))))

(defun random-part (state)
  (- (random 4d0 state) 2d0))

(defun random-vector (state)
  (vector-of (random-part state) (random-part state) (random-part state)))

(defun random-rotation (state)
  (transforms:normalize (quaternion-of (random-part state) (random-part state)
                                       (random-part state) (random-part state))))

(defun random-transform (state)
  (transforms:make-transform (random-vector state) (random-rotation state)))

(defmacro with-trials ((count state) &body body)
  "Evaluate BODY COUNT times with STATE bound to the same seeded random state."
  `(let ((,state (sb-ext:seed-random-state 20240613)))
     (loop repeat ,count do (progn ,@body))))

;;; Vectors

(test vectors-are-double-floats
  (is (equal '(0.1d0 1d0 0.5d0) (transforms:3d-vector->list (vector-of 0.1 1 1/2))))
  (is (equal '(0.1d0 7d0 0.5d0)
             (transforms:3d-vector->list (transforms:copy-3d-vector (vector-of 0.1 1 1/2) :y 7))))
  (is (equal '(0.1d0 0d0 0d0)
             (transforms:3d-vector->list (make-instance 'transforms:3d-vector :x 0.1)))))

(test vector-algebra
  (let ((a (vector-of 1 2 3)) (b (vector-of -4 5 0.5)))
    (flet ((list-of (vector) (transforms:3d-vector->list vector)))
      (is (equal '(-3d0 7d0 3.5d0) (list-of (transforms:v+ a b))))
      (is (equal '(-2d0 9d0 6.5d0) (list-of (transforms:v+ a b a))))
      (is (equal '(5d0 -3d0 2.5d0) (list-of (transforms:v- a b))))
      (is (equal '(-1d0 -2d0 -3d0) (list-of (transforms:v- a))))
      (is (equal '(-1d0 -2d0 -3d0) (list-of (transforms:v-inv a))))
      (is (equal '(0.5d0 1d0 1.5d0) (list-of (transforms:v* a 0.5))))
      (is (equal '(-14d0 -12.5d0 13d0) (list-of (transforms:cross-product a b)))))
    (is (= 7.5d0 (transforms:dot-product a b)))
    (is (= 5d0 (transforms:v-norm (vector-of 3 0 -4))))
    (is (= 5d0 (transforms:v-dist (vector-of 1 1 1) (vector-of 4 5 1))))
    (is (vector-near-p (vector-of 0.6 0 -0.8) (transforms:normalize-vector (vector-of 3 0 -4))))))

;;; Quaternions

(test quaternion-algebra
  (let ((i (quaternion-of 1 0 0 0)) (j (quaternion-of 0 1 0 0)) (k (quaternion-of 0 0 1 0)))
    (is (equal '(0d0 0d0 1d0 0d0) (quaternion-parts (transforms:q* i j))))
    (is (equal '(0d0 0d0 -1d0 0d0) (quaternion-parts (transforms:q* j i))))
    (is (equal '(0d0 0d0 0d0 -1d0) (quaternion-parts (transforms:q* i j k))))
    (is (equal '(1d0 1d0 -1d0 0d0) (quaternion-parts (transforms:q- (transforms:q+ i j) k)))))
  (is (= 30d0 (transforms:q-dot (quaternion-of 1 2 3 4) (quaternion-of 1 2 3 4))))
  (with-trials (50 state)
    (let* ((q (quaternion-of (random-part state) (random-part state)
                             (random-part state) (random-part state)))
           (one (transforms:q* q (transforms:q-inv q))))
      (is (< (transforms:q-norm (transforms:q- one (transforms:make-identity-rotation))) 1d-12)))))

(test rotations-do-not-depend-on-length-or-sign
  (with-trials (50 state)
    (let* ((q (random-rotation state))
           (v (random-vector state))
           (turned (transforms:rotate q v)))
      (is (vector-near-p turned (transforms:rotate (transforms:q- q) v)))
      (is (vector-near-p turned (transforms:rotate (transforms:q+ q q q) v)))
      (is (< (transforms:angle-between-quaternions q (transforms:q- (transforms:q+ q q))) 1d-7)))))

(test slerp-between-rotations
  (let ((from (transforms:make-identity-rotation))
        (to (transforms:euler->quaternion :az (/ pi 2))))
    (is (equal (quaternion-parts from) (quaternion-parts (transforms:slerp from to 0))))
    (is (equal (quaternion-parts to) (quaternion-parts (transforms:slerp from to 1))))
    (is (same-rotation-p (transforms:euler->quaternion :az (/ pi 8))
                         (transforms:slerp from to 1/4)))
    ;; The negative of a quaternion is the same rotation: the way is as short.
    (is (same-rotation-p (transforms:euler->quaternion :az (/ pi 8))
                         (transforms:slerp from (transforms:q- to) 1/4)))
    (is (same-rotation-p to (transforms:slerp from (transforms:q- to) 1)))
    (dolist (ratio '(0 0.3 0.5 1))
      (is (equal (quaternion-parts from)
                 (quaternion-parts (transforms:slerp from (transforms:q- from) ratio)))))
    ;; By half a turn there are two ways of the same length; one of them is taken.
    (is (nearly (/ pi 2) (transforms:angle-between-quaternions
                          from (transforms:slerp from (quaternion-of 0 0 1 0) 0.5))))
    ;; A tiny turn.
    (is (nearly 5d-10 (transforms:get-yaw
                       (transforms:slerp from (transforms:euler->quaternion :az 1d-9) 0.5))
                1d-20)))
  (with-trials (50 state)
    (let* ((from (random-rotation state)) (to (random-rotation state))
           (ratio (random 1d0 state)) (between (transforms:slerp from to ratio)))
      (is (nearly 1 (transforms:q-norm between)))
      (is (nearly (* ratio (transforms:angle-between-quaternions from to))
                  (transforms:angle-between-quaternions from between)
                  1d-7)))))

;;; Rotations in other notations

(test plane-angles
  (is (= pi (transforms:normalize-angle pi)))
  (is (= pi (transforms:normalize-angle (- pi))))
  (is (zerop (transforms:normalize-angle (* 2 pi))))
  (is (nearly 1 (transforms:normalize-angle (+ 1 (* 20 pi)))))
  (is (nearly -1 (transforms:normalize-angle (- -1 (* 20 pi)))))
  (is (nearly 0.2 (transforms:shortest-angular-distance (- pi 0.1) (+ (- pi) 0.1)) 1d-7))
  (is (nearly -0.5 (transforms:shortest-angular-distance 1 0.5))))

(test euler-angles-are-those-of-geometry
  (with-trials (100 state)
    (let* ((roll (random-part state)) (pitch (random-part state)) (yaw (random-part state))
           (q (transforms:euler->quaternion :ax roll :ay pitch :az yaw))
           (pose (geometry:make-pose 0 0 0 :roll roll :pitch pitch :yaw yaw)))
      (is (equal (nthcdr 3 (geometry:pose-components pose)) (quaternion-parts q)))
      (is (nearly (geometry:pose-yaw pose) (transforms:get-yaw q)))
      (is (same-rotation-p q (apply #'transforms:euler->quaternion
                                    (transforms:quaternion->euler q))))
      (when (< (abs pitch) 1.5)
        (is (every #'nearly (list roll pitch yaw)
                   (transforms:quaternion->euler q :just-values t)))))))

(test euler-angles-straight-up-and-down
  "Where roll and yaw turn about the same axis, and beside it, the angles still make the rotation."
  (dolist (pitch (list (/ pi 2) (- (/ pi 2))))
    (dolist (off '(0 1d-13 1d-10 1d-8 1d-5))
      (dolist (yaw '(0 0.3d0 -2d0 3d0))
        (dolist (roll '(0 0.7d0 -1d0))
          (let* ((q (transforms:euler->quaternion :ax roll :ay (+ pitch off) :az yaw))
                 (angles (transforms:quaternion->euler q)))
            (is (same-rotation-p q (apply #'transforms:euler->quaternion angles) 1d-11)
                "~a ~a ~a" roll (+ pitch off) yaw))))))
  (let ((angles (transforms:quaternion->euler
                 (transforms:euler->quaternion :ax 0.5 :ay (/ pi 2) :az 0.75))))
    (is (zerop (getf angles :ax)))
    (is (nearly (/ pi 2) (getf angles :ay)))
    (is (nearly 0.25 (getf angles :az)))))

(test axis-and-angle
  (is (same-rotation-p (transforms:euler->quaternion :ay 0.4)
                       (transforms:axis-angle->quaternion (vector-of 0 3 0) 0.4)))
  (multiple-value-bind (axis angle)
      (transforms:quaternion->axis-angle (transforms:make-identity-rotation))
    (is (equal '(1d0 0d0 0d0) (transforms:3d-vector->list axis)))
    (is (zerop angle)))
  (multiple-value-bind (axis angle)
      (transforms:quaternion->axis-angle
       (transforms:axis-angle->quaternion (vector-of 0 0 1) (* 3/2 pi)))
    (is (vector-near-p (vector-of 0 0 -1) axis))
    (is (nearly (/ pi 2) angle)))
  (is (nearly 1d-9 (nth-value 1 (transforms:quaternion->axis-angle
                                 (transforms:euler->quaternion :ax 1d-9)))
              1d-20))
  (with-trials (50 state)
    (let ((q (random-rotation state)))
      (is (same-rotation-p q (multiple-value-call #'transforms:axis-angle->quaternion
                               (transforms:quaternion->axis-angle q)))))))

(test matrices
  (is (equalp #2A((0d0 -1d0 0d0) (1d0 0d0 0d0) (0d0 0d0 1d0))
              (transforms:quaternion->matrix (quaternion-of 0 0 1 1))))
  (flet ((round-trip-p (q)
           (same-rotation-p q (transforms:matrix->quaternion (transforms:quaternion->matrix q)))))
    ;; Half turns, where the real part is zero, and turns with each part the largest.
    (dolist (parts '((1 0 0 0) (0 1 0 0) (0 0 1 0) (1 1 0 0) (0 -1 1 0)
                     (9 1 2 1) (1 9 2 -1) (2 1 9 1) (1 1 1 9)))
      (is (round-trip-p (apply #'quaternion-of parts)) "~a" parts))
    (with-trials (50 state)
      (is (round-trip-p (random-rotation state)))
      (let* ((there (random-transform state))
             (again (transforms:matrix->transform (transforms:transform->matrix there))))
        (is (vector-near-p (transforms:translation there) (transforms:translation again)))
        (is (same-rotation-p (transforms:rotation there) (transforms:rotation again))))))
  (is (same-rotation-p (transforms:euler->quaternion :az (/ pi 2))
                       (transforms:column-vectors->quaternion
                        (vector-of 0 1 0) (vector-of -1 0 0) (vector-of 0 0 1)))))

;;; Transforms

(test transforms-compose-as-poses-of-geometry-do
  (with-trials (100 state)
    (let* ((a (random-transform state)) (b (random-transform state))
           (c (random-transform state)) (p (random-vector state))
           (geometry-a (transforms:geometry-pose a))
           (geometry-b (transforms:geometry-pose b)))
      (is (poses-nearly-equal-p (geometry:compose geometry-a geometry-b)
                                (transforms:geometry-pose (transforms:transform* a b))))
      (is (poses-nearly-equal-p (geometry:inverse geometry-a)
                                (transforms:geometry-pose (transforms:transform-inv a))))
      (is (poses-nearly-equal-p (transforms:geometry-pose (transforms:transform* a b c))
                                (transforms:geometry-pose
                                 (transforms:transform (transforms:transform a b) c))))
      (is (poses-nearly-equal-p
           (geometry:compose geometry-a geometry-b)
           (transforms:geometry-pose
            (transforms:transform-pose a (transforms:transform->pose b)))))
      (is (vector-near-p p (transforms:transform-point
                            (transforms:transform-inv a) (transforms:transform-point a p))))
      (is (vector-near-p (transforms:transform* a b p)
                         (transforms:transform (transforms:transform* a b) p))))))

(test transforms-of-quaternions-that-are-not-unit
  (let ((quarter (transforms:make-transform (vector-of 1 2 3) (quaternion-of 0 0 0.7 0.7))))
    (is (vector-near-p (vector-of 1 3 3) (transforms:transform-point quarter (vector-of 1 0 0))))
    (is (vector-near-p (vector-of 1 0 0) (transforms:transform (transforms:transform-inv quarter)
                                                               (vector-of 1 3 3))))
    (is (poses-nearly-equal-p (geometry:make-pose 1 2 3 :yaw (/ pi 2))
                              (transforms:geometry-pose quarter)))))

(test geometry-and-back-keeps-the-bits
  (with-trials (100 state)
    (let ((pose (geometry:make-pose (random-part state) (random-part state) (random-part state)
                                    :roll (random-part state) :pitch (random-part state)
                                    :yaw (random-part state))))
      (is (geometry:pose= pose (transforms:geometry-pose (transforms:pose-from-geometry pose)))))))

;;; Texts

(test transforms-print-as-in-cram
  (let ((*print-pretty* t) (*package* (find-package '#:cl-user))
        (*read-default-float-format* 'single-float)
        (origin (vector-of 1 2 0.5)) (turn (transforms:make-identity-rotation)))
    (is (equal "#<3D-VECTOR (1.0d0 2.0d0 0.5d0)>" (prin1-to-string origin)))
    (is (equal "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>" (princ-to-string turn)))
    (is (equal "#<POSE
   #<3D-VECTOR (1.0d0 2.0d0 0.5d0)>
   #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>"
               (prin1-to-string (transforms:make-pose origin turn))))
    (is (equal "#<POSE-STAMPED
   FRAME-ID: \"map\", STAMP: 0.5d0
   #<3D-VECTOR (1.0d0 2.0d0 0.5d0)>
   #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>"
               (princ-to-string (transforms:make-pose-stamped "map" 0.5 origin turn))))
    (let ((*print-pretty* nil))
      (is (equal (format nil "#<TRANSFORM-STAMPED FRAME-ID: \"map\", CHILD-FRAME-ID: \"cup\", ~
                              STAMP: 0.0d0 #<3D-VECTOR (1.0d0 2.0d0 0.5d0)> ~
                              #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>")
                 (prin1-to-string
                  (transforms:make-transform-stamped "map" "cup" 0 origin turn))))
      (is (equal (format nil "#<POINT-STAMPED FRAME-ID: \"map\", STAMP: 0.0d0 ~
                              #<3D-VECTOR (1.0d0 2.0d0 0.5d0)>>")
                 (prin1-to-string (transforms:make-point-stamped "map" 0 origin)))))))

(test unsuitable-values-are-named
  (signals-with (transforms:unsuitable-value "The x of a 3d-vector must be a finite real number"
                                             ":ONE")
    (vector-of :one 2 3))
  (signals-with (transforms:unsuitable-value "The z of a 3d-vector")
    (make-instance 'transforms:3d-vector :z "3"))
  (signals-with (transforms:unsuitable-value "The w of a quaternion")
    (quaternion-of 0 0 0 sb-ext:double-float-positive-infinity))
  (signals-with (transforms:unsuitable-value "The y of a 3d-vector" "finite")
    (vector-of 0 (expt 10 400) 0))
  (signals-with (transforms:unsuitable-value "The origin of a pose must be a 3d-vector" "(1 2 3)")
    (transforms:make-pose '(1 2 3) (transforms:make-identity-rotation)))
  (signals-with (transforms:unsuitable-value "What translation is asked of must be a transform"
                                             "#<POSE #<3D-VECTOR")
    (transforms:translation (transforms:make-identity-pose)))
  (signals-with (transforms:unsuitable-value "What is transformed")
    (transforms:transform (transforms:make-identity-transform) 5))
  (signals-with (transforms:unsuitable-value "right-handed")
    (transforms:matrix->quaternion #2A((1 0 0) (0 1 0) (0 0 -1))))
  (signals-with (transforms:unsuitable-value "3 x 3 or 4 x 4")
    (transforms:matrix->quaternion #2A((1 0) (0 1))))
  (signals-with (transforms:unsuitable-value "What means a pose" "(1 2)")
    (transforms:geometry-pose '(1 2)))
  (signals-with (transforms:zero-length "A quaternion of length zero has no direction.")
    (transforms:normalize (quaternion-of 0 0 0 0)))
  (signals-with (transforms:zero-length "A quaternion of length zero")
    (transforms:geometry-pose (transforms:make-pose (vector-of 0 0 0) (quaternion-of 0 0 0 0))))
  (signals-with (transforms:zero-length "A vector of length zero")
    (transforms:axis-angle->quaternion (vector-of 0 0 0) 1)))
