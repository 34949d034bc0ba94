;;;; Z3's C API: sorts and function declarations.

(in-package #:discrepancy-finder.z3)

;;; Sorts

(define-z3-function z3-mk-uninterpreted-sort handle context name)
(define-z3-function z3-mk-bool-sort handle context)
(define-z3-function z3-mk-int-sort handle context)
(define-z3-function z3-mk-real-sort handle context)
(define-z3-function z3-mk-bv-sort handle context (size :uint))
(define-z3-function z3-mk-finite-domain-sort handle context name (size :uint64))
(define-z3-function z3-mk-array-sort handle context domain range)
(define-z3-function z3-mk-array-sort-n handle context (count :uint) (domains :pointer) range)
(define-z3-function z3-mk-set-sort handle context element)
(define-z3-function z3-mk-enumeration-sort handle
  context name (count :uint) (names :pointer) (elements :pointer) (testers :pointer))
(define-z3-function z3-mk-tuple-sort handle
  context name (count :uint) (field-names :pointer) (field-sorts :pointer)
  (constructor :pointer) (projections :pointer))
(define-z3-function z3-mk-list-sort handle
  context name element (nil-declaration :pointer) (nil-tester :pointer)
  (cons-declaration :pointer) (cons-tester :pointer) (head :pointer) (tail :pointer))

;;; Data types

(define-z3-function z3-mk-constructor handle
  context name recognizer (count :uint) (field-names :pointer) (field-sorts :pointer)
  (references :pointer))
(define-z3-function z3-del-constructor :void context constructor)
(define-z3-function z3-query-constructor :void
  context constructor (count :uint) (declaration :pointer) (tester :pointer) (accessors :pointer))
(define-z3-function z3-mk-constructor-list handle context (count :uint) (constructors :pointer))
(define-z3-function z3-del-constructor-list :void context constructors)
(define-z3-function z3-mk-datatype handle context name (count :uint) (constructors :pointer))
(define-z3-function z3-mk-datatypes :void
  context (count :uint) (names :pointer) (sorts :pointer) (constructor-lists :pointer))
(define-z3-function z3-datatype-update-field handle context accessor term value)

;;; Questions about sorts

(define-z3-function z3-sort-to-ast handle context sort)
(define-z3-function z3-sort-to-string handle context sort)
(define-z3-function z3-is-eq-sort bool context left right)
(define-z3-function z3-get-sort-id :uint context sort)
(define-z3-function z3-get-sort-kind :int context sort)
(define-z3-function z3-get-sort-name handle context sort)
(define-z3-function z3-get-bv-sort-size :uint context sort)
(define-z3-function z3-get-finite-domain-sort-size bool context sort (size :pointer))
(define-z3-function z3-get-array-sort-domain handle context sort)
(define-z3-function z3-get-array-sort-range handle context sort)
(define-versioned-z3-function z3-get-array-arity :uint context sort)
(define-versioned-z3-function z3-get-array-sort-domain-n handle context sort (index :uint))
(define-z3-function z3-get-tuple-sort-mk-decl handle context sort)
(define-z3-function z3-get-tuple-sort-num-fields :uint context sort)
(define-z3-function z3-get-tuple-sort-field-decl handle context sort (index :uint))
(define-z3-function z3-get-datatype-sort-num-constructors :uint context sort)
(define-z3-function z3-get-datatype-sort-constructor handle context sort (index :uint))
(define-z3-function z3-get-datatype-sort-recognizer handle context sort (index :uint))
(define-z3-function z3-get-datatype-sort-constructor-accessor handle
  context sort (constructor-index :uint) (accessor-index :uint))

;;; Function declarations

(define-z3-function z3-mk-func-decl handle
  context name (arity :uint) (domain :pointer) range)
(define-z3-function z3-mk-fresh-func-decl handle
  context (prefix :pointer) (arity :uint) (domain :pointer) range)
(define-z3-function z3-mk-rec-func-decl handle
  context name (arity :uint) (domain :pointer) range)
(define-z3-function z3-add-rec-def :void
  context declaration (count :uint) (parameters :pointer) body)
(define-z3-function z3-mk-linear-order handle context sort (id :uint))
(define-z3-function z3-mk-partial-order handle context sort (id :uint))
(define-z3-function z3-mk-piecewise-linear-order handle context sort (id :uint))
(define-z3-function z3-mk-tree-order handle context sort (id :uint))
(define-z3-function z3-mk-transitive-closure handle context declaration)

;;; Questions about function declarations

(define-z3-function z3-func-decl-to-ast handle context declaration)
(define-z3-function z3-func-decl-to-string handle context declaration)
(define-z3-function z3-is-eq-func-decl bool context left right)
(define-z3-function z3-get-func-decl-id :uint context declaration)
(define-z3-function z3-get-decl-name handle context declaration)
(define-z3-function z3-get-decl-kind :int context declaration)
(define-z3-function z3-get-domain-size :uint context declaration)
(define-z3-function z3-get-arity :uint context declaration)
(define-z3-function z3-get-domain handle context declaration (index :uint))
(define-z3-function z3-get-range handle context declaration)
(define-z3-function z3-get-decl-num-parameters :uint context declaration)
(define-z3-function z3-get-decl-parameter-kind :int context declaration (index :uint))
(define-z3-function z3-get-decl-int-parameter :int context declaration (index :uint))
(define-z3-function z3-get-decl-double-parameter :double context declaration (index :uint))
(define-z3-function z3-get-decl-symbol-parameter handle context declaration (index :uint))
(define-z3-function z3-get-decl-sort-parameter handle context declaration (index :uint))
(define-z3-function z3-get-decl-ast-parameter handle context declaration (index :uint))
(define-z3-function z3-get-decl-func-decl-parameter handle context declaration (index :uint))
(define-z3-function z3-get-decl-rational-parameter handle context declaration (index :uint))
