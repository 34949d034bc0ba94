(defpackage #:discrepancy-finder.projection
  (:documentation "Projection: plans executed in a physical world.")
  (:use #:cl #:discrepancy-finder.geometry)
  (:local-nicknames (#:bullet #:discrepancy-finder.bullet)
                    (#:plan #:discrepancy-finder.plan-language)
                    (#:source #:discrepancy-finder.source)
                    (#:foreign #:discrepancy-finder.foreign))
  (:export
   ;; scenes
   #:load-scene #:scene #:scene-name #:scene-file #:scene-files #:scene-parameters #:scene-parameter
   #:scene-with-parameters #:normalized-parameters #:scene-body-pose #:check-movable
   #:scene-item-names #:scene-item-type
   #:scene-robot-name
   ;; URDF
   #:read-urdf #:urdf-model #:urdf-model-name #:urdf-link #:urdf-joint
   ;; projections
   #:projection #:make-projection #:close-projection #:with-projection #:projection-world
   #:projection-scene #:observed-pose #:held-item #:settle #:interpenetration #:state-hash
   #:simulated-seconds #:visible-part
   #:projection-robot #:projection-fixtures #:projection-items #:projection-joints
   #:projection-grasps #:projection-fidelity #:projection-parameter
   #:observed-joint #:held-items #:item-at-rest-p
   ;; pictures
   ;; manipulation
   ;; process modules
   #:execute-designator #:executes-p #:drive-base #:move-arm #:move-head
   ;; conditions
   #:projection-error #:scene-error #:scene-error-file #:scene-error-reason #:urdf-error
   #:unknown-parameter #:impossible-parameter #:unknown-body #:unknown-joint #:missing-robot-part))
