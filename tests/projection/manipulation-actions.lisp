;;;; Tests of the projection layer: motions of arms and grippers, and CRAM's atomic actions.

(in-package #:discrepancy-finder.tests)

(in-suite manipulation-kitchen)

(defun tool-position (projection arm)
  "Return where the tool of ARM, :left or :right, is."
  (let ((pose (projection::tool-pose projection (projection::find-arm projection arm))))
    (list (geometry:pose-x pose) (geometry:pose-y pose) (geometry:pose-z pose))))

(defun near-position-p (expected position tolerance)
  (and (= (length expected) (length position))
       (every (lambda (a b) (nearly a b tolerance)) expected position)))

(defun performed-in-kitchen (type class &rest properties)
  (plan:make-designator class `((:type ,type) ,@properties)))

(test moving-both-tools
  (let ((?left (geometry:make-pose -1.8 -0.2 1.05 :yaw pi))
        (?right (geometry:make-pose -1.8 0.3 1.05 :yaw pi)))
    (destructuring-bind (&optional left right)
        (call-in-kitchen
         (lambda (projection)
           (perform-in projection
                       (performed-in-kitchen :moving-tcp :motion
                                  (list :left-target (plan:a location (pose ?left)))
                                  (list :right-target (plan:a location (pose ?right)))))
           (list (tool-position projection :left) (tool-position projection :right)))
         (standing-at -1.3 0.05 pi))
      (is (near-position-p '(-1.8 -0.2 1.05) left 1d-3))
      (is (near-position-p '(-1.8 0.3 1.05) right 1d-3)))))

(test moving-arm-joints
  (let ((goal '(0.5 0 0.5 -1.5 0 -1 0)))
    (is (near-position-p goal
                (call-in-kitchen
                 (lambda (projection)
                   (perform-in projection
                               (performed-in-kitchen :moving-arm-joints :motion
                                          (list :left-configuration goal)))
                   (projection::joints-of-arm projection (projection::find-arm projection :left)))
                 (standing-at -1 0 pi))
                1d-9)))
  (is (eq 'plan:manipulation-pose-unreachable
          (failure-in-kitchen (standing-at -1 0 pi)
                              (performed-in-kitchen :moving-arm-joints :motion
                                         '(:left-configuration (5 0 0 -1 0 -1 0)))))
      "beyond a limit"))

(test grippers-by-their-longer-names
  (dolist (class '(:motion :action))
    (is (equal '(0.045d0 0d0)
               (call-in-kitchen
                (lambda (projection)
                  (loop for type in '(:opening-gripper :closing-gripper)
                        do (perform-in projection
                                       (performed-in-kitchen type class '(:gripper :left)))
                        collect (projection:observed-joint projection
                                                           "l_gripper_l_finger_joint")))
                (standing-at -1 0 pi))))))

(test grippers-open-and-close
  (flet ((positions (&rest designators)
           (call-in-kitchen
            (lambda (projection)
              (loop for designator in designators
                    do (perform-in projection designator)
                    collect (projection:observed-joint projection "l_gripper_l_finger_joint")))
            (standing-at -1 0 pi))))
    (is (near-position-p '(0.045 0 0.02 0.045 0.01)
                (positions (performed-in-kitchen :opening :motion '(:gripper :left))
                           (performed-in-kitchen :closing :motion '(:gripper :left))
                           (performed-in-kitchen :moving-gripper-joint :motion '(:gripper :left)
                                      '(:joint-angle 0.02))
                           (performed-in-kitchen :opening :action '(:gripper (:left :right)))
                           (performed-in-kitchen :setting-gripper :action '(:gripper :left)
                                      '(:position 0.01)))
                1d-6)))
  (is (eq 'plan:gripper-goal-not-reached
          (failure-in-kitchen (standing-at -1 0 pi)
                              (performed-in-kitchen :setting-gripper :action '(:gripper :left)
                                         '(:position 0.2))))))

(defun milk-by-atomic-actions (projection)
  "Pick up the milk step by step, as CRAM's plan for picking up does; then let it go.  Return what
was held, and how high."
  (flet ((pose (x z) (geometry:make-pose x 0.1 z :yaw pi)))
    (let ((held nil) (height nil))
      (dolist (designator (list (performed-in-kitchen :opening :action '(:gripper :left))
                                (performed-in-kitchen :reaching :action
                                           (list :left-poses (list (pose -1.9 0.95)
                                                                   (pose -1.98 0.95))))
                                (performed-in-kitchen :grasping :action
                                           (list :left-poses (list (pose -2.09 0.95))))
                                (performed-in-kitchen :gripping :action '(:gripper :left))
                                (performed-in-kitchen :lifting :action
                                           (list :left-poses (list (pose -2.09 1.05))))))
        (perform-in projection designator))
      (setf held (projection:held-item projection)
            height (items-height projection :milk))
      (dolist (designator (list (performed-in-kitchen :putting :action
                                           (list :left-poses (list (pose -2.09 0.952))))
                                (performed-in-kitchen :releasing :action '(:gripper :left))
                                (performed-in-kitchen :retracting :action
                                           (list :left-poses (list (pose -1.95 0.952))))))
        (perform-in projection designator))
      (list held height (projection:held-item projection) (items-height projection :milk)))))

(test atomic-actions-pick-up-and-put-down
  (multiple-value-bind (result failure)
      (call-in-kitchen #'milk-by-atomic-actions (standing-at -1.3 0.2 pi))
    (is-true result "~a" failure)
    (destructuring-bind (&optional held (height 0) holding (after 0)) result
      (is (eq :milk held))
      (is (nearly 1.047 height 3d-3))
      (is (null holding))
      (is (nearly 0.947 after 2d-3)))))

(test a-motion-goes-through-positions-in-between
  "Half of a way with two pieces ends in the middle, all of it at the goal."
  (flet ((after (part)
           (call-in-kitchen
            (lambda (projection)
              (let* ((robot (projection::projection-robot projection))
                     (mechanism (projection::robot-mechanism robot))
                     (joints (projection::arm-joints (projection::find-arm projection :left)))
                     (middle (copy-seq (projection::joint-positions robot)))
                     (goal (copy-seq middle)))
                (loop for joint in (subseq joints 0 2)
                      do (incf (aref middle joint) 0.2d0)
                         (incf (aref goal joint) 0.3d0))
                (bullet:run-motion mechanism
                                   :steps 40 :through (list middle) :goal goal
                                   :fractions (coerce (loop for step from 1 to 40
                                                            collect (* part (/ step 40d0)))
                                                      '(simple-array double-float (*))))
                (let ((positions (nth-value 1 (bullet:mechanism-posture mechanism))))
                  (loop for joint in joints
                        collect (- (aref positions joint)
                                   (aref (projection::joint-positions robot) joint))))))
            (standing-at -1 0 pi))))
    (is (near-position-p '(0.2 0.2 0 0 0 0 0) (after 1/2) 1d-6))
    (is (near-position-p '(0.3 0.3 0 0 0 0 0) (after 1) 1d-6))
    (is (not (near-position-p '(0.1 0.1 0 0 0 0 0) (after 1/4) 1d-3)) "it is no straight way")))

(test both-fidelities-agree-on-what-is-carried
  "Picked up and put down, things end at the same place in both."
  (flet ((places (fidelity)
           (call-in-kitchen (lambda (projection)
                              (perform-in projection (picking-up-item :milk))
                              (perform-in projection (parking))
                              (perform-in projection (placing-at -2.1 0.3 0.947))
                              (let ((pose (projection:observed-pose projection :milk)))
                                (list (geometry:pose-x pose) (geometry:pose-y pose)
                                      (geometry:pose-z pose))))
                            (standing-at -1.3 0.1 pi) :fidelity fidelity)))
    (is (near-position-p (places :full) (places :fast) 1d-3))))
