(in-package #:discrepancy-finder.tests)

(def-suite random-numbers :in all)
(in-suite random-numbers)

(test philox-known-answers
  ;; The vectors published with the Random123 library for philox4x32-10.
  (flet ((check (answer &rest arguments)
           (is (equal answer (multiple-value-list (apply #'discrepancy::philox arguments))))))
    (check '(#x6627e8d5 #xe169c58d #xbc57ac4c #x9b00dbd8) 0 0 0 0 0 0)
    (check '(#x408f276d #x41c83b0e #xa20bc7c6 #x6d5451fd)
           #xffffffff #xffffffff #xffffffff #xffffffff #xffffffff #xffffffff)
    (check '(#xd16cfe09 #x94fdcceb #x5001e420 #x24126ea1)
           #x243f6a88 #x85a308d3 #x13198a2e #x03707344 #xa4093822 #x299f31d0)))

(test content-hash-known-answers
  ;; Published FNV-1a 64-bit vectors; the last one was computed with Python, octet by octet.
  (is (= #xcbf29ce484222325 (discrepancy::content-hash "")))
  (is (= #xaf63dc4c8601ec8c (discrepancy::content-hash "a")))
  (is (= #x85944171f73967e8 (discrepancy::content-hash "foobar")))
  (is (= #x16fbf41ccc5652d9 (discrepancy::content-hash (format nil "r~c1" (code-char #xe4))))))

(test unit-float-known-answers
  ;; Computed with Python from the description in random.lisp.  Samples are told by seed and index:
  ;; these numbers must never change.
  (is (eql 0.7944924562035857d0 (discrepancy::unit-float 0 0 0 0)))
  (is (eql 0.6980105701745144d0 
          (discrepancy::unit-float 42 (discrepancy::content-hash "trace") 7 3)))
  (is (eql 0.05602708899234843d0 (discrepancy::unit-float (1- (expt 2 64)) (1- (expt 2 64))
                                        (1- (expt 2 32)) (1- (expt 2 32))))))

(test unit-float-refuses
  (dolist (arguments `((-1 0 0 0) (,(expt 2 64) 0 0 0) (1.5 0 0 0) (0 -1 0 0) (0 ,(expt 2 64) 0 0)
                       (0 0 ,(expt 2 32) 0) (0 0 -1 0) (0 0 0 ,(expt 2 32)) (nil 0 0 0)))
    (signals type-error (apply #'discrepancy::unit-float arguments))))

(defun unit-floats (count &key (seed 1) (content 2) (index #'identity) (draw (constantly 0)))
  (loop for i below count
        collect (discrepancy::unit-float seed content (funcall index i) (funcall draw i))))

(test unit-float-is-a-pure-function
  (let ((forward (unit-floats 50))
        (backward (unit-floats 50 :index (lambda (i) (- 49 i)))))
    (is (equal forward (reverse backward)))
    (is (every (lambda (x) (and (typep x 'double-float) (<= 0 x) (< x 1))) forward))
    (is (= 50 (length (remove-duplicates forward))))))

(test unit-float-uses-each-argument
  (let ((numbers (loop for arguments in '((0 0 0 0) (1 0 0 0) (0 1 0 0) (0 0 1 0) (0 0 0 1)
                                          (4294967296 0 0 0) (0 4294967296 0 0))
                       collect (apply #'discrepancy::unit-float arguments))))
    (is (= (length numbers) (length (remove-duplicates numbers))))))

(test unit-float-is-uniform
  ;; 16 cells, 16000 draws: a chi-square value with 15 degrees of freedom exceeds 37.7 with
  ;; probability 0.001.
  (loop for (name . arguments) in `(("index") ("draw" :index ,(constantly 5) :draw ,#'identity)
                                    ("high seed" :seed ,(expt 2 63)))
        for cells = (make-array 16 :initial-element 0)
        for numbers = (apply #'unit-floats 16000 arguments)
        do (dolist (x numbers) (incf (aref cells (floor (* 16 x)))))
           (is (< (loop for cell across cells sum (/ (expt (- cell 1000) 2) 1000)) 37.7) name)
           ;; Five standard deviations of the mean.
           (is (< (abs (- (/ (reduce #'+ numbers) 16000) 0.5d0))
                  (* 5 (/ (sqrt (* 12 16000d0)))))
               name)))

(defun correlation (xs ys)
  (let* ((count (length xs))
         (mean-x (/ (reduce #'+ xs) count))
         (mean-y (/ (reduce #'+ ys) count)))
    (flet ((product (us mean-u vs mean-v)
             (loop for u in us for v in vs sum (* (- u mean-u) (- v mean-v)))))
      (/ (product xs mean-x ys mean-y)
         (sqrt (* (product xs mean-x xs mean-x) (product ys mean-y ys mean-y)))))))

(test unit-float-streams-are-uncorrelated
  ;; Five standard deviations of the correlation of 4000 independent pairs.
  (let ((base (unit-floats 4000)))
    (dolist (other (list (unit-floats 4000 :draw (constantly 1))
                         (unit-floats 4000 :index #'1+)
                         (unit-floats 4000 :seed 2)
                         (unit-floats 4000 :content 3)
                         (unit-floats 4000 :seed 2 :content 1)
                         (unit-floats 4000 :index (constantly 0) :draw #'identity)))
      (is (< (abs (correlation base other)) (/ 5 (sqrt 4000d0)))))))
