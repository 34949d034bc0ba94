;;;; Where a picture is taken from.
;;;;
;;;; A VIEWPOINT is a camera for pictures: a pose that looks along its x axis, with z upwards and y
;;;; to the left, as the cameras of robots do, and a field of view; a flat one sees along parallel
;;;; lines.  SCENE-VIEWPOINT stands outside of the scene, obliquely above it, at the distance from
;;;; which all of it is seen; ROBOT-VIEWPOINT is the robot's own camera.

(in-package #:discrepancy-finder.projection)

(defstruct (viewpoint (:copier nil))
  "A camera for pictures at POSE.  ACROSS and UPWARDS are the tangents of half the angles of view,
or, if FLAT, half the width and the height that are seen (m)."
  (pose nil :type pose :read-only t)
  (across 1d0 :type double-float :read-only t)
  (upwards 1d0 :type double-float :read-only t)
  (flat nil :read-only t))

(defparameter *angle-of-view* 0.8d0
  "From side to side of the narrow side of a perspective picture, rad.")

(defparameter *viewing-azimuth* -0.95d0
  "Pictures of a scene are taken from this direction, rad from the x axis.")

(defparameter *viewing-elevation* 0.6d0
  "Pictures of a scene are taken from this height, rad above the horizon.")

(defun viewing-pose (from target)
  "Return the pose of a camera at the position of the pose FROM that looks at the position of the
pose TARGET, with the picture upright, for VIEW-WORLD."
  (let ((dx (- (pose-x target) (pose-x from)))
        (dy (- (pose-y target) (pose-y from)))
        (dz (- (pose-z target) (pose-z from))))
    (make-pose (pose-x from) (pose-y from) (pose-z from)
               :yaw (if (= 0 dx dy) 0 (atan dy dx))
               :pitch (- (atan dz (sqrt (+ (* dx dx) (* dy dy))))))))

(defun pose-viewpoint (pose width height)
  "Return the viewpoint at POSE for a picture of WIDTH and HEIGHT pixels."
  (let ((narrow (tan (/ *angle-of-view* 2))) (side (min width height)))
    (make-viewpoint :pose pose :across (* narrow (/ width side 1d0))
                    :upwards (* narrow (/ height side 1d0)))))

(defun fitting-distance (corners turn across upwards)
  "Return the distance (m) from the origin at which a camera turned like the pose TURN, looking at
the origin, sees all CORNERS."
  (let ((outside (inverse turn)))
    (loop for corner in corners
          for local = (compose outside corner)
          maximize (- (max (/ (abs (pose-y local)) across) (/ (abs (pose-z local)) upwards))
                      (pose-x local)))))

(defun scene-viewpoint (chunks width height)
  "Return the viewpoint from which a picture of WIDTH and HEIGHT pixels shows all CHUNKS but ground
and walls, from outside."
  (let ((corners (mapcan #'chunk-corners (contents chunks))))
    (multiple-value-bind (low high) (corners-bounds (or corners (list (point-pose 0 0 0))))
      (destructuring-bind (x y z) (mapcar (lambda (a b) (/ (+ a b) 2)) low high)
        (let* ((turn (make-pose 0 0 0 :yaw (+ *viewing-azimuth* pi)
                                      :pitch *viewing-elevation*))
               (seen (pose-viewpoint turn width height))
               (distance (+ 0.2d0
                            (* 1.03d0
                               (fitting-distance
                                (loop for corner in corners
                                      collect (point-pose (- (pose-x corner) x)
                                                          (- (pose-y corner) y)
                                                          (- (pose-z corner) z)))
                                turn (viewpoint-across seen) (viewpoint-upwards seen))))))
          (pose-viewpoint (compose (point-pose x y z) (compose turn (point-pose (- distance) 0 0)))
                          width height))))))

(defun robot-viewpoint (projection)
  "Return the viewpoint of the camera of PROJECTION's robot, which sees as far aside as that does.
Signals MISSING-ROBOT-PART if there is none."
  (check-robot-part projection :camera :camera)
  (flet ((half (name)
           (tan (min 1.5d0 (/ (scene-parameter (projection-scene projection) name) 2)))))
    (make-viewpoint :pose (camera-pose (projection-robot projection))
                    :across (half :camera-field-of-view)
                    :upwards (half :camera-vertical-field-of-view))))

(defun downward-viewpoint (low high)
  "Return the flat viewpoint from above that sees just the rectangle from LOW to HIGH, lists whose
first two numbers are x and y (m), with y upwards in the picture."
  (destructuring-bind ((x0 y0 &rest low-z) (x1 y1 &rest high-z)) (list low high)
    (declare (ignore low-z high-z))
    (make-viewpoint :pose (compose (point-pose (/ (+ x0 x1) 2) (/ (+ y0 y1) 2) 50)
                                   (quaternion-from-turns))
                    :across (/ (- x1 x0) 2) :upwards (/ (- y1 y0) 2) :flat t)))

(defun quaternion-from-turns ()
  "Return the orientation of a camera that looks down, with the y axis upwards in the picture."
  (compose (make-pose 0 0 0 :yaw (/ pi 2)) (make-pose 0 0 0 :pitch (/ pi 2))))
