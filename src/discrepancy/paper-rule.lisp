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

(in-package #:discrepancy-finder.discrepancy)

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

(defun design-matrix (samples columns)
  (let ((design (make-array (list (length samples) columns) :element-type 'double-float)))
    (loop for sample in samples
          for row from 0
          do (dotimes (column columns)
               (setf (aref design row column) (aref (parameter-sample-initial sample) column))))
    design))

(defun final-values (samples index)
  (map '(simple-array double-float (*))
       (lambda (sample) (aref (parameter-sample-final sample) index))
       samples))

(defun observed-interval (values)
  (cons (reduce #'min values) (reduce #'max values)))

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

(defun judge-fits (fits confidence region count)
  "Return the verdict after COUNT samples, given a FIT with coefficients for each final parameter."
  (let* ((z (paper-z confidence (length fits)))
         (intervals (loop for fit in fits
                          collect (paper-interval (fit-coefficients fit)
                                                  (parameter-region-initial-bounds region)
                                                  (* z (/ (fit-residual-sum fit)
                                                          (sqrt (float count 1d0))))))))
    (judge-intervals intervals (parameter-region-final-bounds region) count
                     :coefficients (mapcar #'fit-coefficients fits)
                     :sigma (mapcar #'fit-residual-sum fits)
                     :z z)))

(defmethod confidence-verdict ((rule paper-rule) samples region)
  (let* ((samples (coerce samples 'list))
         (count (length samples))
         (design (design-matrix samples (length (parameter-region-initial-bounds region))))
         (columns (merged-column-count design))
         (responses (loop for index below (length (parameter-region-final-bounds region))
                          collect (final-values samples index))))
    (cond ((< count (max 1 columns))
           (not-yet count "~d sample~:p for ~d column~:p" count columns))
          ((null responses)
           (make-verdict :confident
                         (format nil "after ~d sample~:p there is no final parameter to predict"
                                 count)
                         :count count))
          ((zerop columns)
           (judge-intervals (mapcar #'observed-interval responses)
                            (parameter-region-final-bounds region) count))
          (t
           (let ((fits (loop for response in responses
                             collect (least-squares design response))))
             (if (every #'fit-coefficients fits)
                 (judge-fits fits (confidence-rule-confidence rule) region count)
                 (not-yet count "the ~d columns of ~d samples have rank ~d"
                          columns count (fit-rank (first fits)))))))))
