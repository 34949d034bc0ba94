;;;; Least squares without an intercept.
;;;;
;;;; Given the rows x of a design matrix X and a response y, find the coefficients b that minimize
;;;; the residual sum of squares (y - Xb)'(y - Xb).  LEAST-SQUARES is the entry point.
;;;;
;;;; Method: Householder QR factorization with column pivoting (Golub and Van Loan, section 5.4).
;;;; X'X is never formed, which would square the condition number, and the residual sum comes from
;;;; the part of Q'y that no coefficient reaches, so that it is exactly 0 when there are as many
;;;; rows as columns.
;;;;
;;;; Constant columns: a column that has the same value c_j in all of at least two rows is a hidden
;;;; intercept, and two of them make X'X singular.  All constant columns are therefore merged into
;;;; one, and its effect is shared out as the minimum-norm solution does it: b_j is proportional to
;;;; c_j, and the sum of b_j c_j is the intercept.  A single constant column other than zero thus
;;;; gets its ordinary coefficient, and columns of zeros get the coefficient 0.  One row makes no
;;;; column constant, since it cannot show that something does not vary.

(in-package #:discrepancy-finder.statistics)

(defstruct (fit (:constructor make-fit (coefficients residual-sum rank columns)) (:copier nil))
  "The result of LEAST-SQUARES."
  (coefficients nil :type (or null (simple-array double-float (*))) :read-only t)
  (residual-sum nil :type (or null double-float) :read-only t)
  (rank 0 :type fixnum :read-only t)
  (columns 0 :type fixnum :read-only t))

(setf (documentation 'fit-coefficients 'function)
      "Return the vector of coefficients of a FIT, one for each column of the design, in its order;
NIL if the rank is too small to tell."
      (documentation 'fit-residual-sum 'function)
      "Return the sum of the squared residuals of a FIT; NIL if the rank is too small to tell."
      (documentation 'fit-rank 'function)
      "Return the numerical rank of the design of a FIT, after constant columns were merged."
      (documentation 'fit-columns 'function)
      "Return the number of columns of the design of a FIT, after constant columns were merged.")

(defmethod print-object ((fit fit) stream)
  (print-unreadable-object (fit stream :type t)
    (format stream "rank ~d of ~d~@[, coefficients ~{~,4f~^ ~}~]"
            (fit-rank fit) (fit-columns fit) (coerce (fit-coefficients fit) 'list))))

;;; Constant columns

(defun constant-columns (design)
  "Return the list of the indices of columns that have one value in all rows; NIL for one row."
  (destructuring-bind (rows columns) (array-dimensions design)
    (when (> rows 1)
      (loop for column below columns
            when (loop for row from 1 below rows
                       always (= (aref design row column) (aref design 0 column)))
              collect column))))

(defun merged-norm (design constant)
  "Return the norm of the values of the columns that CONSTANT lists: the merged column's value."
  (sqrt (loop for column in constant
              sum (expt (aref design 0 column) 2) of-type double-float)))

(defun kept-columns (design constant)
  (loop for column below (array-dimension design 1)
        unless (member column constant) collect column))

(defun augment (design response kept norm)
  "Return the matrix of the columns of DESIGN that KEPT lists, of a column full of NORM unless it is
zero, and of RESPONSE."
  (let* ((rows (array-dimension design 0))
         (columns (+ (length kept) (if (plusp norm) 2 1)))
         (matrix (make-array (list rows columns)
                             :element-type 'double-float :initial-element norm)))
    (dotimes (row rows matrix)
      (loop for column in kept
            for target from 0
            do (setf (aref matrix row target) (aref design row column)))
      (setf (aref matrix row (1- columns)) (aref response row)))))

(defun share-out (solution design constant kept norm)
  "Return the coefficients of all columns of DESIGN, given the SOLUTION for the merged design."
  (let ((coefficients (make-array (array-dimension design 1)
                                  :element-type 'double-float :initial-element 0d0)))
    (loop for column in kept
          for source from 0
          do (setf (aref coefficients column) (aref solution source)))
    (when (plusp norm)
      (loop with effect = (aref solution (length kept))
            for column in constant
            do (setf (aref coefficients column) (* effect (/ (aref design 0 column) norm)))))
    coefficients))

;;; Factorization of an augmented matrix: the last columns are responses

(deftype matrix () '(simple-array double-float (* *)))

(defun column-product (matrix a b start)
  "Return the dot product of the columns A and B of MATRIX from row START on."
  (declare (type matrix matrix) (type fixnum a b start) (optimize speed (safety 1)))
  (loop for row of-type fixnum from start below (array-dimension matrix 0)
        sum (* (aref matrix row a) (aref matrix row b)) of-type double-float))

(defun column-norm (matrix column start)
  (sqrt (the (double-float 0d0) (column-product matrix column column start))))

(defun swap-columns (matrix a b)
  (declare (type matrix matrix))
  (dotimes (row (array-dimension matrix 0))
    (rotatef (aref matrix row a) (aref matrix row b))))

(defun reflect (matrix pivot)
  "Apply to MATRIX, from row and column PIVOT on, the Householder reflection that makes column
PIVOT zero below the diagonal.  The column must not be zero; it is left as the reflection's axis
and the new diagonal element is returned."
  (declare (type matrix matrix) (type fixnum pivot) (optimize speed (safety 1)))
  (destructuring-bind (rows columns) (array-dimensions matrix)
    (declare (type fixnum rows columns))
    (let* ((norm (column-norm matrix pivot pivot))
           (head (aref matrix pivot pivot))
           ;; The sign that adds to the head of the axis: no cancellation.
           (diagonal (if (plusp head) (- norm) norm))
           (scale (/ (* norm (+ norm (abs head))))))
      (declare (double-float norm head diagonal scale))
      (decf (aref matrix pivot pivot) diagonal)
      (loop for column of-type fixnum from (1+ pivot) below columns
            for amount of-type double-float
              = (* scale (the double-float (column-product matrix pivot column pivot)))
            do (loop for row of-type fixnum from pivot below rows
                     do (decf (aref matrix row column) (* amount (aref matrix row pivot)))))
      diagonal)))

(defun factorize (matrix responses)
  "Turn MATRIX, whose last columns are RESPONSES many responses y, into (R | Q'y), R above the
diagonal.  Return the rank, the vector of the columns' original indices, and the vector of the
diagonal of R.  Columns count as dependent on those before them if their diagonals are at most
2^-50 max(rows, columns) times the first and largest one."
  (let* ((rows (array-dimension matrix 0))
         (columns (- (array-dimension matrix 1) responses))
         (order (coerce (loop for column below columns collect column) 'simple-vector))
         (diagonal (make-array columns :element-type 'double-float :initial-element 0d0))
         (tolerance 0d0))
    (dotimes (pivot (min rows columns) (values (min rows columns) order diagonal))
      (let* ((norms (loop for column from pivot below columns
                          collect (column-norm matrix column pivot)))
             (largest (reduce #'max norms))
             (column (+ pivot (position largest norms))))
        (when (zerop pivot)
          (setf tolerance (* (scale-float 1d0 -50) (max rows columns) largest)))
        (when (<= largest tolerance)
          (return (values pivot order diagonal)))
        (swap-columns matrix pivot column)
        (rotatef (aref order pivot) (aref order column))
        (setf (aref diagonal pivot) (reflect matrix pivot))))))

(defun back-substitute (matrix order diagonal &optional (response 0))
  "Return the solution of the factorized MATRIX for the RESPONSE with this number, in the original
order of its columns."
  (declare (type matrix matrix))
  (let* ((columns (length order))
         (right (+ columns response))
         (solution (make-array columns :element-type 'double-float)))
    (loop for row from (1- columns) downto 0
          for rest = (loop for column from (1+ row) below columns
                           sum (* (aref matrix row column)
                                  (aref solution (aref order column)))
                             of-type double-float)
          do (setf (aref solution (aref order row))
                   (/ (- (aref matrix row right) rest) (aref diagonal row))))
    solution))

(defun solve (matrix)
  "Return the solution of the augmented MATRIX, which is overwritten, its rank, and the residual sum
of squares; the solution and the sum are NIL if the rank is too small."
  (multiple-value-bind (rank order diagonal) (factorize matrix 1)
    (let ((columns (1- (array-dimension matrix 1))))
      (if (< rank columns)
          (values nil rank nil)
          (values (back-substitute matrix order diagonal) rank
                  (column-product matrix columns columns columns))))))

(defun least-squares (design response)
  "Return the FIT of the coefficients b that minimize (y - Xb)'(y - Xb), without an intercept, for
the two-dimensional array DESIGN = X with a row for each observation and the vector RESPONSE = y;
both of double floats.  Constant columns are merged into one.  If the columns that are then left
are linearly dependent, or more than the rows, the FIT has no coefficients, but tells the rank."
  (let* ((constant (constant-columns design))
         (kept (kept-columns design constant))
         (norm (merged-norm design constant))
         (matrix (augment design response kept norm))
         (columns (1- (array-dimension matrix 1))))
    (multiple-value-bind (solution rank residual-sum) (solve matrix)
      (make-fit (and solution (share-out solution design constant kept norm))
                residual-sum rank columns))))
