;;;; Simulation without a trace: the baseline that guided search is measured against.
;;;;
;;;; A BLIND SEARCH knows nothing of the plan, nor of where that is meant to begin.  Its state space
;;;; is that of the abstraction.  It draws a discrete state: every body that has a placement is in
;;;; one of its regions, every joint in one of its ranges, each as likely as the others.  Then it
;;;; draws continuous states for it, a body anywhere in its region and turned any way, until one is
;;;; valid: nothing penetrates anything, all comes to rest, and the discrete state is then the one
;;;; drawn.  The theory's axioms about states must allow it.  Tolerances are drawn as ever.
;;;;
;;;; What the theory says of the beginning and what can be observed is set aside: that is what is
;;;; drawn.  What it says of the beginning and what cannot be observed, that the arms are parked,
;;;; say, is kept, since the robot does begin so.
;;;;
;;;; The plan runs to its end, and its own events and outcomes are judged by the theory.  The search
;;;; ends with the first discrepancy of a wanted kind.  SIMULATE-BLINDLY is the entry point.

(in-package #:discrepancy-finder.discrepancy)

;;; The theory without what is drawn

(defun has-name-p (formula names)
  "Return true if FORMULA has a term or atom whose name is one of NAMES."
  (and (consp formula)
       (or (member (first formula) names)
           (some (lambda (part) (has-name-p part names)) (rest formula)))))

(defun beginnings (domain)
  "Return the axioms of the theory of DOMAIN that say what can be observed at the beginning."
  (let ((names (mapcar #'first (observed-atoms (domain-observers domain)))))
    (remove-if-not (lambda (axiom)
                     (and (ec:about-the-beginning-p axiom)
                          (has-name-p (ec:axiom-formula axiom) names)))
                   (ec:theory-axioms (symbolic:action-theory-theory domain)))))

(defun domain-beginning-anywhere (domain)
  "Return a domain like DOMAIN whose theory leaves open what can be observed at the beginning.  It
is not registered."
  (changed-domain domain
                  :theory (ec:revised-theory (symbolic:action-theory-theory domain)
                                             :without (mapcar #'ec:axiom-name
                                                              (beginnings domain)))))

;;; Discrete states.  An ALTERNATIVE is (atoms . PARAMETERs): where one body or joint may be, and
;;; what holds then.

(defun whole-range (axis coordinate region)
  "Return the bounds of AXIS of a body that is somewhere in REGION; COORDINATE is what its placement
says of AXIS.  Bodies stand on something: their height is that of the placement or, where that is
not in REGION, the region's top, from which they fall."
  (let ((bounds (rest (assoc axis (region-bounds region)))))
    (cond ((eq axis :yaw) (or bounds (list (- pi) pi)))
          ((null bounds) (coordinate-range coordinate region))
          ((eq axis :z)
           (let ((height (coordinate-range coordinate region)))
             (if (<= (first bounds) (first height) (second height) (second bounds))
                 height
                 (list (second bounds) (second bounds)))))
          (t bounds))))

(defun whole-placement-parameters (placement region)
  "Return the PARAMETERs of the body of PLACEMENT anywhere in REGION."
  (loop for coordinate in (placement-coordinates placement)
        for axis = (first coordinate)
        for (min max) = (whole-range axis coordinate region)
        collect (make-parameter (placement-body placement) axis min max nil
                                (and (not (region-box-p region)) region))))

(defun body-alternatives (domain body)
  "Return the alternatives for BODY: the regions of its placements."
  (loop for placement in (placements domain)
        when (eq (placement-body placement) body)
          append (loop for region in (placement-regions placement)
                       collect (cons (list (placement-atom placement region))
                                     (whole-placement-parameters placement region)))))

(defun joint-alternatives (scene ranges joint)
  "Return the alternatives for JOINT of SCENE: those of RANGES, JOINT-RANGEs, that are its own, and
where it is otherwise."
  (let* ((own (remove joint ranges :key #'joint-range-joint :test-not #'string=))
         (otherwise (some #'joint-range-otherwise own)))
    (flet ((alternative (atoms min max)
             (cons atoms (list (joint-parameter scene joint min max)))))
      (append (loop for range in own
                    collect (alternative (list (joint-range-atom range))
                                         (joint-range-min range) (joint-range-max range)))
              (and otherwise (list (alternative '() (first otherwise) (second otherwise))))))))

(defun initial-choices (domain)
  "Return a list of the alternatives for each body and each joint of DOMAIN."
  (let ((ranges (remove-if-not #'joint-range-p (domain-observers domain))))
    (flet ((distinct (function things)
             (remove-duplicates (mapcar function things) :test #'equal :from-end t)))
      (append (mapcar (lambda (body) (body-alternatives domain body))
                      (distinct #'placement-body (placements domain)))
              (mapcar (lambda (joint)
                        (joint-alternatives (domain-scene domain) ranges joint))
                      (distinct #'joint-range-joint ranges))))))

(defun draw-alternatives (choices seed index)
  "Return one of each of CHOICES, lists of alternatives: a discrete state, a function of the
arguments."
  (loop with content = (content-hash "the discrete state of a simulation without a trace")
        for choice in choices
        for draw from 0
        collect (nth (floor (* (length choice) (unit-float seed content index draw))) choice)))

(defun draw-blindly (domain alternatives seed index)
  "Return a sample of the discrete state ALTERNATIVES of DOMAIN, a function of the arguments."
  (draw-sample (append (mapcan (lambda (alternative) (copy-list (rest alternative))) alternatives)
                       (tolerance-parameters (domain-scene domain)))
               seed (content-hash "a simulation without a trace") index))

(defun settled-state (domain sample)
  "Return the discrete state of DOMAIN to which SAMPLE comes, or NIL if it is not valid."
  (with-open-projection (projection (projection:make-projection
                                     (domain-scene domain)
                                     :poses (sample-poses (domain-scene domain) sample)
                                     :joints (sample-joints sample)
                                     :parameters (sample-tolerances sample)))
    (flet ((valid-p () (eq :valid (sample-validity projection nil '()))))
      (and (valid-p) (projection:settle projection) (valid-p)
           (discrete-state domain projection)))))

(defun comes-to-p (domain sample alternatives choices)
  "Return true if SAMPLE is valid and comes to the discrete state ALTERNATIVES, one of each of
CHOICES."
  (let ((state (settled-state domain sample))
        (drawn (mapcan (lambda (alternative) (copy-list (first alternative))) alternatives)))
    (and state
         (loop for (atoms) in (apply #'append choices)
               always (loop for atom in atoms
                            always (eq (and (member atom drawn :test #'equal) t)
                                       (and (cdr (assoc atom state :test #'equal)) t)))))))

;;; Runs

(defun judge-alone (domain run)
  "Return the JUDGEMENT on RUN, made for no trace, by the theory of DOMAIN; NIL if the theory does
not allow the state in which it begins."
  (call-with-judge
   (lambda (solver state)
     (when (eq (z3:check solver) :sat)
       (multiple-value-bind (consistent divergence)
           (judge-steps domain solver state (run-steps run) nil :consistent)
         (make-judgement :divergence divergence
                         :verdict (if consistent :consistent :discrepancy)))))
   domain (run-initial-state run) nil))

(defstruct (blind-result (:copier nil))
  "What a blind search came to: the number of SIMULATIONS, the number of initial states that were
REJECTED because nothing can be like that or the theory does not allow it, the KINDS of all
discrepancies as a list of (kind . count), the first DISCREPANCY of a wanted kind or NIL, and the
SECONDS that it took."
  (simulations 0 :type (integer 0) :read-only t)
  (rejected 0 :type (integer 0) :read-only t)
  (kinds '() :type list :read-only t)
  (discrepancy nil :read-only t)
  (seconds 0d0 :type double-float :read-only t))

(setf (documentation 'blind-result-simulations 'function)
      "Return the number of simulations of a blind search."
      (documentation 'blind-result-rejected 'function)
      "Return how many initial states of a blind search were drawn and do not count: in them bodies
penetrate each other, or come to rest in another discrete state or not at all, or the theory does
not allow them."
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

(defparameter *draws-per-state* 100
  "When so many samples of a discrete state are not valid another one is drawn.")

(defparameter *draws-per-simulation* 10000
  "When so many initial states in a row are not valid a blind search gives up.")

(defun next-blind-run (domain plan seed index)
  "Return the first run of PLAN that counts, from the samples INDEX, INDEX + 1, ..., the judgement
on it, and its index."
  (loop with choices = (initial-choices domain)
        with alternatives
        for draw from 0 below *draws-per-simulation*
        for number = (+ index draw)
        do (when (zerop (mod draw *draws-per-state*))
             (setf alternatives (draw-alternatives choices seed number)))
           (let ((sample (draw-blindly domain alternatives seed number)))
             (when (comes-to-p domain sample alternatives choices)
               (let* ((run (execute-sample domain plan sample))
                      (judgement (judge-alone domain run)))
                 (when judgement
                   (return (values run judgement number))))))
        finally (error 'sampling-error
                       :trace nil
                       :reason (format nil "~d random initial states in a row were not valid"
                                       *draws-per-simulation*))))

(defun simulate-blindly (plan &key domain (kinds t) (seed 1) (budget 1000) progress)
  "Run PLAN (a symbol) in DOMAIN (a domain or its name) from random initial states, over the whole
state space, until there is a discrepancy of one of KINDS, a list of what DISCREPANCY-KIND returns
(T: of any kind), and return the BLIND-RESULT.  The samples are a function of SEED, an integer of 64
bits; BUDGET is the largest number of simulations.  PROGRESS is NIL or a function that is called
with the number of simulations after each.  Signals PLAN-NOT-FOUND, DOMAIN-NOT-FOUND,
SAMPLING-ERROR."
  (let* ((plan (ensure-plan plan))
         (domain (domain-beginning-anywhere (ensure-domain domain)))
         (start (foreign:monotonic-seconds))
         (index 0) (simulations 0) (met '()) (found nil))
    (loop until (or found (= simulations budget))
          do (multiple-value-bind (run judgement number)
                 (next-blind-run domain (plan:plan-name plan) seed index)
               (setf index (1+ number))
               (incf simulations)
               (when progress
                 (funcall progress simulations))
               (when (eq (judgement-verdict judgement) :discrepancy)
                 (let* ((discrepancy (make-discrepancy
                                      :plan plan :domain domain :execution :plan :seed seed
                                      :sample (run-sample run) :run run :judgement judgement))
                        (kind (discrepancy-kind discrepancy)))
                   (incf (cdr (or (assoc kind met :test #'equal)
                                  (first (push (cons kind 0) met)))))
                   (when (or (eq kinds t) (member kind kinds :test #'equal))
                     (setf found discrepancy))))))
    (make-blind-result :simulations simulations :rejected (- index simulations)
                       :kinds (stable-sort (reverse met) #'> :key #'cdr) :discrepancy found
                       :seconds (- (foreign:monotonic-seconds) start))))
