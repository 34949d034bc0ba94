;;;; Tests of the layer z3: sorts, terms of numbers and enumerations, their values in models.

(in-package #:discrepancy-finder.tests)

(in-suite z3)

(defmacro signals-sort-error (text &body body)
  "Check that BODY signals a Z3-ERROR that TEXT is the report of."
  `(is (equal '(:sort-error ,text)
              (handler-case (progn ,@body :none)
                (z3:z3-error (condition)
                  (list (z3:z3-error-code condition) (princ-to-string condition)))))))

(defmacro with-terms ((context &rest bindings) &body body)
  "Evaluate BODY with each of BINDINGS, (variable kind), bound to a variable of that name and kind:
:INTEGER, :REAL, :BOOLEAN or :COLOR, an enumeration of red, green and blue."
  `(z3:with-context (,context)
     (let ,(loop for (variable kind) in bindings
                 collect `(,variable
                           (z3:variable ,context ,(string-downcase variable)
                                        ,(ecase kind
                                           (:integer `(z3:integer-sort ,context))
                                           (:real `(z3:real-sort ,context))
                                           (:boolean `(z3:boolean-sort ,context))
                                           (:color `(z3:enumeration-sort
                                                     ,context "color"
                                                     '("red" "green" "blue")))))))
       ,@body)))

(defun text-of (argument)
  "Return the SMT-LIB text of a term, a constant as it is."
  (if (z3:term-p argument)
      (let ((text (prin1-to-string argument)))
        (subseq text (1+ (position #\Space text)) (1- (length text))))
      argument))

;;; Sorts

(test sorts-of-terms
  (z3:with-context (context)
    (let ((color (z3:enumeration-sort context "color" '("red" "green"))))
      (is (eq (z3:integer-sort context) (z3:integer-sort context)))
      (is (eq color (z3:enumeration-sort context "color" '("red" "green"))))
      (is (eq color (z3:enumeration-sort context "color")))
      (is (equal '(:boolean :integer :real :enumeration)
                 (mapcar #'z3:sort-kind
                         (list (z3:boolean-sort context) (z3:integer-sort context)
                               (z3:real-sort context) color))))
      (is (equal '("Bool" "Int" "Real" "color")
                 (mapcar #'z3:sort-name
                         (list (z3:boolean-sort context) (z3:integer-sort context)
                               (z3:real-sort context) color))))
      (is (equal '("red" "green") (z3:sort-elements color)))
      (is (eq context (z3:sort-context color)))
      (is (search "color of red, green" (prin1-to-string color)))
      (is (eq color (z3:term-sort (z3:variable context "c" color))))
      (is (eq (z3:boolean-sort context) (z3:term-sort (z3:variable context "p"))))
      (is (not (z3:term-equal (z3:variable context "x" (z3:integer-sort context))
                              (z3:variable context "x" (z3:real-sort context)))))
      (signals-z3-error :invalid-argument (z3:enumeration-sort context "color" '("red")))
      (signals-z3-error :invalid-argument (z3:enumeration-sort context "unknown"))
      (signals-z3-error :invalid-argument (z3:enumeration-sort context "none" '()))
      (signals-z3-error :invalid-argument (z3:enumeration-sort context "twice" '("a" "a")))
      (signals-z3-error :invalid-argument (z3:enumeration-sort context "symbols" '(a)))
      (z3:with-context (other)
        (signals-z3-error :other-context (z3:variable other "c" color))))))

(test sorts-of-closed-contexts
  (let* ((context (z3:make-context)) (real (z3:real-sort context)))
    (z3:close-context context)
    (is (search "Real" (prin1-to-string real)))
    (signals-z3-error :closed-context (z3:variable context "x" real))
    (signals-z3-error :closed-context (z3:constant-term 1 real))
    (signals-z3-error :closed-context (z3:integer-sort context))))

;;; Folding

(test arithmetic-folds-constants
  (is (eql 6 (z3:sum '(1 2 3))))
  (is (eql 0 (z3:sum '())))
  (is (eql 1 (z3:sum '(1/3 2/3))))
  (is (eql 1 (z3:product '())))
  (is (eql (expt 10 60) (z3:product (list (expt 10 30) (expt 10 30)))))
  (is (eql -1/2 (z3:difference 1/2 1)))
  (is (eql 7/2 (z3:quotient 7/2 1)))
  (is (eql 14 (z3:quotient 7 1/2)))
  (is (equal '(3 -4 -3 4) (list (z3:quotient 7 2) (z3:quotient -7 2) (z3:quotient 7 -2)
                                (z3:quotient -7 -2))))
  (is (equal '(1 1 1 1) (list (z3:modulo 7 2) (z3:modulo -7 2) (z3:modulo 7 -2)
                              (z3:modulo -7 -2))))
  (is (eq t (z3:less 1/3 1/2)))
  (is (eq nil (z3:less 1 1)))
  (is (eq t (z3:less-or-equal 1 1)))
  (is (eql 3 (z3:integer-to-real 3)))
  (is (eql -4 (z3:real-to-integer -7/2)))
  (is (eq t (z3:integral 4)))
  (is (eq nil (z3:integral 7/2)))
  (signals-z3-error :division-by-zero (z3:quotient 1 0))
  (signals-z3-error :division-by-zero (z3:modulo 1 0))
  (with-terms (context (i :integer) (x :real))
    (is (equal "(+ i 6)" (text-of (z3:sum (list 1 2 i 3)))))
    (is (eq i (z3:sum (list 1 i -1))))
    (is (equal "(* 6 i)" (text-of (z3:product (list 2 i 3)))))
    (is (eql 0 (z3:product (list i 0))))
    (is (eq x (z3:product (list 2 x 1/2))))
    (is (eq i (z3:difference i 0)))
    (is (eql 0 (z3:difference i i)))
    (is (eq x (z3:quotient x 1)))
    (is (eq nil (z3:less i i)))
    (is (eq t (z3:less-or-equal x x)))
    (is (eql 7/2 (z3:quotient (z3:constant-term 7 (z3:real-sort context)) 2)))
    (is (equal "(div i 0)" (text-of (z3:quotient i 0))))))

(test equality-folds-constants
  (is (eq t (z3:equals 1 1)))
  (is (eq nil (z3:equals 1 2)))
  (is (eq t (z3:equals "red" "red")))
  (is (eq nil (z3:equals "red" "green")))
  (is (eq t (z3:equals nil nil)))
  (is (eq t (z3:distinct '())))
  (is (eq t (z3:distinct '(1 2 1/2))))
  (is (eq nil (z3:distinct '(1 2 1))))
  (is (eql 1 (z3:if-then-else t 1 2)))
  (is (equal "b" (z3:if-then-else nil "a" "b")))
  (with-terms (context (p :boolean) (i :integer) (c :color) (d :color))
    (let ((color (z3:term-sort c)))
      (is (eq p (z3:equals p t)))
      (is (equal "(not p)" (text-of (z3:equals nil p))))
      (is (eq t (z3:equals c c)))
      (is (equal "(= c red)" (text-of (z3:equals c "red"))))
      (is (eq t (z3:equals (z3:constant-term "red" color) "red")))
      (is (eq nil (z3:equals (z3:constant-term "red" color) (z3:constant-term "blue" color))))
      (is (eq nil (z3:distinct (list c d c))))
      (is (eq nil (z3:distinct (list c "red" "red"))))
      (is (equal "(distinct c d red)" (text-of (z3:distinct (list c d "red")))))
      (is (equal "(not (= c d))" (text-of (z3:distinct (list c d)))))
      (is (eq p (z3:if-then-else p t nil)))
      (is (equal "(not p)" (text-of (z3:if-then-else p nil t))))
      (is (eq i (z3:if-then-else p i i)))
      (is (equal "(ite p 1 2)" (text-of (z3:if-then-else p 1 2))))
      (is (equal "(ite p 1.0 (/ 1.0 2.0))" (text-of (z3:if-then-else p 1 1/2))))
      (is (equal "(ite p 1.0 2.0)" (text-of (z3:if-then-else p 1 2 (z3:real-sort context)))))
      (is (equal "(ite p c red)" (text-of (z3:if-then-else p c "red"))))
      (is (equal "(ite p red blue)" (text-of (z3:if-then-else p "red" "blue" color)))))))

(test counting-folds-constants
  (is (eq t (z3:at-most '(t nil) 1)))
  (is (eq nil (z3:at-most '(t t) 1)))
  (is (eq nil (z3:at-most '() -1)))
  (is (eq t (z3:at-least '(t t nil) 2)))
  (is (eq nil (z3:at-least '(t nil) 2)))
  (with-terms (context (p :boolean) (q :boolean) (r :boolean))
    (is (equal "(not p)" (text-of (z3:at-most (list p t) 1))))
    (is (equal "((_ at-most 1) p q)" (text-of (z3:at-most (list p nil q) 1))))
    (is (equal "(or p q)" (text-of (z3:at-least (list p q) 1))))
    (is (equal "(and p q)" (text-of (z3:at-least (list p t q) 3))))
    (is (equal "((_ at-least 2) p q r)" (text-of (z3:at-least (list p q r) 2))))))

;;; Errors

(test arguments-of-the-wrong-sort
  (with-terms (context (p :boolean) (i :integer) (x :real) (c :color))
    (signals-sort-error "Z3: sum is given x, a real, where an integer is needed."
      (z3:sum (list i x)))
    (signals-sort-error "Z3: sum is given 1/2 where an integer is needed." (z3:sum (list i 1/2)))
    (signals-sort-error "Z3: sum is given 0.5, which is not exact, where a real is needed."
      (z3:sum (list x 0.5)))
    (signals-sort-error "Z3: sum is given :A, which is no term, where a number is needed."
      (z3:sum (list :a)))
    (signals-sort-error "Z3: product is given p, a truth value, where a number is needed."
      (z3:product (list p 2)))
    (signals-sort-error "Z3: product is given the truth value T where a number is needed."
      (z3:product (list 2 t)))
    (signals-sort-error "Z3: modulo is given x, a real, where an integer is needed."
      (z3:modulo x 2))
    (signals-sort-error "Z3: less is given c, an element of \"color\", where a number is needed."
      (z3:less c c))
    (signals-sort-error "Z3: equals is given \"pink\" where an element of \"color\" is needed."
      (z3:equals c "pink"))
    (signals-sort-error "Z3: equals is given the truth value NIL where a number is needed."
      (z3:equals 1 nil))
    (signals-sort-error
        "Z3: distinct is given c, an element of \"color\", where a truth value is needed."
      (z3:distinct (list p c)))
    (signals-sort-error "Z3: if-then-else is given i, an integer, where a truth value is needed."
      (z3:if-then-else i 1 2))
    (signals-sort-error "Z3: if-then-else is given \"a\" and \"b\", and cannot tell their sort."
      (z3:if-then-else p "a" "b"))
    (signals-sort-error "Z3: integer-to-real is given x, a real, where an integer is needed."
      (z3:integer-to-real x))
    (signals-sort-error "Z3: real-to-integer is given i, an integer, where a real is needed."
      (z3:real-to-integer i))
    (signals-sort-error "Z3: conjunction is given i, an integer, where a truth value is needed."
      (z3:conjunction (list i)))
    (signals-sort-error "Z3: negation is given i, an integer, where a truth value is needed."
      (z3:negation i))
    (signals-sort-error "Z3: implication is given i, an integer, where a truth value is needed."
      (z3:implication p i))
    (signals-sort-error "Z3: equivalence is given i, an integer, where a truth value is needed."
      (z3:equivalence i p))
    (signals-sort-error "Z3: at-most is given i, an integer, where a truth value is needed."
      (z3:at-most (list i) 0))
    (signals-sort-error "Z3: constant-term is given 1/2 where an integer is needed."
      (z3:constant-term 1/2 (z3:integer-sort context)))
    (z3:with-solver (solver context)
      (signals-sort-error "Z3: solver-assert is given i, an integer, where a truth value is needed."
        (z3:solver-assert solver i))
      (signals-sort-error "Z3: check is given i, an integer, where a truth value is needed."
        (z3:check solver (list i)))
      (is (eq :sat (z3:check solver (list p)))))
    (z3:with-context (other)
      (let ((j (z3:variable other "i" (z3:integer-sort other))))
        (signals-z3-error :other-context (z3:sum (list i j)))
        (signals-z3-error :other-context (z3:equals i j))
        (signals-z3-error :other-context (z3:if-then-else p j 1))
        (signals-z3-error :other-context (z3:at-most (list p (z3:less j 1)) 1))))))

;;; Values

(test values-of-every-sort
  (with-terms (context (p :boolean) (i :integer) (j :integer) (x :real) (c :color) (d :color))
    (z3:with-solver (solver context :logic nil)
      (let ((large (expt 10 40)))
        (z3:solver-assert solver (z3:equals i (- large)))
        (z3:solver-assert solver (z3:equals (z3:product (list 3 x)) large))
        (z3:solver-assert solver (z3:distinct (list c d "red")))
        (z3:solver-assert solver (z3:equals d "green"))
        (z3:solver-assert solver (z3:equivalence p (z3:less j i)))
        (z3:solver-assert solver (z3:equals j (z3:sum (list i 1))))
        (is (eq :sat (z3:check solver)))
        (is (eql (- large) (z3:model-value solver i)))
        (is (eql (/ large 3) (z3:model-value solver x)))
        (is (equal "blue" (z3:model-value solver c)))
        (is (eq nil (z3:model-value solver p)))
        (is (eql (- 1 (* 2 large)) (z3:model-value solver (z3:sum (list i j)))))
        (is (equal "green" (z3:model-value solver (z3:if-then-else p c d))))
        (is (equal "red" (z3:model-value solver "red")))
        (is (eql 1/2 (z3:model-value solver 1/2)))
        (is (equal `(("c" . "blue") ("d" . "green") ("i" . ,(- large)) ("j" . ,(- 1 large))
                     ("p" . nil) ("x" . ,(/ large 3)))
                   (z3:model-values solver)))))))

