(defpackage #:discrepancy-finder.plan-language
  (:documentation "CPL, the plan language of CRAM: plans, tasks, fluents, failures, designators,
perform.")
  (:use #:cl #:discrepancy-finder.geometry)
  (:local-nicknames (#:source #:discrepancy-finder.source)
                    (#:prolog #:discrepancy-finder.prolog)
                    (#:desig #:discrepancy-finder.designators))
  (:import-from #:discrepancy-finder.designators
                #:a #:an #:action #:motion #:location #:object #:human
                #:designator #:action-designator #:motion-designator #:location-designator
                #:object-designator #:human-designator
                #:make-designator #:designator-class-keyword #:properties
                #:desig-prop-value #:desig-prop-values #:with-desig-props
                #:equate #:current-desig #:first-desig #:desig-equal
                #:newest-effective-designator #:copy-designator #:merge-desig-descriptions
                #:reference #:next-solution #:designated-pose)
  (:export
   ;; plans and their sources
   #:def-cram-function #:def-top-level-cram-function #:def-plan
   #:plan #:plan-name #:plan-lambda-list #:plan-body #:plan-documentation #:plan-position
   #:plan-top-level-p #:find-plan #:current-plan-name #:plan-source #:plans-in-files
   #:plans-mentioned
   #:method-source #:load-plan #:*closure-evaluator* #:*plan-locator*
   #:ensure-top-level #:call-in-implicit-top-level
   ;; goals
   #:declare-goal #:def-goal #:succeed #:register-goal #:describe-goal
   ;; top-levels
   #:top-level #:named-top-level #:call-in-top-level #:*scheduling-seed* #:*idle-limit*
   #:*strand-limit*
   ;; one after the other, in parallel
   #:seq #:par #:par-loop #:pursue #:try-all #:try-in-order #:try-each-in-order
   #:partial-order #:mapcar-clean
   ;; tags
   #:with-tags #:task #:sub-task
   ;; policies
   #:policy #:make-policy #:define-policy #:with-policy #:with-policies #:with-named-policy
   #:with-named-policies #:timeout-policy #:policy-age
   ;; tasks
   #:current-task #:status #:result #:task-alive #:task-dead
   #:task-dead-p #:task-running-p #:task-done-p #:task-failed-p
   #:suspend #:wake-up #:evaporate #:with-task-suspended
   #:on-suspension #:retry-after-suspension #:without-scheduling #:with-scheduling
   #:define-task-variable #:call-in-task
   ;; the task tree, and what its paths consist of
   #:tagged #:goal #:?designator #:process-module
   #:with-task-tree-node #:task-path #:current-path #:get-top-level-task-tree
   #:task-tree-node #:task-tree-node-path #:task-tree-node-parent #:task-tree-node-children
   #:task-tree-node-code #:task-tree-node-parameters #:task-tree-node-task
   #:task-tree-node-result #:task-tree-node-status-fluent #:flatten-task-tree
   ;; fluents
   #:fluent #:value-fluent #:fluent-net #:fluentp #:fluent-name #:make-fluent
   #:value #:pulse #:pulsed #:wait-for #:whenever #:sleep*
   #:fl< #:fl> #:fl= #:fl+ #:fl- #:fl* #:fl/ #:fl-eq #:fl-eql #:fl-not #:fl-and #:fl-or
   #:fl-pulsed #:fl-funcall #:fl-apply #:fl-value-changed
   ;; time
   #:now #:clock-time #:let-time-pass #:virtual-clock #:executive-clock
   ;; failures
   #:fail #:on-fail #:*break-on-plan-failures* #:*debug-on-lisp-errors* #:rethrow
   #:with-failure-handling #:retry #:call-with-failure-handlers
   #:with-retry-counters #:do-retry #:get-counter #:reset-counter
   #:plan-failure #:simple-plan-failure
   #:composite-failure #:composite-failures
   #:common-lisp-error-envelope #:envelop-error
   #:policy-condition #:policy-not-found #:policy-not-found-name
   #:policy-failure #:policy-failure-policy #:policy-failure-parameters
   #:policy-init-failed #:policy-check-condition-met
   ;; failure classes of CRAM
   #:described-failure #:failure-description
   #:low-level-failure #:high-level-failure
   #:actionlib-action-timed-out
   #:manipulation-low-level-failure #:manipulation-goal-not-reached
   #:manipulation-pose-unreachable
   #:gripper-low-level-failure #:gripper-failure-action
   #:gripper-closed-completely #:gripper-goal-not-reached
   #:torso-low-level-failure #:torso-failure-torso
   #:torso-goal-unreachable #:torso-goal-not-reached
   #:navigation-low-level-failure #:navigation-failure-location
   #:navigation-pose-unreachable #:navigation-goal-not-reached
   #:perception-low-level-failure #:perception-object-not-found #:object-not-found-object
   #:ptu-low-level-failure #:ptu-failure-target #:ptu-goal-unreachable #:ptu-goal-not-reached
   #:navigation-high-level-failure
   #:navigation-goal-in-collision #:navigation-failure-pose-stamped
   #:looking-high-level-failure #:manipulation-goal-in-collision
   #:object-unreachable #:object-unreachable-object
   #:object-unfetchable #:object-unfetchable-object
   #:object-undeliverable #:object-undeliverable-object
   #:object-nowhere-to-be-found #:object-nowhere-to-be-found-object
   #:environment-unreachable #:environment-manipulation-impossible
   ;; designators
   #:a #:an #:action #:motion #:location #:object #:human
   #:designator #:action-designator #:motion-designator #:location-designator
   #:object-designator #:human-designator
   #:make-designator #:designator-class-keyword #:properties
   #:desig-prop-value #:desig-prop-values #:with-desig-props
   #:equate #:current-desig #:first-desig #:desig-equal
   #:newest-effective-designator #:copy-designator #:merge-desig-descriptions
   #:reference #:next-solution #:designated-pose
   ;; executive
   #:perform #:perform-with #:generic-perform #:plan-known-p #:*control-functions*
    #:call-plan-function
   #:call-with-executive #:with-executive #:current-executive #:choose-strand
   #:begin-turn #:ready-strands #:gives-way-p
   #:strand-number #:strand-task #:strand-evaporating-p #:task-parent #:task-strand #:branch-code
   #:perform-task-p #:all-needed-p
   #:leave-plan #:call-on-main #:current-handlers #:with-handlers
   #:try-reference-designator #:designator-reference-failure
   #:designator-reference-failure-result #:designator-goal-parsing-failure
   ;; process modules
   #:def-process-module #:with-process-modules-running #:pm-execute #:pm-execute-matching
   #:matching-process-module #:available-process-module #:projection-running
   #:get-running-process-modules
   #:process-module-not-running #:process-module-not-running-name
   ;; editors
   #:register-indentation
   ;; hooks, events and occasions
   #:hooks #:define-hook
   #:event #:on-event #:holds
   #:robot-state-changed #:object-perceived-event #:object-gripper-event
   #:object-attached #:object-detached #:container-handling-event
   #:container-opening-event #:container-closing-event
   #:object-location-changed #:object-updated #:object-removed
   #:event-object-designator #:event-perception-source #:event-object-name #:event-arm
   #:event-link #:event-other-object-name #:event-grasp #:event-not-loose
   #:event-joint-name #:event-side #:event-environment #:event-distance
   #:object-in-hand #:object-picked #:object-put #:object-placed-at #:loc #:looking-at
   #:arms-parked #:gripper-opened #:gripper-closed #:torso-at #:tool-frames-at
   #:container-state #:robot-loc
   ;; conditions
   #:plan-error #:nested-top-level #:not-in-top-level #:not-in-top-level-form
   #:plan-not-found #:plan-not-found-name #:plan-not-found-known
   #:designator-not-understood #:designator-not-understood-designator
   #:malformed-plan-form #:malformed-plan-form-form #:malformed-plan-form-expected
   #:malformed-plan-form-plan
   #:misplaced-retry #:misplaced-retry-form
   #:deadlock #:deadlock-waiting #:too-many-tasks #:too-many-tasks-task
   #:too-many-tasks-limit #:tasks-nested-too-deeply #:top-level-interrupted #:wait-for-nil
   #:fluent-not-settable #:fluent-not-settable-fluent
   #:task-left-by-jump #:task-left-by-jump-task #:task-not-found #:task-not-found-path
   #:process-module-not-found #:process-module-not-found-name
   #:no-goal-fits #:no-goal-fits-name #:no-goal-fits-arguments
   #:goal-already-reached #:goal-already-reached-designator #:goal-already-reached-goal))

(defpackage #:discrepancy-finder.cpl
  (:documentation "What a file of plans uses: all of Common Lisp, but with operators that know
fluents, and the plan language.  It corresponds to CRAM's package CPL.")
  (:use #:cl #:discrepancy-finder.plan-language)
  (:shadow #:< #:> #:+ #:- #:* #:/ #:= #:eq #:eql #:not #:sleep)
  (:export #:< #:> #:+ #:- #:* #:/ #:= #:eq #:eql #:not #:sleep))

;; It is used in the place of Common Lisp, hence passes on all of it.
(let ((package (find-package '#:discrepancy-finder.cpl)))
  (dolist (used '(#:cl #:discrepancy-finder.plan-language))
    (do-external-symbols (symbol used)
      (multiple-value-bind (visible status) (find-symbol (symbol-name symbol) package)
        (when (and (eq visible symbol) (eq status :inherited))
          (export (list symbol) package))))))

(defpackage #:discrepancy-finder-user
  (:documentation "The package in which plans and domains are read and in which users work.")
  (:use #:discrepancy-finder.cpl #:discrepancy-finder.geometry)
  (:import-from #:discrepancy-finder.prolog
                #:prolog #:def-fact-group #:<- #:lisp-fun #:lisp-pred #:lisp-type
                #:bound #:ground #:once #:cut #:== #:-> #:forall #:findall #:setof #:instance-of)
  (:import-from #:discrepancy-finder.designators
                #:desig-prop #:action-grounding #:motion-grounding #:location-grounding)
  (:local-nicknames (#:cpl #:discrepancy-finder.cpl)
                    (#:exe #:discrepancy-finder.plan-language)
                    (#:cpm #:discrepancy-finder.plan-language)
                    (#:coe #:discrepancy-finder.plan-language)
                    (#:cpoe #:discrepancy-finder.plan-language)
                    (#:common-fail #:discrepancy-finder.plan-language)
                    (#:desig #:discrepancy-finder.designators)
                    (#:prolog #:discrepancy-finder.prolog)
                    (#:cut #:discrepancy-finder.prolog)))
