;;;; Execution traces: what a plan does to the world, according to the theory.
;;;;
;;;; An EXECUTION-TRACE has a concrete initial state, the steps that the plan performs from it, and
;;;; the states that follow by the theory.  It is made from a path on which a state constraint
;;;; comes true, cut after the last timepoint at which it does; the path may go on to a failure, or
;;;; to where the theory allows nothing.  The initial state is the least that the path allows, with
;;;; false before true in the order of the fluents: a function of the path alone.  So are the
;;;; states that follow, where the theory leaves a choice.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (execution-trace (:conc-name trace-) (:copier nil))
  "STATES begins with the initial state and has one element more than STEPS.  ARGUMENTS are the
plan's."
  (plan nil :type symbol :read-only t)
  (arguments '() :type list :read-only t)
  (steps '() :type list :read-only t)
  (states '() :type cons :read-only t))

(setf (documentation 'make-execution-trace 'function)
      "Return a new execution trace."
      (documentation 'trace-plan 'function)
      "Return the symbol that names the plan of a trace."
      (documentation 'trace-arguments 'function)
      "Return the list of the arguments of the plan of a trace."
      (documentation 'trace-steps 'function)
      "Return the list of the steps of a trace."
      (documentation 'trace-states 'function)
      "Return the list of the states of a trace, the initial one first.")

(defun trace-initial-state (trace)
  "Return the discrete initial state of TRACE."
  (first (trace-states trace)))

(defun trace-final-state (trace)
  "Return the discrete state at the end of TRACE, according to the theory."
  (first (last (trace-states trace))))

(defmethod print-object ((trace execution-trace) stream)
  (print-unreadable-object (trace stream :type t)
    (format stream "~(~a~): ~d step~:p,~{ ~a~} ->~{ ~a~}" (trace-plan trace)
            (length (trace-steps trace))
            (mapcar #'ec:atom-text (ec:state-fluents (trace-initial-state trace)))
            (mapcar #'ec:atom-text (ec:state-fluents (trace-final-state trace))))))

(defun step-text (step)
  "Return the text of STEP's event and outcome."
  (format nil "~:[nothing happens~;~:*~a~], ~a"
          (and (step-event step) (ec:atom-text (step-event step)))
          (ec:name-text (step-outcome step))))

(defun trace-text (trace)
  "Return a text that is the same for two traces if and only if plan, arguments, initial state,
events and outcomes are."
  (with-standard-io-syntax
    (format nil "~(~a~) ~s~%~{~a~%~}~{~a~%~}" (symbol-name (trace-plan trace))
            (trace-arguments trace)
            (mapcar #'ec:atom-text (ec:state-fluents (trace-initial-state trace)))
            (mapcar #'step-text (trace-steps trace)))))

(defun least-values (solver propositions)
  "Return the least list of truth values of PROPOSITIONS that the SOLVER allows, and add them to
its assertions."
  (loop for proposition in propositions
        for value = (if (z3:term-p proposition)
                        (not (eq (z3:check solver (list (z3:negation proposition))) :sat))
                        proposition)
        do (z3:solver-assert solver (if value proposition (z3:negation proposition)))
        collect value))

(defun fix-numbers (solver numbers)
  "Add to the assertions of SOLVER values for the terms among NUMBERS, one after the other: 0 where
that is allowed, else what Z3 finds first."
  (dolist (number numbers)
    (when (z3:term-p number)
      (let ((zero (z3:equals number 0)))
        (if (eq (z3:check solver (list zero)) :sat)
            (z3:solver-assert solver zero)
            (let ((value (progn (z3:check solver) (z3:model-value solver number))))
              (when (rationalp value)
                (z3:solver-assert solver (z3:equals number value)))))))))

(defun least-states (solver states)
  "Return STATES, which follow each other, with truth values for their propositions: the least that
SOLVER allows, the earlier state first."
  (let ((concrete '()))
    (dolist (state states)
      (least-values solver (ec:state-propositions state))
      (fix-numbers solver (coerce (ec:state-numbers state) 'list))
      ;; Where the theory leaves nothing open the initial state has settled the rest.
      (when (every #'ec:state-determined-p states)
        (return)))
    (z3:check solver)
    (dolist (state states (nreverse concrete))
      (push (ec:state-in-model state (lambda (term) (z3:model-value solver term))
                               (first concrete))
            concrete))))

(defun make-path-solver (context ground)
  "Return a solver for paths of the theory GROUND.  Its questions are many and small: Z3's engine
for QF_UF, which keeps what it has learnt, is some ten times faster there than the one for QF_FD."
  (z3:make-solver context :logic (if (ec:ground-numeric-p ground) nil "QF_UF")))

(defun states-along (ground fluents steps)
  "Return the concrete states of the theory GROUND along STEPS from the state in which just
FLUENTS, a list of ground fluents, hold: the least ones, in the order of time and of the fluents,
that the theory allows.  If it allows none return NIL and the number of the first step that it
forbids, counted from 1, or 0 if it forbids the first state."
  (z3:with-context (context)
    (let* ((solver (make-path-solver context ground))
           (state (ec:concrete-state ground
                                     (lambda (atom) (and (member atom fluents :test #'equal) t))
                                     :context context))
           (states (list state)))
      (flet ((allowed-p (conditions)
               (loop for (nil . proposition) in conditions
                     do (z3:solver-assert solver proposition))
               (eq (z3:check solver) :sat)))
        (unless (allowed-p (ec:initial-conditions state))
          (return-from states-along (values '() 0)))
        (loop for step in steps
              for number from 1
              do (multiple-value-bind (next conditions)
                     (ec:progress (first states) (ec:event-number ground (step-event step)))
                   (unless (allowed-p conditions)
                     (return-from states-along (values '() number)))
                   (push next states)))
        (values (least-states solver (nreverse states)) nil)))))

(defun instance-time (path formula span)
  "Return the last timepoint at which the ground FORMULA of a state constraint can be true on PATH,
and its proposition there; or NIL."
  (let ((states (reverse (path-states path))))
    (loop for time from (- (length states) span 1) downto 0
          for proposition = (ec:holds formula (nthcdr time states))
          when (possible-p path proposition)
            return (values time proposition))))

(defun path-trace (path formula span argument-propositions)
  "Return the trace of the state constraint with the ground FORMULA over SPAN steps on PATH, or NIL
if it comes true nowhere on it."
  (multiple-value-bind (time proposition) (instance-time path formula span)
    (when time
      (let ((solver (path-solver path)) (length (+ time span)))
        (z3:push-scope solver)
        (z3:solver-assert solver proposition)
        (let ((arguments (least-values solver argument-propositions))
              (states (least-states solver (subseq (reverse (path-states path)) 0 (1+ length)))))
          (z3:pop-scope solver)
          (make-execution-trace
           :plan (path-plan path) :arguments arguments :states states
           :steps (subseq (reverse (path-steps path)) 0 length)))))))
