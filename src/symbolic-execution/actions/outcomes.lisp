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

(defun outcome-event-in (ground event designator)
  "Return EVENT, a list of symbols, as a ground event of GROUND."
  (let ((atom (loop for part in event
                    collect (if (symbolp part) (ec:name-keyword part) part))))
    (handler-case (ec:find-event ground atom)
      (ec:unknown-atom ()
        (error 'action-problem
               :designator designator
               :reason (format nil "it means the event ~a, which theory ~a does not have"
                               (ec:atom-text atom)
                               (ec:name-text (ec:theory-name
                                              (ec:ground-theory-theory ground)))))))
    atom))

(defun outcome-condition-in (domain condition designator)
  "Return CONDITION, T, NIL or a formula, as a ground formula of the theory of DOMAIN."
  (ground-state-formula domain condition (lambda () (format nil "action ~a" designator))))

(defun describe-outcomes (domain designator)
  (let ((binding (find-action-binding domain designator))
        (ground (action-theory-ground domain)))
    (unless binding
      (error 'action-problem :designator designator
                             :reason (format nil "the domain ~a has no action binding for it"
                                             (ec:name-text (action-theory-name domain)))))
    (loop for (name event condition initargs)
            in (funcall (action-binding-describe-outcomes binding) domain designator)
          for number from 0
          collect (make-outcome
                   :name name :binding binding :number number :initargs initargs
                   :event (and event (outcome-event-in ground event designator))
                   :condition (outcome-condition-in domain condition designator)
                   :result (and (eq name :success)
                                (result-function domain binding designator))))))
