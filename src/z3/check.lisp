;;;; Checks and cores.
;;;;
;;;; CHECK asks whether the assertions of a solver can hold together; if they cannot, UNSAT-CORE
;;;; tells which of them and of the assumptions are to blame.  See models.lisp for the way in which
;;;; they can.  Z3's third answer, `unknown', is a condition and no answer.

(in-package #:discrepancy-finder.z3)

;;; One check

(defun with-tracked-literals (solver assumed)
  "Return the addresses ASSUMED after those that SOLVER assumes for its tracked assertions."
  (let ((tracked (solver-tracked solver)))
    (if tracked
        (concatenate 'handles (nreverse (mapcar #'tracked-literal tracked)) assumed)
        assumed)))

(defvar *timeout* nil
  "The time (s) that a check may take, or NIL for any.")

(defun check-in-z3 (solver assumed assumptions &optional asker)
  "Make the check, with the assumptions at the addresses ASSUMED, which are ASSUMPTIONS, of the
clause set ASKER if they are numbers.  Return :SAT, :UNSAT, or :UNKNOWN and the reason."
  (declare (type handles assumed))
  (let* ((context (solver-context solver))
         (terms (with-tracked-literals solver assumed)) (count (length terms)))
    (declare (type handles terms))
    (forget-answer solver)
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
                                             pointer address)))))))))
         *timeout*)
      (cond ((eq reason :closed) (misuse :closed-solver "the solver is closed"))
            ((consp reason) (signal-z3-error (car reason) (cdr reason))))
      (case answer
        (:sat (setf (solver-model solver) :unread))
        (:unsat (setf (solver-core solver) :unread
                      (solver-assumed solver) assumed
                      (solver-assumptions solver) assumptions
                      (solver-asker solver) asker)))
      (values answer reason))))

(defun check-literal-terms (solver terms)
  "Do as CHECK-IN-Z3 does with the list TERMS, which are literals."
  (let ((context (solver-context solver)))
    (check-in-z3 solver
                 (map 'handles (lambda (term) (live-pointer term context)) terms)
                 terms)))

(defun check-in-scope (solver propositions)
  "Do as CHECK-IN-Z3 does with any terms: assert them, in a scope, for the time of the check."
  (let* ((context (solver-context solver))
         (terms (map 'handles
                     (lambda (proposition) (proposition-pointer 'check proposition context))
                     propositions)))
    (unwind-protect
         (progn
           (forget-answer solver)
           (calling-solver (pointer address solver)
             (foreign:with-c-float-traps (z3-solver-push pointer address))
             (loop for term across (the handles terms)
                   while (zerop (z3-get-error-code pointer))
                   do (z3-solver-assert pointer address term)))
           (multiple-value-bind (answer reason) (check-in-z3 solver (make-handles 0) '())
             ;; What Z3 holds is gone with the scope.
             (case answer
               (:sat (read-model solver))
               (:unsat (setf (solver-core solver)
                             (cons (and (solver-tracked solver) (car (read-core solver)))
                                   propositions))))
             (values answer reason)))
      (calling-solver (pointer address solver)
        (z3-solver-pop pointer address
                       (- (z3-solver-get-num-scopes pointer address) (scope-count solver)))))))

;;; Checks until there is an answer

(defun read-timeout ()
  "Ask the user for the argument of RETRY-WITH-TIMEOUT."
  (loop
    (format *query-io* "~&Seconds: ")
    (finish-output *query-io*)
    (let ((seconds (let ((*read-eval* nil)) (read *query-io*))))
      (when (typep seconds '(real (0)))
        (return (list seconds))))))

(defun answer-of (solver ask)
  "Call ASK, which makes one check of SOLVER, until there is an answer, and return it.  Signal
SOLVER-UNKNOWN, with its restarts, when there is none."
  (let ((timeout (solver-timeout solver)))
    (loop
      (multiple-value-bind (answer reason) (let ((*timeout* timeout)) (funcall ask))
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
    (forget-answer solver)
    (setf (solver-asker solver) nil
          (solver-core solver) (list '() nil))
    (return-from check :unsat))
  (let ((assumptions (remove t assumptions)))
    (answer-of solver
               (if (every #'literal-p assumptions)
                   (lambda () (check-literal-terms solver assumptions))
                   (lambda () (check-in-scope solver assumptions))))))

;;; Cores

(defun core-addresses (solver)
  "Return a table whose keys are the addresses of the literals in the core that Z3 holds."
  (let ((addresses (make-hash-table)))
    (calling-solver (pointer address solver)
      (let ((core (z3-solver-get-unsat-core pointer address)))
        (unless (zerop core)
          (z3-ast-vector-inc-ref pointer core)
          (dotimes (index (z3-ast-vector-size pointer core))
            (setf (gethash (z3-ast-vector-get pointer core index) addresses) t))
          (z3-ast-vector-dec-ref pointer core))))
    addresses))

(defun read-core (solver)
  "Return (labels . assumptions): those of the last check of SOLVER that are in its core, in order.
Signal Z3-ERROR if there is none."
  (case (solver-core solver)
    ((nil) (misuse :no-core "there is no core, for the last operation on the solver was not a ~
                             check that said :unsat"))
    (:unread
     (let ((addresses (core-addresses solver)) (seen (make-hash-table :test 'equal)))
       (flet ((in-core-p (address) (gethash address addresses)))
         (setf (solver-core solver)
               (cons (loop for tracked in (reverse (solver-tracked solver))
                           for label = (tracked-label tracked)
                           when (and (in-core-p (tracked-literal tracked))
                                     (not (shiftf (gethash label seen) t)))
                             collect label)
                     (loop for assumption in (solver-assumptions solver)
                           for address across (solver-assumed solver)
                           when (in-core-p address)
                             collect assumption))))))
    (t (solver-core solver))))

(defun unsat-core (solver)
  "Return the list of what is to blame for the answer :UNSAT of SOLVER's last check: the labels of
the tracked assertions and then the assumptions, in their order, that alone contradict the other
assertions.  They need not be a smallest such list.  If an assumption was no literal, all are in the
list.  Signals Z3-ERROR if the last operation on the solver was not a check that said :UNSAT."
  (let ((core (read-core solver)))
    (append (car core) (cdr core))))
