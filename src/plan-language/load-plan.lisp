;;;; Loading files of plans.

(in-package #:discrepancy-finder.plan-language)

(defun load-plan (file)
  "Load FILE, a file of plan definitions read in the package DISCREPANCY-FINDER-USER, and return
the list of the plans that it defines, in their order.  Signals SOURCE-ERROR, which names file and
line, if it cannot be read or loaded."
  (let ((before (alexandria:hash-table-values *plans*)))
    (source:load-source file :package '#:discrepancy-finder-user)
    (sort (set-difference (alexandria:hash-table-values *plans*) before)
          #'< :key (lambda (plan)
                     (let ((position (plan-position plan)))
                       (if position (source:source-position-line position) 0))))))
