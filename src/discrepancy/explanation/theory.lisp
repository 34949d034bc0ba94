;;;; Why the theory says what it says: the axioms and the inertia behind a divergence.
;;;;
;;;; A run is told to the bounded reasoner as facts: what is the case at a MOMENT, a timepoint of
;;;; the run, and the events after it.  A CLAIM is a fluent's value after the divergent step, or
;;;; that the step cannot have ended as it did; its minimal core names the axioms.  The shortest
;;;; piece of the run from which the claim follows is taken, one step as a rule, and for each fact
;;;; that the claim rests on its ORIGIN is told: the step that brought it about.  Entry points:
;;;; STATE-CLAIMS, OUTCOME-CLAIM and REQUIREMENT-CLAIM.

(in-package #:discrepancy-finder.discrepancy)

;;; Moments

(defstruct (moment (:copier nil))
  "What is the case at the timepoint TIME of a run: FACTS is a list of (atom . truth), observed or,
where nothing is observed, said by the theory; what follows from other fluents at the same time, as
fluents that are not inertial do, is no fact unless it is observed.  SELF-CONTAINED-P is true if
what happened before does not matter to the theory."
  (time 0 :type (integer 0) :read-only t)
  (facts '() :type list :read-only t)
  (self-contained-p nil :type boolean :read-only t))

(defun moment-of (ground solver candidates time observed)
  "Return the moment at TIME in which one of CANDIDATES is the case and OBSERVED was seen."
  (make-moment
   :time time
   :facts (append observed
                  (loop with others = (ec:theory-non-inertial (ec:ground-theory-theory ground))
                        for atom across (ec:ground-theory-fluents ground)
                        for value = (if (or (member (first atom) others)
                                            (assoc atom observed :test #'equal))
                                        :open
                                        (theory-value solver candidates atom))
                        unless (eq value :open) collect (cons atom value)))
   :self-contained-p (loop for (state) in candidates always (ec:self-contained-p state))))

(defun run-moments (domain run trace last)
  "Return the vector of the moments of RUN from its beginning to the timepoint LAST, before step
LAST."
  (let ((ground (symbolic:action-theory-ground domain))
        (moments '()))
    (call-with-judge
     (lambda (solver state)
       (push (moment-of ground solver (list (cons state t)) 0 (run-initial-state run)) moments)
       (when (plusp last)
         (map-steps (lambda (number step kind fluents candidates)
                      (declare (ignore kind fluents))
                      (push (moment-of ground solver candidates (1+ number) (run-step-state step))
                            moments)
                      (= (1+ number) last))
                    domain solver state (run-steps run) trace :consistent)))
     domain (run-initial-state run) nil)
    (coerce (reverse moments) 'vector)))

(defun moment-value (moment atom)
  "Return what is the case with ATOM at MOMENT: T, NIL or :OPEN."
  (let ((fact (assoc atom (moment-facts moment) :test #'equal)))
    (if fact (cdr fact) :open)))

(defun seen-event (step)
  "Return the event that STEP was for the theory, or NIL."
  (let ((outcome (first (run-step-candidates step))))
    (and outcome (symbolic:outcome-event outcome))))

;;; A piece of a run as a theory

(defparameter *fact-prefix* "OBSERVED-IN-THE-RUN-"
  "How the names of the axioms begin that tell what was the case at a moment.")

(defparameter *event-prefix* "STEP-OF-THE-RUN-"
  "How the names of the axioms begin that tell what happened.")

(defparameter *outcome-name* :outcome-of-the-run
  "The name of the axiom that tells under which condition a step can end as it did.")

(defun numbered-name (prefix number)
  (make-symbol (format nil "~a~d" prefix number)))

(defun numbered-p (name prefix)
  "Return the number in NAME, a symbol, if it begins with PREFIX, or NIL."
  (let ((name (symbol-name name)))
    (and (alexandria:starts-with-subseq prefix name)
         (parse-integer name :start (length prefix) :junk-allowed t))))

(defun told-p (name)
  "Return true if NAME is that of an axiom that tells the run."
  (or (numbered-p name *fact-prefix*) (numbered-p name *event-prefix*)
      (eq name *outcome-name*)))

(defun literal-form (atom truth &optional time)
  "Return the formula that the fluent ATOM has the value TRUTH, at TIME if that is given."
  (let ((form (if time (list :holds-at atom time) atom)))
    (if truth form (list :not form))))

(defun piece-of-run (domain moment run last &key event condition)
  "Return the theory of DOMAIN with the facts of MOMENT and the events of the steps of RUN from
there to the step before LAST; with EVENT, a list, that happens in step LAST, and the CONDITION, a
formula about that time.  What the theory says of the beginning is left out unless MOMENT is the
beginning."
  (let ((theory (symbolic:action-theory-theory domain))
        (first (moment-time moment)))
    (ec:revised-theory
     theory
     :without (and (plusp first)
                   (mapcar #'ec:axiom-name
                           (remove-if-not #'ec:about-the-beginning-p (ec:theory-axioms theory))))
     :with (append
            (loop for (atom . truth) in (moment-facts moment)
                  for number from 0
                  collect (list (numbered-name *fact-prefix* number)
                                (list :initially (literal-form atom truth))))
            (loop for number from first below last
                  for event = (seen-event (nth number (run-steps run)))
                  when event
                    collect (list (numbered-name *event-prefix* number)
                                  (list :happens event number)))
            (and event
                 (list (list (numbered-name *event-prefix* last) (list :happens event last))))
            (and condition (list (list *outcome-name* condition))))
     :complete-events t)))

(defun call-with-pieces (function moments last)
  "Call FUNCTION with later and earlier ones of MOMENTS, at most at LAST, until it returns true, and
return that and the moment.  Pieces of the run begin only where nothing before matters."
  (loop for back = 0 then (if (zerop back) 1 (* 2 back))
        for time = (max 0 (- last back))
        for moment = (svref moments time)
        do (when (or (zerop time) (moment-self-contained-p moment))
             (let ((answer (handler-case (funcall function moment)
                             (ec:event-calculus-error () nil))))
               (when answer (return (values answer moment)))))
        until (zerop time)))

;;; Claims

(defstruct (origin (:copier nil))
  "That the fluent ATOM has had the value TRUTH since STEP, counted from 0, whose event is EVENT, by
AXIOMS, names; STEP is NIL if it has been so from the beginning."
  (atom '() :type list :read-only t)
  (truth nil :type boolean :read-only t)
  (step nil :type (or null (integer 0)) :read-only t)
  (event '() :type list :read-only t)
  (axioms '() :type list :read-only t))

(defstruct (claim (:copier nil))
  "What the theory says of FLUENTS, a list of (atom . truth), after a step, or, where that is empty,
that the step cannot have ended as it did.  EXPLANATIONS are the reasoner's, as a rule one; AXIOMS
are the names of the theory's axioms in them, PERSISTENT a list of (atom truth event) for what
persists by inertia through an event, ORIGINS those of the facts that the claim rests on."
  (fluents '() :type list :read-only t)
  (explanations '() :type list :read-only t)
  (axioms '() :type list :read-only t)
  (persistent '() :type list :read-only t)
  (facts '() :type list :read-only t)
  (origins '() :type list :read-only t))

(defun cited-facts (explanation moment)
  "Return the facts of MOMENT that EXPLANATION rests on, a list of (atom . truth)."
  (loop for name in (ec:explanation-axioms explanation)
        for number = (numbered-p name *fact-prefix*)
        when number collect (nth number (moment-facts moment))))

(defun own-axioms (explanation)
  "Return the names of the theory's own axioms that EXPLANATION rests on."
  (remove-if #'told-p (ec:explanation-axioms explanation)))

(defun origin-of (domain moments run time atom truth)
  "Return the origin of the fact, at the timepoint TIME of RUN, that ATOM has the value TRUTH."
  (let ((since (loop for number downfrom time to 1
                     unless (eq (moment-value (svref moments (1- number)) atom) truth)
                       return number)))
    (if (null since)
        (make-origin :atom atom :truth truth)
        (let ((explanation (value-explanation domain moments run (1- since) atom truth)))
          (make-origin :atom atom :truth truth :step (1- since)
                       :event (seen-event (nth (1- since) (run-steps run)))
                       :axioms (and explanation (own-axioms explanation)))))))

(defun claim-of (domain moments run explanation moment fluents)
  "Return the claim of FLUENTS by EXPLANATION, of the piece of RUN that begins at MOMENT."
  (let ((facts (and explanation (cited-facts explanation moment))))
    (make-claim
     :fluents fluents :explanations (and explanation (list explanation)) :facts facts
     :axioms (and explanation (own-axioms explanation))
     :persistent (and explanation
                      (loop for (atom time) in (ec:explanation-persistent explanation)
                            for truth = (if (< time (length moments))
                                            (moment-value (svref moments time) atom)
                                            :open)
                            for step = (nth time (run-steps run))
                            unless (eq truth :open)
                              collect (list atom truth (and step (seen-event step)))))
     :origins (loop for (atom . truth) in facts
                    collect (origin-of domain moments run (moment-time moment) atom truth)))))

;;; After a step

(defun form-explanation (domain moments run number event form)
  "Return why FORM is true where EVENT happens in step NUMBER of RUN, or NIL, and the moment from
which it follows."
  (call-with-pieces (lambda (moment)
                      (ec:why (piece-of-run domain moment run number :event event) form
                              :horizon (list (moment-time moment) (1+ number))))
                    moments number))

(defun value-explanation (domain moments run number atom truth)
  "Return why the theory says that ATOM has the value TRUTH after step NUMBER of RUN, or NIL, and
the moment from which it follows."
  (fluents-explanation domain moments run number (seen-event (nth number (run-steps run)))
                       (list (cons atom truth))))

(defun fluents-explanation (domain moments run number event fluents)
  "Return why the theory says that after EVENT in step NUMBER of RUN not all of FLUENTS, a list of
\(atom . truth), have the opposite values, and the moment from which it follows; or NIL."
  (form-explanation domain moments run number event
                    (if (rest fluents)
                        (cons :or (loop for (atom . truth) in fluents
                                        collect (literal-form atom truth (1+ number))))
                        (literal-form (car (first fluents)) (cdr (first fluents))
                                      (1+ number)))))

(defun state-claims (domain moments run number event differing)
  "Return the claims of the theory of DOMAIN about DIFFERING, a list of (atom theory-value
simulation-value), after EVENT in step NUMBER of RUN: one for each, or one for all together where
the theory says nothing of each by itself."
  (let* ((fluents (loop for (atom theory) in differing collect (cons atom theory)))
         (claims (loop for fluent in fluents
                       collect (multiple-value-bind (explanation moment)
                                   (fluents-explanation domain moments run number event
                                                        (list fluent))
                                 (claim-of domain moments run explanation moment
                                           (list fluent))))))
    (cond ((or (some #'claim-explanations claims) (null (rest fluents))) claims)
          (t (multiple-value-bind (explanation moment)
                 (fluents-explanation domain moments run number event fluents)
               (if explanation
                   (list (claim-of domain moments run explanation moment fluents))
                   claims))))))

;;; The end of a step

(defun outcome-explanation (domain moments run number outcome)
  "Return why the theory of DOMAIN does not allow OUTCOME in step NUMBER of RUN, or NIL, and the
moment from which it follows."
  (let* ((formula (symbolic:outcome-condition outcome))
         (condition (and (not (eq formula t))
                         (ec:formula-form (symbolic:action-theory-ground domain) formula
                                          number))))
    (call-with-pieces (lambda (moment)
                        (ec:why-inconsistent
                         (piece-of-run domain moment run number
                                       :event (symbolic:outcome-event outcome)
                                       :condition condition)
                         :horizon (list (moment-time moment) (1+ number))))
                      moments number)))

(defun joined-claim (claims)
  "Return one claim that rests on what CLAIMS rest on."
  (flet ((all (reader &optional (key #'identity))
           (remove-duplicates (loop for claim in claims append (funcall reader claim))
                              :test #'equal :key key :from-end t)))
    (make-claim :explanations (all #'claim-explanations) :axioms (all #'claim-axioms)
                :persistent (all #'claim-persistent) :facts (all #'claim-facts)
                :origins (all #'claim-origins #'origin-atom))))

(defun requirement-claim (domain moments run number formula)
  "Return the claim that FORMULA, the condition of an outcome, held before step NUMBER of RUN, each
part of it; or NIL if there is none or that does not follow."
  (let* ((form (and (consp formula)
                    (ec:formula-form (symbolic:action-theory-ground domain) formula number)))
         (claims (loop for part in (if (eq (first form) :and)
                                       (rest form)
                                       (and form (list form)))
                       collect (multiple-value-bind (explanation moment)
                                   (form-explanation domain moments run number nil part)
                                 (and explanation
                                      (claim-of domain moments run explanation moment '()))))))
    (and claims (every #'identity claims)
         (joined-claim claims))))

(defun outcome-claim (domain moments run number outcome)
  "Return the claim that step NUMBER of RUN cannot have ended with OUTCOME."
  (let ((condition (symbolic:outcome-condition outcome)))
    (or (and (null (symbolic:outcome-event outcome))
             (consp condition) (eq (first condition) :not)
             (requirement-claim domain moments run number (second condition)))
        (multiple-value-bind (explanation moment)
            (outcome-explanation domain moments run number outcome)
          (claim-of domain moments run explanation moment '())))))
