;;;; Tests of the projection layer: arms, grippers and drawers in the kitchen.

(in-package #:discrepancy-finder.tests)

(def-suite manipulation-kitchen :in all)
(in-suite manipulation-kitchen)

(defvar *manipulation-scene* nil)

(defun manipulation-scene ()
  "Return the kitchen without stopping and perception errors."
  (or *manipulation-scene*
      (setf *manipulation-scene*
            (projection:load-scene
             (asdf:system-relative-pathname "discrepancy-finder" "models/kitchen/scene.lisp")))))

(defun standing-at (x y yaw &rest poses)
  "Return the poses of a projection with the robot at X, Y, turned by YAW; POSES are more of them."
  (list* :robot (geometry:make-pose x y 0 :yaw yaw) poses))

(defun call-in-kitchen (function poses &rest options)
  "Return what FUNCTION returns, called with a projection of the kitchen with POSES, settled; NIL
and the plan failure if it signals one."
  (let ((projection (apply #'projection:make-projection (manipulation-scene) :poses poses
                           options)))
    (unwind-protect (progn (projection:settle projection)
                           (handler-case (funcall function projection)
                             (plan:plan-failure (failure) (values nil failure))))
      (projection:close-projection projection))))

(defun parking ()
  (plan:an action (type parking-arms)))

(defun picking-up-item (?name &rest more)
  (plan:make-designator :action
                        `((:type :picking-up)
                          (:object ,(plan:an object (name ?name)))
                          ,@more)))

(defun opening-drawer (?drawer &rest more)
  (plan:make-designator :action `((:type :opening)
                                  (:object ,(plan:an object (type drawer) (name ?drawer)))
                                  ,@more)))

(defun closing-drawer (?drawer &rest more)
  (plan:make-designator :action `((:type :closing)
                                  (:object ,(plan:an object (type drawer) (name ?drawer)))
                                  ,@more)))

(defun items-height (projection name)
  (geometry:pose-z (projection:observed-pose projection name)))

(defun picked-up-and-placed (item poses x y z)
  "Pick up ITEM and place it at X, Y, Z; return true if that is done, how high it was lifted, and
how far (m) it is from there."
  (call-in-kitchen
   (lambda (projection)
     (let ((before (items-height projection item)))
       (perform-in projection (picking-up-item item))
       (let ((held (projection:held-item projection))
             (lifted (- (items-height projection item) before)))
         (perform-in projection (parking))
         (perform-in projection (placing-at x y z))
         (let ((pose (projection:observed-pose projection item)))
           (values (and (eq item held) (null (projection:held-item projection)))
                   lifted
                   (sqrt (+ (expt (- (geometry:pose-x pose) x) 2)
                            (expt (- (geometry:pose-y pose) y) 2)
                            (expt (- (geometry:pose-z pose) z) 2))))))))
   poses))

(defun check-picked-up-and-placed (item poses x y z)
  (multiple-value-bind (done lifted away) (picked-up-and-placed item poses x y z)
    (is-true done "~a: ~a" item lifted)
    (when done
      (is (nearly (projection:scene-parameter (manipulation-scene) :clearance) lifted 0.01)
          "~a is lifted by ~a m" item lifted)
      (is (< away 0.02) "~a is ~a m from its target" item away))))

(test each-item-is-picked-up-from-the-counter-and-placed-there
  (loop for (item y z to) in '((:milk 0.1 0.947 0.3) (:bowl -0.6 0.8835 -0.4)
                               (:cereal -0.2 0.962 -0.4))
        do (check-picked-up-and-placed item (standing-at -1.3 y pi) -2.1 to z)))

(test each-item-is-picked-up-from-the-table-and-placed-there
  (loop for (item height) in '((:milk 0.847) (:bowl 0.7835) (:cereal 0.862) (:spoon 0.7595))
        do (check-picked-up-and-placed item
                                       (standing-at -0.35 0 0 item
                                                    (geometry:make-pose 0.35 0.1 height))
                                       0.35 -0.1 height)))

;;; Drawers

(defun drawer-opened-and-closed (?drawer joint x y &rest options)
  "Open and close a drawer from X, Y; return how far it was open, how far the spoon went along, and
how far open it is at the end."
  (apply #'call-in-kitchen
         (lambda (projection)
           (let ((before (geometry:pose-x (projection:observed-pose projection :spoon))))
             (perform-in projection (opening-drawer ?drawer))
             (let ((open (projection:observed-joint projection joint))
                   (along (- (geometry:pose-x (projection:observed-pose projection :spoon))
                             before)))
               (perform-in projection (parking))
               (perform-in projection (closing-drawer ?drawer))
               (values open along (projection:observed-joint projection joint)))))
         (standing-at x y pi) options))

(test each-drawer-is-opened-and-closed
  "From where the robot stands it reaches the handle at either end of its way; the spoon is in the
second drawer and goes along."
  (loop for (drawer joint x y spoon) in '((:drawer-1 "drawer_1_joint" -1.1 -0.3 0)
                                          (:drawer-2 "drawer_2_joint" -1.1 0.3 0.4)
                                          (:drawer-3 "drawer_3_joint" -1.1 0.6 0))
        do (multiple-value-bind (open along closed) (drawer-opened-and-closed drawer joint x y)
             (is-true open "~a: ~a" drawer along)
             (when open
               (is (nearly 0.4 open 0.005) "~a is open by ~a m" drawer open)
               (is (nearly spoon along 0.01) "the spoon went along by ~a m" along)
               (is (nearly 0 closed 0.005) "~a is open by ~a m" drawer closed)))))

(test a-hand-gets-away-from-the-handle
  "Where the arm is folded so that no way leads from the handle to where it is parked, the hand goes
back first."
  (is (eq :parked
          (call-in-kitchen (lambda (projection)
                             (perform-in projection (opening-drawer :drawer-1 '(:arm :right)))
                             (perform-in projection (parking))
                             :parked)
                           (standing-at -1.1 -0.4 pi)))))

(test the-spoon-is-taken-out-of-the-drawer
  (multiple-value-bind (held height)
      (call-in-kitchen (lambda (projection)
                         (perform-in projection (opening-drawer :drawer-2))
                         (perform-in projection (parking))
                         (perform-in projection (picking-up-item :spoon))
                         (values (projection:held-item projection)
                                 (items-height projection :spoon)))
                       (standing-at -1.1 0.3 pi))
    (is (eq :spoon held) "~a" height)
    (is (and (realp height) (> height 0.69)))))

(test a-drawer-goes-as-far-as-it-is-asked-to
  (is (nearly 0.2 (or (call-in-kitchen
                       (lambda (projection)
                         (perform-in projection (opening-drawer :drawer-2 '(:distance 0.2)))
                         (projection:observed-joint projection "drawer_2_joint"))
                       (standing-at -1.1 0.3 pi))
                      0)
              0.005)))

;;; Failures

(defun failure-in-kitchen (poses &rest designators)
  "Return the name of the class of the plan failure, and the failure, that performing DESIGNATORS
one after the other signals."
  (multiple-value-bind (done failure)
      (call-in-kitchen (lambda (projection)
                         (dolist (designator designators t)
                           (perform-in projection designator)))
                       poses)
    (if done :none (values (type-of failure) failure))))

(defun moving-tool (x y z &rest more)
  (let ((?pose (geometry:make-pose x y z :yaw pi)))
    (plan:make-designator :motion `((:type :moving-tcp)
                                    (:left-target ,(plan:a location (pose ?pose)))
                                    ,@more))))

