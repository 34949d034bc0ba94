;;;; Symbolic values, and the functions that may be given some.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (symbolic-boolean (:constructor make-symbolic-boolean (proposition)) (:copier nil))
  "A truth value that depends on the initial state or on symbolic arguments of the plan."
  (proposition nil :read-only t))

(setf (documentation 'symbolic-boolean-proposition 'function)
      "Return the proposition that a symbolic boolean stands for.")

(defmethod print-object ((value symbolic-boolean) stream)
  (print-unreadable-object (value stream :type t)
    (princ (symbolic-boolean-proposition value) stream)))

(defun symbolic-boolean (proposition)
  "Return the truth value of PROPOSITION: T, NIL or a symbolic boolean."
  (cond ((z3:term-p proposition)
         (when *path* (setf (path-symbolic-p *path*) t))
         (make-symbolic-boolean proposition))
        (t proposition)))

(defun symbolic-element (choices)
  "Return one of the objects of CHOICES, a list of (object . proposition): which, is decided."
  (if (rest choices)
      (decide *path* "an element" choices :exhaustive t)
      (car (first choices))))

(defun truth (value description)
  "Return VALUE, or T or NIL by a decision if it is symbolic."
  (if (symbolic-boolean-p value)
      (let ((proposition (symbolic-boolean-proposition value)))
        (decide *path* description
                (list (cons t proposition) (cons nil (z3:negation proposition)))
                :exhaustive t))
      value))

(defclass interpreted-function (sb-mop:funcallable-standard-object)
  ((name :initarg :name :initform nil :reader interpreted-function-name))
  (:metaclass sb-mop:funcallable-standard-class)
  (:documentation "A function whose body the evaluator runs; it may be given symbolic values."))

(defmethod print-object ((function interpreted-function) stream)
  (print-unreadable-object (function stream :type t :identity t)
    (princ (interpreted-function-name function) stream)))

(defun make-interpreted-function (name function)
  (let ((instance (make-instance 'interpreted-function :name name)))
    (sb-mop:set-funcallable-instance-function instance function)
    instance))

(defun holds-symbolic-p (value)
  "Return true if VALUE is a symbolic boolean or a list structure with one in it.  Only so many
conses are looked at: the list of an &rest parameter is short, and others hold none."
  (let ((budget 10000))
    (labels ((look (value)
               (loop
                 (cond ((symbolic-boolean-p value) (return t))
                       ((or (atom value) (minusp (decf budget))) (return nil))
                       ((look (car value)) (return t))
                       (t (setf value (cdr value)))))))
      (look value))))

(defun decided (value description)
  "Return VALUE with every symbolic boolean in it decided, for code that cannot handle one: in
conses, which the list of an &rest parameter may be, and in what an interpreted function returns."
  (cond ((symbolic-boolean-p value) (truth value description))
        ((typep value 'interpreted-function)
         (lambda (&rest arguments)
           (let ((values (multiple-value-list (apply value arguments))))
             (values-list (cons (truth (first values) description) (rest values))))))
        ((and (consp value) (holds-symbolic-p value))
         (cons (decided (car value) description) (decided (cdr value) description)))
        (t value)))
