;;;; Results: discrepancies, what sampling a trace came to, and what a whole search came to.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (discrepancy (:copier nil))
  "A sample from which the simulation does what the theory does not allow."
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
  (run nil :read-only t)
  (judgement nil :read-only t)
  (confirmed-p nil :type boolean :read-only t)
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

(defstruct (trace-result (:copier nil))
  "What sampling a trace came to: STATUS is :CERTIFIED, :DISCREPANCY, :UNDECIDED or :SKIPPED."
  (trace nil :read-only t)
  (status :undecided :type (member :certified :discrepancy :undecided :skipped) :read-only t)
  (reason "" :type string :read-only t)
  (verdict nil :read-only t)
  (samples 0 :type (integer 0) :read-only t)
  (rejected 0 :type (integer 0) :read-only t)
  (left-trace 0 :type (integer 0) :read-only t)
  (discrepancies '() :type list :read-only t))

(setf (documentation 'trace-result-trace 'function)
      "Return the execution trace."
      (documentation 'trace-result-status 'function)
      "Return :CERTIFIED, :DISCREPANCY, :UNDECIDED or :SKIPPED."
      (documentation 'trace-result-reason 'function)
      "Return why a trace has its status, as a clause."
      (documentation 'trace-result-verdict 'function)
      "Return the last verdict of the confidence rule, or NIL."
      (documentation 'trace-result-samples 'function)
      "Return the number of samples that the theory allows."
      (documentation 'trace-result-rejected 'function)
      "Return the number of samples that were not valid.")

(defmethod print-object ((result trace-result) stream)
  (print-unreadable-object (result stream :type t)
    (format stream "~(~a~) after ~d sample~:p" (trace-result-status result)
            (trace-result-samples result))))

;;; Searches

(defclass search-result ()
  ((plan :initarg :plan :reader result-plan)
   (domain :initarg :domain :reader result-domain)
   (constraint :initarg :constraint :reader result-constraint)
   (parameters :initarg :parameters :reader result-parameters)
   (rule-name :initarg :rule-name :reader result-rule-name)
   (confidence :initarg :confidence :reader result-confidence)
   (seed :initarg :seed :reader result-seed
         :documentation "The seed of the blind samples.")
   (exploration :initarg :exploration :reader result-exploration
                :documentation "The EXPLORATION of the plan.")
   (traces :initarg :traces :reader result-traces
           :documentation "The list of the TRACE-RESULTs, in order.")
   (simulations :initarg :simulations :reader result-simulations
                :documentation "The number of projections.")
   (simulation-seconds :initarg :simulation-seconds :reader result-simulation-seconds
                       :documentation "The seconds spent in them."))
  (:documentation "What a search has found."))

(defun result-discrepancies (result)
  "Return the list of the DISCREPANCYs that RESULT holds."
  (loop for trace in (result-traces result) append (trace-result-discrepancies trace)))

(defun result-discrepancy (result)
  "Return the first DISCREPANCY of RESULT, or NIL."
  (first (result-discrepancies result)))

(defun result-iterations (result)
  "Return the number of traces that were simulated."
  (length (result-traces result)))

(defun result-symbolic-seconds (result)
  "Return the seconds spent in symbolic execution."
  (values (symbolic:exploration-seconds (result-exploration result))))

(defun result-status (result)
  "Return :DISCREPANCY, :CERTIFIED (all traces are, and exploration was complete) or :UNDECIDED."
  (cond ((result-discrepancies result) :discrepancy)
        ((and (result-traces result)
              (every (lambda (trace) (eq (trace-result-status trace) :certified))
                     (result-traces result))
              (symbolic:exploration-complete-p (result-exploration result)))
         :certified)
        (t :undecided)))

(defun result-reason (result)
  "Return a sentence without a full stop that says why RESULT has its status."
  (let ((undecided (find :certified (result-traces result) :key #'trace-result-status
                                                           :test-not #'eq)))
    (cond ((result-discrepancies result) "theory and simulation disagree")
          ((not (symbolic:exploration-consistent-p (result-exploration result)))
           "the theory allows no initial state")
          (undecided (trace-result-reason undecided))
          ((symbolic:exploration-complete-p (result-exploration result))
           (if (result-traces result)
               "every trace is certified and exploration was complete"
               "the state constraint comes true on no path, so nothing was simulated"))
          (t (format nil "exploration was incomplete~@[: ~{~a~^, ~}~]"
                     (symbolic:exploration-gaps (result-exploration result)))))))

(defmethod print-object ((result search-result) stream)
  (print-unreadable-object (result stream :type t)
    (format stream "~(~a: ~a~), ~d iteration~:p, ~d simulation~:p, seed ~d"
            (plan:plan-name (result-plan result)) (result-status result)
            (result-iterations result) (result-simulations result) (result-seed result))))

(defmethod describe-object ((result search-result) stream)
  (format stream "~a~%~a" result (result-text result)))
