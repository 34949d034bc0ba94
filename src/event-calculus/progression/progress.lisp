;;;; Progression: what is true after known events.
;;;;
;;;; PROGRESS rewrites the fluents that the events affect, by DEC5 to DEC12 with the completed effect
;;;; predicates in place:
;;;;   f is released at t+1  <->  it is released at t by an event, or it was and no event initiates
;;;;                              or terminates it
;;;;   where it is not, f holds at t+1  <->  it is initiated at t, or held and is not terminated
;;;;   where it is, f may hold or not, as trajectories and state constraints allow
;;;; and returns what must be true for that step to be possible: that no effects conflict and that
;;;; the sentences are true whose last timepoint this is.  Constants are folded: where everything is
;;;; known Z3 is not needed.

(in-package #:discrepancy-finder.event-calculus)

;;; Events

(defun happening-events (step)
  "Return the list of (number . proposition) of the events that happen in STEP, perhaps."
  (let ((outline (step-outline step)) (events '()))
    (flet ((try (number)
             (unless (assoc number events)
               (let ((proposition (step-event step number)))
                 (when proposition
                   (push (cons number proposition) events))))))
      (dolist (number (step-given step)) (try number))
      (loop for number being the hash-keys of (outline-events outline) do (try number))
      (when (dated-p outline)
        (loop for (kind number) in (gethash (step-time step)
                                            (dated-supports
                                             (outline-dated-until outline (step-time step))))
              when (eq kind :event) do (try number))))
    (nreverse events)))

(defun require-exclusions (step events)
  "Require of EVENTS, (number . proposition), what the exclusions of the theory say."
  (loop for (kind . numbers) in (outline-exclusions (step-outline step))
        for members = (if (eq numbers t)
                          events
                          (remove-if-not (lambda (event) (member (car event) numbers)) events))
        do (loop for ((nil . proposition) . others) on members
                 do (loop for (nil . other) in others
                          do (require-condition step nil
                                                (z3:negation
                                                 (z3:conjunction (list proposition other))))))
           (when (eq kind :xor)
             (require-condition step nil (z3:disjunction (mapcar #'cdr members))))))

;;; Effects.  A TURN is (fluent initiated terminated released), propositions, or (fluent :ahead).

(defun guards-proposition (step happens guards time)
  "Return the proposition that HAPPENS and one of GUARDS is true."
  (if (null guards)
      nil
      (z3:conjunction
       (list happens
             (let ((terms '()))
               (dolist (guard guards (z3:disjunction terms))
                 (let ((value (evaluate step guard time)))
                   (cond ((eq value t) (return t))
                         (value (push value terms))))))))))

(defun influence-turn (step influence happens base)
  (list (influence-fluent influence)
        (guards-proposition step happens (influence-initiates influence) base)
        (guards-proposition step happens (influence-terminates influence) base)
        (guards-proposition step happens (influence-releases influence) base)))

(defun add-turn (turns turn)
  "Return TURNS with TURN, which joins that of the same fluent if there is any."
  (let ((same (assoc (first turn) turns)))
    (cond ((null same) (cons turn turns))
          ((or (eq (second same) :ahead) (eq (second turn) :ahead))
           (setf (rest same) (list :ahead))
           turns)
          (t (setf (rest same)
                   (loop for p in (rest same)
                         for q in (rest turn)
                         collect (z3:disjunction (list p q))))
             turns))))

(defun event-turns (step events)
  "Return the turns that EVENTS, (number . proposition), bring about in STEP."
  (let* ((outline (step-outline step))
         (time (step-time step))
         (turns '())
         (single (null (rest events))))
    (loop for (number . happens) in events
          do (dolist (influence (svref (outline-influences outline) number))
               (let ((turn (if (influence-ahead-p influence)
                               (list (influence-fluent influence) :ahead)
                               (influence-turn step influence happens time))))
                 (setf turns (if single (cons turn turns) (add-turn turns turn))))))
    (when (dated-p outline)
      (dolist (effect (gethash time (dated-effects (outline-dated-until outline time))))
        (let ((happens (cdr (assoc (effect-event effect) events))))
          (when happens
            (setf turns (add-turn turns (dated-turn step effect happens)))))))
    turns))

(defun dated-turn (step effect happens)
  (if (> (or (formula-reach (effect-guard effect)) 0) (step-time step))
      (list (effect-fluent effect) :ahead)
      (let ((proposition (guards-proposition step happens (list (effect-guard effect)) 0)))
        (flet ((if-kind (kind) (and (eq (effect-kind effect) kind) proposition)))
          (list (effect-fluent effect) (if-kind :initiates) (if-kind :terminates)
                (if-kind :releases))))))

(defun effects-formula (outline fluent kind time)
  "Return the ground formula, with timepoints, that an event has an effect of KIND on FLUENT at
TIME."
  (fold :or
        (append
         (loop for effect in (fluent-effects (outline-ground outline) fluent kind nil)
               collect (shift-formula (effect-formula effect) time))
         (and (dated-p outline)
              (loop for effect in (gethash time (dated-effects
                                                 (outline-dated-until outline time)))
                    when (and (= (effect-fluent effect) fluent) (eq (effect-kind effect) kind))
                      collect (fold :and (list (list :event (effect-event effect) time)
                                               (effect-guard effect))))))))

;;; Fluents

(defun require-compatible (step p q)
  (require-condition step nil (z3:negation (z3:conjunction (list p q)))))

(defun carried-on (old initiated terminated)
  (z3:disjunction (list initiated (z3:conjunction (list old (z3:negation terminated))))))

(defun set-loose-fluent (step next fluent turn)
  "Set in NEXT whether FLUENT, which can be released, is released, and its value if it is not: :OPEN
if it is; return (fluent . value-if-not) where that depends."
  (destructuring-bind (&optional initiated terminated released) (rest turn)
    (let* ((state (step-state step))
           (old (svref (state-values state) fluent))
           (touched (z3:disjunction (list initiated terminated)))
           (release (svref (ground-theory-release (outline-ground (step-outline step))) fluent))
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
         (release (svref (ground-theory-release (outline-ground outline)) fluent)))
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
  "Set the fluents of NEXT; return a list of (fluent . value-if-not-released) for those that depend."
  (let* ((outline (step-outline step))
         (release (ground-theory-release (outline-ground outline)))
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
