;;;; Z3's C API: solvers, models, statistics.

(in-package #:discrepancy-finder.z3)

;;; Life and parameters

(define-z3-function z3-mk-solver handle context)
(define-z3-function z3-mk-simple-solver handle context)
(define-z3-function z3-mk-solver-for-logic handle context logic)
(define-z3-function z3-mk-solver-from-tactic handle context tactic)
(define-z3-function z3-solver-translate handle context solver target)
(define-z3-function z3-solver-import-model-converter :void context source target)
(define-z3-function z3-solver-inc-ref :void context solver)
(define-z3-function z3-solver-dec-ref :void context solver)
(define-z3-function z3-solver-get-help handle context solver)
(define-z3-function z3-solver-get-param-descrs handle context solver)
(define-z3-function z3-solver-set-params :void context solver parameters)
(define-versioned-z3-function z3-solver-add-simplifier handle context solver simplifier)

;;; Assertions

(define-z3-function z3-solver-push :void context solver)
(define-z3-function z3-solver-pop :void context solver (count :uint))
(define-z3-function z3-solver-reset :void context solver)
(define-z3-function z3-solver-get-num-scopes :uint context solver)
(define-z3-function z3-solver-assert :void context solver term)
(define-z3-function z3-solver-assert-and-track :void context solver term literal)
(define-z3-function z3-solver-from-file :void context solver (file :pointer))
(define-z3-function z3-solver-from-string :void context solver (text :pointer))
(define-z3-function z3-solver-get-assertions handle context solver)
(define-z3-function z3-solver-get-units handle context solver)
(define-z3-function z3-solver-get-non-units handle context solver)
(define-z3-function z3-solver-get-trail handle context solver)
(define-z3-function z3-solver-get-levels :void
  context solver literals (count :uint) (levels :pointer))
(define-versioned-z3-function z3-solver-set-initial-value :void context solver term value)

;;; Checks

(define-z3-function z3-solver-check :int context solver)
(define-z3-function z3-solver-check-assumptions :int
  context solver (count :uint) (assumptions :pointer))
(define-z3-function z3-solver-interrupt :void context solver)
(define-z3-function z3-solver-get-reason-unknown handle context solver)
(define-z3-function z3-solver-get-unsat-core handle context solver)
(define-z3-function z3-solver-get-proof handle context solver)
(define-z3-function z3-solver-get-model handle context solver)
(define-z3-function z3-solver-get-statistics handle context solver)
(define-z3-function z3-solver-get-consequences :int
  context solver assumptions variables consequences)
(define-z3-function z3-solver-cube handle context solver variables (level :uint))
(define-z3-function z3-get-implied-equalities :int
  context solver (count :uint) (terms :pointer) (classes :pointer))
(define-versioned-z3-function z3-solver-congruence-root handle context solver term)
(define-versioned-z3-function z3-solver-congruence-next handle context solver term)
(define-versioned-z3-function z3-solver-solve-for :void context solver variables terms guards)
(define-z3-function z3-solver-to-string handle context solver)
(define-z3-function z3-solver-to-dimacs-string handle context solver (names bool))

;;; Models

(define-z3-function z3-mk-model handle context)
(define-z3-function z3-model-inc-ref :void context model)
(define-z3-function z3-model-dec-ref :void context model)
(define-z3-function z3-model-eval bool context model term (completion bool) (value :pointer))
(define-z3-function z3-model-get-const-interp handle context model declaration)
(define-z3-function z3-model-has-interp bool context model declaration)
(define-z3-function z3-model-get-func-interp handle context model declaration)
(define-z3-function z3-model-get-num-consts :uint context model)
(define-z3-function z3-model-get-const-decl handle context model (index :uint))
(define-z3-function z3-model-get-num-funcs :uint context model)
(define-z3-function z3-model-get-func-decl handle context model (index :uint))
(define-z3-function z3-model-get-num-sorts :uint context model)
(define-z3-function z3-model-get-sort handle context model (index :uint))
(define-z3-function z3-model-get-sort-universe handle context model sort)
(define-z3-function z3-model-translate handle context model target)
(define-z3-function z3-model-to-string handle context model)
(define-z3-function z3-add-const-interp :void context model declaration value)
(define-z3-function z3-add-func-interp handle context model declaration default)

;;; Interpretations of functions

(define-z3-function z3-func-interp-inc-ref :void context interpretation)
(define-z3-function z3-func-interp-dec-ref :void context interpretation)
(define-z3-function z3-func-interp-get-num-entries :uint context interpretation)
(define-z3-function z3-func-interp-get-entry handle context interpretation (index :uint))
(define-z3-function z3-func-interp-add-entry :void context interpretation arguments value)
(define-z3-function z3-func-interp-get-else handle context interpretation)
(define-z3-function z3-func-interp-set-else :void context interpretation value)
(define-z3-function z3-func-interp-get-arity :uint context interpretation)
(define-z3-function z3-func-entry-inc-ref :void context entry)
(define-z3-function z3-func-entry-dec-ref :void context entry)
(define-z3-function z3-func-entry-get-value handle context entry)
(define-z3-function z3-func-entry-get-num-args :uint context entry)
(define-z3-function z3-func-entry-get-arg handle context entry (index :uint))

;;; Statistics

(define-z3-function z3-stats-inc-ref :void context statistics)
(define-z3-function z3-stats-dec-ref :void context statistics)
(define-z3-function z3-stats-size :uint context statistics)
(define-z3-function z3-stats-get-key handle context statistics (index :uint))
(define-z3-function z3-stats-is-uint bool context statistics (index :uint))
(define-z3-function z3-stats-is-double bool context statistics (index :uint))
(define-z3-function z3-stats-get-uint-value :uint context statistics (index :uint))
(define-z3-function z3-stats-get-double-value :double context statistics (index :uint))
(define-z3-function z3-stats-to-string handle context statistics)
