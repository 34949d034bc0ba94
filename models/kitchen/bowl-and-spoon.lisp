;;;; The domain of the plan bowl-and-spoon: the kitchen with bowl and spoon only.

(in-package #:discrepancy-finder-user)

(define-abstraction bowl-and-spoon
  "The domain kitchen with two items."
  (:extends "domain.lisp")
  (:theory "bowl-and-spoon-theory.lisp")
  (:items bowl spoon)
  ;; There is nothing below the workspace's top that could be taken for being on it; room for what
  ;; regression predicts of heights.
  (:region workspace (box (x -2.5 -1.9) (y -1 1) (z 0.7 0.98))))
