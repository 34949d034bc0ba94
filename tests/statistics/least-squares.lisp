(in-package #:discrepancy-finder.tests)

(def-suite least-squares :in all)
(in-suite least-squares)

(defun double-matrix (rows)
  (make-array (list (length rows) (length (first rows)))
              :element-type 'double-float
              :initial-contents (loop for row in rows
                                      collect (mapcar (lambda (x) (float x 1d0)) row))))

(defun double-vector (numbers)
  (map '(simple-array double-float (*)) (lambda (x) (float x 1d0)) numbers))

(defun fit-rows (rows response)
  (statistics::least-squares (double-matrix rows) (double-vector response)))

(defun close-to-p (numbers expected tolerance)
  (and (= (length numbers) (length expected))
       (every (lambda (x y) (<= (abs (- x y)) tolerance)) numbers expected)))

(defun solve-exactly (matrix right)
  "Solve the square system MATRIX, a list of rows of rationals, by elimination without rounding."
  (let* ((rows (mapcar (lambda (row b) (coerce (append row (list b)) 'vector)) matrix right))
         (n (length rows)))
    (dotimes (k n (mapcar (lambda (row) (aref row n)) rows))
      (let ((pivot (find-if (lambda (row) (/= 0 (aref row k))) rows :start k)))
        (rotatef (nth k rows) (nth (position pivot rows) rows))
        (setf (nth k rows) (map 'vector (lambda (x) (/ x (aref pivot k))) pivot))
        (loop for row in rows
              for i from 0
              unless (= i k)
                do (setf (nth i rows)
                         (map 'vector (lambda (x y) (- x (* (aref row k) y)))
                              row (nth k rows))))))))

(defun exact-least-squares (rows response)
  "Return the coefficients and the residual sum, by the normal equations without rounding."
  (flet ((dot (u v) (reduce #'+ (mapcar #'* u v))))
    (let* ((columns (apply #'mapcar #'list rows))
           (b (solve-exactly (loop for u in columns
                                   collect (loop for v in columns collect (dot u v)))
                             (loop for u in columns collect (dot u response))))
           (residuals (loop for row in rows for y in response collect (- y (dot row b)))))
      (values b (dot residuals residuals)))))

(test least-squares-example-3-of-the-paper
  (let ((fit (fit-rows '((0.5d0 1.3d0) (0.9d0 1.7d0)) '(0.6d0 0.8d0))))
    (is (close-to-p (statistics::fit-coefficients fit) '(0.0625d0 0.4375d0) 1d-15))
    (is (= 0 (statistics::fit-residual-sum fit)))
    (is (= 2 (statistics::fit-rank fit) (statistics::fit-columns fit)))))

(test least-squares-agrees-with-exact-arithmetic
  (let ((state (sb-ext:seed-random-state 4)))
    (loop repeat 100
          for columns = (1+ (random 4 state))
          for count = (+ columns 1 (random 6 state))
          for rows = (loop repeat count
                           collect (loop repeat columns
                                         collect (rational (- (random 2d0 state) 1))))
          for response = (loop repeat count collect (rational (random 3d0 state)))
          for fit = (fit-rows rows response)
          do (multiple-value-bind (b residual-sum) (exact-least-squares rows response)
               (unless (and (close-to-p (statistics::fit-coefficients fit) b
                                        (* 1d-9 (reduce #'max (mapcar #'abs b))))
                            (< (relative-error (statistics::fit-residual-sum fit) residual-sum)
                               1d-9))
                 (fail "~s ~s" rows response)))
          finally (pass))))

(test least-squares-survives-bad-conditioning
  ;; Nearly equal columns: the condition number is about 10^7, so that X'X in double floats, with
  ;; 10^14, would leave two digits at best.
  (let* ((rows (loop for i from 1 to 8
                     collect (mapcar #'rational
                                     (list (/ i 8d0)
                                           (+ (/ i 8d0) (* 1d-7 (mod (* i i) 5)))
                                           (/ (mod (* 3 i) 7) 7d0)))))
         (response (loop for i from 1 to 8 collect (rational (sin (float i 1d0)))))
         (fit (fit-rows rows response)))
    (multiple-value-bind (b residual-sum) (exact-least-squares rows response)
      (is (> (reduce #'max (mapcar #'abs b)) 1e5))
      (is (close-to-p (statistics::fit-coefficients fit) b
                      (* 1d-8 (reduce #'max (mapcar #'abs b)))))
      (is (< (relative-error (statistics::fit-residual-sum fit) residual-sum) 1d-8)))))

(test least-squares-rank
  (flet ((check (rank columns rows)
           (let ((fit (fit-rows rows (loop for row in rows for i from 1 collect i))))
             (is (= rank (statistics::fit-rank fit)))
             (is (= columns (statistics::fit-columns fit)))
             (is (eq (= rank columns) (and (statistics::fit-coefficients fit) t)))
             (is (eq (= rank columns) (and (statistics::fit-residual-sum fit) t))))))
    ;; the second column is a multiple of the first; the third the sum of the others, rounded
    (check 1 2 '((1 2) (2 4) (3 6)))
    (check 2 3 '((0.1d0 0.7d0 0.8d0) (0.2d0 0.1d0 0.3d0) (0.3d0 0.5d0 0.8d0) (0.7d0 0.1d0 0.8d0)))
    ;; two columns with a constant sum, beside a constant column
    (check 2 3 '((0 4 7) (1 3 7) (2 2 7)))
    ;; fewer rows than columns
    (check 1 2 '((1 2)))
    (check 2 3 '((1 2 3) (2 1 5)))
    ;; a tiny column is no dependent one
    (check 2 2 '((1 1d-9) (2 3d-9) (5 1d-9)))
    (check 0 1 '((0)))
    (check 2 2 '((1 2) (2 1)))))

(test least-squares-constant-columns
  ;; one: an ordinary column
  (let ((fit (fit-rows '((1 2) (2 2) (3 2) (5 2)) '(4 5 6 8))))
    (is (close-to-p (statistics::fit-coefficients fit) '(1 3/2) 1d-13))
    (is (< (statistics::fit-residual-sum fit) 1d-24)))
  ;; a negative one
  (is (close-to-p (statistics::fit-coefficients (fit-rows '((1 -2) (2 -2) (3 -2)) '(4 5 6)))
                  '(1 -3/2) 1d-13))
  ;; two, of 3 and 4: together the intercept 5, shared out in proportion to 3 and 4
  (let ((fit (fit-rows '((3 1 4) (3 2 4) (3 4 4)) '(6 7 9))))
    (is (= 2 (statistics::fit-columns fit) (statistics::fit-rank fit)))
    (is (close-to-p (statistics::fit-coefficients fit) '(3/5 1 4/5) 1d-13)))
  ;; zeros: they explain nothing
  (let ((fit (fit-rows '((0 1) (0 2)) '(2 4))))
    (is (= 1 (statistics::fit-columns fit)))
    (is (close-to-p (statistics::fit-coefficients fit) '(0 2) 1d-13)))
  (let ((fit (fit-rows '((0) (0)) '(3 4))))
    (is (equalp #(0d0) (statistics::fit-coefficients fit)))
    (is (= 25 (statistics::fit-residual-sum fit)))))

(test least-squares-leaves-its-arguments
  (let ((design (double-matrix '((1 2) (2 1) (3 3)))) (response (double-vector '(1 2 3))))
    (statistics::least-squares design response)
    (is (equalp design (double-matrix '((1 2) (2 1) (3 3)))))
    (is (equalp response (double-vector '(1 2 3))))))
