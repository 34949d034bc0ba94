;;;; Student's t and Fisher's F, by the beta distribution.
;;;;
;;;; For t with n degrees of freedom  P(|T| > t) = I_x(n/2, 1/2)   with x = n/(n + t^2),
;;;; for F with d1 and d2             P(F <= f)  = I_x(d1/2, d2/2) with x = d1 f/(d1 f + d2)
;;;; (Abramowitz and Stegun 26.7.1 and 26.6.2).

(in-package #:discrepancy-finder.statistics)

(defun two-sided-tail (x degrees)
  "Return P(|T| > |X|) for Student's t with DEGREES of freedom."
  (let ((square (* x x)))
    (if (zerop square)
        1d0
        (values (incomplete-beta (/ degrees 2) 0.5d0
                                 (/ (+ 1 (/ square degrees)))
                                 (/ (+ 1 (/ degrees square))))))))

(defun student-cdf (x degrees)
  "Return the probability that a Student t variable with a positive number of DEGREES of freedom is
at most the double float X.  The relative error is below 1d-12 in the lower tail.  Signals
TYPE-ERROR for degrees that are not positive."
  (let ((half (/ (two-sided-tail x (positive-double degrees "degrees")) 2)))
    (if (plusp x) (- 1 half) half)))

(defun tail-t (tail degrees)
  "Return the t with P(|T| > t) = TAIL."
  (let ((degrees (positive-double degrees "degrees")))
    (* (sqrt degrees) (exp (* -0.5d0 (beta-logit (/ degrees 2) 0.5d0 tail nil))))))

(defun two-sided-t (confidence degrees)
  "Return the t such that a Student variable with a positive number of DEGREES of freedom lies in
[-t, t] with probability CONFIDENCE, a double float in ]0, 1[.  The relative error is below 1d-10.
Signals TYPE-ERROR for other arguments."
  (check-probability confidence)
  (tail-t (- 1 confidence) degrees))

(defun student-quantile (probability degrees)
  "Return the t such that a Student variable with a positive number of DEGREES of freedom is at most
t with PROBABILITY, a double float in ]0, 1[.  The relative error is below 1d-10.  Signals
TYPE-ERROR for other arguments."
  (check-probability probability)
  (cond ((< probability 0.5d0) (- (tail-t (* 2 probability) degrees)))
        ((= probability 0.5d0) 0d0)
        (t (tail-t (* 2 (- 1 probability)) degrees))))

(defun f-cdf (x numerator denominator)
  "Return the probability that an F variable with positive degrees of freedom NUMERATOR and
DENOMINATOR is at most X, a real.  The relative error of the smaller one of it and its complement
is below 1d-12.  Signals TYPE-ERROR for degrees that are not positive."
  (let ((d1 (positive-double numerator "numerator"))
        (d2 (positive-double denominator "denominator"))
        (x (float x 1d0)))
    (if (<= x 0)
        0d0
        (values (incomplete-beta (/ d1 2) (/ d2 2)
                                 (/ (+ 1 (/ d2 (* d1 x)))) (/ (+ 1 (/ (* d1 x) d2))))))))

(defun f-quantile (probability numerator denominator)
  "Return the f such that an F variable with positive degrees of freedom NUMERATOR and DENOMINATOR
is at most f with PROBABILITY, a double float in ]0, 1[.  The relative error is below 1d-10.
Signals TYPE-ERROR for other arguments."
  (check-probability probability)
  (let* ((d1 (positive-double numerator "numerator"))
         (d2 (positive-double denominator "denominator"))
         (upper-p (> probability 0.5d0)))
    (* (/ d2 d1) (exp (beta-logit (/ d1 2) (/ d2 2)
                                  (if upper-p (- 1 probability) probability) upper-p)))))
