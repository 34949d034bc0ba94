;;;; Execution traces: what a plan does to the world, according to the theory.
;;;;
;;;; An EXECUTION-TRACE has a concrete initial state, the steps that the plan performs from it, and
;;;; the states that follow by the theory.  Its ALTERNATIVES begin in other states and take the same
;;;; path.  Traces are made in traces-of-paths.lisp.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (trace-decision (:conc-name taken-) (:copier nil))
  "What a plan decides on the way of a trace, but for the outcomes of its steps: the TEXT of the
form with its source position, the text of the CHOICE, and TIME, the number of steps before."
  (text "" :type string :read-only t)
  (choice "" :type string :read-only t)
  (time 0 :type (integer 0) :read-only t))

(setf (documentation 'taken-text 'function)
      "Return the text of a decision on a trace: a form of the plan with its source position."
      (documentation 'taken-choice 'function)
      "Return the text of what a decision on a trace is for, e.g. t."
      (documentation 'taken-time 'function)
      "Return the number of the steps of a trace before a decision.")

(defmethod print-object ((decision trace-decision) stream)
  (print-unreadable-object (decision stream :type t)
    (format stream "~a -> ~a" (taken-text decision) (taken-choice decision))))

(defstruct (execution-trace (:conc-name trace-) (:copier nil))
  "STATES begins with the initial state and has one element more than STEPS.  ARGUMENTS are the
plan's.  ENDING is how the whole run ends: :FINISHED, a failure class, or a keyword for what cut it
off.  OUTPUT is what the whole run has printed.  ALTERNATIVES are traces, and MORE-P is true if
there are others."
  (plan nil :type symbol :read-only t)
  (arguments '() :type list :read-only t)
  (steps '() :type list :read-only t)
  (states '() :type cons :read-only t)
  (decisions '() :type list :read-only t)
  (ending :finished :type symbol :read-only t)
  (output "" :type string :read-only t)
  (alternatives '() :type list)
  (more-p nil :type boolean))

(setf (documentation 'make-execution-trace 'function)
      "Return a new execution trace."
      (documentation 'trace-plan 'function)
      "Return the symbol that names the plan of a trace."
      (documentation 'trace-arguments 'function)
      "Return the list of the arguments of the plan of a trace."
      (documentation 'trace-steps 'function)
      "Return the list of the steps of a trace."
      (documentation 'trace-states 'function)
      "Return the list of the states of a trace, the initial one first."
      (documentation 'trace-decisions 'function)
      "Return the list of the TRACE-DECISIONs of a trace, in order."
      (documentation 'trace-ending 'function)
      "Return how the run ends whose beginning a trace is: :FINISHED, a failure class, or what cut
it off: :DEAD-END, :TOO-MANY-STEPS, :TOO-MANY-JUMPS, :OUT-OF-TIME, :ERROR."
      (documentation 'trace-output 'function)
      "Return what the run whose beginning a trace is has printed, a string."
      (documentation 'trace-alternatives 'function)
      "Return the list of the traces that take the same path as a trace, as far as it goes, from
other initial states; those that differ in the atoms which the exploration was asked for, the least
ones first."
      (documentation 'trace-more-p 'function)
      "Return true if a trace has more alternatives than TRACE-ALTERNATIVES returns.")

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

(defun trace-key (trace)
  "Return an object that is EQUAL for two traces if and only if TRACE= is true of them."
  (let ((initial (trace-initial-state trace)))
    (list* (trace-plan trace) (trace-arguments trace)
           (ec:state-fluents initial) (coerce (ec:state-numbers initial) 'list)
           (loop for step in (trace-steps trace)
                 collect (step-event step)
                 collect (step-outcome step)))))

(defun trace= (trace other)
  "Return true if two traces are of the same plan with the same arguments, from the same initial
state, with the same events and outcomes."
  (equal (trace-key trace) (trace-key other)))
