;;;; Progression: what is true after a known event.
;;;;
;;;; A STATE gives each ground fluent a proposition: T, NIL or a Z3 term over the initial state.
;;;; PROGRESS rewrites the fluents that an event affects, by the axioms of the Discrete Event
;;;; Calculus for inertial fluents:
;;;;   f holds at t+1  <->  f is initiated at t, or f holds at t and is not terminated
;;;; (DEC5, DEC6, DEC9, DEC10)
;;;; and returns what must be true for that step to be possible: the sentences about the event, the
;;;; sentences about the new state, and that nothing is both initiated and terminated.  With a
;;;; concrete initial state everything folds to T and NIL, and Z3 is not needed.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (state (:constructor make-state (ground time values)) (:copier nil))
  "The propositions of the ground fluents at one timepoint."
  (ground nil :type ground-theory :read-only t)
  (time 0 :type (integer 0) :read-only t)
  (values #() :type simple-vector :read-only t))

(setf (documentation 'state-ground 'function)
      "Return the ground theory of a state."
      (documentation 'state-time 'function)
      "Return the timepoint of a state, counted from 0."
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

(defun symbolic-state (ground context)
  "Return the state of GROUND at timepoint 0 in which each fluent is a new variable in the Z3
CONTEXT."
  (make-state ground 0
              (map 'simple-vector (lambda (atom) (z3:variable context (atom-text atom)))
                   (ground-theory-fluents ground))))

(defun concrete-state (ground value-of)
  "Return the state of GROUND at timepoint 0 in which the fluent ATOM has the proposition that the
function VALUE-OF returns for it."
  (make-state ground 0 (map 'simple-vector value-of (ground-theory-fluents ground))))

(defun holds (formula states &optional event)
  "Return the proposition that the ground FORMULA is in the list STATES: the states at ?time,
?time + 1, ....  EVENT is the number of the event that happens at ?time, NIL for none, or a list of
these for the successive timepoints."
  (let ((events (if (listp event) event (list event))))
    (labels ((evaluate (formula)
               (if (atom formula)
                   formula
                   (ecase (first formula)
                     (:fluent (svref (state-values (nth (third formula) states))
                                     (second formula)))
                     (:event (eql (second formula) (nth (third formula) events)))
                     (:and (z3:conjunction (mapcar #'evaluate (rest formula))))
                     (:or (z3:disjunction (mapcar #'evaluate (rest formula))))
                     (:not (z3:negation (evaluate (second formula))))
                     (:iff (z3:equivalence (evaluate (second formula))
                                           (evaluate (third formula))))))))
      (evaluate formula))))

;; Sentences about one timepoint, and those about a step.

(defun sentences-over (ground last)
  (remove-if-not (lambda (sentence)
                   (and (not (sentence-absolute sentence)) (= (sentence-last sentence) last)
                        (= (sentence-first sentence) 0)))
                 (ground-theory-sentences ground)))

(defun sentence-conditions (sentences states &optional event)
  (loop for sentence in sentences
        for proposition = (holds (sentence-formula sentence) states event)
        unless (eq proposition t) collect (cons (sentence-axiom sentence) proposition)))

(defun initial-conditions (state)
  "Return what must be true of the initial STATE: a list of (axiom . proposition), the theory's
INITIALLY axioms and its sentences about single states."
  (let ((ground (state-ground state)))
    (append (sentence-conditions (ground-theory-initial-conditions ground) (list state))
            (sentence-conditions (sentences-over ground 0) (list state)))))

(defun progress (state event)
  "Return the state after EVENT, the number of an event or NIL for none, happened in STATE, and what
must be true for that: a list of (axiom . proposition), where the axiom is NIL for the conflict of
an effect with its opposite."
  (let* ((ground (state-ground state))
         (values (copy-seq (state-values state)))
         (effects (and event (svref (ground-theory-effects ground) event)))
         (conditions '()))
    (dolist (index (remove-duplicates (mapcar #'effect-fluent effects)))
      (flet ((affected (kind)
               (z3:disjunction (loop for effect in effects
                                     when (and (eq (effect-kind effect) kind)
                                               (= (effect-fluent effect) index))
                                       collect (holds (effect-guard effect) (list state)
                                                      event)))))
        (let* ((initiated (affected :initiates))
               (terminated (affected :terminates))
               (compatible (z3:negation (z3:conjunction (list initiated terminated)))))
          (unless (eq compatible t) (push (cons nil compatible) conditions))
          (setf (svref values index)
                (z3:disjunction
                 (list initiated (z3:conjunction (list (svref values index)
                                                       (z3:negation terminated)))))))))
    (let ((next (make-state ground (1+ (state-time state)) values)))
      (values next
              (append (sentence-conditions (sentences-over ground 1) (list state next) event)
                      conditions
                      (sentence-conditions (sentences-over ground 0) (list next)))))))
