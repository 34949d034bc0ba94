;;;; The packages around the language: designators, executive, process modules, events, failures,
;;;; robots, objects, projection.

(in-package #:discrepancy-finder.cram-compat)

;; THE and SOME are words in nested descriptions and else those of COMMON-LISP: a package may use
;; CRAM-DESIGNATORS along with COMMON-LISP or CRAM-LANGUAGE.
(define-compat-package #:cram-designators (#:desig) "cram-designators"
  "Designators: descriptions of actions, motions, locations, objects and humans."
  (#:cl #:the #:some)
  (#:discrepancy-finder.designators
   #:a #:an #:all #:when #:action #:motion #:location #:object #:human
   #:designator #:action-designator #:motion-designator #:location-designator
   #:object-designator #:human-designator
   #:make-designator #:properties #:description #:quantifier #:parent #:successor #:effective
   #:timestamp #:data #:desig-prop-value #:desig-prop-values #:with-desig-props
   #:equate #:on-equate-designators #:current-desig #:first-desig #:desig-equal
   #:get-equal-designators #:newest-effective-designator
   #:copy-designator #:merge-desig-descriptions #:extend-designator-properties
   #:update-designator-properties #:make-effective-designator
   #:reference #:next-solution #:resolve-designator #:*default-role*
   #:object-designator-data #:object-identifier #:object-pose
   #:action-grounding #:motion-grounding #:location-grounding
   #:desig-prop #:desig-location-prop #:current-designator #:desig-solution #:desig-reference
   #:desig-solution-not-rejected #:designator-groundings
   #:designator? #:action-desig? #:motion-desig? #:loc-desig? #:obj-desig? #:human-desig?
   #:register-location-generator #:delete-location-generator-function
   #:enable-location-generator-function #:disable-location-generator-function
   #:list-location-generators
   #:register-location-validation-function #:delete-location-validation-function
   #:enable-location-validation-function #:disable-location-validation-function
   #:list-location-validation-functions #:validate-location-designator-solution
   #:*location-generator-max-retries* #:*print-location-validation-function-results*
   #:designator-error))

(define-compat-package #:cram-language-designator-support () "cram-language-designator-support"
  "Designators as variables of plans."
  (#:discrepancy-finder.designators #:with-designators))

(define-compat-package #:cram-designator-specification (#:spec) "cram-designator-specification"
  "Properties with types."
  (#:discrepancy-finder.designators #:property))

;; CRAM's symbol INSPECT is that of COMMON-LISP.
(define-compat-package #:cram-common-designators () "cram-common-designators"
  "The commands that motions are resolved to."
  (#:cl #:inspect)
  (#:discrepancy-finder.cram-compat
   #:move-base #:move-torso #:move-head #:detect #:move-gripper-joint #:move-tcp #:move-joints
   #:move-with-constraints))

(define-compat-package #:cram-executive (#:exe) "cram-executive"
  "Performing designators."
  (#:discrepancy-finder.plan-language
   #:perform #:generic-perform #:try-reference-designator
   #:designator-reference-failure #:designator-reference-failure-result
   #:designator-goal-parsing-failure))

(define-compat-package #:cram-process-modules (#:cpm) "cram-process-modules"
  "What executes motions."
  (#:discrepancy-finder.plan-language
   #:def-process-module #:with-process-modules-running #:pm-execute #:pm-execute-matching
   #:matching-process-module #:available-process-module #:projection-running
   #:get-running-process-modules))

(define-compat-package #:cram-occasions-events (#:coe #:occasions-events) "cram-occasions-events"
  "Telling and asking what is the case in the world."
  (#:discrepancy-finder.plan-language #:event #:on-event #:holds))

(define-compat-package #:cram-plan-occasions-events (#:cpoe) "cram-plan-occasions-events"
  "The events and occasions of plans."
  (#:discrepancy-finder.plan-language
   #:robot-state-changed #:object-perceived-event #:object-gripper-event
   #:object-attached #:object-detached #:container-handling-event
   #:container-opening-event #:container-closing-event
   #:object-location-changed #:object-updated #:object-removed
   #:event-object-designator #:event-perception-source #:event-object-name #:event-arm
   #:event-link #:event-other-object-name #:event-grasp #:event-not-loose
   #:event-joint-name #:event-side #:event-environment #:event-distance
   #:object-in-hand #:object-picked #:object-put #:object-placed-at #:loc #:looking-at
   #:arms-parked #:gripper-opened #:gripper-closed #:torso-at #:tool-frames-at
   #:container-state #:robot-loc))

(define-compat-package #:cram-common-failures (#:common-fail) "cram-common-failures"
  "The failures of plans and process modules."
  (#:discrepancy-finder.plan-language
   #:low-level-failure #:high-level-failure #:failure-description
   #:actionlib-action-timed-out
   #:manipulation-low-level-failure #:manipulation-goal-not-reached
   #:manipulation-pose-unreachable #:gripper-low-level-failure #:gripper-failure-action
   #:gripper-closed-completely #:gripper-goal-not-reached
   #:torso-low-level-failure #:torso-failure-torso #:torso-goal-unreachable
   #:torso-goal-not-reached
   #:navigation-low-level-failure #:navigation-failure-location #:navigation-pose-unreachable
   #:navigation-goal-not-reached
   #:perception-low-level-failure #:perception-object-not-found #:object-not-found-object
   #:ptu-low-level-failure #:ptu-failure-target #:ptu-goal-unreachable #:ptu-goal-not-reached
   #:navigation-high-level-failure #:navigation-goal-in-collision
   #:navigation-failure-pose-stamped #:looking-high-level-failure
   #:manipulation-goal-in-collision #:object-unreachable #:object-unreachable-object
   #:object-unfetchable #:object-unfetchable-object
   #:object-undeliverable #:object-undeliverable-object
   #:object-nowhere-to-be-found #:object-nowhere-to-be-found-object
   #:environment-unreachable #:environment-manipulation-impossible))

(define-compat-package #:cram-robot-interfaces () "cram-robot-interfaces"
  "Predicates about robots, for facts of plan files."
  (#:discrepancy-finder.cram-compat
   #:robot #:arm #:required-arms #:available-arms #:camera-frame #:tool-frame #:torso-frame
   #:base-frame #:arm-joints #:arm-links #:hand-links #:hand-link #:gripper-joint #:gripper-link
   #:end-effector-link #:robot-torso-link-joint #:robot-tool-frame #:robot-joint-states
   #:robot-pan-tilt-links #:robot-pan-tilt-joints #:reachability-designator
   #:designator-reach-pose #:visibility-designator))

(define-compat-package #:cram-object-interfaces (#:obj-int) "cram-object-interfaces"
  "How objects are grasped, for methods of plan files."
  (#:discrepancy-finder.cram-compat
   #:get-object-type-gripping-effort #:get-object-type-gripper-opening #:get-object-type-grasps
   #:get-object-grasping-poses #:get-object-pose #:get-object-transform))

(define-compat-package #:cram-projection (#:proj) "cram-projection"
  "Environments in which plans are projected."
  (#:discrepancy-finder.cram-compat
   #:define-projection-environment #:with-projection-environment #:*projection-environment*))
