;;;; Arrays: their elements are handed on as they are, indices are decided.
;;;;
;;;; An array of another element type than T can hold no symbolic value: what is to be stored there
;;;; is decided.

(in-package #:discrepancy-finder.symbolic-execution)

(define-transparent aref (array &rest indices))
(define-transparent svref (vector index))
(define-transparent elt (sequence index))
(define-transparent row-major-aref (array index))
(define-transparent bit (array &rest indices))
(define-transparent sbit (array &rest indices))
(define-transparent char (string index))
(define-transparent schar (string index))
(define-transparent array-dimension (array index))
(define-transparent subseq (sequence start &optional end))
(define-transparent copy-seq (sequence))
(define-transparent array-row-major-index (array &rest indices))
(define-transparent array-in-bounds-p (array &rest indices))
(define-transparent (sb-kernel:data-vector-ref sb-kernel:hairy-data-vector-ref) (vector index)
  (row-major-aref (settled vector "a vector") (settled index "an index")))

(macrolet ((define (&rest names)
             `(progn ,@(loop for name in names collect `(define-transparent ,name (array))))))
  (define array-dimensions array-rank array-total-size array-element-type array-has-fill-pointer-p
    array-displacement adjustable-array-p fill-pointer))

(define-transparent make-array (dimensions &rest keywords
                                           &key element-type initial-element initial-contents
                                           &allow-other-keys)
  (declare (ignorable initial-element initial-contents))
  (if (symbolic-run-p)
      (let* ((dimensions (settled dimensions "the dimensions of an array"))
             (element-type (settled (if (getf keywords :element-type) element-type t)
                                    "an element type"))
             (general (eq (upgraded-array-element-type element-type) t)))
        (apply #'make-array
               (if (consp dimensions)
                   (settled-each dimensions "the dimensions of an array")
                   dimensions)
               (loop for (keyword value) on keywords by #'cddr
                     collect keyword
                     collect (cond ((not (member keyword '(:initial-element :initial-contents)))
                                    (settled value "an argument of make-array"))
                                   ((and general (eq element-type t)) value)
                                   (t (decided value "an element of an array"))))))
      (apply #'make-array dimensions keywords)))

;;; Changes

(defun fitting-element (value array)
  "Return VALUE, settled unless ARRAY can hold it as it is."
  (if (and (symbolic-value-p value) (not (eq (array-element-type array) t)))
      (settled value "an element of an array")
      value))

(defun set-element (array index value)
  "Store VALUE at the row-major INDEX of ARRAY."
  (note-place (row-major-aref array index))
  (setf (row-major-aref array index) (fitting-element value array)))

(defmacro define-element-setter (name value-first setter)
  "Define the version of the function NAME that stores an element; its arguments are the array, the
indices and the value, which comes first if VALUE-FIRST.  Without a path SETTER is called."
  `(define-transparent (,name) (&rest arguments)
     (if *path*
         (destructuring-bind (array &rest indices)
             (settled-each ,(if value-first '(rest arguments) '(butlast arguments))
                           "an index of an array")
           (set-element array (apply #'array-row-major-index array indices)
                        ,(if value-first
                             '(first arguments)
                             '(first (last arguments)))))
         (apply ,setter arguments))))

(define-element-setter (setf aref) t #'(setf aref))
(define-element-setter (setf bit) t #'(setf bit))
(define-element-setter (setf sbit) t #'(setf sbit))

(defmacro define-vector-setters (&rest names)
  `(progn
     ,@(loop for name in names
             collect `(define-transparent (,name) (array index any-value)
                        (if *path*
                            (let ((array (settled array "an array"))
                                  (index (settled index "an index of an array")))
                              (set-element array index any-value))
                            (,name array index any-value))))))

(define-vector-setters sb-kernel:%svset sb-kernel:%set-row-major-aref sb-kernel:%charset
  sb-kernel:%scharset)

(define-transparent (sb-kernel:%setelt) (sequence index any-value)
  (if *path*
      (let ((sequence (settled sequence "a sequence")) (index (settled index "an index")))
        (if (listp sequence)
            (let ((tail (nthcdr index sequence)))
              (unless (consp tail)
                (sb-kernel:%setelt sequence index any-value))
              (note-place (car tail))
              (setf (car tail) any-value))
            (progn
              (elt sequence index)
              (set-element sequence index any-value))))
      (sb-kernel:%setelt sequence index any-value)))

(define-transparent (sb-kernel:%set-fill-pointer) (vector fill-pointer)
  (let ((vector (settled vector "a vector")))
    (note-place (fill-pointer vector))
    (setf (fill-pointer vector) (settled fill-pointer "a fill pointer"))))

(define-transparent (vector-push) (any-value vector)
  (let ((vector (settled vector "a vector")))
    (note-vector-end vector)
    (vector-push (fitting-element any-value vector) vector)))

(defun note-vector-end (vector)
  "Note the size of VECTOR, its fill pointer and the element behind it."
  (when *path*
    (let* ((fill-pointer (fill-pointer vector)) (size (array-total-size vector))
           (full (= fill-pointer size))
           (old (if full nil (row-major-aref vector fill-pointer))))
      (note-undo (lambda ()
                   (unless (= (array-total-size vector) size)
                     (adjust-array vector size :fill-pointer 0))
                   (setf (fill-pointer vector) fill-pointer)
                   (unless full
                     (setf (row-major-aref vector fill-pointer) old)))))))

(define-transparent (vector-push-extend) (any-value vector &optional (extension 1 extension-p))
  (let ((vector (settled vector "a vector")))
    (note-vector-end vector)
    (if extension-p
        (vector-push-extend (fitting-element any-value vector) vector
                            (settled extension "a size"))
        (vector-push-extend (fitting-element any-value vector) vector))))

(define-transparent (vector-pop) (vector)
  (let ((vector (settled vector "a vector")))
    (note-place (fill-pointer vector))
    (vector-pop vector)))

(define-transparent (adjust-array) (array dimensions &rest keywords)
  (let ((array (settled array "an array")))
    (note-array array)
    (let ((old (array-dimensions array)) (adjustable (adjustable-array-p array)))
      (when (and *path* adjustable)
        (note-undo (lambda () (adjust-array array old)))))
    (apply #'adjust-array array (settled dimensions "the dimensions of an array")
           (settled-each keywords "an argument of adjust-array"))))

;;; Functions that understand nothing symbolic, and change an array

(defmacro define-changing (&rest definitions)
  "Let functions note what they change: each definition is a number, of the argument that is changed
if it is an array, and names."
  `(progn
     ,@(loop for (number . names) in definitions
             append (loop for name in names
                          collect `(define-transparent (,name) (&rest arguments)
                                     (let ((array (nth ,number arguments)))
                                       (when (and *path* (arrayp array))
                                         (note-array array)))
                                     (call-opaque #',name arguments
                                                  ,(describe-decision name)))))))

(define-changing
  (0 nstring-upcase nstring-downcase nstring-capitalize read-sequence)
  (1 bit-not)
  (2 bit-and bit-ior bit-xor bit-eqv bit-nand bit-nor bit-andc1 bit-andc2 bit-orc1 bit-orc2))
