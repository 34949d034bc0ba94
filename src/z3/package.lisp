(defpackage #:discrepancy-finder.z3
  (:documentation "The SMT solver Z3 from Lisp: contexts, terms, solvers, models, cores, SMT-LIB.")
  (:use #:cl)
  (:shadow #:sort #:variable)
  (:local-nicknames (#:foreign #:discrepancy-finder.foreign))
  (:export
   ;; conditions and restarts
   #:z3-error #:z3-error-code #:z3-error-message
   #:solver-unknown #:solver-unknown-solver #:solver-unknown-reason
   #:retry-with-timeout #:treat-as-sat
   ;; contexts
   #:context #:context-p #:make-context #:close-context #:with-context
   #:check-count #:check-seconds #:*on-check* #:z3-version
   ;; sorts
   #:sort #:sort-p #:sort-context #:sort-kind #:sort-name #:sort-elements
   #:boolean-sort #:integer-sort #:real-sort #:enumeration-sort
   ;; terms
   #:proposition #:term #:term-p #:term-context #:term-sort #:with-released-terms
   #:variable #:constant-term #:term-name #:term-text #:term-equal
   ;; propositions
   #:negation #:conjunction #:disjunction #:implication #:equivalence #:at-most #:at-least
   ;; terms of every sort
   #:equals #:distinct #:if-then-else
   ;; numbers
   #:sum #:difference #:product #:quotient #:modulo #:less #:less-or-equal
   #:integer-to-real #:real-to-integer #:integral
   ;; solvers
   #:solver #:solver-p #:solver-context #:make-solver #:close-solver #:with-solver
   #:solver-assert #:push-scope #:pop-scope #:solver-smt-lib
   ;; checks, cores, models
   #:check #:unsat-core #:model-value #:model-values #:solver-statistics
   #:algebraic-number #:algebraic-number-p #:algebraic-number-lower #:algebraic-number-upper
   #:algebraic-number-text
   ;; clauses in bulk
   #:clause-set #:clause-set-p #:clause-set-solver #:clause-set-size
   #:make-clause-set #:close-clause-set #:with-clause-set #:clause-set-term
   #:assert-clauses #:assert-at-most #:check-literals #:failed-literals #:literal-values))
