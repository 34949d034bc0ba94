;;;; Symbolic arguments of plans.
;;;;
;;;; An argument's type is boolean, integer, (integer LOW HIGH), real, (real LOW HIGH),
;;;; (member OBJECT*) or the name of a sort of the theory, whose elements are keywords.  A guarded
;;;; choice has one proposition an object, of which just one is true.

(in-package #:discrepancy-finder.symbolic-execution)

(defun number-type-p (type name)
  "Return true if TYPE is NAME or a list of it and two rationals or *."
  (or (eq type name)
      (and (consp type) (eq (first type) name) (= (length type) 3)
           (every (lambda (bound) (or (eq bound '*) (rationalp bound))) (rest type))
           (or (eq name 'real) (every (lambda (bound) (or (eq bound '*) (integerp bound)))
                                      (rest type)))
           (not (and (rationalp (second type)) (rationalp (third type))
                     (> (second type) (third type)))))))

(defun named-p (type name)
  "Return true if TYPE is a symbol, in any package, or a list that begins with one, named NAME."
  (let ((operator (if (consp type) (first type) type)))
    (and (symbolp operator) (string= operator name))))

(defun theory-sort-elements (theory name)
  "Return the elements of the sort of THEORY named by the symbol NAME, or NIL if it has none."
  (and theory
       (values (ec:sort-elements theory name))))

(defun numeric-argument-type-p (type)
  "Return true if a symbolic argument of TYPE is a number to Z3, so that its solver needs a logic
with arithmetic."
  (or (number-type-p type 'integer) (number-type-p type 'real)))

(defun make-symbolic-argument (name type theory context)
  "Return a symbolic value of TYPE for the parameter NAME of a plan in THEORY (or NIL), made in
CONTEXT of Z3; the list of the propositions that are true of it; and a function that returns its
concrete value, given a function that returns the value of a term in a model.  Signals
UNKNOWN-ARGUMENT-TYPE."
  (let ((text (format nil "~(~a~)" name)))
    (cond ((equal type 'boolean) (boolean-argument text context))
          ((number-type-p type 'integer) (number-argument text type (z3:integer-sort context)))
          ((number-type-p type 'real)
           (number-argument text (if (consp type) (cons 'rational (rest type)) 'rational)
                            (z3:real-sort context)))
          ((and (consp type) (eq (first type) 'member) (rest type))
           (element-argument text (remove-duplicates (rest type) :from-end t) context))
          ((and (symbolp type) type (theory-sort-elements theory type))
           (element-argument text (theory-sort-elements theory type) context))
          ((and (symbolp type) (named-p type "BOOLEAN")) (boolean-argument text context))
          (t (error 'unknown-argument-type
                    :parameter name :type type
                    :sorts (and theory (mapcar #'ec:sort-name (ec:theory-sorts theory))))))))

(defun boolean-argument (name context)
  (let ((proposition (z3:variable context (format nil "argument ~a" name))))
    (values (make-symbolic-boolean proposition)
            '()
            (lambda (value-of) (funcall (the function value-of) proposition)))))

(defun number-argument (name type sort)
  (let ((term (z3:variable (z3:sort-context sort) (format nil "argument ~a" name) sort)))
    (multiple-value-bind (low high) (type-bounds type)
      (values (make-symbolic-number term type)
              (append (and low (list (z3:less-or-equal low term)))
                      (and high (list (z3:less-or-equal term high))))
              (lambda (value-of) (funcall (the function value-of) term))))))

;;; No pseudo-boolean constraint: the engine for QF_UF does not have them.

(defun exactly-one (propositions)
  "Return a list of propositions that say that just one of PROPOSITIONS is true."
  (cons (z3:disjunction propositions)
        (loop for (one . others) on propositions
              append (loop for other in others
                           collect (z3:disjunction (list (z3:negation one)
                                                         (z3:negation other)))))))

(defun element-argument (name elements context)
  (let ((choices (loop for element in elements
                       for number from 0
                       collect (cons element
                                     (z3:variable context
                                                  (format nil "argument ~a is ~a ~(~s~)" name
                                                          number element))))))
    (flet ((value-in (value-of)
             (car (find-if (lambda (choice) (funcall (the function value-of) (cdr choice)))
                           choices))))
      (if (rest choices)
          (values (make-symbolic-element choices)
                  (exactly-one (mapcar #'cdr choices))
                  #'value-in)
          (values (first elements) '()
                  (lambda (value-of) (declare (ignore value-of)) (first elements)))))))
