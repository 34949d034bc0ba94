(defpackage #:discrepancy-finder.z3
  (:documentation "The SMT solver Z3 from Lisp: contexts, propositional terms, solvers, models.")
  (:use #:cl)
  (:shadow #:variable)
  (:local-nicknames (#:foreign #:discrepancy-finder.foreign))
  (:export
   ;; conditions and restarts
   #:z3-error #:z3-error-code #:z3-error-message
   #:solver-unknown #:solver-unknown-solver #:solver-unknown-reason
   #:retry-with-timeout #:treat-as-sat
   ;; contexts
   #:context #:context-p #:make-context #:close-context #:with-context
   #:check-count #:check-seconds
   ;; propositions
   #:proposition #:term #:term-p #:term-context #:with-released-terms
   #:variable #:term-name #:term-equal
   #:negation #:conjunction #:disjunction #:implication #:equivalence
   ;; solvers
   #:solver #:solver-p #:solver-context #:make-solver #:close-solver #:with-solver
   #:solver-assert #:push-scope #:pop-scope #:solver-smt-lib
   ;; checks and models
   #:check #:model-value))
