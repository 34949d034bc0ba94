;;;; Unit propagation before Z3 sees anything.
;;;;
;;;; With a narrative most atoms of a theory are known: what happens, and so what holds.  A unit
;;;; clause fixes its variable, and clauses that are true then are dropped, literals that are false
;;;; are left out.  Fixed variables are asserted as units, so that Z3's models have them, too.
;;;; Entry point: SIMPLIFY-CLAUSES.

(in-package #:discrepancy-finder.event-calculus)

(deftype clause-vector () '(simple-array fixnum (*)))
(deftype truth-vector () '(simple-array (unsigned-byte 2) (*)))

(defconstant +unknown+ 0)
(defconstant +true+ 1)
(defconstant +false+ 2)

(declaim (inline literal-index literal-truth))

(defun literal-index (literal)
  (declare (type (signed-byte 32) literal))
  (if (plusp literal) (* 2 literal) (1+ (* -2 literal))))

(defun literal-truth (truths literal)
  (declare (type truth-vector truths) (type (signed-byte 32) literal))
  (let ((truth (aref truths (abs literal))))
    (cond ((= truth +unknown+) +unknown+)
          ((plusp literal) truth)
          (t (- 3 truth)))))

(defun clause-starts (clauses)
  "Return a vector of the positions at which the clauses begin, and the length at its end."
  (declare (type clause-vector clauses) (optimize speed))
  (let ((starts (make-array (1+ (count 0 clauses)) :element-type 'fixnum :initial-element 0))
        (clause 0))
    (declare (type fixnum clause))
    (dotimes (position (length clauses) starts)
      (when (zerop (aref clauses position))
        (incf clause)
        (setf (aref starts clause) (1+ position))))))

(defun occurrence-lists (clauses starts size)
  "Return two vectors: where the clauses of each literal, by its index, begin in the second."
  (declare (type clause-vector clauses starts) (type (unsigned-byte 32) size) (optimize speed))
  (let ((begins (make-array (+ 2 (* 2 size)) :element-type 'fixnum :initial-element 0))
        (members (make-array (length clauses) :element-type 'fixnum :initial-element 0)))
    (loop for literal of-type (signed-byte 32) across clauses
          do (unless (zerop literal)
               (incf (aref begins (1+ (literal-index literal))))))
    (loop for index from 1 below (length begins)
          do (incf (aref begins index) (aref begins (1- index))))
    (let ((next (copy-seq begins)))
      (dotimes (clause (1- (length starts)))
        (loop for position from (aref starts clause) below (1- (aref starts (1+ clause)))
              for index of-type fixnum = (literal-index (aref clauses position))
              do (setf (aref members (aref next index)) clause)
                 (incf (aref next index)))))
    (values begins members)))

(defun propagate-units (clauses starts begins members truths)
  "Fix in TRUTHS what follows by unit propagation.  Return NIL if there is a contradiction."
  (declare (type clause-vector clauses starts begins members) (type truth-vector truths)
           (optimize speed) (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let ((queue (make-array (length truths) :element-type 'fixnum :initial-element 0))
        (head 0) (tail 0))
    (declare (type fixnum head tail))
    (labels ((fix (literal)
               (declare (type (signed-byte 32) literal))
               (let ((truth (literal-truth truths literal)))
                 (cond ((= truth +false+) (return-from propagate-units nil))
                       ((= truth +unknown+)
                        (setf (aref truths (abs literal)) (if (plusp literal) +true+ +false+)
                              (aref queue tail) literal)
                        (incf tail)))))
             (look (clause)
               (declare (type fixnum clause))
               (let ((only 0))
                 (declare (type (signed-byte 32) only))
                 (loop for position from (aref starts clause)
                         below (1- (aref starts (1+ clause)))
                       for literal of-type (signed-byte 32) = (aref clauses position)
                       for truth = (literal-truth truths literal)
                       do (cond ((= truth +true+) (return-from look))
                                ((= truth +unknown+)
                                 (unless (or (zerop only) (= only literal))
                                   (return-from look))
                                 (setf only literal))))
                 (when (zerop only) (return-from propagate-units nil))
                 (fix only))))
      (dotimes (clause (1- (length starts)))
        (look clause))
      (loop while (< head tail)
            do (let* ((literal (aref queue head))
                      (index (literal-index (- literal))))
                 (declare (type (signed-byte 32) literal) (type fixnum index))
                 (incf head)
                 (loop for place from (aref begins index) below (aref begins (1+ index))
                       do (look (aref members place)))))
      t)))

(defun remaining-clauses (clauses starts truths known)
  "Return CLAUSES without what TRUTHS makes superfluous, and units for what it fixes and KNOWN does
not."
  (declare (type clause-vector clauses starts) (type truth-vector truths known) (optimize speed))
  (let ((output (make-array (+ (length clauses) (* 2 (length truths))) :element-type 'fixnum
                                                                       :initial-element 0))
        (end 0))
    (declare (type fixnum end))
    (flet ((put (literal)
             (setf (aref output end) literal)
             (incf end)))
      (declare (inline put))
      (loop for variable from 1 below (length truths)
            for truth = (aref truths variable)
            do (unless (or (= truth +unknown+) (= truth (aref known variable)))
                 (put (if (= truth +true+) variable (- variable)))
                 (put 0)))
      (dotimes (clause (1- (length starts)))
        (let ((first (aref starts clause)) (last (1- (aref starts (1+ clause)))))
          (unless (loop for position from first below last
                          thereis (= +true+ (literal-truth truths (aref clauses position))))
            (loop for position from first below last
                  for literal of-type (signed-byte 32) = (aref clauses position)
                  do (when (= +unknown+ (literal-truth truths literal))
                       (put literal)))
            (put 0)))))
    (subseq output 0 end)))

(defun simplify-clauses (clauses truths size)
  "Return clauses that say the same as CLAUSES and units for what TRUTHS has fixed of the variables
below SIZE; and the truths after unit propagation.  A contradiction is an empty clause."
  (let* ((known (adjust-truths truths size))
         (truths (copy-seq known))
         (starts (clause-starts clauses)))
    (multiple-value-bind (begins members) (occurrence-lists clauses starts size)
      (if (propagate-units clauses starts begins members truths)
          (values (remaining-clauses clauses starts truths known) truths)
          (values (coerce '(0) 'clause-vector) known)))))

(defun adjust-truths (truths size)
  "Return a copy of TRUTHS for the variables below SIZE."
  (declare (type truth-vector truths))
  (let ((larger (make-array (max size (length truths)) :element-type '(unsigned-byte 2)
                                                       :initial-element +unknown+)))
    (replace larger truths)))
