;;;; The Discrete Event Calculus by brute force: an evaluator to test the reasoner against.
;;;;
;;;; It reads the declarations and the axioms of a theory and shares nothing else with the
;;;; reasoner.  DEC1 to DEC12 are written as in the literature, for all fluents, events and
;;;; timepoints; completion is done clause by clause; models are found by trying both values of each
;;;; atom, a branch being left when a constraint is false whatever the other atoms are.  A model is
;;;; an integer whose bit n is set if the atom with the number n is true.
;;;; Entry point: FORCED-MODELS.

(in-package #:discrepancy-finder.tests)

;;; The axioms of a theory

(defun head-p (form)
  "Return true if FORM is (condition implies) an effect or a trajectory, or several of them."
  (case (first form)
    (:forall (head-p (third form)))
    (:implies (head-p (third form)))
    (:and (and (rest form) (every #'head-p (rest form))))
    ((:initiates :terminates :releases :trajectory :anti-trajectory) t)))

(defun note-heads (oracle form condition)
  "Note in ORACLE what the instance FORM says of effects and trajectories under CONDITION."
  (case (first form)
    (:forall (dolist (instance (instances oracle (second form) (third form)))
               (note-heads oracle instance condition)))
    (:implies (note-heads oracle (third form) (list :and condition (second form))))
    (:and (dolist (part (rest form)) (note-heads oracle part condition)))
    (t (push condition
             (gethash (cons (first form)
                            (mapcar (lambda (term) (term-value oracle term)) (rest form)))
                      (if (member (first form) '(:trajectory :anti-trajectory))
                          (oracle-changes oracle)
                          (oracle-effects oracle)))))))

(defun value-p (oracle form)
  "Return true if FORM gives a function's value."
  (case (first form)
    (:forall (value-p oracle (third form)))
    (:= (and (consp (second form))
             (find (first (second form)) (ec:theory-functions (oracle-theory oracle))
                   :key #'caar)
             t))))

(defun note-values (oracle form)
  "Note in ORACLE the values that FORM, (= (function term*) term), gives."
  (loop while (eq (first form) :forall) do (setf form (third form)))
  (destructuring-bind (application value) (rest form)
    (loop for (name . terms) in (axiom-instances oracle (append application (list value)))
          for values = (mapcar (lambda (term) (term-value oracle term)) terms)
          do (setf (gethash (cons name (butlast values)) (oracle-function-values oracle))
                   (first (last values))))))

(defun at-time (form theory time)
  "Return FORM, in which fluents stand for themselves, as a formula about TIME."
  (ecase (formula-kind form)
    (:connective (cons (first form)
                       (mapcar (lambda (part) (at-time part theory time)) (rest form))))
    (:quantifier (list (first form) (second form) (at-time (third form) theory time)))
    (:comparison form)
    (:atom (if (assoc (first form) (ec:theory-fluents theory))
               (list :holds-at form time)
               form))))

(defun make-theory-oracle (theory first last &optional (axioms (ec:theory-axioms theory)))
  "Return the oracle of THEORY with AXIOMS for the timepoints FIRST to LAST, and a list of
(label . ground formula), the sentences."
  (let* ((oracle (make-oracle :theory theory :first first :last last))
         (values (remove-if-not (lambda (axiom) (value-p oracle (ec:axiom-formula axiom))) axioms))
         (heads (remove-if-not (lambda (axiom) (head-p (ec:axiom-formula axiom))) axioms))
         (sentences (remove-if (lambda (axiom) (member axiom (append values heads))) axioms)))
    (dolist (axiom values)
      (note-values oracle (ec:axiom-formula axiom)))
    (dolist (axiom heads)
      (dolist (instance (axiom-instances oracle (ec:axiom-formula axiom)))
        (note-heads oracle instance '(:and))))
    (values oracle
            (loop for axiom in sentences
                  for form = (ec:axiom-formula axiom)
                  append (loop for instance in (axiom-instances
                                                oracle
                                                (if (eq (first form) :initially)
                                                    (at-time (second form) theory first)
                                                    form))
                               collect (cons (ec:axiom-label axiom)
                                             (ground-instance oracle instance)))))))

;;; DEC

(defun dec-axioms (oracle)
  "Return the instances of DEC3 to DEC12 as ground formulas."
  (let* ((theory (oracle-theory oracle))
         (first (oracle-first oracle)) (last (oracle-last oracle))
         (events (all-events oracle))
         (constraints '()))
    (labels ((holds (fluent time) (atom-number oracle :holds-at fluent time))
             (released (fluent time) (atom-number oracle :released-at fluent time))
             (all (&rest parts) (junction :and parts))
             (none (formula) (negation formula))
             (initiates (event fluent time) (relation oracle :initiates event fluent time))
             (terminates (event fluent time) (relation oracle :terminates event fluent time))
             (releases (event fluent time) (relation oracle :releases event fluent time))
             (some-event (time condition)
               (junction :or (loop for event in events
                                   collect (all (atom-number oracle :happens event time)
                                                (funcall condition event)))))
             (axiom (premise conclusion)
               (push (junction :or (list (none premise) conclusion)) constraints))
             (dec5-to-8 (f time)
               (let ((next (1+ time)))
                 (flet ((initiated (event) (initiates event f time))
                        (terminated (event) (terminates event f time))
                        (changed (event) (junction :or (list (initiates event f time)
                                                             (terminates event f time))))
                        (let-go (event) (releases event f time)))
                   (axiom (all (holds f time) (none (released f next))
                               (none (some-event time #'terminated)))
                          (holds f next))
                   (axiom (all (none (holds f time)) (none (released f next))
                               (none (some-event time #'initiated)))
                          (none (holds f next)))
                   (axiom (all (released f time) (none (some-event time #'changed)))
                          (released f next))
                   (axiom (all (none (released f time)) (none (some-event time #'let-go)))
                          (none (released f next))))))
             (dec9-to-12 (f time)
               ;; An axiom each, so that the conditions of all of them are made of atoms.
               (let ((next (1+ time)))
                 (dolist (e events)
                   (flet ((effect (kind conclusion)
                            (dolist (condition (effect-conditions oracle kind e f time))
                              (axiom (all (atom-number oracle :happens e time) condition)
                                     conclusion))))
                     (effect :initiates (holds f next))
                     (effect :terminates (none (holds f next)))
                     (effect :releases (released f next))
                     (effect :initiates (none (released f next)))
                     (effect :terminates (none (released f next)))))))
             (dec3-and-4 (kind f1 time f2 offset condition)
               (multiple-value-bind (start stop) (if (eq kind :trajectory)
                                                     (values #'initiates #'terminates)
                                                     (values #'terminates #'initiates))
                 (when (and (< 0 offset) (<= (+ time offset) last))
                   (dolist (e events)
                     (axiom (all (atom-number oracle :happens e time)
                                 (funcall start e f1 time)
                                 condition
                                 (none (junction :or
                                                 (loop for between from (1+ time)
                                                         below (+ time offset)
                                                       collect (some-event
                                                                between
                                                                (lambda (e)
                                                                  (funcall stop e f1
                                                                           between)))))))
                            (holds f2 (+ time offset))))))))
      (dolist (f (all-fluents oracle))
        (if (member (first f) (ec:theory-non-inertial theory))
            (loop for time from first to last do (push (released f time) constraints))
            (progn
              (unless (or (eq (ec:theory-manual-release theory) t)
                          (member (first f) (ec:theory-manual-release theory)))
                (push (none (released f first)) constraints))
              (loop for time from first below last do (dec5-to-8 f time))))
        (loop for time from first below last do (dec9-to-12 f time)))
      (loop for key being the hash-keys of (oracle-changes oracle) using (hash-value conditions)
            do (destructuring-bind (kind f1 time f2 offset) key
                 (when (< time last)
                   (dec3-and-4 kind f1 time f2 offset
                               (junction :or (mapcar (lambda (condition)
                                                       (ground-instance oracle condition))
                                                     conditions))))))
      constraints)))

(defun exclusions (oracle)
  "Return what the theory's :mutex and :xor declarations say, as ground formulas."
  (flet ((numbers (predicate atoms names time)
           (loop for atom in atoms
                 when (member (first atom) names)
                   collect (atom-number oracle predicate atom time))))
    (loop for (kind . names) in (ec:theory-exclusions (oracle-theory oracle))
          append (loop for time from (oracle-first oracle) to (oracle-last oracle)
                       for atoms = (append (and (< time (oracle-last oracle))
                                                (numbers :happens (all-events oracle) names time))
                                           (numbers :holds-at (all-fluents oracle) names time))
                       append (loop for (atom . others) on atoms
                                    append (loop for other in others
                                                 collect (list :or (list :not atom)
                                                               (list :not other))))
                       when (and (eq kind :xor) atoms)
                         collect (junction :or atoms)))))

;;; Completion

(defun without-implied (clauses)
  "Return CLAUSES without those that hold an atom and its negation, or all literals of another."
  (let ((kept '()))
    (dolist (clause (sort (copy-list clauses) #'< :key #'length) (nreverse kept))
      (unless (or (some (lambda (literal) (member (- literal) clause)) clause)
                  (some (lambda (shorter) (subsetp shorter clause)) kept))
        (push clause kept)))))

(defun clauses (formula &optional (positive t))
  "Return the ground FORMULA, or its negation, in clauses: lists of atoms and negated atoms, by
distribution.  Clauses that are always true, or are so where others are, are left out."
  (flet ((every-part (parts)
           (without-implied (loop for part in parts append (clauses part positive))))
         (distribute (parts)
           (reduce (lambda (p q)
                     (without-implied
                      (loop for left in p
                            append (loop for right in q collect (union left right)))))
                   (mapcar (lambda (part) (clauses part positive)) parts))))
    (cond ((eq formula positive) '())
          ((integerp formula) (list (list (if positive formula (- formula)))))
          ((atom formula) (list '()))
          (t (destructuring-bind (operator . parts) formula
               (ecase operator
                 (:not (clauses (first parts) (not positive)))
                 (:and (if positive (every-part parts) (distribute parts)))
                 (:or (if positive (distribute parts) (every-part parts)))
                 (:iff (destructuring-bind (p q) parts
                         (clauses (if positive
                                      `(:and (:or (:not ,p) ,q) (:or ,p (:not ,q)))
                                      `(:and (:or ,p ,q) (:or (:not ,p) (:not ,q)))))))))))))

(defun completion-of (atom clauses)
  "Return the ground formula that ATOM is true only if it is needed by one of CLAUSES."
  (junction :or (cons (negation atom)
                      (loop for clause in clauses
                            when (member atom clause)
                              collect (junction :and
                                                (loop for literal in (remove atom clause)
                                                      collect (if (plusp literal)
                                                                  (negation literal)
                                                                  (- literal))))))))

(defun completions (oracle sentences open-events)
  "Return the completions that the theory declares, over SENTENCES, a list of (label . formula)."
  (loop for (label predicate) in (ec:theory-completions (oracle-theory oracle))
        for clauses = (loop for (own . formula) in sentences
                            when (if label (eq own label) (not (eq own ec::+facts+)))
                              append (clauses formula))
        append (loop for (name event) across (oracle-atoms oracle)
                     for number from 1
                     when (and (eq name predicate)
                               (not (and (eq name :happens) (member (first event) open-events))))
                       collect (completion-of number clauses))))

;;; Models

(defun truth (formula values)
  "Return 1 if FORMULA is true by VALUES, -1 if it is false, 0 if that is open."
  (declare (type (simple-array (signed-byte 8) (*)) values) (optimize speed (safety 1)))
  (labels ((look (formula)
             (cond ((typep formula 'fixnum) (aref values formula))
                   ((eq formula t) 1)
                   ((null formula) -1)
                   (t (let ((parts (rest (the cons formula))) (operator (first formula)))
                        (case operator
                          (:not (- (look (first parts))))
                          (:iff (* (look (first parts)) (look (second parts))))
                          (t (let* ((absorbing (if (eq operator :or) 1 -1))
                                    (result (- absorbing)))
                               (declare (type (signed-byte 8) result))
                               (dolist (part parts result)
                                 (let ((value (look part)))
                                   (cond ((= value absorbing) (return value))
                                         ((zerop value) (setf result 0)))))))))))))
    (declare (ftype (function (t) (signed-byte 8)) look))
    (look formula)))

(defun numbers-in (formula)
  (cond ((integerp formula) (list formula))
        ((consp formula) (remove-duplicates (mapcan #'numbers-in (copy-list (rest formula)))))))

(defun place-in-time (oracle number)
  "Return a number by which the atom NUMBER is tried after those before it in time."
  (let* ((atom (aref (oracle-atoms oracle) (1- number)))
         (times (loop for value in (rest atom)
                      for sort in (signature oracle (first atom))
                      when (eq sort :time) collect value)))
    (+ (* 4 (reduce #'max times :initial-value (1- (oracle-first oracle))))
       (or (position (first atom) '(:holds-at :released-at :happens)) 3))))

(defstruct (trial (:conc-name nil) (:copier nil))
  "The constraints of each atom, by its number, and the value of each: 1, -1, or 0 if it has none."
  (constraints-of #() :type simple-vector :read-only t)
  (trial-values nil :type (simple-array (signed-byte 8) (*)) :read-only t))

(defun forced-value (constraint number values)
  "Return the only value that the atom NUMBER can have if CONSTRAINT is true, or NIL."
  (flet ((possible-p (value)
           (setf (aref values number) value)
           (/= -1 (the fixnum (truth constraint values)))))
    (prog1 (cond ((not (possible-p 1)) -1)
                 ((not (possible-p -1)) 1))
      (setf (aref values number) 0))))

(defun assign (trial number value)
  "Give the atom NUMBER its VALUE, and others those that constraints force on them.  Return the list
of these atoms, and true unless a constraint is false."
  (let* ((values (trial-values trial)) (assigned (list number)) (queue assigned))
    (setf (aref values number) value)
    (loop while queue
          do (loop for (constraint . numbers) in (svref (constraints-of trial) (pop queue))
                   do (case (truth constraint values)
                        (-1 (return-from assign (values assigned nil)))
                        (0 (dolist (other numbers)
                             (when (zerop (aref values other))
                               (let ((forced (forced-value constraint other values)))
                                 (when forced
                                   (setf (aref values other) forced)
                                   (push other assigned)
                                   (push other queue)))))))))
    (values assigned t)))

(defun make-constraint-trial (oracle constraints)
  (let* ((size (1+ (length (oracle-atoms oracle))))
         (mentioning (make-array size :initial-element '())))
    (dolist (constraint constraints)
      (let ((entry (cons constraint (numbers-in constraint))))
        (dolist (number (rest entry))
          (push entry (svref mentioning number)))))
    (make-trial :constraints-of mentioning
                :trial-values (make-array size :element-type '(signed-byte 8)
                                               :initial-element 0))))

(defun assign-what-is-forced (trial numbers)
  "Give those atoms of NUMBERS a value that a constraint forces on them by itself.  Return true
unless a constraint is false."
  (loop with values = (trial-values trial)
        for number in numbers
        always (loop for (constraint) in (svref (constraints-of trial) number)
                     for forced = (and (zerop (aref values number))
                                       (forced-value constraint number values))
                     always (or (null forced) (nth-value 1 (assign trial number forced))))))

(defun satisfying (oracle constraints limit)
  "Return the models of CONSTRAINTS, a list of ground formulas, LIMIT at most; true if there are no
more; and the numbers of the atoms that occur."
  (let* ((constraints (remove t (remove-duplicates constraints :test #'equal)))
         (numbers (sort (remove-duplicates (loop for constraint in constraints
                                                 append (numbers-in constraint)))
                        #'< :key (lambda (number) (place-in-time oracle number))))
         (trial (make-constraint-trial oracle constraints))
         (values (trial-values trial))
         (models '()) (count 0))
    (labels ((model ()
               (loop for number in numbers
                     when (= 1 (aref values number)) sum (ash 1 number)))
             (search-on (numbers)
               (let ((rest (member-if (lambda (number) (zerop (aref values number))) numbers)))
                 (cond (rest (try (first rest) -1 (rest rest))
                             (try (first rest) 1 (rest rest)))
                       ((eql count limit)
                        (return-from satisfying (values models nil numbers)))
                       (t (incf count)
                          (push (model) models)))))
             (try (number value others)
               (multiple-value-bind (assigned possible) (assign trial number value)
                 (when possible (search-on others))
                 (dolist (number assigned) (setf (aref values number) 0)))))
      (when (and (not (member nil constraints)) (assign-what-is-forced trial numbers))
        (search-on numbers))
      (values models t numbers))))

(defun forced-models (theory &key (horizon (ec:theory-time-range theory)) where open-events limit)
  "Return the models of THEORY for HORIZON, (first . last), LIMIT at most, that satisfy the formula
WHERE; true if there are no more; the oracle that knows the atoms; and the numbers of those that
occur.  The completion of OPEN-EVENTS is left out."
  (destructuring-bind (first . last) horizon
    (multiple-value-bind (oracle sentences) (make-theory-oracle theory first last)
      (let* ((constraints (append (mapcar #'cdr sentences)
                                  (dec-axioms oracle)
                                  (exclusions oracle)
                                  (and where (list (ground-question oracle where)))))
             (completions (completions oracle sentences open-events)))
        (multiple-value-bind (models complete numbers)
            (satisfying oracle (append constraints completions) limit)
          (values models complete oracle numbers))))))
