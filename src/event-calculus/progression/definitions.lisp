;;;; What makes events happen and predicates true: definitions.
;;;;
;;;; In progression nothing happens but the events given and those that the theory triggers.  So
;;;; each event that occurs positively in a sentence is completed, as completion.lisp says it:
;;;;   e <-> not S1[e := false] or not S2[e := false] or ...
;;;; The right-hand side is the DEFINITION of e, each part of it a SUPPORT, whose formula is moved
;;;; so that e itself is at distance 0.  The theory's own predicates have definitions, too: where
;;;; the theory completes them, or where a sentence says (iff predicate formula).  What has none is
;;;; open.
;;;;
;;;; A support that looks ahead, at a later timepoint than that of its atom, cannot be evaluated
;;;; when it is needed; see resolve.lisp.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (support (:copier nil))
  "What makes an atom true: FORMULA.  FIRST and LAST are the distances that the sentence behind it
spans.  AHEAD-P is true if they must all be there for it, and are not yet at the time of the atom."
  (formula t :type (or boolean cons) :read-only t)
  (first 0 :type fixnum :read-only t)
  (last 0 :type fixnum :read-only t)
  (ahead-p nil :type boolean :read-only t))

(defstruct (definition (:copier nil))
  "An atom is true just if in each of ALTERNATIVES, lists of supports, one of a completion, some
support is.  AHEAD-P is true if a support looks ahead, EXTENT is 1 if the value depends on the
events of the timepoint."
  (alternatives '() :type list :read-only t)
  (ahead-p nil :type boolean :read-only t)
  (extent 0 :type bit))

;;; Supports

(defun atom-supports (kind index pairs)
  "Return the supports of an atom in PAIRS, a list of (sentence . distance)."
  (loop for (sentence . distance) in pairs
        for formula = (shift-formula
                       (negated (replace-atom (sentence-formula sentence)
                                              (if (eq kind :static)
                                                  (list kind index)
                                                  (list kind index distance))
                                              nil))
                       (- distance))
        when formula
          collect (new-support formula sentence distance (if (eq kind :event) 1 0))))

(defun new-support (formula sentence distance duration)
  "Return the support that FORMULA is, by SENTENCE, for an atom at DISTANCE that lasts for
DURATION."
  (let ((last (- (sentence-last sentence) distance)))
    (make-support :formula (plain-parts-first formula)
                  :first (min (- (sentence-first sentence) distance) (formula-start formula))
                  :last last
                  :ahead-p (or (looks-ahead-p formula)
                               (> last (max duration (span-end formula)))))))

(defun completion-labels (theory predicate)
  "Return the list of the labels under which THEORY completes PREDICATE."
  (loop for (label completed) in (theory-completions theory)
        when (eq completed predicate) collect label))

(defun supporting-p (axiom label)
  "Return true if a completion with LABEL counts the sentences of AXIOM."
  (let ((own (and (axiom-p axiom) (axiom-label axiom))))
    (if label (eq own label) (not (eq own +facts+)))))

(defun event-labels (theory)
  "Return the list of the labels under which events are completed in progression."
  (or (completion-labels theory :happens) (list nil)))

(defun new-definition (alternatives)
  (make-definition :alternatives alternatives
                   :ahead-p (loop for supports in alternatives
                                    thereis (some #'support-ahead-p supports))))

(defun relative-pairs (table index)
  (remove-if #'sentence-absolute (gethash index table) :key #'car))

(defun event-definitions (ground)
  "Return a table from the number of each event that a sentence about an arbitrary timepoint can
make happen to its definition."
  (let ((tables (loop for label in (event-labels (ground-theory-theory ground))
                      collect (supports ground :event label)))
        (definitions (make-hash-table)))
    (dolist (table tables definitions)
      (loop for index being the hash-keys of table
            unless (gethash index definitions)
              do (let ((alternatives (loop for table in tables
                                           collect (atom-supports :event index
                                                                  (relative-pairs table index)))))
                   (when (some #'identity alternatives)
                     (setf (gethash index definitions) (new-definition alternatives))))))))

;;; Predicates

(defun equated-predicate (sentence)
  "Return the atom of a predicate that SENTENCE equates with a formula, and that formula, or NIL."
  (flet ((predicate-p (formula)
           (and (consp formula) (eq (first formula) :predicate))))
    (let ((formula (sentence-formula sentence)))
      (cond ((sentence-absolute sentence) nil)
            ((predicate-p formula) (values formula t))
            ((and (eq (first formula) :not) (predicate-p (second formula)))
             (values (second formula) nil))
            ((eq (first formula) :iff)
             (loop for (atom other) in (list (rest formula) (reverse (rest formula)))
                   when (and (predicate-p atom)
                             (not (looks-ahead-p (shift-formula other (- (third atom)))))
                             (equal other (replace-atom other atom nil)))
                     return (values atom other)))))))

(defun equated-predicates (ground completed-p)
  "Return a table from the number of each predicate that a sentence equates with a formula to its
definition, and the list of these sentences.  Predicates that are COMPLETED-P have none."
  (let ((definitions (make-hash-table)) (used '()))
    (dolist (sentence (ground-theory-sentences ground) (values definitions used))
      (multiple-value-bind (atom formula) (equated-predicate sentence)
        (when (and atom
                   (not (gethash (second atom) definitions))
                   (not (funcall completed-p (second atom))))
          (push sentence used)
          (setf (gethash (second atom) definitions)
                (new-definition
                 (list (let ((distance (third atom)))
                         (and formula
                              (list (new-support (shift-formula formula (- distance))
                                                 sentence distance 0))))))))))))

(defun predicate-labels (ground index)
  "Return the labels under which the predicate with the number INDEX is completed."
  (completion-labels (ground-theory-theory ground)
                     (first (aref (atom-table-atoms (ground-theory-predicates ground)) index))))

(defun completed-predicates (ground definitions)
  "Add the definitions of the predicates that are completed to the table DEFINITIONS."
  (let ((tables (make-hash-table :test 'eq)))
    (flet ((pairs (label index)
             (let ((table (or (gethash label tables)
                              (setf (gethash label tables) (supports ground :predicate label)))))
               (relative-pairs table index))))
      (dotimes (index (length (atom-table-atoms (ground-theory-predicates ground))) definitions)
        (let ((labels (predicate-labels ground index)))
          (when labels
            (setf (gethash index definitions)
                  (new-definition (loop for label in labels
                                        collect (atom-supports :predicate index
                                                               (pairs label index)))))))))))

(defun depends-on-events-p (formula predicates)
  "Return true if the ground FORMULA depends on the events of its timepoint."
  (map-atoms (lambda (atom)
               (when (and (eql (third atom) 0)
                          (case (first atom)
                            (:event t)
                            (:predicate (let ((definition (gethash (second atom) predicates)))
                                          (and definition (= 1 (definition-extent definition)))))))
                 (return-from depends-on-events-p t)))
             formula))

(defun set-extents (predicates)
  "Find out which of the definitions in the table PREDICATES depend on the events of their
timepoint, and return the table."
  (loop while (loop with changed = nil
                    for definition being the hash-values of predicates
                    do (when (and (zerop (definition-extent definition))
                                  (not (definition-ahead-p definition))
                                  (loop for supports in (definition-alternatives definition)
                                          thereis (loop for support in supports
                                                          thereis (depends-on-events-p
                                                                   (support-formula support)
                                                                   predicates))))
                         (setf (definition-extent definition) 1
                               changed t))
                    finally (return changed)))
  predicates)
