;;;; Beta, Student and F distributions against values computed with mpmath, 50 digits.

(in-package #:discrepancy-finder.tests)

(def-suite distributions :in all)
(in-suite distributions)

(defun worst-error (function cases)
  "Return the largest relative error of FUNCTION over CASES, a list of ((argument ...) value)."
  (loop for (arguments expected) in cases
        maximize (relative-error (apply function arguments) expected)))

(test beta-cdf-golden-values
  (is (< (worst-error #'statistics:beta-cdf
                      '(((0.001d0 1.0d0 59.0d0) 0.057321058835667471637d0)
                        ((0.9000000000000000222d0 2.5d0 0.5d0) 0.48958974456442755456d0)
                        ((0.99899999999999999911d0 5000.0d0 0.5d0) 0.0015615791602892832788d0)
                        ((0.9000000000000000222d0 3.0d0 9997.0d0) 1.0d0)
                        ((0.2999999999999999889d0 100.0d0 0.5d0) 3.4637139119166706919d-54)
                        ((0.99899999999999999911d0 0.1d0 0.2d0)
                         0.91395987796148383993d0)
                        ((0.9000000000000000222d0 100.0d0 0.5d0) 4.5452549045170283168d-6)
                        ((0.10000000000000000555d0 100.0d0 0.5d0) 5.9363894010801136134d-102)
                        ((0.9000000000000000222d0 0.5d0 0.5d0) 0.79516723530086657191d0)
                        ((0.10000000000000000555d0 0.1d0 0.2d0)
                         0.54824008590524392905d0)
                        ((0.001d0 0.5d0 0.5d0) 0.020135041633377491182d0)
                        ((0.99899999999999999911d0 300.0d0 700.0d0) 1.0d0)))
         1d-11)))

(test beta-quantile-golden-values
  (is (< (worst-error #'statistics:beta-quantile
                      '(((0.94999999999999995559d0 300.0d0 700.0d0) 0.32405138100853149481d0)
                        ((0.98999999999999999112d0 59.0d0 1.0d0) 0.99982966983234736837d0)
                        ((1d-10 0.1d0 0.2d0)
                         4.3988747541943693098d-99)
                        ((0.001d0 59.0d0 1.0d0) 0.88951349731082336878d0)
                        ((0.5d0 10.0d0 3.0d0) 0.78331358921345444175d0)
                        ((0.99990000000000001101d0 0.1d0 0.2d0)
                         0.99999999999999999788d0)
                        ((0.99990000000000001101d0 3.0d0 9997.0d0) 0.001392125794384688763d0)
                        ((0.001d0 0.1d0 0.2d0)
                         4.3988747541943292646d-29)
                        ((0.001d0 5000.0d0 0.5d0) 0.99891777527665847196d0)
                        ((0.98999999999999999112d0 2.5d0 0.5d0) 0.99996530096802131119d0)
                        ((0.5d0 0.1d0 0.2d0)
                         0.041652495555596219193d0)
                        ((0.94999999999999995559d0 3.0d0 9997.0d0)
                         0.00062950708587439591545d0)))
         1d-11)))

(test student-quantile-golden-values
  (is (< (worst-error #'statistics:student-quantile
                      '(((0.9749999999999999778d0 30.0d0) 2.0422724563012378878d0)
                        ((0.5999999999999999778d0 7.0d0) 0.26316686135202275215d0)
                        ((1.0000000000000000209d-8 1.0d0) -31830988.618379056016d0)
                        ((1.0000000000000000209d-8 100000.0d0) -5.6124571748817132712d0)
                        ((0.94999999999999995559d0 1.0d0) 6.3137515146750373979d0)
                        ((0.5999999999999999778d0 2.0d0) 0.28867513459481281549d0)
                        ((0.2999999999999999889d0 1000.0d0) -0.52456770730922693249d0)
                        ((0.2999999999999999889d0 1.0d0) -0.72654252800536093919d0)
                        ((0.9749999999999999778d0 3.0d0) 3.1824463052837084359d0)
                        ((0.010000000000000000208d0 1.0d0) -31.820515953773957377d0)
                        ((0.5999999999999999778d0 3.0d0) 0.27667066233268984701d0)
                        ((0.2999999999999999889d0 30.0d0) -0.53001900390650450976d0)))
                         1d-11)))

(test f-quantile-golden-values
  (is (< (worst-error #'statistics:f-quantile
                      '(((0.010000000000000000208d0 2.0d0 1000.0d0) 0.010050436863428997568d0)
                        ((0.99899999999999999911d0 7.0d0 53.0d0) 4.1756421344618630381d0)
                        ((0.99899999999999999911d0 2.0d0 1000.0d0) 6.9556928683397050989d0)
                        ((0.94999999999999995559d0 3.0d0 10.0d0) 3.708264819046843146d0)
                        ((0.5d0 2.0d0 1000.0d0) 0.69362785566726454161d0)
                        ((0.5d0 7.0d0 53.0d0) 0.9181519124359134966d0)
                        ((0.99899999999999999911d0 3.0d0 10.0d0) 12.552745388943725041d0)
                        ((0.94999999999999995559d0 1.0d0 1.0d0) 161.44763879758820773d0)
                        ((0.5d0 3.0d0 10.0d0) 0.84508057659171366713d0)
                        ((0.010000000000000000208d0 1.0d0 1.0d0) 0.00024678070282409452519d0)
                        ((0.94999999999999995559d0 2.0d0 1000.0d0) 3.0047246355778478791d0)
                        ((0.5d0 1.0d0 1.0d0) 1.0d0)))
         1d-11)))

(test distributions-and-quantiles-are-inverses
  (loop for p in '(1d-6 0.02d0 0.5d0 0.77d0 0.999d0)
        do (loop for (a b) in '((0.5d0 0.5d0) (3 59) (1000 2) (20 20000))
                 do (is (nearly p (statistics:beta-cdf (statistics:beta-quantile p a b) a b)
                                1d-11))
                    (is (nearly p (statistics:f-cdf (statistics:f-quantile p a b) a b) 1d-11))
                    (is (nearly p (statistics:student-cdf (statistics:student-quantile p a) a)
                                1d-11)))))

(test small-tails-are-no-matter
  "Newton's step is not taken where the density is next to nothing."
  (is (nearly -5.8003517343429461198d0 (statistics:student-quantile (/ 1.149d-8 2) 521) 1d-10))
  (loop for tail in '(1d-8 3d-9 1d-11 1d-13)
        do (loop for freedom from 1 to 1200 by 47
                 do (is (< (abs (- 1 (/ (statistics:student-cdf
                                         (statistics:student-quantile tail freedom) freedom)
                                        tail)))
                           1d-9)))))

(test distributions-at-their-ends
  (is (= 0 (statistics:beta-cdf 0 2 3)))
  (is (= 1 (statistics:beta-cdf 1 2 3)))
  (is (= 0 (statistics:f-cdf -1 2 3)))
  (is (= 0.5d0 (statistics:student-cdf 0d0 4)))
  (is (= 0 (statistics:student-quantile 0.5d0 4)))
  (is (nearly (statistics:two-sided-z 0.95d0) (statistics:two-sided-t 0.95d0 1000000) 1d-5)
      "t tends to the normal distribution")
  (dolist (wrong '(0d0 1d0 1.5d0 1/2))
    (signals type-error (statistics:beta-quantile wrong 1 1)))
  (signals type-error (statistics:student-quantile 0.9d0 0))
  (signals type-error (statistics:beta-cdf 0.5d0 -1 1)))
