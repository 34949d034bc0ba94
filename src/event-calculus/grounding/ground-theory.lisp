;;;; Ground theories: a theory in which all variables are replaced by elements.
;;;;
;;;; The ground fluents and events are numbered, and so are, as they are met, the ground atoms of
;;;; the theory's own predicates: those with one argument of sort TIME apart from that time, the
;;;; others as a whole.  Axioms about one arbitrary timepoint are made ground once, relative to it;
;;;; those that compare timepoints or name them by number are made ground for each horizon (see
;;;; axioms.lisp).  Entry point: GROUND, in axioms.lisp.
;;;;
;;;; A ground formula is T, NIL, one of
;;;;   (:fluent index offset) (:released index offset) (:event index offset)
;;;;   (:predicate index offset) (:static index)
;;;;   (:compare operator term term), the operator :=, :< or :<=
;;;; or :and, :or, :not, :iff of ground formulas; what is constant is folded away.  OFFSET is the
;;;; distance from the timepoint in question, or the timepoint itself.  A ground term is a rational
;;;; number, (:value index offset) for a numeric fluent, or :+, :-, :* or :/ of ground terms.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (atom-table (:constructor make-atom-table ()) (:copier nil))
  "Ground atoms and their numbers."
  (atoms (make-array 16 :adjustable t :fill-pointer 0) :type vector :read-only t)
  (index (make-term-table) :type hash-table :read-only t))

(defun intern-atom (table atom)
  "Return the number of the ground ATOM in TABLE, a new one if need be."
  (or (gethash atom (atom-table-index table))
      (setf (gethash atom (atom-table-index table))
            (vector-push-extend atom (atom-table-atoms table)))))

