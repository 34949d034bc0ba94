;;;; Z3's C API: terms of the core, of arithmetic, of pseudo-booleans, of arrays; quantifiers.

(in-package #:discrepancy-finder.z3)

;;; Core

(define-z3-function z3-mk-app handle context declaration (count :uint) (arguments :pointer))
(define-z3-function z3-mk-const handle context name sort)
(define-z3-function z3-mk-fresh-const handle context (prefix :pointer) sort)
(define-z3-function z3-mk-true handle context)
(define-z3-function z3-mk-false handle context)
(define-z3-function z3-mk-eq handle context left right)
(define-z3-function z3-mk-distinct handle context (count :uint) (terms :pointer))
(define-z3-function z3-mk-not handle context term)
(define-z3-function z3-mk-ite handle context condition then else)
(define-z3-function z3-mk-iff handle context left right)
(define-z3-function z3-mk-implies handle context left right)
(define-z3-function z3-mk-xor handle context left right)
(define-z3-function z3-mk-and handle context (count :uint) (terms :pointer))
(define-z3-function z3-mk-or handle context (count :uint) (terms :pointer))

;;; Pseudo-booleans

(define-z3-function z3-mk-atmost handle context (count :uint) (terms :pointer) (bound :uint))
(define-z3-function z3-mk-atleast handle context (count :uint) (terms :pointer) (bound :uint))
(define-z3-function z3-mk-pble handle
  context (count :uint) (terms :pointer) (coefficients :pointer) (bound :int))
(define-z3-function z3-mk-pbge handle
  context (count :uint) (terms :pointer) (coefficients :pointer) (bound :int))
(define-z3-function z3-mk-pbeq handle
  context (count :uint) (terms :pointer) (coefficients :pointer) (bound :int))

;;; Integers and reals

(define-z3-function z3-mk-add handle context (count :uint) (terms :pointer))
(define-z3-function z3-mk-mul handle context (count :uint) (terms :pointer))
(define-z3-function z3-mk-sub handle context (count :uint) (terms :pointer))
(define-z3-function z3-mk-unary-minus handle context term)
(define-z3-function z3-mk-div handle context left right)
(define-z3-function z3-mk-mod handle context left right)
(define-z3-function z3-mk-rem handle context left right)
(define-z3-function z3-mk-power handle context base exponent)
(define-z3-function z3-mk-lt handle context left right)
(define-z3-function z3-mk-le handle context left right)
(define-z3-function z3-mk-gt handle context left right)
(define-z3-function z3-mk-ge handle context left right)
(define-z3-function z3-mk-divides handle context divisor dividend)
(define-z3-function z3-mk-int2real handle context term)
(define-z3-function z3-mk-real2int handle context term)
(define-z3-function z3-mk-is-int handle context term)
(define-versioned-z3-function z3-mk-abs handle context term)

;;; Numerals

(define-z3-function z3-mk-numeral handle context (text :pointer) sort)
(define-z3-function z3-mk-real handle context (numerator :int) (denominator :int))
(define-versioned-z3-function z3-mk-real-int64 handle
  context (numerator :int64) (denominator :int64))
(define-z3-function z3-mk-int handle context (value :int) sort)
(define-z3-function z3-mk-unsigned-int handle context (value :uint) sort)
(define-z3-function z3-mk-int64 handle context (value :int64) sort)
(define-z3-function z3-mk-unsigned-int64 handle context (value :uint64) sort)
(define-z3-function z3-mk-bv-numeral handle context (size :uint) (bits :pointer))

;;; Arrays and sets

(define-z3-function z3-mk-select handle context array index)
(define-z3-function z3-mk-select-n handle context array (count :uint) (indices :pointer))
(define-z3-function z3-mk-store handle context array index value)
(define-z3-function z3-mk-store-n handle context array (count :uint) (indices :pointer) value)
(define-z3-function z3-mk-const-array handle context domain value)
(define-z3-function z3-mk-map handle context declaration (count :uint) (arrays :pointer))
(define-z3-function z3-mk-array-default handle context array)
(define-z3-function z3-mk-as-array handle context declaration)
(define-z3-function z3-mk-array-ext handle context left right)
(define-z3-function z3-is-as-array bool context term)
(define-z3-function z3-get-as-array-func-decl handle context term)
(define-z3-function z3-mk-empty-set handle context domain)
(define-z3-function z3-mk-full-set handle context domain)
(define-z3-function z3-mk-set-add handle context set element)
(define-z3-function z3-mk-set-del handle context set element)
(define-z3-function z3-mk-set-union handle context (count :uint) (sets :pointer))
(define-z3-function z3-mk-set-intersect handle context (count :uint) (sets :pointer))
(define-z3-function z3-mk-set-difference handle context left right)
(define-z3-function z3-mk-set-complement handle context set)
(define-z3-function z3-mk-set-member handle context element set)
(define-z3-function z3-mk-set-subset handle context left right)
(define-versioned-z3-function z3-mk-set-has-size handle context set size)

;;; Quantifiers

(define-z3-function z3-mk-pattern handle context (count :uint) (terms :pointer))
(define-z3-function z3-mk-bound handle context (index :uint) sort)
(define-z3-function z3-mk-forall handle
  context (weight :uint) (pattern-count :uint) (patterns :pointer)
  (count :uint) (sorts :pointer) (names :pointer) body)
(define-z3-function z3-mk-exists handle
  context (weight :uint) (pattern-count :uint) (patterns :pointer)
  (count :uint) (sorts :pointer) (names :pointer) body)
(define-z3-function z3-mk-quantifier handle
  context (forall bool) (weight :uint) (pattern-count :uint) (patterns :pointer)
  (count :uint) (sorts :pointer) (names :pointer) body)
(define-z3-function z3-mk-quantifier-ex handle
  context (forall bool) (weight :uint) id skolem-id (pattern-count :uint) (patterns :pointer)
  (no-pattern-count :uint) (no-patterns :pointer)
  (count :uint) (sorts :pointer) (names :pointer) body)
(define-z3-function z3-mk-forall-const handle
  context (weight :uint) (count :uint) (constants :pointer)
  (pattern-count :uint) (patterns :pointer) body)
(define-z3-function z3-mk-exists-const handle
  context (weight :uint) (count :uint) (constants :pointer)
  (pattern-count :uint) (patterns :pointer) body)
(define-z3-function z3-mk-quantifier-const handle
  context (forall bool) (weight :uint) (count :uint) (constants :pointer)
  (pattern-count :uint) (patterns :pointer) body)
(define-z3-function z3-mk-quantifier-const-ex handle
  context (forall bool) (weight :uint) id skolem-id (count :uint) (constants :pointer)
  (pattern-count :uint) (patterns :pointer) (no-pattern-count :uint) (no-patterns :pointer) body)
(define-z3-function z3-mk-lambda handle
  context (count :uint) (sorts :pointer) (names :pointer) body)
(define-z3-function z3-mk-lambda-const handle context (count :uint) (constants :pointer) body)
