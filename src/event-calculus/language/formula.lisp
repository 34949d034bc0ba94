;;;; Formulas: the language of axioms, checked against a theory's declarations.
;;;;
;;;; A formula is a tree of keywords and integers.  CHECK-FORMULA walks it and signals a
;;;; THEORY-ERROR that names the axiom and the sub-form for an unknown name, a wrong number or sort
;;;; of arguments, an unbound variable, or a time where none can stand.  PARSE-FORMULA is for
;;;; formulas from elsewhere: state formulas, which speak of one timepoint, state constraints, and
;;;; questions about timepoints given by number.

(in-package #:discrepancy-finder.event-calculus)

(defconstant +environment-size+ 64
  "The number of variables that an axiom may have.")

(defun check-structure (scope form check-leaf)
  "Check the connectives and quantifiers of FORM; call CHECK-LEAF with the scope and the form of
each atomic formula in it."
  (unless (and (consp form) (keywordp (first form)))
    (scope-problem scope (and (consp form) form) "~a was found where a formula was expected"
                   (formula-text form)))
  (flet ((check (part) (check-structure scope part check-leaf)))
    (case (first form)
      ((:and :or) (mapc #'check (rest form)))
      (:not (check-arity scope form 1 1) (check (second form)))
      ((:implies :iff) (check-arity scope form 2 2) (mapc #'check (rest form)))
      ((:forall :exists)
       (check-arity scope form 2 2)
       (unless (and (consp (second form)) (every #'variable-p (second form)))
         (scope-problem scope form "a list of variables was expected after ~a"
                        (name-text (first form))))
       (let ((inner (bind-variables scope (second form))))
         (dolist (variable (second form)) (check-variable inner variable form))
         (check-structure inner (third form) check-leaf)))
      (t (funcall (the function check-leaf) scope form)))))

(defun check-atomic-formula (scope form)
  (cond ((member (first form) *comparisons*)
         (check-arity scope form 2 2)
         (let ((sort (if (member (first form) '(:= :/=)) nil :integer)))
           (dolist (term (rest form)) (check-term scope term sort form))
           (when (and (null sort) (scope-strict-p scope))
             (check-compared scope form))))
        (t (check-predication scope form))))

(defun check-formula (scope form)
  "Check FORM in SCOPE; signal a THEORY-ERROR where it is not well-formed."
  (check-structure scope form #'check-atomic-formula))

(defun nested-variables (form)
  "Return the greatest number of variables that quantifiers in FORM bind around a formula."
  (cond ((atom form) 0)
        ((member (first form) '(:forall :exists))
         (+ (length (second form)) (nested-variables (third form))))
        ((member (first form) *connectives*)
         (reduce #'max (rest form) :key #'nested-variables :initial-value 0))
        (t 0)))

(defun check-variable-count (scope form)
  (let ((count (+ (length (free-variables form)) (nested-variables form))))
    ;; One place is for a time.
    (when (>= count +environment-size+)
      (scope-problem scope nil "it has ~d variables, where fewer than ~d variables can stand" count
                     +environment-size+))))

;;; Forms

(defun free-variables (form &optional bound)
  "Return the free variables of FORM in order of appearance."
  (cond ((variable-p form) (unless (member form bound) (list form)))
        ((atom form) '())
        ((member (first form) '(:forall :exists))
         (free-variables (third form) (append (second form) bound)))
        (t (remove-duplicates (mapcan (lambda (part) (free-variables part bound))
                                      (copy-list form))
                              :from-end t))))

(defun mentions-value-p (term)
  "Return true if TERM, or a form, depends on a numeric fluent."
  (and (consp term)
       (or (eq (first term) :value-at) (some #'mentions-value-p (rest term)))))

(defun static-form-p (form)
  "Return true if FORM only compares terms."
  (case (first form)
    ((:and :or :not :implies :iff) (every #'static-form-p (rest form)))
    (t (and (member (first form) *comparisons*) (not (mentions-value-p form))))))

;;; Predications

(defun numeric-atom-p (theory form)
  "Return true if FORM applies a numeric fluent of THEORY."
  (and (consp form) (assoc (first form) (theory-numeric-fluents theory)) t))

(defun signature (theory form)
  "Return the declaration of the standard predicate that FORM applies, or NIL.  What is released,
and where a trajectory leads, may be a numeric fluent."
  (case (first form)
    (:releases (if (numeric-atom-p theory (third form))
                   '(:releases :event :numeric-fluent :time)
                   (assoc :releases *standard-predicates*)))
    (t (assoc (first form) *standard-predicates*))))

(defun unknown-predicate (scope form)
  (let ((theory (scope-theory scope)) (operator (first form)) (axiom (scope-axiom scope)))
    (cond ((or (member operator *arithmetic*) (eq operator :value-at)
               (find-function theory operator) (reified-symbol theory operator))
           (scope-problem scope form "~a is a term where a formula was expected"
                          (formula-text form)))
          (t
           (scope-problem scope form "~a is no operator and no predicate~a~:[~;; an axiom is a ~
                                      formula, (name formula) or (name :label label formula)~]"
                          (name-text operator)
                          (other-kind-text theory form :in-formula t)
                          (and (axiom-p axiom) (eq form (axiom-formula axiom))
                               (scope-strict-p scope)
                               (null (kind-of-name theory operator))
                               (rest form)))))))

(defun check-predication (scope form)
  (let* ((theory (scope-theory scope))
         (operator (first form))
         (standard (signature theory form))
         (predicate (assoc operator (theory-predicates theory))))
    (cond ((and (eq (scope-kind scope) :state) (not predicate))
           (check-atom scope form (theory-fluents theory) "fluent" form))
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
          (t (unknown-predicate scope form)))))

;;; Formulas from elsewhere

(defun parse-formula (form theory &key (kind :state) (blame "a formula") (variables '()))
  "Return FORM, a tree of symbols of any package, as a formula of THEORY.  KIND is :STATE, where
fluents stand for themselves and there is no time, :CONSTRAINT, with holds-at and happens at ?time
or (+ ?time n), or :QUERY, with timepoints by number.  BLAME names the form in errors; VARIABLES are
bound.  Signals THEORY-ERROR, also for unbound variables."
  (let ((formula (normalize form (theory-name theory) blame))
        (scope (make-scope :theory theory :axiom blame :kind kind :variables variables)))
    (check-formula scope formula)
    (check-variable-count scope formula)
    formula))
