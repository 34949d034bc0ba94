;;;; Outlines: what progression has to know of a ground theory, found out once.
;;;;
;;;; An OUTLINE says for each event what it changes, and sorts the sentences by when they have to be
;;;; looked at: DEMANDS are the sentences that a step must not violate.  A sentence about one
;;;; timepoint is looked at where one of its fluents has changed, one that is true unless some event
;;;; happens where that event does (a precondition, as a rule), all others at each step.
;;;; Entry point: GROUND-OUTLINE.

(in-package #:discrepancy-finder.event-calculus)

(defparameter *to-come* "it speaks of all timepoints to come"
  "Why an axiom is never judged.")

(defstruct (demand (:copier nil))
  "That FORMULA is true at each timepoint; it looks at timepoints up to the distance LAST.  AXIOM is
the axiom behind it, or the exclusion, a list.  FLUENTS are the numbers of the fluents in it."
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
          ((or (mentions-kind-p formula '(:predicate :released :compare)) (null (demand-fluents demand)))
           (push demand (outline-state-demands outline)))
          (t (dolist (fluent (demand-fluents demand))
               (push demand (svref (outline-state-demands-of outline) fluent)))))))

;;; What need not be judged

(defun disjuncts (formula)
  (if (and (consp formula) (eq (first formula) :or)) (rest formula) (list formula)))

(defun provided-p (outline sentence)
  "Return true if SENTENCE is true by the definition of one of its events or predicates."
  (and (not (sentence-absolute sentence))
       (loop for atom in (disjuncts (sentence-formula sentence))
               thereis (and (member (first atom) '(:event :predicate))
                            (let ((labels (atom-labels (outline-ground outline) (first atom)
                                                       (second atom)))
                                  (definition (gethash (second atom)
                                                       (if (eq (first atom) :event)
                                                           (outline-events outline)
                                                           (outline-predicates outline)))))
                              (and definition (not (definition-ahead-p definition))
                                   (= 1 (length labels))
                                   (supporting-p (sentence-axiom sentence) (first labels))))))))

;;; Exclusions

(defun fluent-exclusion-demands (ground kind names)
  "Return the demands that say that at most one (:mutex) or just one (:xor) instance of the fluents
NAMES holds."
  (let* ((literals (loop for number in (rest (excluded-atoms ground names))
                         collect (list :fluent number 0)))
         (formulas (append (and (eq kind :xor) (list (fold :or literals)))
                           (loop for (literal . others) on literals
                                 append (loop for other in others
                                              collect (fold :or (list (fold-not literal)
                                                                      (fold-not other))))))))
    (loop for formula in formulas
          collect (make-demand :axiom (cons kind names) :formula formula
                               :fluents (formula-fluents formula)))))

(defun add-exclusions (outline)
  (let ((ground (outline-ground outline)))
    (when (ground-theory-one-event-at-a-time ground)
      (push (list* (ground-theory-one-event-at-a-time ground) :mutex t)
            (outline-exclusions outline)))
    (loop for (kind . names) in (theory-exclusions (ground-theory-theory ground))
          for (atom-kind . numbers) = (excluded-atoms ground names)
          do (if (eq atom-kind :event)
                 (push (list* (cons kind names) kind numbers) (outline-exclusions outline))
                 (dolist (demand (fluent-exclusion-demands ground kind names))
                   (file-demand outline demand))))))

;;; Timeless atoms

(defun timeless-p (theory sentence)
  "Return true if neither the formula of SENTENCE nor its bindings depend on the time."
  (and (null (formula-reach (sentence-formula sentence)))
       (loop for (variable) in (sentence-bindings sentence)
             never (eq (variable-sort theory variable) :time))))

(defun completion-demand (theory atom index pairs)
  "Return the demand that the timeless ATOM with number INDEX is true only if one of PAIRS, (sentence
. distance), supports it; or NIL if these depend on the time."
  (when (loop for (sentence) in pairs always (timeless-p theory sentence))
    (make-demand :axiom (list :completion (first atom))
                 :formula (fold :or (cons (list :not (list :static index))
                                          (mapcar #'support-formula
                                                  (atom-supports :static index pairs)))))))

(defun static-demands (outline sentences)
  "Return what SENTENCES, all those of the theory of OUTLINE, and the completions say of timeless
atoms; note the completions that depend on the time as limits."
  (let* ((ground (copy-structure (outline-ground outline)))
         (theory (ground-theory-theory ground))
         (atoms (atom-table-atoms (ground-theory-statics ground)))
         (tables (make-hash-table :test 'eq))
         (demands (loop for sentence in sentences
                        when (timeless-p theory sentence)
                          collect (sentence-demand outline sentence))))
    (setf (ground-theory-sentences ground) sentences)
    (loop for atom across atoms
          for index from 0
          do (dolist (label (completion-labels theory (first atom)))
               (let ((demand (completion-demand
                              theory atom index
                              (gethash index
                                       (or (gethash label tables)
                                           (setf (gethash label tables)
                                                 (supports ground :static label)))))))
                 (if demand
                     (push demand demands)
                     (pushnew (cons (list :completion (first atom)) *to-come*)
                              (outline-limits outline) :test #'equal)))))
    demands))

(defun set-statics (outline)
  "Find out what is known of the timeless atoms, and what else must be true of them."
  (let* ((ground (outline-ground outline))
         (demands (static-demands outline (append (ground-theory-sentences ground)
                                                  (dated-sentences outline))))
         (statics (make-array (length (atom-table-atoms (ground-theory-statics ground)))
                              :initial-element :open)))
    (settle statics (loop for index below (length statics) collect index)
            (constantly (mapcar #'demand-formula demands))
            :static)
    (setf (outline-statics outline) statics
          (outline-static-demands outline) demands)))

;;; The whole

(defun set-release (outline ground)
  "Note which fluents GROUND, the ground theory of OUTLINE or a copy with dated instances, can
release, and which are causes of trajectories."
  (flet ((numbers (vector)
           (loop for entry across vector
                 for fluent from 0
                 when entry collect fluent)))
    (setf (outline-release outline) (ground-theory-release ground)
          (outline-loose-fluents outline) (numbers (ground-theory-release ground))
          (outline-causes outline) (numbers (ground-theory-changes ground)))))

(defun make-empty-outline (ground)
  (let ((range (theory-time-range (ground-theory-theory ground))))
    (make-outline :ground ground :first-time (if range (car range) 0)
                  :influences (all-influences ground) :dated-p (needs-dated-p ground)
                  :state-demands-of (make-array (length (ground-theory-fluents ground))
                                               :initial-element '())
                  :event-demands-of (make-array (length (ground-theory-events ground))
                                               :initial-element '()))))

(defun looks-back-p (outline)
  "Return true if OUTLINE looks at timepoints before that of the latest state."
  (flet ((definition-looks-back-p (definition)
           (loop for supports in (definition-alternatives definition)
                   thereis (loop for support in supports
                                   thereis (minusp (support-first support)))))
         (influence-looks-back-p (influence)
           (loop for guards in (list (influence-initiates influence)
                                     (influence-terminates influence)
                                     (influence-releases influence))
                   thereis (some #'minusp (mapcar #'car guards)))))
    (and (or (outline-dated-p outline)
             (outline-causes outline)
             (find-if (lambda (demand) (> (demand-last demand) 1)) (outline-other-demands outline))
             (loop for table in (list (outline-events outline) (outline-predicates outline))
                     thereis (loop for definition being the hash-values of table
                                     thereis (definition-looks-back-p definition)))
             (some (lambda (influences) (some #'influence-looks-back-p influences))
                   (outline-influences outline)))
         t)))

(defun compute-outline (ground)
  (let ((outline (make-empty-outline ground)))
    (multiple-value-bind (equated used)
        (equated-predicates ground (lambda (index) (predicate-labels ground index)))
      (setf (outline-events outline) (event-definitions ground)
            (outline-predicates outline) (set-extents (completed-predicates ground equated)))
      (dolist (sentence (ground-theory-sentences ground))
        (unless (or (sentence-absolute sentence) (member sentence used)
                    (provided-p outline sentence))
          (let ((demand (sentence-demand outline sentence)))
            (when (> (effective-last outline sentence) (sentence-last sentence))
              (setf (outline-late-p outline) t))
            (file-demand outline demand))))
      (add-exclusions outline)
      (set-release outline ground)
      (when (outline-dated-p outline)
        (outline-dated-until outline (outline-first-time outline)))
      (set-statics outline)
      (setf (outline-memory-p outline) (looks-back-p outline))
      (map nil (lambda (effects) (note-numeric-limits outline effects))
           (ground-theory-effects-on-numeric ground))
      outline)))

(defvar *outlines* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The outline of each ground theory that was progressed.")

(defun ground-outline (ground)
  "Return the OUTLINE of GROUND, which is computed once."
  (or (gethash ground *outlines*)
      (setf (gethash ground *outlines*) (compute-outline ground))))
