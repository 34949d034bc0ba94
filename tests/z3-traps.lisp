;;;; Tests of the layer z3: what a C library does to a Lisp process, and the raw functions.

(in-package #:discrepancy-finder.tests)

(in-suite z3)

;;; Floating-point traps

(defun call-with-all-traps (function)
  "Call FUNCTION where even inexact results trap.  Return its value and the number of traps that are
on afterwards."
  (let ((before (getf (sb-int:get-floating-point-modes) :traps)))
    (unwind-protect
         (progn
           (sb-int:set-floating-point-modes :traps '(:overflow :invalid :divide-by-zero :inexact))
           (list (funcall function)
                 (length (getf (sb-int:get-floating-point-modes) :traps))))
      (sb-int:set-floating-point-modes :traps before))))

(defun exercise-z3 ()
  "Make Z3 calculate with floating-point numbers wherever it may; return the answers."
  (with-terms (context (x :real) (y :real) (i :integer))
    (let ((clauses (random-clauses 100 300 3 1)))
      (z3:with-solver (algebraic context :logic "QF_NRA")
        (z3:with-solver (solver context :logic nil :timeout 60 :seed 3)
          (z3:with-clause-set (clause-set solver)
            (z3:solver-assert algebraic (z3:equals (z3:product (list x x)) (z3:sum (list x 1))))
            (z3:solver-assert algebraic (z3:less 1/3 x))
            (z3:solver-assert solver (z3:less (z3:integer-to-real i) (z3:product (list 7/3 y))))
            (z3:solver-assert solver (z3:equals (z3:modulo i 7) 3))
            (z3:push-scope solver)
            (z3:solver-assert solver (z3:less 100 i))
            ;; Lisp itself has inexact results where it makes hash tables, so there are none here.
            (call-with-all-traps
             (lambda ()
               (list (z3:check algebraic)
                     (z3:algebraic-number-p (z3:model-value algebraic x))
                     (z3:check solver)
                     (= 3 (mod (z3:model-value solver i) 7))
                     (length (z3:model-values solver))
                     (z3:check solver (list (z3:equals i 104)))
                     (z3:check solver (list (z3:less i 200)))
                     (consp (z3:solver-statistics solver))
                     (progn (z3:pop-scope solver)
                            (z3:assert-clauses clause-set clauses)
                            (z3:assert-at-most clause-set '(1 2 3 4) 2)
                            (z3:check-literals clause-set '(1 2)))
                     (length (z3:literal-values clause-set)))))))))))

(defun hundredth-of (number)
  (/ 1d0 (* 100 number)))

(test float-traps-are-masked-inside-and-kept-outside
  "Z3 is left alone even where Lisp traps inexact results, in any thread, and Lisp's traps are as
they were afterwards."
  (let ((expected '((:sat t :sat t 2 :unsat :sat t :sat 101) 4)))
    (is (equal expected (exercise-z3)))
    (is (equal expected (sb-thread:join-thread (sb-thread:make-thread #'exercise-z3)))))
  (signals division-by-zero (hundredth-of 0)))

(test concurrent-contexts-in-threads-that-trap
  (flet ((work ()
           (loop repeat 5 always (eq :sat (first (first (exercise-z3)))))))
    (let ((threads (loop repeat 3 collect (sb-thread:make-thread #'work))))
      (is (every #'identity (mapcar #'sb-thread:join-thread threads))))))

;;; Errors

(test errors-set-a-code-and-leave-the-process
  "Z3's own handler would end the process."
  (is (= 42 (run-lisp
             '((z3:with-context (context)
                 (sb-ext:exit
                  :code (handler-case (z3:make-solver context :logic "NONE")
                          (z3:z3-error (condition)
                            (if (and (search "NONE" (z3:z3-error-message condition))
                                     (z3:term-p (z3:variable context "p")))
                                42
                                4))))))))))

(test errors-of-a-call-are-not-those-of-a-later-one
  (with-z3 (context solver)
    (signals z3:z3-error (z3:make-solver context :logic "NONE"))
    (let ((p (z3:variable context "p")))
      (z3:solver-assert solver p)
      (is (eq :sat (z3:check solver)))
      (is (eq t (z3:model-value solver p))))))

;;; Lives

(test finalizers-only-enqueue
  "A context that was dropped is deleted by the thread that makes another, not by the collector."
  (let ((foreign (list)))
    (dotimes (i 30)
      (push (z3::context-foreign (z3:make-context)) foreign))
    (flet ((deleted-p (foreign) (zerop (z3::foreign-context-pointer foreign))))
      (is (loop repeat 200
                  thereis (progn (sb-ext:gc :full t)
                                 (> (length z3::**dropped-contexts**) 10))
                do (sleep 1/20)))
      (is (notany #'deleted-p foreign))
      (z3:close-context (z3:make-context))
      (is (> (count-if #'deleted-p foreign) 10)))))

(test the-numbered-library-comes-first
  "Z3's developers number the library, Debian ships it without the plain name."
  (is (equal '("libz3.so.4" "libz3.so") (third (assoc 'z3::z3 foreign::*libraries*)))))

(test contexts-with-deep-terms-close-quickly
  "Z3 itself takes milliseconds for each level of terms that are still referred to; the test is that
this one ends."
  (z3:with-context (context)
    (let ((term (z3:variable context "p")))
      (dotimes (i 100000)
        (setf term (if (evenp i)
                       (z3:disjunction (list term (z3:variable context "q")))
                       (z3:negation term))))
      (is (z3:term-p term)))))

(defun live-once (context round)
  "Use the layer in one life of a solver, and in every tenth life most of it."
  (z3:with-released-terms (context)
    (let ((p (z3:variable context "p")) (q (z3:variable context "q")))
      (z3:with-solver (solver context)
        (z3:solver-assert solver (z3:disjunction (list p q)) :track "axiom")
        (z3:push-scope solver)
        (z3:solver-assert solver (z3:negation p) :track (list round))
        (z3:check solver (list (z3:negation q)))
        (z3:unsat-core solver)
        (z3:pop-scope solver)
        (z3:with-clause-set (clauses solver)
          (z3:assert-clauses clauses (literals 1 2 0 -1 -2 0))
          (z3:assert-at-most clauses '(1 2 3) 2)
          (z3:check-literals clauses '(1))
          (z3:literal-values clauses)))
      (when (zerop (mod round 10))
        (z3:with-solver (solver context :logic nil)
          (z3:solver-assert solver (z3:less (z3:variable context "x" (z3:real-sort context))
                                            (+ round 1/3))
                            :track p)
          (z3:check solver (list (z3:conjunction (list p q))))
          (z3:model-values solver)
          (z3:solver-smt-lib solver)
          (z3:solver-statistics solver))))))

(test a-hundred-thousand-lives
  "Resident memory after 10 000 lives and after 100 000 more."
  (if *long*
      (z3:with-context (context)
        (flet ((lives (count)
                 (dotimes (i count) (live-once context i))
                 (sb-ext:gc :full t)
                 (resident-megabytes)))
          (let* ((before (lives 10000)) (after (lives 100000)))
            (format *test-dribble* "~&~,1f MB after 10000 lives, ~,1f MB after 110000~%"
                    before after)
            (is (< (- after before) 25)))))
      (skip "Run with *LONG* true.")))

(test timeouts-end-what-the-timer-of-libz3-does-not
  "The timer of libz3 4.8.12 ends in a deadlock here."
  (with-z3 (context solver :logic nil :timeout 1/5)
    (flet ((power (base exponent)
             (z3:product (make-list exponent :initial-element base)))
           (integer-variable (name)
             (z3:variable context name (z3:integer-sort context))))
      (let ((x (integer-variable "x")) (y (integer-variable "y")) (z (integer-variable "z")))
        (dolist (variable (list x y z))
          (z3:solver-assert solver (z3:less 1 variable)))
        (z3:solver-assert solver (z3:equals (power x 5) (z3:sum (list (power y 3) (power z 3) 7))))
        (z3:solver-assert solver (z3:less 1000 z))
        (z3:solver-assert solver (z3:less y z))
        (is (string= "timeout" (handler-case (z3:check solver)
                                 (z3:solver-unknown (condition)
                                   (z3:solver-unknown-reason condition)))))))))

;;; The raw functions

(defmacro with-raw-context ((pointer kept) &body body)
  "Evaluate BODY with POINTER bound to the address of a Z3 context, without interrupts; the local
function KEPT gives a term or sort, which it returns, a reference."
  (let ((context (gensym "CONTEXT")))
    `(z3:with-context (,context)
       (z3::calling-z3 (,pointer ,context)
         (foreign:with-c-float-traps
           (flet ((,kept (address)
                    (z3::z3-inc-ref ,pointer address)
                    address))
             (declare (ignorable #',kept))
             ,@body))))))

(test versions
  (is (= 3 (count #\. (z3:z3-version))))
  (is (every (lambda (character) (or (digit-char-p character) (char= character #\.)))
             (z3:z3-version))))

(test functions-that-this-version-lacks
  (with-raw-context (pointer kept)
    (let ((name (if (cffi:foreign-symbol-pointer "Z3_mk_simplifier")
                    'z3::z3-mk-set-has-size
                    'z3::z3-solver-solve-for)))
      (let ((report (report-of 'z3:z3-error
                               (lambda ()
                                 (if (eq name 'z3::z3-mk-set-has-size)
                                     (funcall name pointer 0 0)
                                     (funcall name pointer 0 0 0 0))))))
        (is (search (z3::z3-c-name name) report))
        (is (search (z3:z3-version) report))))))

(test every-raw-function-is-in-the-library
  "Those that are not looked up at each call are in the libz3 of this machine."
  (let ((names '()))
    (do-symbols (symbol '#:discrepancy-finder.z3)
      (when (and (eq (symbol-package symbol) (find-package '#:discrepancy-finder.z3))
                 (fboundp symbol)
                 (uiop:string-prefix-p "Z3-" (symbol-name symbol))
                 (string= "INLINE" (sb-int:info :function :inlinep symbol)))
        (pushnew (z3::z3-c-name symbol) names)))
    (is (> (length names) 400))
    (is (equal '() (remove-if #'cffi:foreign-symbol-pointer names)))))

(test raw-bit-vectors-and-arrays
  (with-raw-context (pointer kept)
    (let* ((sort (kept (z3::z3-mk-bv-sort pointer 8)))
           (x (kept (z3::z3-mk-const pointer (z3::z3-mk-int-symbol pointer 1) sort)))
           (ten (kept (z3::z3-mk-int pointer 10 sort)))
           (three (kept (z3::z3-mk-int pointer 3 sort)))
           (sum (kept (z3::z3-mk-bvadd pointer x ten)))
           (array-sort (kept (z3::z3-mk-array-sort pointer sort sort)))
           (array (kept (z3::z3-mk-const pointer (z3::z3-mk-int-symbol pointer 2) array-sort)))
           (element (kept (z3::z3-mk-select pointer array x)))
           (solver (z3::z3-mk-simple-solver pointer)))
      (is (= 8 (z3::z3-get-bv-sort-size pointer sort)))
      (is (= sort (z3::z3-get-array-sort-range pointer array-sort)))
      (z3::z3-solver-inc-ref pointer solver)
      (z3::z3-solver-assert pointer solver (z3::z3-mk-eq pointer sum three))
      (z3::z3-solver-assert pointer solver (z3::z3-mk-eq pointer element x))
      (is (= 1 (z3::z3-solver-check pointer solver)))
      (let ((model (z3::z3-solver-get-model pointer solver)))
        (z3::z3-model-inc-ref pointer model)
        (cffi:with-foreign-object (value :uint64)
          (is-true (z3::z3-model-eval pointer model element t value))
          (is (string= "249" (z3::decode (z3::z3-get-numeral-string
                                          pointer (cffi:mem-ref value :uint64))))))
        (z3::z3-model-dec-ref pointer model))
      (z3::z3-solver-assert pointer solver (z3::z3-mk-bvult pointer x ten))
      (is (= -1 (z3::z3-solver-check pointer solver)))
      (z3::z3-solver-dec-ref pointer solver))))

(test raw-optimization-and-parsing
  (with-raw-context (pointer kept)
    (let ((optimizer (z3::z3-mk-optimize pointer)))
      (z3::z3-optimize-inc-ref pointer optimizer)
      (z3::with-encoded-text (text "(declare-fun x () Int) (assert (< (* 3 x) 20)) (maximize x)")
        (z3::z3-optimize-from-string pointer optimizer text))
      (is (= 1 (z3::z3-optimize-check pointer optimizer 0 (cffi:null-pointer))))
      (is (string= "6" (z3::decode (z3::z3-get-numeral-string
                                    pointer (z3::z3-optimize-get-upper pointer optimizer 0)))))
      (z3::z3-optimize-dec-ref pointer optimizer))))

(test raw-tactics-and-quantifiers
  (with-raw-context (pointer kept)
    (let* ((sort (kept (z3::z3-mk-int-sort pointer)))
           (x (kept (z3::z3-mk-const pointer (z3::z3-mk-int-symbol pointer 1) sort)))
           (three (kept (z3::z3-mk-int pointer 3 sort)))
           (below (kept (z3::z3-mk-lt pointer x three)))
           (goal (z3::z3-mk-goal pointer t nil nil)))
      (z3::z3-goal-inc-ref pointer goal)
      (cffi:with-foreign-object (bound :uint64)
        (setf (cffi:mem-ref bound :uint64) x)
        (z3::z3-goal-assert pointer goal
                            (z3::z3-mk-exists-const pointer 0 1 bound 0 (cffi:null-pointer)
                                                    below)))
      (let* ((tactic (z3::with-encoded-text (name "qe")
                       (z3::z3-mk-tactic pointer name)))
             (result (progn (z3::z3-tactic-inc-ref pointer tactic)
                            (z3::z3-tactic-apply pointer tactic goal)))
             (subgoal (progn (z3::z3-apply-result-inc-ref pointer result)
                             (z3::z3-apply-result-get-subgoal pointer result 0))))
        (z3::z3-goal-inc-ref pointer subgoal)
        (is (= 1 (z3::z3-apply-result-get-num-subgoals pointer result)))
        ;; Some integer is less than 3.
        (is-true (z3::z3-goal-is-decided-sat pointer subgoal))
        (z3::z3-goal-dec-ref pointer subgoal)
        (z3::z3-apply-result-dec-ref pointer result)
        (z3::z3-tactic-dec-ref pointer tactic)
        (z3::z3-goal-dec-ref pointer goal)))))
