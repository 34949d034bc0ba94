;;;; The search: traces, samples, runs, judgements, until the confidence rule is met.
;;;;
;;;; FIND-DISCREPANCIES is the entry point.  For each trace that exploration hands out it draws
;;;; sample 0, 1, 2, ..., runs the plan from each, and asks after each consistent run whether the
;;;; confidence rule is satisfied.  A discrepancy is run a second time to confirm it and ends the
;;;; search, unless the user goes on by a restart.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *rejection-limit* 200
  "So many rejected samples in a row mean that the trace cannot be sampled.")

(defclass search-state ()
  ((plan :initarg :plan :reader search-plan)
   (domain :initarg :domain :reader search-domain)
   (constraint :initarg :constraint :reader search-constraint)
   (parameters :initarg :parameters :reader search-parameters)
   (rule :initarg :rule :reader search-rule)
   (seed :initarg :seed :reader search-seed)
   (sampler :initarg :sampler :reader search-sampler)
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

;;; One trace

(defstruct (trace-search (:copier nil))
  "The sampling of a trace in progress, by RULE.  DISCREPANCIES are newest first; IN-A-ROW counts
the rejected samples since the last valid one; PENDING are the values of the present ROUND of
strata, newest first."
  (search nil :read-only t)
  (trace nil :read-only t)
  (parameters '() :type list :read-only t)
  (content 0 :type (unsigned-byte 64) :read-only t)
  (rule nil :read-only t)
  (evidence nil :read-only t)
  (rejected 0 :type (integer 0))
  (in-a-row 0 :type (integer 0))
  (left 0 :type (integer 0))
  (round 0 :type (integer 0))
  (pending '() :type list)
  (verdict nil)
  (runs '() :type list)
  (discrepancies '() :type list))

(defun parameter-bounds (parameters)
  (map 'vector (lambda (parameter)
                 (cons (parameter-min parameter) (parameter-max parameter)))
       parameters))

(defun begin-trace (search trace)
  "Return the TRACE-SEARCH for TRACE.  Signals SAMPLING-ERROR."
  (let ((parameters (initial-parameters (search-domain search) trace)))
    (make-trace-search :search search :trace trace :parameters parameters
                       :content (content-hash (symbolic:trace-text trace))
                       :rule (rule-for-trace (search-rule search)
                                             (1+ (length (search-results search))))
                       :evidence (make-evidence
                                  (make-parameter-region
                                   (parameter-bounds (remove-if #'fixed-p parameters))
                                   (parameter-bounds (final-parameters (search-domain search)
                                                                       trace)))))))

(defun conclude (trace-search status reason &optional stop)
  "Return the TRACE-RESULT of TRACE-SEARCH, and STOP: whether the whole search ends."
  (values (make-trace-result
           :trace (trace-search-trace trace-search) :reason reason
           :status (if (trace-search-discrepancies trace-search) :discrepancy status)
           :verdict (trace-search-verdict trace-search)
           :samples (evidence-blind (trace-search-evidence trace-search))
           :rejected (trace-search-rejected trace-search)
           :left-trace (trace-search-left trace-search)
           :runs (reverse (trace-search-runs trace-search))
           :discrepancies (reverse (trace-search-discrepancies trace-search)))
          stop))

(defun note-rejection (trace-search run)
  "Count the invalid RUN; conclude if there were too many in a row."
  (incf (trace-search-rejected trace-search))
  (when (> (incf (trace-search-in-a-row trace-search)) *rejection-limit*)
    (conclude trace-search :skipped
              (format nil "~d samples in a row were rejected, the last one because ~a"
                      (trace-search-in-a-row trace-search) (run-validity run)))))

(defun note-discrepancy (trace-search sample run judgement)
  "Keep the discrepancy that RUN of SAMPLE is; conclude if that is the user's choice."
  (let* ((search (trace-search-search trace-search))
         (discrepancy (confirmed-discrepancy search sample (trace-search-trace trace-search)
                                             run judgement)))
    (push discrepancy (trace-search-discrepancies trace-search))
    (ecase (offer-choices search discrepancy)
      (:continue nil)
      (:next-trace (conclude trace-search :discrepancy "a discrepancy was found"))
      (:stop (conclude trace-search :discrepancy "a discrepancy was found" t)))))

(defun flush-round (trace-search blind-p)
  "Add the pending samples of TRACE-SEARCH to its evidence."
  (loop for (initial . final) in (reverse (trace-search-pending trace-search))
        do (add-sample (trace-search-evidence trace-search)
                       (make-parameter-sample initial final :blind-p blind-p)))
  (setf (trace-search-pending trace-search) '()))

(defun add-evidence (trace-search sample run)
  "Add RUN of SAMPLE, which the theory allows, to the evidence of TRACE-SEARCH: as a blind sample if
draws are independent, or if it is in a round of strata of which no sample was lost."
  (let ((sampler (search-sampler (trace-search-search trace-search)))
        (round (floor (sample-index sample) +cells+)))
    (when (/= round (trace-search-round trace-search))
      (flush-round trace-search nil)
      (setf (trace-search-round trace-search) round))
    (push (cons (drawn-values sample) (run-final-values run))
          (trace-search-pending trace-search))
    (cond ((not (eq sampler :stratified)) (flush-round trace-search (eq sampler :independent)))
          ((= (length (trace-search-pending trace-search)) +cells+)
           (flush-round trace-search t)))))

(defun note-agreement (trace-search sample run)
  "Ask the confidence rule after RUN of SAMPLE, which the theory allows; conclude if it is
satisfied."
  (add-evidence trace-search sample run)
  (let ((verdict (evidence-verdict (trace-search-rule trace-search)
                                   (trace-search-evidence trace-search))))
    (setf (trace-search-verdict trace-search) verdict)
    (when (and (eq (verdict-status verdict) :confident)
               (inside-final-regions-p (final-parameters
                                        (search-domain (trace-search-search trace-search))
                                        (trace-search-trace trace-search))
                                       (verdict-intervals verdict)))
      (conclude trace-search :certified (verdict-reason verdict)))))

(defun try-sample (trace-search index)
  "Run sample INDEX of TRACE-SEARCH.  Return NIL to go on, or what CONCLUDE returns."
  (let* ((search (trace-search-search trace-search))
         (trace (trace-search-trace trace-search))
         (sample (draw-sample (trace-search-parameters trace-search) (search-seed search)
                              (trace-search-content trace-search) index
                              :sampler (search-sampler search)))
         (run (simulate search sample trace)))
    (cond
      ((not (eq (run-validity run) :valid)) (note-rejection trace-search run))
      ((eq (run-ending run) :too-many-steps)
       (conclude trace-search :undecided
                 (format nil "the run of sample ~d did not end within ~d steps" index
                         *step-limit*)))
      (t
       (let ((judgement (judge-run (search-domain search) run trace
                                   :context (search-context search)
                                   :compare (search-compare search))))
         (setf (trace-search-in-a-row trace-search) 0)
         (push (cons run judgement) (trace-search-runs trace-search))
         (ecase (judgement-verdict judgement)
           (:discrepancy (note-discrepancy trace-search sample run judgement))
           (:left-trace (incf (trace-search-left trace-search)) nil)
           (:consistent (note-agreement trace-search sample run))))))))

(defun search-trace (search trace)
  "Sample TRACE until the confidence rule is met, a discrepancy ends it, or the budget is used up.
Return the TRACE-RESULT, and true if the whole search is to end."
  (handler-case
      (loop with trace-search = (begin-trace search trace)
            for index from 0
            do (unless (within-budget-p search)
                 (return (conclude trace-search :undecided
                                   (format nil "the budget of ~d simulations is used up~@[; ~a~]"
                                           (search-budget search)
                                           (let ((verdict (trace-search-verdict trace-search)))
                                             (and verdict (verdict-reason verdict))))
                                   t)))
               (multiple-value-bind (result stop) (try-sample trace-search index)
                 (when result
                   (return (values result stop)))))
    (sampling-error (condition)
      (make-trace-result :trace trace :status :skipped
                         :reason (sampling-error-reason condition)))))

;;; Entry point

(defun check-argument (name value test expected)
  (unless test
    (error 'invalid-argument :name name :value value :expected expected)))

(defun constraint-name (constraint)
  "Return the name of CONSTRAINT, a state constraint or :ANY-ACTION."
  (if (keywordp constraint) constraint (ec:state-constraint-name constraint)))

(defun find-discrepancies (plan &key domain constraint (confidence 0.95d0) (rule :paper) delta
                                  (seed 1) (sampler :independent) (budget 1000) parameters
                                  arguments (execution :trace)
                                  (compare :final) (on-discrepancy :return) (max-paths 10000)
                                  (traces :last))
  "Search for a discrepancy between the theory and the scene of DOMAIN along PLAN (a symbol) and
return a SEARCH-RESULT.
  DOMAIN          a domain or its name
  CONSTRAINT      the name of the state constraint; NIL: the theory's only one; :ANY-ACTION: each
                  performed action ends a trace
  CONFIDENCE      in ]0, 1[, for the confidence RULE: :PAPER, :PAPER-SD, :PREDICTION,
                  :ZERO-FAILURE or :SOUND
  DELTA           in ]0, 1[, for the last two: the part of a trace's initial region that may be
                  discrepant all the same; NIL: 0.05
  SEED            of the blind samples, an integer of 64 bits
  SAMPLER         :INDEPENDENT, :STRATIFIED, :SOBOL or :CORNERS; the last two find, but certify
                  nothing
  BUDGET          the largest number of simulations, but for the one that confirms a discrepancy
  PARAMETERS      property list of scene parameters that differ from the scene's
  ARGUMENTS       list of (parameter boolean), the plan's symbolic arguments
  EXECUTION       :TRACE or :PLAN, COMPARE :FINAL or :EVERY-STEP
  TRACES          which ones of each path: :LAST, :EVERY-STATE, ..., see SYMBOLIC:MAKE-EXPLORATION
  ON-DISCREPANCY  :RETURN, or :SIGNAL for DISCREPANCY-FOUND with the restarts CONTINUE-SEARCH,
                  NEXT-TRACE and ACCEPT
Signals PLAN-NOT-FOUND, DOMAIN-NOT-FOUND, STATE-CONSTRAINT-NOT-FOUND, INVALID-CONFIDENCE,
INVALID-DELTA, UNKNOWN-CONFIDENCE-RULE, UNKNOWN-PARAMETER, IMPOSSIBLE-PARAMETER, INVALID-ARGUMENT,
and what symbolic execution signals."
  (check-argument 'plan plan (and plan (symbolp plan)) "the name of a plan")
  (check-argument 'constraint constraint (symbolp constraint) "the name of a state constraint")
  (check-argument 'max-paths max-paths (typep max-paths '(integer 1)) "a positive integer")
  (check-argument 'parameters parameters (alexandria:proper-list-p parameters) "a property list")
  (check-argument 'rule rule (symbolp rule) "the name of a confidence rule")
  (check-argument 'seed seed (typep seed '(unsigned-byte 64)) "an integer from 0 to 2^64 - 1")
  (check-argument 'sampler sampler (member sampler *samplers*)
                  ":independent, :stratified, :sobol or :corners")
  (check-argument 'budget budget (typep budget '(integer 1)) "a positive integer")
  (check-argument 'execution execution (member execution '(:trace :plan)) ":trace or :plan")
  (check-argument 'compare compare (member compare '(:final :every-step)) ":final or :every-step")
  (check-argument 'on-discrepancy on-discrepancy (member on-discrepancy '(:return :signal))
                  ":return or :signal")
  (let* ((rule-object (apply #'make-confidence-rule (ec:name-keyword rule)
                             :confidence confidence (and delta (list :delta delta))))
         (plan (ensure-plan plan))
         (domain (ensure-domain domain))
         (parameters (projection:normalized-parameters (domain-scene domain) parameters))
         (domain (domain-with-parameters domain parameters))
         (exploration (symbolic:make-exploration (plan:plan-name plan) domain :constraint constraint
                                                             :arguments arguments
                                                             :traces traces
                                                             :max-paths max-paths)))
    (unwind-protect
         (z3:with-context (context)
           (let ((search (make-instance
                          'search-state
                          :plan plan :domain domain :parameters parameters
                          :constraint (constraint-name
                                       (symbolic:exploration-constraint exploration))
                          :rule rule-object :seed seed :sampler sampler :budget budget
                          :execution execution
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
