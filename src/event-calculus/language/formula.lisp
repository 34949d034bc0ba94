;;;; Formulas: the language of axioms, checked against a theory's declarations.
;;;;
;;;; A formula is a tree of keywords and integers.  CHECK-FORMULA walks it and signals a
;;;; THEORY-ERROR that names the axiom and the sub-form for an unknown name, a wrong number or sort
;;;; of arguments, an unbound variable, or a time where none can stand.  PARSE-FORMULA is for
;;;; formulas from elsewhere: state formulas, which speak of one timepoint, state constraints, and
;;;; questions about timepoints given by number.

(in-package #:discrepancy-finder.event-calculus)

(defparameter *connectives* '(:and :or :not :implies :iff :forall :exists)
  "Operators that build formulas from formulas.")

(defparameter *comparisons* '(:= :/= :< :<= :> :>=)
  "Operators that build formulas from terms.")

(defparameter *arithmetic* '(:+ :- :* :/ :mod)
  "Operators that build terms from terms.")

(defparameter *standard-predicates*
  '((:holds-at :fluent :time) (:released-at :fluent :time) (:happens :event :time)
    (:initiates :event :fluent :time) (:terminates :event :fluent :time)
    (:releases :event :fluent :time) (:assigns :event :numeric-fluent :integer :time)
    (:trajectory :fluent :time :fluent :offset) (:anti-trajectory :fluent :time :fluent :offset)
    (:stopped-in :time :fluent :time) (:started-in :time :fluent :time)
    (:clipped :time :fluent :time) (:declipped :time :fluent :time))
  "The predicates of the event calculus with the sorts of their arguments.")

(defparameter *effect-predicates*
  '(:initiates :terminates :releases :assigns :trajectory :anti-trajectory)
  "The predicates that axioms define, as heads, and that are completed in every theory.")

