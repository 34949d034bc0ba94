;;;; The oracle: Z3, as the runs of an exploration ask it.
;;;;
;;;; The solver's scopes follow the decisions of the run: one scope for each decision that says
;;;; something.  The next run closes only the scopes that it does not share with the last one, so
;;;; that a prefix is asserted once for all the runs below it.  An answer `unknown' is counted and
;;;; means "possible".  When an oracle holds too many terms it is RENEWED: what decisions remember
;;;; of Z3 belongs to an EPOCH and is found again by the next run.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (decision (:constructor make-decision (choice description)) (:copier nil))
  "CHOICE is the number of the option taken, DESCRIPTION says of what.  The rest is what the first
run that took it has found out, valid in EPOCH: the PROPOSITION assumed, the VALUE of the option.
What a step performs is its DESIGNATOR, and POSITION where, if the description does not say."
  (choice 0 :type (integer 0) :read-only t)
  (description "" :type string :read-only t)
  (epoch -1 :type fixnum)
  (proposition t)
  (value nil)
  (designator nil)
  (position nil))

(setf (documentation 'decision-choice 'function)
      "Return the number of the option that a decision takes, counted from 0."
      (documentation 'decision-description 'function)
      "Return the text of what a decision is about: a form of the plan with its source position, or
a designator.")

(defmethod print-object ((decision decision) stream)
  (print-unreadable-object (decision stream :type t)
    (format stream "~d of ~a" (decision-choice decision) (decision-description decision))))

(defstruct (scope-entry (:constructor make-scope-entry (decision)) (:conc-name entry-)
                        (:copier nil))
  "A DECISION (NIL for what is true on every path) whose proposition the solver holds; OPEN-P is
true if it has a scope of its own."
  (decision nil :read-only t)
  (open-p nil :type boolean))

(defstruct (oracle (:copier nil))
  "ENTRIES are those of the decisions that the solver holds, the deepest first, DEPTH is their
number, without the one of what is always true."
  (make-solver #'identity :type function :read-only t)
  (context nil)
  (solver nil)
  (epoch 0 :type fixnum)
  (entries '() :type list)
  (depth 0 :type fixnum)
  ;; how many new states and options it has seen in this epoch
  (load 0 :type fixnum)
  ;; figures: of contexts that were closed, of decisions, of traces
  (past-checks 0 :type fixnum)
  (past-seconds 0d0 :type double-float)
  (decisions 0 :type fixnum)
  (decision-checks 0 :type fixnum)
  (unknowns 0 :type fixnum)
  (signals-unknown nil :type boolean))

(defun open-oracle (oracle)
  "Give ORACLE a new context and an empty solver."
  (let ((context (z3:make-context)))
    (setf (oracle-context oracle) context
          (oracle-solver oracle) (funcall (oracle-make-solver oracle) context)
          (oracle-entries oracle) (list (make-scope-entry nil))
          (oracle-depth oracle) 0
          (oracle-load oracle) 0)
    (incf (oracle-epoch oracle))
    oracle))

(defun oracle-with (context solver)
  "Return an oracle that asks SOLVER, an empty one in CONTEXT; whoever made them closes them."
  (make-oracle :context context :solver solver :entries (list (make-scope-entry nil))))

(defun close-oracle (oracle)
  "Release the context of ORACLE; its figures stay."
  (let ((context (shiftf (oracle-context oracle) nil)))
    (when context
      (incf (oracle-past-checks oracle) (z3:check-count context))
      (incf (oracle-past-seconds oracle) (z3:check-seconds context))
      (z3:close-context context))))

(defun renew-oracle (oracle)
  (close-oracle oracle)
  (open-oracle oracle))

(defun oracle-checks (oracle)
  "Return the number of questions that were put to Z3."
  (+ (oracle-past-checks oracle)
     (if (oracle-context oracle) (z3:check-count (oracle-context oracle)) 0)))

(defun oracle-seconds (oracle)
  "Return the seconds spent in Z3."
  (+ (oracle-past-seconds oracle)
     (if (oracle-context oracle) (z3:check-seconds (oracle-context oracle)) 0d0)))

;;; Questions

(defun ask (oracle &optional (propositions '()))
  "Return :SAT if PROPOSITIONS can be true together with what the solver of ORACLE holds, :UNSAT if
they cannot, :UNKNOWN if Z3 cannot tell, unless that is to be signaled."
  (if (oracle-signals-unknown oracle)
      (z3:check (oracle-solver oracle) propositions)
      (block nil
        (handler-bind ((z3:solver-unknown
                         (lambda (condition)
                           (declare (ignore condition))
                           (incf (oracle-unknowns oracle))
                           (return :unknown))))
          (z3:check (oracle-solver oracle) propositions)))))

;;; Scopes

(defun oracle-assume (oracle proposition)
  "Assert PROPOSITION in the scope of the deepest decision that the solver holds."
  (unless (eq proposition t)
    (let ((entry (first (oracle-entries oracle))))
      (unless (entry-open-p entry)
        (z3:push-scope (oracle-solver oracle))
        (setf (entry-open-p entry) t))
      (z3:solver-assert (oracle-solver oracle) proposition))))

(defun retract-to-depth (oracle depth)
  "Let the solver hold only the first DEPTH of its decisions."
  (let ((scopes 0))
    (loop while (> (oracle-depth oracle) depth)
          do (when (entry-open-p (pop (oracle-entries oracle))) (incf scopes))
             (decf (oracle-depth oracle)))
    (when (plusp scopes)
      (z3:pop-scope (oracle-solver oracle) scopes))))

(defun shared-depth (oracle prefix)
  "Return how many of the first decisions of PREFIX the solver of ORACLE holds."
  (loop for entry in (rest (reverse (oracle-entries oracle)))
        for decision in prefix
        while (and (eq (entry-decision entry) decision)
                   (eql (decision-epoch decision) (oracle-epoch oracle)))
        count t))

(defun hold-decision (oracle decision)
  "Let the solver hold DECISION, too, which is the next one."
  (push (make-scope-entry decision) (oracle-entries oracle))
  (incf (oracle-depth oracle))
  (oracle-assume oracle (decision-proposition decision)))