(defstruct (effect (:copier nil))
  "That EVENT :INITIATES, :TERMINATES or :RELEASES FLUENT, both given by number, where the ground
formula GUARD holds: at any timepoint, or at TIME only.  An effect that :ASSIGNS gives the numeric
fluent FLUENT the value of the ground TERM."
  (kind :initiates :type (member :initiates :terminates :releases :assigns) :read-only t)
  (term nil :type (or null rational list) :read-only t)
  (event 0 :type fixnum :read-only t)
  (fluent 0 :type fixnum :read-only t)
  (guard t :type (or boolean cons) :read-only t)
  (time nil :type (or null integer) :read-only t)
  (axiom nil :type axiom :read-only t)
  (bindings '() :type list :read-only t))

(defstruct (gradual-change (:copier nil))
  "That once an event has initiated (:TRAJECTORY) or terminated (:ANTI-TRAJECTORY) the fluent
CAUSE, FLUENT holds OFFSET timepoints later, where GUARD holds at the time of the event.  With a
ground TERM, whose times are distances from that of the event, it is a numeric fluent that has the
value of TERM then."
  (kind :trajectory :type (member :trajectory :anti-trajectory) :read-only t)
  (cause 0 :type fixnum :read-only t)
  (fluent 0 :type fixnum :read-only t)
  (offset 1 :type fixnum :read-only t)
  (term nil :type (or null rational list) :read-only t)
  (guard t :type (or boolean cons) :read-only t)
  (time nil :type (or null integer) :read-only t)
  (axiom nil :type axiom :read-only t)
  (bindings '() :type list :read-only t))

(defstruct (sentence (:copier nil))
  "The instance of AXIOM for BINDINGS.  FIRST and LAST are the distances of the timepoints that it
speaks of from the one in question; an event at t ends at t + 1.  Where ABSOLUTE is true they are
timepoints.  DEFINITIONS are the effect axioms that conditions about effects were replaced by."
  (axiom nil :type (or axiom cons) :read-only t)
  (bindings '() :type list :read-only t)
  (formula t :type (or boolean cons) :read-only t)
  (first 0 :type fixnum :read-only t)
  (last 0 :type fixnum :read-only t)
  (absolute nil :type boolean :read-only t)
  (definitions '() :type list :read-only t))

(defstruct (ground-theory (:copier nil))
  "A theory in which all variables are replaced by elements."
  (theory nil :type theory :read-only t)
  (fluents #() :type simple-vector :read-only t)
  (events #() :type simple-vector :read-only t)
  (numerics #() :type simple-vector :read-only t)
  (fluent-index nil :type hash-table :read-only t)
  (numeric-index nil :type hash-table :read-only t)
  (event-index nil :type hash-table :read-only t)
  (predicates (make-atom-table) :type atom-table :read-only t)
  (statics (make-atom-table) :type atom-table :read-only t)
  (function-values (make-term-table) :type hash-table :read-only t)
  ;; for each event and for each fluent its effects; trajectories by cause
  (effects #() :type simple-vector)
  (effects-on #() :type simple-vector)
  (changes #() :type simple-vector)
  ;; for each numeric fluent the effects that assign or release it
  (effects-on-numeric #() :type simple-vector)
  ;; for each fluent whether it can be released: NIL, :POSSIBLY, or :ALWAYS if it is not inertial
  (release #() :type simple-vector)
  ;; the axiom that says that no two events happen at once, or NIL
  (one-event-at-a-time nil :type (or null axiom))
  (initial-conditions '() :type list)
  (sentences '() :type list)
  ;; the axioms of which not all instances were dropped
  (instantiated (make-hash-table :test 'eq) :type hash-table :read-only t)
  ;; the clauses (axiom kind condition head) that are made ground for each horizon
  (absolute-clauses '() :type list))

(setf (documentation 'ground-theory-theory 'function)
      "Return the theory that was made ground."
      (documentation 'ground-theory-fluents 'function)
      "Return the vector of the ground fluents, each a list of keywords, integers and such lists."
      (documentation 'ground-theory-events 'function)
      "Return the vector of the ground events, each a list of keywords, integers and such lists.")

(defmethod print-object ((ground ground-theory) stream)
  (print-unreadable-object (ground stream :type t)
    (format stream "~a: ~d ground fluent~:p, ~d ground event~:p"
            (name-text (theory-name (ground-theory-theory ground)))
            (length (ground-theory-fluents ground)) (length (ground-theory-events ground)))))

(defun copy-with-own-effects (ground)
  "Return a copy of GROUND to which effects and trajectories can be added."
  (let ((copy (copy-structure ground)))
    (setf (ground-theory-effects copy) (copy-seq (ground-theory-effects ground))
          (ground-theory-effects-on copy) (copy-seq (ground-theory-effects-on ground))
          (ground-theory-changes copy) (copy-seq (ground-theory-changes ground))
          (ground-theory-effects-on-numeric copy)
          (copy-seq (ground-theory-effects-on-numeric ground))
          (ground-theory-release copy) (copy-seq (ground-theory-release ground)))
    copy))

(defun index-table (atoms)
  (let ((table (make-term-table)))
    (loop for atom across atoms for index from 0 do (setf (gethash atom table) index))
    table))

(defun find-fluent (ground atom)
  "Return the number of the ground fluent ATOM, a list of symbols, in GROUND.  Signals
UNKNOWN-ATOM."
  (or (gethash (atom-keywords atom) (ground-theory-fluent-index ground))
      (error 'unknown-atom :atom atom :kind "fluent"
                           :theory (theory-name (ground-theory-theory ground)))))

(defun find-event (ground atom)
  "Return the number of the ground event ATOM, a list of symbols, in GROUND.  Signals
UNKNOWN-ATOM."
  (or (gethash (atom-keywords atom) (ground-theory-event-index ground))
      (error 'unknown-atom :atom atom :kind "event"
                           :theory (theory-name (ground-theory-theory ground)))))

(defun event-number (ground event)
  "Return the number of the ground EVENT, a list of symbols, in GROUND, or NIL if EVENT is NIL.
Signals UNKNOWN-ATOM."
  (and event (find-event ground event)))

;;; Ground formulas

(defun fold (operator parts)
  "Return the conjunction (OPERATOR :and) or disjunction (:or) of PARTS, constants folded."
  (let ((absorbing (eq operator :or))
        (kept '()))
    (dolist (part parts (cond ((null kept) (not absorbing))
                              ((null (rest kept)) (first kept))
                              (t (cons operator (nreverse kept)))))
      (cond ((eq part absorbing) (return absorbing))
            ((eq part (not absorbing)))
            ((eq (first part) operator) (dolist (inner (rest part)) (push inner kept)))
            ((and (null (nthcdr 8 kept)) (member part kept :test #'equal)))
            (t (push part kept))))))

(defun fold-not (part)
  (cond ((eq part t) nil)
        ((null part) t)
        ((eq (first part) :not) (second part))
        (t (list :not part))))

(defun fold-iff (p q)
  (cond ((eq p t) q) ((eq q t) p)
        ((null p) (fold-not q)) ((null q) (fold-not p))
        (t (list :iff p q))))

(defun shift-formula (formula offset)
  "Return the ground FORMULA, moved by OFFSET timepoints."
  (if (or (atom formula) (eql offset 0))
      formula
      (case (first formula)
        ((:fluent :released :event :predicate :value)
         (list (first formula) (second formula) (+ (third formula) offset)))
        (:static formula)
        (:compare (list* :compare (second formula)
                         (mapcar (lambda (term) (shift-formula term offset)) (cddr formula))))
        (t (cons (first formula)
                 (mapcar (lambda (part) (shift-formula part offset)) (rest formula)))))))

(defun map-atoms (function formula)
  "Call FUNCTION with each atom of the ground FORMULA."
  (when (consp formula)
    (if (member (first formula) '(:and :or :not :iff))
        (dolist (part (rest formula)) (map-atoms function part))
        (funcall function formula))))

(defun mentions-event-p (formula)
  (map-atoms (lambda (atom) (when (eq (first atom) :event) (return-from mentions-event-p t)))
             formula))
