;;;; Paths: one way through a plan, as a list of decisions.
;;;;
;;;; A PATH is the executive of one symbolic run.  Where the run could go on in several ways, DECIDE
;;;; takes one and notes the others as prefixes for later runs; a run begins by repeating its own
;;;; prefix.  The path's solver holds what must be true of the initial state for the run to go this
;;;; way.  Abandoning a path leaves the plan with all its tasks; no handler of the plan sees it.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (decision (:constructor make-decision (choice description)) (:copier nil))
  "CHOICE is the number of the option taken, DESCRIPTION says of what."
  (choice 0 :type (integer 0) :read-only t)
  (description "" :type string :read-only t))

(defstruct (path (:copier nil))
  "A symbolic run.  Lists are in reverse order but for PREFIX, what is still to be repeated.
MAX-STEPS bounds the performs, JUMPS-LEFT the iterations of loops and retries.
SYMBOLIC-P is true if the plan has symbolic arguments; with SCHEDULES :ALL the order in which
parallel tasks take their turns is decided, too; HANDLERS are the condition handlers outside
of the plan.  ENDING says why the run is over, :ERROR if by the condition FATAL."
  (plan nil :read-only t)
  (domain nil :type action-theory :read-only t)
  (solver nil :read-only t)
  (prefix '() :type list)
  (decisions '() :type list)
  (alternatives '() :type list)
  (states '() :type list)
  (steps '() :type list)
  (journal '() :type list)
  (writes 0 :type fixnum)
  (max-steps 1000 :type (integer 0) :read-only t)
  (jumps-left 0 :type fixnum)
  (symbolic-p nil :type boolean :read-only t)
  (schedules :one :type (member :one :all) :read-only t)
  (handlers nil)
  (ending nil)
  (fatal nil))

(defvar *path* nil
  "The path of the symbolic run in progress.")

(defun abandon (path ending)
  "Leave the run of PATH; ENDING, a keyword, says why."
  (setf (path-ending path) ending)
  (plan:leave-plan path))

(defun doom (path condition)
  "Note that the run of PATH is over because of CONDITION, an error, which is going to unwind it.
What cleanup forms of the plan do meanwhile is without effect, and cannot make it forgotten."
  (setf (path-ending path) :error
        (path-fatal path) condition))

(defun call-outside-the-plan (path function)
  (plan:call-on-main
   (lambda ()
     (plan:with-handlers ((path-handlers path))
       (handler-bind ((error (lambda (condition) (doom path condition))))
         (multiple-value-prog1 (funcall (the function function))
           (when (path-fatal path)
             (setf (path-ending path) nil
                   (path-fatal path) nil))))))))

(defmacro outside-the-plan ((path) &body body)
  "Evaluate BODY, which is no business of the plan, on the thread of the top-level: its errors are
for handlers from outside, and doom the run unless they return."
  `(call-outside-the-plan ,path (lambda () ,@body)))

(defun count-jump (path)
  "Count a jump in a loop of the plan; abandon PATH after too many."
  (when (minusp (decf (path-jumps-left path)))
    (abandon path :too-many-jumps)))

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

(defun recorded-choice (path description options)
  "Take the next decision of PATH's prefix and return its choice, or NIL if all are repeated.
Signals NONDETERMINISTIC-PLAN if another decision is met than the recorded one."
  (let ((recorded (pop (path-prefix path))))
    (when recorded
      (unless (and (string= (decision-description recorded) description)
                   (< (decision-choice recorded) (length options)))
        (error 'nondeterministic-plan :plan (path-plan path) :found description
                                      :expected (decision-description recorded)))
      (decision-choice recorded))))

(defun note-alternatives (path description numbers)
  "Note prefixes that go on with each of NUMBERS, so that the first of them comes first."
  (dolist (number (reverse numbers))
    (push (reverse (cons (make-decision number description) (path-decisions path)))
          (path-alternatives path))))

(defun decide (path description options &key exhaustive)
  "Return the choice of one of OPTIONS, a list of (choice . proposition), and assume its
proposition.  The other possible ones are noted as alternatives.  EXHAUSTIVE: one of the
propositions is true in any case.  Abandons PATH if none is possible."
  (outside-the-plan (path)
    (let* ((recorded (recorded-choice path description options))
           (possible (if recorded
                         (list recorded)
                         (possible-options path options exhaustive)))
           (taken (first possible)))
      (unless possible
        (abandon path :dead-end))
      (note-alternatives path description (rest possible))
      (push (make-decision taken description) (path-decisions path))
      (destructuring-bind (choice . proposition) (nth taken options)
        (assume path proposition)
        choice))))

;;; Symbolic booleans, and the functions that may be given some

(defstruct (symbolic-boolean (:constructor make-symbolic-boolean (proposition)) (:copier nil))
  "A truth value that depends on the initial state or on symbolic arguments of the plan."
  (proposition nil :read-only t))

(setf (documentation 'symbolic-boolean-proposition 'function)
      "Return the proposition that a symbolic boolean stands for.")

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

(defclass interpreted-function (sb-mop:funcallable-standard-object)
  ((name :initarg :name :initform nil :reader interpreted-function-name))
  (:metaclass sb-mop:funcallable-standard-class)
  (:documentation "A function whose body the evaluator runs; it may be given symbolic values."))

(defmethod print-object ((function interpreted-function) stream)
  (print-unreadable-object (function stream :type t :identity t)
    (princ (interpreted-function-name function) stream)))

(defun make-interpreted-function (name function)
  (let ((instance (make-instance 'interpreted-function :name name)))
    (sb-mop:set-funcallable-instance-function instance function)
    instance))

(defun holds-symbolic-p (value)
  "Return true if VALUE is a symbolic boolean or a list structure with one in it.  Only so many
conses are looked at: the list of an &rest parameter is short, and others hold none."
  (let ((budget 10000))
    (labels ((look (value)
               (loop
                 (cond ((symbolic-boolean-p value) (return t))
                       ((or (atom value) (minusp (decf budget))) (return nil))
                       ((look (car value)) (return t))
                       (t (setf value (cdr value)))))))
      (look value))))

(defun decided (value description)
  "Return VALUE with every symbolic boolean in it decided, for code that cannot handle one: in
conses, which the list of an &rest parameter may be, and in what an interpreted function returns."
  (cond ((symbolic-boolean-p value) (truth value description))
        ((typep value 'interpreted-function)
         (lambda (&rest arguments)
           (let ((values (multiple-value-list (apply value arguments))))
             (values-list (cons (truth (first values) description) (rest values))))))
        ((and (consp value) (holds-symbolic-p value))
         (cons (decided (car value) description) (decided (cdr value) description)))
        (t value)))

;;; Side effects on global variables are undone between runs.  The journal is a list of
;;; (number symbol task . restoring function), the last write first.  A write to a variable that a
;;; task has bound itself is forgotten when the binding ends; what another task writes meanwhile is
;;; the global value.  Bindings of several tasks need not end in the reverse order of their begin.

(defun note-write (symbol)
  "Remember the value of SYMBOL, so that it can be restored after the run."
  (when *path*
    (push (list* (incf (path-writes *path*)) symbol (plan:current-task)
                 (if (boundp symbol)
                     (let ((value (symbol-value symbol)))
                       (lambda () (setf (symbol-value symbol) value)))
                     (lambda () (makunbound symbol))))
          (path-journal *path*))))

(defun forget-writes (path symbols since)
  "Forget the writes of the current task to SYMBOLS that have a number above SINCE."
  (let ((task (plan:current-task)) (newer '()) (older (path-journal path)))
    (loop while (and older (> (first (first older)) since))
          do (let ((entry (pop older)))
               (destructuring-bind (symbol writer . restore) (rest entry)
                 (declare (ignore restore))
                 (unless (and (member symbol symbols) (eq writer task))
                   (push entry newer)))))
    (setf (path-journal path) (nreconc newer older))))

(defmacro with-forgotten-writes ((symbols) &body body)
  "Evaluate BODY, in which SYMBOLS are bound, and forget the writes to them in it."
  (let ((since (gensym "SINCE")) (names (gensym "SYMBOLS")))
    `(let ((,since (if *path* (path-writes *path*) 0))
           (,names ,symbols))
       (unwind-protect (progn ,@body)
         (when *path*
           (forget-writes *path* ,names ,since))))))

(defun undo-writes (path)
  (loop for (nil nil nil . restore) in (path-journal path) do (funcall restore))
  (setf (path-journal path) '()))
