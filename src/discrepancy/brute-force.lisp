;;;; Simulation without a trace: the baseline that guided search is measured against.
;;;;
;;;; A BLIND SEARCH knows nothing of the plan.  It draws a discrete initial state evenly from those
;;;; that the theory allows, and a continuous one from all that map to it: where the domain's
;;;; observers name a range to draw from, a body may here be anywhere in its region, turned any way.
;;;; The plan runs to its end, and its own events and outcomes are judged by the theory.  The search
;;;; ends with the first discrepancy of a wanted kind.
;;;;
;;;; SIMULATE-BLINDLY is the entry point.

(in-package #:discrepancy-finder.discrepancy)

;;; Discrete initial states

(defparameter *initial-state-limit* 1000
  "More discrete initial states than this are not enumerated.")

(defun state-key (state)
  "Return a string that orders STATE, a list of (atom . truth), among others."
  (format nil "~{~a ~}" (mapcar #'ec:atom-text (observed-fluents state))))

(defun allowed-initial-states (domain)
  "Return the list of the initial states that the theory of DOMAIN allows, as far as they can be
observed: lists of (atom . truth).  Signals SAMPLING-ERROR if there are more than a limit."
  (let ((atoms (observed-atoms (domain-observers domain)))
        (states '()))
    (z3:with-context (context)
      (z3:with-solver (solver context)
        (let ((state (free-state (symbolic:action-theory-ground domain) context '())))
          (loop for (nil . proposition) in (ec:initial-conditions state)
                do (z3:solver-assert solver proposition))
          (loop while (eq (z3:check solver) :sat)
                do (when (>= (length states) *initial-state-limit*)
                     (error 'sampling-error
                            :trace nil :reason (format nil "the theory allows more than ~d initial ~
                                                            states" *initial-state-limit*)))
                   (push (loop for atom in atoms
                               collect (cons atom (z3:model-value
                                                   solver (ec:fluent-value state atom))))
                         states)
                   (z3:solver-assert
                    solver
                    (z3:negation (z3:conjunction (observation state (first states))))))
          (sort states #'string< :key #'state-key))))))

;;; All of the continuous states that map to one

(defun whole-range (axis coordinate region)
  "Return the bounds of AXIS of a body that is somewhere in REGION; COORDINATE is what its placement
says of AXIS.  Bodies stand on something: their height is that of the placement."
  (let ((bounds (rest (assoc axis (region-bounds region)))))
    (cond ((eq axis :yaw) (or bounds (list (- pi) pi)))
          ((and bounds (not (eq axis :z))) bounds)
          (t (coordinate-range coordinate region)))))

(defun whole-placement-parameters (placement region)
  (loop for coordinate in (placement-coordinates placement)
        for axis = (first coordinate)
        for (min max) = (whole-range axis coordinate region)
        collect (make-parameter (placement-body placement) axis min max nil
                                (and (not (region-box-p region)) region))))

(defun whole-state-parameters (domain state)
  "Return the PARAMETERs whose values are the continuous states that map to STATE, a list of (atom .
truth)."
  (flet ((true-p (atom) (cdr (assoc atom state :test #'equal))))
    (append
     (loop for placement in (placements domain)
           append (loop for region in (placement-regions placement)
                        when (true-p (placement-atom placement region))
                          append (whole-placement-parameters placement region)))
     (loop for range in (remove-if-not #'joint-range-p (domain-observers domain))
           for (min max) = (if (true-p (joint-range-atom range))
                               (list (joint-range-min range) (joint-range-max range))
                               (joint-range-otherwise range))
           when min collect (make-parameter (joint-range-joint range) :position min max))
     (tolerance-parameters (domain-scene domain)))))

;;; Runs

(defun judge-alone (domain run)
  "Return the JUDGEMENT on RUN, made for no trace, by the theory of DOMAIN."
  (multiple-value-bind (consistent divergence)
      (judged-steps domain (run-initial-state run) (run-steps run))
    (make-judgement :divergence divergence
                    :verdict (if consistent :consistent :discrepancy))))

(defun mapped-p (run state)
  "Return true if RUN began in STATE, a list of (atom . truth)."
  (and (eq (run-validity run) :valid)
       (loop for (atom . truth) in state
             always (eq truth (and (cdr (assoc atom (run-initial-state run) :test #'equal)) t)))))

(defstruct (blind-result (:copier nil))
  "What a blind search came to: the number of SIMULATIONS, the number of initial states that were
REJECTED because nothing can be like that, the KINDS of all discrepancies as a list of (kind .
count), the first DISCREPANCY of a wanted kind or NIL, and the SECONDS that it took."
  (simulations 0 :type (integer 0) :read-only t)
  (rejected 0 :type (integer 0) :read-only t)
  (kinds '() :type list :read-only t)
  (discrepancy nil :read-only t)
  (seconds 0d0 :type double-float :read-only t))

(setf (documentation 'blind-result-simulations 'function)
      "Return the number of simulations of a blind search."
      (documentation 'blind-result-rejected 'function)
      "Return how many initial states of a blind search were drawn and not simulated: in them bodies
penetrate each other, or come to rest in another discrete state."
      (documentation 'blind-result-kinds 'function)
      "Return the list of (kind . count) of the discrepancies that a blind search has met."
      (documentation 'blind-result-discrepancy 'function)
      "Return the discrepancy with which a blind search ended, or NIL."
      (documentation 'blind-result-seconds 'function)
      "Return the seconds (s) that a blind search took.")

(defmethod print-object ((result blind-result) stream)
  (print-unreadable-object (result stream :type t)
    (format stream "~:[nothing~;~:*~a~] in ~d simulation~:p"
            (and (blind-result-discrepancy result)
                 (kind-text (blind-result-discrepancy result)))
            (blind-result-simulations result))))

(defun draw-blindly (domain states seed index)
  "Return sample INDEX of a blind search, and its discrete state, one of STATES."
  (let* ((content (content-hash "a simulation without a trace"))
         (state (nth (floor (* (length states) (unit-float seed content index 65535))) states)))
    (values (draw-sample (whole-state-parameters domain state) seed content index) state)))

(defparameter *draws-per-simulation* 1000
  "When so many initial states in a row are not valid a blind search gives up.")

(defun next-blind-run (domain plan states seed index)
  "Return the first valid run of PLAN from the samples INDEX, INDEX + 1, ..., and its index."
  (loop for number from index repeat *draws-per-simulation*
        do (multiple-value-bind (sample state) (draw-blindly domain states seed number)
             (let ((run (execute-sample domain plan sample)))
               (when (mapped-p run state)
                 (return (values run number)))))
        finally (error 'sampling-error
                       :trace nil
                       :reason (format nil "~d random initial states in a row were not valid"
                                       *draws-per-simulation*))))

(defun blind-discrepancy (plan domain seed run)
  "Return the DISCREPANCY that RUN of PLAN is, or NIL."
  (let ((judgement (judge-alone domain run)))
    (and (eq (judgement-verdict judgement) :discrepancy)
         (make-discrepancy :plan plan :domain domain :execution :plan :seed seed
                           :sample (run-sample run) :run run :judgement judgement))))

(defun simulate-blindly (plan &key domain (kinds t) (seed 1) (budget 1000) progress)
  "Run PLAN (a symbol) in DOMAIN (a domain or its name) from random initial states, over the whole
state space, until there is a discrepancy of one of KINDS, a list of what DISCREPANCY-KIND returns
(T: of any kind), and return the BLIND-RESULT.  The samples are a function of SEED, an integer of 64
bits; BUDGET is the largest number of simulations.  PROGRESS is NIL or a function that is called
with the number of simulations after each.  Signals PLAN-NOT-FOUND, DOMAIN-NOT-FOUND,
SAMPLING-ERROR."
  (let* ((plan (ensure-plan plan))
         (domain (ensure-domain domain))
         (states (or (allowed-initial-states domain)
                     (error 'sampling-error :trace nil
                                            :reason "the theory allows no initial state")))
         (start (foreign:monotonic-seconds))
         (index 0) (simulations 0) (met '()) (found nil))
    (loop until (or found (= simulations budget))
          do (multiple-value-bind (run number)
                 (next-blind-run domain (plan:plan-name plan) states seed index)
               (setf index (1+ number))
               (incf simulations)
               (when progress
                 (funcall progress simulations))
               (let* ((discrepancy (blind-discrepancy plan domain seed run))
                      (kind (and discrepancy (discrepancy-kind discrepancy))))
                 (when discrepancy
                   (incf (cdr (or (assoc kind met :test #'equal)
                                  (first (push (cons kind 0) met)))))
                   (when (or (eq kinds t) (member kind kinds :test #'equal))
                     (setf found discrepancy))))))
    (make-blind-result :simulations simulations :rejected (- index simulations)
                       :kinds (stable-sort (reverse met) #'> :key #'cdr) :discrepancy found
                       :seconds (- (foreign:monotonic-seconds) start))))
