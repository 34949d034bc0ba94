;;;; The confidence rules :PREDICTION and :SOUND.
;;;;
;;;; :PREDICTION: ordinary least squares with an intercept and a Student-t band for the next run.
;;;; With x = (1, initial parameters), rank r, s samples, freedom n = s - r and s_e^2 = RSS/n
;;;;
;;;;   y(x) +- t(1 - a/2, n) s_e sqrt(1 + x'(X'X)^-1 x),    a = 1 - (1 - alpha_k)^(1/m)
;;;;
;;;; for each of m final parameters (Sidak).  The upper end is convex and the lower one concave in
;;;; x, so that their extremes are at the corners of the box of initial parameters.  Look k spends
;;;; alpha_k = alpha/(k (k + 1)), which sums to alpha.  It rests on the assumption that final
;;;; parameters are linear in the initial ones but for normal noise.
;;;;
;;;; :SOUND asks :ZERO-FAILURE and :PREDICTION, each with alpha/2, and wants both: what the count
;;;; guarantees needs no assumption, what the regression adds does.

(in-package #:discrepancy-finder.statistics)

(defconstant +most-corners+ 12
  "With more varying initial parameters, bounds on the band take the place of its 2^n corners.")

(defclass prediction-rule (guaranteed-rule)
  ()
  (:documentation "The rule of the Student-t prediction band."))

(register-confidence-rule :prediction 'prediction-rule)

(defmethod rule-for-trace ((rule prediction-rule) number)
  (make-instance (class-of rule) :confidence (alpha-share rule number) :asked (rule-asked rule)))

(defun look-alpha (alpha look outputs)
  "Return the share of ALPHA for one of a number of OUTPUTS in a LOOK, from 1."
  (- (expm1 (/ (log1p (- (/ alpha (* look (1+ look))))) outputs))))

(defun dot (a b)
  (declare (type (simple-array double-float (*)) a b) (optimize speed (safety 1)))
  (loop for x across a for y across b sum (* x y) of-type double-float))

(defun corner-intervals (bands bounds factors)
  "Return the intervals of BANDS over the corners of BOUNDS, a list of (MIN . MAX) of the varying
inputs; FACTORS are t s_e of each band."
  (let* ((n (length bounds))
         (point (make-array (1+ n) :element-type 'double-float :initial-element 1d0))
         (intervals (loop repeat (length bands)
                          collect (cons most-positive-double-float most-negative-double-float))))
    (dotimes (corner (expt 2 n) intervals)
      (loop for (min . max) in bounds
            for bit from 0
            do (setf (aref point bit) (if (logbitp bit corner) max min)))
      (let ((root (sqrt (+ 1 (band-leverage (first bands) point)))))
        (loop for band in bands
              for factor in factors
              for interval in intervals
              for middle = (dot (band-solution band) point)
              do (setf (car interval) (min (car interval) (- middle (* factor root)))
                       (cdr interval) (max (cdr interval) (+ middle (* factor root)))))))))

(defun leverage-bound (band bounds)
  "Return a number that x'(X'X)^-1 x of BAND nowhere exceeds in BOUNDS: the triangle inequality on
the way from their middle to a corner."
  (flet ((norm (point) (sqrt (band-leverage band point))))
    (let ((middle (map '(simple-array double-float (*)) #'identity
                       (append (loop for (min . max) in bounds collect (/ (+ min max) 2))
                               '(1d0)))))
      (expt (+ (norm middle)
               (loop for (min . max) in bounds
                     for index from 0
                     sum (let ((axis (make-array (length middle) :element-type 'double-float
                                                                 :initial-element 0d0)))
                           (setf (aref axis index) (/ (- max min) 2))
                           (norm axis))))
            2))))

(defun bounded-intervals (bands bounds factors)
  "Return intervals of BANDS that hold those of CORNER-INTERVALS, without visiting the corners."
  (let ((root (sqrt (+ 1 (leverage-bound (first bands) bounds)))))
    (loop for band in bands
          for factor in factors
          for solution = (band-solution band)
          for intercept = (aref solution (length bounds))
          collect (destructuring-bind (low . high)
                      (paper-interval (subseq solution 0 (length bounds))
                                      (coerce bounds 'vector) (* factor root))
                    (cons (+ intercept low) (+ intercept high))))))

(defun fixed-inputs (region regression)
  "Return how many initial parameters with a range of their own have not varied in REGRESSION."
  (loop for (min . max) across (parameter-region-initial-bounds region)
        for index from 0
        count (and (< min max) (not (member index (regression-varying regression))))))

(defmethod evidence-verdict ((rule prediction-rule) (evidence region-evidence))
  (let* ((regression (evidence-regression evidence))
         (region (evidence-region evidence))
         (outputs (regression-outputs regression))
         (count (evidence-blind evidence))
         (columns (1+ (count-if (lambda (bounds) (< (car bounds) (cdr bounds)))
                                (parameter-region-initial-bounds region))))
         (look (- count columns)))
    (cond ((< look 1)
           (not-yet count "~d blind sample~:p for ~d column~:p" count columns))
          ((plusp (fixed-inputs region regression))
           (not-yet count "an initial parameter has not varied"))
          ((zerop outputs)
           (make-verdict :confident
                         (format nil "after ~d sample~:p there is no final parameter to predict"
                                 count)
                         :count count))
          (t
           (let ((bands (fit-bands regression)))
             (if bands
                 (judge-bands rule bands region count look)
                 (not-yet count "the columns of ~d samples depend on each other" count)))))))

(defun judge-bands (rule bands region count look)
  "Return the verdict of RULE on BANDS after COUNT samples, at LOOK."
  (let* ((confidence (- 1 (look-alpha (rule-alpha rule) look (length bands))))
         (bounds (remove-if-not (lambda (bounds) (< (car bounds) (cdr bounds)))
                                (coerce (parameter-region-initial-bounds region) 'list)))
         (freedom (band-freedom (first bands)))
         (t-value (two-sided-t (min confidence (- 1 double-float-negative-epsilon)) freedom))
         (spreads (loop for band in bands collect (sqrt (/ (band-residual-sum band) freedom))))
         (factors (loop for spread in spreads collect (* t-value spread))))
    (judge-intervals (if (<= (length bounds) +most-corners+)
                         (corner-intervals bands bounds factors)
                         (bounded-intervals bands bounds factors))
                     (parameter-region-final-bounds region) count
                     :coefficients (mapcar #'band-solution bands)
                     :sigma spreads :z t-value :freedom freedom)))

;;; Both

(defclass sound-rule (zero-failure-rule)
  ()
  (:documentation "The rule that wants both :ZERO-FAILURE and :PREDICTION, each with half of
alpha."))

(register-confidence-rule :sound 'sound-rule)

(defun half-rules (rule)
  "Return the :ZERO-FAILURE and the :PREDICTION rule that the :SOUND RULE is made of."
  (let ((confidence (- 1 (/ (rule-alpha rule) 2))))
    (values (make-instance 'zero-failure-rule :confidence confidence :delta (rule-delta rule))
            (make-instance 'prediction-rule :confidence confidence))))

(defmethod evidence-verdict ((rule sound-rule) evidence)
  (multiple-value-bind (counting predicting) (half-rules rule)
    (let ((counted (evidence-verdict counting evidence)))
      (if (eq (verdict-status counted) :continue)
          counted
          (let ((predicted (evidence-verdict predicting evidence)))
            (if (eq (verdict-status predicted) :continue)
                predicted
                (make-verdict :confident
                              (format nil "~a; ~a, if they are linear in the initial ones but for ~
                                           normal noise"
                                      (verdict-reason counted) (verdict-reason predicted))
                              :count (verdict-count counted)
                              :intervals (verdict-intervals predicted)
                              :coefficients (verdict-coefficients predicted)
                              :sigma (verdict-sigma predicted)
                              :z (verdict-z predicted)
                              :freedom (verdict-freedom predicted)
                              :parts (verdict-parts predicted))))))))
