;;;; Tests of the layer z3: propositions, solvers, models, bad use.

(in-package #:discrepancy-finder.tests)

(def-suite z3 :in all)
(in-suite z3)

(defmacro with-z3 ((context solver &rest options) &body body)
  `(z3:with-context (,context)
     (z3:with-solver (,solver ,context ,@options)
       ,@body)))

(defmacro signals-z3-error (code &body body)
  "Check that BODY signals a Z3-ERROR of CODE."
  `(is (eq ,code (handler-case (progn ,@body :none)
                   (z3:z3-error (condition) (z3:z3-error-code condition))))))

;;; A problem that grows exponentially harder: put more pigeons than holes into the holes, one into
;;; each.  Its source is kept, for tests that run it in another process.

(defmacro define-portable-function (name lambda-list &body body)
  `(progn (setf (get ',name 'source) '(defun ,name ,lambda-list ,@body))
          (defun ,name ,lambda-list ,@body)))

(define-portable-function assert-pigeonhole (solver holes)
  (let* ((context (z3:solver-context solver))
         (in (make-array (list (1+ holes) holes))))
    (flet ((column (pigeon)
             (loop for hole below holes collect (aref in pigeon hole))))
      (dotimes (pigeon (1+ holes))
        (dotimes (hole holes)
          (setf (aref in pigeon hole)
                (z3:variable context (format nil "pigeon ~d in ~d" pigeon hole))))
        (z3:solver-assert solver (z3:disjunction (column pigeon)))
        (dotimes (other pigeon)
          (loop for one in (column pigeon)
                for two in (column other)
                do (z3:solver-assert solver
                                     (z3:disjunction (list (z3:negation one)
                                                           (z3:negation two))))))))))

;;; Propositions

(test constants-fold
  (is (eq t (z3:conjunction '())))
  (is (eq nil (z3:disjunction '())))
  (is (eq nil (z3:conjunction '(t nil))))
  (is (eq t (z3:disjunction '(nil t))))
  (is (eq t (z3:negation nil)))
  (is (eq nil (z3:negation t)))
  (is (eq t (z3:implication nil nil)))
  (is (eq nil (z3:implication t nil)))
  (is (eq nil (z3:equivalence t nil)))
  (is (eq t (z3:equivalence nil nil)))
  (z3:with-context (context)
    (let* ((p (z3:variable context "p")) (not-p (z3:negation p)))
      (is (eq p (z3:conjunction (list t p t))))
      (is (eq nil (z3:conjunction (list p nil p))))
      (is (eq p (z3:disjunction (list nil p))))
      (is (eq t (z3:disjunction (list p t))))
      (is (eq p (z3:negation not-p)))
      (is (eq p (z3:implication t p)))
      (is (eq t (z3:implication p t)))
      (is (eq t (z3:implication nil p)))
      (is (z3:term-equal not-p (z3:implication p nil)))
      (is (eq p (z3:equivalence t p)))
      (is (eq p (z3:equivalence p t)))
      (is (z3:term-equal not-p (z3:equivalence p nil)))
      (is (z3:term-equal not-p (z3:equivalence nil p)))
      (signals type-error (z3:conjunction (list p 1)))
      (signals type-error (z3:negation :p)))))

(test equal-terms-are-shared
  (z3:with-context (context)
    (flet ((make ()
             (z3:conjunction (list (z3:variable context "p")
                                   (z3:negation (z3:variable context "q"))))))
      (is (z3:term-equal (make) (make)))
      (is (not (z3:term-equal (make) (z3:negation (make)))))
      (is (not (z3:term-equal (make) t)))
      (is (z3:term-equal nil nil)))))

(test terms-print-as-smt-lib
  (z3:with-context (context)
    (let ((p (z3:variable context "p")) (q (z3:variable context "q r")))
      (is (string= "#<TERM (and p |q r| (not p))>"
                   (let ((*package* (find-package '#:discrepancy-finder.z3)))
                     (prin1-to-string (z3:conjunction (list p q (z3:negation p))))))))))

(test names-are-any-strings
  (let ((names (list "" "null" " " "a b" "|" "||" "a|b" "a\\b" "a\\|b" "\"quoted\"" "(f x)" ")"
                     ";comment" "λ" "Ünïcödé" "日本語" (string (code-char #x1F916))
                     (string (code-char 0)) (format nil "a~ab" (code-char 0)) "a"
                     (format nil "two~%lines") (string (code-char #xD800)) "x!0" "k!0" "true"
                     "not" "\\u{7c}" (coerce "base" 'simple-base-string)
                     (make-array 3 :element-type 'character :initial-contents "abc"
                                   :fill-pointer 2))))
    (z3:with-context (context)
      (let ((variables (loop for name in names collect (z3:variable context name))))
        (loop for name in names
              for p in variables
              do (is (string= name (z3:term-name p))))
        (is (loop for (p . others) on variables
                  never (member p others :test #'z3:term-equal)))
        (is (z3:term-equal (z3:variable context "λ") (z3:variable context "λ")))
        (is (null (z3:term-name (z3:negation (first variables)))))
        (z3:with-solver (solver context)
          (z3:solver-assert solver (z3:conjunction variables))
          (z3:solver-assert solver (z3:negation (z3:variable context "another")))
          (is (eq :sat (z3:check solver)))
          (is (every (lambda (p) (z3:model-value solver p)) variables)))))))

(test released-terms
  (with-z3 (context solver)
    (let* ((p (z3:variable context "p")) released)
      (is (eq :value (z3:with-released-terms (context)
                       (z3:with-released-terms (context)
                         (setf released (z3:conjunction (list p (z3:variable context "q"))))
                         (z3:solver-assert solver released))
                       :value)))
      (signals-z3-error :released-term (z3:negation released))
      (signals-z3-error :released-term (z3:solver-assert solver released))
      (is (search "released" (prin1-to-string released)))
      (is (eq :unsat (z3:check solver (list (z3:negation p)))))
      (is (eq :sat (z3:check solver (list p))))
      (is (eq t (z3:model-value solver (z3:variable context "q")))))))

;;; Solvers

(test sat-unsat-and-model
  (dolist (logic '("QF_FD" "QF_UF" nil))
    (with-z3 (context solver :logic logic)
      (let ((p (z3:variable context "p")) (q (z3:variable context "q")))
        (z3:solver-assert solver t)
        (z3:solver-assert solver (z3:disjunction (list p q)))
        (z3:solver-assert solver (z3:implication q (z3:negation p)))
        (z3:solver-assert solver (z3:equivalence p (z3:negation p)))
        (is (eq :unsat (z3:check solver))))
      (z3:with-solver (other context :logic logic)
        (let ((p (z3:variable context "p")) (q (z3:variable context "q"))
              (free (z3:variable context "free")))
          (z3:solver-assert other (z3:conjunction (list p (z3:negation q))))
          (is (eq :sat (z3:check other)))
          (is (eq t (z3:model-value other p)))
          (is (eq nil (z3:model-value other q)))
          (is (eq t (z3:model-value other (z3:disjunction (list p q)))))
          (is (eq t (z3:model-value other t)))
          (is (eq (z3:model-value other free)
                  (not (z3:model-value other (z3:negation free)))))
          (z3:solver-assert other nil)
          (is (eq :unsat (z3:check other))))))))

(test scopes
  (with-z3 (context solver)
    (let ((p (z3:variable context "p")))
      (z3:solver-assert solver p)
      (z3:push-scope solver)
      (z3:solver-assert solver (z3:negation p))
      (is (eq :unsat (z3:check solver)))
      (z3:pop-scope solver)
      (is (eq :sat (z3:check solver)))
      (z3:push-scope solver)
      (z3:push-scope solver)
      (z3:solver-assert solver nil)
      (is (eq :unsat (z3:check solver)))
      (signals-z3-error :index-out-of-bounds (z3:pop-scope solver 3))
      (is (eq :unsat (z3:check solver)))
      (z3:pop-scope solver 2)
      (is (eq :sat (z3:check solver)))
      (is (eq t (z3:model-value solver p)))
      (signals-z3-error :index-out-of-bounds (z3:pop-scope solver))
      (is (eq :sat (z3:check solver))))))

(test assumptions
  (with-z3 (context solver)
    (let* ((p (z3:variable context "p")) (q (z3:variable context "q"))
           (both (z3:conjunction (list p q))))
      (z3:solver-assert solver (z3:disjunction (list p q)))
      (is (eq :sat (z3:check solver (list t (z3:negation p)))))
      (is (eq t (z3:model-value solver q)))
      (is (eq :unsat (z3:check solver (list (z3:negation p) (z3:negation q)))))
      (is (eq :unsat (z3:check solver (list p nil))))
      (is (eq :sat (z3:check solver (list both))))
      (is (eq t (z3:model-value solver p)))
      (is (eq t (z3:model-value solver q)))
      (is (eq :unsat (z3:check solver (list both (z3:negation p)))))
      (is (eq :sat (z3:check solver)))
      (signals-z3-error :index-out-of-bounds (z3:pop-scope solver)))))

(test statistics
  (with-z3 (context solver)
    (is (= 0 (z3:check-count context)))
    (assert-pigeonhole solver 4)
    (z3:check solver)
    (z3:check solver)
    (is (= 2 (z3:check-count context)))
    (is (plusp (z3:check-seconds context)))))

;;; Unknown

(test unknown-is-a-condition
  (with-z3 (context solver :timeout 1/1000)
    (assert-pigeonhole solver 11)
    (handler-case (progn (z3:check solver) (fail "There was an answer."))
      (z3:solver-unknown (condition)
        (is (eq solver (z3:solver-unknown-solver condition)))
        (is (string= "timeout" (z3:solver-unknown-reason condition)))
        (is (string= "The solver cannot tell whether its assertions are satisfiable (timeout)."
                     (princ-to-string condition)))))
    (is (eq :sat (handler-bind ((z3:solver-unknown
                                  (lambda (condition)
                                    (let ((restart (find-restart 'z3:treat-as-sat condition)))
                                      (is (search "paths are then kept" (princ-to-string restart)))
                                      (invoke-restart restart)))))
                   (z3:check solver))))
    (signals-z3-error :no-model (z3:model-value solver t))))

(test retry-with-a-longer-timeout
  (with-z3 (context solver :timeout 1/1000)
    (z3:push-scope solver)
    (assert-pigeonhole solver 8)
    (let ((unknowns 0))
      (is (eq :unsat (handler-bind ((z3:solver-unknown
                                      (lambda (condition)
                                        (declare (ignore condition))
                                        (incf unknowns)
                                        (invoke-restart 'z3:retry-with-timeout
                                                        (if (= unknowns 1) 1/1000 600)))))
                       (z3:check solver))))
      (is (= 2 unknowns)))
    (z3:pop-scope solver)
    (assert-pigeonhole solver 11)
    (signals z3:solver-unknown (z3:check solver))))

;;; Bad use

(test errors-of-z3-are-conditions
  (z3:with-context (context)
    (handler-case (progn (z3:make-solver context :logic "NO_SUCH_LOGIC") (fail "It was made."))
      (z3:z3-error (condition)
        ;; The code depends on the version.
        (is (member (z3:z3-error-code condition) '(:exception :invalid-argument)))
        (is (string= "Z3: logic 'NO_SUCH_LOGIC' is not recognized."
                     (princ-to-string condition)))))
    (is (z3:term-p (z3:variable context "usable afterwards")))))

(test closed-contexts
  (let* ((context (z3:make-context)) (solver (z3:make-solver context))
         (p (z3:variable context "p")))
    (z3:solver-assert solver p)
    (z3:check solver)
    (z3:close-context context)
    (z3:close-context context)
    (z3:close-solver solver)
    (signals-z3-error :closed-context (z3:variable context "q"))
    (signals-z3-error :closed-context (z3:negation p))
    (signals-z3-error :closed-context (z3:conjunction (list p p)))
    (signals-z3-error :closed-context (z3:term-name p))
    (signals-z3-error :closed-context (z3:make-solver context))
    (is (= 1 (z3:check-count context)))
    (is (search "released" (prin1-to-string p)))
    (is (search "closed" (prin1-to-string context)))
    (is (search "closed" (prin1-to-string solver))))
  (let* ((context (z3:make-context)) (solver (z3:make-solver context)))
    (z3:close-context context)
    (signals-z3-error :closed-context (z3:solver-assert solver t) (z3:check solver))
    (signals-z3-error :closed-context (z3:push-scope solver))
    (signals-z3-error :closed-context (z3:check solver))))

(test closed-solvers
  (z3:with-context (context)
    (let ((solver (z3:make-solver context)))
      (z3:check solver)
      (z3:close-solver solver)
      (z3:close-solver solver)
      (signals-z3-error :closed-solver (z3:solver-assert solver nil))
      (signals-z3-error :closed-solver (z3:check solver))
      (signals-z3-error :closed-solver (z3:pop-scope solver))
      (signals-z3-error :no-model (z3:model-value solver t)))))

(test terms-of-another-context
  (with-z3 (context solver)
    (z3:with-context (other)
      (let ((p (z3:variable context "p")) (q (z3:variable other "p")))
        (signals-z3-error :other-context (z3:conjunction (list p q)))
        (signals-z3-error :other-context (z3:implication p q))
        (signals-z3-error :other-context (z3:equivalence q p))
        (signals-z3-error :other-context (z3:term-equal p q))
        (signals-z3-error :other-context (z3:solver-assert solver q))
        (signals-z3-error :other-context (z3:check solver (list q)))
        (z3:check solver)
        (signals-z3-error :other-context (z3:model-value solver q))
        (is (eq :sat (z3:check solver (list p))))))))

(test models-need-a-check-that-found-one
  (with-z3 (context solver)
    (let ((p (z3:variable context "p")))
      (signals-z3-error :no-model (z3:model-value solver p))
      (dolist (change (list (lambda () (z3:solver-assert solver p))
                            (lambda () (z3:push-scope solver))
                            (lambda () (z3:pop-scope solver))
                            (lambda () (z3:check solver (list nil)))
                            (lambda () (z3:check solver (list (z3:negation p))))))
        (is (eq :sat (z3:check solver)))
        (z3:model-value solver p)
        (funcall change)
        (signals-z3-error :no-model (z3:model-value solver p))))))
