;;;; Terms: what stands for an element, a number, a fluent or an event in a formula.
;;;;
;;;; A term is an element, a number, a ?variable, or (operator term*) for arithmetic, a function of
;;;; the theory, a reified term, a fluent or an event.  CHECK-TERM signals a THEORY-ERROR for an
;;;; unknown name, a wrong number or sort of arguments, or an unbound variable.  A theory in Lisp is
;;;; refused for a term of a wrong sort; in .e files such an instance is dropped when the theory is
;;;; made ground, as their reasoner does.

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

;;; Where a formula stands

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

(defun scope-strict-p (scope)
  "Return true if terms of a wrong sort are refused."
  (eq (theory-syntax (scope-theory scope)) :lisp))

(defun bind-variables (scope variables)
  (make-scope :theory (scope-theory scope) :axiom (scope-axiom scope) :kind (scope-kind scope)
              :variables (if (eq (scope-variables scope) :free)
                             :free
                             (append variables (scope-variables scope)))))

(defun check-arity (scope form minimum maximum)
  (unless (<= minimum (length (rest form)) (or maximum (length (rest form))))
    (scope-problem scope form "~a takes ~:[at least ~d~*~;~d~@[ or ~d~]~] argument~p, not ~d"
                   (name-text (first form)) maximum minimum
                   (and maximum (/= minimum maximum) maximum)
                   (or maximum minimum) (length (rest form)))))

;;; What a name is

(defun kind-of-name (theory name)
  "Return what NAME is declared as in THEORY, with an article, or NIL."
  (cond ((assoc name (theory-fluents theory)) "a fluent")
        ((assoc name (theory-events theory)) "an event")
        ((assoc name (theory-numeric-fluents theory)) "a numeric fluent")
        ((assoc name (theory-predicates theory)) "a predicate")
        ((find-function theory name) "a function")
        ((reified-symbol theory name) "a term")))

(defun other-kind-text (theory form &key in-formula in-state)
  "Return what to say of FORM, which is of another kind than was expected, or an empty string.
IN-FORMULA is true if a formula was expected, IN-STATE in a formula without times."
  (let* ((name (if (consp form) (first form) form))
         (kind (kind-of-name theory name))
         (atom (formula-text (if (consp form) form (list form)))))
    (cond ((null kind) "")
          ((string= kind "a numeric fluent")
           (format nil ": ~a is ~a, (value-at ~a~:[ time~;~]) was expected" (name-text name) kind
                   atom in-state))
          ((and in-formula (string= kind "a fluent"))
           (format nil ", but ~a: (holds-at ~a ?time) was expected" kind atom))
          ((and in-formula (string= kind "an event"))
           (format nil ", but ~a: (happens ~a ?time) was expected" kind atom))
          (in-formula (format nil ", but ~a" kind))
          (t (format nil ": ~a is ~a" (name-text name) kind)))))

;;; Sorts

(defun sort-text (theory sort)
  "Return the text for the sort named SORT, with the range of its numbers."
  (let ((range (let ((sort (theory-sort theory sort))) (and sort (sort-range sort)))))
    (format nil "sort ~a~@[ (~{~d to ~d~})~]" (name-text sort)
            (and range (list (car range) (cdr range))))))

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
  (when (and expected found (scope-strict-p scope)
             (not (sorts-meet-p (scope-theory scope) found expected)))
    (if (eq found :time)
        (scope-problem scope form "the time ~a stands where an element was expected"
                       (formula-text term))
        (scope-problem scope form "~a is of sort ~a where sort ~a was expected"
                       (formula-text term) (name-text found) (name-text expected)))))

(defun sort-of-term (theory term)
  "Return the name of the sort of TERM, which is checked, or NIL for an element."
  (cond ((rationalp term) :integer)
        ((variable-p term) (variable-sort theory term))
        ((atom term) nil)
        ((or (eq (first term) :value-at) (member (first term) *arithmetic*)) :integer)
        ((find-function theory (first term)) (second (find-function theory (first term))))
        ((reified-symbol theory (first term)) (values (reified-symbol theory (first term))))
        ((assoc (first term) (theory-fluents theory)) :fluent)
        ((assoc (first term) (theory-events theory)) :event)))

