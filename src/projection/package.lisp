(defpackage #:discrepancy-finder.projection
  (:documentation "Projection: plans executed in a physical world.")
  (:use #:cl #:discrepancy-finder.geometry)
  (:local-nicknames (#:bullet #:discrepancy-finder.bullet)
                    (#:plan #:discrepancy-finder.plan-language)
                    (#:desig #:discrepancy-finder.designators)
                    (#:source #:discrepancy-finder.source)
                    (#:prolog #:discrepancy-finder.prolog)
                    (#:foreign #:discrepancy-finder.foreign))
  ;; What the plans in actions/ are written in.
  (:import-from #:discrepancy-finder.plan-language
                #:a #:an #:def-cram-function #:perform #:fail
                #:with-failure-handling #:retry #:with-retry-counters #:do-retry
                #:desig-prop-value #:next-solution #:failure-description
                #:gripper-low-level-failure #:looking-high-level-failure
                #:manipulation-low-level-failure #:manipulation-goal-not-reached
                #:manipulation-pose-unreachable
                #:navigation-goal-in-collision #:navigation-high-level-failure
                #:navigation-low-level-failure #:navigation-pose-unreachable
                #:object-nowhere-to-be-found #:object-undeliverable #:object-unfetchable
                #:object-unreachable #:perception-low-level-failure #:ptu-low-level-failure
                #:environment-manipulation-impossible #:environment-unreachable)
  (:import-from #:discrepancy-finder.designators #:designator-error)
  (:export
   ;; scenes
   #:load-scene #:scene #:scene-name #:scene-file #:scene-files #:scene-parameters #:scene-parameter
   #:scene-with-parameters #:scene-with-items #:normalized-parameters #:scene-body-pose
   #:check-movable
   #:scene-item-names #:scene-item-type #:scene-item-grasps #:scene-tolerances
   #:scene-open-tolerances
   #:scene-knows-p
   #:scene-robot-name #:scene-arm-names #:scene-joint #:scene-joint-limits
   ;; URDF
   #:read-urdf #:urdf-model #:urdf-model-name #:urdf-model-root #:urdf-model-links
   #:urdf-model-joints #:urdf-link #:urdf-joint
   ;; projections
   #:projection #:make-projection #:close-projection #:with-projection #:projection-world
   #:projection-scene #:observed-pose #:held-item #:settle #:interpenetration #:state-hash
   #:simulated-seconds #:visible-part
   #:projection-robot #:projection-fixtures #:projection-items #:projection-joints
   #:projection-grasps #:projection-fidelity #:projection-parameter
   #:observed-joint #:held-items #:item-at-rest-p
   #:fixture-joint #:fixture-link-body #:fixture-link-pose #:projection-observer
   #:run-joints #:run-path #:run-base #:run-motion #:pass-time #:move-torso
   #:base-pose-free-p #:plan-base-path
   ;; pictures
   #:view-world #:viewing-pose #:picture-error #:picture-error-reason
   #:watch-projection #:recorder #:make-frame-recorder #:frame-observer #:finish-frames
   #:abandon-frames
   #:outlines-from-above #:record-trail #:base-trail
   ;; manipulation
   ;; process modules
   #:execute-designator #:executes-p #:drive-base #:move-arm #:move-head
   ;; conditions
   #:projection-error #:scene-error #:scene-error-file #:scene-error-line #:scene-error-reason
   #:urdf-error #:urdf-error-file #:urdf-error-line #:urdf-error-reason
   #:unknown-parameter #:impossible-parameter #:unknown-body #:unknown-joint
   #:impossible-joint-position
   #:missing-robot-part))
