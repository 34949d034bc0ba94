;;;; Regressions that grow: what ten thousand observations say fits into a small triangle.
;;;;
;;;; A REGRESSION collects observations (x, y), vectors of inputs and outputs.  After each 64 rows
;;;; the matrix (1 X Y) is replaced by the triangular factor of its QR factorization, which has the
;;;; same least-squares solutions, residual sums and dependent columns: one more observation costs
;;;; the same, however many there were.  Up to 64 observations nothing is replaced, so that the bits
;;;; are those of LEAST-SQUARES.
;;;;
;;;; LINEAR-FIT is the fit without an intercept, constant inputs merged as in LEAST-SQUARES; BAND is
;;;; the one with an intercept, from which predictions come.

(in-package #:discrepancy-finder.statistics)

(defconstant +rows-kept+ 64
  "So many rows are collected beyond the triangle before they are factorized.")

(defstruct (regression (:constructor %make-regression (inputs outputs)) (:copier nil))
  "Observations of a number of INPUTS and OUTPUTS."
  (inputs 0 :type (integer 0) :read-only t)
  (outputs 0 :type (integer 0) :read-only t)
  (count 0 :type (integer 0))
  (first nil :type (or null simple-vector))
  (varying '() :type list)
  (rows '() :type list)
  (fresh 0 :type (integer 0)))

(setf (documentation 'regression-count 'function)
      "Return the number of the observations of a REGRESSION.")

(defmethod print-object ((regression regression) stream)
  (print-unreadable-object (regression stream :type t)
    (format stream "of ~d on ~d, ~d observation~:p" (regression-outputs regression)
            (regression-inputs regression) (regression-count regression))))

(defun make-regression (inputs outputs)
  "Return a new REGRESSION of a number of OUTPUTS on a number of INPUTS, without observations."
  (%make-regression inputs outputs))

(defun rows-matrix (rows)
  "Return the matrix of ROWS, a list of vectors, newest first."
  (let ((matrix (make-array (list (length rows) (length (first rows)))
                            :element-type 'double-float)))
    (loop for row in rows
          for index downfrom (1- (length rows))
          do (dotimes (column (length row))
               (setf (aref matrix index column) (aref row column))))
    matrix))

(defun triangle (matrix)
  "Return the rows, newest first, of the triangular factor of MATRIX, which is overwritten."
  (destructuring-bind (rows columns) (array-dimensions matrix)
    (let ((diagonal (make-array columns :element-type 'double-float :initial-element 0d0)))
      (dotimes (pivot (min rows columns))
        (when (plusp (column-norm matrix pivot pivot))
          (setf (aref diagonal pivot) (reflect matrix pivot))))
      (let ((result '()))
        (dotimes (row (min rows columns) result)
          (let ((vector (make-array columns :element-type 'double-float :initial-element 0d0)))
            (setf (aref vector row) (aref diagonal row))
            (loop for column from (1+ row) below columns
                  do (setf (aref vector column) (aref matrix row column)))
            (push vector result)))))))

(defun add-observation (regression inputs outputs)
  "Add the observation of the vectors INPUTS and OUTPUTS of double floats to REGRESSION; return it."
  (let ((row (concatenate '(simple-array double-float (*)) '(1d0) inputs outputs)))
    (if (regression-first regression)
        (loop for index below (regression-inputs regression)
              do (unless (= (aref inputs index) (aref (regression-first regression) index))
                   (pushnew index (regression-varying regression))))
        (setf (regression-first regression) (coerce inputs 'simple-vector)))
    (when (= (regression-fresh regression) +rows-kept+)
      (setf (regression-rows regression) (triangle (rows-matrix (regression-rows regression)))
            (regression-fresh regression) 0))
    (push row (regression-rows regression))
    (incf (regression-fresh regression))
    (incf (regression-count regression)))
  regression)

(defun varying-inputs (regression)
  "Return the ascending list of the numbers of the inputs that have not one value in all of at least
two observations of REGRESSION; of fewer observations all."
  (if (< (regression-count regression) 2)
      (loop for index below (regression-inputs regression) collect index)
      (sort (copy-list (regression-varying regression)) #'<)))

(defun augmented-matrix (regression inputs scale outputs)
  "Return the matrix of the columns INPUTS of REGRESSION, of SCALE in each observation unless it is
0, and of OUTPUTS, a list of numbers."
  (let* ((source (rows-matrix (regression-rows regression)))
         (rows (array-dimension source 0))
         (first-output (+ (length inputs) (if (zerop scale) 0 1)))
         (matrix (make-array (list rows (+ first-output (length outputs)))
                             :element-type 'double-float)))
    (dotimes (row rows matrix)
      (loop for input in inputs
            for column from 0
            do (setf (aref matrix row column) (aref source row (1+ input))))
      (unless (zerop scale)
        (setf (aref matrix row (1- first-output)) (* scale (aref source row 0))))
      (loop for output in outputs
            for column from first-output
            do (setf (aref matrix row column)
                     (aref source row (+ 1 (regression-inputs regression) output)))))))

(defun constant-values (regression varying)
  "Return the list of (input . value) of the inputs that are not in VARYING."
  (loop for index below (regression-inputs regression)
        unless (member index varying)
          collect (cons index (aref (regression-first regression) index))))

(defun linear-columns (regression)
  "Return how many columns LINEAR-FIT of REGRESSION has, after constant inputs were merged."
  (let ((varying (varying-inputs regression)))
    (+ (length varying)
       (if (some #'plusp (mapcar (lambda (entry) (abs (cdr entry)))
                                 (constant-values regression varying)))
           1 0))))

(defun linear-fit (regression output)
  "Return the FIT, without an intercept, of the OUTPUT with this number on the inputs of
REGRESSION."
  (let* ((varying (varying-inputs regression))
         (constant (constant-values regression varying))
         (norm (sqrt (loop for (nil . value) in constant
                           sum (* value value) of-type double-float)))
         (matrix (augmented-matrix regression varying norm (list output)))
         (columns (1- (array-dimension matrix 1)))
         (coefficients (make-array (regression-inputs regression)
                                   :element-type 'double-float :initial-element 0d0)))
    (multiple-value-bind (solution rank residual-sum) (solve matrix)
      (when solution
        (loop for input in varying
              for number from 0
              do (setf (aref coefficients input) (aref solution number)))
        (unless (zerop norm)
          (loop for (input . value) in constant
                do (setf (aref coefficients input)
                         (* (aref solution (length varying)) (/ value norm))))))
      (make-fit (and solution coefficients) residual-sum rank columns))))

;;; Prediction

(defstruct (band (:copier nil))
  "An ordinary least-squares fit with an intercept.  SOLUTION has the coefficients of the inputs
that vary and, last, the intercept; FACTOR is the factorized matrix with its pivots ORDER and
DIAGONAL, FREEDOM the residual degrees of freedom."
  (solution nil :read-only t)
  (residual-sum 0d0 :type double-float :read-only t)
  (factor nil :read-only t)
  (order nil :read-only t)
  (diagonal nil :read-only t)
  (freedom 0 :type integer :read-only t))

(defun fit-bands (regression)
  "Return the list of the BANDs of all outputs of REGRESSION, or NIL if its columns depend on each
other or are more than the observations."
  (let* ((outputs (loop for output below (regression-outputs regression) collect output))
         (matrix (augmented-matrix regression (sort (copy-list (regression-varying regression)) #'<)
                                   1d0 outputs))
         (columns (- (array-dimension matrix 1) (length outputs))))
    (multiple-value-bind (rank order diagonal) (factorize matrix (length outputs))
      (when (= rank columns)
        (loop for output in outputs
              for column = (+ columns output)
              collect (make-band :solution (back-substitute matrix order diagonal output)
                                 :residual-sum (column-product matrix column column columns)
                                 :factor matrix :order order :diagonal diagonal
                                 :freedom (- (regression-count regression) columns)))))))

(defun band-leverage (band point)
  "Return x'(X'X)^-1 x of BAND for the vector POINT = x, the intercept's 1 included and last."
  (declare (type (simple-array double-float (*)) point) (optimize speed (safety 1)))
  (loop with factor of-type matrix = (band-factor band)
        with order of-type simple-vector = (band-order band)
        with diagonal of-type (simple-array double-float (*)) = (band-diagonal band)
        with solved = (make-array (length order) :element-type 'double-float)
        for row of-type fixnum below (length order)
        for value of-type double-float
          = (/ (- (aref point (the fixnum (aref order row)))
                  (loop for column of-type fixnum below row
                        sum (* (aref factor column row) (aref solved column))
                          of-type double-float))
               (aref diagonal row))
        do (setf (aref solved row) value)
        sum (* value value) of-type double-float))
