;;;; Calls of common functions with simple arguments, done in place.
;;;;
;;;; An entry says for which arguments what the function does can be done without a call; with all
;;;; others, symbolic ones among them, it is called as any function.  What is inlined cannot be
;;;; defined again: the functions are Common Lisp's and those of the same names in CPL, which for
;;;; numbers do the same.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *inline-functions* (make-hash-table :test 'equal)
  "For (name argument count) a function that makes the code of a call of callee, site, codes.")

(defmacro define-inline (names lambda-list condition form)
  "A call of one of NAMES with arguments LAMBDA-LIST for which CONDITION holds evaluates FORM."
  (let ((codes (loop for variable in lambda-list
                     collect (gensym (symbol-name variable)))))
    `(dolist (name ',names)
       (setf (gethash (list name ,(length lambda-list)) *inline-functions*)
             (lambda (callee site codes)
               (destructuring-bind ,codes codes
                 (declare (type function ,@codes))
                 (code (frame)
                   (let ,(loop for variable in lambda-list for code in codes
                               collect `(,variable (run ,code frame)))
                     (if ,condition
                         ,form
                         (call-callee callee site ,@lambda-list))))))))))

(defmacro define-inlines (&rest definitions)
  `(progn ,@(loop for definition in definitions collect `(define-inline ,@definition))))

(define-inlines
  ((+ discrepancy-finder.cpl:+) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (+ a b))
  ((- discrepancy-finder.cpl:-) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (- a b))
  ((* discrepancy-finder.cpl:*) (a b) (and (typep a '(signed-byte 31)) (typep b '(signed-byte 31)))
   (* a b))
  ((< discrepancy-finder.cpl:<) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (< a b))
  ((> discrepancy-finder.cpl:>) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (> a b))
  ((= discrepancy-finder.cpl:=) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (= a b))
  ((<=) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (<= a b))
  ((>=) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (>= a b))
  ((/=) (a b) (and (typep a 'fixnum) (typep b 'fixnum)) (/= a b))
  ((1+) (a) (typep a 'fixnum) (1+ a))
  ((1-) (a) (typep a 'fixnum) (1- a))
  ((zerop) (a) (typep a 'fixnum) (eql a 0))
  ((plusp) (a) (typep a 'fixnum) (> a 0))
  ((minusp) (a) (typep a 'fixnum) (< a 0))
  ((oddp) (a) (typep a 'fixnum) (oddp a))
  ((evenp) (a) (typep a 'fixnum) (evenp a))
  ((car first) (a) (listp a) (car a))
  ((cdr rest) (a) (listp a) (cdr a))
  ((endp) (a) (listp a) (null a))
  ((consp) (a) (not (symbolic-value-p a)) (consp a))
  ((atom) (a) (not (symbolic-value-p a)) (atom a))
  ((listp) (a) (not (symbolic-value-p a)) (listp a))
  ((null not) (a) (not (symbolic-value-p a)) (not a))
  ((eq) (a b) (not (or (symbolic-value-p a) (symbolic-value-p b))) (eq a b))
  ((eql) (a b) (not (or (symbolic-value-p a) (symbolic-value-p b))) (eql a b))
  ((cons) (a b) t (cons a b))
  ((svref) (a b)
   (and (simple-vector-p a) (typep b 'fixnum) (< -1 b (length a)))
   (svref a b)))

(defun analyze-inline-call (form scope)
  "Return the code of FORM if it calls a function in place, or NIL."
  (let ((maker (gethash (list (first form) (length (rest form))) *inline-functions*)))
    (and maker
         (funcall (the function maker) (find-callee (first form)) (make-site form)
                  (analyze-all (rest form) scope)))))
