(defpackage #:discrepancy-finder.roslisp
  (:documentation "What CRAM's plans use of roslisp and roslisp-utilities, without ROS: log lines, a
clock, functions to be run at start and end.")
  (:use #:cl)
  (:export
   ;; logging
   #:ros-debug #:ros-info #:ros-warn #:ros-error #:ros-fatal
   #:debug-level #:set-debug-level #:*debug-stream*
   #:ros-time #:*ros-clock*
   ;; roslisp-utilities
   #:register-ros-init-function #:register-ros-cleanup-function #:startup-ros #:shutdown-ros
   ;; conditions
   #:roslisp-error
   #:malformed-log-call #:malformed-log-call-form
   #:unknown-debug-level #:unknown-debug-level-level
   #:not-a-function #:not-a-function-value))
