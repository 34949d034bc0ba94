;;;; The packages of poses and of ROS: cl-transforms, cl-transforms-stamped, cl-tf, cram-tf,
;;;; roslisp, roslisp-utilities.
;;;;
;;;; CL-TRANSFORMS-STAMPED and CL-TF pass on all of CL-TRANSFORMS, so that a plan may take a vector
;;;; from any of them.

(in-package #:discrepancy-finder.cram-compat)

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defparameter *plain-names*
    '(#:3d-vector #:point #:make-3d-vector #:make-identity-vector #:copy-3d-vector #:x #:y #:z
      #:v+ #:v- #:v* #:v-inv #:v-norm #:v-dist #:dot-product #:cross-product #:normalize-vector
      #:quaternion #:make-quaternion #:make-identity-rotation #:copy-quaternion #:w
      #:q+ #:q- #:q* #:q-inv #:q-dot #:q-norm #:normalize #:normalize-quaternion #:rotate #:slerp
      #:angle-between-quaternions
      #:euler->quaternion #:quaternion->euler #:get-yaw
      #:axis-angle->quaternion #:quaternion->axis-angle
      #:matrix->quaternion #:quaternion->matrix #:column-vectors->quaternion
      #:normalize-angle #:shortest-angular-distance
      #:pose #:make-pose #:make-identity-pose #:copy-pose #:origin #:orientation
      #:transform #:make-transform #:make-identity-transform #:copy-transform
      #:translation #:rotation #:transform* #:transform-inv #:transform-point #:transform-pose
      #:pose->transform #:transform->pose #:reference-transform
      #:matrix->transform #:transform->matrix)
    "What cl-transforms exports.")

  (defparameter *stamped-names*
    '(#:stamped #:frame-id #:child-frame-id #:stamp
      #:pose-stamped #:make-pose-stamped #:copy-pose-stamped
      #:transform-stamped #:make-transform-stamped #:copy-transform-stamped
      #:point-stamped #:make-point-stamped #:copy-point-stamped
      #:vector-stamped #:make-vector-stamped #:copy-vector-stamped
      #:pose->pose-stamped #:point->point-stamped #:transform->transform-stamped
      #:pose->transform-stamped #:transform->pose-stamped
      #:pose-stamped->transform-stamped #:transform-stamped->pose-stamped
      #:lookup-transform #:transform-pose-stamped #:transform-point-stamped)
    "What cl-transforms-stamped exports beside."))

(macrolet ((define-geometry-packages ()
             `(progn
                (define-compat-package #:cl-transforms () "cl-transforms"
                  "Vectors, quaternions, poses and transforms."
                  (#:discrepancy-finder.transforms ,@*plain-names*))
                (define-compat-package #:cl-transforms-stamped () "cl-transforms-stamped"
                  "Poses and transforms in frames, and all of CL-TRANSFORMS."
                  (#:discrepancy-finder.transforms ,@*plain-names* ,@*stamped-names*))
                (define-compat-package #:cl-tf () "cl-tf"
                  "The same as CL-TRANSFORMS-STAMPED."
                  (#:discrepancy-finder.transforms ,@*plain-names* ,@*stamped-names*)))))
  (define-geometry-packages))

(define-compat-package #:cram-tf () "cram-tf"
  "The frames of the robot, and what plans do with poses."
  (#:discrepancy-finder.transforms
   #:*fixed-frame* #:*odom-frame* #:*robot-base-frame* #:*robot-torso-frame*
   #:*robot-left-tool-frame* #:*robot-right-tool-frame* #:*transformer* #:*tf-default-timeout*
   #:poses-equal-p #:values-converged
   #:pose->list #:list->pose #:pose->flat-list #:flat-list->pose #:3d-vector->list
   #:translate-pose #:rotate-pose #:rotate-pose-in-own-frame
   #:translate-transform-stamped #:rotate-transform-in-own-frame
   #:transform-stamped-inv #:strip-transform-stamped
   #:multiply-transform-stampeds #:apply-transform
   #:ensure-pose-in-frame #:ensure-point-in-frame
   #:frame-to-pose-in-fixed-frame #:robot-current-pose
   #:pose->transform-stamped #:transform->pose-stamped
   #:pose-stamped->transform-stamped #:transform-stamped->pose-stamped))

(define-compat-package #:roslisp () "roslisp"
  "Log lines and the clock."
  (#:discrepancy-finder.roslisp
   #:ros-debug #:ros-info #:ros-warn #:ros-error #:ros-fatal
   #:set-debug-level #:debug-level #:ros-time))

(define-compat-package #:roslisp-utilities () "roslisp-utilities"
  "Functions to be run at the start and at the end."
  (#:discrepancy-finder.roslisp
   #:register-ros-init-function #:register-ros-cleanup-function #:startup-ros #:shutdown-ros))
