(in-package :ts-plans)

(def-fact-group ts-robot (cram-robot-interfaces:robot
                          cram-robot-interfaces:arm
                          cram-robot-interfaces:camera-frame)
  (<- (cram-robot-interfaces:robot :test-robot))

  (<- (cram-robot-interfaces:arm :test-robot :left))
  (<- (cram-robot-interfaces:arm :test-robot :right))

  (<- (cram-robot-interfaces:camera-frame :test-robot "camera_link")))

(defmethod obj-int:get-object-type-gripping-effort ((object-type t)) 20)
(defmethod obj-int:get-object-type-gripping-effort ((object-type (cl:eql :cup))) 35)

(defmethod obj-int:get-object-type-gripper-opening ((object-type t)) 0.1)

(defmethod obj-int:get-object-type-grasps (object-type arm object-transform-in-base)
  (declare (ignore arm object-transform-in-base))
  (if (eq object-type :bowl)
      '(:top)
      '(:front :top)))

(defmethod obj-int:get-object-grasping-poses (object-name object-type arm grasp object-transform)
  (declare (ignore object-name object-type arm))
  (let ((grasp-pose (cram-tf:strip-transform-stamped object-transform)))
    (list (cram-tf:translate-pose grasp-pose :z-offset (if (eq grasp :top) 0.2 0.1))
          (cram-tf:translate-pose grasp-pose :z-offset 0.1)
          grasp-pose
          (cram-tf:translate-pose grasp-pose :z-offset 0.15)
          (cram-tf:translate-pose grasp-pose :z-offset 0.3))))
