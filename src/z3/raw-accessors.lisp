;;;; Z3's C API: questions about terms, their parts, their texts, and rewriting them.

(in-package #:discrepancy-finder.z3)

;;; Any term

(define-z3-function z3-is-eq-ast bool context left right)
(define-z3-function z3-get-ast-id :uint context ast)
(define-z3-function z3-get-ast-hash :uint context ast)
(define-z3-function z3-get-ast-kind :int context ast)
(define-z3-function z3-get-sort handle context term)
(define-z3-function z3-is-well-sorted bool context term)
(define-z3-function z3-get-bool-value :int context term)
(define-versioned-z3-function z3-get-depth :uint context term)
(define-versioned-z3-function z3-is-ground bool context term)

;;; Applications

(define-z3-function z3-is-app bool context ast)
(define-z3-function z3-to-app handle context ast)
(define-z3-function z3-app-to-ast handle context application)
(define-z3-function z3-to-func-decl handle context ast)
(define-z3-function z3-get-app-decl handle context application)
(define-z3-function z3-get-app-num-args :uint context application)
(define-z3-function z3-get-app-arg handle context application (index :uint))

;;; Numerals

(define-z3-function z3-is-numeral-ast bool context term)
(define-z3-function z3-get-numeral-string handle context numeral)
(define-z3-function z3-get-numeral-binary-string handle context numeral)
(define-z3-function z3-get-numeral-decimal-string handle context numeral (precision :uint))
(define-z3-function z3-get-numeral-double :double context numeral)
(define-z3-function z3-get-numerator handle context numeral)
(define-z3-function z3-get-denominator handle context numeral)
(define-z3-function z3-get-numeral-small bool
  context numeral (numerator :pointer) (denominator :pointer))
(define-z3-function z3-get-numeral-int bool context numeral (value :pointer))
(define-z3-function z3-get-numeral-uint bool context numeral (value :pointer))
(define-z3-function z3-get-numeral-int64 bool context numeral (value :pointer))
(define-z3-function z3-get-numeral-uint64 bool context numeral (value :pointer))
(define-z3-function z3-get-numeral-rational-int64 bool
  context numeral (numerator :pointer) (denominator :pointer))

;;; Algebraic numbers

(define-z3-function z3-is-algebraic-number bool context term)
(define-z3-function z3-get-algebraic-number-lower handle context number (precision :uint))
(define-z3-function z3-get-algebraic-number-upper handle context number (precision :uint))
(define-z3-function z3-algebraic-is-value bool context term)
(define-z3-function z3-algebraic-sign :int context number)
(define-z3-function z3-algebraic-is-pos bool context number)
(define-z3-function z3-algebraic-is-neg bool context number)
(define-z3-function z3-algebraic-is-zero bool context number)
(define-z3-function z3-algebraic-add handle context left right)
(define-z3-function z3-algebraic-sub handle context left right)
(define-z3-function z3-algebraic-mul handle context left right)
(define-z3-function z3-algebraic-div handle context left right)
(define-z3-function z3-algebraic-root handle context number (degree :uint))
(define-z3-function z3-algebraic-power handle context number (exponent :uint))
(define-z3-function z3-algebraic-lt bool context left right)
(define-z3-function z3-algebraic-gt bool context left right)
(define-z3-function z3-algebraic-le bool context left right)
(define-z3-function z3-algebraic-ge bool context left right)
(define-z3-function z3-algebraic-eq bool context left right)
(define-z3-function z3-algebraic-neq bool context left right)
(define-z3-function z3-algebraic-roots handle context polynomial (count :uint) (values :pointer))
(define-z3-function z3-algebraic-eval :int context polynomial (count :uint) (values :pointer))
(define-z3-function z3-algebraic-get-poly handle context number)
(define-z3-function z3-algebraic-get-i :uint context number)

;;; Quantifiers and patterns

(define-z3-function z3-pattern-to-ast handle context pattern)
(define-z3-function z3-pattern-to-string handle context pattern)
(define-z3-function z3-get-pattern-num-terms :uint context pattern)
(define-z3-function z3-get-pattern handle context pattern (index :uint))
(define-z3-function z3-get-index-value :uint context variable)
(define-z3-function z3-is-quantifier-forall bool context term)
(define-z3-function z3-is-quantifier-exists bool context term)
(define-z3-function z3-is-lambda bool context term)
(define-z3-function z3-get-quantifier-weight :uint context term)
(define-z3-function z3-get-quantifier-num-patterns :uint context term)
(define-z3-function z3-get-quantifier-pattern-ast handle context term (index :uint))
(define-z3-function z3-get-quantifier-num-no-patterns :uint context term)
(define-z3-function z3-get-quantifier-no-pattern-ast handle context term (index :uint))
(define-z3-function z3-get-quantifier-num-bound :uint context term)
(define-z3-function z3-get-quantifier-bound-name handle context term (index :uint))
(define-z3-function z3-get-quantifier-bound-sort handle context term (index :uint))
(define-z3-function z3-get-quantifier-body handle context term)

;;; Rewriting

(define-z3-function z3-simplify handle context term)
(define-z3-function z3-simplify-ex handle context term parameters)
(define-z3-function z3-simplify-get-help handle context)
(define-z3-function z3-simplify-get-param-descrs handle context)
(define-z3-function z3-update-term handle context term (count :uint) (arguments :pointer))
(define-z3-function z3-substitute handle context term (count :uint) (from :pointer) (to :pointer))
(define-z3-function z3-substitute-vars handle context term (count :uint) (to :pointer))
(define-versioned-z3-function z3-substitute-funs handle
  context term (count :uint) (from :pointer) (to :pointer))
(define-z3-function z3-translate handle context ast target)

;;; Texts

(define-z3-function z3-set-ast-print-mode :void context (mode :int))
(define-z3-function z3-ast-to-string handle context ast)
(define-z3-function z3-benchmark-to-smtlib-string handle
  context (name :pointer) (logic :pointer) (status :pointer) (attributes :pointer)
  (count :uint) (assumptions :pointer) formula)
(define-z3-function z3-parse-smtlib2-string handle
  context (text :pointer) (sort-count :uint) (sort-names :pointer) (sorts :pointer)
  (count :uint) (names :pointer) (declarations :pointer))
(define-z3-function z3-parse-smtlib2-file handle
  context (file :pointer) (sort-count :uint) (sort-names :pointer) (sorts :pointer)
  (count :uint) (names :pointer) (declarations :pointer))
(define-z3-function z3-eval-smtlib2-string handle context (text :pointer))
