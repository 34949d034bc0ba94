(defpackage #:discrepancy-finder.event-calculus
  (:documentation "The Discrete Event Calculus (Mueller): theories, and what they say of a state
after known events.")
  (:use #:cl)
  (:local-nicknames (#:z3 #:discrepancy-finder.z3) (#:source #:discrepancy-finder.source))
  (:import-from #:discrepancy-finder.source #:name-keyword)
  (:export
   ;; theories
   #:define-theory #:load-theory #:find-theory #:theory #:theory-name #:theory-documentation
   #:theory-sorts #:theory-fluents #:theory-events #:theory-axioms #:theory-file
   #:sort-elements #:axiom #:axiom-name #:axiom-formula
   ;; names and atoms
   #:name-keyword #:name-text #:atom-text #:text-atom
   ;; formulas
   #:parse-formula #:formula-text
   ;; state constraints
   #:define-state-constraint #:find-state-constraint #:state-constraint #:state-constraint-name
   #:state-constraint-formula #:state-constraint-documentation #:state-constraint-span
   #:state-constraint-theory #:theory-state-constraints #:state-constraint-p
   ;; grounding
   #:ground-theory #:ground-theory-theory #:ground-theory-fluents #:ground-theory-events
   #:ground #:ground-formula #:find-fluent #:find-event #:event-number
   ;; progression
   #:state #:state-time #:fluent-value #:symbolic-state #:concrete-state #:initial-conditions
   #:state-values #:state-ground #:progress #:holds #:state-fluents
   ;; conditions
   #:event-calculus-error #:theory-error #:theory-error-theory #:theory-error-axiom
   #:theory-not-found #:state-constraint-not-found #:unknown-atom))
