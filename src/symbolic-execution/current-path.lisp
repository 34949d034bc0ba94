;;;; The path in progress, which all parts of this layer ask for.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *path* nil
  "The path of the symbolic run in progress, or NIL.")
