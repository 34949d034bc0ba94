;;;; Operations on lazy lists that return lazy lists.  Each computes the first element of its result
;;;; at once and the others when they are asked for.

(in-package #:discrepancy-finder.prolog)

(defun copy-lazy-list (list)
  "Return a lazy list with the elements of the lazy LIST in fresh conses; elements that LIST has not
computed yet are computed when one of the two lists is asked for them."
  (lazy-list ((rest (forced list)))
    (if rest
        (lazy-cons (car rest) (next (lazy-cdr rest)))
        (fin))))

(defun lazy-take (n list)
  "Return a lazy list of the first N elements of the lazy LIST, fewer if it has fewer."
  ;; The element after the last one is not computed.
  (labels ((take-more (n rest)
             (if (and (plusp n) rest)
                 (if (= n 1)
                     (list (car rest))
                     (lazy-cons (car rest) (take-more (1- n) (lazy-cdr rest))))
                 '())))
    (if (plusp n) (take-more n (forced list)) '())))

(defun lazy-mapcar (function list &rest more-lists)
  "Return a lazy list of the values of FUNCTION for the elements of the lazy lists, until the
shortest ends."
  (labels ((walk (lists)
             (if (every #'identity lists)
                 (lazy-cons (apply function (mapcar #'car lists))
                            (walk (mapcar #'lazy-cdr lists)))
                 '())))
    (walk (mapcar #'forced (cons list more-lists)))))

(defun append-two (first second)
  "Return a lazy list of the elements of the lazy list FIRST and of the one that the function SECOND
returns."
  (labels ((walk (rest)
             (if rest
                 (lazy-cons (car rest) (walk (lazy-cdr rest)))
                 (funcall second))))
    (walk (forced first))))

(defun lazy-append (&rest lists)
  "Return a lazy list of the elements of the lazy LISTS, one list after the other."
  (labels ((walk (lists)
             (cond ((null lists) '())
                   ((null (rest lists)) (first lists))
                   (t (append-two (first lists) (lambda () (walk (rest lists))))))))
    (forced (walk lists))))

(defun lazy-mapcan (function list &rest more-lists)
  "Return a lazy list of the elements of the lazy lists that FUNCTION returns for the elements of
the lazy lists, until the shortest ends."
  ;; Empty results are skipped by way of NEXT, which spares the control stack.
  (lazy-list ((lists (mapcar #'forced (cons list more-lists))))
    (if (every #'identity lists)
        (append-two (apply function (mapcar #'car lists))
                    (lambda () (next (mapcar #'lazy-cdr lists))))
        (fin))))

(defun lazy-flatten (list)
  "Return a lazy list of the elements of the lazy lists that are elements of the lazy LIST; elements
that are no lists are kept."
  (lazy-mapcan (lambda (element) (if (lazy-list-p element) element (list element))) list))

(defun lazy-filter (predicate list)
  "Return a lazy list of the elements of the lazy LIST of which PREDICATE is true."
  (lazy-mapcan (lambda (element) (if (funcall predicate element) (list element) '())) list))

(defun lazy-fold (function initial-value list)
  "Return what is left of INITIAL-VALUE after FUNCTION was called with it and the first element of
the lazy LIST, then with the value and the second element, and so on.  All of LIST is computed."
  (let ((value initial-value))
    (lazy-dolist (element list value)
      (setf value (funcall function value element)))))

(defun lazy-set-difference (list excluded &key (test #'eql))
  "Return a lazy list of the elements of the lazy LIST, in its order, that are not in the lazy list
EXCLUDED by TEST.  EXCLUDED is computed only as far as it is needed."
  (lazy-filter (lambda (element)
                 (lazy-dolist (other excluded t)
                   (when (funcall test element other) (return nil))))
               list))

(defun lazy-cross-product (list &rest more-lists)
  "Return a lazy list of the lists that have one element of each of the lazy lists, the last list
varying fastest."
  (if more-lists
      (lazy-mapcan (lambda (element)
                     (lazy-mapcar (lambda (others) (cons element others))
                                  (apply #'lazy-cross-product more-lists)))
                   list)
      (lazy-mapcar #'list list)))
