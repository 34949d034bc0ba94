(defpackage #:discrepancy-finder.discrepancy
  (:documentation "Where theory and projection meet: abstraction, sampling, confidence, comparison,
search, replay.")
  (:use #:cl)
  (:export
   ;; random numbers
   #:philox #:unit-float #:content-hash
   ;; confidence
   #:confidence-verdict #:confidence-rule #:make-confidence-rule #:verdict #:verdict-status #:verdict-reason
   #:least-squares #:normal-quantile))
