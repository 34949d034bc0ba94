;;;; Motion profiles: how far something has got after a time.
;;;;
;;;; A move of a given length runs at a trapezoidal velocity profile: constant acceleration up to a
;;;; speed, constant speed, constant deceleration; a short move never reaches the speed.
;;;; MOVE-JOINTS moves several joints so, all at once.

(in-package #:discrepancy-finder.projection)

(defun profile-duration (length speed acceleration)
  "Return the seconds that a move over LENGTH takes at most SPEED with ACCELERATION."
  (declare (double-float length speed acceleration))
  (if (<= length (/ (* speed speed) acceleration))
      (* 2 (sqrt (/ length acceleration)))
      (+ (/ length speed) (/ speed acceleration))))

(defun profile-fraction (time length speed acceleration)
  "Return the part, 0 to 1, of a move over LENGTH that is done at TIME."
  (declare (double-float time length speed acceleration))
  (let* ((duration (profile-duration length speed acceleration))
         (ramp (min (/ speed acceleration) (/ duration 2)))
         (distance (cond ((<= time 0) 0d0)
                         ((< time ramp) (* 0.5d0 acceleration time time))
                         ((< time (- duration ramp))
                          (+ (* 0.5d0 acceleration ramp ramp)
                             (* acceleration ramp (- time ramp))))
                         ((< time duration)
                          (- length (* 0.5d0 acceleration (expt (- duration time) 2))))
                         (t length))))
    (if (zerop length) 1d0 (min 1d0 (/ distance length)))))

(defun interpolate (start goal fraction)
  "Return the number at FRACTION of the way from START to GOAL."
  (+ start (* fraction (- goal start))))

(defun call-along-profile (function length speed acceleration)
  "Call FUNCTION with the part of a move over LENGTH that is done after each simulation step, until
it returns true or the move is done.  Return what it returned last."
  (if (zerop length)
      nil
      (let ((steps (ceiling (/ (profile-duration length speed acceleration) +time-step+))))
        (loop for step from 1 to steps
              for fraction = (if (= step steps)
                                 1d0
                                 (profile-fraction (* step (float +time-step+ 1d0))
                                                   length speed acceleration))
                thereis (funcall function fraction)))))

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
