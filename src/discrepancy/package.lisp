(defpackage #:discrepancy-finder.discrepancy
  (:documentation "Where theory and projection meet: abstraction, sampling, confidence, comparison,
search, replay.")
  (:use #:cl #:discrepancy-finder.geometry #:discrepancy-finder.statistics)
  (:local-nicknames (#:z3 #:discrepancy-finder.z3)
                    (#:ec #:discrepancy-finder.event-calculus)
                    (#:plan #:discrepancy-finder.plan-language)
                    (#:symbolic #:discrepancy-finder.symbolic-execution)
                    (#:projection #:discrepancy-finder.projection)
                    (#:source #:discrepancy-finder.source)
                    (#:desig #:discrepancy-finder.designators)
                    (#:json #:discrepancy-finder.json)
                    (#:foreign #:discrepancy-finder.foreign))
  (:import-from #:discrepancy-finder.symbolic-execution #:next-trace)
  (:export
   ;; domains: theory, scene, abstraction, action bindings
   #:define-abstraction #:domain #:domain-scene #:domain-file #:domain-regions
   #:domain-with-parameters #:load-domain
   #:region #:region-name #:region-description #:region-bounds #:inside-region-p
   #:discrete-state #:observed-fluents
   ;; random numbers
   #:philox #:content-hash #:unit-float #:unit-point #:*samplers*
   ;; samples
   #:parameter #:parameter-name #:parameter-min #:parameter-max
   #:parameter-body #:parameter-axis #:tolerance-p
   #:initial-parameters #:final-parameters #:draw-sample
   #:sample #:sample-index #:sample-values #:sample-text #:sample-tolerances
   ;; runs and their judgement
   #:make-meter #:with-meter #:meter-simulations
   #:execute-sample #:run-plan #:run #:run-steps #:run-initial-state #:run-final-state #:run-hash
   #:run-seconds #:run-validity #:run-tolerances #:run-final-values #:run-ending
   #:run-step #:run-step-designator #:run-step-outcome #:run-step-state
   #:run-step-failure #:run-text
   #:run-in-scene #:scene-run #:scene-run-ending #:scene-run-hash #:scene-run-text
   #:judge-run #:judgement #:judgement-verdict #:judgement-divergence
   #:divergence #:divergence-step #:divergence-fluents #:divergence-kind
   #:judgement-comparison
   ;; comparisons, step by step
   #:step-comparisons #:step-comparison #:step-comparison-number #:step-comparison-step
   #:step-comparison-verdict #:step-comparison-theory #:step-comparison-fluents
   ;; explanations
   #:explain-discrepancy #:explanation #:explanation-text #:explanation-json
   #:explanation-step #:explanation-grounds #:explanation-influences #:explanation-edits
   #:explanation-probes
   #:influence #:influence-parameters #:influence-failing #:influence-agreeing
   ;; verdicts on plans, reviewed by the discrepancies of the model
   #:review-plan #:review-of-verification #:review #:review-verification #:review-verdict
   #:review-doubts #:review-text #:review-json
   #:doubt #:doubt-file #:doubt-grounds #:doubt-status
   ;; search
   #:find-discrepancies #:search-result #:result-status #:result-reason #:result-discrepancy
   #:result-discrepancies #:result-traces #:result-simulations #:result-iterations #:result-seed
   #:result-exploration #:result-text #:result-symbolic-seconds #:result-simulation-seconds
   #:result-plan #:result-domain #:result-constraint #:result-parameters #:result-rule-name
   #:result-rule #:result-confidence #:result-sampler #:result-acceptance-rate #:result-kinds
   #:result-phases #:result-seconds #:result-solver-seconds #:result-reused #:result-stopped
   #:search-phase #:phase-name #:phase-simulations #:phase-simulation-seconds #:phase-seconds
   #:result-statement #:trace-result-statement #:trace-result-bound
   #:trace-result-starts-text
   #:request-stop #:stop-search
   #:skip-sample #:retry-sample #:abort-trace
   #:trace-result #:run-trace #:trace-result-status #:trace-result-trace #:trace-result-verdict
   #:trace-result-samples #:trace-result-rejected #:trace-result-reason
   #:trace-result-blind #:trace-result-targeted #:trace-result-drawn #:trace-result-accepted
   #:trace-result-left-trace #:trace-result-void #:trace-result-runs #:trace-result-warnings
   #:trace-result-acceptance-rate #:trace-result-confidence #:trace-result-discrepancies
   #:discrepancy #:discrepancy-plan #:discrepancy-trace #:discrepancy-sample #:discrepancy-run
   #:discrepancy-judgement #:discrepancy-seed #:discrepancy-file #:discrepancy-text
   #:discrepancy-parameters #:discrepancy-confirmed-p #:discrepancy-domain
   #:discrepancy-constraint #:discrepancy-execution #:discrepancy-compare
   #:discrepancy-comparison #:discrepancy-origin #:discrepancy-occurrences #:discrepancy-runs
   #:discrepancy-other-runs
   #:discrepancy-kind #:kind-text #:discrepancy-explanation #:discrepancy-shrunk
   ;; plans and domains by name
   #:ensure-plan #:ensure-domain #:locate-file #:use-data-directories
   ;; replay
   #:save-discrepancy #:replay #:replay-result #:replay-status #:replay-verdict
   #:replay-discrepancy #:replay-text
   #:replay-stopped #:replay-stopped-number #:replay-stopped-text #:replay-stopped-projection
   #:finish-replay
   ;; shrinking
   #:shrink-discrepancy #:shrinking #:shrinking-discrepancy #:shrinking-original
   #:shrinking-boundary #:shrinking-runs #:shrinking-seconds #:shrinking-exhausted
   #:shrinking-text #:shrinking-json #:boundary #:boundary-parameter #:boundary-failing
   #:boundary-passing #:boundary-text #:run-case
   #:recorded-action #:recorded-action-text #:discrepancy-actions #:discrepancy-left-out
   ;; candidate edits of the theory
   #:candidate-edits #:edit #:edit-text #:edit-kind #:edit-support #:edit-sentences #:edit-replaced
   #:edit-requirements #:edit-ranges #:edit-removes-p #:edit-contradicted #:edit-runs
   #:edited-theory #:edited-domain
   ;; refinement
   #:refine-theory #:refinement #:refinement-domain #:refinement-initial-domain
   #:refinement-steps #:refinement-status #:refinement-reason #:refinement-simulations
   #:refinement-runs #:refinement-results #:refinement-text #:refinement-step
   #:refinement-step-discrepancy #:refinement-step-edit #:refinement-step-alternatives
   ;; results as JSON, and what pictures of them need
   #:result-json #:sample-poses #:sample-joints #:sample-parameters #:write-file-whole #:run-sample
   ;; conditions and restarts
   #:discrepancy-error #:abstraction-error #:sampling-error #:replay-error
   #:discrepancy-found #:discrepancy-found-discrepancy
   #:continue-search #:next-trace #:accept
   #:journal-error #:journal-error-file #:journal-error-reason
   #:invalid-argument
   ;; simulation without a trace
   #:simulate-blindly #:blind-result #:blind-result-simulations
   #:blind-result-rejected #:blind-result-kinds #:blind-result-discrepancy
   #:blind-result-seconds #:discrepancy-summary))
