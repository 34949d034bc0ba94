;;;; Theories made ground by brute force, for the evaluator of brute-force.lisp.
;;;;
;;;; Formulas are made ground by substitution from outside to inside, for all timepoints.  An
;;;; INSTANCE is a formula without free variables; a quantifier has those in which no argument lies
;;;; outside of its sort.  A ground formula is T, NIL, the number of an atom, or :not, :and, :or,
;;;; :iff of ground formulas; constants are folded away, nothing else.

(in-package #:discrepancy-finder.tests)

(defstruct (oracle (:copier nil))
  "A theory and the timepoints FIRST to LAST.  EFFECTS and CHANGES map (kind event fluent time) and
(kind fluent time fluent offset) to the conditions of the axioms' instances."
  (theory nil :type ec:theory :read-only t)
  (first 0 :type integer :read-only t)
  (last 0 :type integer :read-only t)
  (elements (make-hash-table) :type hash-table :read-only t)
  (function-values (make-hash-table :test 'equal) :type hash-table :read-only t)
  (effects (make-hash-table :test 'equal) :type hash-table :read-only t)
  (changes (make-hash-table :test 'equal) :type hash-table :read-only t)
  (known-effects (make-hash-table :test 'equal) :type hash-table :read-only t)
  (numbers (make-hash-table :test 'equal) :type hash-table :read-only t)
  (atoms (make-array 64 :adjustable t :fill-pointer 0) :type vector :read-only t))

;;; Sorts and terms

(defun variable-term-p (term)
  (and (symbolp term) term (char= (char (symbol-name term) 0) #\?)))

(defun sort-of-variable (variable)
  (intern (string-right-trim "0123456789" (subseq (symbol-name variable) 1)) :keyword))

(defun applications (oracle declarations without)
  "Return the ground terms of DECLARATIONS, those with an argument of the sort WITHOUT left out."
  (labels ((tuples (sorts)
             (if (null sorts)
                 '(())
                 (loop for element in (elements oracle (first sorts))
                       append (loop for tuple in (tuples (rest sorts))
                                    collect (cons element tuple))))))
    (loop for (name . sorts) in declarations
          unless (member without sorts)
            append (loop for tuple in (tuples sorts) collect (cons name tuple)))))

(defun elements (oracle sort)
  "Return the list of the elements of SORT."
  (multiple-value-bind (elements known) (gethash sort (oracle-elements oracle))
    (if known
        elements
        (setf (gethash sort (oracle-elements oracle)) (compute-elements oracle sort)))))

(defun compute-elements (oracle sort)
  (let* ((theory (oracle-theory oracle))
         (span (- (oracle-last oracle) (oracle-first oracle)))
         (declared (find sort (ec:theory-sorts theory) :key #'ec:sort-name)))
    (flet ((integers (low high) (loop for i from low to high collect i)))
      (case sort
        (:time (integers (oracle-first oracle) (oracle-last oracle)))
        (:offset (destructuring-bind (low . high)
                     (or (ec:theory-offset-range theory) (cons 1 span))
                   (integers low high)))
        (:fluent (applications oracle (ec:theory-fluents theory) :fluent))
        (:event (applications oracle (ec:theory-events theory) :event))
        (t (if (ec:sort-range declared)
               (integers (car (ec:sort-range declared)) (cdr (ec:sort-range declared)))
               (remove-duplicates
                (append (ec:sort-constants declared)
                        (applications oracle (ec:sort-terms declared) sort)
                        (loop for other in (ec:theory-sorts theory)
                              when (member sort (ec:sort-parents other))
                                append (elements oracle (ec:sort-name other))))
                :test #'equal)))))))

(defun in-sort-p (oracle value sort)
  (if (eq sort :integer)
      (integerp value)
      (and (member value (elements oracle sort) :test #'equal) t)))

(defparameter *arithmetic-functions*
  (list :+ #'+ :- #'- :* #'*
        :/ (lambda (p q) (if (zerop q) nil (truncate p q)))
        :mod (lambda (p q) (if (zerop q) nil (rem p q)))))

(defun signature (oracle name)
  "Return the sorts of the arguments of the predicate, fluent, event, function or term NAME."
  (let ((theory (oracle-theory oracle)))
    (rest (or (assoc name '((:holds-at :fluent :time) (:released-at :fluent :time)
                            (:happens :event :time) (:initiates :event :fluent :time)
                            (:terminates :event :fluent :time) (:releases :event :fluent :time)
                            (:trajectory :fluent :time :fluent :offset)
                            (:anti-trajectory :fluent :time :fluent :offset)
                            (:stopped-in :time :fluent :time) (:started-in :time :fluent :time)
                            (:clipped :time :fluent :time) (:declipped :time :fluent :time)))
              (assoc name (ec:theory-predicates theory))
              (assoc name (ec:theory-fluents theory))
              (assoc name (ec:theory-events theory))
              (assoc name (mapcar #'first (ec:theory-functions theory)))
              (some (lambda (sort) (assoc name (ec:sort-terms sort)))
                    (ec:theory-sorts theory))))))

(defun term-value (oracle term)
  "Return the value of the ground TERM, or NIL if it has none or a part is outside of its sort."
  (if (atom term)
      term
      (let ((arithmetic (getf *arithmetic-functions* (first term)))
            (values (mapcar (lambda (part) (term-value oracle part)) (rest term))))
        (cond (arithmetic (and (every #'integerp values) (apply arithmetic values)))
              ((notevery (lambda (value sort) (in-sort-p oracle value sort))
                         values (signature oracle (first term)))
               nil)
              ((find (first term) (ec:theory-functions (oracle-theory oracle)) :key #'caar)
               (values (gethash (cons (first term) values) (oracle-function-values oracle))))
              (t (cons (first term) values))))))

;;; Instances

(defun formula-kind (form)
  (case (first form)
    ((:and :or :not :implies :iff) :connective)
    ((:forall :exists) :quantifier)
    ((:= :/= :< :<= :> :>=) :comparison)
    (t :atom)))

(defun unbound-variables (form &optional bound)
  "Return the free variables of FORM in order of appearance."
  (cond ((variable-term-p form) (unless (member form bound) (list form)))
        ((atom form) '())
        ((member (first form) '(:forall :exists))
         (unbound-variables (third form) (append (second form) bound)))
        (t (remove-duplicates (loop for part in (rest form)
                                    append (unbound-variables part bound))
                              :from-end t))))

(defun substitute-variable (form variable value)
  (cond ((eq form variable) value)
        ((atom form) form)
        ((and (member (first form) '(:forall :exists)) (member variable (second form))) form)
        (t (cons (first form)
                 (mapcar (lambda (part) (substitute-variable part variable value))
                         (rest form))))))

(defun legal-term-p (oracle term sort)
  "Return true unless TERM or a part of it is ground and outside of its sort; NIL stands for any."
  (cond ((null (unbound-variables term))
         (let ((value (term-value oracle term)))
           (and value (or (null sort) (in-sort-p oracle value sort)))))
        ((atom term))
        ((getf *arithmetic-functions* (first term))
         (every (lambda (part) (legal-term-p oracle part :integer)) (rest term)))
        (t (every (lambda (part sort) (legal-term-p oracle part sort))
                  (rest term) (signature oracle (first term))))))

(defun legal-p (oracle form)
  "Return true unless FORM has a ground argument outside of its sort, or an event at a timepoint
where none can happen; what stands in a quantifier within is its own affair."
  (ecase (formula-kind form)
    (:connective (every (lambda (part) (legal-p oracle part)) (rest form)))
    (:quantifier t)
    (:comparison (let ((sort (if (member (first form) '(:= :/=)) nil :integer)))
                   (every (lambda (term) (legal-term-p oracle term sort)) (rest form))))
    (:atom (and (every (lambda (term sort) (legal-term-p oracle term sort))
                       (rest form) (signature oracle (first form)))
                (or (not (eq (first form) :happens))
                    (unbound-variables (third form))
                    (< (term-value oracle (third form)) (oracle-last oracle)))))))

(defun instances (oracle variables form)
  "Return the list of the legal instances of FORM for VARIABLES."
  (if (null variables)
      (list form)
      (loop for element in (elements oracle (sort-of-variable (first variables)))
            for instance = (substitute-variable form (first variables) element)
            when (legal-p oracle instance)
              append (instances oracle (rest variables) instance))))

(defun axiom-instances (oracle form)
  "Return the list of the legal instances of the axiom FORM."
  (let ((form (loop while (eq (first form) :forall) do (setf form (third form))
                    finally (return form))))
    (and (legal-p oracle form)
         (instances oracle (unbound-variables form) form))))

;;; Ground formulas

(defun junction (operator parts)
  "Return the conjunction (OPERATOR :and) or disjunction (:or) of the ground formulas PARTS."
  (let* ((absorbing (eq operator :or))
         (parts (remove (not absorbing) parts)))
    (cond ((member absorbing parts) absorbing)
          ((null parts) (not absorbing))
          ((null (rest parts)) (first parts))
          (t (cons operator parts)))))

(defun negation (formula)
  (cond ((eq formula t) nil)
        ((null formula) t)
        (t (list :not formula))))

(defun equivalence (p q)
  (cond ((eq p t) q)
        ((eq q t) p)
        ((null p) (negation q))
        ((null q) (negation p))
        (t (list :iff p q))))

(defun atom-number (oracle name &rest values)
  "Return the number of the ground atom of NAME and VALUES."
  (let ((atom (cons name values)))
    (or (gethash atom (oracle-numbers oracle))
        (setf (gethash atom (oracle-numbers oracle))
              ;; The number 0 is left out.
              (1+ (vector-push-extend atom (oracle-atoms oracle)))))))

(defun all-events (oracle)
  (applications oracle (ec:theory-events (oracle-theory oracle)) nil))

(defun all-fluents (oracle)
  (applications oracle (ec:theory-fluents (oracle-theory oracle)) nil))

(defun effect-conditions (oracle kind event fluent time)
  "Return the conditions under which EVENT has an effect of KIND on FLUENT at TIME, one an axiom."
  (let ((key (list kind event fluent time)) (table (oracle-known-effects oracle)))
    (multiple-value-bind (formulas known) (gethash key table)
      (cond ((eq formulas :in-work) (error "~s is defined by itself." key))
            (known formulas)
            (t (setf (gethash key table) :in-work
                     (gethash key table)
                     (mapcar (lambda (condition) (ground-instance oracle condition))
                             (gethash key (oracle-effects oracle)))))))))

(defun relation (oracle kind event fluent time)
  "Return the completed definition of (KIND EVENT FLUENT TIME): one of its conditions is true."
  (junction :or (effect-conditions oracle kind event fluent time)))

(defun ground-question (oracle form)
  "Return FORM, without free variables, as a ground formula; NIL if an argument is outside of its
sort."
  (and (legal-p oracle form) (ground-instance oracle form)))

(defun ground-instance (oracle form)
  "Return the instance FORM as a ground formula."
  (flet ((parts () (mapcar (lambda (part) (ground-instance oracle part)) (rest form)))
         (values-of () (mapcar (lambda (term) (term-value oracle term)) (rest form))))
    (case (first form)
      ((:and :or) (junction (first form) (parts)))
      (:not (negation (first (parts))))
      (:implies (destructuring-bind (p q) (parts) (junction :or (list (negation p) q))))
      (:iff (destructuring-bind (p q) (parts) (equivalence p q)))
      ((:forall :exists)
       (junction (if (eq (first form) :forall) :and :or)
                 (mapcar (lambda (instance) (ground-instance oracle instance))
                         (instances oracle (second form) (third form)))))
      (:= (destructuring-bind (p q) (values-of) (equal p q)))
      (:/= (destructuring-bind (p q) (values-of) (not (equal p q))))
      ((:< :<= :> :>=)
       (destructuring-bind (p q) (values-of)
         (ecase (first form) (:< (< p q)) (:<= (<= p q)) (:> (> p q)) (:>= (>= p q)))))
      ((:initiates :terminates :releases)
       (destructuring-bind (event fluent time) (values-of)
         (relation oracle (first form) event fluent time)))
      ;; DEC1 and DEC2, and their kin that count the first timepoint, too
      ((:stopped-in :started-in :clipped :declipped)
       (destructuring-bind (start fluent end) (values-of)
         (junction
          :or (loop with kind = (if (member (first form) '(:stopped-in :clipped))
                                    :terminates
                                    :initiates)
                    for time from (if (member (first form) '(:stopped-in :started-in))
                                      (1+ start)
                                      start)
                      to (1- end)
                    append (loop for event in (all-events oracle)
                                 collect (junction :and
                                                   (list (atom-number oracle :happens event time)
                                                         (relation oracle kind event fluent
                                                                   time))))))))
      (t (apply #'atom-number oracle (first form) (values-of))))))
