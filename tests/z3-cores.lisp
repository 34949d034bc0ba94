;;;; Tests of the layer z3: tracked assertions, cores, statistics, seeds.

(in-package #:discrepancy-finder.tests)

(in-suite z3)

(defun core-of (solver &optional (assumptions '()))
  "Return the core of SOLVER and ASSUMPTIONS, with the texts of terms; NIL if there is none."
  (and (eq :unsat (z3:check solver assumptions))
       (mapcar #'text-of (z3:unsat-core solver))))

(test cores-name-what-is-to-blame
  (dolist (logic '("QF_FD" "QF_UF" nil))
    (with-z3 (context solver :logic logic)
      (let ((p (z3:variable context "p")) (q (z3:variable context "q"))
            (r (z3:variable context "r")))
        (z3:solver-assert solver (z3:implication p q) :track "p needs q")
        (z3:solver-assert solver (z3:implication q r) :track 'q-needs-r)
        (z3:solver-assert solver (z3:disjunction (list q (z3:variable context "s")))
                          :track '(irrelevant 1))
        (is (eq :sat (z3:check solver (list p))))
        (signals-z3-error :no-core (z3:unsat-core solver))
        (is (equal '("p needs q" q-needs-r "p" "(not r)")
                   (core-of solver (list (z3:variable context "s") p (z3:negation r)))))
        ;; An assumption that is no literal makes the check one in a scope.
        (is (equal '("p needs q" q-needs-r "(and p (not r))")
                   (core-of solver (list (z3:conjunction (list p (z3:negation r)))))))
        (z3:push-scope solver)
        (signals-z3-error :no-core (z3:unsat-core solver))
        (z3:solver-assert solver p :track :here)
        (z3:solver-assert solver (z3:negation r))
        (is (equal '("p needs q" q-needs-r :here) (core-of solver)))
        (is (equal '("p needs q" q-needs-r :here) (z3:unsat-core solver)))
        (z3:pop-scope solver)
        (is (eq :sat (z3:check solver (list p))))
        (is (equal '(nil) (core-of solver (list p nil))))))))

(test labels-that-stand-twice
  (with-z3 (context solver)
    (let ((p (z3:variable context "p")) (q (z3:variable context "q")))
      (z3:solver-assert solver (z3:disjunction (list p q)))
      (z3:solver-assert solver (z3:negation p) :track (list :axiom 1))
      (z3:solver-assert solver (z3:negation q) :track (list :axiom 1))
      (is (equal '((:axiom 1)) (core-of solver))))))

(test constants-can-be-tracked
  (with-z3 (context solver)
    (z3:solver-assert solver t :track "true")
    (is (eq :sat (z3:check solver)))
    (z3:solver-assert solver nil :track "false")
    (is (equal '("false") (core-of solver)))))

(test literals-as-labels
  (with-z3 (context solver)
    (let ((p (z3:variable context "p")) (switch (z3:variable context "switch")))
      (z3:solver-assert solver p :track switch)
      (is (eq :sat (z3:check solver)))
      (is (eq t (z3:model-value solver switch)))
      (is (eq t (z3:model-value solver p)))
      (is (equal '("switch" "(not p)") (core-of solver (list (z3:negation p)))))
      (signals-z3-error :invalid-argument
        (z3:solver-assert solver p :track (z3:conjunction (list p switch)))))))

(test labels-are-no-names-of-variables
  "A label and a variable that share a name have nothing else in common."
  (with-z3 (context solver)
    (let ((p (z3:variable context "p")))
      (z3:solver-assert solver (z3:negation p) :track "p")
      (is (eq :sat (z3:check solver)))
      (is (eq nil (z3:model-value solver p)))
      (is (equal '(("p" . nil)) (z3:model-values solver)))
      (is (equal '("p" "p") (core-of solver (list p)))))))

(test cores-are-gone-after-a-change
  (with-z3 (context solver)
    (let ((p (z3:variable context "p")))
      (signals-z3-error :no-core (z3:unsat-core solver))
      (z3:solver-assert solver (z3:negation p))
      (is (equal '("p") (core-of solver (list p))))
      (z3:solver-assert solver t)
      (signals-z3-error :no-core (z3:unsat-core solver)))))

(test cores-of-numbers
  (with-terms (context (i :integer) (j :integer))
    (z3:with-solver (solver context :logic nil)
      (z3:solver-assert solver (z3:less i j) :track "i < j")
      (z3:solver-assert solver (z3:less j 10) :track "j < 10")
      (z3:solver-assert solver (z3:less 0 j) :track "0 < j")
      (is (eq :sat (z3:check solver)))
      (z3:solver-assert solver (z3:less 9 i) :track "9 < i")
      (is (equal '("i < j" "j < 10" "9 < i") (core-of solver))))))

(test random-cores-suffice
  "What a core names contradicts the rest on its own, and other assertions are not needed."
  (let ((state (sb-ext:seed-random-state 11)) (cores 0))
    (dotimes (round 60)
      (with-z3 (context solver :logic (random-choice '("QF_FD" "QF_UF" nil) state))
        (let* ((variables (loop for i below 5 collect (z3:variable context (format nil "~d" i))))
               (clauses (loop repeat 14
                              collect (z3:disjunction
                                       (loop repeat 2
                                             for variable = (random-choice variables state)
                                             collect (if (zerop (random 2 state))
                                                         variable
                                                         (z3:negation variable)))))))
          (loop for clause in clauses
                for number from 0
                do (z3:solver-assert solver clause :track number))
          (let ((core (core-of solver)))
            (when core
              (incf cores)
              (z3:with-solver (other context)
                (dolist (number core)
                  (z3:solver-assert other (nth number clauses)))
                (is (eq :unsat (z3:check other)))))))))
    (is (> cores 10))))

(test the-seed-decides
  (flet ((model (seed)
           (with-z3 (context solver :seed seed)
             (z3:with-clause-set (clauses solver)
               (z3:assert-clauses clauses (random-clauses 200 600 3 1))
               (z3:check solver)
               (z3:literal-values clauses)))))
    (is (equal (model 1) (model 1)))
    (is (equal (model nil) (model nil)))
    (is (not (equal (model 1) (model 2)))))
  (z3:with-context (context)
    (signals type-error (z3:make-solver context :seed -1))))

(test options-of-the-engine
  (z3:with-context (context)
    (z3:with-solver (solver context :options '(("max_conflicts" . 10) ("pb.solver" . 3)))
      (handler-case (progn (z3:check solver) (fail "A symbol may not be a number."))
        (z3:z3-error (condition)
          (is (search "pb.solver" (z3:z3-error-message condition))))))
    (z3:with-solver (solver context :options '(("max_conflicts" . 10) ("core.minimize" . t)))
      (is (eq :sat (z3:check solver)))
      (assert-pigeonhole solver 9)
      (signals z3:solver-unknown (z3:check solver)))
    (z3:with-solver (solver context :options '(("no such option" . 1)))
      (signals-with (z3:z3-error "no such option") (z3:check solver)))
    (z3:with-solver (solver context :options '(("pb.solver" . "totalizer") ("random_freq" . 0d0)))
      (is (eq :sat (z3:check solver))))
    (signals type-error (z3:make-solver context :options '(("max_conflicts" . :ten))))))

(test solver-statistics-are-an-alist
  (with-z3 (context solver)
    (assert-pigeonhole solver 6)
    (z3:check solver)
    (let ((statistics (z3:solver-statistics solver)))
      (is (every #'keywordp (mapcar #'car statistics)))
      (is (every #'realp (mapcar #'cdr statistics)))
      (is (plusp (cdr (assoc :sat-conflicts statistics))))
      (is (plusp (cdr (assoc :memory statistics)))))))

(test what-z3-says-in-lines-is-one-line
  (with-terms (context (i :integer))
    (z3:with-solver (solver context)
      (z3:solver-assert solver (z3:less i 3))
      (signals-with (z3:solver-unknown "cannot tell" "Int") (z3:check solver)))))
