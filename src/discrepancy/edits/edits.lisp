;;;; Edits: changes of a theory, and of what its domain's actions require, that a discrepancy calls
;;;; for.
;;;;
;;;; An EDIT adds sentences to the theory, takes others out of it, and changes REQUIREMENTS, each of
;;;; one action binding.  CANDIDATE-EDITS (edits-check.lisp) finds them; EDITED-DOMAIN applies one.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (requirement (:copier nil))
  "A change of what the success of the designators of CLASS and TYPE requires: FORMULA is a state
formula over the variables of PATTERN, the event of success; if some of its arguments are elements,
it is about the actions with these.  Where it is false the action ends in one of FAILURES.  MODE is
as for SYMBOLIC:REVISED-BINDING."
  (class nil :type keyword :read-only t)
  (type nil :type keyword :read-only t)
  (pattern '() :type list :read-only t)
  (formula t :read-only t)
  (failures '() :type list :read-only t)
  (mode :also :type (member :also :instead :unless :may-fail) :read-only t))

(defun requirement-text (requirement)
  "Return what REQUIREMENT says, as a clause."
  (let ((class (requirement-class requirement)) (type (requirement-type requirement))
        (pattern (requirement-pattern requirement)) (formula (requirement-formula requirement))
        (failures (requirement-failures requirement)) (mode (requirement-mode requirement)))
    (format nil "~(~a~) ~a, event ~a, ~a" class (ec:name-text type) (ec:formula-text pattern)
            (cond ((eq mode :may-fail)
                   (format nil "may end in ~{~(~a~)~^ or ~} at any time" failures))
                  ((eq mode :unless)
                   (format nil "may end in ~{~(~a~)~^ or ~} unless ~a" failures
                           (ec:formula-text formula)))
                  ((eq formula t) "succeeds whatever is the case")
                  (t (format nil "~:[requires~;requires, instead of what it did,~] ~a~@[; else ~
                                  it ends in ~{~(~a~)~^ or ~}~]"
                             (eq mode :instead) (ec:formula-text formula) failures))))))

