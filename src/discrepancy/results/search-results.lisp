;;;; What a whole search came to.

(in-package #:discrepancy-finder.discrepancy)

;;; Phases

(defstruct (search-phase (:conc-name phase-) (:constructor make-phase) (:predicate nil)
                         (:copier nil))
  "What a phase of a search cost: SIMULATIONS, the SECONDS that they took, and all its SECONDS."
  (name nil :type keyword :read-only t)
  (simulations 0 :type (integer 0))
  (simulation-seconds 0d0 :type double-float)
  (seconds 0d0 :type double-float))

(defparameter *phases* '(:explore :reuse :generate :target :confirm :shrink :explain :store)
  "The phases of a search, in order.")

(setf (documentation 'phase-name 'function)
      "Return the name of a phase: :EXPLORE (symbolic execution), :REUSE, :GENERATE, :TARGET,
:CONFIRM, :SHRINK, :EXPLAIN or :STORE."
      (documentation 'phase-simulations 'function)
      "Return the number of simulations in a phase."
      (documentation 'phase-simulation-seconds 'function)
      "Return the seconds that the simulations of a phase took."
      (documentation 'phase-seconds 'function)
      "Return the seconds that a phase took, simulations included.")

(defmethod print-object ((phase search-phase) stream)
  (print-unreadable-object (phase stream :type t)
    (format stream "~(~a~), ~d simulation~:p, ~,3f s" (phase-name phase)
            (phase-simulations phase) (phase-seconds phase))))

(defun make-phases ()
  (loop for name in *phases* collect (make-phase :name name)))

(defclass search-result ()
  ((plan :initarg :plan :reader result-plan :documentation "The PLAN.")
   (domain :initarg :domain :reader result-domain
           :documentation "The domain, with the parameters of the search.")
   (constraint :initarg :constraint :reader result-constraint
               :documentation "The name of the state constraint.")
   (parameters :initarg :parameters :reader result-parameters
               :documentation "The property list of the scene parameters of the search.")
   (rule-name :initarg :rule-name :reader result-rule-name
              :documentation "The name of the confidence rule, a keyword.")
   (rule :initarg :rule :reader result-rule :documentation "The rule itself.")
   (confidence :initarg :confidence :reader result-confidence
               :documentation "The confidence asked for.")
   (seed :initarg :seed :reader result-seed
         :documentation "The seed of the blind samples.")
   (sampler :initarg :sampler :reader result-sampler :documentation "The name of the sampler.")
   (exploration :initarg :exploration :reader result-exploration
                :documentation "The EXPLORATION of the plan.")
   (traces :initarg :traces :reader result-traces
           :documentation "The list of the TRACE-RESULTs, in order.")
   (simulations :initarg :simulations :reader result-simulations
                :documentation "The number of simulations that looked for discrepancies: without
those that shrink and explain one.")
   (phases :initarg :phases :reader result-phases
           :documentation "The list of the SEARCH-PHASEs, in order.")
   (seconds :initarg :seconds :reader result-seconds
            :documentation "The seconds that the whole search took.")
   (solver-seconds :initarg :solver-seconds :initform 0d0 :reader result-solver-seconds
                   :documentation "The seconds spent in Z3's checks, in all phases.")
   (reused :initarg :reused :initform '() :reader result-reused
           :documentation "A list of (discrepancies file text): what became of the stored ones.")
   (stopped :initarg :stopped :initform nil :reader result-stopped
            :documentation "Why the search ended before its time, as a clause, or NIL."))
  (:documentation "What a search has found."))

(defun result-discrepancies (result)
  "Return the list of the DISCREPANCYs that RESULT holds, those of the store first."
  (append (remove nil (mapcar #'first (result-reused result)))
          (loop for trace in (result-traces result) append (trace-result-discrepancies trace))))

(defun result-kinds (result)
  "Return the list of (kind . occurrences) of the discrepancies of RESULT; see DISCREPANCY-KIND."
  (let ((kinds '()))
    (dolist (discrepancy (result-discrepancies result) (nreverse kinds))
      (let* ((kind (discrepancy-kind discrepancy))
             (entry (assoc kind kinds :test #'equal)))
        (if entry
            (incf (cdr entry) (discrepancy-occurrences discrepancy))
            (push (cons kind (discrepancy-occurrences discrepancy)) kinds))))))

(defun result-simulation-seconds (result)
  "Return the seconds spent in simulation, in all phases."
  (reduce #'+ (result-phases result) :key #'phase-simulation-seconds))

(defun result-acceptance-rate (result)
  "Return the part of the samples drawn blindly that were valid initial states, in all traces
together; NIL if none was drawn."
  (let ((drawn (reduce #'+ (result-traces result) :key #'trace-result-drawn)))
    (and (plusp drawn)
         (/ (reduce #'+ (result-traces result) :key #'trace-result-accepted)
            (float drawn 1d0)))))

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
              (null (result-stopped result))
              (symbolic:exploration-complete-p (result-exploration result)))
         :certified)
        (t :undecided)))

(defun result-reason (result)
  "Return a sentence without a full stop that says why RESULT has its status."
  (let ((undecided (find :certified (result-traces result) :key #'trace-result-status
                                                           :test-not #'eq)))
    (cond ((result-discrepancies result) "theory and simulation disagree")
          ((and (result-stopped result) (null (result-traces result))) (result-stopped result))
          ((not (symbolic:exploration-consistent-p (result-exploration result)))
           "the theory allows no initial state")
          (undecided (trace-result-reason undecided))
          ((result-stopped result))
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
