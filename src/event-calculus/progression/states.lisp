;;;; States: what is true at one timepoint, as far as it is known.
;;;;
;;;; A STATE gives each ground fluent a proposition: T, NIL or a Z3 term over the initial state and
;;;; over what is left open later.  It knows its predecessor and the events in between, so that
;;;; sentences over several timepoints can be judged.  SYMBOLIC-STATE and CONCRETE-STATE make initial
;;;; states, PROGRESS (progress.lisp) makes the next ones.
;;;;
;;;; What the theory leaves open becomes a Z3 variable in the context of the state; a state without
;;;; a context signals UNDETERMINED there.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (state (:copier nil))
  "The propositions of the ground fluents at one timepoint."
  (outline nil :type outline :read-only t)
  (context nil :type (or null z3:context) :read-only t)
  (time 0 :type integer :read-only t)
  (values #() :type simple-vector)
  ;; for each fluent the proposition that it is released
  (released #() :type simple-vector)
  ;; the propositions of the timeless atoms, the same for all states that follow each other
  (statics #() :type simple-vector :read-only t)
  (predecessor nil :type (or null state) :read-only t)
  ;; (number . proposition) of the events between predecessor and this state
  (events '() :type list)
  ;; (fluent initiated terminated) for the causes of trajectories between them
  (turns '() :type list)
  ;; a table from numbers to the propositions of predicates at the time of the predecessor
  (predicates nil :type (or null hash-table))
  ;; (due axiom . ground formula) with timepoints: what can be judged at the timepoint DUE only
  (pending '() :type list))

(defun state-ground (state)
  "Return the ground theory of a state."
  (outline-ground (state-outline state)))

(setf (documentation 'state-time 'function)
      "Return the timepoint of a state; that of an initial state is the theory's first one, 0 if the
theory does not say (:time first last)."
      (documentation 'state-context 'function)
      "Return the Z3 context of a state, or NIL: where variables for what is open come from."
      (documentation 'state-predecessor 'function)
      "Return the state before a state, or NIL if it is an initial one."
      (documentation 'state-values 'function)
      "Return the vector of the propositions of a state, in the order of the ground fluents.")

(defmethod print-object ((state state) stream)
  (print-unreadable-object (state stream :type t)
    (format stream "at ~d~{ ~a~}" (state-time state)
            (mapcar #'atom-text (state-fluents state)))))

(defun fluent-value (state atom)
  "Return the proposition of the ground fluent ATOM, a list of symbols, in STATE.  Signals
UNKNOWN-ATOM."
  (svref (state-values state) (find-fluent (state-ground state) atom)))

(defun state-fluents (state)
  "Return the list of the ground fluents that are simply true in STATE, in the theory's order."
  (loop for value across (state-values state)
        for atom across (ground-theory-fluents (state-ground state))
        when (eq value t) collect atom))

(defun state-happenings (state)
  "Return what happened just before STATE, given or triggered: a list of (event . proposition)."
  (loop for (number . proposition) in (state-events state)
        collect (cons (svref (ground-theory-events (state-ground state)) number) proposition)))

;;; Exactness

(defun state-limits (state)
  "Return what the propositions and conditions of STATE and its predecessors do not say although
the theory does: a list of (axiom . reason), where the axiom is an AXIOM or (:completion predicate)
and the reason a string.  Without limits the theory allows just what the conditions allow; with
limits it may allow less, never more."
  (remove-duplicates
   (append (state-static-limits state)
           (loop for (nil axiom) in (state-pending state)
                 collect (cons axiom "it depends on timepoints to come")))
   :test #'equal))

(defun state-exact-p (state)
  "Return true if the conditions of STATE and its predecessors say all that the theory says of a
horizon that ends with STATE; see STATE-LIMITS."
  (null (state-limits state)))

(defun state-static-limits (state)
  (let ((outline (state-outline state)))
    (append (outline-limits outline)
            (and (ground-theory-absolute-clauses (outline-ground outline))
                 (dated-limits outline (state-time state))))))

;;; Variables

(defun fresh-variable (context outline kind number time)
  "Return the Z3 variable for the atom of KIND with NUMBER at TIME, which the theory leaves open.
Signals UNDETERMINED if there is no context."
  (let* ((ground (outline-ground outline))
         (atom (ecase kind
                 ((:fluent :released) (svref (ground-theory-fluents ground) number))
                 (:event (svref (ground-theory-events ground) number))
                 (:predicate (aref (atom-table-atoms (ground-theory-predicates ground)) number))
                 (:static (aref (atom-table-atoms (ground-theory-statics ground)) number)))))
    (unless context
      (error 'undetermined :atom atom :kind kind :time (if (eq kind :static) nil time)
                           :theory (theory-name (ground-theory-theory ground))))
    ;; The names of fluents at the first timepoint are their texts alone; none of these begins with
    ;; a letter or ends with a digit.
    (z3:variable context
                 (format nil "~:[~(~a~) ~;~*~]~a~@[ at ~d~]" (eq kind :fluent) kind
                         (atom-text atom) (if (eq kind :static) nil time)))))

;;; Initial states

(defun context-of (propositions)
  (let ((term (find-if #'z3:term-p propositions)))
    (and term (z3:term-context term))))

(defun initial-released (outline context)
  (let ((ground (outline-ground outline)))
    (map 'simple-vector
         (let ((number -1))
           (lambda (release)
             (incf number)
             (ecase release
               ((nil) nil)
               (:always t)
               (:possibly (and (manual-release-p ground number)
                               (fresh-variable context outline :released number
                                               (outline-first-time outline)))))))
         (outline-release outline))))

(defun initial-statics (outline context)
  (let ((statics (copy-seq (outline-statics outline))))
    (dotimes (number (length statics) statics)
      (when (eq (svref statics number) :open)
        (setf (svref statics number)
              (fresh-variable context outline :static number nil))))))

(defun make-initial-state (ground context values)
  (let ((outline (ground-outline ground)))
    (make-state :outline outline :context context :time (outline-first-time outline)
                :values values :released (initial-released outline context)
                :statics (initial-statics outline context))))

(defun symbolic-state (ground context)
  "Return the initial state of GROUND in which each fluent is a new variable in the Z3 CONTEXT, named
by the fluent's text."
  (make-initial-state ground context
                      (map 'simple-vector (lambda (atom) (z3:variable context (atom-text atom)))
                           (ground-theory-fluents ground))))

(defun concrete-state (ground value-of &key context)
  "Return the initial state of GROUND in which the fluent ATOM has the proposition that the function
VALUE-OF returns for it.  CONTEXT is where variables for what is left open later come from, by
default that of the propositions.  Signals UNDETERMINED if the theory leaves open whether a fluent is
released or a timeless atom is true, and there is no context."
  (let ((values (map 'simple-vector value-of (ground-theory-fluents ground))))
    (make-initial-state ground (or context (context-of values)) values)))
