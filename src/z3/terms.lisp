;;;; Terms: what Z3 reasons about.
;;;;
;;;; An argument of the functions that build terms is a TERM or a constant of its sort (a Lisp
;;;; object, see sorts.lisp).  They fold constants, so that Z3 sees only what is left, and of
;;;; constants alone they make a constant, without Z3.  A PROPOSITION is an argument of the sort of
;;;; truth values: T, NIL or a TERM.
;;;;
;;;; Equal terms are one object inside of Z3; TERM-EQUAL tells.  Terms live as long as their
;;;; context, or as the WITH-RELEASED-TERMS in whose body they were made.  Here are their lives,
;;;; variables and constants; see connectives.lisp, equality.lisp and arithmetic.lisp for the rest.

(in-package #:discrepancy-finder.z3)

(defstruct (term (:constructor %make-term (context pointer sort operand)) (:copier nil))
  "A term of Z3."
  (context nil :type context :read-only t)
  ;; 0 when the term was released.
  (pointer 0 :type (unsigned-byte 64))
  (sort nil :type sort :read-only t)
  ;; T in a variable, the negated term in a negation, a number or a string in a constant, else NIL.
  (operand nil :type (or boolean term rational string) :read-only t))

(deftype proposition ()
  "What can be asserted: T, NIL (the constants) or a TERM, which must be one of truth values."
  '(or boolean term))

(setf (documentation 'term-p 'function)
      "Return true if its argument is a TERM."
      (documentation 'term-context 'function)
      "Return the context of a term."
      (documentation 'term-sort 'function)
      "Return the sort of a term.")

(declaim (inline boolean-p))
(defun boolean-p (term)
  (eq (sort-kind (term-sort term)) :boolean))

(defun literal-p (term)
  "Return true if TERM is a propositional variable or the negation of one."
  (let ((operand (term-operand term)))
    (and (boolean-p term)
         (or (eq operand t)
             (and (term-p operand) (eq (term-operand operand) t))))))

(declaim (inline live-pointer proposition-pointer))
(defun live-pointer (term context)
  "Return the address of TERM.  Signal Z3-ERROR if it is not a live term of CONTEXT."
  (let ((pointer (term-pointer term)))
    (unless (eq (term-context term) context)
      (misuse :other-context "the term belongs to another context"))
    (when (zerop pointer)
      (misuse :released-term "the term was released at the end of WITH-RELEASED-TERMS"))
    pointer))

(defun wrong-sort (operation argument needed)
  "Signal that OPERATION, a symbol, was given ARGUMENT where it needs NEEDED, words."
  (misuse :sort-error "~(~a~) is given ~a where ~a is needed"
          operation
          (typecase argument
            (term (format nil "~a, ~a," (term-text argument) (sort-text (term-sort argument))))
            (boolean (if argument "the truth value T" "the truth value NIL"))
            (float (format nil "~a, which is not exact," argument))
            ((or rational string) (prin1-to-string argument))
            (t (format nil "~s, which is no term," argument)))
          needed))

(defun proposition-pointer (operation term context)
  "Return the address of TERM.  Signal Z3-ERROR if it is not a live term of truth values."
  (unless (boolean-p term)
    (wrong-sort operation term (kind-text :boolean)))
  (live-pointer term context))

(defun term-text (term)
  "Return Z3's text of TERM."
  (let ((context (term-context term)))
    (if (or (zerop (term-pointer term)) (zerop (context-pointer context)))
        "released"
        (calling-z3 (pointer context)
          (decode (z3-ast-to-string pointer (term-pointer term)))))))

(defmethod print-object ((term term) stream)
  (print-unreadable-object (term stream :type t)
    (write-string (term-text term) stream)))

;;; Life

(defmacro making-term ((pointer context &optional operand sort) form)
  "Return a TERM of SORT, truth values by default, for the address that FORM, a call of Z3, returns
in the Z3 context at POINTER."
  (let ((address (gensym "ADDRESS")) (term (gensym "TERM")) (owner (gensym "CONTEXT"))
        (sort-of-term (gensym "SORT")))
    `(let* ((,owner ,context) (,sort-of-term ,(or sort `(boolean-sort ,owner))))
       (calling-z3 (,pointer ,owner)
         (let ((,address ,form))
           ;; A refused call gives 0; reading the error code is left to CALLING-Z3, since the
           ;; next call would reset it.
           (unless (zerop ,address)
             (let ((,term (%make-term ,owner ,address ,sort-of-term ,operand)))
               (cond ((eq (context-trail ,owner) :kept)
                      (z3-ast-vector-push ,pointer (context-kept ,owner) ,address))
                     (t (z3-inc-ref ,pointer ,address)
                        (push ,term (context-trail ,owner))))
               ,term)))))))

(defun release-terms (context terms)
  (sb-sys:without-interrupts
    (let ((pointer (context-pointer context)))
      (dolist (term terms)
        (let ((address (shiftf (term-pointer term) 0)))
          (unless (zerop pointer)
            (z3-dec-ref pointer address)))))))

