;;;; Seeing: which part of an item the camera sees.
;;;;
;;;; An item is seen as far as rays from the camera to points on its surface get there: the point is
;;;; within the field of view and the range, and the first thing that the ray meets is the item.
;;;; The far side of an item counts as seen where its near side is.  The robot's own links hide
;;;; nothing.  VISIBLE-PART is the entry point.  It runs for every item that a plan looks for, in
;;;; every simulation: numbers in vectors, no poses.

(in-package #:discrepancy-finder.projection)

(deftype numbers ()
  '(simple-array double-float (*)))

(defun rigid-motion (pose)
  "Return POSE as a vector of twelve numbers: the rows of its rotation matrix, each with the
coordinate of its position behind."
  (let ((x (pose-qx pose)) (y (pose-qy pose)) (z (pose-qz pose)) (w (pose-qw pose))
        (motion (make-array 12 :element-type 'double-float)))
    (replace motion (list (- 1 (* 2 (+ (* y y) (* z z)))) (* 2 (- (* x y) (* w z)))
                          (* 2 (+ (* x z) (* w y))) (pose-x pose)
                          (* 2 (+ (* x y) (* w z))) (- 1 (* 2 (+ (* x x) (* z z))))
                          (* 2 (- (* y z) (* w x))) (pose-y pose)
                          (* 2 (- (* x z) (* w y))) (* 2 (+ (* y z) (* w x)))
                          (- 1 (* 2 (+ (* x x) (* y y)))) (pose-z pose)))))

(declaim (inline moved-point))
(defun moved-point (motion x y z)
  "Return, as three values, the point X, Y, Z moved by MOTION, a vector of RIGID-MOTION."
  (declare (type numbers motion) (double-float x y z))
  (flet ((row (start)
           (+ (* (aref motion start) x) (* (aref motion (+ start 1)) y)
              (* (aref motion (+ start 2)) z) (aref motion (+ start 3)))))
    (declare (inline row))
    (values (row 0) (row 4) (row 8))))

(defstruct (view (:constructor make-view (outside range across upwards)) (:copier nil))
  "What a camera can see: OUTSIDE is the motion from the world into its frame, RANGE in m, ACROSS
and UPWARDS are the tangents of half its fields of view."
  (outside nil :type numbers :read-only t)
  (range 0d0 :type double-float :read-only t)
  (across 0d0 :type double-float :read-only t)
  (upwards 0d0 :type double-float :read-only t))

(defun camera-view (scene camera)
  "Return the VIEW by the parameters of SCENE of a camera at the pose CAMERA."
  (flet ((half-tangent (name)
           (tan (/ (scene-parameter scene name) 2))))
    (make-view (rigid-motion (inverse camera))
               (scene-parameter scene :camera-range)
               (half-tangent :camera-field-of-view)
               (half-tangent :camera-vertical-field-of-view))))

(declaim (inline in-view-p))
(defun in-view-p (view x y z)
  "Return true if the point X, Y, Z of the world is within the field and range of VIEW."
  (declare (type view view) (double-float x y z))
  (multiple-value-bind (x y z) (moved-point (view-outside view) x y z)
    (and (> x 1d-6)
         (<= (+ (* x x) (* y y) (* z z)) (expt (view-range view) 2))
         (<= (abs y) (* (view-across view) x))
         (<= (abs z) (* (view-upwards view) x)))))

(defun points-in-view (view surface motion)
  "Return the points of the vector SURFACE, moved by MOTION, that are in VIEW, as a vector."
  (declare (type numbers surface motion) (optimize speed))
  (let ((points (make-array (length surface) :element-type 'double-float))
        (end 0))
    (declare (fixnum end))
    (loop for i of-type fixnum from 0 below (length surface) by 3
          do (multiple-value-bind (x y z)
                 (moved-point motion (aref surface i) (aref surface (+ i 1))
                              (aref surface (+ i 2)))
               (when (in-view-p view x y z)
                 (setf (aref points end) x
                       (aref points (+ end 1)) y
                       (aref points (+ end 2)) z)
                 (incf end 3))))
    (subseq points 0 end)))

(defun rays-to (points camera start end)
  "Return the rays from the position of CAMERA to the points number START to END of POINTS, for
BULLET:CAST-RAYS."
  (declare (type numbers points) (type (unsigned-byte 32) start end) (optimize speed))
  (let ((rays (make-array (* 6 (the (unsigned-byte 32) (- end start)))
                          :element-type 'double-float)))
    (loop for ray of-type fixnum from 0 by 6
          for point of-type fixnum from (* 3 start) below (* 3 end) by 3
          do (setf (aref rays ray) (pose-x camera)
                   (aref rays (+ ray 1)) (pose-y camera)
                   (aref rays (+ ray 2)) (pose-z camera))
             (replace rays points :start1 (+ ray 3) :start2 point :end2 (+ point 3)))
    rays))

(defconstant +rays-at-a-time+ 64
  "After so many rays it is looked at whether enough of an item was seen.")

(defun count-seen (world body points camera passed enough)
  "Return how many of POINTS, on BODY, rays from CAMERA reach; no more are tried once it is at least
ENOUGH."
  (let ((count (floor (length points) 3)))
    (loop with seen = 0
          for start from 0 below count by +rays-at-a-time+
          while (< seen enough)
          do (let ((rays (rays-to points camera start (min count (+ start +rays-at-a-time+)))))
               ;; A ray may end a last bit before the surface and meet nothing.
               (incf seen (count-if (lambda (other) (or (null other) (eq other body)))
                                    (bullet:cast-rays world rays :passed passed))))
          finally (return seen))))

(defun visible-part (projection name &key (enough 1))
  "Return which part, 0 to 1, of the surface of the item NAME, a symbol, the camera of PROJECTION's
robot sees; once it is at least ENOUGH the rest is not looked at.  Signals UNKNOWN-BODY, and
MISSING-ROBOT-PART if there is no camera."
  (check-robot-part projection :camera :camera)
  (let* ((body (item-body projection name))
         (robot (projection-robot projection))
         (camera (camera-pose robot))
         (surface (surface-vector (bullet:body-shape body)))
         (count (floor (length surface) 3))
         (points (points-in-view (camera-view (projection-scene projection) camera)
                                 surface (rigid-motion (bullet:body-pose body)))))
    (/ (if (zerop (length points))
           0
           (count-seen (projection-world projection) body points camera (link-bodies robot)
                       (* enough count)))
       (float count 1d0))))