(test values-that-the-model-leaves-open
  (with-terms (context (p :boolean) (i :integer) (x :real) (c :color))
    (z3:with-solver (solver context :logic nil)
      (is (eq :sat (z3:check solver)))
      (is (equal '() (z3:model-values solver)))
      (dolist (term (list p i x c (z3:quotient i 0) (z3:quotient x 0) (z3:modulo i 0)))
        (let ((value (z3:model-value solver term)))
          (is (typep value '(or boolean rational string)))
          (is (equal value (z3:model-value solver term))))))))

(test irrational-values
  (with-terms (context (x :real))
    (z3:with-solver (solver context :logic "QF_NRA")
      (z3:solver-assert solver (z3:equals (z3:product (list x x)) 2))
      (z3:solver-assert solver (z3:less 0 x))
      (is (eq :sat (z3:check solver)))
      (let ((root (z3:model-value solver x)))
        (is (z3:algebraic-number-p root))
        (is (< (expt (z3:algebraic-number-lower root) 2) 2
               (expt (z3:algebraic-number-upper root) 2)))
        (is (<= (- (z3:algebraic-number-upper root) (z3:algebraic-number-lower root))
                (expt 10 -20)))
        (is (search "1.414214" (prin1-to-string root)))
        (is (search "root-obj" (z3:algebraic-number-text root)))))))

(test odd-names-of-elements-and-numbers
  (z3:with-context (context)
    (let* ((names (list "" " " "a b" "|" "a\\b" "λ" "日本語" (string (code-char 0)) "true"
                        "x!0"))
           (sort (z3:enumeration-sort context "a sort | of λ" names))
           (variables (loop for name in names
                            collect (z3:variable context name sort))))
      (is (equal names (mapcar #'z3:term-name variables)))
      (z3:with-solver (solver context :logic nil)
        (loop for variable in variables
              for name in (reverse names)
              do (z3:solver-assert solver (z3:equals variable name)))
        (is (eq :sat (z3:check solver)))
        (is (equal (reverse names)
                   (mapcar (lambda (variable) (z3:model-value solver variable)) variables)))))))

;;; Folding and Z3 agree

(defun random-choice (list state)
  (nth (random (length list) state) list))

(defun random-expression (kind depth state)
  "Return a tree of operators and constants of KIND."
  (flet ((sub (kind) (random-expression kind (1- depth) state)))
    (if (zerop depth)
        (ecase kind
          (:integer (- (random 9 state) 4))
          (:real (/ (- (random 9 state) 4) (1+ (random 3 state))))
          (:boolean (zerop (random 2 state))))
        (ecase kind
          (:integer
           (ecase (random 6 state)
             (0 `(sum ,(sub :integer) ,(sub :integer) ,(sub :integer)))
             (1 `(product ,(sub :integer) ,(sub :integer)))
             (2 `(difference ,(sub :integer) ,(sub :integer)))
             (3 (list (random-choice '(quotient modulo) state)
                      (sub :integer) (random-choice '(-3 -2 -1 1 2 3) state)))
             (4 `(if-then-else ,(sub :boolean) ,(sub :integer) ,(sub :integer)))
             (5 `(real-to-integer ,(sub :real)))))
          (:real
           (ecase (random 5 state)
             (0 `(sum ,(sub :real) ,(sub :real)))
             (1 `(product ,(sub :real) ,(sub :real)))
             (2 `(quotient ,(sub :real) ,(random-choice '(-3/2 -1/2 1/2 5/2) state)))
             (3 `(if-then-else ,(sub :boolean) ,(sub :real) ,(sub :real)))
             (4 `(integer-to-real ,(sub :integer)))))
          (:boolean
           (ecase (random 7 state)
             (0 `(less ,(sub :real) ,(sub :real)))
             (1 `(less-or-equal ,(sub :integer) ,(sub :integer)))
             (2 `(equals ,(sub :integer) ,(sub :integer)))
             (3 `(distinct ,(sub :integer) ,(sub :integer) ,(sub :integer)))
             (4 `(integral ,(sub :real)))
             (5 `(at-most ,(sub :boolean) ,(sub :boolean) ,(sub :boolean)))
             (6 `(at-least ,(sub :boolean) ,(sub :boolean) ,(sub :boolean)))))))))

(defun kind-of-operand (operator position)
  (case operator
    ((real-to-integer integral less) :real)
    ((integer-to-real less-or-equal equals distinct quotient-of-integers modulo) :integer)
    ((at-most at-least) :boolean)
    (if-then-else (if (zerop position) :boolean nil))))

(defun build-expression (expression kind leaf)
  "Build EXPRESSION of KIND by the functions of the layer; LEAF makes the arguments."
  (if (atom expression)
      (funcall leaf expression kind)
      (destructuring-bind (operator . operands) expression
        (let ((arguments (loop for operand in operands
                               for position from 0
                               collect (build-expression operand
                                                         (or (kind-of-operand operator position)
                                                             kind)
                                                         leaf))))
          (ecase operator
            (sum (z3:sum arguments))
            (product (z3:product arguments))
            (distinct (z3:distinct arguments))
            (at-most (z3:at-most arguments 1))
            (at-least (z3:at-least arguments 2))
            (quotient (apply #'z3:quotient arguments))
            ((difference modulo less less-or-equal equals if-then-else real-to-integer
              integer-to-real integral)
             (apply (find-symbol (symbol-name operator) '#:discrepancy-finder.z3) arguments)))))))

(test folding-agrees-with-z3
  "A quotient of two Lisp integers is one of integers, so the leaves of reals are terms here."
  (let ((state (sb-ext:seed-random-state 4)))
    (dotimes (i 40)
      (z3:with-context (context)
        (z3:with-solver (solver context :logic nil)
          (let* ((count 0) (unfolded '()) (expected '()))
            (flet ((sort-of (kind)
                     (ecase kind
                       (:integer (z3:integer-sort context))
                       (:real (z3:real-sort context))
                       (:boolean (z3:boolean-sort context)))))
              (dotimes (j 10)
                (let* ((kind (random-choice '(:integer :real :boolean) state))
                       (expression (random-expression kind (1+ (random 3 state)) state)))
                  (push (build-expression expression kind
                                          (lambda (constant kind)
                                            (if (eq kind :real)
                                                (z3:constant-term constant (sort-of kind))
                                                constant)))
                        expected)
                  (push (build-expression
                         expression kind
                         (lambda (constant kind)
                           (let ((variable (z3:variable context (format nil "~d" (incf count))
                                                        (sort-of kind))))
                             (z3:solver-assert solver (z3:equals variable constant))
                             variable)))
                        unfolded))))
            (is (eq :sat (z3:check solver)))
            (loop for term in unfolded
                  for value in expected
                  do (is (equal (z3:model-value solver value)
                                (z3:model-value solver term))))))))))
