;;; Plans for single actions.

(in-package :ts-plans)

(cpl:def-cram-function go-to-target (?target-location)
  "Drive to `?target-location'."
  (declare (type desig:location-designator ?target-location))
  (cpl:with-retry-counters ((nav-retries 1))
    (cpl:with-failure-handling
        ((common-fail:navigation-low-level-failure (e)
           (roslisp:ros-warn (ts-plans go) "Driving failed: ~a~%Ignoring." e)
           (cpl:do-retry nav-retries
             (let ((?next-location (desig:next-solution ?target-location)))
               (when ?next-location
                 (setf ?target-location ?next-location)
                 (cpl:retry))))
           (cpl:fail 'common-fail:navigation-goal-in-collision
                     :pose-stamped (desig:reference ?target-location)
                     :description "no other place")))
      (exe:perform
       (desig:a motion
                (type going)
                (target ?target-location)))
      (cram-occasions-events:on-event (make-instance 'cpoe:robot-state-changed)))))

(cpl:def-cram-function perceive (?object-designator
                                 &key
                                 (object-chosing-function #'identity))
  "Detect what fits `?object-designator'.  Of several, `object-chosing-function' picks."
  (declare (type desig:object-designator ?object-designator)
           (type function object-chosing-function))

  (cpl:with-retry-counters ((perceive-retries (if (desig:desig-prop-value ?object-designator
                                                                          :cad-model)
                                                  1
                                                  4)))
    (cpl:with-failure-handling
        (((or common-fail:perception-low-level-failure
              common-fail:actionlib-action-timed-out) (e)
           (cpl:do-retry perceive-retries
             (roslisp:ros-warn (ts-plans perceive) "~a" e)
             (cpl:retry))))

      (let* ((resulting-designators
               (exe:perform
                (desig:a motion
                         (type detecting)
                         (object ?object-designator))))
             (resulting-designator
               (funcall object-chosing-function resulting-designators)))
        (cram-occasions-events:on-event
         (make-instance 'cram-plan-occasions-events:object-perceived-event
           :object-designator resulting-designator
           :perception-source :whatever))
        (desig:current-desig resulting-designator)))))

(cpl:def-cram-function look-at (&key
                                ((:target ?target-location))
                                ((:frame ?frame))
                                ((:direction ?direction) :forward))
  (cpl:with-failure-handling
      ((common-fail:ptu-low-level-failure (e)
         (roslisp:ros-warn (ts-plans look-at) "Looking failed: ~a~%Ignoring." e)
         (return)))
    (exe:perform
     (desig:a motion
              (type looking)
              (desig:when ?target-location
                (target ?target-location))
              (desig:when (and ?frame (not ?target-location))
                (frame ?frame))
              (desig:when (not (or ?target-location ?frame))
                (direction ?direction))))
    t))

(defun maybe-list (?poses)
  "Return `?poses' as a list if it is none."
  (if (listp ?poses) ?poses (list ?poses)))

(cpl:def-cram-function move-arms-in-sequence (?left-poses ?right-poses
                                              &optional (?collision-mode :avoid-all))
  "Move the arms through the poses, both at the same time."
  (multiple-value-bind (left-poses right-poses)
      (cut:equalize-two-list-lengths (maybe-list ?left-poses) (maybe-list ?right-poses))
    (mapc (lambda (?left-pose ?right-pose)
            (exe:perform
             (desig:a motion
                      (type moving-tcp)
                      (desig:when ?left-pose
                        (left-target (desig:a location (pose ?left-pose))))
                      (desig:when ?right-pose
                        (right-target (desig:a location (pose ?right-pose))))
                      (collision-mode ?collision-mode))))
          left-poses
          right-poses)))

(cpl:def-cram-function grip (?gripper &optional ?effort)
  (cpl:with-retry-counters ((grasping-retries 1))
    (cpl:with-failure-handling
        ((common-fail:gripper-low-level-failure (e)
           (roslisp:ros-warn (ts-plans grip) "~a" e)
           (cpl:do-retry grasping-retries
             (roslisp:ros-warn (ts-plans grip) "Retrying")
             (setf ?effort nil)
             (cpl:retry))
           (roslisp:ros-warn (ts-plans grip) "No retries left.  Propagating up.")))
      (exe:perform
       (desig:a motion
                (type gripping)
                (gripper ?gripper)
                (desig:when ?effort
                  (effort ?effort)))))))

(cpl:def-cram-function release (?gripper)
  (exe:perform
   (desig:a motion (type opening) (gripper ?gripper))))

(cpl:def-cram-function pick-up (?object-designator ?arm ?gripper-opening ?grip-effort ?grasp
                                ?left-reach-poses ?right-reach-poses
                                ?left-grasp-poses ?right-grasp-poses
                                ?left-lift-poses ?right-lift-poses)
  "Reach, grip, lift.  Nothing is done about an object that slips."
  (declare (ignore ?grasp))
  (cpl:par
    (roslisp:ros-info (ts-plans pick-up) "Opening gripper and reaching")
    (exe:perform
     (desig:an action
               (type setting-gripper)
               (gripper ?arm)
               (position ?gripper-opening)))
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (e)
           (roslisp:ros-warn (ts-plans pick-up) "Reaching failed: ~a~%Ignoring." e)
           (return)))
      (exe:perform
       (desig:an action
                 (type reaching)
                 (left-poses ?left-reach-poses)
                 (right-poses ?right-reach-poses)))))
  (roslisp:ros-info (ts-plans pick-up) "Grasping")
  (cpl:with-retry-counters ((grasping-retries 1))
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (e)
           (cpl:do-retry grasping-retries
             (roslisp:ros-warn (ts-plans pick-up) "~a~%Retrying" e)
             (cpl:retry))
           (cpl:fail 'common-fail:object-unreachable :object ?object-designator)))
      (exe:perform
       (desig:an action
                 (type grasping)
                 (object ?object-designator)
                 (left-poses ?left-grasp-poses)
                 (right-poses ?right-grasp-poses)))))
  (exe:perform
   (desig:an action
             (type gripping)
             (gripper ?arm)
             (effort ?grip-effort)))
  (push (cons ?arm (desig:desig-prop-value ?object-designator :name)) *held*)
  (cram-occasions-events:on-event
   (make-instance 'cpoe:object-attached
     :arm ?arm
     :object-name (desig:desig-prop-value ?object-designator :name)))
  (exe:perform
   (desig:an action
             (type lifting)
             (left-poses ?left-lift-poses)
             (right-poses ?right-lift-poses)))
  (desig:current-desig ?object-designator))

(cpl:def-cram-function place (?object-designator ?arm ?location)
  (let ((?pose (desig:reference ?location)))
    (exe:perform
     (desig:an action
               (type putting)
               (desig:when (eql ?arm :left)
                 (left-poses (?pose)))
               (desig:when (eql ?arm :right)
                 (right-poses (?pose)))))
    (exe:perform
     (desig:an action (type releasing) (gripper ?arm)))
    (setf *held* (remove ?arm *held* :key #'car)
          (thing-pose (find (desig:desig-prop-value ?object-designator :name) *things*
                            :key #'thing-name))
          ?pose)
    (coe:on-event
     (make-instance 'cpoe:object-detached
       :arm ?arm
       :object-name (desig:desig-prop-value ?object-designator :name)))))
