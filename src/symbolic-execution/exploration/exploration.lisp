;;;; Explorations: all paths of a plan, by replay.
;;;;
;;;; An EXPLORATION hands out traces one by one (NEXT-TRACE, in next-trace.lisp).  It keeps a
;;;; frontier of prefixes; for each it runs the plan again from the start, repeating the prefix's
;;;; decisions, and adds the alternatives met behind it.  What a bound cuts off is a GAP, a
;;;; sentence.

(in-package #:discrepancy-finder.symbolic-execution)

(defclass exploration ()
  ((plan :initarg :plan :reader exploration-plan :documentation "The plan, a PLAN.")
   (domain :initarg :domain :reader exploration-domain :documentation "The ACTION-THEORY.")
   (constraint :initarg :constraint :reader exploration-constraint
               :documentation "The STATE-CONSTRAINT.")
   (formula :initarg :formula :reader exploration-formula
            :documentation "The constraint's ground formula.")
   (types :initarg :types :reader exploration-types
          :documentation "What PARAMETER-TYPES returns.")
   (traces :initarg :traces :reader exploration-mode :documentation "See PATH-TRACES.")
   (alternatives :initarg :alternatives :reader exploration-alternatives
                 :documentation "The atoms in which alternatives of traces differ.")
   (order :initarg :order :reader exploration-order
          :documentation "The order of the paths, a keyword.")
   (seed :initarg :seed :reader exploration-seed :documentation "The seed of the order :RANDOM.")
   (interleavings :initarg :interleavings :reader exploration-interleavings)
   (recorder :initarg :recorder :reader exploration-recorder)
   (uses :initform (make-hash-table :test 'eq) :reader exploration-uses
         :documentation "The LISP-USE of each branch.")
   (file-output :initarg :file-output :reader exploration-file-output)
   (keep-errors :initarg :keep-errors :reader exploration-keep-errors)
   (max-paths :initarg :max-paths :reader exploration-max-paths)
   (max-steps :initarg :max-steps :reader exploration-max-steps)
   (max-jumps :initarg :max-jumps :reader exploration-max-jumps)
   (max-seconds :initarg :max-seconds :reader exploration-max-seconds)
   (progress :initarg :progress :reader exploration-progress
             :documentation "A function of the exploration, called once a second; or NIL.")
   (oracle :initarg :oracle :reader exploration-oracle)
   (frontier :initarg :frontier :reader exploration-frontier)
   (initial-state :initform nil :accessor exploration-initial-state
                  :documentation "(epoch . symbolic initial state).")
   (source :initform nil :accessor exploration-source
           :documentation "A function that returns the next trace of the path that was run last.")
   (run :initform nil :accessor exploration-run
           :documentation "The RUN of the path that was run last.")
   (seen :initform (make-hash-table :test 'equal) :reader exploration-seen
         :documentation "The keys of the traces handed out.")
   (found :initform '() :accessor exploration-found)
   (paths :initform 0 :accessor exploration-paths
          :documentation "The number of runs.")
   (dead-ends :initform 0 :accessor exploration-dead-ends
              :documentation "The number of paths that end because the theory allows no outcome.")
   (steps :initform 0 :accessor exploration-steps
          :documentation "The number of performs, repeated ones included.")
   (gaps :initform '() :accessor exploration-gaps
         :documentation "What was not explored: a list of sentences.")
   (consistent :initform t :accessor exploration-consistent-p
               :documentation "False if the theory allows no initial state at all.")
   (time :initform 0d0 :accessor exploration-time)
   (reported :initform nil :accessor exploration-reported
             :documentation "When PROGRESS was called last."))
  (:documentation "A search for the traces of a plan on which a state constraint comes true."))

(defun exploration-traces (exploration)
  "Return the list of the traces that EXPLORATION has found so far, in order."
  (reverse (exploration-found exploration)))

(defun exploration-checks (exploration)
  "Return the number of questions that EXPLORATION has put to Z3."
  (oracle-checks (exploration-oracle exploration)))

(defun exploration-seconds (exploration)
  "Return the seconds spent in EXPLORATION so far, and of them the seconds in Z3."
  (values (exploration-time exploration)
          (oracle-seconds (exploration-oracle exploration))))

(defun exploration-pending (exploration)
  "Return the number of prefixes that EXPLORATION knows and has not run yet."
  (frontier-size (exploration-frontier exploration)))

(defun exploration-complete-p (exploration)
  "Return true if EXPLORATION has run every path and nothing was cut off."
  (and (frontier-empty-p (exploration-frontier exploration))
       (null (exploration-source exploration))
       (null (exploration-gaps exploration))))

(defun exploration-statistics (exploration)
  "Return the figures of EXPLORATION as a property list: :PATHS, :TRACES, :DEAD-ENDS and :PENDING
prefixes, :STEPS (performs, repeated ones included), :DECISIONS (first meetings of places where the
theory or the arguments might leave a choice), :CHECKS by Z3, of them :DECISION-CHECKS made for
decisions, :CHECKS-PER-DECISION (the quotient of these, or NIL), :UNKNOWNS (checks that Z3 could not
answer), :SECONDS in all, :SOLVER-SECONDS in Z3, :EVALUATION-SECONDS elsewhere."
  (let ((oracle (exploration-oracle exploration)))
    (multiple-value-bind (seconds solver-seconds) (exploration-seconds exploration)
      (list :paths (exploration-paths exploration)
            :traces (length (exploration-found exploration))
            :dead-ends (exploration-dead-ends exploration)
            :pending (exploration-pending exploration)
            :steps (exploration-steps exploration)
            :decisions (oracle-decisions oracle)
            :checks (oracle-checks oracle)
            :decision-checks (oracle-decision-checks oracle)
            :checks-per-decision (and (plusp (oracle-decisions oracle))
                                      (/ (oracle-decision-checks oracle)
                                         (float (oracle-decisions oracle) 1d0)))
            :unknowns (oracle-unknowns oracle)
            :seconds seconds
            :solver-seconds solver-seconds
            :evaluation-seconds (max 0d0 (- seconds solver-seconds))))))

(defmethod print-object ((exploration exploration) stream)
  (print-unreadable-object (exploration stream :type t)
    (format stream "of ~(~a~): ~d trace~:p on ~d path~:p, ~:[incomplete~;complete~]"
            (plan:plan-name (exploration-plan exploration))
            (length (exploration-found exploration)) (exploration-paths exploration)
            (exploration-complete-p exploration))))

(defun describe-figures (exploration stream)
  (destructuring-bind (&key dead-ends decisions checks checks-per-decision unknowns seconds
                         solver-seconds pending &allow-other-keys)
      (exploration-statistics exploration)
    (format stream "  ~d dead end~:p, ~d decision~:p, ~d check~:p by Z3~@[, ~,1f a decision~]~%"
            dead-ends decisions checks checks-per-decision)
    (format stream "  ~,2f s, of these ~,2f s in Z3~%" seconds solver-seconds)
    (when (eq (exploration-order exploration) :random)
      (format stream "  paths at random, seed ~d~%" (exploration-seed exploration)))
    (when (plusp unknowns)
      (format stream "  ~d check~:p without an answer~%" unknowns))
    (when (plusp pending)
      (format stream "  ~d path~:p or more not run~%" pending))
    (format stream "~{  not explored: ~a~%~}" (exploration-gaps exploration))))

(defmethod describe-object ((exploration exploration) stream)
  (format stream "~a~%" exploration)
  (loop for trace in (exploration-traces exploration)
        for number from 1
        do (format stream "  trace ~d: initially~{ ~a~}~%" number
                   (mapcar #'ec:atom-text (ec:state-fluents (trace-initial-state trace))))
           (loop for step in (trace-steps trace)
                 do (format stream "    ~a: ~a~%" (step-designator step) (step-text step)))
           (format stream "    finally~{ ~a~}~%"
                   (mapcar #'ec:atom-text (ec:state-fluents (trace-final-state trace)))))
  (describe-figures exploration stream))

(defun close-exploration (exploration)
  "Release the Z3 context of EXPLORATION; its traces and figures stay."
  (close-oracle (exploration-oracle exploration)))

;;; Making one

(defun any-action-p (constraint)
  (and (symbolp constraint) constraint (string= constraint "ANY-ACTION")))

(defun resolve-constraint (constraint domain)
  "Return what CONSTRAINT, as MAKE-EXPLORATION has it, means in DOMAIN: a STATE-CONSTRAINT, or
:ANY-ACTION."
  (let ((theory (action-theory-theory domain)))
    (cond ((ec:state-constraint-p constraint) constraint)
          ((and (any-action-p constraint)
                (not (find :any-action (ec:theory-state-constraints theory)
                           :key #'ec:state-constraint-name)))
           :any-action)
          ((consp constraint)
           (ec:parse-state-constraint theory (list :in-the-call '(?time) constraint)))
          (t (ec:find-state-constraint constraint theory)))))

(defun check-option (name value expected valid)
  (unless valid
    (error 'unsupported-form :form (list name value)
                             :reason (format nil "~a was expected" expected))))

(defun check-bounds (&rest bounds)
  (loop for (name value) on bounds by #'cddr
        do (check-option name value "a natural number" (typep value '(integer 0)))))

(defun make-exploration (plan domain
                         &key constraint arguments (traces :last) alternatives
                           (order :depth-first) (seed 0) (max-paths 10000) (max-steps 1000)
                           (max-jumps 1000000) max-seconds interleavings coverage file-output
                           progress solver-timeout solver-options (on-unknown :keep) keep-errors)
  "Return an EXPLORATION of the plan named PLAN (a symbol) in DOMAIN (an ACTION-THEORY or its name).
  CONSTRAINT  a state constraint, its name, or a formula over ?time and (+ ?time n); with NIL the
              theory's only one; :ANY-ACTION: each performed action ends a trace
  ARGUMENTS   list of (parameter type), the plan's symbolic arguments
  TRACES      :LAST, a path is cut after the last time at which the constraint holds on it;
              :EVERY-INSTANCE, each prefix of a path that ends in an instance is a trace, or
              :FIRST-INSTANCE, the shortest; :EVERY-STATE, as :LAST, from every initial state
  ALTERNATIVES  a list of ground atoms: each trace is handed out with its TRACE-ALTERNATIVES, which
              differ in the truth of some of these initially; not with :EVERY-STATE
  ORDER       of the paths: :DEPTH-FIRST, :BREADTH-FIRST, :RANDOM with SEED, or :COVERAGE: options
              that were never taken come first
  MAX-PATHS, MAX-STEPS (performs on a path), MAX-JUMPS (iterations of loops and retries on a path)
              and MAX-SECONDS (in all, or NIL) bound the search; what they cut off is a gap
  INTERLEAVINGS  with NIL tasks that run in parallel take turns in one fixed order, with T all
              orders are explored in which the outcome can differ, with :ALL all orders
  COVERAGE    true if what is evaluated, taken and exercised is to be recorded, see COVERAGE
  FILE-OUTPUT true if the plan may write files: no run's writing is undone
  KEEP-ERRORS true if an error that the plan does not handle only ends its path, instead of being
              signaled as PLAN-BROKE
  PROGRESS    a function that is called with the exploration, at most once a second
  SOLVER-TIMEOUT (s, or NIL) and SOLVER-OPTIONS are for Z3, see Z3:MAKE-SOLVER
  ON-UNKNOWN  :KEEP, what Z3 cannot answer is taken for possible, and a gap; or :SIGNAL
              SOLVER-UNKNOWN with its restarts
Signals PLAN-NOT-FOUND, DOMAIN-NOT-FOUND, STATE-CONSTRAINT-NOT-FOUND, THEORY-ERROR,
UNSUPPORTED-FORM."
  (check-option :traces traces "one of :last, :every-instance, :first-instance, :every-state"
                (member traces '(:last :every-instance :first-instance :every-state)))
  (check-option :order order "one of :depth-first, :breadth-first, :random, :coverage"
                (member order '(:depth-first :breadth-first :random :coverage)))
  (check-option :interleavings interleavings "one of nil, t, :all"
                (member interleavings '(nil t :all)))
  (check-option :on-unknown on-unknown "one of :keep, :signal" (member on-unknown '(:keep :signal)))
  (check-option :max-seconds max-seconds "a number of seconds"
                (typep max-seconds '(or null (real 0))))
  (check-option :solver-timeout solver-timeout "a number of seconds"
                (typep solver-timeout '(or null (real (0)))))
  (check-bounds :max-paths max-paths :max-steps max-steps :max-jumps max-jumps :seed seed)
  (let* ((plan (plan:find-plan plan))
         (domain (if (typep domain 'action-theory) domain (find-action-theory domain)))
         (ground (action-theory-ground domain))
         (constraint (resolve-constraint constraint domain))
         (any-action (eq constraint :any-action))
         (types (parameter-types plan arguments)))
    (make-instance 'exploration
                   :plan plan :domain domain :constraint constraint :types types
                   :formula (or any-action
                                (ec:ground-formula ground
                                                   (ec:state-constraint-formula constraint)))
                   :traces (if (and any-action (eq traces :last)) :every-instance traces)
                   :alternatives (if (eq traces :every-state) '() alternatives)
                   :order order :seed seed :interleavings interleavings
                   :recorder (and coverage (make-recorder))
                   :file-output (and file-output t) :keep-errors (and keep-errors t)
                   :max-paths max-paths :max-steps max-steps :max-jumps max-jumps
                   :max-seconds max-seconds :progress progress
                   :frontier (make-frontier order seed)
                   :oracle (make-path-oracle
                            ground
                            :numeric (some (lambda (entry)
                                             (and (consp entry)
                                                  (numeric-argument-type-p (second entry))))
                                           types)
                            :timeout solver-timeout :options solver-options
                            :signals-unknown (eq on-unknown :signal)))))
