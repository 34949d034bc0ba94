;;;; Samplers: where in the unit cube sample number i lies.
;;;;
;;;; UNIT-POINT is the entry point: a pure function of the sampler, of the user's seed, of the hash
;;;; of what is sampled, and of the index.  Samplers are
;;;;   :INDEPENDENT  uniform draws; what confidence rules are about
;;;;   :STRATIFIED   one uniform draw in each of 64 equal cells, round by round; a full round
;;;;                 without rejections is as good as 64 independent draws, or better
;;;;   :SOBOL        a low-discrepancy sequence with a random shift: good for finding, not for
;;;;                 counting
;;;;   :CORNERS      the corners of the cube first, then independent draws

(in-package #:discrepancy-finder.discrepancy)

(defparameter *samplers* '(:independent :stratified :sobol :corners)
  "The names of the samplers.")

(defconstant +cells+ 64
  "The number of cells of a round of the sampler :STRATIFIED, a power of 2.")

(defconstant +largest-unit+ (- 1 (scale-float 1d0 -53))
  "The largest double float below 1.")

(defun independent-point (seed content index dimensions)
  (loop for dimension below dimensions
        collect (unit-float seed content index dimension)))

;;; Strata

(defun random-bits (count seed content index draw)
  "Return a random integer of COUNT bits."
  (floor (* (unit-float seed content index draw) (ash 1 count))))

(defun stratified-point (seed content index dimensions)
  "The bits of the cell's number go to the dimensions in turn; in which order the cells of a round
are visited is random."
  (multiple-value-bind (round number) (floor index +cells+)
    (let* ((bits (1- (integer-length +cells+)))
           (cell (logxor number (random-bits bits seed content round #xc0000000)))
           (places (make-list dimensions :initial-element 0))
           (widths (make-list dimensions :initial-element 0)))
      (when (plusp dimensions)
        (dotimes (bit bits)
          (let ((dimension (mod bit dimensions)))
            (setf (nth dimension places) (+ (* 2 (nth dimension places))
                                            (ldb (byte 1 bit) cell)))
            (incf (nth dimension widths)))))
      (loop for u in (independent-point seed content index dimensions)
            for place in places
            for width in widths
            collect (/ (+ place u) (ash 1 width))))))

;;; Sobol's sequence

(defparameter *sobol-numbers*
  (coerce
   '(()
      (3 1) (7 1 3) (11 1 3 1) (13 1 1 1) (19 1 1 3 3) (25 1 3 5 13) (37 1 1 5 5 17)
      (41 1 1 5 5 5) (47 1 1 7 11 19) (55 1 1 5 1 1) (59 1 1 1 3 11) (61 1 3 5 5 31)
      (67 1 3 3 9 7 49) (91 1 1 1 15 21 21) (97 1 3 1 13 27 49) (103 1 1 1 15 7 5)
      (109 1 3 1 15 13 25) (115 1 1 5 5 19 61) (131 1 3 7 11 23 15 103)
      (137 1 3 7 13 13 15 69) (143 1 1 3 13 7 35 63) (145 1 3 5 9 1 25 53)
      (157 1 3 1 13 9 35 107) (167 1 3 1 5 27 61 31) (171 1 1 5 11 19 41 61)
      (185 1 3 5 3 3 13 69) (191 1 1 7 13 1 19 1) (193 1 3 7 5 13 19 59)
      (203 1 1 3 9 25 29 41) (211 1 3 5 13 23 1 55) (213 1 3 7 3 13 59 17)
      (229 1 3 1 3 5 53 69) (239 1 1 5 5 23 33 13) (241 1 1 7 7 1 61 123)
      (247 1 1 7 9 13 61 49) (253 1 3 3 5 3 55 33) (285 1 3 1 15 31 13 49 245)
      (299 1 3 5 15 31 59 63 97) (301 1 3 1 11 11 11 77 249))
   'simple-vector)
  "For each dimension a primitive polynomial over GF(2), as bits, and the initial direction numbers
m1 m2 ..., as S. Joe and F. Y. Kuo chose them (SIAM J. Sci. Comput. 30, 2008); the first dimension
has none.")

(defconstant +sobol-bits+ 32)

(defun direction-numbers (dimension)
  "Return the vector of the direction numbers of DIMENSION, integers of +SOBOL-BITS+ bits."
  (let ((numbers (make-array +sobol-bits+)))
    (destructuring-bind (&optional polynomial &rest initial) (svref *sobol-numbers* dimension)
      (let ((degree (if polynomial (1- (integer-length polynomial)) 0)))
        (dotimes (k +sobol-bits+ numbers)
          (setf (svref numbers k)
                (cond ((null polynomial) (ash 1 (- +sobol-bits+ k 1)))
                      ((< k degree) (ash (nth k initial) (- +sobol-bits+ k 1)))
                      (t (let ((value (logxor (svref numbers (- k degree))
                                              (ash (svref numbers (- k degree)) (- degree)))))
                           (loop for j from 1 below degree
                                 do (when (logbitp (- degree j) polynomial)
                                      (setf value (logxor value (svref numbers (- k j))))))
                           value)))))))))

(defparameter *direction-numbers*
  (map 'simple-vector #'direction-numbers (alexandria:iota (length *sobol-numbers*)))
  "For each dimension its direction numbers.")

(defun sobol-integer (index dimension)
  "Return point INDEX of Sobol's sequence in DIMENSION, as an integer of +SOBOL-BITS+ bits."
  (let ((numbers (svref *direction-numbers* dimension)))
    (loop for k below (integer-length index)
          for value = (if (logbitp k index) (svref numbers k) 0)
            then (if (logbitp k index) (logxor value (svref numbers k)) value)
          finally (return (or value 0)))))

(defun sobol-point (seed content index dimensions)
  "Beyond the dimensions of the table draws are independent."
  (loop for dimension below dimensions
        collect (if (< dimension (length *sobol-numbers*))
                    (/ (+ (logxor (sobol-integer index dimension)
                                  (random-bits +sobol-bits+ seed content dimension #xc0000001))
                          (unit-float seed content index dimension))
                       (float (ash 1 +sobol-bits+) 1d0))
                    (unit-float seed content index dimension))))

;;; Corners

(defun corners-point (seed content index dimensions)
  "The first 2^n points are the corners of n dimensions, 12 at the most, in random order; further
dimensions go to either end at random."
  (let* ((counted (min dimensions 12))
         (corner (logxor index (random-bits counted seed content 0 #xc0000002))))
    (if (>= index (ash 1 counted))
        (independent-point seed content index dimensions)
        (loop for dimension below dimensions
              collect (if (if (< dimension counted)
                              (logbitp dimension corner)
                              (< (unit-float seed content index dimension) 1/2))
                          +largest-unit+
                          0d0)))))

(defun unit-point (sampler seed content index dimensions)
  "Return the list of DIMENSIONS coordinates, double floats in [0, 1[, of point INDEX of SAMPLER,
one of *SAMPLERS*; SEED and CONTENT are as for UNIT-FLOAT."
  (funcall (ecase sampler
             (:independent #'independent-point)
             (:stratified #'stratified-point)
             (:sobol #'sobol-point)
             (:corners #'corners-point))
           seed content index dimensions))
