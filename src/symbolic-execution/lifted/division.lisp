;;;; Division with a remainder, of symbolic numbers by numbers.
;;;;
;;;; A symbolic divisor is decided.  With a positive divisor d the floor of n / d is what Z3 calls
;;;; the quotient; the other divisions are made of it, and division by -d is that of -n by d.

(in-package #:discrepancy-finder.symbolic-execution)

(defun floor-term (term divisor)
  "Return the term of the floor of TERM, integer or real, divided by DIVISOR, a positive rational;
an integer divisor for an integer term."
  (if (integer-term-p term)
      (z3:quotient term divisor)
      (z3:real-to-integer (z3:quotient term divisor))))

(defun negative (term)
  (z3:product (list -1 term)))

(defun round-term (term divisor)
  "Return the term of TERM divided by DIVISOR, a positive number, rounded to the nearest integer,
of two to the even one."
  (let* ((floor (floor-term term divisor))
         (twice (z3:product (list 2 (remainder-term term floor divisor))))
         (up (z3:sum (list floor 1))))
    (z3:if-then-else (z3:less twice divisor)
                     floor
                     (z3:if-then-else (z3:less divisor twice)
                                      up
                                      (z3:if-then-else (z3:equals (z3:modulo floor 2) 0)
                                                       floor up)))))

(defun remainder-term (term quotient divisor)
  "Return TERM - QUOTIENT * DIVISOR."
  (z3:difference term
                 (z3:product (list divisor (if (or (integer-term-p term) (integerp quotient))
                                               quotient
                                               (z3:integer-to-real quotient))))))

(defun division-term (kind term divisor)
  "Return the term of TERM divided by DIVISOR, a positive number, in the way of the function KIND."
  (ecase kind
    (floor (floor-term term divisor))
    (ceiling (negative (floor-term (negative term) divisor)))
    (truncate (z3:if-then-else (z3:less term 0)
                               (negative (floor-term (negative term) divisor))
                               (floor-term term divisor)))
    (round (round-term term divisor))))

(defun divide (kind number divisor)
  "Return quotient and remainder of NUMBER and DIVISOR, one of them symbolic, by the function
KIND."
  (let* ((description (format nil "an argument of ~(~a~)" kind))
         (number (operand number description))
         (divisor (settled divisor description)))
    (if (and (symbolic-number-p number) (rationalp divisor) (/= divisor 0))
        (divide-term kind
                     (if (minusp divisor)
                         (subtracted 0 number)
                         number)
                     number divisor)
        (funcall kind (settled number description) divisor))))

(defun divide-term (kind positive number divisor)
  "Do as DIVIDE does; POSITIVE is NUMBER with its sign reversed if DIVISOR is negative."
  (let* ((integer-p (and (integer-number-p number) (integerp divisor)))
         (term (if integer-p (number-term positive) (real-term positive)))
         (quotient (division-term kind term (abs divisor)))
         (remainder (remainder-term (if integer-p (number-term number) (real-term number))
                                    quotient divisor)))
    (values (symbolic-number quotient
                             (interval-type t (interval-quotient (number-interval positive)
                                                                 (abs divisor))))
            (symbolic-number remainder
                             (interval-type integer-p (list (- (abs divisor)) (abs divisor)))))))

(defmacro define-division (name)
  `(define-lifted ,name (number &optional (divisor 1))
     (declare)
     (cond ((and (typep number 'fixnum) (typep divisor 'fixnum)) (,name number divisor))
           ((or (symbolic-value-p number) (symbolic-value-p divisor))
            (divide ',name number divisor))
           (t (,name number divisor)))))

(define-division floor)
(define-division ceiling)
(define-division truncate)
(define-division round)

(define-lifted mod (number divisor)
  (if (or (symbolic-value-p number) (symbolic-value-p divisor))
      (nth-value 1 (divide 'floor number divisor))
      (mod number divisor)))

(define-lifted rem (number divisor)
  (if (or (symbolic-value-p number) (symbolic-value-p divisor))
      (nth-value 1 (divide 'truncate number divisor))
      (rem number divisor)))
