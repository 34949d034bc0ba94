(in-package #:discrepancy-finder.tests)

(def-suite abstraction :in all)
(in-suite abstraction)

(test regions-are-half-open
  (let ((domain (two-regions)))
    (flet ((region (x) (symbolic:region-of-pose domain (geometry:make-pose x 7 7))))
      (is (eq :r1 (region 0)))
      (is (eq :r1 (region 0.999999999999d0)))
      (is (eq :r2 (region 1)))
      (is (eq :r2 (region 1.999999999999d0)))
      (is (null (region 2)))
      (is (null (region -1d-12))))))

(test observing-a-world
  (projection:with-projection (projection (discrepancy:domain-scene (two-regions))
                                          :poses (list :box (geometry:make-pose 2.1 0.4 0.46)))
    (let ((state (discrepancy:discrete-state (two-regions) projection)))
      (is (equal '((:robot-in :r1)) (discrepancy:observed-fluents state)))
      (is (= 5 (length state))))))

(defmacro abstraction-problem-of (clause &rest parts)
  "Check the report for the abstraction of Example 1 with CLAUSE added."
  `(signals-with (discrepancy:abstraction-error "abstraction bad" ,@parts)
     (discrepancy::parse-abstraction
      'bad '((:theory "theory.lisp") (:scene "scene.lisp")
             (:region r1 (interval :x 0 1)) (:region r2 (interval :x 1 2))
             ,@(and clause (list clause)))
      :file (root-file "models/two-regions/domain.lisp"))))

(test malformed-abstractions-are-named
  (abstraction-problem-of (:region r3 (interval :x 1 1)) "r3" "no volume")
  (abstraction-problem-of (:region r3 (interval :x 5 4)) "r3" "no volume")
  (signals-with (discrepancy:abstraction-error "abstraction bad" "r1 and r2 overlap")
    (discrepancy::parse-abstraction
     'bad '((:theory "theory.lisp") (:scene "scene.lisp")
            (:region r1 (interval :x 0 1.1)) (:region r2 (interval :x 1 2))
            (:placement (box-in ?region) :body box :coordinates (x)))
     :file (root-file "models/two-regions/domain.lisp")))
  (abstraction-problem-of (:region r3 (interval :w 3 4)) "axis")
  (abstraction-problem-of (:region r3 (sphere 1)) "sphere is no kind of region")
  (abstraction-problem-of (:region) "(:region name")
  (abstraction-problem-of (:placement (robot-at ?region) :body robot :coordinates (x))
                          "(robot-at ?region) is no fluent")
  (abstraction-problem-of (:placement (robot-in ?region) :body robot :coordinates (x y))
                          "coordinate y" "range")
  (abstraction-problem-of (:placement (robot-in ?region) :body robot :coordinates (x (y 1 0)))
                          "no volume")
  (abstraction-problem-of (:placement (robot-in ?region)) ":body and :coordinates")
  (abstraction-problem-of (:attachment (held) :item box) "(held) is no ground fluent")
  (abstraction-problem-of (:joint (open ?drawer)) "joint was found where")
  (abstraction-problem-of (:placement (robot-in ?region) :body) ":placement (fluent")
  (abstraction-problem-of (:attachment) ":attachment (fluent)")
  (abstraction-problem-of (:theory "theory.lisp") "exactly one clause (:theory")
  (signals-with (projection:unknown-body "teapot")
    (discrepancy::parse-abstraction
     'bad '((:theory "theory.lisp") (:scene "scene.lisp") (:region r1 (interval :x 0 1))
            (:region r2 (interval :x 1 2))
            (:placement (box-in ?region) :body teapot :coordinates (x)))
     :file (root-file "models/two-regions/domain.lisp"))))

(test domain-files
  (with-file (file "(print 1)")
    (signals-with (source:source-error "defines no domain") (discrepancy:load-domain file)))
  (with-file (file (format nil "~%(define-abstraction d~% (:theory \"no-theory.lisp\") ~
                                (:scene \"s\"))"))
    (signals-with (source:source-error "no-theory.lisp" "no such file")
      (discrepancy:load-domain file)))
  (with-file (file "(define-abstraction d #.(print 1))")
    (signals-with (source:source-error ":1: " "#.") (discrepancy:load-domain file)))
  (signals-with (symbolic:domain-not-found "nowhere") (discrepancy:ensure-domain :nowhere)))
