(defpackage #:discrepancy-finder.event-calculus
  (:documentation "The Discrete Event Calculus (Mueller): theories, their models, what follows from
them and why, and what they say of a state after known events.")
  (:use #:cl)
  (:local-nicknames (#:z3 #:discrepancy-finder.z3) (#:source #:discrepancy-finder.source))
  (:import-from #:discrepancy-finder.source #:name-keyword)
  (:export
   ;; theories
   #:define-theory #:load-theory #:find-theory #:make-checked-theory #:register-theory
   #:theory #:theory-name #:theory-counts #:counts-text #:theory-documentation #:theory-syntax
   #:theory-file #:theory-files
   #:theory-sorts #:theory-predicates #:theory-extensions #:theory-functions
   #:theory-fluents #:theory-non-inertial
   #:theory-manual-release #:theory-events #:theory-axioms #:theory-completions
   #:theory-exclusions #:theory-time-range #:theory-offset-range #:theory-options
   #:sort-elements #:element-sort #:sort-name #:sort-parents #:sort-range #:sort-constants
   #:sort-terms
   #:axiom #:axiom-name #:axiom-label #:axiom-formula #:axiom-position
   ;; pieces of a run: what a state alone decides
   #:about-the-beginning-p #:self-contained-p #:formula-form #:effect-conditions
   ;; revised theories
   #:revised-theory #:effect-axioms #:event-axioms #:state-axioms
   ;; names and atoms
   #:name-keyword #:name-text #:atom-text #:text-atom #:make-term-table
   ;; formulas
   #:parse-formula #:formula-text
   ;; state constraints
   #:define-state-constraint #:parse-state-constraint #:find-state-constraint
   #:state-constraint #:state-constraint-name
   #:state-constraint-formula #:state-constraint-documentation #:state-constraint-span
   #:state-constraint-theory #:theory-state-constraints #:state-constraint-p
   ;; grounding
   #:ground-theory #:ground-theory-theory #:ground-theory-fluents #:ground-theory-events
   #:ground #:ground-formula #:find-fluent #:find-event #:event-number
   ;; files of the Discrete Event Calculus Reasoner
   #:load-e-theory #:read-e-theory #:parse-e-text #:write-e-theory #:save-e-theory
   #:print-e-models
   #:e-file-error #:e-file-error-file #:e-file-error-line #:e-file-error-reason
   #:e-file-warning #:e-file-warning-file #:e-file-warning-line #:e-file-warning-reason
   ;; reasoners
   #:reasoner #:make-reasoner #:close-reasoner #:with-reasoner #:extend-horizon
   #:reasoner-theory #:reasoner-horizon
   ;; models
   #:models #:count-models #:model #:model-theory #:model-horizon #:model-fluents #:model-events
   #:model-literals #:model-number
   ;; questions
   #:possible-p #:consistent-p #:entailed-p #:consequences #:abduce
   ;; why
   #:why #:why-impossible #:why-inconsistent #:explanation #:explanation-core
   #:explanation-sentences #:explanation-axioms #:explanation-persistent
   ;; check
   #:check-theory #:finding #:finding-severity #:finding-kind #:finding-subject #:finding-text
   #:finding-position
   ;; progression
   #:state #:state-time #:fluent-value #:symbolic-state #:concrete-state #:initial-conditions
   #:state-values #:state-ground #:progress #:holds #:state-fluents #:state-context
   #:state-predecessor #:state-happenings #:state-exact-p #:state-limits #:state-determined-p
   #:number-value #:state-numbers
   #:state-propositions #:state-in-model #:same-future-p #:ground-numeric-p
   #:order-matters-p #:event-footprint #:formula-footprint #:axioms-used
   #:axioms-about-event #:initial-axioms
   ;; conditions
   #:event-calculus-error #:theory-error #:theory-error-theory #:theory-error-axiom
   #:theory-error-reason
   #:theory-not-found #:state-constraint-not-found #:unknown-atom
   #:no-horizon #:no-horizon-theory #:no-horizon-horizon
   #:outside-horizon #:outside-horizon-time #:outside-horizon-horizon #:outside-horizon-event
   #:closed-reasoner #:closed-reasoner-theory
   #:undetermined #:undetermined-atom #:undetermined-kind #:undetermined-time
   #:undetermined-theory))
