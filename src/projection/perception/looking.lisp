;;;; The head process module: motions of type looking.
;;;;
;;;; Where to look is said by one of
;;;;   :target, :pose    a pose, or an object or a location that has one
;;;;   :frame            the name of a link of the robot or of a fixture, or of an item, a string
;;;;   :direction        :forward (both joints at 0), :up, :down, :left, :right, :left-down or
;;;;                     :right-down, as seen from the base
;;;;   :joint-angles     the list of the positions of pan and tilt (rad).

(in-package #:discrepancy-finder.projection)

(defparameter *directions*
  '((:up 1 0 1) (:down 1 0 -1) (:left 0 1 0) (:right 0 -1 0) (:left-down 1 1 -1)
    (:right-down 1 -1 -1))
  "The vector in the frame of the base for each direction but forward.")

(defun direction-target (robot direction)
  "Return a pose in DIRECTION, one of *DIRECTIONS*, as ROBOT's camera sees it when it looks
forward, or NIL if there is no such direction."
  (let ((vector (rest (assoc direction *directions*))))
    (when vector
      (let* ((camera (compose (inverse (base-pose robot)) (camera-pose robot)))
             (far (mapcar (lambda (number) (* 100 number)) vector)))
        ;; So far away that it does not matter where the camera is.
        (compose (base-pose robot)
                 (apply #'make-pose
                        (mapcar #'+ far (list (pose-x camera) (pose-y camera)
                                              (pose-z camera)))))))))

(defun frame-pose (projection name)
  "Return the pose of the frame NAME, a string: a link of PROJECTION's robot, an item or a link of a
fixture; NIL if there is none."
  (let ((robot (projection-robot projection))
        (item (find name (projection-items projection) :key #'car :test #'same-name-p)))
    (cond ((frame-number robot name) (robot-link-pose robot name))
          (item (bullet:body-pose (cdr item)))
          (t (multiple-value-bind (link fixture) (part-link projection name)
               (and link (fixture-link-pose projection link fixture)))))))

(defun move-head-to-angles (projection angles)
  "Move the head to ANGLES, the list of pan and tilt (rad).  Signals PTU-GOAL-NOT-REACHED, after the
move, where a limit forbids it."
  (destructuring-bind (pan tilt) angles
    (move-head projection pan tilt)
    (loop for role in '(:pan :tilt)
          for angle in (list pan tilt)
          for position = (joint-position (projection-robot projection) role)
          for miss = (- position angle)
          do (when (> (abs (- miss (* 2 pi (round miss (* 2 pi))))) *pointing-tolerance*)
               (plan:fail 'plan:ptu-goal-not-reached
                          :target angles
                          :description
                          (format nil "~a stops at ~,3f rad"
                                  (urdf-joint-name
                                   (find-joint (projection-robot projection) role))
                                  position))))))

(defun looking-target (projection designator)
  "Return the pose that the motion DESIGNATOR is to look at and what the plan named, or NIL."
  (let* ((place (or (plan:desig-prop-value designator :pose)
                    (plan:desig-prop-value designator :target)))
         (frame (plan:desig-prop-value designator :frame))
         (direction (plan:desig-prop-value designator :direction)))
    (cond (place (values (pose-meant place) place))
          ((stringp frame) (values (frame-pose projection frame) frame))
          (direction (values (direction-target (projection-robot projection) direction)
                             direction)))))

(defun angles-p (thing)
  (and (alexandria:proper-list-p thing) (= (length thing) 2) (every #'realp thing)))

(defmethod execute-designator ((projection projection) (class (eql :motion)) (type (eql :looking))
                               designator)
  (check-robot-part projection :head :pan)
  (let ((angles (plan:desig-prop-value designator :joint-angles)))
    (multiple-value-bind (target place) (looking-target projection designator)
      (cond (target (look-at projection target place))
            ((angles-p angles)
             (move-head-to-angles projection (mapcar #'decimal-double angles)))
            ((eq (plan:desig-prop-value designator :direction) :forward)
             (move-head-to-angles projection '(0d0 0d0)))
            (t (misunderstood designator "a motion of type looking needs a pose, a target with a ~
                                          pose, a frame, a direction or two joint angles"))))
    (camera-pose (projection-robot projection))))
