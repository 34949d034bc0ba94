;;;; Lifted, transparent and opaque functions against brute force.

(in-package #:discrepancy-finder.tests)

(def-suite lifted-functions :in all)
(in-suite lifted-functions)

(test functions-of-symbolic-arguments-as-by-brute-force
  (dolist (form *lifted-programs*)
    (let ((problem (expression-problem form)))
      (is (null problem) "~a" problem))))
