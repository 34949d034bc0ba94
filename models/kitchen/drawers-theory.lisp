;;;; The theory of the household kitchen for plans that are about the spoon alone.
;;;;
;;;; This file is data: reading it evaluates nothing.

(define-theory kitchen-drawers
  "The theory of the kitchen, with the spoon as its only item."
  (:extends "theory.lisp")
  (:without item)
  (:sorts (item spoon)))
