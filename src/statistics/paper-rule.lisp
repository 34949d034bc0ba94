;;;; The confidence rule :PAPER.
;;;;
;;;; As printed in the paper, formula by formula.  For each continuous final parameter y the samples
;;;; are the rows of y = Xb + e, without an intercept, and
;;;;
;;;;   b        = (X'X)^-1 X'y
;;;;   sigma    = e'e = (y - Xb)'(y - Xb)
;;;;   interval = [sum x_min,i b_i - Z(C^(1/n)) sigma / sqrt(s),
;;;;               sum x_max,i b_i + Z(C^(1/n)) sigma / sqrt(s)]
;;;;
;;;; with C the confidence, n the number of final parameters, s the number of samples, Z the
;;;; two-sided normal quantile, and x_min,i the smallest value of the initial parameter i over the
;;;; region if b_i > 0, else the largest; x_max,i the other one.  The rule is confident if each
;;;; interval lies in the bounds of its final parameter.
;;;;
;;;; Note that sigma is the residual sum of squares itself, so that the verdict depends on the unit
;;;; (m, rad), and that it is 0 when there are as many samples as columns.
;;;;
;;;; What the paper leaves open is settled so: constant columns are merged (see LEAST-SQUARES); too
;;;; few samples, or columns that depend on each other, mean "not yet".  Without initial parameters
;;;; all samples are one and the same, and the observed values stand for the prediction.  Without
;;;; final parameters there is no interval to check: the rule is confident as soon as it has the
;;;; samples that a regression would need.

(in-package #:discrepancy-finder.statistics)

(defclass paper-rule (confidence-rule)
  ()
  (:documentation "The rule of the paper: linear regression without an intercept, an interval for
each final parameter."))

(register-confidence-rule :paper 'paper-rule)

(defun paper-interval (coefficients bounds half-width)
  "Return the interval (LOWER . UPPER) that the paper predicts for a final parameter whose
regression has the vector COEFFICIENTS, over the box BOUNDS, a vector of conses (MIN . MAX), one
for each coefficient, with HALF-WIDTH = Z sigma / sqrt(s) added on both sides."
  (loop for b across coefficients
        for (min . max) across bounds
        sum (* b (if (plusp b) min max)) into lower of-type double-float
        sum (* b (if (plusp b) max min)) into upper of-type double-float
        finally (return (cons (- lower half-width) (+ upper half-width)))))

(defun inside-p (interval bounds)
  "True if the INTERVAL lies in the closed BOUNDS, but for rounding.  Samples do not include the
upper bound of what they are drawn from; so the interval of a body that is not moved ends there, and
is inside."
  (destructuring-bind (min . max) bounds
    (let ((rounding (* 1d-12 (max 1d0 (abs min) (abs max)))))
      (and (<= (- min rounding) (car interval))
           (<= (cdr interval) (+ max rounding))))))

(defun paper-z (confidence count)
  "Return Z(C^(1/n)) for the CONFIDENCE C and COUNT = n final parameters."
  ;; The root of a confidence just below 1 may round to 1.
  (two-sided-z (min (expt confidence (/ 1d0 count))
                    (- 1 double-float-negative-epsilon))))

(defun not-yet (count control &rest arguments)
  (make-verdict :continue (format nil "not yet: ~?" control arguments) :count count))

(defun judge-intervals (intervals all-bounds count &rest details)
  "Return the verdict after COUNT samples on the INTERVALS that are predicted for the final
parameters with ALL-BOUNDS; DETAILS are the other arguments of MAKE-VERDICT."
  (loop for interval in intervals
        for bounds across all-bounds
        for number from 1
        unless (inside-p interval bounds)
          do (return (apply #'make-verdict :continue
                            (format nil "final parameter ~d is predicted in [~,4f, ~,4f], which is ~
                                         not inside [~,4f, ~,4f]"
                                    number (car interval) (cdr interval) (car bounds) (cdr bounds))
                            :count count :intervals intervals details))
        finally (return (apply #'make-verdict :confident
                               (format nil "after ~d sample~:p every final parameter is predicted ~
                                            inside its bounds" count)
                               :count count :intervals intervals details))))

(defgeneric rule-spread (rule fit count)
  (:documentation "Return what RULE takes for sigma of FIT after COUNT samples, or NIL if these are
too few to tell.")
  (:method ((rule paper-rule) fit count)
    (declare (ignore count))
    (fit-residual-sum fit)))

(defun judge-fits (rule fits region count)
  "Return the verdict of RULE after COUNT samples, given a FIT with coefficients for each final
parameter."
  (let ((z (paper-z (confidence-rule-confidence rule) (length fits)))
        (spreads (loop for fit in fits collect (rule-spread rule fit count))))
    (if (every #'identity spreads)
        (judge-intervals (loop for fit in fits
                               for spread in spreads
                               collect (paper-interval (fit-coefficients fit)
                                                       (parameter-region-initial-bounds region)
                                                       (* z (/ spread (sqrt (float count 1d0))))))
                         (parameter-region-final-bounds region) count
                         :coefficients (mapcar #'fit-coefficients fits)
                         :sigma spreads :z z :freedom (- count (fit-columns (first fits))))
        (not-yet count "~d samples for ~d columns leave no spread" count
                 (fit-columns (first fits))))))

(defmethod evidence-verdict ((rule paper-rule) (evidence region-evidence))
  (let* ((regression (evidence-regression evidence))
         (region (evidence-region evidence))
         (outputs (regression-outputs regression))
         (count (evidence-blind evidence))
         (columns (linear-columns regression)))
    (cond ((< count (max 1 columns))
           (not-yet count "~d sample~:p for ~d column~:p" count columns))
          ((zerop outputs)
           (make-verdict :confident
                         (format nil "after ~d sample~:p there is no final parameter to predict"
                                 count)
                         :count count))
          ((zerop columns)
           (judge-intervals (observed-intervals evidence)
                            (parameter-region-final-bounds region) count))
          (t
           (let ((fits (loop for output below outputs collect (linear-fit regression output))))
             (if (every #'fit-coefficients fits)
                 (judge-fits rule fits region count)
                 (not-yet count "the ~d columns of ~d samples have rank ~d"
                          columns count (fit-rank (first fits)))))))))

;;; The paper's rule with a standard deviation

(defclass paper-sd-rule (paper-rule)
  ()
  (:documentation "The paper's rule, but with sigma the standard deviation of the residuals,
sqrt(RSS / (s - n)) for s samples and n columns, so that the verdict does not depend on the unit; it
needs a sample more than there are columns."))

(register-confidence-rule :paper-sd 'paper-sd-rule)

(defmethod rule-spread ((rule paper-sd-rule) fit count)
  (let ((freedom (- count (fit-columns fit))))
    (and (plusp freedom) (sqrt (/ (fit-residual-sum fit) freedom)))))
