;;;; Samplers: points of the unit cube.

(in-package #:discrepancy-finder.tests)

(def-suite samplers :in all)
(in-suite samplers)

(defun unit-points (sampler count dimensions &optional (seed 3))
  (loop for index below count
        collect (discrepancy:unit-point sampler seed 77 index dimensions)))

(defun counts-in-cells (numbers cells)
  "Return how many of NUMBERS are in each of CELLS equal parts of [0, 1[."
  (let ((counts (make-array cells :initial-element 0)))
    (dolist (number numbers counts)
      (incf (aref counts (floor (* number cells)))))))

(test points-are-in-the-half-open-cube
  (dolist (sampler discrepancy:*samplers*)
    (is (every (lambda (point) (every (lambda (u) (and (<= 0 u) (< u 1))) point))
               (unit-points sampler 300 5))
        "~a" sampler)
    (is (equal (unit-points sampler 100 3) (unit-points sampler 100 3)) "~a" sampler)
    (is (not (equal (unit-points sampler 100 3) (unit-points sampler 100 3 4))) "~a" sampler)
    (is (equal '(nil) (unit-points sampler 1 0)) "~a" sampler)))

(test independent-points-are-those-of-the-generator
  (is (equal (list (discrepancy:unit-float 3 77 9 0) (discrepancy:unit-float 3 77 9 1))
             (discrepancy:unit-point :independent 3 77 9 2))))

(test strata-hold-one-point-each
  "A round of 64 points has one in each of 8 x 8 cells of two dimensions, and of 64 of one."
  (dolist (start '(0 64 640))
    (flet ((points (dimensions)
             (loop for index from start below (+ start 64)
                   collect (discrepancy:unit-point :stratified 3 77 index dimensions))))
      (is (equalp (make-array 64 :initial-element 1)
                  (counts-in-cells (mapcar #'first (points 1)) 64)))
      (is (= 64 (length (remove-duplicates (loop for (x y) in (points 2)
                                                 collect (list (floor (* 8 x)) (floor (* 8 y))))
                                           :test #'equal)))))))

(test sobol-points-are-even
  "Of the first 256 points every dimension has one in each of 256 parts, and the first two have one
in each of 16 x 16 cells."
  (let ((points (unit-points :sobol 256 40)))
    (dotimes (dimension 40)
      (is (equalp (make-array 256 :initial-element 1)
                  (counts-in-cells (mapcar (lambda (point) (nth dimension point)) points) 256))
          "dimension ~d" dimension))
    (is (= 256 (length (remove-duplicates (loop for (x y) in points
                                                collect (list (floor (* 16 x)) (floor (* 16 y))))
                                          :test #'equal)))))
  ;; Point 7 of the sequence without a shift, from the table by hand: 7 = 111 in binary.
  (is (= (ash #b111 29) (discrepancy::sobol-integer 7 0)))
  (is (= (logxor (ash 1 31) (ash #b11 30) (ash #b101 29)) (discrepancy::sobol-integer 7 1))))

(test no-sample-lies-on-an-upper-bound
  "One plus the largest double below one is two, which is in no region."
  (let ((parameters (discrepancy:initial-parameters (two-regions) (example-trace))))
    (dotimes (index 32)
      (loop for value across (discrepancy:sample-values
                              (discrepancy:draw-sample parameters 1 1 index :sampler :corners))
            for parameter in parameters
            do (is (<= (discrepancy:parameter-min parameter) value))
               (is (< value (discrepancy:parameter-max parameter)))))))

(test corners-come-first
  (let ((points (unit-points :corners 12 3)))
    (is (= 8 (length (remove-duplicates (subseq points 0 8) :test #'equal))))
    (is (every (lambda (point) (every (lambda (u) (or (= u 0) (> u 0.999999999d0))) point))
               (subseq points 0 8)))
    (is (notany (lambda (point) (some #'zerop point)) (subseq points 8)))))

(defun search-with (sampler rule &rest more)
  (apply #'df:find-discrepancies 'discrepancy-finder-user::move-the-box
         :domain :two-regions :sampler sampler :rule rule more))

(test which-samplers-certify
  (let ((stratified (search-with :stratified :zero-failure :delta 0.1d0)))
    (is (eq :certified (df:result-status stratified)))
    (is (= 64 (df:result-simulations stratified)) "a whole round"))
  (is (eq :undecided (df:result-status (search-with :sobol :zero-failure :budget 50))))
  (is (eq :undecided (df:result-status (search-with :corners :paper :budget 20))))
  (dolist (sampler '(:sobol :stratified :corners))
    (is (eq :discrepancy (df:result-status (search-with sampler :sound :parameters '(:reach 0.5)
                                                                       :seed 8)))))
  (signals-with (df:invalid-argument "sampler" "HALTON")
    (search-with :halton :paper)))

(test the-region-that-was-seen-is-told
  "A corner of region r2 is drawn as its bound, x = 2 m, which is in no region; the box settles
within r2."
  (let ((run (run-of (example-trace) 0.5 0 -0.1 2 0.38 -3.14159)))
    (is (member '(:box-in :r2) (discrepancy::observed-fluents (discrepancy:run-initial-state run))
                :test #'equal))
    (is (null (symbolic:region-of-pose (two-regions) (geometry:make-pose 2 0.38 0))))
    (let ((text (with-output-to-string (stream)
                  (discrepancy::describe-sample (two-regions) run stream))))
      (is (search "box.x = 2.0000 m" text))
      (is (search "box is in r2" text)))))
