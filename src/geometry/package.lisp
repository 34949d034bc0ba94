(defpackage #:discrepancy-finder.geometry
  (:documentation "Poses in space: metres, radians, unit quaternions (x y z w), double floats.")
  (:use #:cl)
  (:export
   ;; poses
   #:pose #:pose-p #:make-pose #:quaternion-pose #:identity-pose
   #:pose-x #:pose-y #:pose-z #:pose-qx #:pose-qy #:pose-qz #:pose-qw
   #:pose-yaw #:pose-components #:components-pose
   ;; numbers
   #:decimal-double
   ;; algebra
   #:compose #:inverse #:rotate #:pose= #:planar-distance))
