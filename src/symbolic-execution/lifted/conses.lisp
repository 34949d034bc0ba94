;;;; Conses and lists: what is in them is handed on as it is.

(in-package #:discrepancy-finder.symbolic-execution)

(macrolet ((define (&rest names)
             `(progn ,@(loop for name in names collect `(define-transparent ,name (list))))))
  (define car cdr caar cadr cdar cddr caaar caadr cadar caddr cdaar cdadr cddar cdddr
    caaaar caaadr caadar caaddr cadaar cadadr caddar cadddr cdaaar cdaadr cdadar cdaddr
    cddaar cddadr cdddar cddddr
    first second third fourth fifth sixth seventh eighth ninth tenth rest endp
    copy-list copy-alist list-length length reverse))

;;; They look at nothing: the functions themselves will do.

(dolist (name '(cons list list* copy-tree vector identity values acons xcons))
  (when (fboundp name)
    (register-lifted name :transparent nil)))

(define-transparent values-list (list))
(define-transparent nth (index list))
(define-transparent nthcdr (index any-list))
(define-transparent last (list &optional (count 1)))
(define-transparent butlast (list &optional (count 1)))
(define-transparent revappend (list any-tail))
(define-transparent ldiff (list any-tail))
(define-transparent pairlis (keys data &optional list))
(define-transparent make-list (size &key initial-element)
  (make-list (settled size "the size of a list") :initial-element initial-element))

(define-transparent append (&rest any-lists)
  (if (symbolic-run-p)
      (apply #'append (settled-but-last any-lists "an argument of append"))
      (apply #'append any-lists)))

(defun settled-but-last (values description)
  (loop for (value . more) on values
        collect (if more (settled value description) value)))

(defun settled-each (values description)
  "Return VALUES with each that is symbolic settled."
  (if (symbolic-run-p)
      (mapcar (lambda (value) (settled value description)) values)
      values))

;;; Property lists: the indicators are compared

(define-transparent getf (list indicator &optional any-default)
  (getf (settled-indicators (settled list "a property list")) (settled indicator "an indicator")
        any-default))

(defun settled-indicators (list)
  "Return the property list LIST after every symbolic indicator in it was settled."
  (when (symbolic-run-p)
    (loop for tail = list then (cddr tail)
          while (and (consp tail) (consp (cdr tail)))
          when (symbolic-value-p (car tail))
            do (note-place (car tail))
               (setf (car tail) (settled (car tail) "an indicator"))))
  list)

(define-transparent get-properties (list indicators)
  (get-properties (settled-indicators (settled list "a property list"))
                  (settled-each (settled indicators "a list of indicators") "an indicator")))

(define-transparent sb-impl::%putf (list any-indicator any-value)
  (let ((list (settled-indicators (settled list "a property list")))
        (indicator (settled any-indicator "an indicator")))
    (note-properties list)
    (sb-impl::%putf list indicator any-value)))

(define-transparent sb-impl::%remf (indicator list)
  (let ((list (settled-indicators (settled list "a property list"))))
    (note-properties list)
    (sb-impl::%remf (settled indicator "an indicator") list)))

(defun note-properties (list)
  (note-conses list))

;;; Destructive functions

(defun note-conses (list)
  "Note that the conses of LIST, which need not end in NIL, are to be as they are after the run."
  (when *path*
    (let ((conses '()))
      (loop for cons = list then (cdr cons)
            while (consp cons)
            do (push (list* cons (car cons) (cdr cons)) conses)
               (when (and (cdr conses) (eq cons list)) (return)))
      (note-undo (lambda ()
                   (loop for (cons car . cdr) in conses
                         do (setf (car cons) car
                                  (cdr cons) cdr)))))))

(define-transparent (rplaca) (cons any-value)
  (let ((cons (settled cons "a cons")))
    (when (consp cons)
      (note-place (car cons)))
    (rplaca cons any-value)))

(define-transparent (rplacd) (cons any-value)
  (let ((cons (settled cons "a cons")))
    (when (consp cons)
      (note-place (cdr cons)))
    (rplacd cons any-value)))

(define-transparent (sb-kernel:%rplaca) (cons any-value)
  (let ((cons (settled cons "a cons")))
    (when (consp cons)
      (note-place (car cons)))
    (setf (car cons) any-value)))

(define-transparent (sb-kernel:%rplacd) (cons any-value)
  (let ((cons (settled cons "a cons")))
    (when (consp cons)
      (note-place (cdr cons)))
    (setf (cdr cons) any-value)))

(define-transparent (nconc) (&rest any-lists)
  (let ((lists (if (symbolic-run-p)
                   (settled-but-last any-lists "an argument of nconc")
                   any-lists)))
    (when *path*
      (dolist (list (butlast lists))
        (when (consp list)
          (let ((last (last list)))
            (note-place (cdr last))))))
    (apply #'nconc lists)))

(define-transparent (nreconc) (list any-tail)
  (let ((list (settled list "a list")))
    (note-conses list)
    (nreconc list any-tail)))

(define-transparent (nreverse) (sequence)
  (let ((sequence (settled sequence "a sequence")))
    (note-sequence sequence)
    (nreverse sequence)))

(define-transparent (nbutlast) (list &optional (count 1))
  (let ((list (settled list "a list")))
    (note-conses list)
    (nbutlast list (settled count "a number of elements"))))

(defun note-sequence (sequence)
  "Note that SEQUENCE is to be as it is after the run."
  (when *path*
    (if (listp sequence)
        (note-conses sequence)
        (note-array sequence))))

(defun note-array (array)
  "Note that the elements of ARRAY, and its fill pointer, are to be as they are after the run."
  (when *path*
    (let ((elements (let ((copy (make-array (array-total-size array)
                                            :element-type (array-element-type array))))
                      (dotimes (index (length copy) copy)
                        (setf (row-major-aref copy index) (row-major-aref array index)))))
          (fill-pointer (and (array-has-fill-pointer-p array) (fill-pointer array))))
      (note-undo (lambda ()
                   (dotimes (index (min (length elements) (array-total-size array)))
                     (setf (row-major-aref array index) (row-major-aref elements index)))
                   (when fill-pointer
                     (setf (fill-pointer array) fill-pointer)))))))
