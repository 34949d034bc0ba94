(defpackage #:discrepancy-finder.cram-compat
  (:documentation "CRAM's global packages, built on the plan language, where CRAM itself is absent:
what loads a file of plans that was written for CRAM.")
  (:use #:cl)
  (:local-nicknames (#:plan #:discrepancy-finder.plan-language)
                    (#:cpl #:discrepancy-finder.cpl)
                    (#:desig #:discrepancy-finder.designators)
                    (#:prolog #:discrepancy-finder.prolog)
                    (#:transforms #:discrepancy-finder.transforms)
                    (#:roslisp #:discrepancy-finder.roslisp)
                    (#:geometry #:discrepancy-finder.geometry))
  (:import-from #:discrepancy-finder.prolog
                #:def-fact-group #:<-)
  (:export
   ;; what was defined
   #:compat-report
   ;; the table of packages
   #:compat-packages #:compat-package #:compat-package-name #:compat-package-nicknames
   #:compat-package-system #:compat-package-symbols
   ;; predicates of cram-robot-interfaces
   #:robot #:arm #:required-arms #:available-arms #:camera-frame #:tool-frame #:torso-frame
   #:base-frame #:arm-joints #:arm-links #:hand-links #:hand-link #:gripper-joint #:gripper-link
   #:end-effector-link #:robot-torso-link-joint #:robot-tool-frame #:robot-joint-states
   #:robot-pan-tilt-links #:robot-pan-tilt-joints #:reachability-designator
   #:designator-reach-pose #:visibility-designator
   ;; commands of cram-common-designators
   #:move-base #:move-torso #:move-head #:detect #:move-gripper-joint #:move-tcp
   #:move-joints #:move-with-constraints
   ;; functions of cram-object-interfaces
   #:get-object-type-gripping-effort #:get-object-type-gripper-opening
   #:get-object-type-grasps #:get-object-grasping-poses
   #:get-object-pose #:get-object-transform
   ;; functions of cram-utilities
   #:equalize-two-list-lengths #:equalize-lists-of-lists-lengths
   ;; environments of cram-projection
   #:define-projection-environment #:with-projection-environment #:*projection-environment*
   #:unknown-projection-environment #:unknown-projection-environment-name))
