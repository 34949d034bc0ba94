;;;; Edits for an action that fails where the theory has it succeed, or the other way round.
;;;;
;;;; What success requires is learned from all transitions of the same kind of action: the shortest
;;;; condition that holds before each success and before no failure.  It becomes a precondition of
;;;; the event and a requirement of the action binding.  Where no condition over variables tells the
;;;; one from the other, one with elements may (constants.lisp), or else the action may fail at any
;;;; time.

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

(defun call-with-any-state (domain context function)
  "Call FUNCTION with a solver and a state of DOMAIN of which nothing is known but what the theory
says of each state."
  (z3:with-released-terms (context)
    (z3:with-solver (solver context)
      (let ((state (free-state (symbolic:action-theory-ground domain) context '())))
        (loop for (axiom . proposition) in (ec:initial-conditions state)
              unless (and (typep axiom 'ec:axiom)
                          (eq :initially (first (ec:axiom-formula axiom))))
                do (z3:solver-assert solver proposition))
        (funcall function solver state)))))

(defun condition-possible-p (domain condition bindings context)
  "Return true if the theory of DOMAIN allows a state in which the literals CONDITION hold for
BINDINGS."
  (let ((formula (ec:parse-formula (conjunction-of (sublis bindings condition))
                                   (symbolic:action-theory-theory domain))))
    (call-with-any-state
     domain context
     (lambda (solver state)
       (consistent-p solver (list (ec:holds (ec:ground-formula
                                             (symbolic:action-theory-ground domain) formula)
                                            (list state))))))))

(defun requirement-hypotheses (domain transitions transition context)
  "Return (values conditions pattern): what the success of the action of TRANSITION requires, by all
of TRANSITIONS, best first; each a list of literals over PATTERN."
  (let* ((theory (symbolic:action-theory-theory domain))
         (ours (remove transition transitions :test-not #'same-action-p))
         (event (transition-success transition)))
    (multiple-value-bind (pattern lifting) (general-pattern theory event)
      (let ((successes (success-rows ours pattern t)))
        (values (best-conditions
                 domain
                 (condition-literals domain (loop for (variable sort) in lifting
                                                  collect (list variable sort)))
                 successes (success-rows ours pattern nil)
                 ;; What held before a success is possible.
                 :acceptable (if successes
                                 (constantly t)
                                 (lambda (condition)
                                   (condition-possible-p domain condition
                                                         (matching pattern event) context))))
                pattern)))))

(defun failure-names (transitions transition)
  "Return the names of the failures of the action of TRANSITION that were seen in TRANSITIONS, as
the action binding has them; those that it lacks by their class."
  (remove-duplicates
   (loop for other in transitions
         when (and (same-action-p other transition) (not (transition-succeeded-p other)))
           append (or (transition-outcomes other) (list (transition-failure other))))
   :from-end t))

(defun precondition-sentences (theory pattern condition replaced)
  "Return named sentences that the event PATTERN happens only under CONDITION, a list of literals,
but for those that THEORY has.  They take the names of the axioms REPLACED, as far as these go."
  (let* ((axioms (remove-if (lambda (axiom) (member (ec:axiom-name axiom) replaced))
                            (ec:theory-axioms theory)))
         (names '()))
    (loop for literal in condition
          for sentence = (list :implies (list :happens pattern :?time) (timed literal))
          unless (find sentence axioms :key #'ec:axiom-formula :test #'equal)
            collect (let ((name (or (pop replaced)
                                    (axiom-name-for theory (list (first pattern) :requires)
                                                    names))))
                      (push name names)
                      (list name sentence)))))

(defun requirement-parts (domain kind transition pattern condition failures mode)
  "Return the parts (KIND sentences replaced requirements) of the edit by which CONDITION, a list of
literals over PATTERN, is required."
  (let* ((theory (symbolic:action-theory-theory domain))
         (replaced (and (eq mode :instead)
                        (mapcar #'ec:axiom-name (ec:event-axioms theory (first pattern))))))
    (list kind
          (unless (eq mode :unless)
            (precondition-sentences theory pattern condition replaced))
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

(defun constant-requirements (domain transitions transition)
  "Return the parts of edits by which the success of TRANSITION, which has failed, requires
something of particular elements."
  (multiple-value-bind (conditions pattern) (constant-hypotheses domain transitions transition)
    (loop with alike = (remove-if-not (lambda (other)
                                        (nth-value 1 (matching pattern
                                                               (transition-success other))))
                                      transitions)
          for condition in conditions
          collect (requirement-parts domain :requirement transition pattern condition
                                     (failure-names alike transition) :also))))

(defun outcome-edits (domain transitions transition context)
  "Return the parts (kind sentences replaced requirements) of edits for the outcome of TRANSITION,
which the theory forbids, best first."
  (let ((failures (failure-names transitions transition))
        (theory (symbolic:action-theory-theory domain))
        ;; What has never been seen to succeed requires nobody knows what.
        (kind (if (some (lambda (other)
                          (and (same-action-p other transition) (transition-succeeded-p other)))
                        transitions)
                  :requirement
                  :guess)))
    (multiple-value-bind (conditions pattern)
        (requirement-hypotheses domain transitions transition context)
      (append
       (loop for condition in conditions
             append (loop for mode in (if (transition-succeeded-p transition)
                                          '(:instead)
                                          '(:also :instead))
                          collect (requirement-parts domain kind transition pattern condition
                                                     failures mode)))
       (unless (or conditions (transition-succeeded-p transition))
         (constant-requirements domain transitions transition))
       (list (may-fail-parts domain transition pattern failures))
       ;; A sentence of the theory may be what forbids a success.
       (when (transition-succeeded-p transition)
         (loop for axiom in (ec:event-axioms theory (first pattern))
               collect (list :weaken '() (list (ec:axiom-name axiom)) '())))))))
