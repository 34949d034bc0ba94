;;;; Arithmetic: terms of integers and reals, exact.
;;;;
;;;; Integers and reals are different sorts, and a term of one does not stand beside a term of the
;;;; other: INTEGER-TO-REAL and REAL-TO-INTEGER lead from one to the other.  A Lisp integer stands
;;;; beside both, a ratio beside reals, a float beside none, since it is not exact.

(in-package #:discrepancy-finder.z3)

(defmacro making-numeric-term ((pointer sort handles) form)
  "Return the TERM of SORT for the address that FORM returns, where the vector HANDLES is pinned."
  `(locally (declare (type handles ,handles))
     (sb-sys:with-pinned-objects (,handles)
       (making-term (,pointer (sort-context ,sort) nil ,sort)
         ,form))))

;;; Sums and products

(defun sum (arguments)
  "Return the sum of the list ARGUMENTS of numeric terms and rationals; 0 of none.  Signals
Z3-ERROR."
  (let ((sort (common-sort 'sum arguments :number)) (constant 0) (terms '()))
    (dolist (argument (mapcar #'constant-of arguments))
      (if (term-p argument)
          (push argument terms)
          (incf constant argument)))
    (unless (or (eql constant 0) (null terms))
      (push constant terms))
    (cond ((null terms) constant)
          ((null (rest terms)) (first terms))
          (t (let ((handles (argument-pointers (reverse terms) sort)))
               (making-numeric-term (pointer sort handles)
                 (z3-mk-add pointer (length handles) (sb-sys:vector-sap handles))))))))

(defun product (arguments)
  "Return the product of the list ARGUMENTS of numeric terms and rationals; 1 of none, 0 if one is
0.  Signals Z3-ERROR."
  (let ((sort (common-sort 'product arguments :number)) (constant 1) (terms '()))
    (dolist (argument (mapcar #'constant-of arguments))
      (if (term-p argument)
          (push argument terms)
          (setf constant (* constant argument))))
    (setf terms (nreverse terms))
    (unless (or (eql constant 1) (null terms))
      (push constant terms))
    (cond ((or (null terms) (eql constant 0)) constant)
          ((null (rest terms)) (first terms))
          (t (let ((handles (argument-pointers terms sort)))
               (making-numeric-term (pointer sort handles)
                 (z3-mk-mul pointer (length handles) (sb-sys:vector-sap handles))))))))

(defmacro with-numbers ((operation kind sort (a b)) constant &body clauses)
  "Evaluate CONSTANT with A and B bound to numbers if they are constants; else the clauses of COND
with SORT bound to that of the terms."
  (let ((left (gensym "A")) (right (gensym "B")))
    `(let* ((,left ,a) (,right ,b)
            (,sort (common-sort ',operation (list ,left ,right) ,kind))
            (,a (constant-of ,left)) (,b (constant-of ,right)))
       (cond ((not (or (term-p ,a) (term-p ,b))) ,constant)
             ,@clauses))))

(defun difference (a b)
  "Return A - B, of numeric terms or rationals.  Signals Z3-ERROR."
  (with-numbers (difference :number sort (a b))
      (- a b)
    ((eql b 0) a)
    ((term-equal a b) 0)
    (t (let ((handles (argument-pointers (list a b) sort)))
         (making-numeric-term (pointer sort handles)
           (z3-mk-sub pointer 2 (sb-sys:vector-sap handles)))))))

;;; Division

(defun check-divisor (dividend divisor)
  (when (eql divisor 0)
    (misuse :division-by-zero "~d is divided by 0" dividend)))

(defun euclidean-division (a b)
  (if (plusp b) (floor a b) (ceiling a b)))

(defun quotient (a b)
  "Return A divided by B, as SMT-LIB has it.  Of reals it is the exact quotient.  Of integers, two
Lisp integers included, it is the integer q for which A - q B is at least 0 and less than the
magnitude of B.  By a 0 that only Z3 sees the quotient is any number, the same for the same A.
Signals Z3-ERROR, e.g. if constants are divided by 0."
  (with-numbers (quotient :number sort (a b))
      (progn (check-divisor a b)
             (if (and (integerp a) (integerp b)
                      (not (and sort (eq (sort-kind sort) :real))))
                 (values (euclidean-division a b))
                 (/ a b)))
    ((eql b 1) a)
    (t (let ((left (argument-pointer a sort)) (right (argument-pointer b sort)))
         (making-term (pointer (sort-context sort) nil sort)
           (z3-mk-div pointer left right))))))

(defun modulo (a b)
  "Return the remainder, at least 0 and less than the magnitude of B, of the integer terms or
integers A divided by B.  By a 0 that only Z3 sees it is any integer, the same for the same A.
Signals Z3-ERROR, e.g. if constants are divided by 0."
  (with-numbers (modulo :integer sort (a b))
      (progn (check-divisor a b)
             (nth-value 1 (euclidean-division a b)))
    (t (let ((left (argument-pointer a sort)) (right (argument-pointer b sort)))
         (making-term (pointer (sort-context sort) nil sort)
           (z3-mk-mod pointer left right))))))

;;; Comparison

(defun less (a b)
  "Return the proposition that A is less than B, of numeric terms or rationals.  Signals Z3-ERROR."
  (with-numbers (less :number sort (a b))
      (< a b)
    ((term-equal a b) nil)
    (t (let ((left (argument-pointer a sort)) (right (argument-pointer b sort)))
         (making-term (pointer (sort-context sort))
           (z3-mk-lt pointer left right))))))

(defun less-or-equal (a b)
  "Return the proposition that A is at most B, of numeric terms or rationals.  Signals Z3-ERROR."
  (with-numbers (less-or-equal :number sort (a b))
      (<= a b)
    ((term-equal a b) t)
    (t (let ((left (argument-pointer a sort)) (right (argument-pointer b sort)))
         (making-term (pointer (sort-context sort))
           (z3-mk-le pointer left right))))))

;;; Conversion

(defun integer-to-real (a)
  "Return the integer term or integer A as a real.  Signals Z3-ERROR."
  (common-sort 'integer-to-real (list a) :integer)
  (cond ((integerp a) a)
        ((integerp (constant-of a))
         (constant-term (constant-of a) (real-sort (term-context a))))
        (t (let ((address (live-pointer a (term-context a))))
             (making-term (pointer (term-context a) nil (real-sort (term-context a)))
               (z3-mk-int2real pointer address))))))

(defun real-to-integer (a)
  "Return the greatest integer that is at most the real term or rational A.  Signals Z3-ERROR."
  (common-sort 'real-to-integer (list a) :real)
  (cond ((rationalp (constant-of a)) (values (floor (constant-of a))))
        (t (let ((address (live-pointer a (term-context a))))
             (making-term (pointer (term-context a) nil (integer-sort (term-context a)))
               (z3-mk-real2int pointer address))))))

(defun integral (a)
  "Return the proposition that the real term or rational A is an integer.  Signals Z3-ERROR."
  (common-sort 'integral (list a) :real)
  (cond ((rationalp (constant-of a)) (integerp (constant-of a)))
        (t (let ((address (live-pointer a (term-context a))))
             (making-term (pointer (term-context a))
               (z3-mk-is-int pointer address))))))
