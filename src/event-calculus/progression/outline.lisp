;;;; Outlines: what progression has to know of a ground theory, found out once.
;;;;
;;;; An OUTLINE says for each event what it changes, and sorts the sentences by when they have to
;;;; be looked at: DEMANDS are the sentences that a step must not violate.  A sentence about one
;;;; timepoint is looked at where one of its fluents has changed, one that is true unless some
;;;; event happens where that event does (a precondition, as a rule), all others at each step.
;;;; Outlines are made by GROUND-OUTLINE, in outlining.lisp.

(in-package #:discrepancy-finder.event-calculus)

(defparameter *to-come* "it speaks of all timepoints to come"
  "Why an axiom is never judged.")

(defstruct (demand (:copier nil))
  "That FORMULA is true at each timepoint; it looks at timepoints up to the distance LAST.  AXIOM
is the axiom behind it, or the exclusion, a list.  FLUENTS are the numbers of the fluents in it."
  (axiom nil :type (or null axiom cons) :read-only t)
  (formula nil :type (or boolean cons) :read-only t)
  (last 0 :type fixnum :read-only t)
  (fluents '() :type list :read-only t))

(defstruct (influence (:copier nil))
  "What an event does to the fluent with the number FLUENT: the guards of the effects, each
(least-distance . formula).  AHEAD-P is true if one of them looks ahead."
  (fluent 0 :type fixnum :read-only t)
  (initiates '() :type list)
  (terminates '() :type list)
  (releases '() :type list)
  (ahead-p nil :type boolean))

(defstruct (outline (:copier nil))
  "What progression has to know of GROUND.  FIRST-TIME is its first timepoint."
  (ground nil :type ground-theory :read-only t)
  (first-time 0 :type integer :read-only t)
  ;; for each event its influences
  (influences #() :type simple-vector)
  ;; tables from numbers to definitions
  (events (make-hash-table) :type hash-table)
  (predicates (make-hash-table) :type hash-table)
  ;; for each fluent whether it can be released, as in the ground theory; the numbers of those that
  ;; can, and of the causes of trajectories
  (release #() :type simple-vector)
  (loose-fluents '() :type list)
  (causes '() :type list)
  ;; for each timeless atom T, NIL or :OPEN, and what must be true of these
  (statics #() :type simple-vector)
  (static-demands '() :type list)
  ;; demands on one timepoint: for each fluent, and those that also depend on other things
  (state-demands-of #() :type simple-vector)
  (state-demands '() :type list)
  ;; demands on a step: for each event, and for all
  (event-demands-of #() :type simple-vector)
  (other-demands '() :type list)
  ;; (axiom :mutex or :xor . numbers) of events, the axiom as in demands, NUMBERS T for all
  (exclusions '() :type list)
  ;; what is never judged: a list of (axiom . reason)
  (limits '() :type list)
  ;; whether sentences are judged later than they end, when the events of that timepoint are known
  (late-p nil :type boolean)
  ;; whether anything looks at more than the latest state and the events after it
  (memory-p nil :type boolean)
  ;; the instances of the axioms that compare timepoints or name them by number; see dated.lisp
  (dated-p nil :type boolean :read-only t)
  (dated nil))

;;; Influences

(defun group-effects (effects)
  "Return the influences that EFFECTS, those of one event, amount to."
  (let ((influences '()))
    (dolist (effect effects (nreverse influences))
      (let ((influence (or (find (effect-fluent effect) influences :key #'influence-fluent)
                           (first (push (make-influence :fluent (effect-fluent effect))
                                        influences))))
            (guard (cons (formula-start (effect-guard effect)) (effect-guard effect))))
        (ecase (effect-kind effect)
          (:initiates (push guard (influence-initiates influence)))
          (:terminates (push guard (influence-terminates influence)))
          (:releases (push guard (influence-releases influence))))
        (when (looks-ahead-p (effect-guard effect))
          (setf (influence-ahead-p influence) t))))))

(defun all-influences (ground)
  (map 'simple-vector (lambda (effects) (group-effects (remove-if #'effect-time effects)))
       (ground-theory-effects ground)))

;;; Sorting the sentences

(defun formula-fluents (formula)
  "Return the numbers of the fluents in the ground FORMULA, in order."
  (let ((fluents '()))
    (map-atoms (lambda (atom)
                 (when (eq (first atom) :fluent) (pushnew (second atom) fluents)))
               formula)
    (sort fluents #'<)))

(defun formula-end (outline formula)
  "Return the last distance that must be known to evaluate the ground FORMULA; its predicates may
depend on the events of their timepoint.  Return the least integer if it has no time."
  (let ((end most-negative-fixnum))
    (map-atoms (lambda (atom)
                 (case (first atom)
                   (:event (setf end (max end (1+ (third atom)))))
                   (:predicate
                    (let ((definition (gethash (second atom) (outline-predicates outline))))
                      (setf end (max end (+ (third atom)
                                            (if definition (definition-extent definition) 0))))))
                   (t (setf end (max end (or (formula-reach atom) end))))))
               formula)
    end))

(defun effective-last (outline sentence)
  (max (sentence-last sentence) (formula-end outline (sentence-formula sentence))))

(defun sentence-demand (outline sentence)
  "Return SENTENCE as a demand: moved, unless it is an instance for given timepoints, so that its
first distance is 0."
  (let* ((formula (sentence-formula sentence))
         (shift (if (sentence-absolute sentence)
                    0
                    (- (min (sentence-first sentence) (formula-start formula))))))
    (make-demand :axiom (sentence-axiom sentence)
                 :formula (plain-parts-first (shift-formula formula shift))
                 :last (+ shift (effective-last outline sentence))
                 :fluents (formula-fluents formula))))

(defun guarding-events (formula)
  "Return the numbers of events at distance 0, as few as possible, such that FORMULA is true unless
one of them happens; or NIL if there are none."
  (let ((events '()))
    (map-atoms (lambda (atom)
                 (when (and (eq (first atom) :event) (eql (third atom) 0))
                   (pushnew (second atom) events)))
               formula)
    (flet ((without (formula event) (replace-atom formula (list :event event 0) nil)))
      (let ((single (find-if (lambda (event) (eq t (without formula event))) events)))
        (cond (single (list single))
              ((eq t (reduce #'without events :initial-value formula)) events))))))

(defun file-demand (outline demand)
  "Add DEMAND, whose first distance is 0, to the list of OUTLINE where it belongs."
  (let* ((formula (demand-formula demand))
         (once (zerop (demand-last demand)))
         (guards (and (= 1 (demand-last demand)) (guarding-events formula))))
    (cond (guards
           (dolist (event guards)
             (push demand (svref (outline-event-demands-of outline) event))))
          ((not once) (push demand (outline-other-demands outline)))
          ((or (mentions-kind-p formula '(:predicate :released :compare))
               (null (demand-fluents demand)))
           (push demand (outline-state-demands outline)))
          (t (dolist (fluent (demand-fluents demand))
               (push demand (svref (outline-state-demands-of outline) fluent)))))))
