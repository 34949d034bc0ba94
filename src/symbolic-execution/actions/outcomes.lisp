;;;; The outcomes of an action: its binding applied to a designator.
;;;;
;;;; Symbolic execution asks which outcomes the theory allows; the judgement of a projected run asks
;;;; whether it allows the outcome that was seen.  Entry point: ACTION-OUTCOMES.

(in-package #:discrepancy-finder.symbolic-execution)

(defun action-outcomes (domain designator &key plan position)
  "Return the list of the OUTCOMEs that DESIGNATOR may have in DOMAIN, success first.  Signals
ACTION-PROBLEM if there is no binding for it or its arguments mean nothing in the theory; it names
the PLAN that performs it and the source POSITION where it does."
  (handler-bind ((action-problem (lambda (condition)
                                   (setf (slot-value condition 'plan) plan
                                         (slot-value condition 'position) position))))
    (describe-outcomes domain designator)))

(defun describe-outcomes (domain designator)
  (let ((binding (find-action-binding domain designator))
        (ground (action-theory-ground domain)))
    (unless binding
      (error 'action-problem :designator designator
                             :reason (format nil "the domain ~a has no action binding for it"
                                             (ec:name-text (action-theory-name domain)))))
    (loop for (name event condition value)
            in (funcall (action-binding-describe-outcomes binding) domain designator)
          collect (make-outcome
                   :name name :value value
                   :event (and event
                               (let ((atom (mapcar #'ec:name-keyword event)))
                                 (ec:find-event ground atom)
                                 atom))
                   :condition (if (typep condition 'boolean)
                                  condition
                                  (ec:ground-formula
                                   ground
                                   (ec:parse-formula
                                    condition (action-theory-theory domain)
                                    :blame (format nil "action ~a" designator))))))))
