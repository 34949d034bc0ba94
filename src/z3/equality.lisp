;;;; Equality and choice, for terms of every sort.

(in-package #:discrepancy-finder.z3)

(defun equals (a b)
  "Return the proposition that the terms or constants A and B, of one sort, are equal.  Signals
Z3-ERROR."
  (let ((sort (common-sort 'equals (list a b) :any))
        (left (constant-of a)) (right (constant-of b)))
    (cond ((not (or (term-p left) (term-p right))) (equal left right))
          ((eq (sort-kind sort) :boolean) (equivalence a b))
          ((term-equal a b) t)
          (t (let ((left (argument-pointer a sort)) (right (argument-pointer b sort)))
               (making-term (pointer (sort-context sort))
                 (z3-mk-eq pointer left right)))))))

(defun distinct (arguments)
  "Return the proposition that no two of the list ARGUMENTS, terms or constants of one sort, are
equal.  Signals Z3-ERROR."
  (let ((sort (common-sort 'distinct arguments :any))
        (constants (mapcar #'constant-of arguments)))
    (cond ((loop for (one . others) on constants
                 thereis (member one others :test #'term-equal))
           nil)
          ((notany #'term-p constants) t)
          ((null (rest arguments)) t)
          ((null (cddr arguments)) (negation (equals (first arguments) (second arguments))))
          (t (let ((handles (argument-pointers arguments sort)))
               (declare (type handles handles))
               (sb-sys:with-pinned-objects (handles)
                 (making-term (pointer (sort-context sort))
                   (z3-mk-distinct pointer (length handles) (sb-sys:vector-sap handles)))))))))

(defun choose-proposition (condition then else)
  (cond ((eq then t) (disjunction (list condition else)))
        ((null then) (conjunction (list (negation condition) else)))
        ((eq else t) (disjunction (list (negation condition) then)))
        ((null else) (conjunction (list condition then)))))

(defun sort-of-constants (then else context)
  "Return the sort in CONTEXT that the constants THEN and ELSE have.  Signal Z3-ERROR if they do not
tell."
  (etypecase then
    (boolean (boolean-sort context))
    (rational (if (and (integerp then) (integerp else))
                  (integer-sort context)
                  (real-sort context)))
    (string (misuse :sort-error "if-then-else is given ~s and ~s, and cannot tell their sort"
                    then else))))

(defun if-then-else (condition then else &optional sort)
  "Return the term that is THEN where the proposition CONDITION is true, ELSE where it is not.  They
are terms or constants of one sort; of two constants it is SORT or else integers if both are, reals
for other numbers.  Signals Z3-ERROR."
  (check-type condition proposition)
  (when (term-p condition)
    (proposition-pointer 'if-then-else condition (term-context condition)))
  (let ((common (common-sort 'if-then-else (list then else) :any)))
    (when sort
      (dolist (argument (list then else))
        (unless (if (term-p argument) (eq (term-sort argument) sort) (fits-p argument sort))
          (wrong-sort 'if-then-else argument (sort-text sort)))))
    (cond ((eq condition t) then)
          ((null condition) else)
          ((term-equal then else) then)
          (t (let* ((context (term-context condition))
                    (sort (or sort common (sort-of-constants then else context))))
               (or (and (eq (sort-kind sort) :boolean)
                        (or (typep then 'boolean) (typep else 'boolean))
                        (choose-proposition condition then else))
                   (let ((test (live-pointer condition context))
                         (left (argument-pointer then sort)) (right (argument-pointer else sort)))
                     (unless (eq (sort-context sort) context)
                       (misuse :other-context "the term belongs to another context"))
                     (making-term (pointer context nil sort)
                       (z3-mk-ite pointer test left right)))))))))
