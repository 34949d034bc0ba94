;;;; Z3's C API: terms of bit-vectors.

(in-package #:discrepancy-finder.z3)

;;; Bit by bit

(define-z3-function z3-mk-bvnot handle context term)
(define-z3-function z3-mk-bvredand handle context term)
(define-z3-function z3-mk-bvredor handle context term)
(define-z3-function z3-mk-bvand handle context left right)
(define-z3-function z3-mk-bvor handle context left right)
(define-z3-function z3-mk-bvxor handle context left right)
(define-z3-function z3-mk-bvnand handle context left right)
(define-z3-function z3-mk-bvnor handle context left right)
(define-z3-function z3-mk-bvxnor handle context left right)
(define-versioned-z3-function z3-mk-bit2bool handle context (index :uint) term)

;;; Arithmetic

(define-z3-function z3-mk-bvneg handle context term)
(define-z3-function z3-mk-bvadd handle context left right)
(define-z3-function z3-mk-bvsub handle context left right)
(define-z3-function z3-mk-bvmul handle context left right)
(define-z3-function z3-mk-bvudiv handle context left right)
(define-z3-function z3-mk-bvsdiv handle context left right)
(define-z3-function z3-mk-bvurem handle context left right)
(define-z3-function z3-mk-bvsrem handle context left right)
(define-z3-function z3-mk-bvsmod handle context left right)

;;; Comparison

(define-z3-function z3-mk-bvult handle context left right)
(define-z3-function z3-mk-bvslt handle context left right)
(define-z3-function z3-mk-bvule handle context left right)
(define-z3-function z3-mk-bvsle handle context left right)
(define-z3-function z3-mk-bvuge handle context left right)
(define-z3-function z3-mk-bvsge handle context left right)
(define-z3-function z3-mk-bvugt handle context left right)
(define-z3-function z3-mk-bvsgt handle context left right)

;;; Parts and shifts

(define-z3-function z3-mk-concat handle context left right)
(define-z3-function z3-mk-extract handle context (high :uint) (low :uint) term)
(define-z3-function z3-mk-sign-ext handle context (bits :uint) term)
(define-z3-function z3-mk-zero-ext handle context (bits :uint) term)
(define-z3-function z3-mk-repeat handle context (times :uint) term)
(define-z3-function z3-mk-bvshl handle context left right)
(define-z3-function z3-mk-bvlshr handle context left right)
(define-z3-function z3-mk-bvashr handle context left right)
(define-z3-function z3-mk-rotate-left handle context (bits :uint) term)
(define-z3-function z3-mk-rotate-right handle context (bits :uint) term)
(define-z3-function z3-mk-ext-rotate-left handle context left right)
(define-z3-function z3-mk-ext-rotate-right handle context left right)

;;; Conversion and overflow

(define-z3-function z3-mk-int2bv handle context (size :uint) term)
(define-z3-function z3-mk-bv2int handle context term (signed bool))
(define-z3-function z3-mk-bvadd-no-overflow handle context left right (signed bool))
(define-z3-function z3-mk-bvadd-no-underflow handle context left right)
(define-z3-function z3-mk-bvsub-no-overflow handle context left right)
(define-z3-function z3-mk-bvsub-no-underflow handle context left right (signed bool))
(define-z3-function z3-mk-bvsdiv-no-overflow handle context left right)
(define-z3-function z3-mk-bvneg-no-overflow handle context term)
(define-z3-function z3-mk-bvmul-no-overflow handle context left right (signed bool))
(define-z3-function z3-mk-bvmul-no-underflow handle context left right)
