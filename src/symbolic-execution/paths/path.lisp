;;;; Paths: one way through a plan, as a list of decisions.
;;;;
;;;; A PATH is the executive of one symbolic run.  The path's solver holds what must be true of the
;;;; initial state for the run to go this way.  Abandoning a path leaves the plan with all its
;;;; tasks; no handler of the plan sees it.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (decision (:constructor make-decision (choice description)) (:copier nil))
  "CHOICE is the number of the option taken, DESCRIPTION says of what."
  (choice 0 :type (integer 0) :read-only t)
  (description "" :type string :read-only t))

(defstruct (path (:copier nil))
  "A symbolic run.  Lists are in reverse order but for PREFIX, what is still to be repeated.
MAX-STEPS bounds the performs, JUMPS-LEFT the iterations of loops and retries.
SYMBOLIC-P is true once the run has met a symbolic value, LIMITS are sentences on what it
leaves out; with SCHEDULES :ALL the order in which
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
  (symbolic-p nil :type boolean)
  (limits '() :type list)
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

(defun note-limit (path text)
  "Note TEXT, a sentence, as something that the run of PATH leaves out: the exploration is not
complete then."
  (pushnew text (path-limits path) :test #'string=))

(defun count-jump (path)
  "Count a jump in a loop of the plan; abandon PATH after too many."
  (when (minusp (decf (path-jumps-left path)))
    (abandon path :too-many-jumps)))
