;;;; The motion runner: motions of the robot, step by step in the world.

(in-package #:discrepancy-finder.projection)

(defun call-along-profile (function length speed acceleration)
  "Call FUNCTION with the part of a move over LENGTH that is done after each simulation step, until
it returns true or the move is done.  Return what it returned last."
  (if (zerop length)
      nil
      (loop for fraction across (profile-fractions (make-profile length speed acceleration))
              thereis (funcall function fraction))))

(defun step-projection (projection)
  "Move the robot's links to where its joints are now, and the world by a step."
  (update-links (projection-robot projection))
  (bullet:step-world (projection-world projection)))

(defun move-joints (projection roles goals)
  "Move the joints with ROLES of PROJECTION's robot to GOALS (m or rad), all at once: the one that
has the longest way sets the profile."
  (let* ((robot (projection-robot projection))
         (scene (projection-scene projection))
         (starts (loop for role in roles collect (joint-position robot role)))
         (positions (joint-positions robot))
         (numbers (loop for role in roles collect (frame-number robot role))))
    (call-along-profile (lambda (fraction)
                          (loop for number in numbers for start in starts for goal in goals
                                do (setf (aref positions number)
                                         (interpolate start goal fraction)))
                          (step-projection projection)
                          nil)
                        (reduce #'max (mapcar (lambda (start goal) (abs (- goal start)))
                                              starts goals))
                        (scene-parameter scene :joint-speed)
                        (scene-parameter scene :joint-acceleration))))

(defun pass-time (projection steps)
  "Let PROJECTION run for a number of STEPS while the robot stands still."
  (foreign:with-c-float-traps
    (loop repeat steps do (step-projection projection))))

(defun settle (projection &key (limit 2))
  "Let PROJECTION run until everything in it rests, for LIMIT seconds at the most.  Return true if
it rests."
  (let ((world (projection-world projection)))
    (foreign:with-c-float-traps
      (loop repeat (ceiling limit +time-step+)
            until (bullet:at-rest-p world)
            do (bullet:step-world world))
      (bullet:at-rest-p world))))
