;;;; Judgement: does the theory allow what was seen?
;;;;
;;;; The question is whether theory + the observed initial fluents + the run's own events and
;;;; outcomes + the observed state is satisfiable; fluents that cannot be observed are free.  A run
;;;; that the theory does not allow is a discrepancy.  One that it allows but that took another
;;;; outcome than the trace has left the trace.  The DIVERGENCE is the first step at which the
;;;; question is answered by no; it names the fluents in which theory and simulation part.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (divergence (:copier nil))
  "The first step (counted from 0) at which theory and simulation part.  KIND is :OUTCOME if the
theory forbids the step's outcome, :STATE if it forbids the state observed after it.  FLUENTS is a
list of (atom theory-value simulation-value)."
  (step 0 :type (integer 0) :read-only t)
  (kind :state :type (member :outcome :state) :read-only t)
  (fluents '() :type list :read-only t))

(setf (documentation 'divergence-step 'function)
      "Return the number of the step of a divergence, counted from 0."
      (documentation 'divergence-kind 'function)
      "Return :OUTCOME if the theory forbids the outcome of the step, :STATE if it forbids the
state after it."
      (documentation 'divergence-fluents 'function)
      "Return the fluents in which theory and simulation part: a list of (atom theory-value
simulation-value).")

(defmethod print-object ((divergence divergence) stream)
  (print-unreadable-object (divergence stream :type t)
    (format stream "at step ~d (~(~a~))~{ ~a~}" (1+ (divergence-step divergence))
            (divergence-kind divergence)
            (loop for (atom) in (divergence-fluents divergence) collect (ec:atom-text atom)))))

(defstruct (judgement (:copier nil))
  "VERDICT is :DISCREPANCY, :LEFT-TRACE or :CONSISTENT.  DIVERGENCE is a divergence or NIL; a
consistent run may have one that healed."
  (verdict :consistent :type (member :discrepancy :left-trace :consistent) :read-only t)
  (divergence nil :type (or null divergence) :read-only t))

(setf (documentation 'judgement-verdict 'function)
      "Return :DISCREPANCY, :LEFT-TRACE or :CONSISTENT."
      (documentation 'judgement-divergence 'function)
      "Return the first divergence of a run, or NIL.")

(defmethod print-object ((judgement judgement) stream)
  (print-unreadable-object (judgement stream :type t)
    (format stream "~(~a~)~@[ ~a~]" (judgement-verdict judgement)
            (judgement-divergence judgement))))

(defun free-state (ground context observed)
  "Return the initial state of GROUND with the truth values OBSERVED; other fluents are variables of
the Z3 CONTEXT."
  (ec:concrete-state ground
                     (lambda (atom)
                       (let ((entry (assoc atom observed :test #'equal)))
                         (if entry
                             (cdr entry)
                             (z3:variable context (ec:atom-text atom)))))
                     :context context))

(defun observation (state observed)
  "Return the list of the propositions that STATE has the truth values OBSERVED."
  (loop for (atom . truth) in observed
        for proposition = (ec:fluent-value state atom)
        collect (if truth proposition (z3:negation proposition))))

(defun consistent-p (solver propositions)
  "Return true if PROPOSITIONS can be true together with what SOLVER holds."
  (let ((proposition (z3:conjunction propositions)))
    (case proposition
      ((t) (eq (z3:check solver) :sat))
      ((nil) nil)
      (t (eq (z3:check solver (list proposition)) :sat)))))

(defun differing-fluents (solver state condition observed)
  "Return the list of (atom theory-value simulation-value) for the fluents that, given CONDITION,
cannot have the truth value OBSERVED in STATE."
  (loop for (atom . truth) in observed
        for proposition = (ec:fluent-value state atom)
        unless (consistent-p solver (list condition
                                          (if truth proposition (z3:negation proposition))))
          collect (list atom (not truth) truth)))

;;; A CANDIDATE is (state . condition): what may be the case after the steps so far, since a seen
;;; outcome can be one of several that the action binding lists.

(defun add-candidate (state condition candidates)
  "Return CANDIDATES with (STATE . CONDITION), which joins one of the same state if there is any."
  (let ((same (find state candidates :key #'car :test #'ec:same-future-p)))
    (if same
        (substitute (cons state (z3:disjunction (list (cdr same) condition))) same candidates)
        (append candidates (list (cons state condition))))))

(defun next-candidates (domain solver candidates outcomes)
  "Return the candidates after one of OUTCOMES, those that the theory allows."
  (let ((next-candidates '()))
    (loop for (state . condition) in candidates
          do (dolist (outcome outcomes)
               (multiple-value-bind (next conditions)
                   (symbolic:outcome-transition domain state outcome)
                 (let ((next-condition (z3:conjunction (cons condition
                                                             (mapcar #'cdr conditions)))))
                   (when (consistent-p solver (list next-condition))
                     (setf next-candidates
                           (add-candidate next next-condition next-candidates)))))))
    next-candidates))

(defun observed-candidate (solver candidates observed)
  "Return the first of CANDIDATES whose state can be the one OBSERVED, or NIL."
  (find-if (lambda (candidate)
             (consistent-p solver (cons (cdr candidate) (observation (car candidate) observed))))
           candidates))

(defun divergence-at (solver number kind candidates step)
  "Return the divergence at step NUMBER: the fluents in which the first of CANDIDATES differs from
what was observed after STEP."
  (destructuring-bind (state . condition) (first candidates)
    (make-divergence :step number :kind kind
                     :fluents (differing-fluents solver state condition (run-step-state step)))))

(defun judge-steps (domain solver state steps)
  "Return whether the theory allows the outcomes of STEPS and the state after the last of them, and
the first divergence or NIL."
  (let ((candidates (list (cons state t)))
        (divergence nil)
        (consistent t))
    (loop for step in steps
          for number from 0
          for next = (next-candidates domain solver candidates (run-step-candidates step))
          do (when (null next)
               (return-from judge-steps
                 (values nil
                         (or divergence
                             ;; What the theory would have had instead, if it allows anything.
                             (divergence-at solver number :outcome
                                            (or (next-candidates
                                                 domain solver candidates
                                                 (symbolic:action-outcomes
                                                  domain (run-step-designator step)))
                                                candidates)
                                            step)))))
             (setf candidates next
                   consistent (and (observed-candidate solver candidates (run-step-state step)) t))
             (unless (or consistent divergence)
               (setf divergence (divergence-at solver number :state candidates step))))
    (values consistent divergence)))

(defun followed-p (run trace)
  "Return true if RUN took the steps of TRACE, all of them."
  (and (>= (length (run-steps run)) (length (symbolic:trace-steps trace)))
       (every #'same-step-p (run-steps run) (symbolic:trace-steps trace))))

(defun judge-run (domain run trace &key (compare :final) (context nil))
  "Return the JUDGEMENT of the valid RUN, made for TRACE, by the theory of DOMAIN.  COMPARE is
:FINAL, where a divergence that has healed by the end of the run counts as none, or :EVERY-STEP.
CONTEXT is a Z3 context to use, or NIL for a new one."
  (if (null context)
      (z3:with-context (context)
        (judge-run domain run trace :compare compare :context context))
      (z3:with-released-terms (context)
        (z3:with-solver (solver context)
          (let ((state (free-state (symbolic:action-theory-ground domain) context
                                   (run-initial-state run))))
            (loop for (nil . proposition) in (ec:initial-conditions state)
                  do (z3:solver-assert solver proposition))
            (multiple-value-bind (consistent divergence)
                (judge-steps domain solver state (run-steps run))
              (make-judgement
               :divergence divergence
               :verdict (cond ((or (not consistent) (and divergence (eq compare :every-step)))
                               :discrepancy)
                              ((followed-p run trace) :consistent)
                              (t :left-trace)))))))))
