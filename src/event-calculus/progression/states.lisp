;;;; States: what is true at one timepoint, as far as it is known.
;;;;
;;;; A STATE gives each ground fluent a proposition: T, NIL or a Z3 term over the initial state and
;;;; over what is left open later.  It knows its predecessor and the events in between, so that
;;;; sentences over several timepoints can be judged.  Initial states are made in
;;;; initial-states.lisp, the next ones by PROGRESS, in progress.lisp.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (state (:copier nil))
  "The propositions of the ground fluents at one timepoint."
  (outline nil :type outline :read-only t)
  (context nil :type (or null z3:context) :read-only t)
  (time 0 :type integer :read-only t)
  (values #() :type simple-vector)
  ;; for each fluent the proposition that it is released
  (released #() :type simple-vector)
  ;; for each numeric fluent its number, a rational or a term, and the proposition that it is
  ;; released
  (numbers #() :type simple-vector)
  (loose-numbers #() :type simple-vector)
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
  (pending '() :type list)
  ;; whether no variable was opened here or in a predecessor
  (determined-p t :type boolean))

(defun state-ground (state)
  "Return the ground theory of a state."
  (outline-ground (state-outline state)))

(setf (documentation 'state-time 'function)
      "Return the timepoint of a state; that of an initial state is the theory's first one, 0 if
the theory does not say (:time first last)."
      (documentation 'state-context 'function)
      "Return the Z3 context of a state, or NIL: where variables for what is open come from."
      (documentation 'state-predecessor 'function)
      "Return the state before a state, or NIL if it is an initial one."
      (documentation 'state-determined-p 'function)
      "Return true if the propositions of the initial state determine those of a state: nothing was
left open in between."
      (documentation 'state-numbers 'function)
      "Return the vector of the numbers of a state, rationals or real terms of Z3, in the order of
the ground numeric fluents."
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

(defun number-value (state atom)
  "Return the number of the ground numeric fluent ATOM, a list of symbols, in STATE: a rational or
a real term of Z3.  Signals UNKNOWN-ATOM."
  (let ((ground (state-ground state)))
    (svref (state-numbers state)
           (or (gethash (atom-keywords atom) (ground-theory-numeric-index ground))
               (error 'unknown-atom :atom atom :kind "numeric fluent"
                                    :theory (theory-name (ground-theory-theory ground)))))))

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
  "Return what conditions never say although the theory does, as far as STATE and its predecessors
go: a list of (axiom . reason), where the axiom is an AXIOM, (:completion predicate) or NIL and the
reason a string.  Without limits the theory allows what the conditions allow; with limits it may
allow less, never more."
  (let ((outline (state-outline state)) (time (state-time state)))
    (remove-duplicates
     (append (outline-limits outline)
             (and (ground-theory-absolute-clauses (outline-ground outline))
                  (values (dated-limits outline time)))
             (loop for (due axiom) in (state-pending state)
                   when (open-ended-p outline time due)
                     collect (cons axiom *to-come*)))
     :test #'equal)))

(defun state-exact-p (state)
  "Return true if the conditions of STATE and its predecessors say all that the bounded engine says
of a horizon that ends with STATE: there are no limits, and nothing is to be judged later that the
end of the horizon would decide."
  (let ((outline (state-outline state)))
    (and (null (state-limits state))
         (null (state-pending state))
         (not (outline-late-p outline))
         (or (null (ground-theory-absolute-clauses (outline-ground outline)))
             (nth-value 1 (dated-limits outline (state-time state)))))))

;;; Models of states

(defun state-propositions (state)
  "Return the list of all propositions of STATE, those of the fluents first: whether fluents hold,
are released, and timeless atoms are true, and which events happened just before."
  (append (coerce (state-values state) 'list)
          (coerce (state-released state) 'list)
          (coerce (state-loose-numbers state) 'list)
          (coerce (state-statics state) 'list)
          (mapcar #'cdr (state-events state))))

(defun state-in-model (state value-of &optional predecessor)
  "Return STATE with the truth values and numbers that the function VALUE-OF returns for its terms,
and no Z3 context.  PREDECESSOR is what the same made of the predecessor of STATE."
  (labels ((value (proposition)
             (if (z3:term-p proposition) (funcall value-of proposition) proposition))
           (concrete (vector)
             ;; What has no terms is shared: traces have many states.
             (declare (type simple-vector vector))
             (if (find-if #'z3:term-p vector)
                 (map 'simple-vector #'value vector)
                 vector)))
    (make-state :outline (state-outline state) :time (state-time state) :predecessor predecessor
                :values (concrete (state-values state))
                :released (concrete (state-released state))
                :numbers (concrete (state-numbers state))
                :loose-numbers (concrete (state-loose-numbers state))
                :statics (concrete (state-statics state))
                :events (loop for (number . proposition) in (state-events state)
                              when (value proposition) collect (cons number t))
                :turns (loop for (cause . propositions) in (state-turns state)
                             collect (cons cause (mapcar #'value propositions)))
                :predicates (and (state-predicates state)
                                 (let ((table (make-hash-table)))
                                   (maphash (lambda (number proposition)
                                              (setf (gethash number table) (value proposition)))
                                            (state-predicates state))
                                   table))
                :pending (state-pending state))))

(defun same-propositions-p (p q)
  (every (lambda (p q) (or (eql p q) (z3:term-equal p q))) p q))

(defun same-future-p (state other)
  "Return true if what can follow STATE, of the same chain of initial state and theory, can follow
OTHER: their propositions are the same and the theory does not look further back."
  (and (eql (state-time state) (state-time other))
       (or (not (outline-memory-p (state-outline state)))
           (and (eq (state-predecessor state) (state-predecessor other))
                (equal (mapcar #'car (state-events state)) (mapcar #'car (state-events other)))
                (same-propositions-p (mapcar #'cdr (state-events state))
                                     (mapcar #'cdr (state-events other)))))
       (same-propositions-p (state-values state) (state-values other))
       (same-propositions-p (state-released state) (state-released other))
       (same-propositions-p (state-numbers state) (state-numbers other))
       (same-propositions-p (state-loose-numbers state) (state-loose-numbers other))
       (equal (state-pending state) (state-pending other))))
