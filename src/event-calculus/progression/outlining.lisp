;;;; Making outlines: exclusions, timeless atoms, and which sentences need not be judged at all.
;;;;
;;;; Timeless atoms that the theory settles, by facts and by completion, are constants; the others
;;;; become variables of the initial state.  Entry point: GROUND-OUTLINE.

(in-package #:discrepancy-finder.event-calculus)

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
  "Return the demand that the timeless ATOM with number INDEX is true only if one of PAIRS,
(sentence . distance), supports it; or NIL if these depend on the time."
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
  (or (outline-dated-p outline) (axioms-look-back-p outline)))

(defun axioms-look-back-p (outline)
  "Return true if OUTLINE looks at timepoints before that of the latest state, dated instances
aside."
  (flet ((definition-looks-back-p (definition)
           (loop for supports in (definition-alternatives definition)
                   thereis (loop for support in supports
                                   thereis (minusp (support-first support)))))
         (influence-looks-back-p (influence)
           (loop for guards in (list (influence-initiates influence)
                                     (influence-terminates influence)
                                     (influence-releases influence))
                   thereis (some #'minusp (mapcar #'car guards)))))
    (and (or (outline-causes outline)
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
