;;;; Connectives: propositions made of propositions.
;;;;
;;;; (conjunction (list t p)) is p; of constants alone a constant is made, without Z3.

(in-package #:discrepancy-finder.z3)

(defun negation (p)
  "Return the negation of the proposition P; that of a negation is what it negates."
  (check-type p proposition)
  (if (term-p p)
      (let* ((context (term-context p)) (address (proposition-pointer 'negation p context)))
        (if (term-p (term-operand p))
            (term-operand p)
            (making-term (pointer context p)
              (z3-mk-not pointer address))))
      (not p)))

(defmacro define-connective (name maker neutral documentation)
  "Define NAME to join a list of propositions by MAKER, of which the constant NEUTRAL is the neutral
element and its negation the absorbing one."
  `(defun ,name (propositions)
     ,documentation
     (let ((count 0) (first nil))
       (declare (type (unsigned-byte 32) count))
       (dolist (proposition propositions)
         (cond ((eq proposition ,neutral))
               ((eq proposition ,(not neutral)) (return-from ,name ,(not neutral)))
               (t (check-type proposition term)
                  (unless (boolean-p proposition)
                    (wrong-sort ',name proposition (kind-text :boolean)))
                  (when (zerop count) (setf first proposition))
                  (incf count))))
       (case count
         (0 ,neutral)
         (1 first)
         (t (let ((context (term-context first)) (position 0)
                  (terms (make-array count :element-type '(unsigned-byte 64))))
              (declare (type (unsigned-byte 32) position))
              (dolist (proposition propositions)
                (when (term-p proposition)
                  (setf (aref terms position) (live-pointer proposition context))
                  (incf position)))
              (sb-sys:with-pinned-objects (terms)
                (making-term (pointer context)
                  (,maker pointer count (sb-sys:vector-sap terms))))))))))

(define-connective conjunction z3-mk-and t
  "Return the conjunction of the list PROPOSITIONS: T of the empty list, the term itself of one
term.  Signals Z3-ERROR if terms of different contexts meet.")

(define-connective disjunction z3-mk-or nil
  "Return the disjunction of the list PROPOSITIONS: NIL of the empty list, the term itself of one
term.  Signals Z3-ERROR if terms of different contexts meet.")

(defun implication (p q)
  "Return the proposition that P implies Q.  Signals Z3-ERROR if terms of different contexts meet."
  (check-type p proposition)
  (check-type q proposition)
  (cond ((eq p t) q)
        ((or (null p) (eq q t)) t)
        ((null q) (negation p))
        (t (let* ((context (term-context p))
                  (left (proposition-pointer 'implication p context))
                  (right (proposition-pointer 'implication q context)))
             (making-term (pointer context)
               (z3-mk-implies pointer left right))))))

(defun equivalence (p q)
  "Return the proposition that P and Q have the same truth value.  Signals Z3-ERROR if terms of
different contexts meet."
  (check-type p proposition)
  (check-type q proposition)
  (cond ((eq p t) q)
        ((eq q t) p)
        ((null p) (negation q))
        ((null q) (negation p))
        (t (let* ((context (term-context p))
                  (left (proposition-pointer 'equivalence p context))
                  (right (proposition-pointer 'equivalence q context)))
             (making-term (pointer context)
               (z3-mk-iff pointer left right))))))

;;; Counting

(defun split-constants (operation propositions)
  "Return the terms among the list PROPOSITIONS and the number of Ts."
  (let ((terms '()) (count 0))
    (dolist (proposition propositions (values (nreverse terms) count))
      (cond ((eq proposition t) (incf count))
            ((term-p proposition)
             (proposition-pointer operation proposition (term-context proposition))
             (push proposition terms))
            (proposition (wrong-sort operation proposition (kind-text :boolean)))))))

(defun at-most (propositions count)
  "Return the proposition that at most COUNT, an integer, of the list PROPOSITIONS are true.  One
that stands twice counts twice.  Signals Z3-ERROR."
  (check-type count integer)
  (multiple-value-bind (terms true) (split-constants 'at-most propositions)
    (let ((bound (- count true)))
      (cond ((minusp bound) nil)
            ((<= (length terms) bound) t)
            ((zerop bound) (conjunction (mapcar #'negation terms)))
            (t (let ((handles (argument-pointers terms (term-sort (first terms)))))
                 (declare (type handles handles))
                 (sb-sys:with-pinned-objects (handles)
                   (making-term (pointer (term-context (first terms)))
                     (z3-mk-atmost pointer (length handles) (sb-sys:vector-sap handles)
                                   bound)))))))))

(defun at-least (propositions count)
  "Return the proposition that at least COUNT, an integer, of the list PROPOSITIONS are true.  One
that stands twice counts twice.  Signals Z3-ERROR."
  (check-type count integer)
  (multiple-value-bind (terms true) (split-constants 'at-least propositions)
    (let ((bound (- count true)))
      (cond ((<= bound 0) t)
            ((< (length terms) bound) nil)
            ((= bound 1) (disjunction terms))
            ((= bound (length terms)) (conjunction terms))
            (t (let ((handles (argument-pointers terms (term-sort (first terms)))))
                 (declare (type handles handles))
                 (sb-sys:with-pinned-objects (handles)
                   (making-term (pointer (term-context (first terms)))
                     (z3-mk-atleast pointer (length handles) (sb-sys:vector-sap handles)
                                    bound)))))))))
