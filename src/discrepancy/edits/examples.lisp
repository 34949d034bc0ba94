;;;; Examples for edits: what actions changed, and could not do, in the runs so far.
;;;;
;;;; A TRANSITION is one step of a run: the observed state before, the event, the observed state
;;;; after.  To learn from one, its event and a fluent are LIFTED: elements become variables, which
;;;; are named by their sorts, the same element the same variable.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (transition (:copier nil))
  "What was seen of one step: the states BEFORE and AFTER as tables of truth values, EVENT (ground,
or NIL), the event SUCCESS that the binding of CLASS and TYPE has on success, and the OUTCOMES
(names) of the binding that the seen one can be.  REPORT is the failure in words, or an empty text."
  (class nil :type keyword :read-only t)
  (type nil :type keyword :read-only t)
  (before nil :type hash-table :read-only t)
  (after nil :type hash-table :read-only t)
  (event '() :type list :read-only t)
  (success '() :type list :read-only t)
  (succeeded-p t :type boolean :read-only t)
  (failure nil :type symbol :read-only t)
  (report "" :type string :read-only t)
  (outcomes '() :type list :read-only t))

(defun state-table (state)
  "Return the list STATE of (atom . truth) as a table."
  (let ((table (make-hash-table :test 'equal)))
    (loop for (atom . truth) in state do (setf (gethash atom table) truth))
    table))

(defun outcomes-like (outcomes seen)
  "Return those of OUTCOMES that the outcome SEEN, :SUCCESS or a failure class, can be."
  (remove-if-not (lambda (outcome)
                   (let ((name (symbolic:outcome-name outcome)))
                     (if (or (eq name :success) (eq seen :success))
                         (eq name seen)
                         (subtypep seen name))))
                 outcomes))

(defun refreshed-step (domain step)
  "Return STEP, of a run in some domain, with the outcomes that it can be in DOMAIN; of one that was
read back nothing more is known."
  (if (read-back-p step)
      step
      (step-with-outcomes domain step)))

(defun step-with-outcomes (domain step)
  "Return STEP with the outcomes that its designator can have in DOMAIN."
  (make-run-step :designator (run-step-designator step) :outcome (run-step-outcome step)
                 :candidates (outcomes-like (symbolic:action-outcomes domain
                                                                      (run-step-designator step))
                                            (run-step-outcome step))
                 :failure (run-step-failure step) :position (run-step-position step)
                 :state (run-step-state step)))

(defun step-transition (domain before step)
  "Return the transition from the table BEFORE that STEP of a run is in DOMAIN, or NIL if it can be
of several events."
  (let* ((outcomes (symbolic:action-outcomes domain (run-step-designator step)))
         (seen (outcomes-like outcomes (run-step-outcome step)))
         (events (remove-duplicates (mapcar #'symbolic:outcome-event seen) :test #'equal))
         (binding (symbolic:find-action-binding domain (run-step-designator step))))
    (unless (rest events)
      (make-transition :class (symbolic:action-binding-class binding)
                       :type (symbolic:action-binding-type binding)
                       :before before :after (state-table (run-step-state step))
                       :event (first events)
                       :success (symbolic:outcome-event (first outcomes))
                       :succeeded-p (eq (run-step-outcome step) :success)
                       :failure (run-step-outcome step) :report (or (run-step-failure step) "")
                       :outcomes (mapcar #'symbolic:outcome-name seen)))))

(defun run-transitions (domain run)
  "Return the list of the transitions of RUN, NIL for a step that teaches nothing."
  (loop for before = (state-table (run-initial-state run)) then (state-table (run-step-state step))
        for step in (run-steps run)
        collect (unless (read-back-p step)
                  (step-transition domain before step))))

;;; Lifting

(defun declared-sorts (theory atom kind)
  "Return the sorts of the arguments of ATOM, a fluent or an event of THEORY by KIND."
  (rest (assoc (first atom) (ecase kind
                              (:fluent (ec:theory-fluents theory))
                              (:event (ec:theory-events theory))))))

(defun variable-named (sort number)
  "Return the variable of SORT with NUMBER, or without one if that is NIL."
  (intern (format nil "?~a~@[~d~]" (symbol-name sort) number) :keyword))

(defun sorted-elements (theory atoms)
  "Return the distinct (sort . element) of the arguments of ATOMS, a list of (kind . atom)."
  (let ((pairs '()))
    (loop for (kind . atom) in atoms
          do (loop for sort in (declared-sorts theory atom kind)
                   for element in (rest atom)
                   do (pushnew (cons sort element) pairs :test #'equal)))
    (reverse pairs)))

(defun lifting (theory atoms)
  "Return a list of (variable sort . element), one for each element of a sort in ATOMS, a list of
(kind . atom)."
  (let ((pairs (sorted-elements theory atoms)))
    (loop for (sort . element) in pairs
          for same = (remove sort pairs :key #'car :test-not #'eq)
          collect (list* (variable-named sort (and (rest same)
                                                   (1+ (position (cons sort element) same
                                                                 :test #'equal))))
                         sort element))))

(defun lifted (theory atom kind lifting)
  "Return ATOM of KIND with the variables of LIFTING for its elements."
  (cons (first atom)
        (loop for sort in (declared-sorts theory atom kind)
              for element in (rest atom)
              collect (first (find (cons sort element) lifting :key #'cdr :test #'equal)))))

(defun ground-pattern (pattern bindings)
  "Return PATTERN with elements for its variables, by BINDINGS, a list of (variable . element)."
  (cons (first pattern)
        (loop for term in (rest pattern)
              for binding = (assoc term bindings)
              collect (if binding (cdr binding) term))))

(defun variable-p (term)
  (and (symbolp term) (char= #\? (char (symbol-name term) 0))))

(defun matching (pattern atom)
  "Return the bindings under which PATTERN, of variables and elements, is ATOM, and true; or NIL and
NIL."
  (let ((bindings '()))
    (loop for term in (rest pattern)
          for element in (rest atom)
          for known = (if (variable-p term)
                          (assoc term bindings)
                          (cons term term))
          do (cond ((null known) (push (cons term element) bindings))
                   ((not (equal (cdr known) element)) (return-from matching (values nil nil)))))
    (values bindings (and (eq (first pattern) (first atom)) t))))

(defun all-bindings (theory bindings variables)
  "Return the list of all extensions of BINDINGS to VARIABLES, a list of (variable sort . more)."
  (let ((all (list bindings)))
    (loop for (variable sort) in variables
          unless (assoc variable bindings)
            do (setf all (loop for bindings in all
                               append (loop for element in (ec:sort-elements theory sort)
                                            collect (acons variable element bindings)))))
    all))

;;; Truth

(defun sort-of-variable (theory variable)
  "Return the name of the sort of VARIABLE in THEORY."
  (let ((name (subseq (symbol-name variable) 1)))
    (flet ((sort-named (string)
             (let ((sort (find-symbol string :keyword)))
               (and sort (nth-value 1 (ec:sort-elements theory sort)) sort))))
      (or (sort-named name) (sort-named (string-right-trim "0123456789" name))))))

(defun formula-truth (theory formula table bindings)
  "Return T, NIL or :UNKNOWN: the truth of the state formula FORMULA, whose free variables BINDINGS
binds, in the observed state TABLE."
  (flet ((truth (part &optional (bindings bindings))
           (formula-truth theory part table bindings)))
    (if (typep formula 'boolean)
        formula
        (destructuring-bind (operator . parts) formula
          (flet ((decided (truths stop)
                   (cond ((member stop truths) stop)
                         ((member :unknown truths) :unknown)
                         (t (not stop)))))
            (case operator
              (:and (decided (mapcar #'truth parts) nil))
              (:or (decided (mapcar #'truth parts) t))
              (:not (let ((inner (truth (first parts))))
                      (if (eq inner :unknown) inner (not inner))))
              (:/= (not (eql (cdr (assoc (first parts) bindings))
                             (cdr (assoc (second parts) bindings)))))
              (:exists
               (let ((variable (first (first parts))))
                 (decided (loop for element in (ec:sort-elements
                                                theory (sort-of-variable theory variable))
                                collect (truth (second parts) (acons variable element bindings)))
                          t)))
              (t (multiple-value-bind (truth known)
                     (gethash (ground-pattern formula bindings) table)
                   (if known (and truth t) :unknown)))))))))

(defun timed (formula)
  "Return the state formula FORMULA as a formula about ?time."
  (if (typep formula 'boolean)
      formula
      (case (first formula)
        ((:and :or :not) (cons (first formula) (mapcar #'timed (rest formula))))
        (:exists (list :exists (second formula) (timed (third formula))))
        (:/= formula)
        (t (list :holds-at formula :?time)))))

(defun conjunction-of (formulas)
  (cond ((null formulas) t)
        ((null (rest formulas)) (first formulas))
        (t (cons :and formulas))))

(defun implication (conditions conclusion)
  "Return the sentence that CONDITIONS, a list of state formulas, imply CONCLUSION."
  (if conditions
      (list :implies (timed (conjunction-of conditions)) conclusion)
      conclusion))
