;;;; What happens in a step, and what that does to the fluents.
;;;;
;;;; HAPPENING-EVENTS finds the events, given and triggered, EVENT-TURNS what they initiate,
;;;; terminate and release: a TURN is (fluent initiated terminated released), three propositions,
;;;; or (fluent :ahead) if effects depend on what is not known yet.

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

;;; Effects

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
