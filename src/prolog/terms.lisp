;;;; Terms: what is unified while a query is proved.
;;;;
;;;; A term is a Lisp object in which LOGIC-VARIABLEs stand where a query or a fact has a symbol ?x.
;;;; A variable is bound by assignment; the trail of the PROOF says which bindings to undo.
;;;; INTERNALISE and EXTERNALISE go from symbols to variables and back.  UNIFY, at the end, is
;;;; unification as Lisp sees it.

(in-package #:discrepancy-finder.prolog)

(defstruct (logic-variable (:conc-name variable-) (:predicate variable-p) (:copier nil)
                           (:constructor make-variable (name &optional symbol)))
  "A variable.  NAME is that of its origin.  SYMBOL stands for it in Lisp, if there is one."
  (value '%unbound)
  (name nil :type symbol :read-only t)
  (symbol nil :type symbol))

(defmethod print-object ((variable logic-variable) stream)
  (print-unreadable-object (variable stream :type t :identity t)
    (princ (variable-name variable) stream)))

(defstruct (proof (:constructor make-proof (&optional query)) (:copier nil))
  "The proof of a query.  FRAME: the goals that are left.  CHOICES: what else to try.  TRAIL: the
variables that were bound since.  TRAILING: whether bindings are undone although there is no
choice."
  (query nil :read-only t)
  (frame nil)
  (choices nil)
  (trail '() :type list)
  (trailing nil))

(defmethod print-object ((proof proof) stream)
  (print-unreadable-object (proof stream :type t :identity t)
    (write-string (goal-text (proof-query proof)) stream)))

(declaim (inline unbound-p variable-target deref))
(defun unbound-p (variable)
  (eq (variable-value variable) '%unbound))

(defun variable-target (term)
  "Return what TERM is bound to: a term that is no variable, or an unbound variable."
  (loop while (and (variable-p term) (not (unbound-p term)))
        do (setf term (variable-value term)))
  term)

(defun deref (term)
  "Return what TERM is bound to; of a delayed lazy list the list."
  (let ((target (variable-target term)))
    (if (delayed-p target) (force target) target)))

(defun occurs-p (variable term)
  "Return true if the unbound VARIABLE is in TERM."
  (loop
    (let ((term-now (variable-target term)))
      (cond ((eq term-now variable) (return t))
            ((atom term-now) (return nil))
            ((null (cdr term-now)) (setf term (car term-now)))
            ((occurs-p variable (car term-now)) (return t))
            (t (setf term (cdr term-now)))))))

(declaim (inline assign))
(defun assign (proof variable value)
  (when (or (proof-choices proof) (proof-trailing proof))
    (push variable (proof-trail proof)))
  (setf (variable-value variable) value)
  t)

(defun bind (proof variable term)
  "Bind the unbound VARIABLE to TERM and return true, or return false if VARIABLE is in TERM: there
are no cyclic terms."
  (cond ((atom term) (assign proof variable term))
        ((occurs-p variable term) nil)
        (t (assign proof variable term))))

(defun undo-to (proof mark)
  "Undo the bindings made since the trail was MARK."
  (loop until (eq (proof-trail proof) mark)
        do (setf (variable-value (pop (proof-trail proof))) '%unbound)))

;;; Unification

(defgeneric unify-p (left right)
  (:documentation "Return true if the objects LEFT and RIGHT, instances of classes or structures
that are not the same, unify.  Unification asks methods of other layers in this way, in the order of
the two terms; the default is false.  A method returns: it leaves by no error and no other exit.")
  (:method (left right) (declare (ignore left right)) nil))

(defun not-a-number-p (number)
  (and (floatp number) (sb-ext:float-nan-p number)))

(defun numbers-unify-p (left right)
  "Numbers unify if they are =; a float that is not a number unifies with nothing else."
  (and (not (not-a-number-p left))
       (not (not-a-number-p right))
       (= left right)))

(defun instance-p (object)
  (typep object '(or standard-object structure-object)))

(defun leaves-unify-p (left right)
  "Return true if LEFT and RIGHT, atoms other than variables or an atom and a cons, unify."
  (cond ((eql left right) t)
        ((symbolp left) nil)
        ((numberp left) (and (numberp right) (numbers-unify-p left right)))
        ((instance-p left) (and (instance-p right)
                                (or (equal left right)
                                    (and (unify-p left right) t))))
        (t (equal left right))))

(defun unify-variable (proof variable term)
  "Unify the unbound VARIABLE with TERM, which is dereferenced and not VARIABLE."
  (if (and (variable-p term) (variable-symbol variable) (not (variable-symbol term)))
      ;; A variable of the query keeps its name.
      (assign proof term variable)
      (bind proof variable term)))

(defun unify-terms (proof left right)
  "Unify the terms LEFT and RIGHT, binding variables, and return true; or return false, with some of
the bindings made."
  (loop
    (setf left (variable-target left)
          right (variable-target right))
    (cond ((eq left right) (return t))
          ((variable-p left) (return (unify-variable proof left right)))
          ((variable-p right) (return (unify-variable proof right left)))
          ((and (consp left) (consp right))
           (cond ((and (null (cdr left)) (null (cdr right)))
                  (setf left (car left)
                        right (car right)))
                 ((unify-terms proof (car left) (car right))
                  (setf left (cdr left)
                        right (cdr right)))
                 (t (return nil))))
          ((delayed-p left) (setf left (force left)))
          ((delayed-p right) (setf right (force right)))
          (t (return (leaves-unify-p left right))))))

;;; From symbols to variables and back

(defstruct (names (:constructor make-names (bindings &optional table)) (:copier nil))
  "Which variable stands for which symbol: TABLE is an alist (symbol . variable).  BINDINGS are the
values that symbols have when they are met first."
  (bindings '() :type list :read-only t)
  (table '() :type list))

(defun internalise (form names)
  "Return FORM with variables in the places of its symbols ?x, which are entered in NAMES."
  (if (some-leaf #'is-var form)
      (copy-form (lambda (node) (if (is-var node) (named-variable node names) node)) form)
      form))

(defun named-variable (symbol names)
  "Return the variable that stands for SYMBOL in NAMES."
  (cond ((is-unnamed-var symbol) (make-variable symbol))
        ((cdr (assoc symbol (names-table names) :test #'eq)))
        (t (let* ((variable (make-variable symbol symbol))
                  (value (binding-of symbol (names-bindings names))))
             (push (cons symbol variable) (names-table names))
             (unless (eq value symbol)
               (let ((term (internalise value names)))
                 (unless (eq (variable-target term) variable)
                   (setf (variable-value variable) term))))
             variable))))

(defun variable-placeholder (variable)
  "Return the symbol that stands for the unbound VARIABLE in Lisp."
  (or (variable-symbol variable)
      (setf (variable-symbol variable) (gen-var (or (variable-name variable) '?_)))))

(defun externalise (term)
  "Return TERM as a form with the values of variables, and with symbols in the places of unbound
variables, and the list of those variables.  TERM itself is returned if there are no variables."
  (let ((unbound '()))
    (values (if (some-leaf #'variable-p term)
                (copy-form (lambda (node)
                             (let ((target (variable-target node)))
                               (cond ((variable-p target)
                                      (pushnew target unbound)
                                      (variable-placeholder target))
                                     (t target))))
                           term)
                term)
            unbound)))

(defun placeholder-names (variables)
  "Return the NAMES in which the placeholder of each of VARIABLES stands for it."
  (make-names '() (loop for variable in variables
                        collect (cons (variable-symbol variable) variable))))

(defun copy-term (term)
  "Return TERM with the values of variables and a new variable for each unbound one."
  (if (some-leaf #'variable-p term)
      (let ((copies '()))
        (copy-form (lambda (node)
                     (let ((target (variable-target node)))
                       (if (variable-p target)
                           (or (cdr (assoc target copies))
                               (let ((copy (make-variable (variable-name target))))
                                 (push (cons target copy) copies)
                                 copy))
                           target)))
                   term))
      term))

(defun names-solution (names)
  "Return the bindings of NAMES with those that its variables have got by now in front."
  (let* ((given (names-bindings names))
         (solution given))
    (loop for (symbol . variable) in (names-table names)
          ;; What has a value in the bindings given keeps it: variables in it are in the table.
          do (when (eq (binding-of symbol given) symbol)
               (let ((value (externalise variable)))
                 (unless (eq value symbol)
                   (setf solution (add-bds symbol value solution))))))
    solution))

(defun unify (left right &optional bindings)
  "Unify the forms LEFT and RIGHT under BINDINGS.  Return the binding set that makes them equal, an
extension of BINDINGS, and true; or NIL and NIL if there is none.  Lists unify element by element,
numbers if they are =, strings if they are EQUAL, instances if they are EQL or UNIFY-P says so.  A
variable does not unify with a list that contains it."
  (let ((names (make-names bindings)))
    (if (unify-terms (make-proof) (internalise left names) (internalise right names))
        (values (names-solution names) t)
        (values nil nil))))
