;;;; Picking up and placing by an arm that a carriage lifts on a column.
;;;;
;;;; The gripper comes from above.  An item within reach of the shoulder is grasped at the middle of
;;;; its top by a fixed constraint between gripper and item, lifted, and carried in front of the
;;;; base.  Placing lowers it until its centre is at the target and lets go: how it comes to rest is
;;;; Bullet's business.

(in-package #:discrepancy-finder.projection)

;;; Inverse kinematics of the arm

(defun shoulder-distance (robot pose)
  "Return the horizontal distance (m) from ROBOT's shoulder to the position of POSE."
  (planar-distance (svref (update-poses robot) (frame-number robot :shoulder)) pose))

(defun arm-configuration (robot target)
  "Return lift, shoulder and extension that bring the tip of ROBOT's gripper to the position of
TARGET, as a list, or NIL if a joint limit forbids it."
  (let* ((local (compose (inverse (base-pose robot)) target))
         (tip (compose (inverse (base-pose robot)) (gripper-pose robot)))
         (configuration (list (+ (joint-position robot :lift) (- (pose-z local) (pose-z tip)))
                              (atan (pose-y local) (pose-x local))
                              (sqrt (+ (expt (pose-x local) 2) (expt (pose-y local) 2))))))
    (and (every (lambda (role position) (within-limits-p (find-joint robot role) position))
                '(:lift :shoulder :extension) configuration)
         configuration)))

;;; The gripper

(defparameter *grasp-gap* 1d-3
  "The distance (m) between the gripper's tip and the top of an item that is grasped.")

(defparameter *release-gap* 2d-3
  "The height (m) above its target at which an item is let go.")

(defun move-arm (projection lift shoulder extension)
  "Move the arm of PROJECTION's robot to the joint positions LIFT (m), SHOULDER (rad) and EXTENSION
(m), all at once."
  (move-joints projection '(:lift :shoulder :extension) (list lift shoulder extension)))

(defun upper-extent (shape pose)
  "Return how far (m) the top of SHAPE, at POSE, is above the position of POSE, however it lies."
  (flet ((rise (x y z)                  ; the height that a vector of the shape's frame gains
           (- (pose-z (compose pose (make-pose x y z))) (pose-z pose))))
    (ecase (first shape)
      (:box (destructuring-bind (x y z) (rest shape)
              (/ (+ (abs (rise x 0 0)) (abs (rise 0 y 0)) (abs (rise 0 0 z))) 2)))
      (:sphere (second shape))
      (:cylinder (destructuring-bind (radius length) (rest shape)
                   (+ (/ (abs (rise 0 0 length)) 2)
                      (* radius (sqrt (max 0d0 (- 1 (expt (rise 0 0 1) 2))))))))
      (:compound (loop for (offset part) in (rest shape)
                       for part-pose = (compose pose offset)
                       maximize (+ (- (pose-z part-pose) (pose-z pose))
                                   (upper-extent part part-pose)))))))

(defun check-reach (projection pose what)
  "Signal MANIPULATION-POSE-UNREACHABLE unless the position of POSE is within reach."
  (let ((distance (shoulder-distance (projection-robot projection) pose))
        (reach (scene-parameter (projection-scene projection) :reach)))
    (when (> distance reach)
      (plan:fail 'plan:manipulation-pose-unreachable
                 :description (format nil "~a is ~,3f m from the shoulder, which reaches ~,3f m"
                                      what distance reach)))))

(defun tip-configuration (projection pose height what)
  "Return the arm configuration with the gripper's tip at HEIGHT above the position of POSE.
Signals MANIPULATION-POSE-UNREACHABLE."
  (or (arm-configuration (projection-robot projection)
                         (make-pose (pose-x pose) (pose-y pose) (+ (pose-z pose) height)))
      (plan:fail 'plan:manipulation-pose-unreachable
                 :description (format nil "the joint limits of the arm keep it from ~a" what))))

(defun retract-arm (projection lift)
  "Take the arm back in front of the base at the height LIFT."
  (let* ((robot (projection-robot projection))
         (extension (or (urdf-joint-lower (find-joint robot :extension)) 0d0)))
    (move-arm projection lift (joint-position robot :shoulder) extension)
    (move-arm projection lift 0d0 extension)))

(defun visit (projection pose height what function)
  "Bring the tip of the gripper from above to HEIGHT above the position of POSE, call FUNCTION
there, and take the arm back."
  (let ((clearance (scene-parameter (projection-scene projection) :clearance)))
    (destructuring-bind (low-lift shoulder extension)
        (tip-configuration projection pose height what)
      (destructuring-bind (high-lift &rest more)
          (tip-configuration projection pose (+ height clearance) what)
        (declare (ignore more))
        (let ((robot (projection-robot projection)))
          (move-arm projection high-lift (joint-position robot :shoulder)
                    (joint-position robot :extension))
          (move-arm projection high-lift shoulder (joint-position robot :extension))
          (move-arm projection high-lift shoulder extension)
          (move-arm projection low-lift shoulder extension)
          (funcall function)
          (move-arm projection high-lift shoulder extension)
          (retract-arm projection high-lift))))))

(defun pick-up-by-column (projection designator)
  "Pick up the object of DESIGNATOR, an action, with the arm on a column; return the item's name."
  (let* ((name (designated-item projection (plan:desig-prop-value designator :object)))
         (body (cdr (assoc name (projection-items projection))))
         (pose (bullet:body-pose body))
         (what (format nil "the ~(~a~)" name)))
    (when (held-item projection)
      (plan:fail 'plan:gripper-goal-not-reached
                 :description (format nil "the gripper holds the ~(~a~)" (held-item projection))))
    (check-reach projection pose what)
    (visit projection pose (+ (upper-extent (bullet:body-shape body) pose) *grasp-gap*) what
           (lambda ()
             (note-grasp projection :arm name
                         (bullet:attach (gripper-body (projection-robot projection)) body))))
    name))

(defun place-by-column (projection designator)
  "Place what the arm on a column holds as DESIGNATOR, an action, says; return the item's name."
  (let ((target (plan:designated-pose (plan:desig-prop-value designator :target)))
        (name (held-item projection)))
    (unless target
      (misunderstood designator "an action of type placing needs a target with a pose"))
    (unless name
      (plan:fail 'plan:gripper-closed-completely :description "the gripper holds nothing to place"))
    (check-reach projection target "the target")
    (visit projection target
           ;; As high above the target as the gripper's tip is above the item that it holds.
           (+ (- (pose-z (gripper-pose (projection-robot projection)))
                 (pose-z (observed-pose projection name)))
              *release-gap*)
           "the target"
           (lambda ()
             (release-grasp projection :arm)
             (settle projection)))
    name))
