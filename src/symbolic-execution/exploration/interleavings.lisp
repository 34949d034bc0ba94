;;;; Interleavings: the order in which parallel tasks take their turns, as decisions.

(in-package #:discrepancy-finder.symbolic-execution)

(defmethod plan:choose-strand ((path path) scheduler count)
  (if (path-interleavings path)
      (decide path "the task that has its turn"
              (loop for number below count collect (cons number t))
              :exhaustive t)
      (call-next-method)))
