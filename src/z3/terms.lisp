;;;; Propositions: the Lisp booleans and Z3's boolean terms.
;;;;
;;;; A PROPOSITION is T, NIL or a TERM.  Constructors fold constants, so that Z3 sees only what is
;;;; left: (conjunction (list t p)) is p, and of constants alone a constant is made, without Z3.
;;;; Equal terms are one object inside of Z3; TERM-EQUAL tells.  Terms live as long as their
;;;; context, or as the WITH-RELEASED-TERMS in whose body they were made.

(in-package #:discrepancy-finder.z3)

(defstruct (term (:constructor %make-term (context pointer operand)) (:copier nil))
  "A boolean term of Z3 that is no constant."
  (context nil :type context :read-only t)
  ;; 0 when the term was released.
  (pointer 0 :type (unsigned-byte 64))
  ;; T in a variable, the negated term in a negation, else NIL.
  (operand nil :type (or boolean term) :read-only t))

(deftype proposition ()
  "What can be asserted: T, NIL (the constants) or a TERM."
  '(or boolean term))

(defun literal-p (term)
  "Return true if TERM is a variable or the negation of one."
  (let ((operand (term-operand term)))
    (or (eq operand t)
        (and operand (eq (term-operand operand) t)))))

(declaim (inline live-pointer))
(defun live-pointer (term context)
  "Return the address of TERM.  Signal Z3-ERROR if it is not a live term of CONTEXT."
  (let ((pointer (term-pointer term)))
    (unless (eq (term-context term) context)
      (misuse :other-context "the term belongs to another context"))
    (when (zerop pointer)
      (misuse :released-term "the term was released at the end of WITH-RELEASED-TERMS"))
    pointer))

(setf (documentation 'term-p 'function)
      "Return true if its argument is a TERM."
      (documentation 'term-context 'function)
      "Return the context of a term.")

(defmethod print-object ((term term) stream)
  (print-unreadable-object (term stream :type t)
    (let ((context (term-context term)))
      (write-string (if (or (zerop (term-pointer term)) (zerop (context-pointer context)))
                        "released"
                        (calling-z3 (pointer context)
                          (decode (z3-ast-to-string pointer (term-pointer term)))))
                    stream))))

;;; Life

(defmacro making-term ((pointer context &optional operand) form)
  "Return a TERM for the address that FORM, a call of Z3, returns in the Z3 context at POINTER."
  (let ((address (gensym "ADDRESS")) (term (gensym "TERM")) (owner (gensym "CONTEXT")))
    `(let ((,owner ,context))
       (calling-z3 (,pointer ,owner)
         (let ((,address ,form))
           ;; A refused call gives 0; reading the error code is left to CALLING-Z3, since the
           ;; next call would reset it.
           (unless (zerop ,address)
             (z3-inc-ref ,pointer ,address)
             (let ((,term (%make-term ,owner ,address ,operand)))
               (unless (eq (context-trail ,owner) :kept)
                 (push ,term (context-trail ,owner)))
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

;;; Variables

(defun variable (context name)
  "Return the propositional variable of CONTEXT named by the string NAME; any string will do, and
different strings name different variables.  Signals Z3-ERROR."
  (with-encoded-text (text name)
    (making-term (pointer context t)
      (z3-mk-const pointer (z3-mk-string-symbol pointer text) (context-boolean-sort context)))))

(defun term-name (term)
  "Return the name, a string, of TERM if it is a variable, else NIL.  The SMT-LIB text of a term
shows it between bars where it must be quoted; the empty name is shown as the name null is."
  (when (eq (term-operand term) t)
    (let ((address (live-pointer term (term-context term))))
      (calling-z3 (pointer (term-context term))
        (decode (z3-get-symbol-string
                 pointer (z3-get-decl-name pointer (z3-get-app-decl pointer address))))))))

(defun term-equal (p q)
  "Return true if the propositions P and Q are the same constant or the same term, structurally.
Signals Z3-ERROR if they are terms of different contexts."
  (if (and (term-p p) (term-p q))
      (= (live-pointer p (term-context p)) (live-pointer q (term-context p)))
      (eq p q)))

;;; Connectives

(defun negation (p)
  "Return the negation of the proposition P; that of a negation is what it negates."
  (check-type p proposition)
  (if (term-p p)
      (let* ((context (term-context p)) (address (live-pointer p context)))
        (if (term-p (term-operand p))
            (term-operand p)
            (making-term (pointer context p)
              (z3-mk-not pointer address))))
      (not p)))

(defmacro define-connective (name maker neutral documentation)
  "Define NAME to join a list of propositions by MAKER, of which the constant NEUTRAL is the neutral
element and its negation the absorbing one."
  `(defun ,name (propositions)
     ,documentation
     (let ((count 0) (first nil))
       (declare (type (unsigned-byte 32) count))
       (dolist (proposition propositions)
         (cond ((eq proposition ,neutral))
               ((eq proposition ,(not neutral)) (return-from ,name ,(not neutral)))
               (t (check-type proposition term)
                  (when (zerop count) (setf first proposition))
                  (incf count))))
       (case count
         (0 ,neutral)
         (1 first)
         (t (let ((context (term-context first)) (position 0)
                  (terms (make-array count :element-type '(unsigned-byte 64))))
              (declare (type (unsigned-byte 32) position))
              (dolist (proposition propositions)
                (when (term-p proposition)
                  (setf (aref terms position) (live-pointer proposition context))
                  (incf position)))
              (sb-sys:with-pinned-objects (terms)
                (making-term (pointer context)
                  (,maker pointer count (sb-sys:vector-sap terms))))))))))

(define-connective conjunction z3-mk-and t
  "Return the conjunction of the list PROPOSITIONS: T of the empty list, the term itself of one
term.  Signals Z3-ERROR if terms of different contexts meet.")

(define-connective disjunction z3-mk-or nil
  "Return the disjunction of the list PROPOSITIONS: NIL of the empty list, the term itself of one
term.  Signals Z3-ERROR if terms of different contexts meet.")

(defun implication (p q)
  "Return the proposition that P implies Q.  Signals Z3-ERROR if terms of different contexts meet."
  (check-type p proposition)
  (check-type q proposition)
  (cond ((eq p t) q)
        ((or (null p) (eq q t)) t)
        ((null q) (negation p))
        (t (let* ((context (term-context p))
                  (left (live-pointer p context)) (right (live-pointer q context)))
             (making-term (pointer context)
               (z3-mk-implies pointer left right))))))

(defun equivalence (p q)
  "Return the proposition that P and Q have the same truth value.  Signals Z3-ERROR if terms of
different contexts meet."
  (check-type p proposition)
  (check-type q proposition)
  (cond ((eq p t) q)
        ((eq q t) p)
        ((null p) (negation q))
        ((null q) (negation p))
        (t (let* ((context (term-context p))
                  (left (live-pointer p context)) (right (live-pointer q context)))
             (making-term (pointer context)
               (z3-mk-iff pointer left right))))))
