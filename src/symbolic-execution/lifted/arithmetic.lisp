;;;; Arithmetic on symbolic numbers.
;;;;
;;;; An operation on symbolic numbers makes a term.  On a guarded choice of numbers it is made for
;;;; each of them, on anything else that is symbolic the value is decided.  Symbolic numbers are
;;;; rational: where a float is met the value is decided, but for comparisons, which are exact.

(in-package #:discrepancy-finder.symbolic-execution)

(defparameter *choice-limit* 64
  "A guarded choice that an operation makes has at most so many objects.")

(defun symbolic-numeric-p (value)
  "Return true if VALUE is symbolic and a number in any case."
  (typecase value
    (symbolic-number t)
    (symbolic-element (loop for (object) in (symbolic-element-choices value)
                            always (numberp object)))
    (t nil)))

(defun operand (value description)
  "Return VALUE with what is known of it; it is settled unless it is a number in any case."
  (let ((value (current value)))
    (if (and (symbolic-value-p value) (not (symbolic-numeric-p value)))
        (settled value description)
        value)))

(defun apply-to-choices (function values description)
  "Return the value of FUNCTION for VALUES, at least one of which is symbolic, none a symbolic
number: a guarded choice of what it is for each of theirs."
  (let* ((choices (mapcar #'choices-of values)))
    (if (> (reduce #'* (mapcar #'length choices)) *choice-limit*)
        (apply function (settled-each values description))
        (labels ((combine (choices arguments propositions)
                   (if choices
                       (loop for (object . proposition) in (first choices)
                             append (combine (rest choices) (cons object arguments)
                                             (cons proposition propositions)))
                       (list (cons (apply function (reverse arguments))
                                   (z3:conjunction (reverse propositions)))))))
          (symbolic-element (combine choices '() '()))))))

(defun arithmetic (function combine one other description)
  "Return the value of the arithmetic FUNCTION for ONE and OTHER, of which one is symbolic.  COMBINE
returns it for two numbers that are symbolic or rational."
  (let ((one (operand one description)) (other (operand other description)))
    (flet ((number-p (value) (or (symbolic-number-p value) (rationalp value))))
      (cond ((not (or (symbolic-value-p one) (symbolic-value-p other)))
             (funcall (the function function) one other))
            ((and (number-p one) (number-p other))
             (funcall (the function combine) one other))
            ((not (or (symbolic-number-p one) (symbolic-number-p other)))
             (apply-to-choices function (list one other) description))
            (t (flet ((fitting (value other)
                        (if (or (symbolic-element-p value)
                                (not (or (number-p other) (symbolic-element-p other))))
                            (settled value description)
                            value)))
                 (arithmetic function combine (fitting one other) (fitting other one)
                             description)))))))

(defun number-term (value)
  (if (symbolic-number-p value) (symbolic-number-term value) value))

(defun integer-number-p (value)
  (if (symbolic-number-p value)
      (integer-term-p (symbolic-number-term value))
      (integerp value)))

(defun made-number (term one other interval)
  "Return the number TERM, made of ONE and OTHER, in INTERVAL."
  (symbolic-number term (interval-type (and (integer-number-p one) (integer-number-p other))
                                       interval)))

(defun added (one other)
  (made-number (z3:sum (multiple-value-list (same-sort (number-term one) (number-term other))))
               one other (interval-sum (number-interval one) (number-interval other))))

(defun subtracted (one other)
  (made-number (multiple-value-call #'z3:difference
                 (same-sort (number-term one) (number-term other)))
               one other
               (interval-sum (number-interval one)
                             (interval-negation (number-interval other)))))

(defun multiplied (one other)
  (made-number (z3:product (multiple-value-list
                            (same-sort (number-term one) (number-term other))))
               one other (interval-product (number-interval one) (number-interval other))))

(defun real-term (value)
  "Return the term or rational of VALUE, a symbolic number or a rational, as a real."
  (let ((term (number-term value)))
    (if (and (z3:term-p term) (integer-term-p term))
        (z3:integer-to-real term)
        term)))

(defmacro define-sum (name combine identity description)
  "Define the version of NAME, + or *."
  (let ((binary (intern (format nil "~a/2" combine) *package*)))
    `(progn
       (defun ,binary (one other)
         (arithmetic #',name #',combine one other ,description))
       (define-lifted ,name (&rest numbers)
         (declare (dynamic-extent numbers))
         (if (and (cdr numbers) (null (cddr numbers)))
             (let ((one (first numbers)) (other (second numbers)))
               (cond ((and (typep one 'fixnum) (typep other 'fixnum)) (,name one other))
                     ((or (symbolic-value-p one) (symbolic-value-p other))
                      (,binary one other))
                     (t (,name one other))))
             (if (some #'symbolic-value-p numbers)
                 (let ((result ,identity))
                   (dolist (number numbers (if (rest numbers)
                                               result
                                               (operand result ,description)))
                     (setf result (if (or (symbolic-value-p result) (symbolic-value-p number))
                                      (if (eql result ,identity)
                                          (operand number ,description)
                                          (,binary result number))
                                      (,name result number)))))
                 (apply #',name numbers)))))))

(define-sum + added 0 "an argument of +")
(define-sum * multiplied 1 "an argument of *")

(defun difference-of (one other)
  (arithmetic #'- #'subtracted one other "an argument of -"))

(define-lifted - (one &rest numbers)
  (declare (dynamic-extent numbers))
  (cond ((and numbers (null (rest numbers)))
         (let ((other (first numbers)))
           (cond ((and (typep one 'fixnum) (typep other 'fixnum)) (- one other))
                 ((or (symbolic-value-p one) (symbolic-value-p other))
                  (difference-of one other))
                 (t (- one other)))))
        ((not (or (symbolic-value-p one) (some #'symbolic-value-p numbers)))
         (apply #'- one numbers))
        ((null numbers) (difference-of 0 one))
        (t (dolist (number numbers one)
             (setf one (difference-of one number))))))

(define-lifted 1+ (number)
  (if (symbolic-value-p number) (|ADDED/2| number 1) (1+ number)))

(define-lifted 1- (number)
  (if (symbolic-value-p number) (difference-of number 1) (1- number)))

;;; Exact division by what is not zero

(defun divided (one other)
  (let ((other (if (symbolic-number-p other) (settled other "a divisor") other)))
    (if (or (eql other 0) (not (symbolic-number-p one)))
        (/ (settled one "an argument of /") other)
        (let ((interval (interval-product (number-interval one)
                                          (list (/ other) (/ other)))))
          (symbolic-rational (z3:quotient (real-term one) other) interval)))))

(defun symbolic-rational (term interval)
  (symbolic-number term (interval-type nil interval)))

(define-lifted / (one &rest numbers)
  (cond ((not (or (symbolic-value-p one) (some #'symbolic-value-p numbers)))
         (apply #'/ one numbers))
        ((null numbers) (arithmetic #'/ #'divided 1 one "an argument of /"))
        (t (dolist (number numbers one)
             (setf one (arithmetic #'/ #'divided one number "an argument of /"))))))
