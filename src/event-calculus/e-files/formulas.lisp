;;;; Formulas of a .e file as formulas of a theory.
;;;;
;;;; RESOLVE-FORMULA turns the node of a formula (see expressions.lisp) into a tree of keywords
;;;; and checks on the way what the text of the file explains best: names that are not declared,
;;;; numbers of arguments, variables without a sort, terms where formulas belong.  An argument of
;;;; a wrong sort is no error in this language: the instances in which it does not fit are
;;;; dropped.
;;;;
;;;; Names: a sort or variable without upper-case letters is upcased, agent1 is :?AGENT1; all other
;;;; names are kept by their characters, Nathan is :|Nathan|.

(in-package #:discrepancy-finder.event-calculus)

(defun e-name-keyword (name)
  "Return the keyword with the characters of NAME."
  (intern name :keyword))

(defun e-sort-keyword (name)
  "Return the keyword for the sort NAME, or for its variable after a question mark."
  (e-name-keyword (if (some #'upper-case-p name) name (string-upcase name))))

(defun e-variable-keyword (name)
  (e-sort-keyword (concatenate 'string "?" name)))

(defun e-predicate-keyword (vocabulary name)
  "Return the keyword for the predicate NAME: for one of the event calculus its name in Lisp."
  (let ((standard (standard-predicate vocabulary name)))
    (if standard (second standard) (e-name-keyword name))))

(defun e-variable-p (name)
  "Return true if NAME is that of a variable, which begins with a lower-case letter."
  (lower-case-p (char name 0)))

(defstruct (resolver (:constructor make-resolver (vocabulary file)) (:copier nil))
  "What is needed to resolve the formulas of FILE."
  (vocabulary nil :type vocabulary :read-only t)
  (file "" :type string :read-only t))

(defun node-problem (resolver line control &rest arguments)
  (apply #'e-problem (resolver-file resolver) line control arguments))

(defun node-line (node line)
  "Return the line of NODE, which is LINE or after it."
  (if (consp node) (second node) line))

(defun node-mentions-p (node names)
  "Return true if NODE contains a symbol or constant whose name is among NAMES."
  (and (consp node)
       (case (first node)
         (:name (member (third node) names :test #'string=))
         (:call (or (member (third node) names :test #'string=)
                    (some (lambda (argument) (node-mentions-p argument names)) (cdddr node))))
         ((:forall :exists) (node-mentions-p (fourth node) names))
         (t (some (lambda (operand) (node-mentions-p operand names)) (cddr node))))))

;;; Terms

(defun resolve-variable (resolver line name)
  (let ((vocabulary (resolver-vocabulary resolver))
        (sort (string-right-trim "0123456789" name)))
    (unless (e-variable-p name)
      (node-problem resolver line "~a cannot be a variable: it begins with an upper-case letter"
                    name))
    (unless (or (known-sort-p vocabulary name) (known-sort-p vocabulary sort))
      (node-problem resolver line "the variable ~a has no sort: there is no sort ~a" name sort))
    (e-variable-keyword name)))

(defun term-symbol (resolver name sort)
  "Return the declared symbol NAME, preferably one whose terms are of SORT, or NIL."
  (let ((vocabulary (resolver-vocabulary resolver)))
    (flet ((among (sort) (find-declared-symbol vocabulary name sort)))
      (or (and (member sort '("fluent" "event") :test #'equal) (among sort))
          (among "function")
          (among nil)
          (among "fluent")
          (among "event")))))

(defun resolve-arguments (resolver line name arguments sorts)
  (unless (= (length arguments) (length sorts))
    (node-problem resolver line "~a takes ~d argument~:p, not ~d" name (length sorts)
                  (length arguments)))
  (loop for argument in arguments
        for sort in sorts
        collect (resolve-term resolver line argument sort)))

(defun no-such-name (resolver line name sort)
  "Signal that NAME, where a term of SORT was expected, is not declared."
  (let ((vocabulary (resolver-vocabulary resolver)))
    (cond ((or (find-declared-symbol vocabulary name "predicate")
               (standard-predicate vocabulary name))
           (node-problem resolver line "the predicate ~a was found where a term was expected" name))
          ((member sort '("fluent" "event") :test #'equal)
           (node-problem resolver line "there is no ~a ~a" sort name))
          (t (node-problem resolver line "~a is not declared" name)))))

(defun resolve-application (resolver line name arguments sort)
  "Return the term that the symbol NAME builds of ARGUMENTS where SORT is expected."
  (let ((symbol (term-symbol resolver name sort)))
    (unless symbol
      (no-such-name resolver line name sort))
    (when (and (member sort '("fluent" "event") :test #'equal)
               (not (equal (declared-symbol-sort symbol) sort))
               (not (equal (declared-symbol-value symbol) sort)))
      (node-problem resolver line "there is no ~a ~a, only a symbol of sort ~a" sort name
                    (or (declared-symbol-value symbol) (declared-symbol-sort symbol))))
    (cons (e-name-keyword name)
          (resolve-arguments resolver line name arguments (declared-symbol-arguments symbol)))))

(defun resolve-constant (resolver line name sort)
  "Return the constant or the term without arguments that NAME means where SORT is expected."
  (cond ((member sort '("fluent" "event") :test #'equal)
         (resolve-application resolver line name '() sort))
        ((gethash name (vocabulary-constants (resolver-vocabulary resolver)))
         (e-name-keyword name))
        (t (resolve-application resolver line name '() sort))))

(defun resolve-term (resolver line node sort)
  "Return the term of NODE, in LINE, where SORT, or NIL for any, is expected."
  (cond ((integerp node)
         (when (member sort '("fluent" "event") :test #'equal)
           (node-problem resolver line "~a ~a was expected, but the number ~d was found"
                         (if (string= sort "event") "an" "a") sort node))
         node)
        ((member (first node) *arithmetic*)
         (cons (first node)
               (mapcar (lambda (operand) (resolve-term resolver (second node) operand "integer"))
                       (cddr node))))
        (t (destructuring-bind (kind line name &rest arguments) node
             (case kind
               (:name (if (e-variable-p name)
                          (resolve-variable resolver line name)
                          (resolve-constant resolver line name sort)))
               (:call (if (and (null arguments) (not (term-symbol resolver name sort)))
                          (resolve-constant resolver line name sort)
                          (resolve-application resolver line name arguments sort)))
               (t (node-problem resolver line
                                "a formula was found where a term was expected")))))))

;;; Formulas

(defun resolve-predication (resolver line name arguments)
  (let* ((vocabulary (resolver-vocabulary resolver))
         (standard (standard-predicate vocabulary name))
         (predicate (find-declared-symbol vocabulary name "predicate"))
         (symbol (term-symbol resolver name nil)))
    (cond (standard
           (cons (second standard)
                 (resolve-arguments resolver line name arguments (cddr standard))))
          (predicate
           (cons (e-name-keyword name)
                 (resolve-arguments resolver line name arguments
                                    (declared-symbol-arguments predicate))))
          ((and symbol (string= (declared-symbol-sort symbol) "fluent"))
           (node-problem resolver line "the fluent ~a can only stand in a predicate such as HoldsAt"
                         name))
          ((and symbol (string= (declared-symbol-sort symbol) "event"))
           (node-problem resolver line "the event ~a can only stand in a predicate such as Happens"
                         name))
          ((or symbol (e-variable-p name) (gethash name (vocabulary-constants vocabulary)))
           (node-problem resolver line "the term ~a was found where a formula was expected" name))
          (t (node-problem resolver line "there is no predicate ~a" name)))))

(defun resolve-formula (resolver line node)
  "Return the formula of NODE, which begins in LINE or after it.  Signals E-FILE-ERROR."
  (when (integerp node)
    (node-problem resolver line "the number ~d was found where a formula was expected" node))
  (destructuring-bind (operator line &rest operands) node
    (flet ((term (node) (resolve-term resolver line node nil))
           (formula (node) (resolve-formula resolver (node-line node line) node)))
      (cond ((member operator '(:forall :exists))
             (list operator
                   (mapcar (lambda (name) (resolve-variable resolver line name)) (first operands))
                   (formula (second operands))))
            ((member operator *connectives*) (cons operator (mapcar #'formula operands)))
            ((member operator *comparisons*) (cons operator (mapcar #'term operands)))
            ((member operator *arithmetic*)
             (node-problem resolver line "a term was found where a formula was expected"))
            (t (resolve-predication resolver line (first operands) (rest operands)))))))

(defun resolve-sentence (resolver line node)
  "Return the formula of NODE without the universal quantifiers in front, since free variables are
universally quantified."
  (strip-quantifiers (resolve-formula resolver line node)))
