(defpackage #:discrepancy-finder.bench
  (:documentation "Benchmarks: each measures one part of the system against a peer that does the
same work without it.")
  (:use #:cl)
  (:local-nicknames (#:bullet #:discrepancy-finder.bullet)
                    (#:foreign #:discrepancy-finder.foreign)
                    (#:geometry #:discrepancy-finder.geometry)
                    (#:z3 #:discrepancy-finder.z3)
                    (#:prolog #:discrepancy-finder.prolog)
                    (#:desig #:discrepancy-finder.designators)
                    (#:plan #:discrepancy-finder.plan-language)
                    (#:ec #:discrepancy-finder.event-calculus)
                    (#:symbolic #:discrepancy-finder.symbolic-execution)
                    (#:statistics #:discrepancy-finder.statistics)
                    (#:projection #:discrepancy-finder.projection)
                    (#:discrepancy #:discrepancy-finder.discrepancy)
                    (#:df #:discrepancy-finder))
  (:export
   ;; all of them
   #:print-benchmarks
   ;; steps of a Bullet world, through Lisp and in plain C++
   #:lisp-steps-per-second #:plain-steps-per-second
   ;; a plan in the kitchen
   #:run-transport #:transport-run #:print-transport-benchmarks
   ;; rounds of the plan language
   #:perform-rounds #:module-rounds #:parallel-module-rounds
   #:retry-rounds #:plain-retry-rounds #:child-failure-rounds #:par-rounds
   #:thread-rounds))
