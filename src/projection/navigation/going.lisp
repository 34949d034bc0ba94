;;;; The navigation process module: motions of type going.
;;;;
;;;; The base drives straight to its goal at a trapezoidal velocity profile.  Robot and fixtures do
;;;; not push each other in Bullet (kinematic and static bodies), so the module looks for contact
;;;; itself as the base moves and stops there.

(in-package #:discrepancy-finder.projection)

(defconstant +contact-interval+ 12
  "Contact with fixtures is looked for every so many steps: 5 cm at 1 m/s.")

(defun drive-base (projection goal)
  "Drive the robot of PROJECTION straight to the pose GOAL, of which x, y and yaw count.  Signals
NAVIGATION-GOAL-NOT-REACHED where a link touches a fixture; the base stops there."
  (let* ((robot (projection-robot projection))
         (scene (projection-scene projection))
         (start (base-pose robot))
         (turn (- (pose-yaw goal) (pose-yaw start)))
         (turn (- turn (* 2 pi (round turn (* 2 pi)))))
         (step 0))
    (let ((contact (call-along-profile
                    (lambda (fraction)
                      (setf (base-pose robot)
                            (make-pose (interpolate (pose-x start) (pose-x goal) fraction)
                                       (interpolate (pose-y start) (pose-y goal) fraction)
                                       (pose-z start)
                                       :yaw (+ (pose-yaw start) (* fraction turn))))
                      (step-projection projection)
                      (incf step)
                      (and (or (zerop (mod step +contact-interval+)) (= fraction 1))
                           (nth-value 1 (fixture-contact projection))))
                    ;; A turn on the spot counts as a drive of as many metres as radians.
                    (max (planar-distance start goal) (abs turn))
                    (scene-parameter scene :base-speed)
                    (scene-parameter scene :base-acceleration))))
      (when contact
        (plan:fail 'plan:navigation-goal-not-reached
                   :description (format nil "~{~a touches ~a~}" contact))))))

(defmethod execute-designator ((projection projection) (class (eql :motion)) (type (eql :going))
                               designator)
  (let ((goal (plan:designated-pose (or (plan:desig-prop-value designator :pose)
                                        (plan:desig-prop-value designator :target)))))
    (unless goal
      (misunderstood designator "a motion of type going needs a pose, or a target with a pose"))
    (drive-base projection goal)
    (base-pose (projection-robot projection))))
