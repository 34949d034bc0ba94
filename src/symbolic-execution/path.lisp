;;;; Paths: one way through a plan, as a list of decisions.
;;;;
;;;; A PATH is the executive of one symbolic run.  Where the run could go on in several ways, DECIDE
;;;; takes one and notes the others as prefixes for later runs; a run begins by repeating its own
;;;; prefix.  The path's solver holds what must be true of the initial state for the run to go this
;;;; way.  Abandoning a path leaves the plan by THROW, so that no handler of the plan sees it.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (decision (:constructor make-decision (choice description)) (:copier nil))
  "CHOICE is the number of the option taken, DESCRIPTION says of what."
  (choice 0 :type (integer 0) :read-only t)
  (description "" :type string :read-only t))

(defstruct (path (:copier nil))
  "A symbolic run.  Lists are in reverse order but for PREFIX, what is still to be repeated."
  (plan nil :read-only t)
  (domain nil :type action-theory :read-only t)
  (solver nil :read-only t)
  (prefix '() :type list)
  (decisions '() :type list)
  (alternatives '() :type list)
  (states '() :type list)
  (steps '() :type list)
  (journal '() :type list)
  (max-steps 1000 :type (integer 0) :read-only t)
  (ending nil))

(defvar *path* nil
  "The path of the symbolic run in progress.")

(defun abandon (path ending)
  "Leave the run of PATH; ENDING, a keyword, says why."
  (setf (path-ending path) ending)
  (throw path nil))

(defun assume (path proposition)
  (z3:solver-assert (path-solver path) proposition))

(defun possible-p (path proposition)
  "Return true if PROPOSITION can be true on PATH, which is itself possible."
  (cond ((eq proposition t) t)
        ((null proposition) nil)
        (t (eq (z3:check (path-solver path) (list proposition)) :sat))))

(defun possible-options (path options exhaustive)
  "Return the numbers of the OPTIONS, (choice . proposition), that are possible on PATH.  If they
are EXHAUSTIVE and all but the last are impossible the last one need not be asked for."
  (let ((possible '()))
    (loop for ((nil . proposition) . more) on options
          for number from 0
          when (if (and exhaustive (null more) (null possible))
                   t
                   (possible-p path proposition))
            do (push number possible))
    (nreverse possible)))

(defun decide (path description options &key exhaustive)
  "Return the choice of one of OPTIONS, a list of (choice . proposition), and assume its
proposition.  The other possible ones are noted as alternatives.  EXHAUSTIVE: one of the
propositions is true in any case.  Abandons PATH if none is possible."
  (let ((recorded (pop (path-prefix path))))
    (when (and recorded (string/= (decision-description recorded) description))
      (error 'nondeterministic-plan :plan (path-plan path) :found description
                                    :expected (decision-description recorded)))
    (let* ((possible (if recorded
                         (list (decision-choice recorded))
                         (possible-options path options exhaustive)))
           (taken (first possible)))
      (unless possible
        (abandon path :dead-end))
      (dolist (other (rest possible))
        (push (reverse (cons (make-decision other description) (path-decisions path)))
              (path-alternatives path)))
      (push (make-decision taken description) (path-decisions path))
      (destructuring-bind (choice . proposition) (nth taken options)
        (assume path proposition)
        choice))))

;;; Symbolic booleans

(defstruct (symbolic-boolean (:constructor make-symbolic-boolean (proposition)) (:copier nil))
  "A truth value that depends on the initial state or on symbolic arguments of the plan."
  (proposition nil :read-only t))

(defmethod print-object ((value symbolic-boolean) stream)
  (print-unreadable-object (value stream :type t)
    (princ (symbolic-boolean-proposition value) stream)))

(defun truth (value description)
  "Return VALUE, or T or NIL by a decision if it is symbolic."
  (if (symbolic-boolean-p value)
      (let ((proposition (symbolic-boolean-proposition value)))
        (decide *path* description
                (list (cons t proposition) (cons nil (z3:negation proposition)))
                :exhaustive t))
      value))

;;; Side effects on global variables are undone between runs.

(defun note-write (symbol)
  "Remember the global value of SYMBOL, so that it can be restored after the run."
  (when *path*
    (push (if (boundp symbol)
              (let ((value (symbol-value symbol)))
                (lambda () (setf (symbol-value symbol) value)))
              (lambda () (makunbound symbol)))
          (path-journal *path*))))

(defun undo-writes (path)
  (mapc #'funcall (path-journal path))
  (setf (path-journal path) '()))
