;;;; Motion profiles: how far something has got after a time.
;;;;
;;;; A move of a given length runs at a trapezoidal velocity profile: constant acceleration up to a
;;;; speed, constant speed, constant deceleration, which may be another; a short move never reaches
;;;; the speed.  All functions are pure.

(in-package #:discrepancy-finder.projection)

(defstruct (profile (:constructor %make-profile (length speed acceleration deceleration
                                                  rise fall duration))
                    (:copier nil))
  "A move over LENGTH (m or rad) that gets to SPEED (m/s or rad/s) in RISE (s) by ACCELERATION, and
from there to rest in FALL (s) by DECELERATION, after DURATION (s) in all."
  (length 0d0 :type double-float :read-only t)
  (speed 0d0 :type double-float :read-only t)
  (acceleration 0d0 :type double-float :read-only t)
  (deceleration 0d0 :type double-float :read-only t)
  (rise 0d0 :type double-float :read-only t)
  (fall 0d0 :type double-float :read-only t)
  (duration 0d0 :type double-float :read-only t))

(defun make-profile (length speed acceleration &optional (deceleration acceleration))
  "Return the profile of a move over LENGTH at most at SPEED.  All are positive double floats but
for LENGTH, which may be 0."
  (declare (double-float length speed acceleration deceleration))
  (let* ((peak (sqrt (/ (* 2 length acceleration deceleration) (+ acceleration deceleration))))
         (top (min speed peak))
         (rise (/ top acceleration))
         (fall (/ top deceleration))
         (cruise (if (< speed peak)
                     (- (/ length speed) (/ (+ rise fall) 2))
                     0d0)))
    (%make-profile length top acceleration deceleration rise fall (+ rise cruise fall))))

(defun profile-distance (profile time)
  "Return how far (m or rad) a move with PROFILE has got at TIME (s)."
  (declare (double-float time))
  (let ((speed (profile-speed profile)) (rise (profile-rise profile))
        (left (- (profile-duration profile) time)))
    (cond ((<= time 0) 0d0)
          ((<= left 0) (profile-length profile))
          ((< time rise) (* 0.5d0 (profile-acceleration profile) time time))
          ((< left (profile-fall profile))
           (- (profile-length profile) (* 0.5d0 (profile-deceleration profile) left left)))
          (t (* speed (- time (/ rise 2)))))))

(defun profile-fraction (profile time)
  "Return the part, 0 to 1, of a move with PROFILE that is done at TIME (s)."
  (if (zerop (profile-length profile))
      1d0
      (min 1d0 (/ (profile-distance profile time) (profile-length profile)))))

(defun profile-steps (profile)
  "Return the number of simulation steps that a move with PROFILE takes."
  (values (ceiling (- (/ (profile-duration profile) +time-step+) 1d-9))))

(defun profile-fractions (profile)
  "Return the vector of the parts of a move with PROFILE that are done after each simulation step;
the last one is 1."
  (let* ((steps (profile-steps profile))
         (fractions (make-array steps :element-type 'double-float)))
    (loop for step from 1 to steps
          do (setf (aref fractions (1- step))
                   (if (= step steps)
                       1d0
                       (profile-fraction profile (* step (float +time-step+ 1d0))))))
    fractions))

(declaim (inline interpolate))
(defun interpolate (start goal fraction)
  "Return the number at FRACTION of the way from START to GOAL."
  (+ start (* fraction (- goal start))))
