(in-package #:discrepancy-finder.tests)

(def-suite projection :in all)
(in-suite projection)

(defun two-regions-scene (&rest parameters)
  (projection:scene-with-parameters (discrepancy:domain-scene (two-regions)) parameters))

(defun perform-in (projection designator)
  (plan:with-executive (projection)
    (plan:top-level (plan:perform designator))))

(defun going-to (x &optional (y 0) (yaw 0))
  (let ((?pose (geometry:make-pose x y 0 :yaw yaw)))
    (plan:a motion (type going) (pose ?pose))))

(defun placing-at (x y z)
  (let ((?pose (geometry:make-pose x y z)))
    (plan:an action (type placing) (target (plan:a location (pose ?pose))))))

(defun picking-up-the-box ()
  (plan:an action (type picking-up) (object (plan:an object (type box)))))

(defun box-pose (projection)
  (projection:observed-pose projection :box))

(test the-scene-is-as-described
  (let ((scene (two-regions-scene)))
    (is (equal '(:box) (projection:scene-item-names scene)))
    (is (eq :robot (projection:scene-robot-name scene)))
    (is (= 0.8d0 (projection:scene-parameter scene :reach)))
    (is (= 0.5d0 (projection:scene-parameter (two-regions-scene :reach 0.5) :reach)))
    (is (= 0.5d0 (projection:scene-parameter
                  (projection:scene-with-parameters scene '(reach 0.5)) :reach))
        "names of any package")
    (signals-with (projection:unknown-parameter "two-regions" "reech" "reach")
      (two-regions-scene :reech 1))
    (dolist (value '(0 -1 far nil))
      (signals-with (projection:impossible-parameter "base-speed" "positive")
        (two-regions-scene :base-speed value)))
    (signals projection:impossible-parameter
      (projection:scene-with-parameters scene '(:reach)))))

(test a-settled-world-keeps-its-items-where-they-are
  (projection:with-projection (projection (two-regions-scene))
    (is-true (projection:settle projection))
    (is (nearly 1.5d0 (geometry:pose-x (box-pose projection)) 1d-4))
    (is (nearly 0.46d0 (geometry:pose-z (box-pose projection)) 1d-3))
    (is (< (projection:interpenetration projection) 1d-3))))

(test going
  "The base ends exactly at its goal, after the time of a trapezoidal profile."
  (projection:with-projection (projection (two-regions-scene))
    (perform-in projection (going-to 1.5))
    (is (geometry:pose= (geometry:make-pose 1.5 0 0)
                        (projection:observed-pose projection :robot)))
    (is (nearly 2 (projection:simulated-seconds projection) 1/100)
        "1 m with 1 m/s^2 up to 1 m/s and down again")))

(test a-goal-in-a-fixture-is-refused
  (projection:with-projection (projection (two-regions-scene))
    (let ((before (projection:observed-pose projection :robot)))
      (signals plan:navigation-pose-unreachable
        (perform-in projection (going-to 0.5 0.4)))
      (is (geometry:pose= before (projection:observed-pose projection :robot)))
      (is (zerop (projection:simulated-seconds projection))))))

(test driving-into-a-fixture-stops-the-base
  "The base is 0.2 m deep, the bench begins at 0.25 m, and nothing is touched."
  (dolist (fidelity '(:fast :full))
    (projection:with-projection (projection (two-regions-scene) :fidelity fidelity)
      (multiple-value-bind (reason bodies)
          (projection::run-base projection '((0.5d0 0d0 0d0) (0.5d0 0.4d0 0d0)))
        (is (eq :contact reason))
        (is (search "bench" (bullet:body-name (second bodies)))))
      (let ((y (geometry:pose-y (projection:observed-pose projection :robot))))
        (is (< 0.04 y 0.05) "it stops at ~a" y))
      (is (zerop (projection::fixture-contact projection))))))

(test picking-up-carrying-and-placing
  (projection:with-projection (projection (two-regions-scene))
    (projection:settle projection)
    (perform-in projection (going-to 1.5))
    (perform-in projection (picking-up-the-box))
    (is (eq :box (projection:held-item projection)))
    (is (> (geometry:pose-z (box-pose projection)) 0.55) "it is lifted")
    (let ((before (geometry:planar-distance (box-pose projection)
                                            (projection:observed-pose projection :robot))))
      (perform-in projection (going-to 0.5))
      (is (nearly before (geometry:planar-distance (box-pose projection)
                                                   (projection:observed-pose projection :robot))
                  5d-3)
          "a carried box moves with the robot"))
    (perform-in projection (placing-at 0.5 0.4 0.46))
    (is (null (projection:held-item projection)))
    (is (nearly 0.5 (geometry:pose-x (box-pose projection)) 5d-3))
    (is (nearly 0.4 (geometry:pose-y (box-pose projection)) 5d-3))
    (is (nearly 0.46 (geometry:pose-z (box-pose projection)) 1d-3) "it rests on the bench")))

(test the-top-of-an-item-is-found-however-it-lies
  (flet ((extent (shape &rest angles)
           (projection::upper-extent shape (apply #'geometry:make-pose 1 2 3 angles))))
    (let ((box '(:box 0.06d0 0.08d0 0.12d0)) (can '(:cylinder 0.05d0 0.2d0)) (half (/ pi 2)))
      (is (nearly 0.06 (extent box) 1d-7))
      (is (nearly 0.06 (extent box :yaw 1) 1d-7))
      (is (nearly 0.04 (extent box :roll half) 1d-7))
      (is (nearly 0.03 (extent box :pitch half) 1d-7))
      (is (nearly (/ (+ 0.06 0.12) 2 (sqrt 2d0)) (extent box :pitch (/ pi 4)) 1d-7))
      (is (nearly 0.1 (extent can) 1d-7))
      (is (nearly 0.05 (extent can :roll half) 1d-7))
      (let ((pair (list :compound (list (geometry:make-pose 0 0 -0.2) box)
                        (list (geometry:make-pose 0.3 0 0) '(:sphere 0.01d0)))))
        (is (nearly 0.01 (extent pair) 1d-7))
        (is (nearly 0.31 (extent pair :pitch (- half)) 1d-7))))))

(test a-box-that-lies-is-grasped-at-its-top
  (projection:with-projection (projection (two-regions-scene)
                                          :poses (list :box (geometry:make-pose
                                                             1.5 0.4 0.43 :pitch (/ pi 2))))
    (projection:settle projection)
    (perform-in projection (going-to 1.5))
    (perform-in projection (picking-up-the-box))
    (perform-in projection (going-to 0.5))
    (perform-in projection (placing-at 0.5 0.4 0.43))
    (is (nearly 0.43 (geometry:pose-z (box-pose projection)) 1d-3))
    (is (nearly 0.5 (geometry:pose-x (box-pose projection)) 5d-3))))

(test a-box-placed-in-the-air-falls
  "Nothing holds a released box but what is below it."
  (projection:with-projection (projection (two-regions-scene))
    (projection:settle projection)
    (perform-in projection (going-to 1.5))
    (perform-in projection (picking-up-the-box))
    (perform-in projection (going-to 0.5))
    (perform-in projection (placing-at 0.5 0.4 0.65))
    (is (< (geometry:pose-z (box-pose projection)) 0.47))))

(test reach-is-a-distance-from-the-shoulder
  "Just inside of the reach the box is grasped, just outside it is not."
  (flet ((distance-of-the-box (x)
           (sqrt (+ (expt (- x 1.5) 2) 0.16)))
         (picked-up-p (x reach)
           (projection:with-projection
               (projection (two-regions-scene :reach reach)
                           :poses (list :robot (geometry:make-pose 1.5 0 0)
                                        :box (geometry:make-pose x 0.4 0.46)))
             (projection:settle projection)
             (handler-case (progn (perform-in projection (picking-up-the-box)) t)
               (plan:manipulation-pose-unreachable () nil)))))
    (dolist (x '(1.1 1.4 1.6 1.9))
      (is-true (picked-up-p x (+ (distance-of-the-box x) 1d-3)))
      (is-false (picked-up-p x (- (distance-of-the-box x) 1d-3))))))

(test failures-of-manipulation
  (projection:with-projection (projection (two-regions-scene))
    (signals plan:gripper-closed-completely (perform-in projection (placing-at 0.5 0.4 0.46)))
    (signals plan:perception-object-not-found
      (perform-in projection (plan:an action (type picking-up)
                                      (object (plan:an object (type teapot))))))
    (signals plan:designator-not-understood (perform-in projection (plan:a motion (type flying))))
    (signals plan:designator-not-understood (perform-in projection (plan:a motion (type going))))
    (perform-in projection (going-to 1.5))
    (perform-in projection (picking-up-the-box))
    (signals plan:gripper-goal-not-reached (perform-in projection (picking-up-the-box)))
    (signals plan:manipulation-pose-unreachable (perform-in projection (placing-at 0.5 0.4 0.46)))))

(test the-same-actions-give-the-same-bits
  (flet ((hash ()
           (projection:with-projection (projection (two-regions-scene))
             (projection:settle projection)
             (perform-in projection (going-to 1.4 0 0.05))
             (perform-in projection (picking-up-the-box))
             (projection:state-hash projection))))
    (let ((hash (hash)))
      (is (= hash (hash)))
      (is (= hash (sb-thread:join-thread (sb-thread:make-thread #'hash)))))))

;;; URDF

(defun urdf-with (text)
  (format nil "<robot name=\"r\">~a</robot>" text))

(defmacro urdf-problem-of (text &rest parts)
  `(with-file (file ,text "urdf")
     (signals-with (projection:urdf-error file ,@parts) (projection:read-urdf file))))

(test urdf-models
  (with-file (file (urdf-with "<link name=\"a\"><collision><origin xyz=\"0 0 1\" rpy=\"0 0 0\"/>
      <geometry><box size=\"1 2 3\"/></geometry></collision>
      <collision><geometry><sphere radius=\".5\"/></geometry></collision></link>
    <link name=\"b\"><inertial><mass value=\"2\"/></inertial></link>
    <joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>
      <axis xyz=\"0 0 2\"/><limit lower=\"-1\" upper=\"1.5\"/></joint>") "urdf")
    (let* ((model (projection:read-urdf file))
           (joint (first (projection::urdf-model-joints model))))
      (is (string= "a" (projection::urdf-model-root model)))
      (is (eq :compound (first (projection::urdf-link-shape
                                (first (projection::urdf-model-links model))))))
      (is (equal '(0d0 0d0 1d0) (projection::urdf-joint-axis joint)) "axes are normalized")
      (is (equal '(-1d0 1.5d0) (list (projection::urdf-joint-lower joint)
                                     (projection::urdf-joint-upper joint))))
      (is (= 2d0 (projection::urdf-link-mass (second (projection::urdf-model-links model))))))))

(test what-is-wrong-in-a-urdf-file-is-named
  (signals-with (projection:urdf-error "no/such.urdf" "no such file")
    (projection:read-urdf "no/such.urdf"))
  (urdf-problem-of "<robot name=\"r\"><link" "not well-formed XML")
  (urdf-problem-of "<sdf/>" "not <robot>")
  (urdf-problem-of (urdf-with "") ":1: " "no link")
  (urdf-problem-of (urdf-with "<link/>") "a link" "no attribute name")
  (urdf-problem-of (urdf-with "<link name=\"a\"><collision><geometry><capsule radius=\"1\"/>
                               </geometry></collision></link>") "link a" "<capsule>" "box")
  (urdf-problem-of (urdf-with "<link name=\"a\"><collision><geometry><box size=\"1 2\"/>
                               </geometry></collision></link>") "link a" "3 numbers")
  (urdf-problem-of (urdf-with "<link name=\"a\"><collision><geometry><sphere radius=\"#.1\"/>
                               </geometry></collision></link>") "link a" "no number")
  (urdf-problem-of (urdf-with "<link name=\"a\"/><link name=\"b\"/>
    <joint name=\"j\" type=\"floating\"><parent link=\"a\"/><child link=\"b\"/></joint>")
                   "joint j" "floating")
  (urdf-problem-of (urdf-with "<link name=\"a\"/><link name=\"b\"/>
    <joint name=\"j\" type=\"prismatic\"><parent link=\"a\"/><child link=\"b\"/></joint>")
                   "joint j" "limit")
  (urdf-problem-of (urdf-with "<link name=\"a\"><collision><geometry><box size=\"1 -2 3\"/>
                               </geometry></collision></link>") "link a" "size of -2")
  (urdf-problem-of (urdf-with "<link name=\"a\"><collision><geometry><sphere radius=\"1\"/>
                               <sphere radius=\"2\"/></geometry></collision></link>")
                   "link a" "several shapes")
  (urdf-problem-of (urdf-with "<link name=\"a\"/><link name=\"b\"/>
    <joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>
      <limit lower=\"1\" upper=\"0\"/></joint>") "joint j" "above the upper")
  (urdf-problem-of (urdf-with "<link name=\"a\"/>
    <joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/></joint>")
                   "joint j" "no link c"))

;;; Scene files

(defmacro scene-problem-of (text &rest parts)
  `(with-file (file ,text)
     (signals-with (error file ,@parts) (projection:load-scene file))))

(test what-is-wrong-in-a-scene-file-is-named
  (with-file (file "(define-scene s (:item box \"nothing.urdf\" (:at 0 0 0)))")
    (signals-with (projection:scene-error file ":1: " "nothing.urdf" "no such file")
      (projection:load-scene file)))
  (let ((box (root-file "models/two-regions/box.urdf")))
    (scene-problem-of "(define-scene s (:item box #.(print 1)))" ":1: " "#.")
    (scene-problem-of "" "define-scene")
    (scene-problem-of "(print 1)" "define-scene")
    (scene-problem-of (format nil "(define-scene s~% (:thing))") ":2: " ":thing")
    (scene-problem-of "(define-scene s (:item box))" "name \"file.urdf\"")
    (scene-problem-of (format nil "(define-scene s (:item box ~s))" box) ":item box" ":at")
    (scene-problem-of (format nil "(define-scene s (:item box ~s (:at 0 0)))" box) "(:at x y z")
    (scene-problem-of (format nil "(define-scene s (:item box ~s (:at 0 0 1)) ~
                                   (:item box ~:*~s (:at 1 0 1)))" box) "same name")
    (scene-problem-of "(define-scene s (:parameters (reach far)))" "name positive-number")
    (scene-problem-of (format nil "(define-scene s (:robot r ~s (:at 0 0 0) (:lift \"a\") ~
                                   (:shoulder \"b\") (:extension \"c\") (:gripper \"d\")))" box)
                      ":lift" "no such joint")
    (scene-problem-of (format nil "(define-scene s (:robot r ~s (:at 0 0 0) (:lift \"arm_joint\") ~
                                   (:shoulder \"lift_joint\") (:extension \"arm_joint\") ~
                                   (:gripper \"gripper_link\")))"
                              (root-file "models/two-regions/robot.urdf"))
                      ":shoulder" "not revolute")
    (scene-problem-of "(define-scene s (:parameters (reach 0)))" "positive")
    (scene-problem-of "(define-scene s (:parameters (reach 1) (reach 2)))" "same name")
    (scene-problem-of "(define-scene s (:parameters (reach 1 . 2)))" ":1: " "a dot")
    (scene-problem-of "(define-scene s #1=(:parameters . #1#))" "#=")))
