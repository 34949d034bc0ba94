(in-package #:discrepancy-finder.tests)

(def-suite quantile :in all)
(in-suite quantile)

(defun relative-error (value expected)
  (/ (abs (- value expected)) (abs expected)))

(test quantile-golden-values
  ;; Computed with mpmath, 40 digits, for exactly these double floats.
  (loop for (p expected) in '((1d-300 -37.0470962993611992d0)
                              (1d-100 -21.2734535609653243d0)
                              (1d-16 -8.22208221613043562d0)
                              (1d-8 -5.61200124417478873d0)
                              (1d-3 -3.09023230616781354d0)
                              (0.02425d0 -1.97296105131188484d0)
                              (0.05d0 -1.64485362695147269d0)
                              (0.06d0 -1.55477359459685356d0)
                              (0.1d0 -1.28155156554460044d0)
                              (0.3d0 -0.524400512708040816d0)
                              (0.50001d0 0.0000250662827488208627d0)
                              (0.7d0 0.524400512708040656d0)
                              (0.85d0 1.03643338949378948d0)
                              (0.9d0 1.28155156554460059d0)
                              (0.975d0 1.95996398454005386d0)
                              (0.99d0 2.32634787404084077d0)
                              (0.999999d0 4.75342430881708777d0))
        do (is (< (relative-error (statistics::normal-quantile p) expected) 1d-14) "at ~s" p))
  (is (zerop (statistics::normal-quantile 0.5d0))))

(test normal-cdf-golden-values
  (loop for (x expected) in '((-30d0 4.90671392714818706d-198)
                              (-10d0 7.61985302416052607d-24)
                              (-5d0 2.86651571879193912d-7)
                              (-2d0 0.0227501319481792072d0)
                              (-1.6d0 0.0547992916995579841d0)
                              (-1.5d0 0.066807201268858066d0)
                              (-1.49d0 0.068112117966725455d0)
                              (-1d0 0.158655253931457051d0)
                              (-0.5d0 0.308537538725986896d0)
                              (-0.001d0 0.499601057786088937d0)
                              (0d0 0.5d0)
                              (0.3d0 0.617911422188952633d0)
                              (1d0 0.841344746068542949d0)
                              (1.5d0 0.933192798731141934d0)
                              (1.96d0 0.975002104851779564d0)
                              (3d0 0.998650101968369905d0)
                              (6d0 0.999999999013412355d0)
                              (8d0 0.999999999999999378d0))
        do (is (< (relative-error (statistics::normal-cdf x) expected) 1d-14) "at ~s" x))
  (is (= 0 (statistics::normal-cdf -1d300)))
  (is (= 1 (statistics::normal-cdf 1d300))))

(test two-sided-z-golden-values
  ;; The paper prints the first one as 2.24.
  (loop for (confidence expected) in `((,(sqrt 0.95d0) 2.23647664455779145d0)
                                       (0.95d0 1.95996398454005386d0)
                                       (0.99d0 2.57582930354890045d0)
                                       (0.999d0 3.29052673149189454d0)
                                       (1d-6 1.25331413731582831d-6)
                                       (0.5d0 0.674489750196081743d0)
                                       (0.7d0 1.03643338949378948d0)
                                       (0.89d0 1.59819313992281762d0)
                                       (0.9d0 1.64485362695147282d0)
                                       (0.9983263461476896d0 3.14275583341351691d0))
        do (is (< (relative-error (statistics::two-sided-z confidence) expected) 1d-14)
               "at ~s" confidence))
  (is (string= "2.24" (format nil "~,2f" (statistics::two-sided-z (sqrt 0.95d0))))))

(test quantile-inverts-the-cdf
  (loop for i from 1 below 1000
        for p = (/ i 1000d0)
        for x = (statistics::normal-quantile p)
        do (unless (< (relative-error (statistics::normal-cdf x) p) 2d-14)
             (fail "at ~s" p))
        finally (pass)))

(test quantile-expansions-meet
  ;; Where one expansion takes over from the other the functions stay monotone.
  (flet ((increasing-p (function places)
           (loop for place in places
                 always (< (funcall function (- place 1d-12))
                           (funcall function place)
                           (funcall function (+ place 1d-12))))))
    (is (increasing-p #'statistics::normal-cdf '(-1.5d0 1.5d0 0d0)))
    (is (increasing-p #'statistics::normal-quantile '(0.05d0 0.5d0 0.95d0)))
    (is (increasing-p #'statistics::two-sided-z '(0.9d0)))))

(test quantile-refuses
  (dolist (p '(0d0 1d0 -0.1d0 1.1d0 1/2 0.5 nil))
    (signals type-error (statistics::normal-quantile p))
    (signals type-error (statistics::two-sided-z p))))
