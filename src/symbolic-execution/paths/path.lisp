;;;; Paths: one way through a plan, as a list of decisions.
;;;;
;;;; A PATH is the executive of one symbolic run.  The solver of its oracle holds what must be true
;;;; of the initial state for the run to go this way.  Abandoning a path leaves the plan with all
;;;; its tasks; no handler of the plan sees it.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (path (:copier nil))
  "A symbolic run.  Lists are in reverse order but for PREFIX, the decisions still to be repeated.
ALTERNATIVES are such lists of decisions, the deepest first, for runs to come.
MAX-STEPS bounds the performs, JUMPS-LEFT the iterations of loops and retries, DEADLINE, in seconds
of the monotonic clock, the time.  SYMBOLIC-P is true once the run has symbolic values; LIMITS are
sentences on what it leaves out.  INTERLEAVINGS says which orders of parallel tasks are explored,
SCHEDULE notes those of this run; HANDLERS are the condition handlers outside of the plan.
STEP-DEPTHS has for each step the number of decisions up to it, REPEATED is the number of those that
repeat another run.  ENDING says why the run is over, :ERROR if by the condition FATAL; with
KEEP-ERRORS an error of the plan is an ending like others."
  (plan nil :read-only t)
  (domain nil :type action-theory :read-only t)
  (oracle nil :type oracle :read-only t)
  (prefix '() :type list)
  (repeated 0 :type fixnum :read-only t)
  (decisions '() :type list)
  (depth 0 :type fixnum)
  (alternatives '() :type list)
  (states '() :type list)
  (steps '() :type list)
  (step-depths '() :type list)
  (journal '() :type list)
  (writes 0 :type fixnum)
  (max-steps 1000 :type (integer 0) :read-only t)
  (jumps-left 0 :type fixnum)
  (deadline nil :type (or null double-float) :read-only t)
  (symbolic-p nil :type boolean)
  (limits '() :type list)
  ;; the number of writes when the global variables were last looked through
  (searched 0 :type fixnum)
  (interleavings nil :type (member nil t :all) :read-only t)
  (schedule nil :read-only t)
  (file-output nil :type boolean :read-only t)
  (keep-errors nil :type boolean :read-only t)
  (handlers nil)
  (ending nil)
  (fatal nil))

(defun path-solver (path)
  "Return the solver that holds what is true on PATH."
  (oracle-solver (path-oracle path)))

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

(defun check-deadline (path)
  "Abandon PATH if its time is over."
  (let ((deadline (path-deadline path)))
    (when (and deadline (> (foreign:monotonic-seconds) deadline))
      (abandon path :out-of-time))))

(defun count-jump (path)
  "Count a jump in a loop of the plan; abandon PATH after too many, or when its time is over."
  (let ((left (decf (path-jumps-left path))))
    (cond ((minusp left) (abandon path :too-many-jumps))
          ((zerop (logand left 1023)) (check-deadline path)))))
