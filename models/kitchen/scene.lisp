;;;; The kitchen: a workspace over three drawers, a dining table 2 m away, a door sill between them.
;;;;
;;;; The room is 5 x 4 m; its middle is the origin.  The workspace stands at the wall x = -2.5 and
;;;; ends at x = -1.9; its top is at 0.85 m.  Drawer 1 is at y = -0.6, drawer 2 at y = 0, drawer 3
;;;; at y = 0.6; closed, a drawer is inside from x = -2.32 to x = -1.92, and its floor is at 0.6 m.
;;;; The table begins at x = 0.1; its top is at 0.75 m.
;;;;
;;;; What the numbers do (tests/projection/kitchen-effects.lisp):
;;;;   The sill shakes what the robot carries across it, at the end of an arm by up to 15 m/s^2.
;;;;   With the ranges of grip force and friction below, the milk (1 kg) is always lifted, and lost
;;;;   on the way to the table in 17 % of 300 carries, the bowl (0.45 kg) in 2 % of 200, the cereal
;;;;   (0.4 kg) in none of 300: 6 % in all.
;;;;   An open drawer blocks the places nearer than about x = -1.35 before it, up to 40 cm to both
;;;;   sides of its middle: 14 % of the ways along the workspace.
;;;;   A spoon in the middle of an open drawer is seen and reached by the left arm from x = -1.35 to
;;;;   x = -1.0, y from -0.1 to 0.5 m beside the drawer's middle.  Near the drawer's front it is
;;;;   hidden from afar, near its back it is out of reach from x = -1.05 on.
;;;;
;;;; This file is data: reading it evaluates nothing.  Lengths in m, angles in rad, times in s.

(define-scene kitchen
  "A household kitchen with a mobile manipulator, a bowl, cereal, milk and a spoon in a drawer."
  (:parameters
   (base-speed 1.0 "m/s")
   (base-acceleration 1.0 "m/s^2")
   (base-deceleration 2.5 "braking, m/s^2")
   (base-turn-speed 1.0 "rad/s")
   (joint-speed 1.0 "m/s or rad/s")
   (joint-acceleration 4.0 "m/s^2 or rad/s^2")
   (gripper-speed 0.1 "m/s")
   (pad-radius 0.012 "of the friction torque of the finger pads, m")
   (clearance 0.15 "height by which the gripper lifts what it holds, m")
   (camera-range 3.0 "distance up to which the camera sees, m")
   (camera-field-of-view 1.0 "from the left to the right side of the picture, rad")
   (camera-vertical-field-of-view 0.8 "from the lower to the upper side of the picture, rad")
   (visible-fraction 0.5 "part of an item's surface that must be seen to detect it, 0 to 1"))
  (:tolerances
   (grip-force 15 35 "of each finger, N")
   (finger-friction 0.4 0.6 "of the finger pads on what they hold")
   (base-stopping-error-x -0.01 0.01 "along the base's x axis, m")
   (base-stopping-error-y -0.01 0.01 "along the base's y axis, m")
   (base-stopping-error-yaw -0.02 0.02 "rad")
   (perception-error-x -0.005 0.005 "m")
   (perception-error-y -0.005 0.005 "m")
   (perception-error-z -0.002 0.002 "m"))
  (:materials
   (wood (:friction 0.6) (:restitution 0.1))
   (stone (:friction 0.6) (:restitution 0.1))
   (cardboard (:friction 0.7) (:restitution 0.1) (:rolling-friction 0.001))
   (ceramic (:friction 0.6) (:restitution 0.1) (:rolling-friction 0.001))
   (steel (:friction 0.5) (:restitution 0.1) (:rolling-friction 0.001)))
  (:fixture room "room.urdf" (:at 0 0 0))
  (:fixture sill "sill.urdf" (:at -0.6 0 0))
  (:fixture counter "counter.urdf" (:at -2.5 0 0) (:material stone))
  (:fixture table "table.urdf" (:at 0.5 0 0) (:material wood))
  (:robot robot "../robot/robot.urdf" (:at -1.1 0 0 3.14159)
          (:torso "torso_lift_joint")
          (:arm left
                (:joints "l_shoulder_pan_joint" "l_shoulder_lift_joint" "l_upper_arm_roll_joint"
                         "l_elbow_flex_joint" "l_forearm_roll_joint" "l_wrist_flex_joint"
                         "l_wrist_roll_joint")
                (:tool "l_tool_link")
                (:gripper "l_gripper_l_finger_joint")
                (:fingers "l_gripper_l_finger_link" "l_gripper_r_finger_link")
                (:parked 0.35 -0.35 0.61 -1.97 2.6 -1.98 2.25))
          (:arm right
                (:joints "r_shoulder_pan_joint" "r_shoulder_lift_joint" "r_upper_arm_roll_joint"
                         "r_elbow_flex_joint" "r_forearm_roll_joint" "r_wrist_flex_joint"
                         "r_wrist_roll_joint")
                (:tool "r_tool_link")
                (:gripper "r_gripper_l_finger_joint")
                (:fingers "r_gripper_l_finger_link" "r_gripper_r_finger_link")
                (:parked -0.35 -0.35 -0.61 -1.97 -2.6 -1.98 -2.25))
          (:head "head_pan_joint" "head_tilt_joint")
          (:camera "camera_link"))
  (:item bowl "bowl.urdf" (:at -2.1 -0.6 0.8835) (:material ceramic) (:grasps top))
  (:item cereal "cereal.urdf" (:at -2.1 -0.2 0.962) (:material cardboard))
  (:item milk "milk.urdf" (:at -2.1 0.1 0.947) (:material cardboard))
  (:item spoon "spoon.urdf" (:at -2.12 0 0.6095 1.5708) (:material steel)))
