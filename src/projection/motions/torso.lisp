;;;; The torso process module: motions of type moving-torso.

(in-package #:discrepancy-finder.projection)

(defun move-torso (projection position)
  "Move the torso of PROJECTION's robot to POSITION (m), as far as its limits let it.  Signals
TORSO-GOAL-NOT-REACHED, after the move, if that is not there or something is in the way."
  (check-robot-part projection :torso :torso)
  (let* ((joint (find-joint (projection-robot projection) :torso))
         (goal (max (or (urdf-joint-lower joint) position)
                    (min (or (urdf-joint-upper joint) position) position))))
    (multiple-value-bind (reason bodies) (run-joints projection (list (cons :torso goal)))
      (cond (reason
             (plan:fail 'plan:torso-goal-not-reached
                        :description (format nil "~a; ~a stops at ~,3f m" (contact-text bodies)
                                             (urdf-joint-name joint)
                                             (joint-position (projection-robot projection)
                                                             :torso))))
            ((> (abs (- goal position)) 1d-4)
             (plan:fail 'plan:torso-goal-not-reached
                        :description (format nil "~a is at its limit, ~,3f m, and not at ~,3f m"
                                             (urdf-joint-name joint) goal position)))))))

(defun torso-goal (projection designator)
  "Return the position (m) that DESIGNATOR wants the torso to have, or NIL."
  (let* ((joint (find-joint (projection-robot projection) :torso))
         (value (plan:desig-prop-value designator :joint-angle)))
    (case value
      (:upper-limit (urdf-joint-upper joint))
      (:lower-limit (urdf-joint-lower joint))
      (:middle (/ (+ (urdf-joint-lower joint) (urdf-joint-upper joint)) 2))
      (t (and (realp value) (decimal-double value))))))

(defmethod execute-designator ((projection projection) (class (eql :motion))
                               (type (eql :moving-torso)) designator)
  (check-robot-part projection :torso :torso)
  (let ((goal (torso-goal projection designator)))
    (unless goal
      (misunderstood designator "a motion of type moving-torso needs a joint-angle: a number, ~
                                 upper-limit, lower-limit or middle"))
    (move-torso projection goal)
    (joint-position (projection-robot projection) :torso)))
