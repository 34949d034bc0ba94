;;;; The kitchen's theory where bowl and spoon are the only items.
;;;;
;;;; This file is data: reading it evaluates nothing.

(define-theory bowl-and-spoon
  "The theory kitchen, but for the items."
  (:extends "theory.lisp")
  (:without item)
  (:sorts (item bowl spoon)))
