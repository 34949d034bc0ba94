;;;; Numeric fluents in progression.
;;;;
;;;; The number of a numeric fluent is a rational where it is known, else a real term of Z3.  An
;;;; event assigns it; else it stays as it is; where it is released, by an event, it may be
;;;; anything that trajectories and sentences allow.  Entry points: EVALUATE-COMPARISON,
;;;; SET-NUMBERS.

(in-package #:discrepancy-finder.event-calculus)

;;; Terms

(defun number-at (step numeric time)
  (svref (state-numbers (state-at step time)) numeric))

(defun exact-quotient (a b)
  "Return the quotient of the numbers or terms A and B, which is no 0."
  (if (and (rationalp a) (rationalp b)) (/ a b) (z3:quotient a b)))

(defun evaluate-term (step term base)
  "Return the value, a rational or a term of Z3, of the ground TERM, whose distances are from BASE,
and the proposition that nothing is divided by 0 in it."
  (let ((defined '()))
    (labels ((value (term)
               (if (atom term)
                   term
                   (ecase (first term)
                     (:value (number-at step (second term) (+ base (third term))))
                     (:+ (z3:sum (mapcar #'value (rest term))))
                     (:* (z3:product (mapcar #'value (rest term))))
                     (:- (if (cddr term)
                             (z3:difference (value (second term)) (value (third term)))
                             (z3:difference 0 (value (second term)))))
                     (:/ (let* ((divisor (value (third term))) (zero (z3:equals divisor 0)))
                           (push (z3:negation zero) defined)
                           (if (eq zero t) 0 (exact-quotient (value (second term)) divisor))))))))
      (values (value term) (z3:conjunction defined)))))

(defun evaluate-comparison (step comparison base)
  "Return the proposition of the ground COMPARISON, (:compare operator term term); it is false
where something is divided by 0."
  (destructuring-bind (operator left right) (rest comparison)
    (multiple-value-bind (p p-defined) (evaluate-term step left base)
      (multiple-value-bind (q q-defined) (evaluate-term step right base)
        (z3:conjunction (list p-defined q-defined
                              (ecase operator
                                (:= (z3:equals p q))
                                (:< (z3:less p q))
                                (:<= (z3:less-or-equal p q)))))))))

;;; Effects.  An ASSIGNMENT is (proposition . value).

(defun numeric-effects-now (outline numeric events time)
  "Return those effects on NUMERIC that EVENTS, (number . proposition), may have at TIME, each with
the proposition of its event."
  (append
   (loop for effect in (svref (ground-theory-effects-on-numeric (outline-ground outline)) numeric)
         for happens = (cdr (assoc (effect-event effect) events))
         when (and happens
                   (>= (+ time (formula-start (effect-guard effect)))
                       (outline-first-time outline)))
           collect (cons effect happens))
   (and (outline-dated-p outline)
        (loop for effect in (gethash time (dated-numeric-effects
                                           (outline-dated-until outline time)))
              for happens = (cdr (assoc (effect-event effect) events))
              when (and happens (= (effect-fluent effect) numeric))
                collect (cons effect happens)))))

(defun effect-base (effect time)
  "Return what the distances in EFFECT are from if its event happens at TIME."
  (if (effect-time effect) 0 time))

(defun effect-ahead-p (effect time)
  "Return true if EFFECT at TIME depends on what is not known then."
  (loop for formula in (list (effect-guard effect) (list :compare := 0 (effect-term effect)))
        for reach = (formula-reach formula)
          thereis (and reach (> (+ reach (effect-base effect time)) time))))

(defun number-turn (step effects)
  "Return the assignments of EFFECTS, (effect . proposition), the proposition that one of them
releases the number, and the proposition that nothing assigned is divided by 0."
  (let ((time (step-time step)) (assignments '()) (released '()) (sound '()))
    (loop for (effect . happens) in effects
          for base = (effect-base effect time)
          for proposition = (z3:conjunction
                             (list happens (evaluate step (effect-guard effect) base)))
          do (cond ((null proposition))
                   ((eq (effect-kind effect) :releases) (push proposition released))
                   (t (multiple-value-bind (value defined)
                          (evaluate-term step (effect-term effect) base)
                        (push (z3:implication proposition defined) sound)
                        (push (cons proposition value) assignments)))))
    (values assignments (z3:disjunction released) (z3:conjunction sound))))

(defun assigned-number (assignments otherwise)
  "Return the value of a number by ASSIGNMENTS, or OTHERWISE where none is made."
  (let ((value otherwise))
    (loop for (proposition . assigned) in assignments
          do (setf value (z3:if-then-else proposition assigned value
                                          (sort-of-numbers assigned value proposition))))
    value))

(defun sort-of-numbers (a b condition)
  "Return the real sort of the context that the terms among A, B and CONDITION have, or NIL."
  (let ((term (find-if #'z3:term-p (list a b condition))))
    (and term (z3:real-sort (z3:term-context term)))))

(defun set-number (step next numeric effects)
  "Set the number NUMERIC in NEXT, and whether it is released: :OPEN where it is, and nothing else
is known."
  (multiple-value-bind (assignments released sound) (number-turn step effects)
    (let* ((state (step-state step))
           (assigned (z3:disjunction (mapcar #'car assignments)))
           (loose (z3:disjunction
                   (list released (z3:conjunction
                                   (list (svref (state-loose-numbers state) numeric)
                                         (z3:negation assigned))))))
           (old (svref (state-numbers state) numeric)))
      (require-condition step nil sound)
      (require-compatible step released assigned)
      (setf (svref (state-loose-numbers next) numeric) loose
            (svref (state-numbers next) numeric)
            (case loose
              ((nil) (assigned-number assignments old))
              ((t) :open)
              (t (assigned-number assignments
                                  (z3:if-then-else loose
                                                   (open-atom step :number numeric
                                                              (state-time next))
                                                   old)))))
      (when (and (rest assignments) (null loose))
        (loop for (proposition . value) in assignments
              do (require-condition
                  step nil
                  (z3:implication proposition
                                  (z3:equals (svref (state-numbers next) numeric) value))))))))

(defun open-number (step next numeric)
  "Let the number NUMERIC, whose effects depend on what is not known yet, be anything in NEXT."
  (let ((time (state-time next)))
    (setf (svref (state-numbers next) numeric) (open-atom step :number numeric time)
          (svref (state-loose-numbers next) numeric)
          (open-atom step :number-released numeric time))))

(defun set-numbers (step next events)
  "Set the numbers of NEXT after EVENTS, (number . proposition)."
  (let ((outline (step-outline step)) (time (step-time step)))
    (dotimes (numeric (length (state-numbers next)))
      (let ((effects (numeric-effects-now outline numeric events time)))
        (cond ((some (lambda (effect) (effect-ahead-p (car effect) time)) effects)
               (open-number step next numeric))
              ((or effects (svref (state-loose-numbers next) numeric))
               (set-number step next numeric effects)))))))

(defun note-numeric-limits (outline effects)
  "Note the limits due to EFFECTS on numbers that look ahead."
  (dolist (effect effects)
    (when (effect-ahead-p effect (or (effect-time effect) 0))
      (pushnew (cons (effect-axiom effect)
                     "its effect on a number depends on later timepoints")
               (outline-limits outline) :test #'equal))))

;;; Trajectories

(defun apply-numeric-change (step next change begin proposition)
  "Let CHANGE, which began at BEGIN where PROPOSITION is true, give its number in NEXT."
  (multiple-value-bind (value defined)
      (evaluate-term step (gradual-change-term change) (change-begin change begin))
    (let ((numeric (gradual-change-fluent change)) (axiom (gradual-change-axiom change)))
      (require-condition step axiom (z3:implication proposition defined))
      (if (and (eq proposition t) (eq (svref (state-numbers next) numeric) :open))
          (setf (svref (state-numbers next) numeric) value)
          (let ((number (svref (state-numbers next) numeric)))
            (when (eq number :open)
              (setf number (open-atom step :number numeric (state-time next))
                    (svref (state-numbers next) numeric) number))
            (require-condition step axiom
                               (z3:implication proposition (z3:equals number value))))))))

(defun close-open-numbers (step next)
  "Give the open numbers of NEXT variables."
  (let ((numbers (state-numbers next)))
    (dotimes (numeric (length numbers))
      (when (eq (svref numbers numeric) :open)
        (setf (svref numbers numeric) (open-atom step :number numeric (state-time next)))))))
