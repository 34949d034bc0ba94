;;;; States along given steps, without a plan.

(in-package #:discrepancy-finder.symbolic-execution)

(defun path-logic (ground &optional numeric)
  "Return the logic of Z3's engine for paths of the theory GROUND; NUMERIC if there are numbers
apart from its fluents.  The questions are many and small: the engine for QF_UF, which keeps what
it has learnt, is some ten times faster there than the one for QF_FD."
  (if (or numeric (ec:ground-numeric-p ground)) nil "QF_UF"))

(defun make-path-oracle (ground &key numeric timeout options signals-unknown)
  "Return an open oracle for paths of the theory GROUND; NUMERIC if there are numbers apart from its
fluents.  TIMEOUT and OPTIONS are the solver's; SIGNALS-UNKNOWN lets SOLVER-UNKNOWN pass."
  (let ((logic (path-logic ground numeric)))
    (open-oracle (make-oracle
                  :signals-unknown signals-unknown
                  :make-solver (lambda (context)
                                 (z3:make-solver context :logic logic :timeout timeout
                                                         :options options))))))

(defun states-along (ground fluents steps &key states context)
  "Return the concrete states of the theory GROUND along STEPS from the state in which just
FLUENTS, a list of ground fluents, hold: the least ones, in the order of time and of the fluents,
that the theory allows.  With STATES, a list of (true fluents, numbers), they must be these.  If the
theory allows none return NIL and the number of the first step that it forbids, counted from 1, or 0
if it forbids the first state.  CONTEXT is a Z3 context to use, or NIL for a new one."
  (if (null context)
      (z3:with-context (context)
        (states-along ground fluents steps :states states :context context))
      (z3:with-released-terms (context)
        (z3:with-solver (solver context :logic (path-logic ground))
          (concrete-states (oracle-with context solver) ground fluents steps states)))))

(defun assume-state (oracle state fluents numbers)
  "Assume that just FLUENTS hold in STATE and that its numbers are NUMBERS."
  (loop for atom across (ec:ground-theory-fluents (ec:state-ground state))
        for proposition across (ec:state-values state)
        do (oracle-assume oracle (if (member atom fluents :test #'equal)
                                     proposition
                                     (z3:negation proposition))))
  (loop for term across (ec:state-numbers state)
        for number in numbers
        do (oracle-assume oracle (z3:equals term number))))

(defun concrete-states (oracle ground fluents steps given)
  "Do what STATES-ALONG does with an open ORACLE."
  (let* ((state (ec:concrete-state ground
                                   (lambda (atom) (and (member atom fluents :test #'equal) t))
                                   :context (oracle-context oracle)))
         (states (list state)))
    (flet ((refused-p (state conditions)
             (loop for (nil . proposition) in conditions
                   do (oracle-assume oracle proposition))
             (when given
               (destructuring-bind (fluents numbers) (pop given)
                 (assume-state oracle state fluents numbers)))
             (eq (ask oracle) :unsat)))
      (when (refused-p state (ec:initial-conditions state))
        (return-from concrete-states (values '() 0)))
      (loop for step in steps
            for number from 1
            do (multiple-value-bind (next conditions)
                   (ec:progress (first states) (ec:event-number ground (step-event step)))
                 (when (refused-p next conditions)
                   (return-from concrete-states (values '() number)))
                 (push next states)))
      (values (least-states oracle (nreverse states)) nil))))
