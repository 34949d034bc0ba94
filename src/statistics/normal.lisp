;;;; The normal distribution.
;;;;
;;;; The standard normal distribution has density phi, cumulative distribution function Phi
;;;; (NORMAL-CDF) and its inverse (NORMAL-QUANTILE).  TWO-SIDED-Z is what confidence rules use.
;;;;
;;;; Two expansions with only positive terms, hence without cancellation, cover the line:
;;;;
;;;;   in the centre   Phi(x) - 1/2 = phi(x) (x + x^3/3 + x^5/(3 5) + ...)
;;;;   in the tail     1 - Phi(x)   = phi(x) / (x + 1/(x + 2/(x + 3/(x + ...))))
;;;;
;;;; (Abramowitz and Stegun 26.2.11 and 26.2.14).  Phi - 1/2 and ln (1 - Phi) are concave for
;;;; positive x, so Newton's method on them, started on the proper side, never steps over the root:
;;;; it has converged when it stops moving.

(in-package #:discrepancy-finder.statistics)

(defconstant +centre+ 1.5d0
  "Where the two expansions meet.")

(defun normal-density (x)
  "Return phi(X)."
  (if (> (abs x) 39)
      0d0
      ;; X is split so that the square of its first part is exact: exp magnifies the error of X^2.
      (let* ((head (/ (fround (* 64 x)) 64))
             (rest (- x head)))
        (* (exp (* -0.5d0 head head))
           (exp (* -0.5d0 rest (+ x head)))
           (/ (sqrt (* 2 pi)))))))

(defun central-series (x)
  "Return (Phi(X) - 1/2) / phi(X); for small X."
  (loop with square = (* x x)
        for divisor of-type double-float from 3d0 by 2d0
        for term = x then (/ (* term square) (- divisor 2))
        for sum = term then (+ sum term)
        until (<= (abs term) (* 1d-17 (abs sum)))
        finally (return sum)))

(defun mills-ratio (x)
  "Return (1 - Phi(X)) / phi(X); for X of at least 1.5."
  ;; At 1.5 the error of 150 levels is 1d-15; further out it is less.
  (loop with fraction = x
        for level from 150d0 downto 1d0
        do (setf fraction (+ x (/ level fraction)))
        finally (return (/ fraction))))

(defun normal-cdf (x)
  "Return the probability that a standard normal variable is at most the double float X.  The
relative error is below 1d-14, also in the lower tail down to the denormal numbers."
  (cond ((< x (- +centre+))
         (* (normal-density x) (mills-ratio (- x))))
        ((<= x +centre+)
         (+ 0.5d0 (* (normal-density x) (central-series x))))
        (t
         (- 1 (* (normal-density x) (mills-ratio x))))))

(defun central-quantile (probability)
  "Return the x with Phi(x) - 1/2 = PROBABILITY, which is at least 0 and at most 0.45."
  (loop for x = 0d0 then next
        for next = (+ x (- (/ probability (normal-density x)) (central-series x)))
        while (> next x)
        finally (return x)))

(defun tail-quantile (probability)
  "Return the x with 1 - Phi(x) = PROBABILITY, which is positive and at most 0.05."
  (let ((logarithm (+ (log probability) (* 0.5d0 (log (* 2 pi))))))
    (loop for x = (sqrt (* -2 (log probability))) then next
          for ratio = (mills-ratio x)
          for next = (+ x (* ratio (- (log ratio) (* 0.5d0 x x) logarithm)))
          while (< next x)
          finally (return x))))

(defun normal-quantile (probability)
  "Return the x such that a standard normal variable is at most x with PROBABILITY, a double float
in ]0, 1[.  The relative error is below 1d-14.  Signal TYPE-ERROR for another PROBABILITY."
  (check-type probability (double-float (0d0) (1d0)) "a double float between 0 and 1")
  (cond ((< probability 0.05d0) (- (tail-quantile probability)))
        ((< probability 0.5d0) (- (central-quantile (- 0.5d0 probability))))
        ((<= probability 0.95d0) (central-quantile (- probability 0.5d0)))
        (t (tail-quantile (- 1 probability)))))

(defun two-sided-z (confidence)
  "Return the z such that a standard normal variable lies in [-z, z] with probability CONFIDENCE, a
double float in ]0, 1[: the quantile of (1 + CONFIDENCE) / 2.  The relative error is below 1d-14.
Signal TYPE-ERROR for another CONFIDENCE."
  (check-type confidence (double-float (0d0) (1d0)) "a double float between 0 and 1")
  (if (<= confidence 0.9d0)
      (central-quantile (/ confidence 2))
      (tail-quantile (/ (- 1 confidence) 2))))
