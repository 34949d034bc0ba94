(defpackage #:discrepancy-finder.plan-language
  (:documentation "CPL, the plan language of CRAM: plans, failures, designators, perform.")
  (:use #:cl #:discrepancy-finder.geometry)
  (:local-nicknames (#:source #:discrepancy-finder.source))
  (:export
   ;; plans and their sources
   #:def-cram-function #:def-top-level-cram-function #:top-level #:seq
   #:plan #:plan-name #:plan-lambda-list #:plan-body #:plan-documentation #:plan-position
   #:plan-top-level-p #:find-plan #:plan-source #:load-plan
   ;; failures
   #:fail #:with-failure-handling #:retry #:call-with-failure-handlers
   #:with-retry-counters #:do-retry #:get-counter #:reset-counter
   #:plan-failure #:simple-plan-failure
   #:low-level-failure #:low-level-failure-description
   #:manipulation-low-level-failure #:manipulation-goal-not-reached
   #:manipulation-pose-unreachable
   #:gripper-low-level-failure #:gripper-closed-completely #:gripper-goal-not-reached
   #:navigation-low-level-failure #:navigation-pose-unreachable #:navigation-goal-not-reached
   #:perception-low-level-failure #:perception-object-not-found
   ;; designators
   #:a #:an
   #:designator #:action-designator #:motion-designator #:object-designator
   #:location-designator #:make-designator #:designator-class-keyword
   #:properties #:desig-prop-value #:desig-prop-values #:designated-pose
   #:action #:motion #:object #:location
   ;; executive
   #:perform #:perform-with #:call-with-executive #:with-executive
   #:current-handlers #:with-handlers
   ;; conditions
   #:plan-error #:nested-top-level #:plan-not-found #:plan-not-found-name #:no-executive
   #:designator-not-understood #:designator-not-understood-designator
   #:malformed-plan-form))

(defpackage #:discrepancy-finder-user
  (:documentation "The package in which plans and domains are read and in which users work.")
  (:use #:cl #:discrepancy-finder.geometry #:discrepancy-finder.plan-language)
  (:local-nicknames (#:cpl #:discrepancy-finder.plan-language)
                    (#:exe #:discrepancy-finder.plan-language)
                    (#:desig #:discrepancy-finder.plan-language)
                    (#:common-fail #:discrepancy-finder.plan-language)))