(defun check-compared (scope form)
  "Check that the terms that FORM, an equation or its negation, compares can be the same."
  (let ((theory (scope-theory scope)))
    (destructuring-bind (left right) (rest form)
      (let ((left-sort (sort-of-term theory left)) (right-sort (sort-of-term theory right)))
        (flet ((empty-p (sort)
                 (and (not (theory-numeric-p theory sort)) (null (sort-elements theory sort))))
               (check-element (element sort)
                 (unless (element-of-sort-p theory element sort)
                   (scope-problem scope form "~a is no element of ~a" (formula-text element)
                                  (sort-text theory sort)))))
          (cond ((and left-sort right-sort)
                 (unless (or (sorts-meet-p theory left-sort right-sort)
                             (empty-p left-sort) (empty-p right-sort))
                   (scope-problem scope form "~a, of sort ~a, is compared with ~a, of sort ~a"
                                  (formula-text left) (name-text left-sort)
                                  (formula-text right) (name-text right-sort))))
                (left-sort (check-element right left-sort))
                (right-sort (check-element left right-sort))))))))

;;; Variables and constants

(defun check-variable (scope variable form)
  "Check VARIABLE in FORM and return the name of its sort."
  (let* ((theory (scope-theory scope)) (sort (variable-sort theory variable)))
    (cond ((string= (symbol-name sort) "")
           (scope-problem scope form "the variable ~a names no sort" (name-text variable)))
          ((not (theory-sort theory sort))
           (scope-problem scope form "the variable ~a has no sort: the theory has no sort ~a"
                          (name-text variable) (name-text sort)))
          ((and (eq sort :time) (eq (scope-kind scope) :state))
           (scope-problem scope form "the time ~a stands where an element was expected"
                          (name-text variable)))
          ((and (listp (scope-variables scope)) (not (member variable (scope-variables scope)))
                (not (and (eq (scope-kind scope) :constraint) (eq sort :time))))
           (scope-problem scope form "the variable ~a is unbound" (name-text variable))))
    sort))

(defun check-constant (scope term sort form)
  (let ((theory (scope-theory scope)))
    (unless (if (and sort (scope-strict-p scope))
                (element-of-sort-p theory term sort)
                (some (lambda (other) (member term (sort-constants other)))
                      (theory-sorts theory)))
      (scope-problem scope form "~a is no element of ~:[any sort~;~:*~a~]"
                     (name-text term) (and sort (sort-text theory sort))))))

