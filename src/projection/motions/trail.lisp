;;;; Trails: where the robot's base has been.
;;;;
;;;; RECORD-TRAIL lets a projection note the places through which its base goes from then on, ten a
;;;; second; BASE-TRAIL returns them, for pictures of paths.  Nothing is noted unless it is asked
;;;; for, and noting changes nothing else.

(in-package #:discrepancy-finder.projection)

(defparameter *trail-stride* 24
  "Of so many steps of a motion one is noted, and the last.")

(defun record-trail (projection)
  "Let PROJECTION note from now on where the base of its robot is.  Without a robot do nothing."
  (when (projection-robot projection)
    (let ((base (base-pose (projection-robot projection))))
      (setf (projection-trail projection)
            (list (list (pose-x base) (pose-y base) (pose-yaw base))))))
  (values))

(defun base-trail (projection)
  "Return the places where the base of PROJECTION's robot has been since RECORD-TRAIL, in order:
lists of x (m), y (m) and yaw (rad).  The list is empty if nothing was recorded."
  (reverse (projection-trail projection)))

(defun extend-trail (projection bases steps)
  "Note the places of the first STEPS of the vector BASES, seven numbers a step, if PROJECTION
records a trail."
  (when (and bases (projection-trail projection))
    (loop for step from 0 below steps
          do (when (or (zerop (mod (1+ step) *trail-stride*)) (= (1+ step) steps))
               (let ((base (apply #'quaternion-pose
                                  (loop for i from (* 7 step) repeat 7
                                        collect (aref bases i)))))
                 (push (list (pose-x base) (pose-y base) (pose-yaw base))
                       (projection-trail projection)))))))
