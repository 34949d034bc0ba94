;;;; The packages of the language itself: cram-language, its implementation, cram-prolog and
;;;; cram-utilities.
;;;;
;;;; CRAM-PROLOG exports the FAIL of CRAM-LANGUAGE: the one symbol is a function in plans and a
;;;; predicate in facts, so that a package can use both.  In the same way NOT, <, > and = of
;;;; CRAM-LANGUAGE, which know fluents, are predicates too.

(in-package #:discrepancy-finder.cram-compat)

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defparameter *language-names*
    '(;; plans, goals
      #:def-cram-function #:def-top-level-cram-function
      #:declare-goal #:def-goal #:succeed #:register-goal #:describe-goal
      ;; top-levels, control
      #:top-level #:named-top-level #:seq #:par #:par-loop #:pursue #:try-all #:try-in-order
      #:try-each-in-order #:partial-order #:mapcar-clean #:with-tags #:task #:sub-task
      ;; policies
      #:policy #:make-policy #:define-policy #:with-policy #:with-policies #:with-named-policy
      #:with-named-policies #:timeout-policy
      #:policy-condition #:policy-not-found #:policy-failure #:policy-failure-parameters
      #:policy-init-failed #:policy-check-condition-met
      ;; tasks
      #:current-task #:status #:result #:task-alive #:task-dead
      #:task-dead-p #:task-running-p #:task-done-p #:task-failed-p
      #:suspend #:wake-up #:evaporate #:with-task-suspended #:on-suspension
      #:retry-after-suspension #:without-scheduling #:with-scheduling #:define-task-variable
      ;; the task tree
      #:with-task-tree-node #:task-path #:get-top-level-task-tree #:task-tree-node
      #:task-tree-node-path #:task-tree-node-parent #:task-tree-node-children
      #:task-tree-node-code #:task-tree-node-parameters #:task-tree-node-result
      #:task-tree-node-status-fluent #:flatten-task-tree
      ;; fluents
      #:fluent #:value-fluent #:fluent-net #:fluentp #:make-fluent #:value #:pulse #:pulsed
      #:wait-for #:whenever #:sleep*
      #:fl< #:fl> #:fl= #:fl+ #:fl- #:fl* #:fl/ #:fl-eq #:fl-eql #:fl-not #:fl-and #:fl-or
      #:fl-pulsed #:fl-funcall #:fl-apply #:fl-value-changed
      ;; failures
      #:fail #:on-fail #:*break-on-plan-failures* #:*debug-on-lisp-errors*
      #:with-failure-handling #:retry #:with-retry-counters #:do-retry #:get-counter
      #:reset-counter
      #:plan-failure #:simple-plan-failure #:composite-failure #:composite-failures
      #:common-lisp-error-envelope #:envelop-error)
    "What both CRAM-LANGUAGE and its implementation export of the plan language."))

(macrolet ((define-language-packages ()
             `(progn
                (define-compat-package #:cram-language (#:cpl) "cram-language"
                  "The plan language, to be used in the place of COMMON-LISP, all of which it passes
on but for the operators that know fluents."
                  (#:discrepancy-finder.cpl
                   ,@(loop for symbol being the external-symbols of '#:cl
                           collect (symbol-name symbol)))
                  (#:discrepancy-finder.plan-language ,@*language-names*))

                (define-compat-package #:cram-language-implementation (#:cpl-impl) "cram-language"
                  "The plan language without COMMON-LISP."
                  (#:discrepancy-finder.plan-language ,@*language-names*)))))
  (define-language-packages))

(define-compat-package #:cram-prolog (#:prolog) "cram-prolog"
  "Facts, queries and built-in predicates.  FAIL is that of CRAM-LANGUAGE."
  (#:discrepancy-finder.plan-language #:fail)
  (#:discrepancy-finder.prolog
   #:prolog #:*break-on-lisp-errors* #:def-fact-group #:<- #:def-prolog-handler
   #:unify #:unify-p #:rename-vars
   #:-> #:*-> #:cut #:true #:call #:once #:forall #:findall #:bagof #:setof #:set-of #:take
   #:filter-bindings #:generate-values #:lisp-fun #:lisp-pred #:lisp-type #:instance-of
   #:assert-type #:set-symbol-value #:get-slot-value #:bound #:ground #:== #:string-concat))

(define-compat-package #:cram-utilities (#:cut) "cram-utilities"
  "Lazy lists, variables and their bindings, hooks."
  (#:discrepancy-finder.plan-language #:define-hook #:hooks)
  (#:discrepancy-finder.cram-compat #:equalize-two-list-lengths #:equalize-lists-of-lists-lengths)
  (#:discrepancy-finder.prolog
   #:lazy-list #:cont #:next #:fin #:lazy-cons #:lazy-list-p
   #:lazy-car #:lazy-cdr #:lazy-elt #:lazy-take #:lazy-skip #:force-ll #:copy-lazy-list
   #:lazy-mapcar #:lazy-mapcan #:lazy-append #:lazy-flatten #:lazy-filter #:lazy-fold
   #:lazy-dolist #:lazy-cross-product #:lazy-set-difference
   #:is-var #:is-unnamed-var #:is-segvar #:is-genvar #:gen-var #:vars-in
   #:var-value #:is-bound #:add-bds #:substitute-vars
   #:with-vars-bound #:with-vars-strictly-bound))
