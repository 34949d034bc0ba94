;;;; The fluents of the next state, by DEC5 to DEC12 with the completed effect predicates in place:
;;;;   f is released at t+1  <->  it is released at t by an event, or it was and no event initiates
;;;;                              or terminates it
;;;;   where it is not, f holds at t+1  <->  it is initiated at t, or held and is not terminated
;;;;   where it is, f may hold or not, as trajectories and state constraints allow
;;;;
;;;; Entry points: SET-FLUENTS, APPLY-CHANGES and CLOSE-OPEN-FLUENTS, in this order.

(in-package #:discrepancy-finder.event-calculus)

(defun require-compatible (step p q)
  (require-condition step nil (z3:negation (z3:conjunction (list p q)))))

(defun carried-on (old initiated terminated)
  (z3:disjunction (list initiated (z3:conjunction (list old (z3:negation terminated))))))

(defun set-loose-fluent (step next fluent turn)
  "Set in NEXT whether FLUENT, which can be released, is released, and its value if it is not:
:OPEN if it is; return (fluent . value-if-not) where that depends."
  (destructuring-bind (&optional initiated terminated released) (rest turn)
    (let* ((state (step-state step))
           (old (svref (state-values state) fluent))
           (touched (z3:disjunction (list initiated terminated)))
           (release (svref (outline-release (step-outline step)) fluent))
           (loose (if (eq release :always)
                      t
                      (z3:disjunction (list released
                                            (z3:conjunction
                                             (list (svref (state-released state) fluent)
                                                   (z3:negation touched))))))))
      (require-compatible step initiated terminated)
      (require-compatible step (if (eq release :always) t released) touched)
      (setf (svref (state-released next) fluent) loose
            (svref (state-values next) fluent)
            (if (null loose) (carried-on old initiated terminated) :open))
      (and loose (not (eq loose t))
           (cons fluent (carried-on old initiated terminated))))))

(defun set-fluent-ahead (step next fluent)
  "Let FLUENT, whose effects depend on what is not known yet, be open in NEXT; DEC5 to DEC12 for it
are pending."
  (let* ((outline (step-outline step))
         (time (step-time step))
         (release (svref (outline-release outline) fluent)))
    (labels ((formula-of (kind) (effects-formula outline fluent kind time))
             (released (time)
               (case release ((nil) nil) (:always t) (t (list :released fluent time))))
             (leave (formula)
               (push (list* (max (1+ time) (formula-end outline formula)) nil formula)
                     (step-pending step)))
             (clause (&rest literals) (leave (fold :or literals))))
      (let ((now (list :fluent fluent time)) (then (list :fluent fluent (1+ time)))
            (loose-now (released time)) (loose-then (released (1+ time)))
            (initiated (formula-of :initiates)) (terminated (formula-of :terminates))
            (released (formula-of :releases)))
        (clause (fold-not initiated) (fold :and (list then (fold-not loose-then))))
        (clause (fold-not terminated) (fold :and (list (fold-not then) (fold-not loose-then))))
        (clause (fold-not released) loose-then)
        (clause (fold-not now) loose-then then terminated)
        (clause now loose-then (fold-not then) initiated)
        (clause (fold-not loose-now) loose-then initiated terminated)
        (unless (eq release :always)
          (clause loose-now (fold-not loose-then) released))
        (setf (svref (state-values next) fluent)
              (open-atom step :fluent fluent (1+ time)))
        (when (eq release :possibly)
          (setf (svref (state-released next) fluent)
                (open-atom step :released fluent (1+ time))))))))

(defun set-fluents (step next turns)
  "Set the fluents of NEXT; return a list of (fluent . value-if-not-released) for those that
depend."
  (let* ((outline (step-outline step))
         (release (outline-release outline))
         (values (state-values next))
         (mixed '()))
    (dolist (turn turns)
      (destructuring-bind (fluent initiated &optional terminated released) turn
        (declare (ignore released))
        (cond ((eq initiated :ahead) (set-fluent-ahead step next fluent))
              ((svref release fluent))
              (t (unless (or (null initiated) (null terminated))
                   (require-compatible step initiated terminated))
                 (setf (svref values fluent)
                       (carried-on (svref values fluent) initiated terminated))))))
    (dolist (fluent (outline-loose-fluents outline) mixed)
      (let ((turn (assoc fluent turns)))
        (unless (eq (second turn) :ahead)
          (let ((entry (set-loose-fluent step next fluent turn)))
            (when entry (push entry mixed))))))))

;;; Released fluents

(defun apply-change (step next change begin proposition)
  "Let CHANGE, which began at BEGIN where PROPOSITION is true, set its fluent in NEXT.  Return true
if the fluent is open and PROPOSITION not simply true."
  (let ((fluent (gradual-change-fluent change)) (values (state-values next)))
    (cond ((gradual-change-term change)
           (apply-numeric-change step next change begin proposition)
           nil)
          ((not (eq (svref values fluent) :open))
           (require-condition step (gradual-change-axiom change)
                              (z3:implication proposition (svref values fluent)))
           nil)
          ((eq proposition t) (setf (svref values fluent) t) nil)
          (t t))))

(defun apply-changes (step next)
  "Let trajectories set open fluents of NEXT; return a list of (fluent axiom . proposition) for
those that one sets only where the proposition is true."
  (let ((end (state-time next)) (partial '()) (outline (step-outline step)))
    (loop for (change begin going) in (due-changes step)
          for axiom = (gradual-change-axiom change)
          do (if (early-change-p change begin end)
                 (let ((proposition (z3:conjunction
                                     (list going
                                           (evaluate step (gradual-change-guard change)
                                                     (change-begin change begin))))))
                   (when (and proposition (apply-change step next change begin proposition))
                     (push (list* (gradual-change-fluent change) axiom proposition) partial)))
                 (let ((formula (change-formula outline change begin)))
                   (push (list* (max end (formula-end outline formula)) axiom formula)
                         (step-pending step)))))
    partial))

(defun guarded-value (loose free otherwise)
  (z3:disjunction (list (z3:conjunction (list loose free))
                        (z3:conjunction (list (z3:negation loose) otherwise)))))

(defun open-fluents (step next)
  (loop for fluent in (outline-loose-fluents (step-outline step))
        when (eq (svref (state-values next) fluent) :open)
          collect fluent))

(defun close-open-fluents (step next mixed partial)
  "Give the open fluents of NEXT values: those that state constraints force, else variables.  MIXED
and PARTIAL are what SET-FLUENTS and APPLY-CHANGES return."
  (let ((values (state-values next)) (time (state-time next))
        (demands-of (outline-state-demands-of (step-outline step))))
    (loop for (fluent . otherwise) in mixed
          do (setf (svref values fluent)
                   (guarded-value (svref (state-released next) fluent)
                                  (open-atom step :fluent fluent time) otherwise)))
    (dolist (fluent (settle values (open-fluents step next)
                            (lambda (fluent)
                              (mapcar #'demand-formula (svref demands-of fluent)))
                            :fluent))
      (setf (svref values fluent) (open-atom step :fluent fluent time)))
    (loop for (fluent axiom . proposition) in partial
          do (require-condition step axiom (z3:implication proposition (svref values fluent))))))