(defun formula-operator-p (symbol)
  (let ((name (name-keyword symbol)))
    (and (or (member name *connectives*) (member name *comparisons*) (member name *arithmetic*)
             (assoc name *standard-predicates*) (member name '(:initially :value-at)))
         t)))

(defstruct (scope (:copier nil))
  "What a formula may mention: the theory, who is to blame, and for what it is checked.
VARIABLES is the list of bound variables or :FREE where every variable is allowed.  KIND is :AXIOM,
:CONSTRAINT (time may be ?time or (+ ?time n)), :QUERY (without effect predicates) or :STATE
(fluents stand for themselves, no time)."
  (theory nil :type theory :read-only t)
  (axiom nil :type (or axiom string) :read-only t)
  (variables :free :type (or (eql :free) list) :read-only t)
  (kind :axiom :type (member :axiom :constraint :query :state) :read-only t))

(defun scope-problem (scope form control &rest arguments)
  (apply #'theory-problem (scope-theory scope) (scope-axiom scope) form control arguments))

(defun bind-variables (scope variables)
  (make-scope :theory (scope-theory scope) :axiom (scope-axiom scope) :kind (scope-kind scope)
              :variables (if (eq (scope-variables scope) :free)
                             :free
                             (append variables (scope-variables scope)))))

;;; Terms

(defun check-variable (scope variable form)
  "Check VARIABLE in FORM and return the name of its sort."
  (let* ((theory (scope-theory scope)) (sort (variable-sort theory variable)))
    (cond ((not (theory-sort theory sort))
           (scope-problem scope form "the variable ~a has no sort: the theory has no sort ~a"
                          (name-text variable) (name-text sort)))
          ((and (eq sort :time) (eq (scope-kind scope) :state))
           (scope-problem scope form "the time ~a stands where an element was expected"
                          (name-text variable)))
          ((and (listp (scope-variables scope)) (not (member variable (scope-variables scope)))
                (not (and (eq (scope-kind scope) :constraint) (eq sort :time))))
           (scope-problem scope form "the variable ~a is unbound" (name-text variable))))
    sort))

(defun sorts-meet-p (theory sort other)
  "Return true if an element can be of both sorts."
  (or (eq sort other)
      (and (theory-numeric-p theory sort) (theory-numeric-p theory other))
      (theory-subsort-p theory sort other)
      (theory-subsort-p theory other sort)
      (and (not (theory-numeric-p theory sort)) (not (theory-numeric-p theory other))
           (intersection (sort-elements theory sort) (sort-elements theory other)
                         :test #'equal))))

(defun check-sort (scope found expected term form)
  (when (and expected found (not (sorts-meet-p (scope-theory scope) found expected))
             (eq (theory-syntax (scope-theory scope)) :lisp))
    (if (eq found :time)
        (scope-problem scope form "the time ~a stands where an element was expected"
                       (formula-text term))
        (scope-problem scope form "~a is of sort ~a where sort ~a was expected"
                       (formula-text term) (name-text found) (name-text expected)))))

(defun check-constant (scope term sort form)
  (let ((theory (scope-theory scope)))
    (unless (if (and sort (eq (theory-syntax theory) :lisp))
                (element-of-sort-p theory term sort)
                (some (lambda (other) (member term (sort-constants other)))
                      (theory-sorts theory)))
      (scope-problem scope form "~a is no element of ~:[any sort~;sort ~:*~a~]"
                     (name-text term) (and sort (name-text sort))))))

(defun check-arguments (scope atom declaration)
  "Check the arguments of ATOM by DECLARATION, (name sort*)."
  (unless (= (length atom) (length declaration))
    (scope-problem scope atom "~a takes ~d argument~:p, not ~d" (name-text (first atom))
                   (length (rest declaration)) (length (rest atom))))
  (loop for term in (rest atom)
        for sort in (rest declaration)
        do (check-term scope term sort atom)))

(defun check-application (scope term sort form)
  "Check TERM, (operator term*), in FORM where SORT is expected."
  (let* ((theory (scope-theory scope)) (operator (first term))
         (function (find-function theory operator)))
    (multiple-value-bind (reified declaration) (reified-symbol theory operator)
      (cond ((eq operator :value-at)
             (check-arity scope term 2 2)
             (check-term scope (second term) :numeric-fluent term)
             (check-term scope (third term) :time term)
             (check-sort scope :integer sort term form))
            ((member operator *arithmetic*)
             (check-arity scope term 1 (if (member operator '(:+ :*)) nil 2))
             (dolist (part (rest term)) (check-term scope part :integer term))
             (check-sort scope :integer sort term form))
            (function
             (check-arguments scope term (first function))
             (check-sort scope (second function) sort term form))
            (declaration
             (check-arguments scope term declaration)
             (check-sort scope reified sort term form))
            ((and (assoc operator (theory-fluents theory)) (not (eq sort :event)))
             (check-atom scope term (theory-fluents theory) "fluent")
             (check-sort scope :fluent sort term form))
            ((assoc operator (theory-events theory))
             (check-atom scope term (theory-events theory) "event")
             (check-sort scope :event sort term form))
            (t (scope-problem scope form "there is no function ~a" (formula-text operator)))))))

(defun check-term (scope term sort form)
  "Check that TERM in FORM is of SORT; NIL stands for any sort."
  (cond ((and (member sort '(:fluent :event :numeric-fluent)) (not (variable-p term)))
         (let ((theory (scope-theory scope)))
           (case sort
             (:event (check-atom scope term (theory-events theory) "event"))
             (:numeric-fluent
              (check-atom scope term (theory-numeric-fluents theory) "numeric fluent"))
             (t (check-atom scope term (theory-fluents theory) "fluent")))))
        ((and (eq sort :time) (not (member (scope-kind scope) '(:axiom :query))))
         (check-time scope term form))
        ((rationalp term) (check-sort scope :integer sort term form))
        ((and (consp term) (keywordp (first term))) (check-application scope term sort form))
        ((not (and (keywordp term) term))
         (scope-problem scope form "~a was found where an element~@[ of sort ~a~] was expected"
                        (formula-text term) (and sort (name-text sort))))
        ((variable-p term)
         (check-sort scope (check-variable scope term form) sort term form))
        (t (check-constant scope term sort form))))

(defun check-atom (scope atom declarations kind)
  "Check that ATOM is an instance of one of DECLARATIONS; KIND is \"fluent\" or \"event\"."
  (unless (and (consp atom) (keywordp (first atom)))
    (scope-problem scope atom "~a was found where a ~a such as (name ...) was expected"
                   (formula-text atom) kind))
  (let ((declaration (assoc (first atom) declarations)))
    (unless declaration
      (scope-problem scope atom "there is no ~a ~a" kind (name-text (first atom))))
    (check-arguments scope atom declaration)))

(defun time-offset (term)
  "Return n if TERM is ?time (n = 0) or (+ ?time n), else NIL."
  (cond ((eq term :?time) 0)
        ((and (consp term) (= (length term) 3) (eq (first term) :+) (eq (second term) :?time)
              (typep (third term) '(integer 0)))
         (third term))))

(defun check-time (scope term form)
  "Check the time TERM of a state constraint."
  (unless (time-offset term)
    (scope-problem scope form "~a was found where ?time or (+ ?time n) was expected"
                   (formula-text term))))

;;; Formulas

(defun check-arity (scope form minimum maximum)
  (unless (<= minimum (length (rest form)) (or maximum (length (rest form))))
    (scope-problem scope form "~a takes ~:[at least ~;~]~d argument~:p, not ~d"
                   (name-text (first form)) maximum minimum (length (rest form)))))

(defun check-formula (scope form)
  "Check FORM in SCOPE; signal a THEORY-ERROR where it is not well-formed."
  (unless (and (consp form) (keywordp (first form)))
    (scope-problem scope (and (consp form) form) "~a was found where a formula was expected"
                   (formula-text form)))
  (case (first form)
    ((:and :or) (dolist (part (rest form)) (check-formula scope part)))
    (:not (check-arity scope form 1 1) (check-formula scope (second form)))
    ((:implies :iff)
     (check-arity scope form 2 2)
     (dolist (part (rest form)) (check-formula scope part)))
    ((:forall :exists)
     (check-arity scope form 2 2)
     (unless (and (consp (second form)) (every #'variable-p (second form)))
       (scope-problem scope form "a list of variables was expected after ~a"
                      (name-text (first form))))
     (let ((inner (bind-variables scope (second form))))
       (dolist (variable (second form)) (check-variable inner variable form))
       (check-formula inner (third form))))
    ((:= :/= :< :<= :> :>=)
     (check-arity scope form 2 2)
     (let ((sort (if (member (first form) '(:= :/=)) nil :integer)))
       (dolist (term (rest form)) (check-term scope term sort form))))
    (t (check-predication scope form))))

(defun numeric-atom-p (theory form)
  "Return true if FORM applies a numeric fluent of THEORY."
  (and (consp form) (assoc (first form) (theory-numeric-fluents theory)) t))

(defun signature (theory form)
  "Return the declaration of the standard predicate that FORM applies, or NIL.  What is released, and
where a trajectory leads, may be a numeric fluent."
  (case (first form)
    (:releases (if (numeric-atom-p theory (third form))
                   '(:releases :event :numeric-fluent :time)
                   (assoc :releases *standard-predicates*)))
    (t (assoc (first form) *standard-predicates*))))

(defun check-predication (scope form)
  (let* ((theory (scope-theory scope))
         (operator (first form))
         (standard (signature theory form))
         (predicate (assoc operator (theory-predicates theory))))
    (cond ((and (eq (scope-kind scope) :state) (not predicate))
           (check-atom scope form (theory-fluents theory) "fluent"))
          ((and standard
                (member operator (case (scope-kind scope)
                                   (:constraint '(:holds-at :happens))
                                   (:query '(:holds-at :happens :released-at :stopped-in
                                             :started-in :clipped :declipped))
                                   (t (list operator)))))
           (check-arity scope form (length (rest standard)) (length (rest standard)))
           (check-arguments scope form standard))
          ((or standard (eq operator :initially))
           (scope-problem scope form "~a cannot stand here, only as the head of an axiom"
                          (name-text operator)))
          (predicate (check-arguments scope form predicate))
          (t (scope-problem scope form "~a is no operator and no predicate"
                            (name-text operator))))))

(defun parse-formula (form theory &key (kind :state) (blame "a formula") (variables '()))
  "Return FORM, a tree of symbols of any package, as a formula of THEORY.  KIND is :STATE, where
fluents stand for themselves and there is no time, :CONSTRAINT, with holds-at and happens at ?time
or (+ ?time n), or :QUERY, with timepoints by number.  BLAME names the form in errors; VARIABLES are
bound.  Signals THEORY-ERROR, also for unbound variables."
  (let ((formula (normalize form (theory-name theory) blame)))
    (check-formula (make-scope :theory theory :axiom blame :kind kind :variables variables) formula)
    formula))
