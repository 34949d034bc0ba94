;;;; Solvers: sets of assertions with scopes.
;;;;
;;;; Entry points: MAKE-SOLVER, WITH-SOLVER, SOLVER-ASSERT, PUSH-SCOPE, POP-SCOPE; see check.lisp
;;;; for the questions.  A solver that is not closed lives as long as its context.

(in-package #:discrepancy-finder.z3)

(defstruct (solver (:constructor %make-solver (context pointer timeout)) (:copier nil))
  "A solver of Z3: made by MAKE-SOLVER, ended by CLOSE-SOLVER or with its context."
  (context nil :type context :read-only t)
  ;; 0 when the solver was closed.
  (pointer 0 :type (unsigned-byte 64))
  (timeout nil :type (or null real) :read-only t)
  ;; NIL; :UNREAD: the last check said :SAT and Z3 holds the model; or the model's address.
  (model nil :type (or null (eql :unread) (unsigned-byte 64))))

(setf (documentation 'solver-p 'function)
      "Return true if its argument is a SOLVER."
      (documentation 'solver-context 'function)
      "Return the context of a solver.")

(defmethod print-object ((solver solver) stream)
  (print-unreadable-object (solver stream :type t :identity t)
    (format stream "~:[open~;closed~]~@[, timeout ~f s~]"
            (or (zerop (solver-pointer solver)) (zerop (context-pointer (solver-context solver))))
            (solver-timeout solver))))

(defmacro calling-solver ((pointer address solver) &body body)
  "Do as CALLING-Z3 does, with ADDRESS bound to that of SOLVER.  Signal Z3-ERROR if it is closed."
  (let ((owner (gensym "SOLVER")))
    `(let* ((,owner ,solver) (,address (solver-pointer ,owner)))
       (when (zerop ,address)
         (misuse :closed-solver "the solver is closed"))
       (calling-z3 (,pointer (solver-context ,owner))
         ,@body))))

;;; Life

(defun timeout-milliseconds (seconds)
  "Return SECONDS, a real or NIL for ever, as Z3 has it."
  (let ((longest (1- (expt 2 32))))
    (if seconds (min longest (max 1 (ceiling (* 1000 seconds)))) longest)))

(defun configure-solver (solver timeout)
  "Let the checks of SOLVER end after TIMEOUT seconds (a real, or NIL for no limit)."
  (let ((milliseconds (timeout-milliseconds timeout)))
    (with-encoded-text (timeout-key "timeout")
      ;; Z3 would put its own handler of SIGINT in the place of SBCL's.
      (with-encoded-text (signal-key "ctrl_c")
        (calling-solver (pointer address solver)
          (let ((parameters (z3-mk-params pointer)))
            (z3-params-inc-ref pointer parameters)
            (z3-params-set-bool pointer parameters (z3-mk-string-symbol pointer signal-key) nil)
            (z3-params-set-uint pointer parameters (z3-mk-string-symbol pointer timeout-key)
                                milliseconds)
            (z3-params-dec-ref pointer
                               (prog1 parameters
                                 (z3-solver-set-params pointer address parameters)))))))))

(defun make-solver (context &key (logic "QF_FD") timeout)
  "Return a new SOLVER in CONTEXT.  LOGIC is the name of an SMT-LIB logic, which picks Z3's engine,
or NIL for Z3's default engine; QF_FD, propositions and finite domains, is the one measured best for
propositions.  A check ends after TIMEOUT seconds of wall-clock time (a positive real, or NIL for no
limit).  Signals Z3-ERROR, e.g. for an unknown LOGIC."
  (check-type logic (or null string))
  (check-type timeout (or null (real (0))))
  (let ((solver (with-encoded-text (text (or logic ""))
                  (calling-z3 (pointer context)
                    (let ((address (foreign:with-c-float-traps
                                     (if logic
                                         (z3-mk-solver-for-logic
                                          pointer (z3-mk-string-symbol pointer text))
                                         (z3-mk-solver pointer)))))
                      (unless (zerop address)
                        (z3-solver-inc-ref pointer address)
                        (%make-solver context address timeout)))))))
    (configure-solver solver timeout)
    solver))

(defun forget-model (solver)
  "Drop the model of SOLVER's last check."
  (let ((model (shiftf (solver-model solver) nil)))
    (when (integerp model)
      (calling-z3 (pointer (solver-context solver))
        (z3-model-dec-ref pointer model)))))

(defun close-solver (solver)
  "Release SOLVER; do nothing if that was done before or its context is closed.  Using it afterwards
signals Z3-ERROR."
  (sb-sys:without-interrupts
    (let ((pointer (context-pointer (solver-context solver)))
          (address (shiftf (solver-pointer solver) 0)))
      (unless (or (zerop pointer) (zerop address))
        (forget-model solver)
        (z3-solver-dec-ref pointer address))))
  (values))

(defmacro with-solver ((variable context &rest options) &body body)
  "Evaluate BODY with VARIABLE bound to a new solver in CONTEXT, made with OPTIONS as MAKE-SOLVER
has them and closed at the end; return the values of BODY."
  (let ((solver (gensym "SOLVER")))
    `(let ((,solver (make-solver ,context ,@options)))
       (unwind-protect (let ((,variable ,solver)) ,@body)
         (close-solver ,solver)))))

;;; Assertions

(defun solver-assert (solver proposition)
  "Add PROPOSITION to the current scope of SOLVER.  The model of the last check is gone then.
Signals Z3-ERROR."
  (check-type proposition proposition)
  (let ((term (and (term-p proposition)
                   (live-pointer proposition (solver-context solver)))))
    (forget-model solver)
    (unless (eq proposition t)
      (calling-solver (pointer address solver)
        (z3-solver-assert pointer address (or term (z3-mk-false pointer))))))
  (values))

(defun push-scope (solver)
  "Open a scope in SOLVER: POP-SCOPE removes what is asserted from now on.  The model of the last
check is gone then.  Signals Z3-ERROR."
  (forget-model solver)
  (calling-solver (pointer address solver)
    (foreign:with-c-float-traps (z3-solver-push pointer address)))
  (values))

(defun scope-count (solver)
  "Return the number of open scopes of SOLVER."
  (calling-solver (pointer address solver)
    (z3-solver-get-num-scopes pointer address)))

(defun pop-scope (solver &optional (count 1))
  "Close the COUNT latest scopes of SOLVER.  The model of the last check is gone then.  Signals
Z3-ERROR, and changes nothing, if there are fewer scopes."
  (check-type count (unsigned-byte 31))
  (let ((scopes (scope-count solver)))
    (when (> count scopes)
      (misuse :index-out-of-bounds
              "~d scope~:p cannot be popped where ~d ~:*~[are~;is~:;are~] open" count scopes)))
  (forget-model solver)
  (calling-solver (pointer address solver)
    (foreign:with-c-float-traps (z3-solver-pop pointer address count)))
  (values))

(defun solver-smt-lib (solver)
  "Return what SOLVER holds as a string of SMT-LIB 2 commands: declarations and assertions."
  (calling-solver (pointer address solver)
    (decode (z3-solver-to-string pointer address))))
