;;;; Results: discrepancies, and what sampling a trace came to.
;;;;
;;;; What a whole search came to is in search-results.lisp.

(in-package #:discrepancy-finder.discrepancy)

;;; Formulas as text

(defun formula-as-text (formula)
  "Return a text of FORMULA from which FORMULA-FROM-TEXT makes an equal one."
  (with-standard-io-syntax
    (let ((*package* (find-package '#:discrepancy-finder-user)) (*print-case* :downcase))
      (prin1-to-string formula))))

(defun formula-from-text (text)
  "Return the formula in TEXT; reading it evaluates nothing."
  (with-standard-io-syntax
    (let ((*package* (find-package '#:discrepancy-finder-user)) (*read-eval* nil))
      (values (read-from-string text)))))

(defun constraint-text (constraint)
  "Return the text of CONSTRAINT, the name of a state constraint or a formula."
  (if (consp constraint)
      (formula-as-text constraint)
      (ec:name-text constraint)))

(defstruct (discrepancy (:copier nil))
  "A sample from which the simulation does what the theory does not allow.  ORIGIN is :BLIND,
:TARGETED or :REUSED; OCCURRENCES counts the finds of the same kind, this one included; RUNS is a
list of (run . judgement), what the search had seen of the trace until then, OTHER-RUNS what it had
seen of traces before."
  (plan nil :read-only t)
  (domain nil :read-only t)
  (constraint nil :read-only t)
  (parameters '() :type list :read-only t)
  (execution :trace :type keyword :read-only t)
  (compare :final :type keyword :read-only t)
  (seed 0 :type (unsigned-byte 64) :read-only t)
  (trace nil :read-only t)
  (sample nil :read-only t)
  (actions '() :type list :read-only t)
  (left-out '() :type list :read-only t)
  (run nil)
  (judgement nil :read-only t)
  (confirmed-p nil :type boolean)
  (origin :blind :type (member :blind :targeted :reused) :read-only t)
  (occurrences 1 :type (integer 1))
  (runs '() :type list)
  (other-runs '() :type list)
  (explanation nil)
  (shrunk nil)
  (file nil :type (or null string)))

(setf (documentation 'discrepancy-plan 'function)
      "Return the plan, a PLAN."
      (documentation 'discrepancy-parameters 'function)
      "Return the property list of the scene parameters that differ from the scene's."
      (documentation 'discrepancy-seed 'function)
      "Return the seed of the sample."
      (documentation 'discrepancy-trace 'function)
      "Return the execution trace."
      (documentation 'discrepancy-sample 'function)
      "Return the sample from which the simulation does what the theory does not allow."
      (documentation 'discrepancy-actions 'function)
      "Return the list of the RECORDED-ACTIONs that a run performs in the place of the plan, or NIL:
the plan is run.  A discrepancy that was shrunk has some."
      (documentation 'discrepancy-left-out 'function)
      "Return the names (keywords) of the scene's items that the world of a shrunk discrepancy does
not have."
      (documentation 'discrepancy-run 'function)
      "Return the run of that sample."
      (documentation 'discrepancy-judgement 'function)
      "Return the judgement on that run."
      (documentation 'discrepancy-confirmed-p 'function)
      "Return true if a second run had the same bits."
      (documentation 'discrepancy-constraint 'function)
      "Return the name of the state constraint, or the formula that it was given as."
      (documentation 'discrepancy-domain 'function)
      "Return the domain."
      (documentation 'discrepancy-execution 'function)
      "Return :TRACE if runs stop where they leave the trace, or :PLAN."
      (documentation 'discrepancy-compare 'function)
      "Return :FINAL if final states are compared, or :EVERY-STEP."
      (documentation 'discrepancy-origin 'function)
      "Return how a discrepancy was found: by a :BLIND sample, a :TARGETED one, or :REUSED from a
store."
      (documentation 'discrepancy-occurrences 'function)
      "Return how often a search has found a discrepancy of this kind."
      (documentation 'discrepancy-runs 'function)
      "Return what the search had seen of the trace: a list of (RUN . JUDGEMENT) of valid runs in
the order in which they were made, the discrepancy's own last; at most 1000."
      (documentation 'discrepancy-other-runs 'function)
      "Return what the search had seen of earlier traces, a list of (RUN . JUDGEMENT) as by
DISCREPANCY-RUNS; at most 1000 of each trace.  Candidate edits are checked against these, too."
      (documentation 'discrepancy-explanation 'function)
      "Return the explanation of a discrepancy, or NIL."
      (documentation 'discrepancy-shrunk 'function)
      "Return what shrinking a discrepancy came to, or NIL."
      (documentation 'discrepancy-file 'function)
      "Return the name of the file in which a discrepancy is stored, or NIL.")

(defun discrepancy-summary (discrepancy)
  "Return where theory and simulation part in DISCREPANCY, as a clause."
  (let* ((divergence (judgement-divergence (discrepancy-judgement discrepancy)))
         (step (nth (divergence-step divergence) (run-steps (discrepancy-run discrepancy)))))
    (format nil "step ~d, ~a~:{; ~a is ~:[false~;true~] in the theory, ~:[false~;true~] in the ~
                 simulation~}"
            (1+ (divergence-step divergence)) (run-step-designator step)
            (loop for (atom . values) in (divergence-fluents divergence)
                  collect (cons (ec:atom-text atom) values)))))

(defmethod print-object ((discrepancy discrepancy) stream)
  (print-unreadable-object (discrepancy stream :type t)
    (format stream "~(~a~): ~a" (plan:plan-name (discrepancy-plan discrepancy))
            (discrepancy-summary discrepancy))))

(defun discrepancy-comparison (discrepancy)
  "Return :CONSISTENT if the theory was asked whether it allows a state, or :EXACT."
  (judgement-comparison (discrepancy-judgement discrepancy)))

;;; Kinds

(defun designator-type-of (designator)
  "Return the type of DESIGNATOR as a keyword; also if it is the text of one."
  (if (stringp designator)
      (let* ((start (search "(type " designator))
             (end (and start (position #\) designator :start start))))
        (if end
            (ec:name-keyword (intern (string-upcase (subseq designator (+ start 6) end))
                                     '#:keyword))
            :step))
      (ec:name-keyword (or (plan:desig-prop-value designator :type) :step))))

(defun intended-event (discrepancy number designator)
  "Return the event that the trace of DISCREPANCY has for DESIGNATOR at step NUMBER, or NIL; where
there is no trace, that of the action binding.  The trace has designators of the same type, perhaps
with less in them: what a run has detected has a pose."
  (let ((trace (discrepancy-trace discrepancy)))
    (if trace
        (let ((expected (nth number (symbolic:trace-steps trace))))
          (and expected
               (eq (designator-type-of designator)
                   (designator-type-of (symbolic:step-designator expected)))
               (symbolic:step-event expected)))
        (some #'symbolic:outcome-event
              (symbolic:action-outcomes (discrepancy-domain discrepancy) designator)))))

(defun step-action (discrepancy number step)
  "Return the name of the event that the theory has for STEP, the step NUMBER of the run of
DISCREPANCY; of one that means no event the type of the designator."
  (let ((event (or (intended-event discrepancy number (run-step-designator step))
                   (some #'symbolic:outcome-event (run-step-candidates step)))))
    (if event
        (first event)
        (designator-type-of (run-step-designator step)))))

(defun discrepancy-kind (discrepancy)
  "Return the kind of DISCREPANCY: a list of two keywords, the event of the first divergent step (or
its designator's type) and the predicate of the first divergent fluent, or, where the theory forbids
the outcome, the class of the failure (:SUCCESS for none)."
  (let* ((divergence (judgement-divergence (discrepancy-judgement discrepancy)))
         (number (divergence-step divergence))
         (step (nth number (run-steps (discrepancy-run discrepancy)))))
    (list (step-action discrepancy number step)
          (ecase (divergence-kind divergence)
            (:outcome (ec:name-keyword (run-step-outcome step)))
            (:state (or (first (first (first (divergence-fluents divergence)))) :state))))))

(defun kind-text (discrepancy)
  "Return the kind of DISCREPANCY in words, such as \"holding differs after navigate\"."
  (destructuring-bind (action aspect) (discrepancy-kind discrepancy)
    (if (eq :outcome (divergence-kind (judgement-divergence (discrepancy-judgement discrepancy))))
        (format nil "~a ends with ~a" (ec:name-text action) (ec:name-text aspect))
        (format nil "~a differs after ~a" (ec:name-text aspect) (ec:name-text action)))))

;;; Traces

(defstruct (trace-result (:copier nil))
  "What sampling a trace came to: STATUS is :CERTIFIED, :DISCREPANCY, :UNDECIDED or :SKIPPED.  BLIND
and TARGETED count the samples that the theory allows, DRAWN the blind samples that were drawn, and
REJECTED all samples that were not valid; VOID says why there can be no certificate, or is NIL.
STARTS are the initial states that were drawn from."
  (trace nil :read-only t)
  (starts '() :type list :read-only t)
  (status :undecided :type (member :certified :discrepancy :undecided :skipped) :read-only t)
  (reason "" :type string :read-only t)
  (verdict nil :read-only t)
  (confidence 0.95d0 :type double-float :read-only t)
  (blind 0 :type (integer 0) :read-only t)
  (targeted 0 :type (integer 0) :read-only t)
  (drawn 0 :type (integer 0) :read-only t)
  (accepted 0 :type (integer 0) :read-only t)
  (rejected 0 :type (integer 0) :read-only t)
  (left-trace 0 :type (integer 0) :read-only t)
  (void nil :type (or null string) :read-only t)
  (runs '() :type list :read-only t)
  (warnings '() :type list :read-only t)
  (discrepancies '() :type list :read-only t))

(defun trace-result-samples (result)
  "Return the number of samples that the theory allows, blind and targeted ones."
  (+ (trace-result-blind result) (trace-result-targeted result)))

(defun trace-result-acceptance-rate (result)
  "Return the part of the samples drawn blindly that were valid, or NIL if none was drawn."
  (and (plusp (trace-result-drawn result))
       (/ (trace-result-accepted result) (float (trace-result-drawn result) 1d0))))

(defun run-trace (result run)
  "Return the trace that RUN, of the trace of RESULT, is a run of: that trace, or the alternative to
it that begins as RUN does."
  (let ((start (find (sample-parameters (run-sample run)) (trace-result-starts result)
                     :key #'start-parameters)))
    (if start (start-trace start) (trace-result-trace result))))

(setf (documentation 'trace-result-trace 'function)
      "Return the execution trace; its alternatives are those that were sampled, too."
      (documentation 'trace-result-status 'function)
      "Return :CERTIFIED, :DISCREPANCY, :UNDECIDED or :SKIPPED."
      (documentation 'trace-result-reason 'function)
      "Return why a trace has its status, as a clause."
      (documentation 'trace-result-verdict 'function)
      "Return the last verdict of the confidence rule, or NIL."
      (documentation 'trace-result-confidence 'function)
      "Return the confidence that a guarantee for this trace needs, so that those for all traces of
the search hold jointly."
      (documentation 'trace-result-blind 'function)
      "Return the number of blind samples that the theory allows; only they count for a guarantee."
      (documentation 'trace-result-targeted 'function)
      "Return the number of other samples that the theory allows."
      (documentation 'trace-result-drawn 'function)
      "Return the number of samples that were drawn blindly, valid or not."
      (documentation 'trace-result-accepted 'function)
      "Return the number of samples that were drawn blindly and valid."
      (documentation 'trace-result-rejected 'function)
      "Return the number of samples that were not valid, targeted ones included."
      (documentation 'trace-result-left-trace 'function)
      "Return the number of samples that took another outcome than the trace's, which the theory
allows."
      (documentation 'trace-result-void 'function)
      "Return why the samples of a trace can support no certificate, as a clause, or NIL."
      (documentation 'trace-result-runs 'function)
      "Return the list of (RUN . JUDGEMENT) of the valid runs in their order; at most 1000."
      (documentation 'trace-result-warnings 'function)
      "Return the list of sentences that warn of what the verdict does not show."
      (documentation 'trace-result-discrepancies 'function)
      "Return the list of the DISCREPANCYs that were found in a trace.")

(defmethod print-object ((result trace-result) stream)
  (print-unreadable-object (result stream :type t)
    (format stream "~(~a~) after ~d sample~:p" (trace-result-status result)
            (trace-result-samples result))))
