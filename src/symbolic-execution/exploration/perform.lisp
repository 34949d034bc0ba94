;;;; PERFORM under symbolic execution: one step of the theory.
;;;;
;;;; The action binding of the designator lists its outcomes.  Those that the theory does not allow
;;;; on this path are dropped; among the others one is decided for.  Its event progresses the
;;;; state, and a failure is signaled in the plan.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (trace-step (:conc-name step-) (:copier nil))
  "One performed designator of a trace: its text, the event that happened (a list of keywords) or
NIL, the outcome (:SUCCESS or a failure class) and the source position of the perform form."
  (designator "" :type string :read-only t)
  (event nil :type list :read-only t)
  (outcome :success :type symbol :read-only t)
  (position nil :read-only t))

(setf (documentation 'make-trace-step 'function)
      "Return a new step of a trace."
      (documentation 'step-designator 'function)
      "Return the text of the designator of a step."
      (documentation 'step-event 'function)
      "Return the ground event of a step, a list of keywords, or NIL."
      (documentation 'step-outcome 'function)
      "Return the outcome of a step: :SUCCESS or a failure class."
      (documentation 'step-position 'function)
      "Return the source position of the perform form of a step, or NIL.")

(defmethod print-object ((step trace-step) stream)
  (print-unreadable-object (step stream :type t)
    (format stream "~a -> ~(~a~)" (step-designator step) (step-outcome step))))

(defun outcome-transition (domain state outcome)
  "Return the state after OUTCOME of an action in STATE and the list of (axiom . proposition) that
must be true for it."
  (let ((event (ec:event-number (action-theory-ground domain) (outcome-event outcome)))
        (condition (ec:holds (outcome-condition outcome) (list state))))
    (multiple-value-bind (next conditions) (ec:progress state event)
      (values next (if (eq condition t) conditions (acons nil condition conditions))))))

(defun same-description-p (one other)
  "Return true if ONE and OTHER, designators or parts of their descriptions, have the same text for
sure."
  (cond ((eql one other) t)
        ((consp one) (and (consp other)
                          (same-description-p (car one) (car other))
                          (same-description-p (cdr one) (cdr other))))
        ((typep one 'plan:designator)
         (and (eq (class-of one) (class-of other))
              (eq (desig:quantifier one) (desig:quantifier other))
              (same-description-p (desig:properties one) (desig:properties other))))
        ((stringp one) (equal one other))))

(defun designator-text (path designator)
  "Return the text of DESIGNATOR, which PATH performs now."
  (let* ((recorded (next-recorded path))
         (known (and recorded (decision-designator recorded))))
    (if (and known (same-description-p designator known))
        (decision-description recorded)
        (princ-to-string designator))))

(defun recorded-step (path description)
  "Return the outcome and the state after it if the next decision of PATH's prefix is for the step
DESCRIPTION and still remembers them, else NIL."
  (let ((recorded (next-recorded path)))
    (when (and recorded (current-p path recorded))
      (let ((value (decision-value recorded)))
        (when (and (consp value) (outcome-p (car value))
                   (string= description (decision-description recorded)))
          (values (car value) (cdr value)))))))

(defun decide-new-step (path designator description position outcomes)
  "Decide for one of OUTCOMES of DESIGNATOR, performed at POSITION, and return it and the state
after it."
  (let ((alternatives (path-alternatives path)))
    (destructuring-bind (outcome . next)
        (decide path description (step-options path outcomes) :position position)
      ;; For the runs that will repeat the decision.
      (flet ((complete (decision)
               (setf (decision-designator decision) designator
                     (decision-position decision) position)))
        (complete (first (path-decisions path)))
        (loop for (decision) in (ldiff (path-alternatives path) alternatives)
              do (complete decision)))
      (values outcome next))))

(defun step-options (path outcomes)
  "Return the options ((outcome . state) . proposition) of a step with OUTCOMES."
  (let ((state (first (path-states path))))
    (loop for outcome in outcomes
          collect (multiple-value-bind (next conditions)
                      (outcome-transition (path-domain path) state outcome)
                    (cons (cons outcome next) (z3:conjunction (mapcar #'cdr conditions)))))))

(defun decide-step (path designator position plan)
  "Decide for an outcome of DESIGNATOR, which PLAN performs at POSITION, on PATH and return it and
the state after it, and the text of DESIGNATOR."
  (let ((description (designator-text path designator)))
    (multiple-value-bind (recorded next) (recorded-step path description)
      (if (and recorded (null (path-schedule path))
               (null (outcome-result recorded))) ; it has no part of the other run
          (progn (repeat-decision path (next-recorded path))
                 (values recorded next description))
          (let ((outcomes (action-outcomes (path-domain path) designator
                                           :plan plan :position position)))
            (note-outcomes path outcomes)
            (when *recorder*
              (note-considered *recorder* (action-theory-ground (path-domain path)) outcomes))
            ;; Its arguments may have been decided meanwhile.
            (multiple-value-bind (recorded next) (recorded-step path description)
              (if recorded
                  (let ((outcome (nth (decision-choice (next-recorded path)) outcomes)))
                    (unless (and outcome (equal (outcome-event outcome) (outcome-event recorded)))
                      (other-decision path (next-recorded path) description position))
                    (repeat-decision path (next-recorded path))
                    (values outcome next description))
                  (multiple-value-bind (outcome next)
                      (decide-new-step path designator description position outcomes)
                    (values outcome next description)))))))))

(defun take-step (path designator position plan)
  "Decide for an outcome of DESIGNATOR, which PLAN performs at POSITION, on PATH, add the step and
return the outcome."
  (multiple-value-bind (outcome next description) (decide-step path designator position plan)
    (push (make-trace-step :designator (if (search "#<symbolic" description)
                                           ;; What the event needs is decided by now.
                                           (let ((*show-decided* t) (*print-case* :downcase))
                                             (princ-to-string designator))
                                           description)
                           :event (outcome-event outcome)
                           :outcome (outcome-name outcome) :position position)
          (path-steps path))
    (when *recorder*
      (note-step-taken *recorder* (first (path-states path)) outcome next))
    (push (path-depth path) (path-step-depths path))
    (push next (path-states path))
    outcome))

(defun entered-p (domain designator)
  "Return true if DESIGNATOR has no action binding in DOMAIN but a plan of its own: performing it
enters that plan."
  (and (null (find-action-binding domain designator))
       (progn
         (note-designator designator)
         (plan:plan-known-p (decided designator "a designator that is resolved")))))

(defmethod plan:perform-with ((path path) designator position)
  (cond ((path-fatal path) nil)         ; an error unwinds: let it go on
        ((path-ending path) (plan:leave-plan path))
        ((entered-p (path-domain path) designator) (call-next-method))
        ((>= (length (path-steps path)) (path-max-steps path)) (abandon path :too-many-steps))
        (t (check-deadline path)
           (let* ((plan (plan:current-plan-name))
                  (outcome (outside-the-plan (path) (take-step path designator position plan))))
             (if (eq (outcome-name outcome) :success)
                 (outcome-value outcome (first (path-states path)))
                 (apply #'plan:fail (outcome-name outcome) (outcome-initargs outcome)))))))

(defmethod plan:call-plan-function ((path path) name arguments)
  (note-entered-plan path name)
  (apply (global-function name) arguments))
