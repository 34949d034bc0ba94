;;;; The search: traces, samples, runs, judgements, until the confidence rule is met.
;;;;
;;;; FIND-DISCREPANCIES is the entry point.  For each trace that exploration hands out it draws
;;;; sample 0, 1, 2, ..., runs the plan from each, and asks after each consistent run whether the
;;;; confidence rule is satisfied.  A discrepancy is run a second time to confirm it and ends the
;;;; search, unless the user goes on by a restart.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *rejection-limit* 200
  "So many rejected samples, without any valid one, mean that the trace cannot be sampled.")

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
  (run nil :read-only t)
  (judgement nil :read-only t)
  (confirmed-p nil :type boolean :read-only t)
  (file nil :type (or null string)))

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

(defmethod print-object ((result trace-result) stream)
  (print-unreadable-object (result stream :type t)
    (format stream "~(~a~) after ~d sample~:p" (trace-result-status result)
            (trace-result-samples result))))

(defclass search-state ()
  ((plan :initarg :plan :reader search-plan)
   (domain :initarg :domain :reader search-domain)
   (constraint :initarg :constraint :reader search-constraint)
   (parameters :initarg :parameters :reader search-parameters)
   (rule :initarg :rule :reader search-rule)
   (seed :initarg :seed :reader search-seed)
   (budget :initarg :budget :reader search-budget)
   (execution :initarg :execution :reader search-execution)
   (compare :initarg :compare :reader search-compare)
   (on-discrepancy :initarg :on-discrepancy :reader search-on-discrepancy)
   (context :initarg :context :reader search-context)
   (simulations :initform 0 :accessor search-simulations)
   (seconds :initform 0d0 :accessor search-seconds)
   (results :initform '() :accessor search-results :documentation "Newest first."))
  (:documentation "A search in progress."))

(defun simulate (search sample trace)
  "Run SAMPLE of TRACE and count it."
  (let ((start (foreign:monotonic-seconds)))
    (prog1 (execute-sample (search-domain search) (plan:plan-name (search-plan search)) sample
                           :trace trace :execution (search-execution search)
                           :arguments (symbolic:trace-arguments trace))
      (incf (search-simulations search))
      (incf (search-seconds search) (- (foreign:monotonic-seconds) start)))))

(defun confirmed-discrepancy (search sample trace run judgement)
  "Return the DISCREPANCY that RUN of SAMPLE is, after a second run."
  (let ((again (simulate search sample trace)))
    (make-discrepancy :plan (search-plan search) :domain (search-domain search)
                      :constraint (search-constraint search)
                      :parameters (search-parameters search)
                      :execution (search-execution search) :compare (search-compare search)
                      :seed (search-seed search) :trace trace :sample sample :run run
                      :judgement judgement
                      :confirmed-p (= (run-hash run) (run-hash again)))))

(defun offer-choices (search discrepancy)
  "Signal DISCREPANCY if that is wanted, and return what to do next: :CONTINUE, :NEXT-TRACE or
:STOP."
  (if (eq (search-on-discrepancy search) :signal)
      (restart-case (progn (error 'discrepancy-found :discrepancy discrepancy) :stop)
        (continue-search ()
          :report "Draw more samples of this trace; the discrepancy stays in the result."
          :continue)
        (next-trace ()
          :report "Leave this trace and take the next one; the discrepancy stays in the result."
          :next-trace)
        (accept ()
          :report "End the search and return the result with the discrepancy."
          :stop))
      :stop))

(defun within-budget-p (search)
  (< (search-simulations search) (search-budget search)))

(defun search-trace (search trace)
  "Sample TRACE until the confidence rule is met, a discrepancy ends it, or the budget is used up.
Return the TRACE-RESULT, and true if the whole search is to end."
  (let* ((domain (search-domain search))
         (parameters (initial-parameters domain trace))
         (content (content-hash (symbolic:trace-text trace)))
         (region (make-parameter-region
                  (map 'vector (lambda (p) (cons (parameter-min p) (parameter-max p))) parameters)
                  (map 'vector (lambda (p) (cons (parameter-min p) (parameter-max p)))
                       (final-parameters domain trace))))
         (samples '()) (rejected 0) (left 0) (verdict nil) (discrepancies '()))
    (flet ((result (status reason &optional stop)
             (return-from search-trace
               (values (make-trace-result :trace trace :status status :reason reason
                                          :verdict verdict :samples (length samples)
                                          :rejected rejected :left-trace left
                                          :discrepancies (reverse discrepancies))
                       stop))))
      (loop for index from 0
            do (unless (within-budget-p search)
                 (result (if discrepancies :discrepancy :undecided)
                         (format nil "the budget of ~d simulations is used up~@[; ~a~]"
                                 (search-budget search)
                                 (and verdict (verdict-reason verdict)))
                         t))
               (let* ((sample (draw-sample parameters (search-seed search) content index))
                      (run (simulate search sample trace)))
                 (if (not (eq (run-validity run) :valid))
                     (when (and (> (incf rejected) *rejection-limit*) (null samples))
                       (error 'sampling-error
                              :trace trace
                              :reason (format nil "all of ~d samples were rejected; the last one ~
                                                   because ~a" rejected (run-validity run))))
                     (let ((judgement (judge-run domain run trace
                                                 :context (search-context search)
                                                 :compare (search-compare search))))
                       (ecase (judgement-verdict judgement)
                         (:discrepancy
                          (push (confirmed-discrepancy search sample trace run judgement)
                                discrepancies)
                          (ecase (offer-choices search (first discrepancies))
                            (:continue)
                            (:next-trace (result :discrepancy "a discrepancy was found"))
                            (:stop (result :discrepancy "a discrepancy was found" t))))
                         (:left-trace (incf left))
                         (:consistent
                          (push (make-parameter-sample (sample-values sample)
                                                       (run-final-values run))
                                samples)
                          (setf verdict (confidence-verdict (search-rule search)
                                                            (reverse samples) region))
                          (when (eq (verdict-status verdict) :confident)
                            (result (if discrepancies :discrepancy :certified)
                                    (verdict-reason verdict))))))))))))

;;; Results

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
          ((null (result-traces result))
           "the state constraint comes true on no path, so nothing was simulated")
          (undecided (trace-result-reason undecided))
          ((symbolic:exploration-complete-p (result-exploration result))
           "every trace is certified and exploration was complete")
          (t (format nil "exploration was incomplete~@[: ~{~a~^, ~}~]"
                     (symbolic:exploration-gaps (result-exploration result)))))))

(defmethod print-object ((result search-result) stream)
  (print-unreadable-object (result stream :type t)
    (format stream "~(~a: ~a~), ~d iteration~:p, ~d simulation~:p, seed ~d"
            (plan:plan-name (result-plan result)) (result-status result)
            (result-iterations result) (result-simulations result) (result-seed result))))

(defmethod describe-object ((result search-result) stream)
  (format stream "~a~%~a" result (result-text result)))

;;; Entry point

(defun check-argument (name value test expected)
  (unless test
    (error 'invalid-argument :name name :value value :expected expected)))

(defun find-discrepancies (plan &key domain constraint (confidence 0.95d0) (rule :paper) (seed 1)
                                  (budget 1000) parameters arguments (execution :trace)
                                  (compare :final) (on-discrepancy :return) (max-paths 10000))
  "Search for a discrepancy between the theory and the scene of DOMAIN along PLAN (a symbol) and
return a SEARCH-RESULT.
  DOMAIN          a domain or its name
  CONSTRAINT      the name of the state constraint; NIL: the theory's only one
  CONFIDENCE      in ]0, 1[, for the confidence RULE, a keyword such as :PAPER
  SEED            of the blind samples, an integer of 64 bits
  BUDGET          the largest number of simulations
  PARAMETERS      property list of scene parameters that differ from the scene's
  ARGUMENTS       list of (parameter boolean), the plan's symbolic arguments
  EXECUTION       :TRACE or :PLAN, COMPARE :FINAL or :EVERY-STEP
  ON-DISCREPANCY  :RETURN, or :SIGNAL for DISCREPANCY-FOUND with the restarts CONTINUE-SEARCH,
                  NEXT-TRACE and ACCEPT
Signals PLAN-NOT-FOUND, DOMAIN-NOT-FOUND, STATE-CONSTRAINT-NOT-FOUND, INVALID-CONFIDENCE,
UNKNOWN-CONFIDENCE-RULE, UNKNOWN-PARAMETER, INVALID-ARGUMENT, SAMPLING-ERROR."
  (check-argument 'seed seed (typep seed '(unsigned-byte 64)) "an integer from 0 to 2^64 - 1")
  (check-argument 'budget budget (typep budget '(integer 1)) "a positive integer")
  (check-argument 'execution execution (member execution '(:trace :plan)) ":trace or :plan")
  (check-argument 'compare compare (member compare '(:final :every-step)) ":final or :every-step")
  (check-argument 'on-discrepancy on-discrepancy (member on-discrepancy '(:return :signal))
                  ":return or :signal")
  (let* ((rule-object (make-confidence-rule rule :confidence confidence))
         (plan-object (ensure-plan plan))
         (domain (domain-with-parameters (ensure-domain domain) parameters))
         (exploration (symbolic:make-exploration plan domain :constraint constraint
                                                             :arguments arguments
                                                             :max-paths max-paths)))
    (unwind-protect
         (z3:with-context (context)
           (let ((search (make-instance
                          'search-state
                          :plan plan-object :domain domain :parameters parameters
                          :constraint (ec:state-constraint-name
                                       (symbolic:exploration-constraint exploration))
                          :rule rule-object :seed seed :budget budget :execution execution
                          :compare compare :on-discrepancy on-discrepancy :context context)))
             (loop for trace = (symbolic:next-trace exploration)
                   while trace
                   do (multiple-value-bind (result stop) (search-trace search trace)
                        (push result (search-results search))
                        (when stop (return))))
             (make-instance 'search-result
                            :plan (search-plan search) :domain domain :rule-name rule
                            :constraint (search-constraint search) :parameters parameters
                            :confidence (confidence-rule-confidence rule-object) :seed seed
                            :exploration exploration
                            :traces (reverse (search-results search))
                            :simulations (search-simulations search)
                            :simulation-seconds (search-seconds search))))
      (symbolic:close-exploration exploration))))
