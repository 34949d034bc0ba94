;;;; Decisions: where a run could go on in several ways.
;;;;
;;;; DECIDE takes one of the ways and notes the others as prefixes for later runs; a run begins by
;;;; repeating its own prefix.  What the first run has found out about a decision, the decision
;;;; remembers: a repetition asks Z3 nothing.

(in-package #:discrepancy-finder.symbolic-execution)

(defun assume (path proposition)
  "Add PROPOSITION to what is true on PATH from here on.  It must follow from the decisions so far."
  (let ((oracle (path-oracle path)))
    ;; The decisions below this one hold more than that.
    (when (= (path-depth path) (oracle-depth oracle))
      (oracle-assume oracle proposition))))

(defun possible-p (path proposition)
  "Return true if PROPOSITION can be true on PATH, which is itself possible, or if Z3 cannot tell."
  (cond ((eq proposition t) t)
        ((null proposition) nil)
        (t (not (eq (ask (path-oracle path) (list proposition)) :unsat)))))

(defun possible-options (path options exhaustive)
  "Return the numbers of the OPTIONS, (choice . proposition), that are possible on PATH.  If they
are EXHAUSTIVE and all but the last are impossible the last one need not be asked for."
  (let* ((possible '()) (oracle (path-oracle path)) (checks (oracle-checks oracle)))
    (when (some (lambda (option) (z3:term-p (cdr option))) options)
      (incf (oracle-decisions oracle)))
    (loop for ((nil . proposition) . more) on options
          for number from 0
          when (if (and exhaustive (null more) (null possible))
                   t
                   (possible-p path proposition))
            do (push number possible))
    (incf (oracle-decision-checks oracle) (- (oracle-checks oracle) checks))
    (nreverse possible)))

(defun current-p (path decision)
  "Return true if what DECISION remembers of Z3 is of the present epoch."
  (eql (decision-epoch decision) (oracle-epoch (path-oracle path))))

(defun next-recorded (path)
  "Return the next decision of PATH's prefix, or NIL if all are repeated."
  (first (path-prefix path)))

(defun decision-text (description position)
  (format nil "~@[~a: ~]~a" (and position (princ-to-string position)) description))

(defun expected-text (recorded)
  "Return the text of the decision RECORDED, with its place."
  (decision-text (decision-description recorded) (decision-position recorded)))

(defun other-decision (path recorded description &optional position)
  "Signal NONDETERMINISTIC-PLAN: the decision described is met instead of the RECORDED one."
  (error 'nondeterministic-plan :plan (path-plan path)
                                :found (decision-text description position)
                                :expected (expected-text recorded)))

(defun take-decision (path decision)
  "Let PATH go on with DECISION."
  (push decision (path-decisions path))
  (incf (path-depth path))
  (when (> (path-depth path) (oracle-depth (path-oracle path)))
    (hold-decision (path-oracle path) decision)))

(defun repeat-decision (path recorded)
  "Let PATH go on with RECORDED, the next decision of its prefix."
  (pop (path-prefix path))
  (take-decision path recorded))

(defun fill-decision (path decision option)
  "Let DECISION remember OPTION, (choice . proposition)."
  (incf (oracle-load (path-oracle path)))
  (setf (decision-value decision) (car option)
        (decision-proposition decision) (cdr option)
        (decision-epoch decision) (oracle-epoch (path-oracle path)))
  decision)

(defun repeat-option (path recorded description options position)
  "Repeat the decision RECORDED, met with DESCRIPTION and OPTIONS, and return its choice."
  (unless (string= (decision-description recorded) description)
    (other-decision path recorded description position))
  (let* ((given (if (functionp options)
                    (and (not (current-p path recorded)) (funcall options))
                    options))
         (option (nth (decision-choice recorded) given)))
    (cond ((and (functionp options) (null given)))
          ((null option) (other-decision path recorded description position))
          ((not (current-p path recorded)) (fill-decision path recorded option))
          ((not (z3:term-equal (decision-proposition recorded) (cdr option)))
           (other-decision path recorded (format nil "~a about something else" description)
                           position)))
    (repeat-decision path recorded)
    (if option (car option) (decision-value recorded))))

(defun take-option (path description options exhaustive)
  "Decide for the first of OPTIONS that is possible, note the others and return its choice."
  (when (functionp options)
    (setf (values options exhaustive) (funcall options)))
  (let ((possible (possible-options path options exhaustive))
        (so-far (path-decisions path)))
    (unless possible
      (abandon path :dead-end))
    (flet ((decision (number)
             (fill-decision path (make-decision number description) (nth number options))))
      ;; The first alternative comes first.
      (dolist (number (reverse (rest possible)))
        (push (cons (decision number) so-far) (path-alternatives path)))
      (take-decision path (decision (first possible)))
      (car (nth (first possible) options)))))

(defun decide (path description options &key exhaustive position)
  "Return the choice of one of OPTIONS, a list of (choice . proposition), and assume its
proposition.  The other possible ones are noted as alternatives.  OPTIONS may be a function that
returns this list and the value of EXHAUSTIVE: a repetition of the decision calls it only if it
must.  It may ask the path's solver.  EXHAUSTIVE: one of the propositions is true in any case.
POSITION is where in the source that is, if DESCRIPTION does not say.  Abandons PATH if none is
possible."
  (outside-the-plan (path)
    (check-deadline path)
    (let ((recorded (next-recorded path)))
      (if recorded
          (repeat-option path recorded description options position)
          (take-option path description options exhaustive)))))
