;;;; Explanations: why theory and simulation part, and what can be done about it.
;;;;
;;;; An EXPLANATION says which axioms, and which inertia, made the theory say what it says at the
;;;; divergent step; which coordinates of the initial state decide, and between which values; and
;;;; which edits of the theory would help.  Its GROUNDS are what the theory's side rests on: a
;;;; verdict on a plan that rests on the same is in doubt (review.lisp).  EXPLAIN-DISCREPANCY is the
;;;; entry point; explain-text.lisp has the words.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (explanation (:copier nil))
  "Why theory and simulation part in a discrepancy at STEP, counted from 0.  CLAIMS are what the
theory says after the step, or would have said; ENDING is its claim that the step cannot have ended
as it did, with the CONDITION under which it could, a clause.  Where the action binding has no such
outcome OUTCOMES are the names of those that it has, and ENDING is the claim that the CONDITION of
success held.  Where the states differ there is no ENDING.  OTHERS counts the runs of other traces
against which the EDITS were checked, too."
  (step 0 :type (integer 0) :read-only t)
  (action "" :type string :read-only t)
  (event '() :type list :read-only t)
  (kind :state :type (member :state :outcome) :read-only t)
  (outcome "" :type string :read-only t)
  (outcomes '() :type list :read-only t)
  (claims '() :type list :read-only t)
  (ending nil :type (or null claim) :read-only t)
  (condition nil :type (or null string) :read-only t)
  (grounds '() :type list :read-only t)
  (influences '() :type list :read-only t)
  (agreeing 0 :type (integer 0) :read-only t)
  (differing 0 :type (integer 0) :read-only t)
  (probes 0 :type (integer 0) :read-only t)
  (others 0 :type (integer 0) :read-only t)
  (edits '() :type list :read-only t))

(setf (documentation 'explanation-step 'function)
      "Return the number of the step that an explanation is about, counted from 0."
      (documentation 'explanation-grounds 'function)
      "Return what the theory's side of a discrepancy rests on: a list of (:axiom name), (:inertia
fluent event truth) with the names of a fluent and of the event through which it keeps the value
TRUTH, and (:binding class type) of an action binding; all names are keywords."
      (documentation 'explanation-influences 'function)
      "Return the list of the INFLUENCEs: which coordinates decide, and between which values."
      (documentation 'explanation-edits 'function)
      "Return the list of the candidate EDITs of the theory."
      (documentation 'explanation-probes 'function)
      "Return the number of the runs that were made to find out which coordinates decide.")

(defmethod print-object ((explanation explanation) stream)
  (print-unreadable-object (explanation stream :type t)
    (format stream "of step ~d,~{ ~a~}" (1+ (explanation-step explanation))
            (mapcar #'ground-text (explanation-grounds explanation)))))

;;; Grounds

(defun ground-text (ground)
  "Return what GROUND, an element of EXPLANATION-GROUNDS, is in words."
  (ecase (first ground)
    (:axiom (format nil "axiom ~a" (ec:name-text (second ground))))
    (:inertia (format nil "inertia of ~:[false~;true~] ~a through ~a" (fourth ground)
                      (ec:name-text (second ground))
                      (if (third ground) (ec:name-text (third ground)) "a step without event")))
    (:binding (format nil "the binding of ~a ~a" (ec:name-text (second ground))
                      (ec:name-text (third ground))))))

(defun claim-grounds (claim)
  "Return the grounds of CLAIM."
  (append (loop for name in (claim-axioms claim) collect (list :axiom name))
          (loop for (atom truth event) in (claim-persistent claim)
                collect (list :inertia (first atom) (first event) truth))))

(defun binding-ground (step)
  "Return the ground that the action binding for the designator of STEP is."
  (let ((designator (run-step-designator step)))
    (list :binding (plan:designator-class-keyword designator)
          (ec:name-keyword (plan:desig-prop-value designator :type)))))

;;; The theory's side

(defun expected-event (domain run trace number)
  "Return the event that the theory expected in step NUMBER of RUN: that of the outcome in TRACE if
RUN has followed it so far, else that of success."
  (let ((expected (nth number (symbolic:trace-steps trace))))
    (if (and expected
             (every #'same-step-p (subseq (run-steps run) 0 number)
                    (symbolic:trace-steps trace)))
        (symbolic:step-event expected)
        (let ((success (find :success (symbolic:action-outcomes
                                       domain
                                       (run-step-designator (nth number (run-steps run))))
                             :key #'symbolic:outcome-name)))
          (and success (symbolic:outcome-event success))))))

(defun condition-text (domain outcome)
  "Return the condition of OUTCOME as a clause, or NIL if it has none or cannot be told."
  (let* ((formula (symbolic:outcome-condition outcome))
         (form (and (consp formula)
                    (ec:formula-form (symbolic:action-theory-ground domain) formula nil))))
    (cond ((null form) nil)
          ((eq (first form) :not)
           (format nil "~a is false" (ec:formula-text (second form))))
          (t (format nil "~a is true" (ec:formula-text form))))))

(defun theory-side (discrepancy)
  "Return a property list for MAKE-EXPLANATION: what the theory says in DISCREPANCY, and why."
  (let* ((domain (discrepancy-domain discrepancy))
         (run (discrepancy-run discrepancy))
         (trace (discrepancy-trace discrepancy))
         (divergence (judgement-divergence (discrepancy-judgement discrepancy)))
         (number (divergence-step divergence))
         (step (nth number (run-steps run)))
         (outcome-p (eq (divergence-kind divergence) :outcome))
         (moments (run-moments domain run trace number))
         (event (if outcome-p (expected-event domain run trace number) (seen-event step)))
         (claims (state-claims domain moments run number event (divergence-fluents divergence)))
         (seen (first (run-step-candidates step)))
         (outcomes (and outcome-p (null seen)
                        (symbolic:action-outcomes domain (run-step-designator step))))
         (success (find :success outcomes :key #'symbolic:outcome-name))
         (ending (and outcome-p
                      (if seen
                          (outcome-claim domain moments run number seen)
                          (requirement-claim domain moments run number
                                             (symbolic:outcome-condition success))))))
    (list :step number :action (princ-to-string (run-step-designator step))
          :event event :kind (divergence-kind divergence)
          :outcome (or (run-step-failure step) "success")
          :outcomes (mapcar #'symbolic:outcome-name outcomes)
          :claims claims :ending ending
          :condition (and outcome-p (condition-text domain (or seen success)))
          :grounds (remove-duplicates
                    (if outcome-p
                        (cons (binding-ground step) (and ending (claim-grounds ending)))
                        (mapcan #'claim-grounds claims))
                    :test #'equal :from-end t))))

;;; Entry point

(defun judged-runs (discrepancy runs context)
  "Return RUNS, valid runs of the trace of DISCREPANCY or pairs (run . judgement), as such pairs."
  (loop with memory = (make-memory)
        for entry in runs
        collect (if (consp entry)
                    entry
                    (cons entry
                          (judge-run (discrepancy-domain discrepancy) entry
                                     (discrepancy-trace discrepancy)
                                     :compare (discrepancy-compare discrepancy)
                                     :comparison (judgement-comparison
                                                  (discrepancy-judgement discrepancy))
                                     :context context :memory memory)))))

(defun deciding-values (influences)
  "Return (parameter . value) for those of INFLUENCES that are of one parameter: what agrees."
  (loop for influence in influences
        for (parameter . more) = (influence-parameters influence)
        unless more collect (cons parameter (first (influence-agreeing influence)))))

(defparameter *part-for-runs* 2/3
  "This part of the time for an explanation is for runs; what is left of it is for edits.")

(defun explain-discrepancy (discrepancy &key (runs (discrepancy-runs discrepancy)) (max-runs 30)
                                          max-seconds)
  "Return the EXPLANATION of DISCREPANCY.  RUNS are the valid runs of its trace so far, or pairs
\(run . judgement).  At most MAX-RUNS further runs find out which coordinates decide; with 0 none
are made.  None is begun after two thirds of MAX-SECONDS (NIL: no limit), and edits are offered as
far as they are checked when these are over.  EXPLANATION-TEXT tells it in words.  Signals
INVALID-ARGUMENT."
  (check-argument 'max-runs max-runs (typep max-runs '(integer 0)) "an integer from 0 on")
  (check-argument 'max-seconds max-seconds (typep max-seconds '(or null (real 0)))
                  "a number of seconds or nil")
  (z3:with-context (context)
    (let* ((start (foreign:monotonic-seconds))
           (known (judged-runs discrepancy runs context))
           (known (if (find (discrepancy-run discrepancy) known :key #'car)
                      known
                      (append known (list (cons (discrepancy-run discrepancy)
                                                (discrepancy-judgement discrepancy))))))
           (others (plain-runs (discrepancy-other-runs discrepancy))))
      (multiple-value-bind (influences probes count)
          (find-influences discrepancy known
                           :max-runs max-runs :context context
                           :max-seconds (and max-seconds (* *part-for-runs* max-seconds)))
        (apply #'make-explanation
               :influences influences :probes count :others (length others)
               :agreeing (count-if #'agreeing-p known :key #'cdr)
               :differing (count-if-not #'agreeing-p known :key #'cdr)
               :edits (candidate-edits
                       discrepancy
                       :runs (append (mapcar #'car (append known probes)) others)
                       :deciding (deciding-values influences)
                       :max-seconds (and max-seconds
                                         (max 0 (- (+ start max-seconds)
                                                   (foreign:monotonic-seconds)))))
               (theory-side discrepancy))))))
