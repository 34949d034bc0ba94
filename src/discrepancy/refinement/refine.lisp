;;;; Refinement: from a minimal theory to a good one.
;;;;
;;;; REFINE-THEORY searches for a discrepancy along plans, applies the best candidate edit, and
;;;; begins again with the new theory, until none is found.  All runs so far stay: an edit that
;;;; contradicts one of them is not taken while there is another.  The REFINEMENT that it returns
;;;; holds the last domain and the history.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (refinement-step (:copier nil))
  "One discrepancy and what was done about it: EDIT is the one applied, or NIL if there was none;
ALTERNATIVES are the others.  SIMULATIONS and RUNS are the numbers of projections and of kept runs
so far."
  (discrepancy nil :read-only t)
  (edit nil :read-only t)
  (alternatives '() :type list :read-only t)
  (simulations 0 :type (integer 0) :read-only t)
  (runs 0 :type (integer 0) :read-only t))

(defstruct (refinement (:copier nil))
  "What REFINE-THEORY came to.  STATUS is :REFINED if no discrepancy is left along the plans and all
their traces are certified, else :UNDECIDED, for REASON."
  (plans '() :type list :read-only t)
  (initial-domain nil :read-only t)
  (domain nil :read-only t)
  (steps '() :type list :read-only t)
  (status :refined :type (member :refined :undecided) :read-only t)
  (reason "" :type string :read-only t)
  (simulations 0 :type (integer 0) :read-only t)
  (runs '() :type list :read-only t)
  (results '() :type list :read-only t))

(setf (documentation 'refinement-domain 'function)
      "Return the domain with the refined theory and action bindings."
      (documentation 'refinement-initial-domain 'function)
      "Return the domain that a refinement began with."
      (documentation 'refinement-steps 'function)
      "Return the history of a refinement: the list of its REFINEMENT-STEPs, in order."
      (documentation 'refinement-status 'function)
      "Return :REFINED if no discrepancy was left and every trace certified, else :UNDECIDED."
      (documentation 'refinement-reason 'function)
      "Return why a refinement has its status, as a clause."
      (documentation 'refinement-simulations 'function)
      "Return the number of projections of a refinement."
      (documentation 'refinement-runs 'function)
      "Return the list of all valid runs of a refinement."
      (documentation 'refinement-results 'function)
      "Return the SEARCH-RESULTs of the last theory of a refinement, one for each plan."
      (documentation 'refinement-step-discrepancy 'function)
      "Return the discrepancy that a step of a refinement is about."
      (documentation 'refinement-step-edit 'function)
      "Return the edit that was applied in a step of a refinement, or NIL if there was none."
      (documentation 'refinement-step-alternatives 'function)
      "Return the other candidate edits of a step of a refinement.")

(defmethod print-object ((refinement refinement) stream)
  (print-unreadable-object (refinement stream :type t)
    (format stream "~(~a~): ~d edit~:p, ~d simulation~:p" (refinement-status refinement)
            (length (refinement-steps refinement)) (refinement-simulations refinement))))

(defun determined-p (edit)
  "Return true if EDIT leaves nothing open that was determined."
  (not (member (edit-kind edit) '(:release :may-fail))))

(defun same-words-p (edit)
  "Return true if EDIT adds no fluent to the theory."
  (null (edit-ranges edit)))

(defun chosen-edit (edits)
  "Return the edit to apply: the best one of EDITS that removes the discrepancy, contradicts no run
and adds no fluent, what leaves nothing open first; or NIL."
  (let ((good (remove-if-not (lambda (edit)
                               (and (edit-removes-p edit) (zerop (edit-contradicted edit))
                                    (same-words-p edit)))
                             edits)))
    (or (find-if #'determined-p good) (first good))))

(defstruct (refining (:copier nil))
  "A refinement in progress: STEPS and RUNS newest first."
  (domain nil)
  (steps '() :type list)
  (runs '() :type list)
  (simulations 0 :type (integer 0)))

(defun search-plans (refining plans options)
  "Search along PLANS in the present domain of REFINING, until a discrepancy is found.  Return it or
NIL, and the list of the results."
  (let ((results '()))
    (dolist (plan plans (values nil (reverse results)))
      (let ((result (apply #'find-discrepancies plan :domain (refining-domain refining) options)))
        (push result results)
        (incf (refining-simulations refining) (result-simulations result))
        (dolist (trace (result-traces result))
          (dolist (run (plain-runs (trace-result-runs trace)))
            (push run (refining-runs refining))))
        (when (result-discrepancy result)
          (return (values (result-discrepancy result) (reverse results))))))))

(defun apply-best-edit (refining discrepancy)
  "Change the domain of REFINING by the best edit for DISCREPANCY, and note that.  Return true
unless there is none."
  (let* ((edits (candidate-edits discrepancy :guesses t
                                             :runs (reverse (refining-runs refining))))
         (edit (chosen-edit edits)))
    (push (make-refinement-step :discrepancy discrepancy :edit edit
                                :alternatives (remove edit edits)
                                :simulations (refining-simulations refining)
                                :runs (length (refining-runs refining)))
          (refining-steps refining))
    (when edit
      (setf (refining-domain refining) (edited-domain (refining-domain refining) edit)))
    edit))

(defun uncertified (results)
  "Return the first of RESULTS that is not certified, or NIL."
  (find :certified results :key #'result-status :test-not #'eq))

(defun refine-theory (plans &rest options &key domain parameters (constraint :any-action)
                                            (traces :every-state) (compare :every-step)
                                            (execution :plan) (edits 50) progress &allow-other-keys)
  "Refine the theory of DOMAIN (a domain or its name) until no discrepancy is found along PLANS, a
plan's name or a list of them, and return the REFINEMENT.  PARAMETERS are scene parameters that
differ from the scene's.  CONSTRAINT, TRACES, COMPARE, EXECUTION and all other options are those of
FIND-DISCREPANCIES; by default each action of a plan is looked at, in all initial states, after
every step, and plans are run to their ends, beyond what the theory allows.  At most EDITS edits are
applied.  PROGRESS is a function of each REFINEMENT-STEP.  Nothing is registered: the domain in the
end is REFINEMENT-DOMAIN.  Signals what FIND-DISCREPANCIES signals."
  (check-argument 'edits edits (typep edits '(integer 0)) "a natural number")
  (let* ((plans (alexandria:ensure-list plans))
         (first-domain (let ((domain (ensure-domain domain)))
                         (domain-with-parameters
                          domain (projection:normalized-parameters (domain-scene domain)
                                                                   parameters))))
         (refining (make-refining :domain first-domain))
         (options (list* :constraint constraint :traces traces :compare compare
                         :execution execution :shrink nil :explain nil
                         (alexandria:remove-from-plist options :domain :parameters :edits :progress
                                                       :constraint :traces :compare :execution
                                                       :shrink :explain))))
    (flet ((refinement (status results reason &rest arguments)
             (make-refinement :plans plans :initial-domain first-domain
                              :domain (refining-domain refining)
                              :steps (reverse (refining-steps refining)) :status status
                              :reason (apply #'format nil reason arguments)
                              :simulations (refining-simulations refining)
                              :runs (reverse (refining-runs refining)) :results results)))
      (loop
        (multiple-value-bind (discrepancy results) (search-plans refining plans options)
          (cond ((and (null discrepancy) (uncertified results))
                 (return (refinement :undecided results "~a"
                                     (result-reason (uncertified results)))))
                ((null discrepancy)
                 (return (refinement :refined results
                                     "no discrepancy is left along ~{~(~a~)~^, ~}" plans)))
                ((>= (length (refining-steps refining)) edits)
                 (return (refinement :undecided results
                                     "~d edit~:p ~:*~[were~;was~:;were~] not enough" edits)))
                ((not (apply-best-edit refining discrepancy))
                 (return (refinement :undecided results
                                     "no edit removes the last discrepancy without contradicting ~
                                      a run"))))
          (when progress
            (funcall progress (first (refining-steps refining)))))))))
