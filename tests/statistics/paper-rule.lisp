(in-package #:discrepancy-finder.tests)

(def-suite confidence :in all)
(in-suite confidence)

(defun make-samples (rows)
  "Return parameter samples for ROWS, lists (initial parameters -> final parameters)."
  (loop for (initial final) in rows
        collect (statistics::make-parameter-sample (double-vector initial)
                                                    (double-vector final))))

(defun make-box (initial final)
  "Return a parameter region for the lists INITIAL and FINAL of pairs (min max)."
  (flet ((bounds (pairs)
           (map 'vector (lambda (pair)
                          (cons (float (first pair) 1d0) (float (second pair) 1d0)))
                pairs)))
    (statistics::make-parameter-region (bounds initial) (bounds final))))

(defun paper-verdict (rows initial final &rest arguments)
  (statistics::confidence-verdict
   (apply #'statistics::make-confidence-rule :paper arguments)
   (make-samples rows) (make-box initial final)))

(defun near-interval-p (interval lower upper tolerance)
  (close-to-p (list (car interval) (cdr interval)) (list lower upper) tolerance))

(test paper-interval-example-4
  ;; The coefficients are those of the example's vector, Z = 2.24 as printed, sigma 0.3, 4 samples.
  (let ((bounds (vector '(0d0 . 1d0) '(1d0 . 2d0))))
    (is (near-interval-p (statistics::paper-interval #(0.9d0 -0.1d0) bounds
                                                      (/ (* 2.24d0 0.3d0) (sqrt 4d0)))
                         -0.536d0 1.136d0 1d-12))
    (is (near-interval-p (statistics::paper-interval
                          #(0.9d0 -0.1d0) bounds
                          (/ (* (statistics::paper-z 0.95d0 2) 0.3d0) (sqrt 4d0)))
                         -0.536d0 1.136d0 1d-3))))

(test paper-rule-example-3
  (let* ((rows '(((0.5d0 1.3d0) (0.6d0)) ((0.9d0 1.7d0) (0.8d0))))
         (verdict (paper-verdict rows '((0 1) (1 2)) '((0 1)))))
    (is (eq :confident (statistics::verdict-status verdict)))
    (is (= 2 (statistics::verdict-count verdict)))
    (is (close-to-p (first (statistics::verdict-coefficients verdict)) '(0.0625d0 0.4375d0) 1d-15))
    (is (equal '(0d0) (statistics::verdict-sigma verdict)))
    (is (near-interval-p (first (statistics::verdict-intervals verdict)) 0.4375d0 0.9375d0 1d-15))
    (is (string= "after 2 samples every final parameter is predicted inside its bounds"
                 (statistics::verdict-reason verdict)))
    ;; With no residual the confidence has no effect.
    (is (eq :confident (statistics::verdict-status
                        (paper-verdict rows '((0 1) (1 2)) '((0 1)) :confidence 0.99999d0))))))

(test paper-rule-by-hand
  ;; One column x = 1 2 3; the residuals 0.3 0.3 -0.3 are orthogonal to it, hence b = 1.
  (let* ((verdict (paper-verdict '(((1) (1.3d0)) ((2) (2.3d0)) ((3) (2.7d0))) '((0 3)) '((-1 4))
                                 :confidence 0.9d0))
         (half-width (/ (* 1.6448536269514722d0 0.27d0) (sqrt 3d0))))
    (is (close-to-p (first (statistics::verdict-coefficients verdict)) '(1) 1d-15))
    (is (close-to-p (statistics::verdict-sigma verdict) '(0.27d0) 1d-15))
    (is (close-to-p (list (statistics::verdict-z verdict)) '(1.6448536269514722d0) 1d-14))
    (is (near-interval-p (first (statistics::verdict-intervals verdict))
                         (- half-width) (+ 3 half-width) 1d-14))
    (is (eq :confident (statistics::verdict-status verdict)))
    (is (eq :continue (statistics::verdict-status
                       (paper-verdict '(((1) (1.3d0)) ((2) (2.3d0)) ((3) (2.7d0))) '((0 3))
                                      '((-0.2d0 4)) :confidence 0.9d0))))))

(test paper-rule-divides-the-confidence-by-roots
  (let ((verdict (paper-verdict '(((1) (1 2)) ((2) (2 4)) ((3) (3 6.5d0))) '((0 3))
                                '((-9 9) (-9 9)))))
    (is (close-to-p (list (statistics::verdict-z verdict)) '(2.236476644557791d0) 1d-14))
    (is (= 2 (length (statistics::verdict-intervals verdict))
           (length (statistics::verdict-coefficients verdict))
           (length (statistics::verdict-sigma verdict))))))

(test paper-rule-bounds-are-closed
  (flet ((status (min max)
           (statistics::verdict-status
            (paper-verdict '(((1) (1))) '((0 2)) (list (list min max))))))
    (is (eq :confident (status 0 2.1d0)))
    (is (eq :confident (status 0 2)))
    (is (eq :continue (status 0 1.999d0)))
    (is (eq :continue (status 0.1d0 3)))))

(test paper-rule-names-the-final-parameter
  (is (string= (format nil "final parameter 2 is predicted in [1.0000, 4.0000], which is not ~
                            inside [-1.0000, 3.0000]")
               (statistics::verdict-reason
                (paper-verdict '(((1) (1 2)) ((2) (2 4))) '((0.5d0 2)) '((-1 3) (-1 3)))))))

(test paper-rule-not-yet
  (flet ((check (reason rows initial)
           (let ((verdict (paper-verdict rows initial '((0 9)))))
             (is (eq :continue (statistics::verdict-status verdict)))
             (is (string= reason (statistics::verdict-reason verdict)))
             (is (null (statistics::verdict-intervals verdict)))
             (is (= (length rows) (statistics::verdict-count verdict))))))
    (check "not yet: 0 samples for 1 column" '() '((0 1)))
    (check "not yet: 0 samples for 0 columns" '() '())
    (check "not yet: 1 sample for 2 columns" '(((0.5d0 1.3d0) (0.6d0))) '((0 1) (1 2)))
    (check "not yet: 2 samples for 3 columns"
           '(((1 2 3) (1)) ((2 3 1) (2))) '((0 9) (0 9) (0 9)))
    (check "not yet: the 2 columns of 3 samples have rank 1"
           '(((1 2) (1)) ((2 4) (2)) ((3 6) (4))) '((0 9) (0 9)))))

(test paper-rule-merges-constant-columns
  ;; Two fixed goals, 3 and 4, and y = x + 5: confident after two samples, not after one.
  (let* ((rows '(((3 1 4) (6)) ((3 2 4) (7))))
         (initial '((3 3) (0 2) (4 4)))
         (verdict (paper-verdict rows initial '((0 9)))))
    (is (eq :continue (statistics::verdict-status
                       (paper-verdict (list (first rows)) initial '((0 9))))))
    (is (eq :confident (statistics::verdict-status verdict)))
    (is (near-interval-p (first (statistics::verdict-intervals verdict)) 5 7 1d-13))))

(test paper-rule-without-parameters
  ;; nothing sampled: one sample decides, by its own values
  (let ((verdict (paper-verdict '((() (1 2))) '() '((0 2) (0 3)))))
    (is (eq :confident (statistics::verdict-status verdict)))
    (is (equal '((1d0 . 1d0) (2d0 . 2d0)) (statistics::verdict-intervals verdict))))
  (is (eq :continue (statistics::verdict-status (paper-verdict '((() (1))) '() '((2 3))))))
  ;; nothing to predict: as many samples as a regression would need
  (is (eq :continue (statistics::verdict-status (paper-verdict '(((1 2) ())) '((0 9) (0 9)) '()))))
  (let ((verdict (paper-verdict '(((1 2) ()) ((2 1) ())) '((0 9) (0 9)) '())))
    (is (eq :confident (statistics::verdict-status verdict)))
    (is (string= "after 2 samples there is no final parameter to predict"
                 (statistics::verdict-reason verdict)))))

(test paper-rule-takes-vectors-of-samples
  (is (eq :confident
          (statistics::verdict-status
           (statistics::confidence-verdict
            (statistics::make-confidence-rule :paper)
            (coerce (make-samples '(((0.5d0 1.3d0) (0.6d0)) ((0.9d0 1.7d0) (0.8d0)))) 'vector)
            (make-box '((0 1) (1 2)) '((0 1))))))))

(test paper-rule-confidence-next-to-one
  ;; The root rounds to 1, whose quantile is infinite.
  (is (plusp (statistics::paper-z (- 1 double-float-negative-epsilon) 6))))

(test confidence-rules
  (is (= 0.95d0 (statistics::confidence-rule-confidence
                 (statistics::make-confidence-rule :paper))))
  (is (eql 0.5d0 (statistics::confidence-rule-confidence
                  (statistics::make-confidence-rule :paper :confidence 1/2))))
  (dolist (value '(0 1 0d0 1d0 -0.1d0 1.5d0 95 nil "0.95"))
    (signals statistics::invalid-confidence
      (statistics::make-confidence-rule :paper :confidence value)))
  (is (string= "A confidence lies between 0 and 1, both excluded, which 95 does not."
               (handler-case (statistics::make-confidence-rule :paper :confidence 95)
                 (statistics::invalid-confidence (condition) (princ-to-string condition)))))
  (let ((condition (handler-case (statistics::make-confidence-rule :papre)
                     (statistics::unknown-confidence-rule (condition) condition))))
    (is (eq :papre (statistics::unknown-confidence-rule-name condition)))
    (is (member :paper (statistics::unknown-confidence-rule-known condition)))
    (is (eql 0 (search "There is no confidence rule papre; there is "
                       (princ-to-string condition))))))
