;;;; The search: traces, samples, runs, judgements, until the confidence rule is met.
;;;;
;;;; FIND-DISCREPANCIES is the entry point.  It tries the stored discrepancies first; then, for each
;;;; trace that exploration hands out, it draws one sample after the other, runs the plan from each,
;;;; and asks after each consistent run whether the confidence rule is satisfied.  A discrepancy is
;;;; confirmed by a second run, shrunk, explained and stored (finds.lisp); it ends the search,
;;;; unless the search is to keep going or the user goes on by a restart.

(in-package #:discrepancy-finder.discrepancy)

;;; One sample

(defun simulate (search sample trace)
  "Return the run of SAMPLE of TRACE."
  (execute-sample (search-domain search) (plan:plan-name (search-plan search)) sample
                  :trace trace :execution (search-execution search)
                  :arguments (symbolic:trace-arguments trace)))

(defun judge (search run trace)
  "Return the judgement on RUN, made for TRACE."
  (judge-run (search-domain search) run trace :context (search-context search)
                                              :memory (search-memory search)
                                              :compare (search-compare search)
                                              :comparison (search-comparison search)))

(defun run-and-judge (trace-search draw)
  "Return the run of DRAW and, if it is valid, the judgement on it; NIL if the run failed and the
sample was skipped.  What is in the journal of the search is not run again."
  (let ((search (trace-search-search trace-search))
        (trace (drawn-trace draw)))
    (in-phase (search (if (drawn-blindly-p draw) :generate :target))
      (multiple-value-bind (run judgement) (journaled-run search draw)
        (if run
            (values run judgement)
            (loop
              (restart-case
                  (let* ((run (simulate search (drawn-sample draw) trace))
                         (judgement (and (eq (run-validity run) :valid)
                                         (not (eq (run-ending run) :too-many-steps))
                                         (judge search run trace))))
                    (write-run search draw run judgement)
                    (return (values run judgement)))
                (retry-sample ()
                  :report "Run the sample once more.")
                (skip-sample ()
                  :report "Leave out this sample; the trace can have no certificate then."
                  (return nil)))))))))

(defun note-run (trace-search draw run judgement)
  "Take the valid RUN of DRAW into account.  Return NIL to go on, or what CONCLUDE returns."
  (setf (trace-search-in-a-row trace-search) 0)
  (incf (start-accepted (drawn-start draw)))
  (cond ((null judgement)
         (conclude trace-search :undecided
                   (format nil "the run of sample ~d did not end within ~d steps"
                           (sample-index (drawn-sample draw)) *step-limit*)))
        (t
         (keep-run trace-search run judgement)
         (ecase (judgement-verdict judgement)
           (:discrepancy (note-discrepancy trace-search draw run judgement))
           (:left-trace (incf (trace-search-left trace-search)) nil)
           (:consistent (note-agreement trace-search draw run))))))

(defun try-sample (trace-search)
  "Run the next sample of TRACE-SEARCH.  Return NIL to go on, or what CONCLUDE returns."
  (let ((draw (next-draw trace-search)))
    (multiple-value-bind (run judgement) (run-and-judge trace-search draw)
      (let ((valid (and run (eq (run-validity run) :valid))))
        (when (and valid (drawn-blindly-p draw))
          (incf (trace-search-accepted trace-search)))
        (multiple-value-prog1
            (cond ((null run)
                   (void trace-search "sample ~d was skipped" (sample-index (drawn-sample draw)))
                   nil)
                  (valid (note-run trace-search draw run judgement))
                  (t (note-rejection trace-search draw run)))
          (report-search (trace-search-search trace-search)
                         (if (drawn-blindly-p draw) :generate :target)
                         :rejected (trace-search-rejected trace-search)
                         :verdict (trace-search-verdict trace-search)))))))

;;; One trace

(defun sample-trace (trace-search)
  "Draw samples until there is something to CONCLUDE, and return that."
  (restart-case
      (loop
        (let ((reason (end-reason (trace-search-search trace-search))))
          (when reason
            (return (conclude-early trace-search reason))))
        (multiple-value-bind (result stop) (try-sample trace-search)
          (when result
            (return (values result stop)))))
    (abort-trace ()
      :report "Leave this trace, undecided, and take the next one."
      (conclude trace-search :undecided "the trace was left before its time"))
    (stop-search ()
      :report "End the search and return what was found."
      (conclude-early trace-search "the search was interrupted"))))

(defun search-trace (search trace)
  "Sample TRACE until the confidence rule is met, a discrepancy ends it, or the search has to end.
Return the TRACE-RESULT, and true if the whole search is to end."
  (handler-case (sample-trace (begin-trace search trace))
    (sampling-error (condition)
      (make-trace-result :trace trace :status :skipped
                         :reason (sampling-error-reason condition)))))

;;; All traces

(defun next-trace-of (search exploration)
  "Return the next trace of EXPLORATION, or NIL if there is none or the search has to end."
  (let ((reason (end-reason search)))
    (if reason
        (progn (setf (search-stopped search) reason) nil)
        (restart-case (in-phase (search :explore) (symbolic:next-trace exploration))
          (stop-search ()
            :report "End the search and return what was found."
            (setf (search-stopped search) (or (end-reason search) "the search was interrupted"))
            nil)))))

(defun exploration-watcher (search-function)
  "Return a function for the option :PROGRESS of an exploration: it ends the search that
SEARCH-FUNCTION returns where it has to end."
  (lambda (exploration)
    (declare (ignore exploration))
    (let ((search (funcall search-function)))
      (report-search search :explore)
      (when (end-reason search)
        (stop-search)))))

(defun search-traces (search exploration)
  (loop for trace = (next-trace-of search exploration)
        while trace
        do (incf (search-iteration search))
           (multiple-value-bind (result stop) (search-trace search trace)
             (push result (search-results search))
             (when stop (return)))))

(defun search-result (search exploration)
  (make-instance 'search-result
                 :plan (search-plan search) :domain (search-domain search)
                 :rule-name (search-rule-name search) :rule (search-rule search)
                 :constraint (search-constraint search) :parameters (search-parameters search)
                 :confidence (confidence-rule-confidence (search-rule search))
                 :seed (search-seed search) :sampler (search-sampler search)
                 :exploration exploration
                 :traces (reverse (search-results search))
                 :simulations (search-simulations search)
                 :phases (search-phases search)
                 :seconds (search-seconds search)
                 :solver-seconds (meter-solver-seconds (search-meter search))
                 :reused (reverse (search-reused search))
                 :stopped (search-stopped search)))

;;; Entry point

(defun constraint-name (exploration)
  "Return the name of the state constraint of EXPLORATION."
  (let ((constraint (symbolic:exploration-constraint exploration)))
    (if (symbolp constraint) constraint (ec:state-constraint-name constraint))))

(defun check-argument (name value test expected &optional reason)
  "Signal INVALID-ARGUMENT unless TEST is true.  Its report is what was EXPECTED, or, where there is
one, the clause REASON."
  (unless test
    (error 'invalid-argument :name name :value value :expected expected :reason reason)))

(defun check-search-names (plan constraint rule parameters max-paths)
  (check-argument 'plan plan (and plan (symbolp plan)) "the name of a plan")
  (check-argument 'constraint constraint (typep constraint '(or symbol cons))
                  "the name of a state constraint, or a formula,")
  (check-argument 'max-paths max-paths (typep max-paths '(integer 1)) "a positive integer")
  (check-argument 'parameters parameters (alexandria:proper-list-p parameters) "a property list")
  (check-argument 'rule rule (symbolp rule) "the name of a confidence rule"))

(defun check-search-arguments (&key seed sampler targets rule delta budget seconds execution
                                 compare comparison on-discrepancy keep-going store traces)
  (check-argument 'seed seed (typep seed '(unsigned-byte 64)) "an integer from 0 to 2^64 - 1")
  (check-argument 'sampler sampler (member sampler *samplers*)
                  ":independent, :stratified, :sobol or :corners")
  (check-argument 'targets targets (or (not targets) (not (member rule '(:paper :paper-sd))))
                  "nil" (format nil "the rule ~(~a~) takes no targets" rule))
  (check-argument 'delta delta (or (null delta) (member rule '(:zero-failure :sound)))
                  "nil" (format nil "the rule ~(~a~) takes no delta" rule))
  (check-argument 'budget budget (typep budget '(integer 1)) "a positive integer")
  (check-argument 'seconds seconds (typep seconds '(or null (real (0)))) "a positive number or nil")
  (check-argument 'keep-going keep-going (typep keep-going '(or boolean (integer 1)))
                  "t, nil or a number of kinds")
  (check-argument 'store store (typep store '(or null string pathname)) "a folder's name or nil")
  (check-argument 'execution execution (member execution '(:trace :plan)) ":trace or :plan")
  (check-argument 'compare compare (member compare '(:final :every-step)) ":final or :every-step")
  (check-argument 'comparison comparison (member comparison '(:consistent :exact))
                  ":consistent or :exact")
  (check-argument 'traces traces
                  (member traces '(:last :every-instance :first-instance :every-state))
                  ":last, :every-instance, :first-instance or :every-state")
  (check-argument 'on-discrepancy on-discrepancy (member on-discrepancy '(:return :signal))
                  ":return or :signal"))