(defun check-number (scope term sort form)
  (let ((theory (scope-theory scope)))
    (if (and sort (scope-strict-p scope)
             (or (sort-range (theory-sort theory sort)) (member sort '(:time :offset))))
        ;; Where the horizon ends is no matter of the theory.
        (unless (if (sort-range (theory-sort theory sort))
                    (element-of-sort-p theory term sort)
                    (integerp term))
          (scope-problem scope form "~d is no element of ~a" term (sort-text theory sort)))
        (check-sort scope :integer sort term form))))

;;; Applications

(defun check-arguments (scope atom declaration)
  "Check the arguments of ATOM by DECLARATION, (name sort*)."
  (unless (= (length atom) (length declaration))
    (scope-problem scope atom "~a takes ~d argument~:p, not ~d" (name-text (first atom))
                   (length (rest declaration)) (length (rest atom))))
  (loop for term in (rest atom)
        for sort in (rest declaration)
        do (check-term scope term sort atom)))

(defun check-arithmetic (scope term)
  (case (first term)
    ((:+ :*) (check-arity scope term 1 nil))
    (:- (check-arity scope term 1 2))
    (t (check-arity scope term 2 2)))
  (dolist (part (rest term))
    (check-term scope part :integer term))
  (when (and (eq (first term) :mod) (mentions-value-p term))
    (scope-problem scope term "there is no remainder of the value of a numeric fluent")))

(defun check-value-at (scope term)
  "Check TERM, (value-at fluent time), in a state formula (value-at fluent)."
  (let ((state-p (eq (scope-kind scope) :state)))
    (when (and state-p (third term))
      (scope-problem scope term "a time cannot stand here, where (value-at fluent) is a number"))
    (check-arity scope term (if state-p 1 2) (if state-p 1 2))
    (check-term scope (second term) :numeric-fluent term)
    (unless state-p
      (check-term scope (third term) :time term))))

(defun check-application (scope term sort form)
  "Check TERM, (operator term*), in FORM where SORT is expected."
  (let* ((theory (scope-theory scope)) (operator (first term))
         (function (find-function theory operator)))
    (multiple-value-bind (reified declaration) (reified-symbol theory operator)
      (cond ((eq operator :value-at)
             (check-value-at scope term)
             (check-sort scope :integer sort term form))
            ((member operator *arithmetic*)
             (check-arithmetic scope term)
             (check-sort scope :integer sort term form))
            (function
             (check-arguments scope term (first function))
             (check-sort scope (second function) sort term form))
            (declaration
             (check-arguments scope term declaration)
             (check-sort scope reified sort term form))
            ((and (assoc operator (theory-fluents theory)) (not (eq sort :event)))
             (check-atom scope term (theory-fluents theory) "fluent" form)
             (check-sort scope :fluent sort term form))
            ((assoc operator (theory-events theory))
             (check-atom scope term (theory-events theory) "event" form)
             (check-sort scope :event sort term form))
            (t (scope-problem scope form "there is no function ~a~a" (formula-text operator)
                              (other-kind-text theory term
                                               :in-state (eq (scope-kind scope) :state))))))))

(defun check-term (scope term sort form)
  "Check that TERM in FORM is of SORT; NIL stands for any sort."
  (cond ((and (member sort '(:fluent :event :numeric-fluent)) (not (variable-p term)))
         (let ((theory (scope-theory scope)))
           (case sort
             (:event (check-atom scope term (theory-events theory) "event" form))
             (:numeric-fluent
              (check-atom scope term (theory-numeric-fluents theory) "numeric fluent" form))
             (t (check-atom scope term (theory-fluents theory) "fluent" form)))))
        ((and (eq sort :time) (not (member (scope-kind scope) '(:axiom :query))))
         (check-time scope term form))
        ((rationalp term) (check-number scope term sort form))
        ((and (consp term) (keywordp (first term))) (check-application scope term sort form))
        ((not (and (keywordp term) term))
         (scope-problem scope form "~a was found where an element~@[ of sort ~a~] was expected"
                        (formula-text term) (and sort (name-text sort))))
        ((variable-p term)
         (check-sort scope (check-variable scope term form) sort term form))
        (t (check-constant scope term sort form))))

(defun check-atom (scope atom declarations kind form)
  "Check that ATOM, in FORM, is an instance of one of DECLARATIONS; KIND is such as \"fluent\"."
  (unless (and (consp atom) (keywordp (first atom)))
    (scope-problem scope (and (not (eq form atom)) form)
                   "~a was found where ~:[a~;an~] ~a such as (~:[name ...~;~:*~a~]) was expected"
                   (formula-text atom) (string= kind "event") kind
                   (and (keywordp atom) (assoc atom declarations)
                        (format nil "~a~@[ ...~]" (name-text atom)
                                (rest (assoc atom declarations))))))
  (let ((declaration (assoc (first atom) declarations)))
    (unless declaration
      (scope-problem scope atom "there is no ~a ~a~a" kind (name-text (first atom))
                     (other-kind-text (scope-theory scope) atom)))
    (check-arguments scope atom declaration)))

;;; Times of state constraints

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
