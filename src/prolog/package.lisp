(defpackage #:discrepancy-finder.prolog
  (:documentation "A small Prolog with lazy solutions under the names of CRAM's packages cram-prolog
and cram-utilities; designators are grounded in it.")
  (:use #:cl)
  (:export
   ;; lazy lists
   #:lazy-list #:cont #:next #:fin #:lazy-cons #:lazy-list-p
   #:lazy-car #:lazy-cdr #:lazy-elt #:lazy-take #:lazy-skip #:force-ll #:copy-lazy-list
   #:lazy-mapcar #:lazy-mapcan #:lazy-append #:lazy-flatten #:lazy-filter #:lazy-fold
   #:lazy-dolist #:lazy-cross-product #:lazy-set-difference
   ;; variables and bindings
   #:is-var #:is-unnamed-var #:is-segvar #:is-genvar #:gen-var #:vars-in #:rename-vars
   #:var-value #:is-bound #:add-bds #:substitute-vars
   #:with-vars-bound #:with-vars-strictly-bound
   ;; unification
   #:unify #:unify-p
   ;; queries
   #:prolog #:*break-on-lisp-errors*
   ;; predicates
   #:def-fact-group #:<- #:def-prolog-handler #:alias-predicate
   #:predicate #:describe-predicates
   ;; built-in predicates that do not bear a name of Common Lisp
   #:-> #:*-> #:cut #:true #:fail #:call #:once #:forall
   #:findall #:bagof #:setof #:set-of #:take #:filter-bindings #:generate-values
   #:lisp-fun #:lisp-pred #:lisp-type #:instance-of #:assert-type
   #:set-symbol-value #:get-slot-value #:bound #:ground #:== #:string-concat
   ;; conditions
   #:malformed-fact #:malformed-fact-group #:malformed-fact-form #:malformed-fact-reason
   #:malformed-goal #:malformed-goal-goal #:malformed-goal-reason
   #:unknown-predicate #:unknown-predicate-goal #:unknown-predicate-query
   #:unknown-predicate-arities
   #:predicate-not-extendable #:predicate-not-extendable-predicate
   #:predicate-not-extendable-group #:predicate-not-extendable-other
   #:lisp-error-in-goal #:lisp-error-in-goal-goal #:lisp-error-in-goal-error
   #:variable-not-bound #:variable-not-bound-variable))
