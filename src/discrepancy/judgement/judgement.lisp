;;;; Judgement: does the theory allow what was seen?
;;;;
;;;; The question is whether theory + the observed initial fluents + the run's own events and
;;;; outcomes + the observed state is satisfiable; fluents that cannot be observed are free.  A run
;;;; that the theory does not allow is a discrepancy.  One that it allows but that took another
;;;; outcome than the trace has left the trace.  The DIVERGENCE is the first step at which the
;;;; question is answered by no; it names the fluents in which theory and simulation part.
;;;;
;;;; That is the comparison :CONSISTENT.  The comparison :EXACT asks, as long as the run takes the
;;;; steps of the trace, for the trace's own states: where the theory leaves open what happens, the
;;;; trace has one of the possibilities, and a run with another one is a discrepancy.
;;;;
;;;; JUDGE-RUN is the entry point; comparisons.lisp tells all steps of a run.

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
simulation-value).  Where the theory forbids observed values only together, it has a smallest set of
them, and the theory's value of each is what it says given the others.")

(defmethod print-object ((divergence divergence) stream)
  (print-unreadable-object (divergence stream :type t)
    (format stream "at step ~d (~(~a~))~{ ~a~}" (1+ (divergence-step divergence))
            (divergence-kind divergence)
            (loop for (atom) in (divergence-fluents divergence) collect (ec:atom-text atom)))))

(defstruct (judgement (:copier nil))
  "VERDICT is :DISCREPANCY, :LEFT-TRACE or :CONSISTENT, by the COMPARISON :CONSISTENT or :EXACT.
DIVERGENCE is a divergence or NIL; a consistent run may have one that healed."
  (verdict :consistent :type (member :discrepancy :left-trace :consistent) :read-only t)
  (divergence nil :type (or null divergence) :read-only t)
  (comparison :consistent :type (member :consistent :exact) :read-only t))

