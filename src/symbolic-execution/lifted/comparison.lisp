;;;; Comparisons and questions about numbers that are symbolic.

(in-package #:discrepancy-finder.symbolic-execution)

(defun compared (test combine one other description)
  "Return the proposition that the comparison TEST holds of ONE and OTHER; COMBINE makes it of two
terms."
  (let ((one (operand one description)) (other (operand other description)))
    (labels ((exact-p (value)
               (typecase value
                 ((or symbolic-number rational) t)
                 (float (not (or (sb-ext:float-infinity-p value) (sb-ext:float-nan-p value))))))
             (term (value)
               (if (symbolic-number-p value) (symbolic-number-term value) (rational value)))
             (proposition (one other)
               (cond ((not (or (symbolic-number-p one) (symbolic-number-p other)))
                      (and (funcall (the function test) one other) t))
                     ((and (exact-p one) (exact-p other))
                      (multiple-value-call combine (same-sort (term one) (term other))))
                     (t (and (funcall (the function test) (settled one description)
                                      (settled other description))
                             t)))))
      (z3:disjunction
       (loop for (one . one-proposition) in (number-choices one)
             append (loop for (other . other-proposition) in (number-choices other)
                          collect (z3:conjunction (list one-proposition other-proposition
                                                        (proposition one other)))))))))

(defmacro define-comparison (name combine)
  "Define the version of the comparison NAME; COMBINE makes a proposition of two terms."
  (let ((description (format nil "an argument of ~(~a~)" name)))
    `(define-lifted ,name (number &rest numbers)
       (declare (dynamic-extent numbers))
       (let ((other (car numbers)))
         (cond ((and (typep number 'fixnum) (typep other 'fixnum) (null (cdr numbers)))
                (,name number other))
               ((not (or (symbolic-value-p number) (some #'symbolic-value-p numbers)))
                (apply #',name number numbers))
               ((null numbers) (,name (settled number ,description)))
               (t (symbolic-boolean
                   (z3:conjunction
                    (loop for (one other) on (cons number numbers)
                          for rest on numbers
                          collect (compared #',name ,combine one other ,description))))))))))

(define-comparison < #'z3:less)
(define-comparison > (lambda (one other) (z3:less other one)))
(define-comparison <= #'z3:less-or-equal)
(define-comparison >= (lambda (one other) (z3:less-or-equal other one)))
(define-comparison = #'z3:equals)

(define-lifted /= (number &rest numbers)
  (let ((all (cons number numbers)) (description "an argument of /="))
    (cond ((notany #'symbolic-value-p all) (apply #'/= all))
          ((null numbers) (/= (settled number description)))
          (t (symbolic-boolean
              (z3:conjunction
               (loop for (one . others) on all
                     append (loop for other in others
                                  collect (z3:negation (compared #'= #'z3:equals one other
                                                                 description))))))))))

(defmacro define-sign-test (name comparison &rest order)
  `(define-lifted ,name (number)
     (if (symbolic-value-p number)
         (symbolic-boolean
          (compared #',comparison ,(ecase comparison (= '#'z3:equals) (< '#'z3:less))
                    ,@order ,(format nil "an argument of ~(~a~)" name)))
         (,name number))))

(define-sign-test zerop = number 0)
(define-sign-test plusp < 0 number)
(define-sign-test minusp < number 0)

(defun parity (number remainder test description)
  "Return whether NUMBER, which is symbolic, has REMAINDER by 2; TEST says it of an integer."
  (let ((number (operand number description)))
    (cond ((symbolic-element-p number) (apply-to-choices test (list number) description))
          ((and (symbolic-number-p number) (integer-number-p number))
           (symbolic-boolean (z3:equals (z3:modulo (symbolic-number-term number) 2) remainder)))
          (t (funcall (the function test) (settled number description))))))

(define-lifted evenp (number)
  (if (symbolic-value-p number) (parity number 0 #'evenp "an argument of evenp") (evenp number)))

(define-lifted oddp (number)
  (if (symbolic-value-p number) (parity number 1 #'oddp "an argument of oddp") (oddp number)))

;;; The greatest and the least.  Their value is one of the arguments: it has its type.

(defun chosen-number (condition one other)
  "Return ONE where the proposition CONDITION is true, else OTHER, numbers of which one is
symbolic."
  (cond ((eq condition t) one)
        ((null condition) other)
        ((eq (integer-number-p one) (integer-number-p other))
         (symbolic-number
          (multiple-value-call #'z3:if-then-else condition
            (same-sort (number-term one) (number-term other)))
          (interval-type (integer-number-p one)
                         (interval-hull (number-interval one) (number-interval other)))))
        (t (symbolic-number
            (z3:if-then-else condition (real-term one) (real-term other))
            (interval-type nil (interval-hull (number-interval one)
                                              (number-interval other)))))))

(defmacro define-extremum (name test)
  (let ((description (format nil "an argument of ~(~a~)" name)))
    `(define-lifted ,name (number &rest numbers)
       (if (not (or (symbolic-value-p number) (some #'symbolic-value-p numbers)))
           (apply #',name number numbers)
           (let ((result (operand number ,description)))
             (dolist (number numbers result)
               (setf result
                     (arithmetic #',name
                                 (lambda (one other)
                                   (chosen-number (compared #',test
                                                            ,(if (eq test '<=)
                                                                 '#'z3:less-or-equal
                                                                 '(lambda (one other)
                                                                   (z3:less-or-equal other one)))
                                                            one other ,description)
                                                  one other))
                                 result number ,description))))))))

(define-extremum max >=)
(define-extremum min <=)

(define-lifted abs (number)
  (if (symbolic-value-p number)
      (let ((number (operand number "an argument of abs")))
        (cond ((symbolic-element-p number)
               (apply-to-choices #'abs (list number) "an argument of abs"))
              ((symbolic-number-p number)
               (chosen-number (compared #'<= #'z3:less-or-equal 0 number "an argument of abs")
                              number (subtracted 0 number)))
              (t (abs number))))
      (abs number)))
