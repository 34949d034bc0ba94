;;;; Symbolic values: what depends on the initial state or on symbolic arguments of the plan.
;;;;
;;;; There are three kinds.  A SYMBOLIC-BOOLEAN is T where its proposition is true, else NIL.  A
;;;; SYMBOLIC-NUMBER is what its term of Z3 is.  A SYMBOLIC-ELEMENT is a guarded choice: one of a
;;;; few Lisp objects, each with the proposition under which it is the value; on every path just
;;;; one of these is true.
;;;;
;;;; A value is made by SYMBOLIC-BOOLEAN, SYMBOLIC-NUMBER or SYMBOLIC-ELEMENT, which return a plain
;;;; Lisp object where that says it all.  Symbolic values belong to the run in which they are made.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (symbolic-value (:constructor nil) (:copier nil))
  "PATH is the path on which the value was decided last, KNOWN what it is there."
  (path nil)
  (known nil))

(defstruct (symbolic-boolean (:include symbolic-value)
                             (:constructor make-symbolic-boolean (proposition))
                             (:copier nil))
  "A truth value that depends on the initial state or on symbolic arguments of the plan."
  (proposition nil :read-only t))

(defstruct (symbolic-number (:include symbolic-value)
                            (:constructor make-symbolic-number (term type))
                            (:copier nil))
  "A number that is not known: TERM is a term of Z3, of an integer or a real, TYPE a type specifier
of Common Lisp for it, such as (integer 0 3) or rational."
  (term nil :read-only t)
  (type 'rational :read-only t))

(defstruct (symbolic-element (:include symbolic-value)
                             (:constructor make-symbolic-element (choices))
                             (:copier nil))
  "One of several Lisp objects: CHOICES is a list of (object . proposition), of which exactly one is
true; no two objects are EQL."
  (choices '() :type list :read-only t))

(setf (documentation 'symbolic-value-p 'function)
      "Return true if the argument is a symbolic value."
      (documentation 'symbolic-boolean-proposition 'function)
      "Return the proposition that a symbolic boolean stands for."
      (documentation 'symbolic-number-term 'function)
      "Return the term of Z3 that a symbolic number stands for."
      (documentation 'symbolic-number-type 'function)
      "Return the type, a type specifier, of a symbolic number."
      (documentation 'symbolic-element-choices 'function)
      "Return the choices of a symbolic element: a list of (object . proposition).")

(declaim (inline known-p))
(defun known-p (value)
  "Return true if the symbolic VALUE was decided on the path of the run."
  (let ((path (symbolic-value-path value)))
    (and path (eq path *path*))))

(defvar *show-decided* nil
  "True if symbolic values that were decided are printed as what they are.  The texts of decisions
must not depend on that: a replay may know it earlier or later.")

(defmethod print-object ((value symbolic-value) stream)
  (if (and *show-decided* (known-p value))
      (print-object (symbolic-value-known value) stream)
      (format stream "#<symbolic ~a>" (symbolic-text value))))

(defun symbolic-text (value)
  "Return what the symbolic VALUE is, as a text."
  (etypecase value
    (symbolic-boolean (one-line (symbolic-boolean-proposition value)))
    (symbolic-number (one-line (symbolic-number-term value)))
    (symbolic-element (format nil "~{~(~s~)~^ or ~}"
                              (mapcar #'car (symbolic-element-choices value))))))

(defun one-line (term)
  "Return the text of TERM in one line."
  (if (z3:term-p term)
      (let ((text (substitute #\Space #\Newline (z3:term-text term))))
        (loop for position = (search "  " text)
              while position
              do (setf text (concatenate 'string (subseq text 0 position)
                                         (subseq text (1+ position)))))
        text)
      (princ-to-string term)))

(defun meet-symbolic (value)
  "Return VALUE, a symbolic value that was made on the path."
  (when *path*
    (setf (path-symbolic-p *path*) t))
  value)

(defun symbolic-boolean (proposition)
  "Return the truth value of PROPOSITION: T, NIL or a symbolic boolean."
  (if (z3:term-p proposition)
      (meet-symbolic (make-symbolic-boolean proposition))
      proposition))

(defun symbolic-number (term type)
  "Return the number TERM, which is of TYPE: a number or a symbolic one."
  (if (z3:term-p term)
      (meet-symbolic (make-symbolic-number term type))
      term))

(defun merged-choices (choices)
  "Return CHOICES, (object . proposition), with EQL objects made one and impossible ones left out."
  (let ((merged '()))
    (loop for (object . proposition) in choices
          when proposition
            do (let ((known (assoc object merged)))
                 (if known
                     (push proposition (cdr known))
                     (push (list object proposition) merged))))
    (loop for (object . propositions) in (nreverse merged)
          collect (cons object (z3:disjunction (nreverse propositions))))))

(defun symbolic-element (choices)
  "Return the symbolic element with CHOICES, a list of (object . proposition), of which exactly one
is true; or the only object.  A choice between T and NIL is a symbolic boolean."
  (let ((choices (merged-choices choices)))
    (cond ((null (rest choices)) (car (first choices)))
          ((rassoc t choices) (car (rassoc t choices)))
          ((and (null (cddr choices)) (assoc t choices) (assoc nil choices))
           (symbolic-boolean (cdr (assoc t choices))))
          (t (meet-symbolic (make-symbolic-element choices))))))

(declaim (inline current))
(defun current (value)
  "Return VALUE, or what it is if it is symbolic and was decided."
  (if (and (symbolic-value-p value) (known-p value))
      (symbolic-value-known value)
      value))

(defun choices-of (value)
  "Return VALUE, symbolic but no number, or any Lisp object, as a list of (object . proposition)."
  (let ((value (current value)))
    (typecase value
      (symbolic-element (remaining-choices value))
      (symbolic-boolean (let ((proposition (symbolic-boolean-proposition value)))
                          (list (cons t proposition) (cons nil (z3:negation proposition)))))
      (t (list (cons value t))))))

(defun truth-proposition (value)
  "Return the proposition that VALUE, symbolic or not, is not NIL."
  (let ((value (current value)))
    (typecase value
      (symbolic-boolean (symbolic-boolean-proposition value))
      (symbolic-element (let ((false (assoc nil (choices-of value))))
                          (if false (z3:negation (cdr false)) t)))
      (t (and value t)))))

(declaim (inline symbolic-run-p))
(defun symbolic-run-p ()
  "Return true if there may be symbolic values."
  (let ((path *path*))
    (and path (path-symbolic-p path))))
