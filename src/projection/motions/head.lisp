;;;; The head: pointing the camera at a place.  Motions of type looking are in looking.lisp.
;;;;
;;;; A head is two joints, pan and tilt, that turn a camera, in either order and about any axes.
;;;; HEAD-ANGLES turns one after the other, again and again, until the camera's axis meets the
;;;; target; where the tilt axis is level and the camera looks at right angles to it, as in most
;;;; heads, once each is enough, however far the camera is from the axes.  The joints then go there
;;;; as far as their limits let them.

(in-package #:discrepancy-finder.projection)

(defparameter *pointing-tolerance* 1d-5
  "The angle (rad) between the camera's axis and the way to the target that counts as none.")

(defconstant +aiming-rounds+ 50
  "After so many rounds a head of an unusual build points as well as it can.")

(defun check-robot-part (projection part role)
  "Signal MISSING-ROBOT-PART unless the robot of PROJECTION has a joint or link with ROLE."
  (let ((robot (projection-robot projection)))
    (unless (and robot (getf (scene-part-roles (robot-part robot)) role))
      (error 'missing-robot-part :part part :scene (scene-name (projection-scene projection))))))

(defun perpendicular-axes (axis)
  "Return two unit vectors that make a right-handed frame with the unit vector AXIS; all are lists."
  (destructuring-bind (x y z) axis
    (let* ((seed (cond ((<= (abs x) (min (abs y) (abs z))) (list 0d0 (- z) y))
                       ((<= (abs y) (abs z)) (list z 0d0 (- x)))
                       (t (list (- y) x 0d0))))
           (norm (sqrt (reduce #'+ (mapcar #'* seed seed)))))
      (destructuring-bind (ux uy uz) (mapcar (lambda (number) (/ number norm)) seed)
        (values (list ux uy uz)
                (list (- (* y uz) (* z uy)) (- (* z ux) (* x uz)) (- (* x uy) (* y ux))))))))

(defun aiming-turn (axis camera target)
  "Return the angle (rad) in [-pi, pi] by which to turn about AXIS, a list, through the origin, so
that the x axis of the pose CAMERA gets into one plane with AXIS and the position of TARGET; 0 where
no turn matters."
  (multiple-value-bind (u v) (perpendicular-axes axis)
    (flet ((across (pose)
             (loop for part in (list u v)
                   collect (+ (* (first part) (pose-x pose)) (* (second part) (pose-y pose))
                              (* (third part) (pose-z pose))))))
      (destructuring-bind ((cx cy) (fx fy) (tx ty))
          (list (across camera) (across (compose camera (make-pose 1 0 0))) (across target))
        (let* ((dx (- fx cx)) (dy (- fy cy))
               (speed (sqrt (+ (* dx dx) (* dy dy))))
               (radius (sqrt (+ (* tx tx) (* ty ty)))))
          (if (or (< speed 1d-9) (< radius 1d-9))
              0d0
              ;; The camera's axis passes the joint's at the distance ASIDE and is as far from it as
              ;; the target AHEAD of there.
              (let* ((dx (/ dx speed)) (dy (/ dy speed))
                     (aside (- (* cx dy) (* cy dx)))
                     (ahead (sqrt (max 0d0 (- (* radius radius) (* aside aside)))))
                     (turn (- (atan ty tx)
                              (atan (- (* ahead dy) (* aside dx)) (+ (* ahead dx) (* aside dy))))))
                (- turn (* 2 pi (round turn (* 2 pi)))))))))))

(defun head-angles (robot target)
  "Return the angles (rad) of ROBOT's pan and tilt joints at which its camera's axis best meets the
position of TARGET, limits aside.  They depend on nothing else than base, torso and target."
  (let* ((positions (joint-positions robot))
         (numbers (list (frame-number robot :pan) (frame-number robot :tilt)))
         (before (loop for number in numbers collect (aref positions number))))
    (dolist (number numbers)
      (setf (aref positions number) 0d0))
    (loop repeat +aiming-rounds+
          for turns = (loop for number in numbers
                            for frame = (svref (robot-frames robot) number)
                            for outside = (inverse (svref (update-poses robot) number))
                            collect (let ((turn (aiming-turn
                                                 (urdf-joint-axis (link-frame-joint frame))
                                                 (compose outside (camera-pose robot))
                                                 (compose outside target))))
                                      (incf (aref positions number) turn)
                                      turn))
          until (every (lambda (turn) (< (abs turn) 1d-12)) turns))
    (prog1 (loop for number in numbers collect (aref positions number))
      (loop for number in numbers for position in before
            do (setf (aref positions number) position)))))

(defun nearest-position (joint angle present)
  "Return the position within the limits of JOINT, now at PRESENT, that is equivalent to ANGLE (rad)
or else comes nearest to it."
  (if (and (urdf-joint-lower joint) (urdf-joint-upper joint))
      (flet ((clipped (angle)
               (max (urdf-joint-lower joint) (min (urdf-joint-upper joint) angle))))
        (let* ((angle (- angle (* 2 pi (round angle (* 2 pi)))))
               (equivalents (list angle (- angle (* 2 pi)) (+ angle (* 2 pi))))
               (misses (loop for equivalent in equivalents
                             collect (abs (- equivalent (clipped equivalent))))))
          (clipped (nth (position (reduce #'min misses) misses) equivalents))))
      (+ angle (* 2 pi (round (- present angle) (* 2 pi))))))

(defun move-head (projection pan tilt)
  "Move the head of PROJECTION's robot to the joint positions PAN and TILT (rad), both at once, as
far as the joints' limits let it.  Signals MISSING-ROBOT-PART if it has none."
  (check-robot-part projection :head :pan)
  (let ((robot (projection-robot projection)))
    (move-joints projection '(:pan :tilt)
                 (loop for role in '(:pan :tilt)
                       for angle in (list pan tilt)
                       collect (nearest-position (find-joint robot role) angle
                                                 (joint-position robot role))))))

(defun pointing-error (robot target)
  "Return the angle (rad) between the axis of ROBOT's camera and the way from it to the position of
TARGET; pi if the camera is there."
  (let* ((local (compose (inverse (camera-pose robot)) target))
         (ahead (pose-x local))
         (aside (sqrt (+ (expt (pose-y local) 2) (expt (pose-z local) 2)))))
    (if (< (+ (abs ahead) aside) 1d-9)
        pi
        (atan aside ahead))))

(defun look-at (projection target place)
  "Point the camera of PROJECTION's robot at the position of TARGET, as far as the head can.  PLACE
is what the plan named.  Signals PTU-GOAL-NOT-REACHED, after the move, if it is looked past."
  (let ((robot (projection-robot projection)))
    (destructuring-bind (pan tilt) (head-angles robot target)
      (move-head projection pan tilt)
      (let ((miss (pointing-error robot target)))
        (when (> miss *pointing-tolerance*)
          (plan:fail 'plan:ptu-goal-not-reached
                     :target place
                     :description
                     (format nil "the camera looks ~,3f rad past the target with ~a at ~,3f rad ~
                                  and ~a at ~,3f rad"
                             miss
                             (urdf-joint-name (find-joint robot :pan)) (joint-position robot :pan)
                             (urdf-joint-name (find-joint robot :tilt))
                             (joint-position robot :tilt))))))))
