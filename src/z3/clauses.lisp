;;;; Clauses in bulk.
;;;;
;;;; A bounded theory is some 100 000 clauses over some 10 000 propositional variables.  To make a
;;;; TERM for each of their parts would take seconds.  A CLAUSE-SET numbers the variables instead:
;;;; 1, 2, 3, ...  A LITERAL is a fixnum, +N for the variable N and -N for its negation, and a
;;;; clause is the literals of a vector up to a 0, as in the DIMACS format.  The clause set holds
;;;; the addresses of its literals in one vector, so that a clause costs a few calls of Z3 and no
;;;; memory in Lisp.
;;;;
;;;; Entry points: MAKE-CLAUSE-SET, ASSERT-CLAUSES, CHECK-LITERALS, LITERAL-VALUES.  What is
;;;; asserted goes to the solver of the clause set, where it mixes with other assertions and
;;;; follows the scopes; CLAUSE-SET-TERM leads from a literal to propositions.

(in-package #:discrepancy-finder.z3)

(deftype literals ()
  "Clauses: the literals of each, then 0."
  '(simple-array fixnum (*)))

(defconstant +chunk+ 2000
  "So many clauses are asserted between two chances to interrupt.")

(defstruct (clause-set (:constructor %make-clause-set (solver name-of kept)) (:copier nil))
  "Numbered propositional variables for the clauses of a solver: made by MAKE-CLAUSE-SET, ended by
CLOSE-CLAUSE-SET or with the context."
  (solver nil :type solver :read-only t)
  (name-of nil :type (or null function) :read-only t)
  ;; Z3's vector that owns the literals; 0 when the clause set was closed.
  (kept 0 :type (unsigned-byte 64))
  ;; The largest variable so far.
  (size 0 :type (unsigned-byte 32))
  ;; The addresses of the literals +N and -N at 2N and 2N + 1; 0 for those not made yet.
  (handles (make-handles 64) :type handles))

(setf (documentation 'clause-set-p 'function)
      "Return true if its argument is a CLAUSE-SET."
      (documentation 'clause-set-solver 'function)
      "Return the solver of a clause set."
      (documentation 'clause-set-size 'function)
      "Return the largest variable of a clause set that was mentioned; 0 if none was.")

(defmethod print-object ((clause-set clause-set) stream)
  (print-unreadable-object (clause-set stream :type t :identity t)
    (format stream "of ~d variable~:p" (clause-set-size clause-set))))

;;; Life

(defun make-clause-set (solver &key name-of)
  "Return a new CLAUSE-SET for SOLVER.  Its variables are made when they are first mentioned; the
string that the function NAME-OF returns for the number of one is its name.  Without NAME-OF the
variable N is Z3's integer symbol N, which costs less and is the same variable in all such clause
sets of a context.  Signals Z3-ERROR."
  (check-type solver solver)
  (%make-clause-set solver (and name-of (coerce name-of 'function))
                    (calling-z3 (pointer (solver-context solver))
                      (let ((vector (z3-mk-ast-vector pointer)))
                        (z3-ast-vector-inc-ref pointer vector)
                        vector))))

(defun close-clause-set (clause-set)
  "Release the literals of CLAUSE-SET; its solver keeps what was asserted.  Do nothing if that was
done before or its context is closed.  Using its literals afterwards signals Z3-ERROR."
  (sb-sys:without-interrupts
    (let ((pointer (context-pointer (solver-context (clause-set-solver clause-set))))
          (kept (shiftf (clause-set-kept clause-set) 0)))
      (setf (clause-set-handles clause-set) (make-handles 2)
            (clause-set-size clause-set) 0)
      (unless (or (zerop pointer) (zerop kept))
        (z3-ast-vector-dec-ref pointer kept))))
  (values))

(defmacro with-clause-set ((variable solver &rest options) &body body)
  "Evaluate BODY with VARIABLE bound to a new clause set for SOLVER, made with OPTIONS as
MAKE-CLAUSE-SET has them and closed at the end; return the values of BODY."
  (let ((clause-set (gensym "CLAUSE-SET")))
    `(let ((,clause-set (make-clause-set ,solver ,@options)))
       (unwind-protect (let ((,variable ,clause-set)) ,@body)
         (close-clause-set ,clause-set)))))

;;; Literals

(declaim (inline handle-index))
(defun handle-index (literal)
  (declare (fixnum literal))
  (if (plusp literal) (* 2 literal) (1+ (* -2 literal))))

(defun ensure-size (clause-set variable)
  "Let CLAUSE-SET have room for VARIABLE."
  (when (>= variable +first-tracking-symbol+)
    (misuse :index-out-of-bounds "~d is too large for the number of a variable" variable))
  (let ((handles (clause-set-handles clause-set)))
    (when (> (* 2 (1+ variable)) (length handles))
      (let ((larger (make-handles (max (* 2 (1+ variable)) (* 2 (length handles))))))
        (setf (clause-set-handles clause-set) (replace larger handles))))
    (when (> variable (clause-set-size clause-set))
      (setf (clause-set-size clause-set) variable))))

(defun clause-set-boolean-sort (clause-set)
  (sort-pointer (boolean-sort (solver-context (clause-set-solver clause-set)))))

(defun make-literal (clause-set literal)
  "Make LITERAL, a new one for which CLAUSE-SET has room; return its address."
  (let ((context (solver-context (clause-set-solver clause-set)))
        (handles (clause-set-handles clause-set))
        (name-of (clause-set-name-of clause-set))
        (boolean-sort (clause-set-boolean-sort clause-set))
        (kept (clause-set-kept clause-set)))
    (when (zerop kept)
      (misuse :closed-clause-set "the clause set is closed"))
    (macrolet ((making (form)
                 `(calling-z3 (pointer context)
                    (let ((address ,form))
                      (unless (zerop address)
                        (z3-ast-vector-push pointer kept address)
                        (setf (aref handles (handle-index literal)) address))))))
      (cond ((minusp literal)
             (let ((positive (literal-handle clause-set (- literal))))
               (making (z3-mk-not pointer positive))))
            (name-of
             (with-encoded-text (text (funcall name-of literal))
               (making (z3-mk-const pointer (z3-mk-string-symbol pointer text)
                                    boolean-sort))))
            (t (making (z3-mk-const pointer (z3-mk-int-symbol pointer literal)
                                    boolean-sort)))))))

(defun literal-handle (clause-set literal)
  "Return the address of LITERAL, which is made if need be."
  (when (or (not (integerp literal)) (zerop literal))
    (misuse :invalid-argument "~s is no literal" literal))
  (ensure-size clause-set (abs literal))
  (let ((handle (aref (clause-set-handles clause-set) (handle-index literal))))
    (if (zerop handle) (make-literal clause-set literal) handle)))

(defun ensure-literals (clause-set literals start end)
  "Make the literals of the clauses between START and END of LITERALS.  Return the length of the
longest clause."
  (declare (type literals literals) (type fixnum start end))
  (let ((longest 0) (first start) (largest 0))
    (declare (type fixnum longest first largest))
    (loop for position of-type fixnum from start below end
          for literal = (aref literals position)
          do (if (zerop literal)
                 (setf longest (max longest (- position first))
                       first (1+ position))
                 (setf largest (max largest (abs (max literal (- most-positive-fixnum)))))))
    (when (< first end)
      (misuse :invalid-argument "the last clause does not end with 0"))
    (when (plusp largest)
      (ensure-size clause-set largest))
    (let ((handles (clause-set-handles clause-set)))
      (loop for position of-type fixnum from start below end
            for literal = (aref literals position)
            when (and (/= literal 0) (zerop (aref handles (handle-index literal))))
              do (make-literal clause-set literal)))
    longest))

(defun literal-handles (clause-set literals)
  "Return the addresses of the sequence LITERALS."
  (map 'handles (lambda (literal) (literal-handle clause-set literal)) literals))

(defun clause-set-term (clause-set literal)
  "Return the TERM for LITERAL, a fixnum and not 0, of CLAUSE-SET.  Signals Z3-ERROR."
  (let ((context (solver-context (clause-set-solver clause-set)))
        (handle (literal-handle clause-set literal)))
    (if (plusp literal)
        (making-term (pointer context t) handle)
        (negation (clause-set-term clause-set (- literal))))))

;;; Assertions

(defun assert-chunk (pointer solver record handles literals start end clause)
  "Assert some of the clauses between START and END of LITERALS.  Return the position behind the
last one.  CLAUSE is a vector to work in.  Stop at an error."
  (declare (type (unsigned-byte 64) pointer solver record) (type handles handles clause)
           (type literals literals) (type fixnum start end))
  (let ((position start) (count 0))
    (declare (type fixnum position count))
    (loop repeat +chunk+
          while (< position end)
          do (setf count 0)
             (loop for literal = (aref literals position)
                   until (zerop literal)
                   do (setf (aref clause count) (aref handles (handle-index literal)))
                      (incf count)
                      (incf position))
             (incf position)
             (let ((term (case count
                           (0 (z3-mk-false pointer))
                           (1 (aref clause 0))
                           (t (z3-mk-or pointer count (sb-sys:vector-sap clause))))))
               (unless (and (plusp term)
                            (assert-and-record pointer solver record term))
                 (return))))
    position))

(defun assert-clauses (clause-set literals &key (start 0) end)
  "Assert the clauses that stand between START and END (NIL: the end) of LITERALS, a simple vector
of element type fixnum: the literals of each clause, then 0.  An empty clause is false.  The model
of the last check is gone then.  Signals Z3-ERROR; if that happens in the middle, or the thread is
interrupted, the clauses before have been asserted."
  (check-type literals literals)
  (let* ((end (or end (length literals)))
         (solver (clause-set-solver clause-set)))
    (unless (<= 0 start end (length literals))
      (misuse :index-out-of-bounds "~d to ~d are no bounds of ~d literals" start end
              (length literals)))
    (let* ((clause (make-handles (ensure-literals clause-set literals start end)))
           (handles (clause-set-handles clause-set)))
      (forget-answer solver)
      (loop with position = start
            while (< position end)
            do (setf position
                     (calling-solver (pointer address solver)
                       (sb-sys:with-pinned-objects (clause)
                         (foreign:with-c-float-traps
                           (assert-chunk pointer address (solver-record solver) handles
                                         literals position end clause))))))))
  (values))

(defun assert-at-most (clause-set literals count &key if)
  "Assert that at most COUNT (an integer) of the sequence LITERALS are true; if the literal IF is
given, only where that is true.  A literal counts as often as it occurs.  Signals Z3-ERROR."
  (check-type count integer)
  (let ((handles (literal-handles clause-set literals))
        (guard (and if (literal-handle clause-set if)))
        (solver (clause-set-solver clause-set)))
    (declare (type handles handles))
    (forget-answer solver)
    (when (< count (length handles))
      (calling-solver (pointer address solver)
        (sb-sys:with-pinned-objects (handles)
          (let ((term (if (minusp count)
                          (z3-mk-false pointer)
                          (z3-mk-atmost pointer (length handles) (sb-sys:vector-sap handles)
                                        count))))
            (when (and guard (plusp term))
              (setf term (z3-mk-implies pointer guard term)))
            (when (plusp term)
              (foreign:with-c-float-traps
                (assert-and-record pointer address (solver-record solver) term))))))))
  (values))

;;; Checks and models

(defun check-literals (clause-set literals)
  "Return :SAT if the assertions of the solver of CLAUSE-SET can hold together with the sequence
LITERALS, :UNSAT if they cannot.  FAILED-LITERALS says which are to blame then, and LITERAL-VALUES
and MODEL-VALUE give the model else.  Signals, and can be interrupted, as CHECK."
  (let ((solver (clause-set-solver clause-set))
        (handles (literal-handles clause-set literals)))
    (answer-of solver (lambda ()
                        (check-in-z3 solver handles (coerce literals 'list) clause-set)))))

(defun failed-literals (clause-set)
  "Return the list of those literals of the last CHECK-LITERALS of CLAUSE-SET, in the order given,
that alone contradict the assertions; they need not be a smallest such list.  Signals Z3-ERROR if
that was not the last operation on the solver or did not say :UNSAT."
  (let ((core (read-core (clause-set-solver clause-set))))
    (unless (eq (solver-asker (clause-set-solver clause-set)) clause-set)
      (misuse :no-core "there is no core of these clauses, for the last check was another one"))
    (cdr core)))

(defun literal-values (clause-set &optional variables)
  "Return the truth values of VARIABLES (a sequence, or NIL for all so far) of CLAUSE-SET in the
model of the last check, as a simple bit vector indexed by variable; element 0 means nothing.  A
variable that the model leaves open is false.  Signals Z3-ERROR if there is no model, as MODEL-VALUE
does."
  (let* ((solver (clause-set-solver clause-set))
         (model (read-model solver))
         (size (clause-set-size clause-set))
         (handles (clause-set-handles clause-set))
         (bits (make-array (1+ size) :element-type 'bit :initial-element 0))
         (value (make-handles 1)))
    (declare (type (unsigned-byte 64) model) (type (unsigned-byte 32) size))
    (map nil (lambda (variable)
               (unless (and (typep variable 'fixnum) (<= 1 variable size))
                 (misuse :index-out-of-bounds "~s is no variable of the clause set" variable)))
         variables)
    (flet ((read-from (pointer true variable)
             (declare (type (unsigned-byte 64) pointer true) (type (unsigned-byte 32) variable))
             (let ((handle (aref handles (* 2 variable))))
               (unless (zerop handle)
                 (let ((known (z3-model-get-const-interp
                               pointer model (z3-get-app-decl pointer handle))))
                   (when (or (= known true)
                             (and (zerop known)
                                  (z3-model-eval pointer model handle t (sb-sys:vector-sap value))
                                  (= (aref value 0) true)))
                     (setf (sbit bits variable) 1)))))))
      (declare (inline read-from))
      (calling-z3 (pointer (solver-context solver))
        (sb-sys:with-pinned-objects (value)
          (foreign:with-c-float-traps
            (let ((true (z3-mk-true pointer)))
              (if variables
                  (map nil (lambda (variable)
                             (read-from pointer true variable))
                       variables)
                  (loop for variable from 1 to size
                        do (read-from pointer true variable))))))))
    bits))
