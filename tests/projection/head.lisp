;;;; Tests of the projection's head: looking.

(in-package #:discrepancy-finder.tests)

(def-suite perception :in all)
(in-suite perception)

(defun table-top-scene (&rest parameters)
  (projection:scene-with-parameters
   (discrepancy:domain-scene (discrepancy:ensure-domain :table-top)) parameters))

(defmacro with-table ((projection &key parameters poses) &body body)
  `(projection:with-projection (,projection (table-top-scene ,@parameters) :poses ,poses)
     ,@body))

(defun looking-at (x y z)
  (let ((?pose (geometry:make-pose x y z)))
    (plan:a motion (type looking) (pose ?pose))))

(defun detecting (?type)
  (plan:a motion (type detecting) (object (plan:an object (type ?type)))))

(defun robot-of (projection)
  (projection::projection-robot projection))

(defun head-position (projection)
  (list (projection::joint-position (robot-of projection) :pan)
        (projection::joint-position (robot-of projection) :tilt)))

(defun pointing-error (projection x y z)
  (projection::pointing-error (robot-of projection) (geometry:make-pose x y z)))

(defun detected-p (projection type)
  (handler-case (progn (perform-in projection (detecting type)) t)
    (plan:perception-object-not-found () nil)))

(defun poses-but-the-heads (projection)
  "Return the poses of all bodies but those of the head, as numbers."
  (loop for body in (bullet:world-bodies (projection:projection-world projection))
        unless (or (search "head" (bullet:body-name body))
                   (search "camera" (bullet:body-name body)))
          collect (geometry:pose-components (bullet:body-pose body))))

;;; Looking

(test looking-points-the-camera-at-the-target
  (with-table (projection)
    (bullet:step-world (projection:projection-world projection) 480)
    (let ((before (poses-but-the-heads projection)))
      (loop for (x y z) in '((0.4 0.8 0.8) (1.6 0.8 0.8) (-3 2 0) (0.4 5 1.42) (2 -0.5 1.5)
                             (0.4 0.6 0.1))
            do (let ((camera (perform-in projection (looking-at x y z))))
                 (is (< (pointing-error projection x y z) 1d-9))
                 (is (geometry:pose= camera (projection::camera-pose (robot-of projection))))))
      (is (equal before (poses-but-the-heads projection)) "nothing but the head moves"))))

(test looking-takes-the-time-of-the-profile
  (with-table (projection)
    (perform-in projection (looking-at 0.4 50 1.42))
    (let ((before (projection:simulated-seconds projection)))
      (perform-in projection (looking-at 50.4 0 1.42))
      (is (nearly (+ (/ pi 2) 1/4) (- (projection:simulated-seconds projection) before) 1/100)
          "a quarter turn with 4 rad/s^2 up to 1 rad/s and down again")
      (let ((after (projection:simulated-seconds projection)))
        (perform-in projection (looking-at 50.4 0 1.42))
        (is (= after (projection:simulated-seconds projection)) "it is there already")))))

(test going-and-looking-take-a-pose-or-a-target
  (let ((?goal (geometry:make-pose 1.6 0 0 :yaw 1.5)) (?look (geometry:make-pose 1.6 0.8 0.8)))
    (flet ((ends (going looking)
             (with-table (projection)
               (perform-in projection going)
               (perform-in projection looking)
               (projection:state-hash projection))))
      (is (= (ends (plan:a motion (type going) (pose ?goal))
                   (plan:a motion (type looking) (pose ?look)))
             (ends (plan:a motion (type going) (target (plan:a location (pose ?goal))))
                   (plan:a motion (type looking) (target (plan:a location (pose ?look))))))))))

(test looking-forward
  (with-table (projection)
    (perform-in projection (looking-at 1.6 0.8 0.8))
    (is (not (equal '(0d0 0d0) (head-position projection))))
    (perform-in projection (plan:a motion (type looking) (direction forward)))
    (is (equal '(0d0 0d0) (head-position projection)))))

(test looking-stops-at-the-limits-of-the-joints
  (with-table (projection)
    (flet ((looks-past (x y z)
             (signals-with (plan:ptu-goal-not-reached "rad past the target" "head_pan_joint"
                                                      "head_tilt_joint")
               (perform-in projection (looking-at x y z)))
             (is (> (pointing-error projection x y z) 0.1))))
      (looks-past 0.4 0.1 0)
      (is (nearly 1.2d0 (second (head-position projection)) 1d-12) "the tilt is as low as it gets")
      (is (nearly 0 (first (head-position projection)) 1d-3) "and the pan is where it should be")
      (looks-past 0.4 0.4 2.5)
      (is (nearly -0.6d0 (second (head-position projection)) 1d-12))
      (looks-past 0.4 -2 1.2)
      (is (nearly 2.8d0 (abs (first (head-position projection))) 1d-12)
          "it cannot look over its shoulder"))
    (perform-in projection (looking-at 0.4 0.8 0.8))
    (is (< (pointing-error projection 0.4 0.8 0.8) 1d-9) "and the head still moves")))

(test what-looking-does-not-understand
  (with-table (projection)
    (signals-with (plan:designator-not-understood "looking" "direction")
      (perform-in projection (plan:a motion (type looking))))
    (signals-with (plan:designator-not-understood "looking" "direction")
      (perform-in projection (plan:a motion (type looking) (direction sideways))))))

(test a-robot-without-a-head-is-named-by-its-scene
  (projection:with-projection (projection (two-regions-scene))
    (signals-with (projection:missing-robot-part "two-regions" "head")
      (perform-in projection (looking-at 0 1 1)))
    (signals-with (projection:missing-robot-part "two-regions" "camera")
      (perform-in projection (detecting :box)))
    (signals-with (projection:missing-robot-part "two-regions" "camera")
      (projection:visible-part projection :box))))

;;; Heads of other builds

(defun robot-text (first-axis second-axis camera-origin)
  "Return the URDF of the arm of models/table-top with another head."
  (let* ((text (uiop:read-file-string (root-file "models/table-top/robot.urdf")))
         (end (search "  <joint name=\"head_pan_joint\"" text)))
    (format nil "~a<joint name=\"head_pan_joint\" type=\"continuous\"><parent link=\"base_link\"/>
         <child link=\"head_pan_link\"/><origin xyz=\"0.02 0.01 1.12\" rpy=\"0 0.1 0\"/>
         <axis xyz=\"~a\"/></joint>
       <joint name=\"head_tilt_joint\" type=\"continuous\"><parent link=\"head_pan_link\"/>
         <child link=\"head_tilt_link\"/><origin xyz=\"0.03 0 0.05\"/><axis xyz=\"~a\"/></joint>
       <joint name=\"camera_joint\" type=\"fixed\"><parent link=\"head_tilt_link\"/>
         <child link=\"camera_link\"/><origin ~a/></joint></robot>"
            (subseq text 0 end) first-axis second-axis camera-origin)))

(defun scene-text (robot &key (more "")
                           (parameters "(camera-range 3) (camera-field-of-view 1)
                                        (camera-vertical-field-of-view 1) (visible-fraction 0.9)")
                           (head "(:head \"head_pan_joint\" \"head_tilt_joint\")")
                           (camera "(:camera \"camera_link\")"))
  (format nil "(define-scene s
     (:parameters (base-speed 1) (base-acceleration 1) (joint-speed 1) (joint-acceleration 1) ~a)
     (:robot robot ~s (:at 0 0 0) (:lift \"lift_joint\") (:shoulder \"shoulder_joint\")
             (:extension \"arm_joint\") (:gripper \"gripper_link\") ~a ~a) ~a)"
          parameters robot head camera more))

(test heads-of-any-build-point-at-the-target
  (loop for (first second origin)
          in '(("0 0 1" "0 1 0" "xyz=\"0.05 0.1 0.02\"")          ; the left one of two cameras
               ("0 0 -1" "0 -1 0" "xyz=\"0.05 0 0\"")
               ("0 1 0" "0 0 1" "xyz=\"0.05 -0.03 0.1\"")         ; the tilt below the pan
               ("0 0 1" "0 1 0" "xyz=\"0 0 0.1\" rpy=\"0.1 0.2 0.3\"")   ; a crooked camera
               ("0 0.1 1" "0.2 1 0" "xyz=\"0.05 0.1 0\""))        ; axes not at right angles
        do (with-file (robot (robot-text first second origin) "urdf")
             (with-file (file (scene-text robot))
               (projection:with-projection (projection (projection:load-scene file))
                 (loop for (x y z) in '((1 0 0.8) (1 1 0.8) (-1 0.5 1.5) (0.2 -2 0.3) (0.5 0 2)
                                        (-3 -0.1 1))
                       do (perform-in projection (looking-at x y z))
                          (is (< (pointing-error projection x y z) 1d-5))))))))

(test a-continuous-pan-takes-the-short-way
  (with-file (robot (robot-text "0 0 1" "0 1 0" "xyz=\"0 0 0\"") "urdf")
    (with-file (file (scene-text robot))
      (projection:with-projection (projection (projection:load-scene file))
        (perform-in projection (looking-at -2 0.5 1.2))
        (let ((pan (first (head-position projection))))
          (is (> pan 2))
          (perform-in projection (looking-at -2 -0.5 1.2))
          (is (< pan (first (head-position projection)) 4)))))))
