(defpackage #:discrepancy-finder.transforms
  (:documentation "Vectors, quaternions, poses and transforms under the names that CRAM's plans use:
those of cl-transforms, of cl-transforms-stamped and of cram-tf.  Metres, radians, double floats.")
  (:use #:cl)
  (:local-nicknames (#:geometry #:discrepancy-finder.geometry))
  (:export
   ;; vectors
   #:3d-vector #:point #:make-3d-vector #:make-identity-vector #:copy-3d-vector #:x #:y #:z
   #:v+ #:v- #:v* #:v-inv #:v-norm #:v-dist #:dot-product #:cross-product #:normalize-vector
   ;; quaternions
   #:quaternion #:make-quaternion #:make-identity-rotation #:copy-quaternion #:w
   #:q+ #:q- #:q* #:q-inv #:q-dot #:q-norm #:normalize #:normalize-quaternion #:rotate #:slerp
   #:angle-between-quaternions
   ;; rotations in other notations
   #:euler->quaternion #:quaternion->euler #:get-yaw
   #:axis-angle->quaternion #:quaternion->axis-angle
   #:matrix->quaternion #:quaternion->matrix #:column-vectors->quaternion
   #:normalize-angle #:shortest-angular-distance
   ;; poses and transforms
   #:pose #:make-pose #:make-identity-pose #:copy-pose #:origin #:orientation
   #:transform #:make-transform #:make-identity-transform #:copy-transform
   #:translation #:rotation #:transform* #:transform-inv #:transform-point #:transform-pose
   #:pose->transform #:transform->pose #:reference-transform
   #:matrix->transform #:transform->matrix
   ;; stamped
   #:stamped #:frame-id #:child-frame-id #:stamp
   #:pose-stamped #:make-pose-stamped #:copy-pose-stamped
   #:transform-stamped #:make-transform-stamped #:copy-transform-stamped
   #:point-stamped #:make-point-stamped #:copy-point-stamped
   #:vector-stamped #:make-vector-stamped #:copy-vector-stamped
   #:pose->pose-stamped #:point->point-stamped #:transform->transform-stamped
   #:pose->transform-stamped #:transform->pose-stamped
   #:pose-stamped->transform-stamped #:transform-stamped->pose-stamped
   ;; frames
   #:*fixed-frame* #:*odom-frame* #:*robot-base-frame* #:*robot-torso-frame*
   #:*robot-left-tool-frame* #:*robot-right-tool-frame*
   #:*transformer* #:*tf-default-timeout*
   #:frame-store #:make-frame-store #:frame-pose #:frame-names #:lookup-frame
   #:lookup-transform #:transform-pose-stamped #:transform-point-stamped
   ;; the geometry layer
   #:geometry-pose #:pose-from-geometry
   ;; cram-tf
   #:poses-equal-p #:values-converged
   #:pose->list #:list->pose #:pose->flat-list #:flat-list->pose #:3d-vector->list
   #:translate-pose #:rotate-pose #:rotate-pose-in-own-frame
   #:translate-transform-stamped #:rotate-transform-in-own-frame
   #:transform-stamped-inv #:strip-transform-stamped
   #:multiply-transform-stampeds #:apply-transform
   #:ensure-pose-in-frame #:ensure-point-in-frame
   #:frame-to-pose-in-fixed-frame #:robot-current-pose
   ;; conditions
   #:transforms-error
   #:unsuitable-value #:unsuitable-value-role #:unsuitable-value-expected
   #:unsuitable-value-value
   #:zero-length #:zero-length-kind
   #:unknown-frame #:unknown-frame-name #:unknown-frame-known
   #:frame-mismatch #:frame-mismatch-operation #:frame-mismatch-expected
   #:frame-mismatch-found))