(defstruct (edit (:copier nil))
  "A change of a theory.  KIND is one of :EFFECT, :RELEASE, :WEAKEN, :REQUIREMENT, :GUESS,
:MAY-FAIL and :REGION, what it is about.  SENTENCES is a list of (name formula), REPLACED a list of
names of axioms, REQUIREMENTS a list of requirements, RANGES a list of coordinate ranges, whose
fluents are new.  CONTRADICTED of the RUNS runs that it was checked against agreed further with the
theory before.  SUPPORT is NIL or, for a range, (agreeing number agreeing-outside number-outside) of
the runs that were compared: how many are in it, and how many of these agree with the theory."
  (kind :effect :type keyword :read-only t)
  (sentences '() :type list :read-only t)
  (replaced '() :type list :read-only t)
  (requirements '() :type list :read-only t)
  (ranges '() :type list :read-only t)
  (support '() :type list :read-only t)
  (removes-p nil :type boolean :read-only t)
  (contradicted 0 :type (integer 0) :read-only t)
  (runs 0 :type (integer 0) :read-only t))

(setf (documentation 'edit-kind 'function)
      "Return what an edit is about: :EFFECT (sentences of what actions change), :RELEASE (the
change is left open), :WEAKEN (a sentence is taken out), :REQUIREMENT (a precondition), :GUESS (a
precondition of what has never succeeded in the runs), :MAY-FAIL (an action may fail at any time),
:REGION (a region is refined: a new fluent tells whether a coordinate lies in a range, and the
effect or the precondition depends on it)."
      (documentation 'edit-sentences 'function)
      "Return the sentences that an edit adds to the theory: a list of (name formula)."
      (documentation 'edit-replaced 'function)
      "Return the names of the axioms that an edit takes out of the theory, a list of keywords."
      (documentation 'edit-requirements 'function)
      "Return what an edit changes in the action bindings: a list of REQUIREMENTs."
      (documentation 'edit-ranges 'function)
      "Return the coordinate ranges whose fluents an edit adds: a list."
      (documentation 'edit-support 'function)
      "Return NIL or, of an edit that adds a range, the list (agreeing number agreeing-outside
number-outside) of the runs from the same discrete state: how many are in the range, and how many of
these agree with the theory as it was."
      (documentation 'edit-removes-p 'function)
      "Return true if an edit removes the discrepancy: theory and simulation no longer part where
they did."
      (documentation 'edit-contradicted 'function)
      "Return the number of runs with which the theory agrees longer without the edit."
      (documentation 'edit-runs 'function)
      "Return the number of runs that an edit was checked against.")

(defun range-text (range)
  "Return what is added for the new fluent of the coordinate range RANGE, as a clause."
  (format nil "add the fluent ~a, in the abstraction (:coordinate ~:*~a :body ~(~a :axis ~a~) ~
               :range (~,4f ~,4f))"
          (ec:atom-text (coordinate-range-atom range)) (coordinate-range-body range)
          (coordinate-range-axis range) (coordinate-range-min range)
          (coordinate-range-max range)))

(defun edit-parts (edit)
  "Return the list of the parts of EDIT, each as a clause."
  (append (mapcar #'range-text (edit-ranges edit))
          (loop for name in (edit-replaced edit)
                unless (find name (edit-sentences edit) :key #'first)
                  collect (format nil "remove the axiom ~a from the theory" (ec:name-text name)))
          (loop for (name formula) in (edit-sentences edit)
                collect (format nil "~:[add to~;replace in~] the theory: (~a ~a)"
                                (member name (edit-replaced edit)) (ec:name-text name)
                                (ec:formula-text formula)))
          (loop for requirement in (edit-requirements edit)
                collect (format nil "change the action binding: ~a"
                                (requirement-text requirement)))))

(defun edit-verdict-text (edit)
  "Return what the check of EDIT came to, as a clause."
  (format nil "this ~:[does not remove~;removes~] the discrepancy and contradicts ~[none~:;~:*~d~] ~
               of the ~d run~:p~@[; ~{in the range ~d of ~d run~:p ~
               ~:*agree~[~;s~:;~], outside ~d of ~d~}~]"
          (edit-removes-p edit) (edit-contradicted edit) (edit-runs edit) (edit-support edit)))

(defun edit-text (edit)
  "Return EDIT in words, on one line: what is added, replaced or removed.  What its check came to is
told by EDIT-REMOVES-P, EDIT-CONTRADICTED and EDIT-RUNS."
  (format nil "~{~a~^; ~}" (edit-parts edit)))

(defmethod print-object ((edit edit) stream)
  (print-unreadable-object (edit stream :type t)
    (format stream "~a: ~a" (edit-text edit) (edit-verdict-text edit))))

(defun edited-theory (theory edit)
  "Return THEORY changed by EDIT: a new theory that is not registered.  Signals THEORY-ERROR."
  (ec:revised-theory theory :without (edit-replaced edit) :with (edit-sentences edit)
                            :fluents (mapcar #'coordinate-range-atom (edit-ranges edit))))

(defun requirement-for-p (requirement binding)
  (and (eq (requirement-class requirement) (symbolic:action-binding-class binding))
       (eq (requirement-type requirement) (symbolic:action-binding-type binding))))

(defun revised-actions (bindings requirements)
  "Return BINDINGS as REQUIREMENTS change them."
  (loop for binding in bindings
        collect (reduce (lambda (binding requirement)
                          (if (requirement-for-p requirement binding)
                              (symbolic:revised-binding binding (requirement-pattern requirement)
                                                        (requirement-formula requirement)
                                                        :failures
                                                        (requirement-failures requirement)
                                                        :mode (requirement-mode requirement))
                              binding))
                        requirements :initial-value binding)))

(defun edited-domain (domain edit)
  "Return DOMAIN with its theory and its action bindings changed by EDIT: a new domain that is not
registered.  Signals THEORY-ERROR."
  (make-instance 'domain
                 :name (symbolic:action-theory-name domain)
                 :theory (edited-theory (symbolic:action-theory-theory domain) edit)
                 :actions (revised-actions (symbolic:action-theory-actions domain)
                                           (edit-requirements edit))
                 :documentation (domain-documentation domain)
                 :scene (domain-scene domain) :regions (domain-regions domain)
                 :observers (append (domain-observers domain) (edit-ranges edit))
                 :file (domain-file domain)
                 :extended-files (domain-extended-files domain)
                 :clauses (domain-clauses domain)))
