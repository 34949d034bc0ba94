;;;; Comparisons: theory and simulation side by side, step by step.
;;;;
;;;; STEP-COMPARISONS tells for each step of a run what the theory says of each observed fluent
;;;; after it, true, false or open, what the simulation has, and whether the two go together.  After
;;;; an outcome that the theory forbids it says nothing more.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (step-comparison (:copier nil))
  "The step with the NUMBER, counted from 0: STEP is the RUN-STEP, VERDICT is :AGREES,
:OUTCOME-FORBIDDEN, :STATE-FORBIDDEN or :NOT-JUDGED.  THEORY is a list of (atom . value), the value
T, NIL or :OPEN, and FLUENTS a list of (atom theory-value simulation-value) as in a divergence."
  (number 0 :type (integer 0) :read-only t)
  (step nil :type run-step :read-only t)
  (verdict :agrees :type (member :agrees :outcome-forbidden :state-forbidden :not-judged)
                   :read-only t)
  (theory '() :type list :read-only t)
  (fluents '() :type list :read-only t))

(setf (documentation 'step-comparison-number 'function)
      "Return the number of a compared step, counted from 0."
      (documentation 'step-comparison-step 'function)
      "Return the RUN-STEP that was compared, with the observed state after it."
      (documentation 'step-comparison-verdict 'function)
      "Return :AGREES, :OUTCOME-FORBIDDEN, :STATE-FORBIDDEN, or :NOT-JUDGED after a step with an
outcome that the theory forbids."
      (documentation 'step-comparison-theory 'function)
      "Return what the theory says after a step: a list of (atom . value) for the observed fluents,
the value T, NIL, or :OPEN where both are possible; after a forbidden outcome what it would have had
after an allowed one."
      (documentation 'step-comparison-fluents 'function)
      "Return the list of (atom theory-value simulation-value) in which theory and simulation differ
after a step.")

(defmethod print-object ((comparison step-comparison) stream)
  (print-unreadable-object (comparison stream :type t)
    (format stream "~d ~a ~(~a~)" (1+ (step-comparison-number comparison))
            (step-comparison-step comparison) (step-comparison-verdict comparison))))

(defun possible-value-p (solver candidates atom truth)
  "Return true if the fluent ATOM can have the value TRUTH in one of CANDIDATES."
  (loop for (state . condition) in candidates
        for proposition = (ec:fluent-value state atom)
        ;; The conditions of candidates are possible; most propositions are constants.
        thereis (if (typep proposition 'boolean)
                    (eq proposition truth)
                    (consistent-p solver (list condition (if truth
                                                             proposition
                                                             (z3:negation proposition)))))))

(defun theory-value (solver candidates atom)
  "Return what the theory says of the fluent ATOM after CANDIDATES: T, NIL or :OPEN."
  (cond ((not (possible-value-p solver candidates atom t)) nil)
        ((possible-value-p solver candidates atom nil) :open)
        (t t)))

(defun step-comparisons (domain run trace &key (comparison :consistent) (context nil))
  "Return the list of the STEP-COMPARISONs of the valid RUN, made for TRACE, with the theory of
DOMAIN.  COMPARISON and CONTEXT are as for JUDGE-RUN."
  (let ((comparisons '()))
    (call-with-judge
     (lambda (solver state)
       (map-steps (lambda (number step kind fluents candidates)
                    (push (make-step-comparison
                           :number number :step step :fluents fluents
                           :verdict (ecase kind
                                      ((nil) :agrees)
                                      (:outcome :outcome-forbidden)
                                      (:state :state-forbidden))
                           :theory (loop for (atom) in (run-step-state step)
                                         collect (cons atom (theory-value solver candidates
                                                                          atom))))
                          comparisons)
                    nil)
                  domain solver state (run-steps run) trace comparison))
     domain (run-initial-state run) context)
    (append (reverse comparisons)
            (loop for step in (nthcdr (length comparisons) (run-steps run))
                  for number from (length comparisons)
                  collect (make-step-comparison :number number :step step
                                                :verdict :not-judged)))))
