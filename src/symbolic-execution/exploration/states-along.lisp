;;;; States along given steps, without a plan.

(in-package #:discrepancy-finder.symbolic-execution)

(defun make-path-oracle (ground &key numeric timeout options)
  "Return an open oracle for paths of the theory GROUND; NUMERIC if there are numbers apart from its
fluents.  Its questions are many and small: Z3's engine for QF_UF, which keeps what it has learnt,
is some ten times faster there than the one for QF_FD.  TIMEOUT and OPTIONS are the solver's."
  (let ((logic (if (or numeric (ec:ground-numeric-p ground)) nil "QF_UF")))
    (open-oracle (make-oracle
                  :make-solver (lambda (context)
                                 (z3:make-solver context :logic logic :timeout timeout
                                                         :options options))))))

(defun states-along (ground fluents steps)
  "Return the concrete states of the theory GROUND along STEPS from the state in which just
FLUENTS, a list of ground fluents, hold: the least ones, in the order of time and of the fluents,
that the theory allows.  If it allows none return NIL and the number of the first step that it
forbids, counted from 1, or 0 if it forbids the first state."
  (let ((oracle (make-path-oracle ground)))
    (unwind-protect (concrete-states oracle ground fluents steps)
      (close-oracle oracle))))

(defun concrete-states (oracle ground fluents steps)
  "Do what STATES-ALONG does with an open ORACLE."
  (let* ((state (ec:concrete-state ground
                                   (lambda (atom) (and (member atom fluents :test #'equal) t))
                                   :context (oracle-context oracle)))
         (states (list state)))
    (flet ((refused-p (conditions)
             (loop for (nil . proposition) in conditions
                   do (oracle-assume oracle proposition))
             (eq (ask oracle) :unsat)))
      (when (refused-p (ec:initial-conditions state))
        (return-from concrete-states (values '() 0)))
      (loop for step in steps
            for number from 1
            do (multiple-value-bind (next conditions)
                   (ec:progress (first states) (ec:event-number ground (step-event step)))
                 (when (refused-p conditions)
                   (return-from concrete-states (values '() number)))
                 (push next states)))
      (values (least-states oracle (nreverse states)) nil))))
