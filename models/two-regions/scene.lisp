;;;; The scene of Example 1: a robot that drives along y = 0, a bench at y = 0.4 m, a box on it.
;;;;
;;;; This file is data: reading it evaluates nothing.  Lengths in m, masses in kg, times in s.

(define-scene two-regions
  "A robot base with a simple arm, and a box on a bench."
  (:parameters
   (reach 0.8 "horizontal distance from the shoulder within which things can be grasped, m")
   (base-speed 1.0 "m/s")
   (base-acceleration 1.0 "m/s^2")
   (joint-speed 1.0 "m/s or rad/s")
   (joint-acceleration 4.0 "m/s^2 or rad/s^2")
   (clearance 0.15 "height by which the gripper lifts what it holds, m"))
  (:fixture bench "bench.urdf" (:at 1 0.4 0))
  (:robot robot "robot.urdf" (:at 0.5 0 0)
          (:lift "lift_joint") (:shoulder "shoulder_joint") (:extension "arm_joint")
          (:gripper "gripper_link"))
  (:item box "box.urdf" (:at 1.5 0.4 0.46)))
