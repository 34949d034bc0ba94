;;;; Lifted, transparent and opaque functions against brute force.

(in-package #:discrepancy-finder.tests)

(def-suite lifted-functions :in all)
(in-suite lifted-functions)

(test functions-of-symbolic-arguments-as-by-brute-force
  (dolist (form *lifted-programs*)
    (let ((problem (expression-problem form)))
      (is (null problem) "~a" problem))))

(test changes-of-what-was-there-do-not-leak
  "The expressions run on the same objects on all paths, and leave them as they were."
  (dolist (change *lifted-changes*)
    (let ((problem (expression-problem `(list ,change *state*))))
      (is (null problem) "~a" problem))))
