;;;; The navigation process module: motions of type going.
;;;;
;;;; The base drives straight to its goal, or around what is in the way, at a trapezoidal velocity
;;;; profile, and stops a little beside the goal by the tolerances of the scene.  Robot and fixtures
;;;; do not push each other in Bullet (kinematic and static bodies): the motion ends where the robot
;;;; or what it carries would touch something.

(in-package #:discrepancy-finder.projection)

(defun base-gait (projection)
  "Return how fast the base of PROJECTION's robot may be."
  (flet ((value (name) (projection-parameter projection name)))
    (make-gait (value :base-speed) (value :base-acceleration) (value :base-deceleration)
               (/ (value :base-speed) (value :base-turn-speed)))))

(defun stopping-place (projection goal)
  "Return the place where the base of PROJECTION's robot really stops when it goes to the pose
GOAL."
  (destructuring-bind (x y yaw)
      (loop for name in '(:base-stopping-error-x :base-stopping-error-y :base-stopping-error-yaw)
            collect (projection-parameter projection name))
    (if (= 0 x y yaw)
        (pose-place goal)
        (pose-place (compose (make-pose (pose-x goal) (pose-y goal) 0 :yaw (pose-yaw goal))
                             (make-pose x y 0 :yaw yaw))))))

(defun run-base (projection path &key (watch :all) ignore (free-p (constantly t)))
  "Drive the base of PROJECTION's robot along PATH, a list of places that begins where it is; see
RUN-MOTION.  FREE-P is a function that tells whether the base can be at a place."
  (let* ((robot (projection-robot projection))
         (terrain (projection-terrain projection))
         (gait (base-gait projection))
         (last (destructuring-bind (x y yaw) (first (last path))
                 (ground-pose terrain x y (standing-height robot) yaw))))
    (let ((bases (path-bases gait path terrain (standing-height robot) free-p last)))
      (unless (zerop (length bases))
        (run-motion projection (/ (length bases) 7) :bases bases :watch watch :ignore ignore)))))

(defun drive-base (projection goal)
  "Drive the base of PROJECTION's robot to the pose GOAL, of which x, y and yaw count.  Signals
NAVIGATION-POSE-UNREACHABLE, before it moves, if it cannot stand there or no way leads there, and
NAVIGATION-GOAL-NOT-REACHED where it or what it carries would touch something; the base stops
before."
  (multiple-value-bind (path problem footing) (plan-base-path projection goal)
    (unless path
      (plan:fail 'plan:navigation-pose-unreachable
                 :location goal
                 :description (ecase problem
                                (:goal (format nil "at its goal the robot would touch ~{~a~^ and ~}"
                                               (touched-at projection (pose-place goal))))
                                (:path "no way leads to the goal"))))
    (multiple-value-bind (reason bodies)
        (run-base projection (append (butlast path) (list (stopping-place projection goal)))
                  :free-p (lambda (place) (> (footing-clearance footing place 0d0) 0)))
      (when reason
        (plan:fail 'plan:navigation-goal-not-reached
                   :location goal
                   :description (contact-text bodies))))))

(defmethod execute-designator ((projection projection) (class (eql :motion)) (type (eql :going))
                               designator)
  (let ((goal (pose-meant (or (plan:desig-prop-value designator :pose)
                              (plan:desig-prop-value designator :target)))))
    (unless goal
      (misunderstood designator "a motion of type going needs a pose, or a target with a pose"))
    (drive-base projection goal)
    (base-pose (projection-robot projection))))