(test what-is-out-of-reach
  (is (eq 'plan:manipulation-pose-unreachable
          (failure-in-kitchen (standing-at -0.6 0 pi) (picking-up-item :milk))))
  (is (eq 'plan:environment-unreachable
          (failure-in-kitchen (standing-at -0.6 0 pi) (opening-drawer :drawer-2))))
  (is (eq 'plan:manipulation-pose-unreachable
          (failure-in-kitchen (standing-at -1.3 0 pi) (moving-tool -2.9 0 1))))
  (is (eq 'plan:manipulation-pose-unreachable
          (failure-in-kitchen (standing-at -1.3 0.1 pi) (picking-up-item :milk)
                              (placing-at 0.5 0 0.947)))))

(test what-is-in-the-way
  (is (eq 'plan:manipulation-goal-not-reached
          (failure-in-kitchen (standing-at -1.3 0.1 pi) (moving-tool -2.1 0 0.8)))
      "in the workspace")
  (is (eq :none (failure-in-kitchen (standing-at -1.3 0.1 pi)
                                    (moving-tool -1.85 -0.1 1.0))))
  (is (eq 'plan:manipulation-goal-not-reached
          (failure-in-kitchen (standing-at -1.1 0.3 pi)
                              (opening-drawer :drawer-2 '(:distance 0.35))
                              (opening-drawer :drawer-2 '(:distance 0.1))))
      "the drawer cannot be opened farther"))

(test what-grippers-fail-with
  (is (eq 'plan:gripper-closed-completely
          (failure-in-kitchen (standing-at -1.1 0 pi) (placing-at -2.1 0 0.947))))
  (is (eq 'plan:gripper-closed-completely
          (failure-in-kitchen (standing-at -1.1 0 pi)
                              (plan:make-designator :motion '((:type :gripping)
                                                              (:gripper :left))))))
  (let ((?pose (geometry:make-pose -2.1 0.4 0.947)))
    (is (eq 'plan:gripper-closed-completely
            (failure-in-kitchen (standing-at -1.3 0.3 pi)
                                (plan:an action (type picking-up)
                                         (object (plan:an object (name milk) (pose ?pose))))))
        "it is not where it was seen"))
  (is (eq 'plan:gripper-goal-not-reached
          (failure-in-kitchen (standing-at -1.3 0.1 pi)
                              (picking-up-item :milk '(:arm :left))
                              (picking-up-item :cereal '(:arm :left))))
      "the hand is full")
  (is (eq 'plan:gripper-goal-not-reached
          (failure-in-kitchen (standing-at -1.3 0.1 pi)
                              (picking-up-item :milk '(:arm :left))
                              (plan:make-designator :motion '((:type :moving-gripper-joint)
                                                              (:gripper :left)
                                                              (:joint-angle 0)))))
      "the milk is in between")
  (is (eq 'plan:perception-object-not-found
          (failure-in-kitchen (standing-at -1.3 0.1 pi) (picking-up-item :teapot)))))

(test plain-mistakes-are-not-understood
  (flet ((refused-p (class &rest properties)
           (handler-case
               (call-in-kitchen (lambda (projection)
                                  (perform-in projection
                                              (plan:make-designator class properties)))
                                (standing-at -1.1 0 pi))
             (plan:designator-not-understood () t))))
    (is-true (refused-p :motion '(:type :moving-tcp)))
    (is-true (refused-p :motion '(:type :moving-arm-joints) '(:left-configuration (1 2))))
    (is-true (refused-p :motion '(:type :moving-arm-joints) '(:left-configuration "ab")))
    (is-true (refused-p :motion '(:type :moving-tcp) '(:collision-mode :allow-everything)
                        (list :left-target (geometry:make-pose -1.85 -0.1 1))))
    (is-true (refused-p :motion '(:type :moving-gripper-joint) '(:gripper :left)))
    (is-true (refused-p :motion '(:type :gripping) '(:gripper :middle)))
    (is-true (refused-p :action '(:type :picking-up)))
    (is-true (refused-p :action '(:type :opening)
                        (list :object (plan:an object (type dishwasher)))))))

;;; Grips

(defun grip-of-milk (force)
  "Return the utilization of the grip on the milk at rest after it was lifted, or NIL and the
failure if it was lost, with FORCE (N) of each finger."
  (call-in-kitchen (lambda (projection)
                     (perform-in projection (picking-up-item :milk '(:arm :left)
                                                             (list :effort force)))
                     (projection::pass-time projection 60)
                     (bullet:attachment-utilization
                      (projection::grasp-attachment projection :left)))
                   (standing-at -1.3 0.1 pi)
                   :parameters (list :finger-friction 0.6) :fidelity :full))

(test a-grip-bears-what-the-limit-surface-says
  "The milk weighs 9.81 N and is held beside its centre: the grip bears m g of 2 mu N."
  (dolist (force '(15 25 50))
    (let ((expected (/ 9.81 (* 2 0.6 force))) (utilization (grip-of-milk force)))
      (is (and utilization (nearly expected utilization (* 0.03 expected)))
          "~a instead of ~a" utilization expected))))

(test a-grip-that-is-too-weak-loses-the-milk
  "8 N of each finger hold 9.6 N, and the milk weighs 9.81 N."
  (multiple-value-bind (utilization failure) (grip-of-milk 8)
    (is (null utilization))
    (is (typep failure 'plan:gripper-closed-completely)))
  (is-true (grip-of-milk 14)))
