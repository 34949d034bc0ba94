;;;; Tests of the layer z3: export to SMT-LIB, read by another solver.

(in-package #:discrepancy-finder.tests)

(in-suite z3)

(test solver-text
  (with-z3 (context solver)
    (z3:solver-assert solver (z3:disjunction (list (z3:variable context "holds (box r1) 0")
                                                   (z3:variable context "λ"))))
    (is (string= "(set-logic QF_UF)
(declare-fun |holds (box r1) 0| () Bool)
(declare-fun |λ| () Bool)
(assert (or |holds (box r1) 0| |λ|))
(check-sat)
"
                 (z3:solver-smt-lib solver)))))

(test text-of-all-sorts
  (with-terms (context (i :integer) (j :integer) (x :real) (c :color) (p :boolean))
    (z3:with-solver (solver context :logic nil)
      (z3:solver-assert solver (z3:less (z3:product (list -2 i)) j) :track "first axiom")
      (z3:solver-assert solver (z3:equals x (z3:quotient (z3:integer-to-real i) -3/2)))
      (z3:push-scope solver)
      (z3:solver-assert solver (z3:distinct (list c "red" "blue")) :track p)
      (z3:solver-assert solver (z3:at-most (list p (z3:less x 0) (z3:equals i j)) 1))
      (is (string= "(set-logic ALL)
(declare-datatypes ((color 0)) (((red) (green) (blue))))
(declare-fun |first axiom!0| () Bool)
(declare-fun i () Int)
(declare-fun j () Int)
(declare-fun x () Real)
(declare-fun p () Bool)
(declare-fun c () color)
(assert (=> |first axiom!0| (< (* (- 2) i) j)))
(assert (= x (/ (to_real i) (- (/ 3.0 2.0)))))
(assert (=> p (distinct c red blue)))
(assert (<= (+ (ite p 1 0) (ite (< x 0.0) 1 0) (ite (= i j) 1 0) 0) 1))
(check-sat-assuming (|first axiom!0| p))
"
                   (z3:solver-smt-lib solver)))
      (z3:pop-scope solver)
      (is (string= "(set-logic QF_LIRA)
(declare-fun |first axiom!0| () Bool)
(declare-fun i () Int)
(declare-fun j () Int)
(declare-fun x () Real)
(assert (=> |first axiom!0| (< (* (- 2) i) j)))
(assert (= x (/ (to_real i) (- (/ 3.0 2.0)))))
(check-sat-assuming (|first axiom!0|))
"
                   (z3:solver-smt-lib solver))))))

(test text-is-what-was-asserted
  "A check, which rewrites what Z3 holds, changes nothing; what was popped is gone."
  (with-clauses (clauses context solver)
    (z3:assert-clauses clauses (literals 1 2 0 -1 0))
    (let ((text (z3:solver-smt-lib solver)))
      (is (search "(assert (or k!1 k!2))" text))
      (z3:check solver)
      (is (string= text (z3:solver-smt-lib solver)))
      (z3:push-scope solver)
      (z3:assert-at-most clauses '(1 2 3) 1)
      (is (search "(<= (+ (ite k!1 1 0) (ite k!2 1 0) (ite k!3 1 0) 0) 1)"
                  (z3:solver-smt-lib solver)))
      (z3:check solver)
      (z3:pop-scope solver)
      (is (string= text (z3:solver-smt-lib solver))))))

(test large-terms-are-defined-once
  (with-z3 (context solver)
    (let* ((variables (loop for i below 20 collect (z3:variable context (format nil "v~d" i))))
           (large (z3:conjunction variables)) (p (z3:variable context "shared")))
      (z3:solver-assert solver (z3:disjunction (list p large)))
      (z3:solver-assert solver (z3:implication p large))
      (let ((text (z3:solver-smt-lib solver)))
        (is (search "(define-fun shared!2 () Bool (and v0 " text))
        (is (search "(assert (or shared shared!2))" text))
        (is (search "(assert (=> shared shared!2))" text))))))

;;; Another solver

(defun cvc5-answer (script)
  "Return what the solver cvc5 says about SCRIPT: :SAT, :UNSAT, or its words."
  (uiop:with-temporary-file (:stream stream :pathname file :type "smt2" :external-format :utf-8)
    (write-string script stream)
    :close-stream
    (let ((output (handler-case
                      (uiop:run-program (list "cvc5" "--lang" "smt2" "--tlimit" "60000"
                                              (uiop:native-namestring file))
                                        :output :string :error-output :output
                                        :ignore-error-status t)
                    (error () "The solver cvc5 is missing: apt-get install cvc5"))))
      (cond ((string= output (format nil "sat~%")) :sat)
            ((string= output (format nil "unsat~%")) :unsat)
            (t output)))))

(defmacro same-answer (solver answer)
  "Check that Z3 and cvc5 give ANSWER."
  `(let ((script (z3:solver-smt-lib ,solver)))
     (is (eq ,answer (z3:check ,solver)))
     (is (eql ,answer (cvc5-answer script)))))

(defparameter *odd-names*
  (append (list "" "null" " " "a b" "|" "||" "a|b" "a{7c}b" "a\\b" "a\\|b" "\"quoted\"" "(f x)" ")"
                ";comment" "λ" "Ünïcödé" "日本語" (format nil "two~%lines") "x!0" "k!0"
                "shared"
                "not" "true" "let" "_" "!" "assert" "check-sat" "push" "Bool" "Int" "sin" "bvadd"
                "str.len" "select" "@x" ".y" "0" "1a" "-" "-1" "1.5" "#x1" ":key" "+" "<=" "a'b")
          (mapcar (lambda (code) (string (code-char code)))
                  '(0 9 127 160 #x85 #xD800 #xFFFE #x1F916 #x10FFFF))))

(test odd-names-in-another-solver
  (with-z3 (context solver)
    (let ((variables (mapcar (lambda (name) (z3:variable context name)) *odd-names*)))
      ;; If two names were one in the text, all differing from the next would be impossible.
      (loop for (one next) on variables
            while next
            do (z3:solver-assert solver (z3:equivalence one (z3:negation next))))
      (same-answer solver :sat)
      (z3:solver-assert solver (z3:equivalence (first variables) (third variables)))
      (z3:solver-assert solver (z3:equivalence (first variables) (second variables)))
      (same-answer solver :unsat)))
  (z3:with-context (context)
    (let* ((names (list* "color" "Color" "|" "{7c}" *odd-names*))
           (sort (z3:enumeration-sort context "Int" (remove-duplicates names :test #'string=)))
           (other (z3:enumeration-sort context "a | sort" '("color" "λ" "")))
           (x (z3:variable context "color" sort)) (y (z3:variable context "λ" other)))
      (z3:with-solver (solver context :logic nil)
        (z3:solver-assert solver (z3:distinct (list y "color" "λ")) :track "a | label")
        (dolist (element (butlast (z3:sort-elements sort)))
          (z3:solver-assert solver (z3:negation (z3:equals x element)) :track element))
        (same-answer solver :sat)
        (z3:solver-assert solver (z3:negation (z3:equals x (first (last (z3:sort-elements sort)))))
                          :track '("a list" 1))
        (same-answer solver :unsat)))))

(test numbers-in-another-solver
  (with-terms (context (i :integer) (j :integer) (x :real) (y :real) (p :boolean))
    (z3:with-solver (solver context :logic nil)
      (z3:solver-assert solver (z3:equals (z3:modulo i -7) 3))
      (z3:solver-assert solver (z3:equals (z3:quotient i -7) (- (expt 10 30))))
      (z3:solver-assert solver (z3:equals x (z3:sum (list (z3:integer-to-real i) -1/3))))
      (z3:solver-assert solver (z3:equals j (z3:real-to-integer x)))
      (z3:solver-assert solver (z3:equivalence p (z3:integral x)))
      (z3:solver-assert solver (z3:less-or-equal y (z3:if-then-else p x -5/2)))
      (same-answer solver :sat)
      (z3:solver-assert solver (z3:equals i (z3:if-then-else p 0 j)) :track "i = j")
      (same-answer solver :unsat))))

(test non-linear-numbers-in-another-solver
  (with-terms (context (i :integer) (j :integer))
    (z3:with-solver (solver context :logic nil)
      (z3:solver-assert solver (z3:equals (z3:product (list i j)) 35))
      (z3:solver-assert solver (z3:less 1 i))
      (z3:solver-assert solver (z3:less i j))
      (z3:solver-assert solver (z3:less j 20))
      (is (search "(set-logic QF_NIA)" (z3:solver-smt-lib solver)))
      (same-answer solver :sat)
      (z3:solver-assert solver (z3:distinct (list i 5)))
      (same-answer solver :unsat))))

(test deep-terms-in-another-solver
  (with-z3 (context solver)
    (let* ((p (z3:variable context "p")) (term p))
      (dotimes (i 20000)
        (let ((q (z3:variable context (format nil "q~d" (mod i 7)))))
          (setf term (if (evenp i)
                         (z3:disjunction (list (z3:negation term) q))
                         (z3:conjunction (list term (z3:negation q)))))))
      (z3:solver-assert solver term)
      (same-answer solver :sat)
      (z3:solver-assert solver (z3:negation term))
      (same-answer solver :unsat))))

(test pigeons-in-another-solver
  (with-z3 (context solver)
    (assert-pigeonhole solver 5)
    (same-answer solver :unsat)))

(test random-clauses-in-another-solver
  (let ((state (sb-ext:seed-random-state 3)) (answers '()))
    (dotimes (seed 16)
      (with-clauses (clauses context solver :name-of (and (evenp seed)
                                                          (lambda (number)
                                                            (nth number *odd-names*))))
        (z3:assert-clauses clauses (random-clauses 20 (+ 60 (random 40 state)) 3 seed))
        (z3:assert-at-most clauses '(1 2 3 4 5 6 -7) 4 :if -8)
        (let ((answer (z3:check solver)))
          (push answer answers)
          (same-answer solver answer))))
    (is (subsetp '(:sat :unsat) answers))))
