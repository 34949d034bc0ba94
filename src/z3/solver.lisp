;;;; Solvers: sets of assertions with scopes.
;;;;
;;;; Entry points: MAKE-SOLVER, WITH-SOLVER, SOLVER-ASSERT, PUSH-SCOPE, POP-SCOPE; see check.lisp
;;;; for the questions.  A solver that is not closed lives as long as its context.
;;;;
;;;; Z3's engines rewrite what is asserted, so that it cannot be read back from them; the solver
;;;; therefore keeps a RECORD of it, from which smt-lib.lisp writes.
;;;;
;;;; A TRACKED assertion F has a LABEL, which UNSAT-CORE gives if F is to blame.  It is asserted as
;;;; p => F, where the literal p is assumed in every check while the scope of the assertion lasts.

(in-package #:discrepancy-finder.z3)

(defconstant +first-tracking-symbol+ (expt 2 24)
  "The integer symbols from here on name the literals of tracked assertions, those below name
variables of clause sets.  They are used again and again, since Z3 never forgets a string.")

(defstruct (tracked (:constructor make-tracked (label number literal index)) (:copier nil))
  "A tracked assertion: how many were tracked before it, the address of the literal that is assumed
for it, one reference of which it owns, and its index in the record."
  (label nil :type t :read-only t)
  (number 0 :type (unsigned-byte 29) :read-only t)
  (literal 0 :type (unsigned-byte 64) :read-only t)
  (index 0 :type (unsigned-byte 32) :read-only t))

(defstruct (solver (:constructor %make-solver (context pointer record timeout)) (:copier nil))
  "A solver of Z3: made by MAKE-SOLVER, ended by CLOSE-SOLVER or with its context."
  (context nil :type context :read-only t)
  ;; 0 when the solver was closed.
  (pointer 0 :type (unsigned-byte 64))
  ;; Z3's vector of the assertions, and its size at the beginning of each scope, latest first.
  (record 0 :type (unsigned-byte 64))
  (marks '() :type list)
  ;; The tracked assertions, latest first.
  (tracked '() :type list)
  (timeout nil :type (or null real) :read-only t)
  ;; NIL; :UNREAD: the last check said :SAT and Z3 holds the model; or the model's address.
  (model nil :type (or null (eql :unread) (unsigned-byte 64)))
  ;; NIL; :UNREAD: the last check said :UNSAT and Z3 holds the core; or (labels . assumptions).
  (core nil :type (or null (eql :unread) cons))
  ;; What the last check assumed: its objects, their addresses, and the clause set of numbers.
  (assumptions '() :type list)
  (assumed (make-handles 0) :type handles)
  (asker nil :type t))

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

(defun set-options (solver options)
  "Set OPTIONS, an alist from names to values, as MAKE-SOLVER has them, in SOLVER."
  (calling-solver (pointer address solver)
    (let ((parameters (z3-mk-params pointer)))
      (z3-params-inc-ref pointer parameters)
      (loop for (name . value) in options
            do (with-encoded-text (text name)
                 (let ((key (z3-mk-string-symbol pointer text)))
                   (etypecase value
                     (boolean (z3-params-set-bool pointer parameters key value))
                     ((unsigned-byte 32) (z3-params-set-uint pointer parameters key value))
                     (double-float (z3-params-set-double pointer parameters key value))
                     (string (with-encoded-text (text value)
                               (z3-params-set-symbol pointer parameters key
                                                     (z3-mk-string-symbol pointer text))))))))
      (z3-params-dec-ref pointer (prog1 parameters
                                   (z3-solver-set-params pointer address parameters))))))

(defun make-solver (context &key (logic "QF_FD") timeout seed options)
  "Return a new SOLVER in CONTEXT.  LOGIC is the name of an SMT-LIB logic, which picks Z3's engine,
or NIL for Z3's default engine; QF_FD, propositions and finite domains, is the one measured best for
propositions, and cannot tell where numbers occur.  A check ends TIMEOUT seconds of wall-clock time
after its begin (a positive real, or NIL for no limit), or a fiftieth of a second later.  The search
starts from SEED, a natural number, or from Z3's own if it is NIL; the same calls in a new context
with the same seed give the same answers and models.  OPTIONS is an alist from names of options of
Z3's engine to natural numbers, double floats, T, NIL, or words as strings.  Signals Z3-ERROR, e.g.
for an unknown LOGIC; an unknown option is found out by the first assertion or check."
  (check-type logic (or null string))
  (check-type timeout (or null (real (0))))
  (check-type seed (or null (unsigned-byte 32)))
  (loop for (name . value) in options
        do (check-type name string)
           (check-type value (or boolean (unsigned-byte 32) double-float string)))
  (let ((solver (with-encoded-text (text (or logic ""))
                  (calling-z3 (pointer context)
                    (let ((address (foreign:with-c-float-traps
                                     (if logic
                                         (z3-mk-solver-for-logic
                                          pointer (z3-mk-string-symbol pointer text))
                                         (z3-mk-solver pointer)))))
                      (unless (zerop address)
                        (z3-solver-inc-ref pointer address)
                        (let ((record (z3-mk-ast-vector pointer)))
                          (z3-ast-vector-inc-ref pointer record)
                          (%make-solver context address record timeout))))))))
    (set-options solver
                 ;; Z3 would put its own handler of SIGINT in the place of SBCL's.
                 (acons "ctrl_c" nil
                        (if seed (acons "random_seed" seed options) options)))
    solver))

(defun forget-answer (solver)
  "Drop the model or core of SOLVER's last check."
  (setf (solver-core solver) nil)
  (let ((model (shiftf (solver-model solver) nil)))
    (when (integerp model)
      (calling-z3 (pointer (solver-context solver))
        (z3-model-dec-ref pointer model)))))

(defun forget-tracked (pointer solver size)
  "Release the tracked assertions of SOLVER behind the first SIZE ones of the record."
  (loop while (and (solver-tracked solver)
                   (>= (tracked-index (first (solver-tracked solver))) size))
        do (z3-dec-ref pointer (tracked-literal (pop (solver-tracked solver))))))

(defun close-solver (solver)
  "Release SOLVER; do nothing if that was done before or its context is closed.  Using it afterwards
signals Z3-ERROR."
  (sb-sys:without-interrupts
    (let ((pointer (context-pointer (solver-context solver)))
          (address (shiftf (solver-pointer solver) 0)))
      (unless (or (zerop pointer) (zerop address))
        (forget-answer solver)
        (forget-tracked pointer solver 0)
        (z3-ast-vector-dec-ref pointer (shiftf (solver-record solver) 0))
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

(declaim (inline assert-and-record))
(defun assert-and-record (pointer address record term)
  "Assert TERM and record it; return true.  Return NIL if Z3 refuses it."
  (z3-solver-assert pointer address term)
  (when (zerop (z3-get-error-code pointer))
    (z3-ast-vector-push pointer record term)
    t))

(defun assert-tracked (solver proposition label)
  "Add PROPOSITION to the current scope of SOLVER under LABEL."
  (let* ((context (solver-context solver))
         (boolean-sort (boolean-sort context))
         (term (argument-pointer proposition boolean-sort))
         (given-literal (if (term-p label) (live-pointer label context) 0))
         (last (first (solver-tracked solver)))
         (number (if last (1+ (tracked-number last)) 0)))
    (forget-answer solver)
    (calling-solver (pointer address solver)
      (let ((literal (if (zerop given-literal)
                         (z3-mk-const pointer
                                      (z3-mk-int-symbol pointer (+ +first-tracking-symbol+ number))
                                      (sort-pointer boolean-sort))
                         given-literal))
            (index (z3-ast-vector-size pointer (solver-record solver))))
        (z3-inc-ref pointer literal)
        (if (assert-and-record pointer address (solver-record solver)
                               (z3-mk-implies pointer literal term))
            (push (make-tracked label number literal index) (solver-tracked solver))
            (z3-set-error pointer (prog1 (z3-get-error-code pointer)
                                    (z3-dec-ref pointer literal))))))))

(defun solver-assert (solver proposition &key track)
  "Add PROPOSITION to the current scope of SOLVER.  The model of the last check is gone then.

If TRACK is given UNSAT-CORE tells whether PROPOSITION was needed to contradict the others: TRACK is
its label, any object that is not NIL.  Assertions with EQUAL labels are one for UNSAT-CORE.  A TERM
as label must be a literal; that is assumed to be true then, and is no other assertion's.  Tracking
makes checks slower.  Signals Z3-ERROR."
  (check-type proposition proposition)
  (let ((term (and (term-p proposition)
                   (proposition-pointer 'solver-assert proposition (solver-context solver)))))
    (cond ((null track)
           (forget-answer solver)
           (unless (eq proposition t)
             (calling-solver (pointer address solver)
               (assert-and-record pointer address (solver-record solver)
                                  (or term (z3-mk-false pointer))))))
          ((and (term-p track) (not (literal-p track)))
           (misuse :invalid-argument "~a is no literal and cannot be a label" (term-text track)))
          (t (assert-tracked solver proposition track))))
  (values))

;;; Scopes

(defun push-scope (solver)
  "Open a scope in SOLVER: POP-SCOPE removes what is asserted from now on.  The model of the last
check is gone then.  Signals Z3-ERROR."
  (forget-answer solver)
  (calling-solver (pointer address solver)
    (foreign:with-c-float-traps (z3-solver-push pointer address))
    (when (zerop (z3-get-error-code pointer))
      (push (z3-ast-vector-size pointer (solver-record solver)) (solver-marks solver))))
  (values))

(defun scope-count (solver)
  "Return the number of open scopes of SOLVER."
  (length (solver-marks solver)))

(defun pop-scope (solver &optional (count 1))
  "Close the COUNT latest scopes of SOLVER.  The model of the last check is gone then.  Signals
Z3-ERROR, and changes nothing, if there are fewer scopes."
  (check-type count (unsigned-byte 31))
  (calling-solver (pointer address solver) 0)
  (when (> count (scope-count solver))
    (misuse :index-out-of-bounds "~d scope~:p cannot be popped where ~d ~:*~[are~;is~:;are~] open"
            count (scope-count solver)))
  (forget-answer solver)
  (calling-solver (pointer address solver)
    (foreign:with-c-float-traps (z3-solver-pop pointer address count))
    (when (plusp count)
      (let ((size (nth (1- count) (solver-marks solver))))
        (setf (solver-marks solver) (nthcdr count (solver-marks solver)))
        (forget-tracked pointer solver size)
        (z3-ast-vector-resize pointer (solver-record solver) size))))
  (values))
