;;;; The rules that give guarantees: :zero-failure, :prediction and :sound, and :paper-sd.

(in-package #:discrepancy-finder.tests)

(def-suite guaranteed-rules :in all)
(in-suite guaranteed-rules)

(defun linear-samples (count &key (slope 0.5d0) (noise 0d0) (blind-p t))
  "Return COUNT samples with two initial parameters in [0, 1[ x [1, 2[ and one final one, linear in
the first but for a noise that alternates."
  (loop for index below count
        for x = (nth-value 1 (floor (* index 0.6180339887498949d0)))
        for y = (1+ (nth-value 1 (floor (* index 0.7548776662466927d0))))
        collect (statistics:make-parameter-sample
                 (double-vector (list x y))
                 (double-vector (list (+ 0.1d0 (* slope x) (if (evenp index) noise (- noise)))))
                 :blind-p blind-p)))

(defun linear-region (min max)
  (make-box '((0 1) (1 2)) (list (list min max))))

(defun rule-status (rule samples region &rest arguments)
  (statistics:verdict-status
   (statistics:confidence-verdict (apply #'statistics:make-confidence-rule rule arguments)
                                  samples region)))

(test numbers-of-samples-without-failure
  (loop for (confidence delta count) in '((0.95d0 0.2d0 14) (0.95d0 0.1d0 29) (0.95d0 0.05d0 59)
                                          (0.95d0 0.02d0 149) (0.95d0 0.01d0 299)
                                          (0.99d0 0.2d0 21) (0.99d0 0.1d0 44) (0.99d0 0.05d0 90)
                                          (0.99d0 0.02d0 228) (0.99d0 0.01d0 459)
                                          (0.75d0 0.5d0 2))
        do (is (= count (statistics:zero-failure-count confidence delta)))
           (is (<= (statistics:zero-failure-bound count confidence) (+ delta 1d-12)))
           (is (> (statistics:zero-failure-bound (1- count) confidence) delta)))
  (is (= 1 (statistics:zero-failure-bound 0 0.95d0)))
  (is (nearly (statistics:beta-quantile 0.95d0 1 59) (statistics:zero-failure-bound 59 0.95d0)
              1d-12)
      "Clopper and Pearson's bound"))

(test zero-failure-counts-blind-samples
  (let ((region (linear-region 0 1)))
    (is (eq :continue (rule-status :zero-failure (linear-samples 58) region)))
    (is (eq :confident (rule-status :zero-failure (linear-samples 59) region)))
    (is (eq :continue (rule-status :zero-failure (linear-samples 59) region :confidence 0.99d0)))
    (is (eq :confident (rule-status :zero-failure (linear-samples 14) region :delta 0.2d0)))
    (is (eq :continue (rule-status :zero-failure
                                   (append (linear-samples 58)
                                           (linear-samples 30 :blind-p nil))
                                   region)))
    (is (string= (format nil "59 blind simulations without a discrepancy: at 95 % confidence at ~
                              most 5 % of the initial region is discrepant")
                 (statistics:verdict-reason
                  (statistics:confidence-verdict
                   (statistics:make-confidence-rule :zero-failure) (linear-samples 59) region))))
    (signals-with (statistics:invalid-delta "1.5")
      (statistics:make-confidence-rule :zero-failure :delta 1.5))))

(test prediction-band-golden-values
  "Ends of the band at the worst corner, computed with mpmath, 40 digits; the last two are of
observations that were compressed."
  (loop for (count low high) in '((5 -0.045946127715003711d0 0.72152005469971741d0)
                                  (12 0.028850878278187145d0 0.66418347563676929d0)
                                  (100 0.049446896472623389d0 0.65055398108416088d0)
                                  (200 0.048872548394789258d0 0.65111205333701689d0))
        for verdict = (statistics:confidence-verdict
                       (statistics:make-confidence-rule :prediction)
                       (linear-samples count :noise 0.01d0) (linear-region 0 1))
        do (is (near-interval-p (first (statistics:verdict-intervals verdict)) low high 1d-9))))

(test prediction-needs-the-band-inside
  (let ((samples (linear-samples 12 :noise 0.01d0)))
    (is (eq :confident (rule-status :prediction samples (linear-region 0.02d0 0.67d0))))
    (is (eq :continue (rule-status :prediction samples (linear-region 0.03d0 0.67d0))))
    (is (eq :continue (rule-status :prediction samples (linear-region 0.02d0 0.66d0))))
    (is (eq :continue (rule-status :prediction (linear-samples 3) (linear-region 0 1)))
        "three samples for three columns leave no freedom")
    (is (eq :confident (rule-status :prediction (linear-samples 4) (linear-region 0 1)))
        "without noise the band has no width")))

(test prediction-with-many-parameters
  "Beyond twelve parameters the band is bounded from outside, not by corners."
  (flet ((verdict (inputs min)
           (let ((samples
                   (loop for index below 60
                         for x = (loop for input from 1 to inputs
                                       collect (nth-value 1 (floor (* (1+ index)
                                                                      (sqrt (+ 0.3d0 input))))))
                         collect (statistics:make-parameter-sample
                                  (double-vector x)
                                  (double-vector (list (+ (reduce #'+ x)
                                                          (if (evenp index) 0.01d0 -0.01d0))))))))
             (statistics:confidence-verdict
              (statistics:make-confidence-rule :prediction) samples
              (make-box (loop repeat inputs collect '(0 1)) (list (list min (+ inputs 1))))))))
    (destructuring-bind (lower . upper) (first (statistics:verdict-intervals (verdict 14 -1)))
      (is (< -1 lower 0))
      (is (< 14 upper 15)))
    ;; The bound holds what the corners give.
    (let* ((regression (statistics:make-regression 3 1)))
      (loop for index below 20
            do (statistics:add-observation
                regression
                (double-vector
                 (loop for input from 1 to 3
                       collect (nth-value 1 (floor (* index (sqrt (+ 0.3d0 input)))))))
                (double-vector (list (sin index)))))
      (let* ((bands (statistics::fit-bands regression))
             (bounds '((0d0 . 1d0) (0d0 . 1d0) (0d0 . 1d0)))
             (exact (first (statistics::corner-intervals bands bounds '(2d0))))
             (bound (first (statistics::bounded-intervals bands bounds '(2d0)))))
        (is (<= (car bound) (car exact)))
        (is (>= (cdr bound) (cdr exact)))))))

(test sound-wants-both
  (let ((inside (linear-region 0 1)) (tight (linear-region 0.08d0 0.62d0)))
    (is (eq :continue (rule-status :sound (linear-samples 59 :noise 0.01d0) inside)))
    (is (eq :continue (rule-status :sound (linear-samples 71 :noise 0.01d0) inside)))
    (is (eq :confident (rule-status :sound (linear-samples 72 :noise 0.01d0) inside)))
    (is (eq :continue (rule-status :sound (linear-samples 200 :noise 0.01d0) tight)))
    (is (eq :confident (rule-status :zero-failure (linear-samples 200 :noise 0.01d0) tight)))))

(test traces-share-alpha
  (let* ((rule (statistics:make-confidence-rule :zero-failure))
         (confidences (loop for number from 1 to 3
                            collect (statistics:confidence-rule-confidence
                                     (statistics:rule-for-trace rule number)))))
    (is (close-to-p confidences
                    (list (- 1 (/ 0.05d0 2)) (- 1 (/ 0.05d0 6)) (- 1 (/ 0.05d0 12))) 1d-12))
    (is (= (third confidences)
           (statistics:confidence-rule-confidence
            (statistics:rule-for-trace (statistics:rule-for-trace rule 2) 3)))
        "the share is of what was asked for")
    (let ((paper (statistics:make-confidence-rule :paper)))
      (is (eq paper (statistics:rule-for-trace paper 7))))))

(test paper-sd-does-not-depend-on-the-unit
  (flet ((intervals (rule scale)
           (let ((samples (loop for sample in (linear-samples 9 :noise 0.01d0)
                                collect (statistics:make-parameter-sample
                                         (map 'vector (lambda (x) (* scale x))
                                              (statistics:parameter-sample-initial sample))
                                         (map 'vector (lambda (x) (* scale x))
                                              (statistics:parameter-sample-final sample))))))
             (destructuring-bind (low . high)
                 (first (statistics:verdict-intervals
                         (statistics:confidence-verdict
                          (statistics:make-confidence-rule rule) samples
                          (make-box (list (list 0 scale) (list scale (* 2 scale)))
                                    (list (list 0 scale))))))
               (list (/ low scale) (/ high scale))))))
    (is (close-to-p (intervals :paper-sd 1d0) (intervals :paper-sd 1000d0) 1d-9))
    (is (not (close-to-p (intervals :paper 1d0) (intervals :paper 1000d0) 1d-1))
        "the paper's rule does")
    (is (eq :continue (rule-status :paper-sd (linear-samples 2) (linear-region 0 2)))
        "as many samples as columns leave no spread")))

(test evidence-does-not-grow
  "A rule says the same of ten thousand samples, one added after the other, as of all at once, and
what is kept of them is a triangle."
  (let* ((region (linear-region 0 1))
         (samples (linear-samples 10000 :noise 0.01d0))
         (evidence (statistics:make-evidence region)))
    (dolist (sample samples)
      (statistics:add-sample evidence sample))
    (is (= 10000 (statistics:evidence-blind evidence)))
    (is (<= (length (statistics::regression-rows (statistics::evidence-regression evidence))) 70))
    (let ((grown (statistics:evidence-verdict (statistics:make-confidence-rule :paper) evidence))
          (direct (statistics:least-squares (samples-design samples) (samples-response samples))))
      (is (close-to-p (first (statistics:verdict-coefficients grown))
                      (statistics:fit-coefficients direct) 1d-10))
      (is (nearly (first (statistics:verdict-sigma grown))
                  (statistics:fit-residual-sum direct) 1d-9)))))

(defun samples-design (samples)
  (let ((design (make-array (list (length samples) 2) :element-type 'double-float)))
    (loop for sample in samples
          for row from 0
          do (dotimes (column 2 design)
               (setf (aref design row column)
                     (aref (statistics:parameter-sample-initial sample) column))))
    design))

(defun samples-response (samples)
  (map '(simple-array double-float (*))
       (lambda (sample) (aref (statistics:parameter-sample-final sample) 0))
       samples))
