;;;; The domain of the plan bowl-and-spoon: the kitchen with bowl and spoon only.

(in-package #:discrepancy-finder-user)

(define-abstraction bowl-and-spoon
  "The domain kitchen with two items."
  (:extends "domain.lisp")
  (:theory "bowl-and-spoon-theory.lisp")
  (:items bowl spoon))
