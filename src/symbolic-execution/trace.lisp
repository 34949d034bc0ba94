;;;; Execution traces: what a plan does to the world, according to the theory.
;;;;
;;;; An EXECUTION-TRACE has a concrete initial state, the steps that the plan performs from it, and
;;;; the states that follow by the theory.  It is made from a path on which a state constraint comes
;;;; true, cut after the last timepoint at which it does; the path may go on to a failure, or to
;;;; where the theory allows nothing.  The initial state is the least that the path allows, with
;;;; false before true in the order of the fluents: a function of the path alone.

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
        for value = (not (eq (z3:check solver (list (z3:negation proposition))) :sat))
        do (z3:solver-assert solver (if value proposition (z3:negation proposition)))
        collect value))

(defun states-along (initial-state steps)
  "Return the states of the theory from the concrete INITIAL-STATE along STEPS."
  (let* ((ground (ec:state-ground initial-state))
         (states (list initial-state)))
    (dolist (step steps (nreverse states))
      (push (ec:progress (first states) (ec:event-number ground (step-event step))) states))))

(defun instance-time (path formula span)
  "Return the last timepoint at which the ground FORMULA of a state constraint can be true on PATH,
and its proposition there; or NIL."
  (let ((states (reverse (path-states path)))
        (events (loop for step in (reverse (path-steps path))
                      collect (ec:event-number (action-theory-ground (path-domain path))
                                               (step-event step)))))
    (loop for time from (- (length states) span 1) downto 0
          for proposition = (ec:holds formula (nthcdr time states) (or (nthcdr time events) '(nil)))
          when (possible-p path proposition)
            return (values time proposition))))

(defun path-trace (path formula span argument-propositions)
  "Return the trace of the state constraint with the ground FORMULA over SPAN steps on PATH, or NIL
if it comes true nowhere on it."
  (multiple-value-bind (time proposition) (instance-time path formula span)
    (when time
      (let ((solver (path-solver path))
            (initial (first (last (path-states path)))))
        (z3:push-scope solver)
        (z3:solver-assert solver proposition)
        (let* ((values (least-values solver (append argument-propositions
                                                    (coerce (ec:state-values initial) 'list))))
               (arguments (subseq values 0 (length argument-propositions)))
               (fluents (nthcdr (length argument-propositions) values))
               (steps (subseq (reverse (path-steps path)) 0 (+ time span))))
          (z3:pop-scope solver)
          (make-execution-trace
           :plan (path-plan path) :arguments arguments :steps steps
           :states (states-along (ec:concrete-state (action-theory-ground (path-domain path))
                                                    (lambda (atom)
                                                      (declare (ignore atom))
                                                      (pop fluents)))
                                 steps)))))))
