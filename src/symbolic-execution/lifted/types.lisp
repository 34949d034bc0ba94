;;;; What type is a symbolic value?
;;;;
;;;; For a guarded choice that may depend on which object it is; then the answer is symbolic.

(in-package #:discrepancy-finder.symbolic-execution)

(defun type-answer (value test type description)
  "Return whether the symbolic VALUE is of TYPE, a type specifier; TEST tells of a Lisp object."
  (let ((value (current value)))
    (typecase value
      (symbolic-number
       (let ((value-type (symbolic-number-type value)))
         (cond ((subtypep value-type type) t)
               ((subtypep `(and ,value-type ,type) nil) nil)
               (t (number-type-answer value test type description)))))
      (symbolic-value
       (symbolic-boolean
        (z3:disjunction (loop for (object . proposition) in (choices-of value)
                              when (funcall (the function test) object) collect proposition))))
      (t (and (funcall (the function test) value) t)))))

(defun number-type-answer (value test type description)
  "Return whether the symbolic number VALUE is of TYPE, where its own type does not tell."
  (let ((term (symbolic-number-term value))
        (type (if (symbolp type) (sb-kernel:type-specifier (sb-kernel:specifier-type type)) type)))
    (flet ((within (low high)
             (z3:conjunction
              (list (bound-proposition low term #'z3:less-or-equal #'z3:less)
                    (bound-proposition high term
                                       (lambda (bound term) (z3:less-or-equal term bound))
                                       (lambda (bound term) (z3:less term bound)))))))
      (cond ((eq type 'integer)
             (symbolic-boolean (z3:integral term)))
            ((member type '(fixnum bit unsigned-byte))
             (number-type-answer value test
                                 (ecase type
                                   (fixnum `(integer ,most-negative-fixnum ,most-positive-fixnum))
                                   (bit '(integer 0 1))
                                   (unsigned-byte '(integer 0)))
                                 description))
            ((and (consp type) (member (first type) '(integer rational real))
                  (or (integer-term-p term) (not (eq (first type) 'integer))))
             (destructuring-bind (&optional (low '*) (high '*)) (rest type)
               (symbolic-boolean (within low high))))
            ((and (consp type) (eq (first type) 'mod))
             (number-type-answer value test `(integer 0 ,(1- (second type))) description))
            (t (and (funcall (the function test) (settled value description)) t))))))

(defun bound-proposition (bound term inclusive exclusive)
  (cond ((eq bound '*) t)
        ((consp bound) (multiple-value-call exclusive (same-sort (rational (first bound)) term)))
        (t (multiple-value-call inclusive (same-sort (rational bound) term)))))

(defun lifted-typep (value type)
  "Return whether VALUE, which may be symbolic, is of TYPE."
  (flet ((is-p (object) (typep object type)))
    (cond ((symbolic-value-p value)
           (type-answer value #'is-p type "an argument of typep"))
          ;; Whether it is may depend on what is inside: (cons (eql 1)), (satisfies p).
          ((and (symbolic-run-p) (compound-p value) (consp (sb-ext:typexpand type)))
           (is-p (decided value "an argument of typep")))
          (t (is-p value)))))

(define-lifted typep (value type &optional environment)
  (declare (ignore environment))
  (lifted-typep value (settled type "a type")))

(macrolet ((define (&rest predicates)
             `(progn
                ,@(loop for (name type) in predicates
                        collect `(define-lifted ,name (value)
                                   (if (symbolic-value-p value)
                                       (type-answer value #',name ',type
                                                    ,(format nil "an argument of ~(~a~)" name))
                                       (,name value)))))))
  (define (numberp number) (integerp integer) (realp real) (rationalp rational) (floatp float)
    (complexp complex) (symbolp symbol) (keywordp keyword) (stringp string)
    (simple-string-p simple-string) (characterp character) (consp cons) (listp list) (atom atom)
    (functionp function) (vectorp vector) (arrayp array) (simple-vector-p simple-vector)
    (bit-vector-p bit-vector) (hash-table-p hash-table) (packagep package) (pathnamep pathname)
    (streamp stream) (compiled-function-p compiled-function)))
