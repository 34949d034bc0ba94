;;;; Formulas: the language of axioms, checked against a theory's declarations.
;;;;
;;;; A formula is a tree of keywords.  CHECK-FORMULA walks it and signals a THEORY-ERROR that names
;;;; the axiom and the sub-form for an unknown name, a wrong number or sort of arguments, an unbound
;;;; variable, or a time where none can stand.  PARSE-FORMULA is for formulas from elsewhere: state
;;;; formulas, which speak of one timepoint, and state constraints.

(in-package #:discrepancy-finder.event-calculus)

(defparameter *connectives*
  '(:and :or :not :implies :iff :forall :exists := :/=)
  "Operators that build formulas from formulas or terms.")

(defparameter *predicates*
  '(:holds-at :happens :initiates :terminates :initially)
  "The predicates of the event calculus that theories may use.")

(defun formula-operator-p (symbol)
  (and (or (member (name-keyword symbol) *connectives*)
           (member (name-keyword symbol) *predicates*))
       t))

(defstruct (scope (:copier nil))
  "What a formula may mention: the theory, who is to blame, and for what it is checked.
VARIABLES is the list of bound variables or :FREE where every variable is allowed.  KIND is :AXIOM,
:CONSTRAINT (time may be ?time or (+ ?time n)) or :STATE (fluents stand for themselves, no time)."
  (theory nil :type theory :read-only t)
  (axiom nil :type (or axiom string) :read-only t)
  (variables :free :type (or (eql :free) list) :read-only t)
  (kind :axiom :type (member :axiom :constraint :state) :read-only t))

(defun scope-problem (scope form control &rest arguments)
  (apply #'theory-problem (scope-theory scope) (scope-axiom scope) form control arguments))

(defun bind-variables (scope variables)
  (make-scope :theory (scope-theory scope) :axiom (scope-axiom scope) :kind (scope-kind scope)
              :variables (if (eq (scope-variables scope) :free)
                             :free
                             (append variables (scope-variables scope)))))

(defun check-variable (scope variable form)
  (cond ((time-variable-p variable)
         (scope-problem scope form "the time ~a stands where an element was expected"
                        (name-text variable)))
        ((not (nth-value 1 (sort-elements (scope-theory scope) (variable-sort-name variable))))
         (scope-problem scope form "the variable ~a has no sort: the theory has no sort ~a"
                        (name-text variable) (name-text (variable-sort-name variable))))
        ((and (listp (scope-variables scope)) (not (member variable (scope-variables scope))))
         (scope-problem scope form "the variable ~a is unbound" (name-text variable)))))

(defun check-term (scope term sort form)
  "Check that TERM, a variable or constant in FORM, is of SORT; NIL stands for any sort."
  (cond ((not (keywordp term))
         (scope-problem scope form "~a was found where an element~@[ of sort ~a~] was expected"
                        (formula-text term) (and sort (name-text sort))))
        ((variable-p term)
         (check-variable scope term form)
         (when (and sort (not (eq sort (variable-sort-name term))))
           (scope-problem scope form "~a is of sort ~a where sort ~a was expected"
                          (name-text term) (name-text (variable-sort-name term))
                          (name-text sort))))
        ((notany (lambda (declaration)
                   (and (or (null sort) (eq sort (first declaration)))
                        (member term (rest declaration))))
                 (theory-sorts (scope-theory scope)))
         (scope-problem scope form "~a is no element of ~:[any sort~;sort ~:*~a~]"
                        (name-text term) (and sort (name-text sort))))))

(defun check-atom (scope atom declarations kind)
  "Check that ATOM is an instance of one of DECLARATIONS; KIND is \"fluent\" or \"event\"."
  (unless (and (consp atom) (keywordp (first atom)))
    (scope-problem scope atom "~a was found where a ~a such as (name ...) was expected"
                   (formula-text atom) kind))
  (let ((declaration (assoc (first atom) declarations)))
    (unless declaration
      (scope-problem scope atom "there is no ~a ~a" kind (name-text (first atom))))
    (unless (= (length atom) (length declaration))
      (scope-problem scope atom "~a takes ~d argument~:p, not ~d" (name-text (first atom))
                     (length (rest declaration)) (length (rest atom))))
    (loop for term in (rest atom)
          for sort in (rest declaration)
          do (check-term scope term sort atom))))

(defun check-fluent (scope atom)
  (check-atom scope atom (theory-fluents (scope-theory scope)) "fluent"))

(defun check-event (scope atom)
  (check-atom scope atom (theory-events (scope-theory scope)) "event"))

(defun time-offset (term)
  "Return n if TERM is ?time (n = 0) or (+ ?time n), else NIL."
  (cond ((eq term :?time) 0)
        ((and (consp term) (= (length term) 3) (eq (first term) :+) (eq (second term) :?time)
              (typep (third term) '(integer 0)))
         (third term))))

(defun check-time (scope term form)
  (let ((offset (time-offset term)))
    (unless (and offset (or (zerop offset) (eq (scope-kind scope) :constraint)))
      (scope-problem scope form "~a was found where ~a was expected" (formula-text term)
                     (if (eq (scope-kind scope) :constraint) "?time or (+ ?time n)" "?time")))))

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
    ((:= :/=)
     (check-arity scope form 2 2)
     (dolist (term (rest form)) (check-term scope term nil form)))
    (t (check-predication scope form))))

(defun check-predication (scope form)
  (if (eq (scope-kind scope) :state)
      (check-fluent scope form)
      (case (first form)
        ((:holds-at :happens)
         (check-arity scope form 2 2)
         (if (eq (first form) :holds-at)
             (check-fluent scope (second form))
             (check-event scope (second form)))
         (check-time scope (third form) form))
        ((:initiates :terminates :initially)
         (scope-problem scope form "~a cannot stand here, only as the head of an axiom"
                        (name-text (first form))))
        (t (scope-problem scope form "~a is no operator and no predicate"
                          (name-text (first form)))))))

;;; Axioms: effect axioms [condition ->] initiates/terminates, initial conditions, sentences

(defun axiom-parts (axiom)
  "Return the kind of AXIOM (:effect, :initially or :sentence), its condition (T if none) and its
head."
  (let ((formula (axiom-formula axiom)))
    (flet ((head-p (form operators) (and (consp form) (member (first form) operators))))
      (cond ((head-p formula '(:initiates :terminates)) (values :effect t formula))
            ((and (head-p formula '(:implies)) (= (length formula) 3)
                  (head-p (third formula) '(:initiates :terminates)))
             (values :effect (second formula) (third formula)))
            ((head-p formula '(:initially)) (values :initially t formula))
            (t (values :sentence t formula))))))

(defun happens-in-head-p (form positive)
  "Return true if the formula FORM, taken positively or not, can make an event happen."
  (and (consp form)
       (case (first form)
         (:happens positive)
         (:not (happens-in-head-p (second form) (not positive)))
         (:implies (or (happens-in-head-p (second form) (not positive))
                       (happens-in-head-p (third form) positive)))
         (:iff (some (lambda (part) (or (happens-in-head-p part t) (happens-in-head-p part nil)))
                     (rest form)))
         ((:forall :exists) (happens-in-head-p (third form) positive))
         ((:and :or) (some (lambda (part) (happens-in-head-p part positive)) (rest form))))))

(defun check-axiom (theory axiom)
  "Check AXIOM of THEORY.  Signals THEORY-ERROR."
  (let ((scope (make-scope :theory theory :axiom axiom)))
    (multiple-value-bind (kind condition head) (axiom-parts axiom)
      (ecase kind
        (:effect
         (check-arity scope head 3 3)
         (check-event scope (second head))
         (check-fluent scope (third head))
         (check-time scope (fourth head) head)
         (unless (eq condition t) (check-formula scope condition)))
        (:initially
         (check-arity scope head 1 1)
         (check-formula (make-scope :theory theory :axiom axiom :kind :state) (second head)))
        (:sentence
         (check-formula scope head)
         (when (happens-in-head-p head t)
           (scope-problem scope head "a trigger axiom: only the steps of a plan make events ~
                                      happen here")))))))

(defun parse-formula (form theory &key (kind :state) (blame "a formula") (variables '()))
  "Return FORM, a tree of symbols of any package, as a formula of THEORY.  KIND is :STATE, where
fluents stand for themselves and there is no time, or :CONSTRAINT, with holds-at and happens at
?time or (+ ?time n).  BLAME names the form in errors; VARIABLES are bound.  Signals THEORY-ERROR,
also for unbound variables."
  (let ((formula (normalize form (theory-name theory) blame)))
    (check-formula (make-scope :theory theory :axiom blame :kind kind :variables variables) formula)
    formula))
