;;;; The scene of the search on a table: a robot that drives along y = 0, a table beyond y = 0.5 m,
;;;; two items on it.
;;;;
;;;; This file is data: reading it evaluates nothing.  Lengths in m, angles in rad, times in s.

(define-scene table-top
  "A robot with a head, and a box of cereal and a cup on a table."
  (:parameters
   (reach 0.9 "horizontal distance from the shoulder within which things can be grasped, m")
   (base-speed 1.0 "m/s")
   (base-acceleration 1.0 "m/s^2")
   (joint-speed 1.0 "m/s or rad/s")
   (joint-acceleration 4.0 "m/s^2 or rad/s^2")
   (clearance 0.15 "height by which the gripper lifts what it holds, m")
   (camera-range 3.0 "distance up to which the camera sees, m")
   (camera-field-of-view 1.4 "from the left to the right side of the picture, rad")
   (camera-vertical-field-of-view 0.9 "from the lower to the upper side of the picture, rad")
   (visible-fraction 0.9 "part of an item's surface that must be seen to detect it, 0 to 1"))
  (:fixture table "table.urdf" (:at 1 0.85 0))
  (:robot robot "robot.urdf" (:at 0.4 0 0 1.5708)
          (:lift "lift_joint") (:shoulder "shoulder_joint") (:extension "arm_joint")
          (:gripper "gripper_link")
          (:head "head_pan_joint" "head_tilt_joint") (:camera "camera_link"))
  (:item cereal "cereal.urdf" (:at 0.4 0.65 0.862))
  (:item cup "cup.urdf" (:at 0.6 1 0.8)))
