;;;; Checks and models.
;;;;
;;;; CHECK asks whether the assertions of a solver can hold together; MODEL-VALUE reads one way in
;;;; which they do.  Z3's third answer, `unknown', is a condition and no answer.

(in-package #:discrepancy-finder.z3)

;;; One check

(defun check-in-z3 (solver literals)
  "Make the check, with the assumptions LITERALS.  Return :SAT, :UNSAT, or :UNKNOWN and the reason."
  (let* ((context (solver-context solver))
         (count (length literals))
         (terms (make-array count :element-type '(unsigned-byte 64))))
    (map-into terms (lambda (literal) (live-pointer literal context)) literals)
    (forget-model solver)
    (multiple-value-bind (answer reason)
        (call-interruptibly
         context
         (lambda ()
           (let ((pointer (context-pointer context)) (address (solver-pointer solver)))
             (if (zerop address)
                 (values :unknown :closed)
                 (let ((answer (sb-sys:with-pinned-objects (terms)
                                 (foreign:with-c-float-traps
                                   (z3-solver-check-assumptions
                                    pointer address count (sb-sys:vector-sap terms)))))
                       (code (z3-get-error-code pointer)))
                   ;; An error may mean, too, that the check was stopped: then it is made again.
                   (cond ((plusp code)
                          (values :unknown
                                  (cons code (decode (z3-get-error-msg pointer code)))))
                         ((= answer 1) :sat)
                         ((= answer -1) :unsat)
                         (t (values :unknown
                                    (decode (z3-solver-get-reason-unknown
                                             pointer address))))))))))
      (cond ((eq reason :closed) (misuse :closed-solver "the solver is closed"))
            ((consp reason) (signal-z3-error (car reason) (cdr reason))))
      (when (eq answer :sat)
        (setf (solver-model solver) :unread))
      (values answer reason))))

(defun read-model (solver)
  "Return the address of the model of SOLVER's last check.  Signal Z3-ERROR if there is none."
  (let ((model (solver-model solver)))
    (case model
      ((nil) (misuse :no-model "there is no model, for the last operation on the solver was not ~
                                a check that found one"))
      (:unread
       (calling-solver (pointer address solver)
         (let ((model (foreign:with-c-float-traps (z3-solver-get-model pointer address))))
           (unless (zerop model)
             (z3-model-inc-ref pointer model)
             (setf (solver-model solver) model)))))
      (t model))))

(defun check-in-scope (solver propositions)
  "Do as CHECK-IN-Z3 does, with any terms as assumptions: assert them for the time of the check."
  (let ((scopes (scope-count solver)))
    (unwind-protect
         (progn (push-scope solver)
                (dolist (proposition propositions)
                  (solver-assert solver proposition))
                (multiple-value-bind (answer reason) (check-in-z3 solver '())
                  (when (eq answer :sat)
                    (read-model solver))
                  (values answer reason)))
      (calling-solver (pointer address solver)
        (z3-solver-pop pointer address (- (z3-solver-get-num-scopes pointer address) scopes))))))

(defun check-for (solver assumptions timeout)
  "Make one check that ends after TIMEOUT seconds."
  (flet ((ask ()
           (if (every #'literal-p assumptions)
               (check-in-z3 solver assumptions)
               (check-in-scope solver assumptions))))
    (if (eql timeout (solver-timeout solver))
        (ask)
        (unwind-protect (progn (configure-solver solver timeout)
                               (ask))
          (configure-solver solver (solver-timeout solver))))))

(defun read-timeout ()
  "Ask the user for the argument of RETRY-WITH-TIMEOUT."
  (loop
    (format *query-io* "~&Seconds: ")
    (finish-output *query-io*)
    (let ((seconds (let ((*read-eval* nil)) (read *query-io*))))
      (when (typep seconds '(real (0)))
        (return (list seconds))))))

;;; The questions

(defun check (solver &optional (assumptions '()))
  "Return :SAT if the assertions of SOLVER can hold together with the list ASSUMPTIONS of
propositions, :UNSAT if they cannot.  Assumptions that are variables or negated variables cost
least; others are asserted in a scope of their own.

If Z3 cannot tell, e.g. when the solver's timeout is over, signal SOLVER-UNKNOWN with the restarts
RETRY-WITH-TIMEOUT (one argument: seconds, for this check only) and TREAT-AS-SAT.  Signals Z3-ERROR.

The thread may be interrupted during the check: it is left, the interrupt runs, and if that returns,
the check is made again from the start, with its full timeout."
  (dolist (assumption assumptions)
    (check-type assumption proposition))
  (when (member nil assumptions)
    (forget-model solver)
    (return-from check :unsat))
  (let ((assumptions (remove t assumptions))
        (timeout (solver-timeout solver)))
    (loop
      (multiple-value-bind (answer reason) (check-for solver assumptions timeout)
        (unless (eq answer :unknown)
          (return answer))
        (restart-case (error 'solver-unknown :solver solver :reason reason)
          (retry-with-timeout (seconds)
            :report "Check again, for at most so many seconds as you say."
            :interactive read-timeout
            (check-type seconds (real (0)))
            (setf timeout seconds))
          (treat-as-sat ()
            :report "Answer :SAT: paths are then kept although they are not proved possible."
            (return :sat)))))))

(defun model-value (solver proposition)
  "Return the truth value, T or NIL, of PROPOSITION in the model that the last CHECK of SOLVER
found.  Where the model leaves a variable open Z3 completes it, and goes on to give the same value.
Signals Z3-ERROR if there is no model: the last check did not say :SAT (or by TREAT-AS-SAT only), or
assertions or scopes have changed since then."
  (check-type proposition proposition)
  (let ((model (read-model solver)))
    (if (term-p proposition)
        (let ((term (live-pointer proposition (solver-context solver)))
              (value (make-array 1 :element-type '(unsigned-byte 64))))
          (sb-sys:with-pinned-objects (value)
            (case (calling-z3 (pointer (solver-context solver))
                    ;; The value needs no reference: Z3 keeps the last result alive.
                    (if (z3-model-eval pointer model term t (sb-sys:vector-sap value))
                        (z3-get-bool-value pointer (aref value 0))
                        0))
              (1 t)
              (-1 nil)
              (t (misuse :exception "the model gives no truth value to ~a" proposition)))))
        proposition)))
