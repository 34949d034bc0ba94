(defpackage #:discrepancy-finder
  (:documentation "Finds out where a Discrete Event Calculus model of a robot's world is wrong.")
  (:use #:cl)
  (:local-nicknames (#:ec #:discrepancy-finder.event-calculus)
                    (#:plan #:discrepancy-finder.plan-language)
                    (#:symbolic #:discrepancy-finder.symbolic-execution)
                    (#:projection #:discrepancy-finder.projection)
                    (#:discrepancy #:discrepancy-finder.discrepancy)
                    (#:source #:discrepancy-finder.source)
                    (#:foreign #:discrepancy-finder.foreign)
                    (#:z3 #:discrepancy-finder.z3)
                    (#:json #:discrepancy-finder.json)
                    (#:arguments #:command-line-arguments))
  (:import-from #:discrepancy-finder.event-calculus
                #:define-theory #:load-theory #:find-theory #:define-state-constraint
                #:load-e-theory #:read-e-theory #:save-e-theory #:write-e-theory
                #:make-reasoner #:close-reasoner #:with-reasoner #:extend-horizon
                #:theory #:model #:reasoner #:explanation #:finding
                #:models #:count-models #:model-fluents #:model-events #:model-literals
                #:model-number
                #:possible-p #:consistent-p #:entailed-p #:consequences #:abduce
                #:why #:why-impossible #:why-inconsistent #:explanation-core
                #:explanation-sentences #:explanation-axioms
                #:check-theory #:finding-severity #:finding-text #:finding-kind
                #:finding-subject #:finding-position
                #:event-calculus-error #:theory-error #:theory-not-found #:unknown-atom
                #:state-constraint-not-found #:no-horizon #:outside-horizon #:closed-reasoner
                #:e-file-error)
  (:import-from #:discrepancy-finder.plan-language
                #:load-plan #:plan-error #:plan-not-found #:malformed-plan-form
                #:designator-not-understood #:not-in-top-level #:nested-top-level #:deadlock)
  (:import-from #:discrepancy-finder.designators
                #:malformed-designator #:unknown-designator-key)
  (:import-from #:discrepancy-finder.symbolic-execution
                #:define-action #:region-of #:value-of #:truth-of #:make-domain
                #:coverage #:print-coverage #:write-coverage-html #:coverage-figures
                #:never-taken-outcomes #:never-exercised-axioms #:coverage-not-recorded
                #:exploration #:exploration-traces
                #:exploration-complete-p #:exploration-paths #:exploration-gaps
                #:exploration-statistics #:stop-exploring
                #:verification #:verification-verdict #:verification-counterexample
                #:verification-problem #:verification-bounds
                #:trace-initial-state #:trace-steps #:trace-final-state #:execution-trace
                #:plan-broke
                #:symbolic-execution-error #:unsupported-form #:nondeterministic-plan
                #:unknown-argument-type #:file-output-refused #:invalid-trace
                #:coverage-not-recorded #:domain-not-found #:action-problem)
  (:import-from #:discrepancy-finder.discrepancy
                #:define-abstraction #:load-domain #:domain
                #:find-discrepancies #:search-result #:result-status #:result-reason
                #:result-text #:result-discrepancy #:result-discrepancies #:result-traces
                #:result-simulations #:result-iterations #:result-exploration
                #:discrepancy #:discrepancy-text #:discrepancy-trace #:discrepancy-sample
                #:discrepancy-run #:discrepancy-judgement
                #:run-plan #:run #:run-step #:run-steps #:run-final-state #:run-hash
                #:result-json #:explain-discrepancy #:explanation-text
                #:refine-theory #:refinement-text
                #:save-discrepancy #:replay #:replay-status #:replay-verdict #:replay-text
                #:shrink-discrepancy #:shrinking #:shrinking-text #:shrinking-discrepancy
                #:shrinking-boundary
                #:candidate-edits #:edit #:edit-text #:edit-removes-p #:edit-contradicted
                #:edit-runs #:edited-domain
                #:refine-theory #:refinement-text #:refinement-domain #:refinement-status
                #:refinement-steps
                #:discrepancy-found #:discrepancy-found-discrepancy
                #:continue-search #:next-trace #:accept
                #:discrepancy-error #:abstraction-error #:sampling-error #:replay-error
                #:invalid-argument)
  (:import-from #:discrepancy-finder.report #:write-report)
  (:import-from #:discrepancy-finder.statistics
                #:invalid-confidence #:invalid-delta #:unknown-confidence-rule)
  (:import-from #:discrepancy-finder.projection
                #:load-scene #:read-urdf #:with-projection #:make-projection #:close-projection
                #:observed-pose #:observed-joint #:held-items #:item-at-rest-p
                #:simulated-seconds #:state-hash #:view-world #:viewing-pose
                #:watch-projection #:make-frame-recorder #:frame-observer #:finish-frames
                #:projection-error #:scene-error #:urdf-error #:unknown-parameter
                #:impossible-parameter #:unknown-body #:unknown-joint
                #:impossible-joint-position #:missing-robot-part #:picture-error)
  (:import-from #:discrepancy-finder.source #:source-error)
  (:import-from #:discrepancy-finder.z3
                #:z3-error #:solver-unknown #:retry-with-timeout #:treat-as-sat)
  (:export
   ;; theories, domains, plans
   #:define-theory #:load-theory #:find-theory #:define-state-constraint
   #:define-abstraction #:define-action #:region-of #:value-of #:truth-of #:load-domain
   #:make-domain #:domain #:load-plan
   ;; questions to theories
   #:load-e-theory #:read-e-theory #:save-e-theory #:write-e-theory
   #:make-reasoner #:close-reasoner #:with-reasoner #:extend-horizon
   #:theory #:model #:reasoner #:explanation #:finding
   #:models #:count-models #:model-fluents #:model-events #:model-literals #:model-number
   #:possible-p #:consistent-p #:entailed-p #:consequences #:abduce
   #:why #:why-impossible #:why-inconsistent #:explanation-core #:explanation-sentences
   #:explanation-axioms
   #:check-theory #:finding-severity #:finding-text #:finding-kind #:finding-subject
   #:finding-position
   ;; symbolic execution
   #:explore-plan #:exploration #:exploration-traces #:exploration-complete-p
   #:exploration-paths #:exploration-gaps #:exploration-statistics #:stop-exploring
   #:execution-trace #:trace-initial-state #:trace-steps #:trace-final-state
   #:coverage #:print-coverage #:write-coverage-html #:coverage-figures
   #:never-taken-outcomes #:never-exercised-axioms #:coverage-not-recorded
   #:verify-plan #:verification #:verification-verdict #:verification-counterexample
   #:verification-problem #:verification-bounds
   ;; projection
   #:load-scene #:read-urdf #:with-projection #:make-projection #:close-projection
   #:observed-pose #:observed-joint #:held-items #:item-at-rest-p #:simulated-seconds
   #:state-hash #:view-world #:viewing-pose
   #:watch-projection #:make-frame-recorder #:frame-observer #:finish-frames
   #:run-plan #:run #:run-step #:run-steps #:run-final-state #:run-hash
   ;; the search
   #:find-discrepancies #:search-result #:result-status #:result-reason #:result-text
   #:result-discrepancy #:result-discrepancies #:result-traces #:result-simulations
   #:result-iterations #:result-exploration
   #:discrepancy #:discrepancy-text #:discrepancy-trace #:discrepancy-sample #:discrepancy-run
   #:discrepancy-judgement
   #:save-discrepancy #:replay #:replay-status #:replay-verdict #:replay-text
   #:result-json #:write-report
   #:explain-discrepancy #:explanation-text #:refine-theory #:refinement-text
   #:shrink-discrepancy #:shrinking #:shrinking-text #:shrinking-discrepancy #:shrinking-boundary
   #:candidate-edits #:edit #:edit-text #:edit-removes-p #:edit-contradicted #:edit-runs
   #:edited-domain
   #:refine-theory #:refinement-text #:refinement-domain #:refinement-status #:refinement-steps
   ;; conditions and restarts
   #:discrepancy-found #:discrepancy-found-discrepancy #:continue-search #:next-trace #:accept
   #:event-calculus-error #:theory-error #:theory-not-found #:state-constraint-not-found
   #:unknown-atom #:no-horizon #:outside-horizon #:closed-reasoner #:e-file-error
   #:plan-error #:plan-not-found #:malformed-plan-form #:designator-not-understood
   #:not-in-top-level #:nested-top-level #:deadlock
   #:malformed-designator #:unknown-designator-key
   #:domain-not-found #:source-error #:scene-error #:urdf-error
   #:projection-error #:unknown-parameter #:impossible-parameter #:unknown-body #:unknown-joint
   #:impossible-joint-position #:missing-robot-part #:picture-error
   #:symbolic-execution-error #:plan-broke #:unsupported-form #:nondeterministic-plan
   #:unknown-argument-type #:file-output-refused #:invalid-trace #:coverage-not-recorded
   #:action-problem
   #:discrepancy-error #:abstraction-error #:sampling-error #:replay-error
   #:invalid-confidence #:invalid-delta #:unknown-confidence-rule #:invalid-argument
   #:z3-error #:solver-unknown #:retry-with-timeout #:treat-as-sat
   ;; the command line
   #:main #:demo #:version
   ;; the paper's evaluation
   #:table1))

(use-package '#:discrepancy-finder '#:discrepancy-finder-user)
