;;;; The beta distribution, to which Student's t and Fisher's F reduce.
;;;;
;;;; The regularized incomplete beta function I_x(a,b), BETA-CDF, is the probability that a beta
;;;; variable with the parameters a and b is at most x.  It is computed as
;;;;
;;;;   I_x(a,b) = P / (a F),    P = x^a (1-x)^b / B(a,b),    F a continued fraction
;;;;
;;;; (Abramowitz and Stegun 26.5.8) on the side of the mean where the fraction converges fast, and
;;;; as 1 - I_{1-x}(b,a) on the other one.  P is a difference of large logarithms for large a and b,
;;;; so it is written with Stirling's errors and the deviance from the mean, where nothing cancels.
;;;;
;;;; Quantiles are sought in the logit u = ln(x/(1-x)), in which both ends of [0, 1] keep their
;;;; relative precision, by Newton's method within a bracket.

(in-package #:discrepancy-finder.statistics)

(declaim (inline log1p))
(defun log1p (x)
  "Return ln(1 + X), precise for small X."
  (sb-kernel:%log1p x))

(defun expm1 (x)
  "Return e^X - 1, precise for small X."
  (if (< (abs x) 0.5d0)
      (* 2 (sinh (/ x 2)) (exp (/ x 2)))
      (- (exp x) 1)))

(defun stirling-error (z)
  "Return ln Gamma(Z) - ((Z - 1/2) ln Z - Z + ln(2 pi)/2), for positive Z."
  (let ((sum 0d0))
    ;; The series wants a large argument.
    (loop while (< z 16)
          do (incf sum (- (* (+ z 0.5d0) (log1p (/ z))) 1))
             (incf z))
    (let ((square (* z z)))
      (+ sum (/ (- 1/12 (/ (- 1/360 (/ (- 1/1260 (/ (- 1/1680 (/ 1/1188 square))
                                                    square))
                                       square))
                           square))
                z)))))

(defun log-deviance (ratio excess)
  "Return ln RATIO - EXCESS, where EXCESS = RATIO - 1, precise near 1."
  (if (> (abs excess) 0.1d0)
      (- (log ratio) excess)
      (loop for power = (* excess excess) then (* power excess)
            for divisor from 2
            for sign = -1 then (- sign)
            for term = (* sign (/ power divisor))
            sum term into sum of-type double-float
            until (<= (abs term) (* 1d-18 (abs sum)))
            finally (return sum))))

(defun beta-weight (a b x y)
  "Return P = X^A Y^B / B(A,B), where Y = 1 - X."
  (let* ((n (+ a b))
         (excess (- (* x b) (* y a)))
         (deviance (+ (* a (log-deviance (* n (/ x a)) (/ excess a)))
                      (* b (log-deviance (* n (/ y b)) (/ (- excess) b))))))
    (* (sqrt (/ (* a (/ b n)) (* 2 pi)))
       (exp (+ deviance (- (stirling-error n) (stirling-error a) (stirling-error b)))))))

(defun beta-fraction (a b x)
  "Return the continued fraction of I_X(A,B), by Lentz's method; X is below (A + 1)/(A + B + 2)."
  (flet ((nonzero (value)
           (if (< (abs value) 1d-300) 1d-300 value)))
    (let* ((d (/ (nonzero (- 1 (/ (* (+ a b) x) (+ a 1))))))
           (c 1d0)
           (result d))
      (loop for m of-type double-float from 1d0
            for even = (/ (* m (- b m) x) (* (+ a (* 2 m) -1) (+ a (* 2 m))))
            for odd = (- (/ (* (+ a m) (+ a b m) x) (* (+ a (* 2 m)) (+ a (* 2 m) 1))))
            do (dolist (coefficient (list even odd))
                 (setf d (/ (nonzero (+ 1 (* coefficient d))))
                       c (nonzero (+ 1 (/ coefficient c)))
                       result (* result d c)))
            until (or (<= (abs (- (* d c) 1)) 1d-16) (> m 100000))
            finally (return result)))))

(defun incomplete-beta (a b x y)
  "Return I_X(A,B) and 1 - I_X(A,B), where Y = 1 - X, both with small relative errors, and P."
  (cond ((zerop x) (values 0d0 1d0 0d0))
        ((zerop y) (values 1d0 0d0 0d0))
        (t
         (let ((weight (beta-weight a b x y)))
           (if (< x (/ (+ a 1) (+ a b 2)))
               (let ((lower (/ (* weight (beta-fraction a b x)) a)))
                 (values lower (- 1 lower) weight))
               (let ((upper (/ (* weight (beta-fraction b a y)) b)))
                 (values (- 1 upper) upper weight)))))))

(defun beta-logit (a b probability upper-p)
  "Return ln(x/(1-x)) for the x that a beta variable with the parameters A and B stays below, or
above if UPPER-P, with PROBABILITY."
  (let ((low -700d0) (high 700d0) (u (log (/ a b))))
    (loop repeat 200
          do (let ((x (/ (+ 1 (exp (- u))))) (y (/ (+ 1 (exp u)))))
               (multiple-value-bind (below above weight) (incomplete-beta a b x y)
                 (let* ((excess (if upper-p (- probability above) (- below probability)))
                        ;; Newton's step, if the weight is no denormal number.
                        (steep (> weight 1d-290))
                        (next (if steep (- u (/ excess weight)) u)))
                   (if (plusp excess) (setf high u) (setf low u))
                   (when (or (not steep) (not (< low next high)))
                     (setf next (/ (+ low high) 2)))
                   (when (<= (abs (- next u)) (* 1d-15 (max 1 (abs u))))
                     (return next))
                   (setf u next))))
          finally (return u))))

(defun check-probability (probability)
  (check-type probability (double-float (0d0) (1d0)) "a double float between 0 and 1"))

(defun positive-double (value name)
  (if (and (realp value) (plusp value))
      (decimal-double value)
      (error 'type-error :datum value :expected-type '(real (0))
                         :context (format nil "for ~a" name))))

(defun beta-cdf (x a b)
  "Return the probability that a beta variable with the positive parameters A and B is at most X, a
real.  The relative error of the smaller one of it and its complement is below 1d-12 for parameters
up to 1d5.  Signals TYPE-ERROR for parameters that are not positive."
  (let ((a (positive-double a "a")) (b (positive-double b "b")) (x (float x 1d0)))
    (cond ((<= x 0) 0d0)
          ((>= x 1) 1d0)
          (t (values (incomplete-beta a b x (- 1 x)))))))

(defun beta-quantile (probability a b)
  "Return the x in [0, 1] such that a beta variable with the positive parameters A and B is at most
x with PROBABILITY, a double float in ]0, 1[.  The relative error is below 1d-10.  Signals
TYPE-ERROR for other arguments."
  (check-probability probability)
  (let ((u (if (<= probability 0.5d0)
               (beta-logit (positive-double a "a") (positive-double b "b") probability nil)
               (beta-logit (positive-double a "a") (positive-double b "b") (- 1 probability) t))))
    (/ (+ 1 (exp (- u))))))
