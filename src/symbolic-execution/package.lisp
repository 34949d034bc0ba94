(defpackage #:discrepancy-finder.symbolic-execution
  (:documentation "Plans executed on all inputs at once, along every path that a theory allows.")
  (:use #:cl)
  (:local-nicknames (#:z3 #:discrepancy-finder.z3)
                    (#:ec #:discrepancy-finder.event-calculus)
                    (#:plan #:discrepancy-finder.plan-language)
                    (#:source #:discrepancy-finder.source)
                    (#:desig #:discrepancy-finder.designators)
                    (#:json #:discrepancy-finder.json)
                    (#:html #:discrepancy-finder.html)
                    (#:foreign #:discrepancy-finder.foreign))
  (:export
   ;; action theories: what designators mean in a theory
   #:action-theory #:action-theory-name #:action-theory-theory #:action-theory-ground
   #:action-theory-actions #:define-action #:register-action #:region-of-pose #:region-of
   #:value-of #:truth-of
   #:action-binding #:find-action-binding #:find-action-theory #:register-action-theory
   #:all-action-theories #:make-domain
   #:revised-binding #:action-binding-class #:action-binding-type
   #:entered-p #:action-outcomes #:outcome #:make-outcome #:outcome-name #:outcome-event
   #:outcome-condition
   ;; exploration
   #:explore-plan #:make-exploration #:next-trace #:exploration #:exploration-traces
   #:exploration-paths #:exploration-checks #:exploration-seconds #:exploration-complete-p
   #:exploration-gaps #:exploration-dead-ends #:exploration-consistent-p #:exploration-plan
   #:exploration-domain
   #:exploration-constraint #:close-exploration #:exploration-statistics #:exploration-pending
   #:exploration-order #:exploration-seed #:stop-exploring
   ;; traces
   #:trace-initial-state #:trace-steps #:trace-states #:trace-final-state #:execution-trace
   #:trace-plan #:trace-arguments #:trace-text #:step-text #:states-along #:outcome-transition
   #:make-trace-step #:make-execution-trace
   #:trace-step #:step-designator #:step-event #:step-outcome #:step-position
   #:trace= #:trace-decisions #:trace-ending #:trace-output #:trace-alternatives #:trace-more-p
   #:trace-decision #:taken-text
   #:taken-choice #:taken-time #:trace-to-json #:trace-from-json
   #:argument-to-json #:argument-from-json
   ;; verification
   #:verify-plan #:verification #:verification-verdict #:verification-property
   #:verification-counterexample #:verification-problem #:verification-bounds
   #:verification-exploration
   ;; the evaluator
   #:evaluate
   ;; symbolic values
   #:symbolic-value #:symbolic-value-p #:symbolic-boolean #:symbolic-boolean-proposition
   #:symbolic-number #:symbolic-number-term #:symbolic-number-type
   #:symbolic-element #:symbolic-element-choices
   #:*number-limit* #:function-kind #:lifted-function #:make-symbolic-argument
   ;; coverage
   #:coverage #:coverage-forms #:coverage-outcomes #:coverage-axioms #:coverage-figures
   #:covered-form #:covered-form-form #:covered-form-position #:covered-form-state
   #:never-taken-outcomes #:never-exercised-axioms #:print-coverage #:write-coverage-html
   #:coverage-not-recorded
   ;; what an outcome rests on
   #:exploration-grounds #:trace-grounds
   ;; conditions
   #:symbolic-execution-error #:unsupported-form #:nondeterministic-plan
   #:action-problem #:domain-not-found #:domain-not-found-known
   #:invalid-trace #:invalid-trace-reason
   #:file-output-refused #:file-output-refused-file #:file-output-refused-plan
   #:unknown-argument-type #:unknown-argument-type-parameter #:unknown-argument-type-type
   #:unknown-argument-type-sorts
   #:plan-broke #:plan-broke-plan #:plan-broke-error #:call-plan))
