;;;; Decisions: where a run could go on in several ways.
;;;;
;;;; DECIDE takes one of the ways and notes the others as prefixes for later runs; a run begins by
;;;; repeating its own prefix.

(in-package #:discrepancy-finder.symbolic-execution)

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