(setf (documentation 'judgement-verdict 'function)
      "Return :DISCREPANCY, :LEFT-TRACE or :CONSISTENT."
      (documentation 'judgement-divergence 'function)
      "Return the first divergence of a run, or NIL."
      (documentation 'judgement-comparison 'function)
      "Return what a run was judged by: :CONSISTENT, what the theory allows, or :EXACT, the states
of its trace.")

(defmethod print-object ((judgement judgement) stream)
  (print-unreadable-object (judgement stream :type t)
    (format stream "~(~a~)~@[ ~a~]" (judgement-verdict judgement)
            (judgement-divergence judgement))))

(defun free-state (ground context observed)
  "Return the initial state of GROUND with the truth values OBSERVED; other fluents are variables of
the Z3 CONTEXT."
  (let ((values (make-hash-table :test 'equal)))
    (loop for (atom . truth) in observed
          do (setf (gethash atom values) truth))
    (ec:concrete-state ground
                       (lambda (atom)
                         (multiple-value-bind (truth seen) (gethash atom values)
                           (if seen
                               truth
                               (z3:variable context (ec:atom-text atom)))))
                       :context context)))

(defun observation (state observed)
  "Return the list of the propositions that STATE has the truth values OBSERVED."
  (loop for (atom . truth) in observed
        for proposition = (ec:fluent-value state atom)
        collect (if truth proposition (z3:negation proposition))))

(defun consistent-p (solver propositions)
  "Return true if PROPOSITIONS can be true together with what SOLVER holds, which is consistent."
  (let ((proposition (z3:conjunction propositions)))
    (if (typep proposition 'boolean)
        proposition
        (eq (z3:check solver (list proposition)) :sat))))

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

(defun settled-candidates (solver candidates)
  "Return CANDIDATES; the condition of a single one is handed to SOLVER, which has learnt from it by
the next question."
  (destructuring-bind (&optional candidate &rest more) candidates
    (cond ((or (null candidate) more (eq (cdr candidate) t)) candidates)
          (t (z3:solver-assert solver (cdr candidate))
             (list (cons (car candidate) t))))))

;;; Differences

(defun allows-p (solver candidates observed)
  "Return true if one of CANDIDATES can have the state OBSERVED."
  (loop for (state . condition) in candidates
        thereis (consistent-p solver (cons condition (observation state observed)))))

(defun impossible-values (solver candidates observed)
  "Return those of OBSERVED, (atom . truth), that no one of CANDIDATES can have, or, if each by
itself is possible, a smallest part of them that is not: given the others in it, the theory says the
opposite of each."
  (or (remove-if (lambda (entry) (allows-p solver candidates (list entry))) observed)
      (let ((needed observed))
        (dolist (entry observed needed)
          (let ((others (remove entry needed :test #'eq)))
            (unless (allows-p solver candidates others)
              (setf needed others)))))))

(defun trace-state-after (trace steps number)
  "Return the state of TRACE after step NUMBER if STEPS, those of a run, are as in TRACE up to it."
  (and (< number (length (symbolic:trace-steps trace)))
       (every #'same-step-p (subseq steps 0 (1+ number)) (symbolic:trace-steps trace))
       (nth (1+ number) (symbolic:trace-states trace))))

(defun unequal-values (state observed)
  "Return those of OBSERVED, (atom . truth), that STATE, a state of a trace or NIL, does not have."
  (and state
       (remove-if (lambda (entry) (eq (cdr entry) (ec:fluent-value state (car entry))))
                  observed)))

(defun differences (solver candidates expected step)
  "Return a list of (atom theory-value simulation-value) for the fluents in which the observed state
after STEP differs from what CANDIDATES allow, or from EXPECTED, a state of the trace or NIL."
  (let ((observed (run-step-state step)))
    (loop for (atom . truth) in (or (and (not (allows-p solver candidates observed))
                                         (impossible-values solver candidates observed))
                                    (unequal-values expected observed))
          collect (list atom (not truth) truth))))

;;; Walking along a run

(defun alternatives (domain solver candidates step)
  "Return what the theory has instead of a STEP whose outcome it forbids: the candidates after the
outcomes that it allows, or CANDIDATES if there are none, or if they are not known, since STEP was
read back."
  (or (and (not (read-back-p step))
           (next-candidates domain solver candidates
                            (symbolic:action-outcomes domain (run-step-designator step))))
      candidates))

(defun map-steps (function domain solver state steps trace comparison)
  "Call FUNCTION for each of STEPS, those of a run, from STATE on, until it returns true or the
theory forbids an outcome: with the step's number, the step, what is wrong (:OUTCOME, :STATE or
NIL), the list of (atom theory-value simulation-value) in which they differ, and the candidates
after it."
  (let ((candidates (and (eq (z3:check solver) :sat) (list (cons state t)))))
    (loop for step in steps
          for number from 0
          for next = (settled-candidates solver
                                         (next-candidates domain solver candidates
                                                          (run-step-candidates step)))
          do (if (null next)
                 (let ((others (alternatives domain solver candidates step)))
                   (funcall function number step :outcome
                            (differences solver others nil step) others)
                   (return))
                 (let ((differences (differences solver next
                                                 (and (eq comparison :exact)
                                                      (trace-state-after trace steps number))
                                                 step)))
                   (when (funcall function number step (and differences :state) differences next)
                     (return))
                   (setf candidates next))))))

(defun judge-steps (domain solver state steps &optional trace (comparison :consistent))
  "Return whether the theory of DOMAIN allows the outcomes of STEPS, those of a run, and the state
after the last of them; by the COMPARISON :EXACT also whether that after the last step of TRACE is
as in TRACE.  The second value is the first divergence or NIL."
  (let ((divergence nil) (final t) (last-of-trace t))
    (map-steps (lambda (number step kind fluents candidates)
                 (declare (ignore step candidates))
                 (when (and kind (null divergence))
                   (setf divergence (make-divergence :step number :kind kind :fluents fluents)))
                 (setf final (null kind))
                 (when (and kind (eq comparison :exact)
                            (= (1+ number) (length (symbolic:trace-steps trace))))
                   (setf last-of-trace nil))
                 nil)
               domain solver state steps trace comparison)
    (values (and final last-of-trace) divergence)))

(defun followed-p (run trace)
  "Return true if RUN took the steps of TRACE, all of them."
  (and (>= (length (run-steps run)) (length (symbolic:trace-steps trace)))
       (every #'same-step-p (run-steps run) (symbolic:trace-steps trace))))

(defun judging-logic (domain)
  "Return the logic of Z3's engine that answers many small questions fastest."
  (if (ec:ground-numeric-p (symbolic:action-theory-ground domain)) nil "QF_UF"))

(defun call-with-judge (function domain observed context)
  "Call FUNCTION with a solver that holds what the theory of DOMAIN says of a beginning at which
OBSERVED was seen, and with the state there.  CONTEXT is a Z3 context or NIL for a new one."
  (if (null context)
      (z3:with-context (context)
        (call-with-judge function domain observed context))
      (z3:with-released-terms (context)
        (z3:with-solver (solver context :logic (judging-logic domain))
          (let ((state (free-state (symbolic:action-theory-ground domain) context
                                   observed)))
            (loop for (nil . proposition) in (ec:initial-conditions state)
                  do (z3:solver-assert solver proposition))
            (funcall function solver state))))))

(defun judged-steps (domain observed steps &key trace (comparison :consistent) context memory)
  "Return what JUDGE-STEPS returns for STEPS, which follow the state OBSERVED.  What MEMORY, a
memory or NIL, has of it is not asked again."
  (flet ((ask ()
           (call-with-judge (lambda (solver state)
                              (judge-steps domain solver state steps trace comparison))
                            domain observed context)))
    (if memory
        (let ((key (judging-key domain observed steps (and (eq comparison :exact) trace))))
          (values-list (or (gethash key memory)
                           (setf (gethash key memory) (multiple-value-list (ask))))))
        (ask))))

(defun judge-run (domain run trace &key (compare :final) (comparison :consistent) context memory)
  "Return the JUDGEMENT of the valid RUN, made for TRACE, by the theory of DOMAIN.  COMPARE is
:FINAL, where a divergence that has healed by the end of the run counts as none, or :EVERY-STEP.
COMPARISON is :CONSISTENT, where what the theory allows is no discrepancy, or :EXACT, where the
states must be those of TRACE as long as RUN takes its steps.  CONTEXT is a Z3 context to use, or
NIL for a new one; MEMORY, a memory or NIL, knows runs that were judged before."
  (multiple-value-bind (consistent divergence)
      (judged-steps domain (run-initial-state run) (run-steps run)
                    :trace trace :comparison comparison :context context :memory memory)
    (make-judgement
     :divergence divergence :comparison comparison
     :verdict (cond ((or (not consistent) (and divergence (eq compare :every-step))) :discrepancy)
                    ((followed-p run trace) :consistent)
                    (t :left-trace)))))