(defun call-with-released-terms (context function)
  (let ((outer (context-trail context)))
    (unwind-protect (progn (setf (context-trail context) '())
                           (funcall function))
      (release-terms context (shiftf (context-trail context) outer)))))

(defmacro with-released-terms ((context) &body body)
  "Evaluate BODY, release the terms of CONTEXT that were made in it, and return its values.  Using
such a term afterwards signals Z3-ERROR; solvers keep what was asserted."
  `(call-with-released-terms ,context (lambda () ,@body)))

;;; Variables and constants

(defun variable (context name &optional (sort (boolean-sort context)))
  "Return the variable of CONTEXT and of SORT, truth values by default, named by the string NAME;
any string will do, and different names or sorts make different variables.  Signals Z3-ERROR."
  (unless (eq (sort-context sort) context)
    (misuse :other-context "the sort belongs to another context"))
  (with-encoded-text (text name)
    (making-term (pointer context t sort)
      (z3-mk-const pointer (z3-mk-string-symbol pointer text) (sort-pointer sort)))))

(defun numeral-term (value sort)
  "Return the TERM of the rational VALUE, which fits SORT."
  (let ((context (sort-context sort)))
    (if (typep value '(signed-byte 64))
        (making-term (pointer context value sort)
          (z3-mk-int64 pointer value (sort-pointer sort)))
        (with-encoded-text (text (format nil "~d~@[/~d~]" (numerator value)
                                         (and (/= (denominator value) 1) (denominator value))))
          (making-term (pointer context value sort)
            (z3-mk-numeral pointer text (sort-pointer sort)))))))

(defun constant-term (constant sort)
  "Return the Lisp object CONSTANT, a constant of SORT, as a TERM.  It is seldom needed, since
constants may stand beside terms everywhere.  Signals Z3-ERROR if SORT has no such constant."
  (unless (fits-p constant sort)
    (wrong-sort 'constant-term constant (sort-text sort)))
  (let ((context (sort-context sort)))
    (ecase (sort-kind sort)
      (:boolean (making-term (pointer context nil sort)
                  (if constant (z3-mk-true pointer) (z3-mk-false pointer))))
      ((:integer :real) (numeral-term constant sort))
      (:enumeration
       (let ((constructor (nth (position constant (sort-elements sort) :test #'string=)
                               (sort-constructors sort))))
         (making-term (pointer context constant sort)
           (z3-mk-app pointer constructor 0 (cffi:null-pointer))))))))

(declaim (inline constant-of))
(defun constant-of (argument)
  "Return ARGUMENT, or the number or element that it is the term of."
  (if (and (term-p argument) (typep (term-operand argument) '(or rational string)))
      (term-operand argument)
      argument))

(defun argument-pointer (argument sort)
  "Return the address of ARGUMENT, a term or a constant of SORT."
  (if (term-p argument)
      (live-pointer argument (sort-context sort))
      (term-pointer (constant-term argument sort))))

(defun argument-pointers (arguments sort)
  (map 'handles (lambda (argument) (argument-pointer argument sort)) arguments))

(defun common-sort (operation arguments kind)
  "Return the sort of the terms among the list ARGUMENTS of OPERATION, a symbol; NIL if there are
only constants.  Signal Z3-ERROR unless all have that sort and it is of KIND: that of a sort,
:NUMBER, or :ANY."
  (let* ((first (find-if #'term-p arguments))
         (sort (and first (term-sort first))))
    (flet ((kind-p (kind-of-sort)
             (case kind
               (:any t)
               (:number (member kind-of-sort '(:integer :real)))
               (t (eq kind-of-sort kind)))))
      (when (and sort (not (kind-p (sort-kind sort))))
        (wrong-sort operation first (kind-text kind)))
      (let ((constant-kind kind))
        (dolist (argument arguments sort)
          (cond ((term-p argument)
                 (unless (eq (term-context argument) (term-context first))
                   (misuse :other-context "the term belongs to another context"))
                 (unless (eq (term-sort argument) sort)
                   (wrong-sort operation argument (sort-text sort))))
                (sort
                 (unless (fits-p argument sort)
                   (wrong-sort operation argument (sort-text sort))))
                (t
                 (unless (typep argument (ecase constant-kind
                                           (:any '(or boolean rational string))
                                           (:boolean 'boolean)
                                           (:integer 'integer)
                                           ((:number :real) 'rational)
                                           (:enumeration 'string)))
                   (wrong-sort operation argument (if (eq constant-kind :any)
                                                      "a term"
                                                      (kind-text constant-kind))))
                 (when (eq constant-kind :any)
                   (setf constant-kind (etypecase argument
                                         (boolean :boolean) (rational :number)
                                         (string :enumeration)))))))))))

;;; Questions about terms

(defun symbol-name-in-lisp (pointer symbol)
  "Return the string or integer that Z3's SYMBOL in the context at POINTER is."
  (if (= (z3-get-symbol-kind pointer symbol) 0)
      (z3-get-symbol-int pointer symbol)
      (decode (z3-get-symbol-string pointer symbol))))

(defun term-name (term)
  "Return the name, a string, of TERM if it is a variable, else NIL; for a variable of a clause set
without names it is an integer.  The SMT-LIB text of a term shows the name between bars where it
must be quoted."
  (when (eq (term-operand term) t)
    (let ((address (live-pointer term (term-context term))))
      (calling-z3 (pointer (term-context term))
        (symbol-name-in-lisp
         pointer (z3-get-decl-name pointer (z3-get-app-decl pointer address)))))))

(defun term-equal (p q)
  "Return true if the arguments P and Q are the same constant or the same term, structurally.
Signals Z3-ERROR if they are terms of different contexts."
  (if (and (term-p p) (term-p q))
      (= (live-pointer p (term-context p)) (live-pointer q (term-context p)))
      (equal p q)))
