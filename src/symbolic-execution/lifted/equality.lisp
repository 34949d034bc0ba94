;;;; NOT and the equality predicates, of symbolic arguments.

(in-package #:discrepancy-finder.symbolic-execution)

(defun equal-proposition (one other test)
  "Return the proposition that ONE and OTHER, of which at least one is symbolic, are the same by
TEST: for Lisp objects that are not symbolic the function TEST tells."
  (let ((one (current one)) (other (current other)))
    (cond ((not (or (symbolic-value-p one) (symbolic-value-p other)))
           (and (funcall (the function test) one other) t))
          ((or (symbolic-number-p one) (symbolic-number-p other))
           (if (eq test #'equalp)
               (number-equal-proposition (exactly one) (exactly other))
               (number-equal-proposition one other)))
          (t (z3:disjunction
              (loop for (object . proposition) in (choices-of one)
                    append (loop for (other-object . other-proposition) in (choices-of other)
                                 when (funcall (the function test) object other-object)
                                   collect (z3:conjunction (list proposition
                                                                 other-proposition)))))))))

(defun number-equal-proposition (one other)
  "Return the proposition that ONE and OTHER, of which one is a symbolic number, are the same
number.  Symbolic numbers are rational."
  (flet ((term (value)
           (typecase value
             (symbolic-number (symbolic-number-term value))
             (rational value))))
    (z3:disjunction
     (loop for (one . one-proposition) in (number-choices one)
           append (loop for (other . other-proposition) in (number-choices other)
                        for left = (term one)
                        for right = (term other)
                        when (and left right)
                          collect (z3:conjunction
                                   (list one-proposition other-proposition
                                         (multiple-value-call #'equal-terms
                                           (same-sort left right)))))))))

(defun exactly (value)
  "Return VALUE; a float as the rational number that it is, for EQUALP compares by =."
  (cond ((not (floatp value)) value)
        ((or (sb-ext:float-infinity-p value) (sb-ext:float-nan-p value)) nil)
        (t (rational value))))

(defun number-choices (value)
  (if (symbolic-number-p value) (list (cons value t)) (choices-of value)))

(defun same-sort (left right)
  "Return LEFT and RIGHT, numeric terms or rationals, as of one sort; NIL for an integer term and a
constant that is no integer."
  (flet ((integer-p (number)
           (and (z3:term-p number) (integer-term-p number)))
         (real-p (number)
           (and (z3:term-p number) (not (integer-term-p number)))))
    (flet ((fitting (number other)
             (cond ((and (integer-p number)
                         (or (real-p other) (and (rationalp other) (not (integerp other)))))
                    (z3:integer-to-real number))
                   (t number))))
      (values (fitting left right) (fitting right left)))))

(defun equal-terms (left right)
  (z3:equals left right))

(defmacro define-equality (name)
  "Define the version of NAME, EQ or EQL."
  `(define-lifted ,name (one other)
     (if (or (symbolic-value-p one) (symbolic-value-p other))
         (or (eq one other)
             (symbolic-boolean (equal-proposition one other #'eql)))
         (,name one other))))

(define-equality eq)
(define-equality eql)

(define-lifted (not null) (value)
  (if (symbolic-value-p value)
      (symbolic-boolean (z3:negation (truth-proposition value)))
      (null value)))

;;; EQUAL and EQUALP look inside

(define-lifted equal (one other)
  (if (and (symbolic-run-p) (not (eq one other)))
      (symbolic-boolean (deep-equal-proposition one other #'equal))
      (equal one other)))

(define-lifted equalp (one other)
  (cond ((or (not (symbolic-run-p)) (eq one other)) (equalp one other))
        ((flet ((opaque-p (value)
                  (and (compound-p value) (not (consp value)))))
           (or (opaque-p one) (opaque-p other)))
         (equalp (decided one "an argument of equalp") (decided other "an argument of equalp")))
        (t (symbolic-boolean (deep-equal-proposition one other #'equalp)))))

(defun deep-equal-proposition (one other test)
  "Return the proposition that ONE and OTHER are the same by TEST, EQUAL or EQUALP."
  (let ((propositions '()))
    (loop
      (let ((one-now (current one)) (other-now (current other)))
        (cond ((and (consp one-now) (consp other-now))
               (let ((proposition (deep-equal-proposition (car one-now) (car other-now) test)))
                 (unless proposition
                   (return nil))
                 (push proposition propositions)
                 (setf one (cdr one-now) other (cdr other-now))))
              ((or (symbolic-value-p one-now) (symbolic-value-p other-now))
               (return (z3:conjunction (cons (equal-proposition one-now other-now test)
                                             propositions))))
              ((and (eq test #'equalp) (or (compound-p one-now) (compound-p other-now)))
               (return (z3:conjunction
                        (cons (equalp (decided one-now "an argument of equalp")
                                      (decided other-now "an argument of equalp"))
                              propositions))))
              ((funcall (the function test) one-now other-now)
               (return (z3:conjunction propositions)))
              (t (return nil)))))))
