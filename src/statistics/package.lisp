(defpackage #:discrepancy-finder.statistics
  (:documentation "Probability distributions, regression, and the rules that decide when there have
been enough samples.  Numbers are double floats; results are functions of the arguments alone.")
  (:use #:cl)
  (:import-from #:discrepancy-finder.geometry #:decimal-double)
  (:export
   ;; numbers as text
   #:number-text
   ;; distributions
   #:normal-cdf #:normal-quantile #:two-sided-z
   #:beta-cdf #:beta-quantile #:student-cdf #:student-quantile #:two-sided-t
   #:f-cdf #:f-quantile
   ;; regression
   #:least-squares #:fit #:fit-coefficients #:fit-residual-sum #:fit-rank #:fit-columns
   #:regression #:make-regression #:add-observation #:regression-count
   ;; what rules see
   #:parameter-sample #:make-parameter-sample #:parameter-sample-initial #:parameter-sample-final
   #:parameter-sample-blind-p
   #:parameter-region #:make-parameter-region #:parameter-region-initial-bounds
   #:parameter-region-final-bounds
   #:verdict #:verdict-status #:verdict-reason #:verdict-count #:verdict-intervals
   #:verdict-coefficients #:verdict-sigma #:verdict-z #:verdict-freedom
   #:verdict-parts
   #:worst-corners
   ;; confidence rules
   #:confidence-rule #:confidence-rule-confidence #:confidence-verdict
   #:make-confidence-rule #:register-confidence-rule #:rule-for-trace
   #:evidence #:make-evidence #:add-sample #:evidence-verdict #:evidence-blind
   #:evidence-targeted #:make-mixed-evidence #:leave-out-part
   #:paper-rule #:paper-interval #:paper-sd-rule #:prediction-rule #:zero-failure-rule
   #:rule-delta #:sound-rule #:zero-failure-count #:zero-failure-bound
   ;; conditions
   #:invalid-confidence #:invalid-confidence-value #:invalid-delta #:invalid-delta-value
   #:unknown-confidence-rule #:unknown-confidence-rule-name #:unknown-confidence-rule-known))
