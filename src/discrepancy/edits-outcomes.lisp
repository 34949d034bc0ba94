;;;; Edits for an action that fails where the theory has it succeed, or the other way round.
;;;;
;;;; What success requires is learned from all transitions of the same kind of action: the shortest
;;;; condition that holds before each success and before no failure.  It becomes a precondition of
;;;; the event and a requirement of the action binding.  Where no condition tells the one from the
;;;; other, the action may fail at any time.

(in-package #:discrepancy-finder.discrepancy)

(defun same-action-p (transition other)
  (and (eq (transition-class transition) (transition-class other))
       (eq (transition-type transition) (transition-type other))))

(defun success-rows (transitions pattern succeeded-p)
  "Return the rows of those of TRANSITIONS that succeeded, or failed; PATTERN is their lifted event
of success."
  (loop for transition in transitions
        for (bindings matches) = (multiple-value-list
                                  (matching pattern (transition-success transition)))
        when (and matches (eq succeeded-p (transition-succeeded-p transition)))
          collect (make-row (transition-before transition) bindings)))

(defun general-pattern (theory event)
  "Return the pattern of all events of the name of EVENT, and its lifting."
  (let* ((sorts (declared-sorts theory event :event))
         (lifting (loop for sort in sorts
                        for number from 1
                        collect (list* (variable-named sort
                                                       (and (< 1 (count sort sorts)) number))
                                       sort nil))))
    (values (cons (first event) (mapcar #'first lifting)) lifting)))

(defun requirement-hypotheses (domain transitions transition)
  "Return (values conditions pattern): what the success of the action of TRANSITION requires, by all
of TRANSITIONS, best first; each a list of literals over PATTERN."
  (let* ((theory (symbolic:action-theory-theory domain))
         (ours (remove transition transitions :test-not #'same-action-p)))
    (multiple-value-bind (pattern lifting) (general-pattern theory (transition-success transition))
      (values (best-conditions domain
                               (condition-literals domain
                                                   (loop for (variable sort) in lifting
                                                         collect (list variable sort)))
                               (success-rows ours pattern t) (success-rows ours pattern nil))
              pattern))))

(defun failure-names (transitions transition)
  "Return the names of the failures of the action of TRANSITION that were seen in TRANSITIONS, as
the action binding has them; those that it lacks by their class."
  (remove-duplicates
   (loop for other in transitions
         when (and (same-action-p other transition) (not (transition-succeeded-p other)))
           append (or (transition-outcomes other) (list (transition-failure other))))
   :from-end t))

(defun precondition-sentences (theory pattern condition taken)
  "Return named sentences that the event PATTERN happens only under CONDITION, a list of literals."
  (let ((names '()))
    (loop for literal in condition
          for name = (or (pop taken)
                         (axiom-name-for theory (list (first pattern) :requires) names))
          do (push name names)
          collect (list name (list :implies (list :happens pattern :?time) (timed literal))))))

(defun requirement-parts (domain transition pattern condition failures mode)
  "Return the parts (kind sentences replaced requirements) of the edit by which CONDITION, a list of
literals over PATTERN, is required."
  (let* ((theory (symbolic:action-theory-theory domain))
         (replaced (and (eq mode :instead)
                        (mapcar #'ec:axiom-name (ec:event-axioms theory (first pattern))))))
    (list :requirement
          (precondition-sentences theory pattern condition replaced)
          replaced
          (list (make-requirement :class (transition-class transition)
                                  :type (transition-type transition) :pattern pattern
                                  :formula (conjunction-of condition)
                                  :failures failures :mode mode)))))

(defun may-fail-parts (domain transition pattern failures)
  "Return the parts of the edit by which the action of TRANSITION may succeed or end in FAILURES,
whatever is the case."
  (flet ((change (mode)
           (make-requirement :class (transition-class transition) :type (transition-type transition)
                             :pattern pattern :failures failures :mode mode)))
    (if (transition-succeeded-p transition)
        (list :may-fail '()
              (mapcar #'ec:axiom-name
                      (ec:event-axioms (symbolic:action-theory-theory domain) (first pattern)))
              (list (change :instead) (change :may-fail)))
        (list :may-fail '() '() (list (change :may-fail))))))

(defun outcome-edits (domain transitions transition)
  "Return the parts (kind sentences replaced requirements) of edits for the outcome of TRANSITION,
which the theory forbids, best first."
  (let ((failures (failure-names transitions transition))
        (theory (symbolic:action-theory-theory domain)))
    (multiple-value-bind (conditions pattern)
        (requirement-hypotheses domain transitions transition)
      (append
       (loop for condition in conditions
             append (loop for mode in (if (transition-succeeded-p transition)
                                          '(:instead)
                                          '(:also :instead))
                          collect (requirement-parts domain transition pattern condition failures
                                                     mode)))
       (list (may-fail-parts domain transition pattern failures))
       ;; A sentence of the theory may be what forbids a success.
       (when (transition-succeeded-p transition)
         (loop for axiom in (ec:event-axioms theory (first pattern))
               collect (list :weaken '() (list (ec:axiom-name axiom)) '())))))))
