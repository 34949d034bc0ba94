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
      (loop for (kind number) in (dated-supports-at outline (step-time step))
            when (eq kind :event) do (try number)))
    (nreverse events)))

(defun require-exclusions (step events)
  "Require of EVENTS, (number . proposition), what the exclusions of the theory say."
  (loop for (axiom kind . numbers) in (outline-exclusions (step-outline step))
        for members = (if (eq numbers t)
                          events
                          (remove-if-not (lambda (event) (member (car event) numbers)) events))
        do (loop for ((nil . proposition) . others) on members
                 do (loop for (nil . other) in others
                          do (require-condition step axiom
                                                (z3:negation
                                                 (z3:conjunction (list proposition other))))))
           (when (eq kind :xor)
             (require-condition step axiom (z3:disjunction (mapcar #'cdr members))))))

;;; Effects.  A TURN is (fluent initiated terminated released), propositions, or (fluent :ahead).

(defun guards-proposition (step happens guards base)
  "Return the proposition that HAPPENS and one of GUARDS, (least-distance . formula), is true.  An
effect whose condition is about times before the first one is none."
  (if (null guards)
      nil
      (let ((terms '()) (first (outline-first-time (step-outline step))))
        (loop for (start . guard) in guards
              do (let ((value (and (>= (+ base start) first) (evaluate step guard base))))
                   (cond ((eq value t) (return-from guards-proposition happens))
                         (value (push value terms)))))
        (z3:conjunction (list happens (z3:disjunction terms))))))

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
    (when (outline-dated-p outline)
      (dolist (effect (gethash time (dated-effects (outline-dated-until outline time))))
        (let ((happens (cdr (assoc (effect-event effect) events))))
          (when happens
            (setf turns (add-turn turns (dated-turn step effect happens)))))))
    turns))

(defun dated-turn (step effect happens)
  (if (> (or (formula-reach (effect-guard effect)) 0) (step-time step))
      (list (effect-fluent effect) :ahead)
      (let ((proposition (z3:conjunction (list happens
                                              (evaluate step (effect-guard effect) 0)))))
        (flet ((if-kind (kind) (and (eq (effect-kind effect) kind) proposition)))
          (list (effect-fluent effect) (if-kind :initiates) (if-kind :terminates)
                (if-kind :releases))))))

(defun effects-formula (outline fluent kind time)
  "Return the ground formula, with timepoints, that an event has an effect of KIND on FLUENT at
TIME."
  (fold :or
        (append
         (loop for effect in (fluent-effects (outline-ground outline) fluent kind nil)
               when (>= (+ time (formula-start (effect-guard effect)))
                        (outline-first-time outline))
                 collect (shift-formula (effect-formula effect) time))
         (and (outline-dated-p outline)
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
  "Set the fluents of NEXT; return a list of (fluent . value-if-not-released) for those that depend."
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
  "Let trajectories set open fluents of NEXT; return a list of (fluent axiom . proposition) for those
that one sets only where the proposition is true."
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

;;; Judging

(defun judge-demand (step demand base)
  (require-condition step (demand-axiom demand) (evaluate step (demand-formula demand) base)))

(defun judge-pending (step next)
  "Judge what is pending and due at NEXT; the rest stays pending."
  (setf (state-pending next)
        (loop for entry in (append (step-pending step) (state-pending (step-state step)))
              for (due axiom . formula) = entry
              if (<= due (state-time next))
                do (require-condition step axiom (evaluate step formula 0))
              else
                collect entry)))

(defun judge-step (step events)
  "Judge the demands that look at more than one timepoint and end with the next state of STEP."
  (let* ((outline (step-outline step))
         (demands-of (outline-event-demands-of outline))
         (single (null (rest events)))
         (judged '())
         (end (1+ (step-time step))))
    (loop for (number) in events
          do (dolist (demand (svref demands-of number))
               (unless (and (not single) (member demand judged))
                 (unless single (push demand judged))
                 (judge-demand step demand (step-time step)))))
    (dolist (demand (outline-other-demands outline))
      (let ((base (- end (demand-last demand))))
        (when (>= base (outline-first-time outline))
          (judge-demand step demand base))))))

(defun judge-changed-fluents (step next)
  "Judge the demands on the state NEXT whose fluents have changed."
  (let ((old (state-values (step-state step))) (new (state-values next))
        (demands-of (outline-state-demands-of (step-outline step))))
    (declare (type simple-vector old new demands-of))
    (flet ((changed-p (fluent) (not (eq (svref old fluent) (svref new fluent)))))
      (dotimes (fluent (length new))
        (when (changed-p fluent)
          (dolist (demand (svref demands-of fluent))
            ;; once, though several of its fluents have changed
            (when (eql fluent (find-if #'changed-p (demand-fluents demand)))
              (judge-demand step demand (state-time next)))))))))

(defun judge-dated (step time)
  (let ((outline (step-outline step)))
    (when (outline-dated-p outline)
      (dolist (demand (gethash time (dated-demands (outline-dated-until outline time))))
        (judge-demand step demand 0)))))

;;; Entry points

(defun initial-conditions (state)
  "Return what must be true of the initial STATE: a list of (axiom . proposition), the theory's
INITIALLY axioms and its sentences about single timepoints.  The axiom is an AXIOM, a list such as
(:xor name*) or (:completion predicate), or NIL where there is no single one."
  (let* ((outline (state-outline state))
         (step (make-step :state state))
         (time (state-time state))
         (judged (make-hash-table :test 'eq)))
    (dolist (sentence (ground-theory-initial-conditions (outline-ground outline)))
      (require-condition step (sentence-axiom sentence)
                         (evaluate step (sentence-formula sentence) time)))
    (dolist (demand (outline-static-demands outline)) (judge-demand step demand time))
    (loop for demands across (outline-state-demands-of outline)
          do (dolist (demand demands)
               (unless (gethash demand judged)
                 (setf (gethash demand judged) t)
                 (judge-demand step demand time))))
    (dolist (demand (outline-state-demands outline)) (judge-demand step demand time))
    (judge-dated step time)
    (nreverse (step-conditions step))))

(defun resolve-predicates (step)
  "Return a table of the predicates that have supports at the time of STEP, or NIL."
  (let ((outline (step-outline step)) (time (step-time step)))
    (loop for number being the hash-keys of (outline-predicates outline)
          do (predicate-at step number time))
    (loop for (kind number) in (dated-supports-at outline time)
          when (eq kind :predicate) do (predicate-at step number time))
    (step-predicates step)))

(defun cause-turns (outline turns)
  (and (outline-causes outline)
       (loop for turn in turns
             when (and (member (first turn) (outline-causes outline))
                       (not (eq (second turn) :ahead))
                       (or (second turn) (third turn)))
               collect (list (first turn) (second turn) (third turn)))))

(defun progress (state event)
  "Return the state after EVENT, the number of an event, NIL for none, or a list of numbers,
happened in STATE, and what must be true for that: a list of (axiom . proposition), as for
INITIAL-CONDITIONS.  The events that the theory triggers happen, too, and no others.  Signals
UNDETERMINED if the theory leaves something open and the state has no Z3 context."
  (let* ((step (make-step :state state :given (if (listp event) event (list event))))
         (outline (step-outline step))
         (events (happening-events step))
         (turns (event-turns step events))
         (next (make-state :outline outline :context (state-context state)
                           :time (1+ (state-time state)) :predecessor state
                           :statics (state-statics state) :events events
                           :turns (cause-turns outline turns)
                           :values (copy-seq (state-values state))
                           :released (if (outline-loose-fluents outline)
                                         (copy-seq (state-released state))
                                         (state-released state))
                           :numbers (copy-seq (state-numbers state))
                           :loose-numbers (copy-seq (state-loose-numbers state))))
         (mixed (set-fluents step next turns)))
    (setf (step-next step) next)
    (set-numbers step next events)
    (close-open-fluents step next mixed (apply-changes step next))
    (close-open-numbers step next)
    (when (outline-exclusions outline) (require-exclusions step events))
    (judge-step step events)
    (judge-changed-fluents step next)
    (dolist (demand (outline-state-demands outline))
      (judge-demand step demand (state-time next)))
    (judge-dated step (state-time next))
    (setf (state-predicates next) (resolve-predicates step))
    (judge-pending step next)
    (setf (state-determined-p next)
          (and (state-determined-p state) (not (step-opened-p step))))
    (values next (nreverse (step-conditions step)))))