(defun find-discrepancies (plan &key domain constraint (confidence 0.95d0) (rule :paper) delta
                                  (seed 1) (sampler :independent) targets (budget 1000) seconds
                                  keep-going store resume shrink explain progress
                                  parameters arguments (execution :trace)
                                  (compare :final) (comparison :consistent)
                                  (on-discrepancy :return) (max-paths 10000) (traces :last))
  "Search for a discrepancy between the theory and the scene of DOMAIN along PLAN (a symbol) and
return a SEARCH-RESULT.
  DOMAIN          a domain or its name
  CONSTRAINT      the name of the state constraint, or a formula as for MAKE-EXPLORATION; NIL: the
                  theory's only one
  CONFIDENCE      in ]0, 1[, for the confidence RULE: :PAPER, :PAPER-SD, :PREDICTION,
                  :ZERO-FAILURE or :SOUND
  DELTA           in ]0, 1[, for the last two only: the part of a trace's initial region that may
                  be discrepant all the same; NIL: 0.05
  SEED, SAMPLER   the samples are a function of these; :INDEPENDENT, :STRATIFIED, :SOBOL or
                  :CORNERS; guarantees count draws of the first two
  TARGETS         true: every second sample lies where the earlier ones predict the worst; these
                  count for no guarantee; not with the first two rules
  BUDGET          the largest number of simulations, but for those that confirm a discrepancy
  SECONDS         the longest time (s), or NIL
  KEEP-GOING      true: go on after a find; what is of a known kind is counted.  A number: until
                  there are so many kinds
  STORE           NIL, or a folder: the discrepancies that it holds for the same plan, domain,
                  constraint and parameters are tried first, new ones are written into it
  RESUME          NIL, or the file of a journal, made if need be: what a search with the same
                  arguments but for budgets has run is taken from there
  SHRINK, EXPLAIN true: make a discrepancy smaller, and explain it
  PROGRESS        NIL, or a function that is called after each sample, and where another phase
                  begins, with the keyword arguments :PHASE (its name), :TRACE (its number, from
                  1), :SIMULATIONS, :REJECTED (samples of this trace), :DISCREPANCIES (kinds),
                  :SECONDS and :VERDICT (of the confidence rule, or NIL)
  PARAMETERS      a property list of scene parameters that override the scene's
  ARGUMENTS       a list of (parameter type): symbolic arguments of the plan
  EXECUTION       :TRACE (stop where a run leaves the trace) or :PLAN (run to the plan's end)
  COMPARE         :FINAL (compare the final states, as the paper does) or :EVERY-STEP
  COMPARISON      :CONSISTENT (does the theory allow the state?) or :EXACT (is it the trace's?)
  ON-DISCREPANCY  :RETURN, or :SIGNAL DISCREPANCY-FOUND with the restarts CONTINUE-SEARCH,
                  NEXT-TRACE and ACCEPT
  MAX-PATHS       the largest number of paths of the plan to explore
  TRACES          which traces of a path are sampled, as for MAKE-EXPLORATION: :LAST,
                  :EVERY-INSTANCE or :EVERY-STATE
While a search is in progress the restart STOP-SEARCH returns what was found so far, and so does
REQUEST-STOP after the simulation in progress; where a run signals an error there are SKIP-SAMPLE,
RETRY-SAMPLE and ABORT-TRACE.
Signals PLAN-NOT-FOUND, DOMAIN-NOT-FOUND, STATE-CONSTRAINT-NOT-FOUND, INVALID-ARGUMENT,
UNKNOWN-CONFIDENCE-RULE, INVALID-CONFIDENCE, INVALID-DELTA, UNKNOWN-PARAMETER, JOURNAL-ERROR."
  (check-search-names plan constraint rule parameters max-paths)
  (let* ((rule (ec:name-keyword rule))
         (rule-object (apply #'make-confidence-rule rule
                             :confidence confidence (and delta (list :delta delta)))))
    (check-search-arguments :seed seed :sampler sampler :targets targets :rule rule :delta delta
                            :budget budget :seconds seconds :execution execution :compare compare
                            :comparison comparison :on-discrepancy on-discrepancy
                            :keep-going keep-going :store store :traces traces)
    (let* ((plan (ensure-plan plan))
           (domain (ensure-domain domain))
           (parameters (projection:normalized-parameters (domain-scene domain) parameters))
           (domain (domain-with-parameters domain parameters))
           (search nil)
           (exploration (symbolic:make-exploration
                         (plan:plan-name plan) domain
                         :constraint constraint :arguments arguments :max-paths max-paths
                         :traces traces
                         :alternatives (observed-atoms (domain-observers domain))
                         :progress (exploration-watcher (lambda () search)))))
      (setf **stop-requested** nil)
      (unwind-protect
           (z3:with-context (context)
             (setf search (make-instance
                           'search-state
                           :plan plan :domain domain :parameters parameters
                           :constraint (if (consp constraint)
                                           constraint
                                           (constraint-name exploration))
                           :rule rule-object :rule-name rule :seed seed :sampler sampler
                           :targets targets :budget budget :seconds seconds
                           :keep-going keep-going :store store :shrink shrink :explain explain
                           :progress progress :execution execution :compare compare
                           :comparison comparison :on-discrepancy on-discrepancy
                           :context context))
             (with-journal (search resume arguments (list max-paths traces))
               (unless (reuse-stored search)
                 (search-traces search exploration)))
             (search-result search exploration))
        (symbolic:close-exploration exploration)))))
