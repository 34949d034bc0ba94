;;;; Questions: what can be, what must be, and which events lead to a goal.
;;;;
;;;; POSSIBLE-P and ENTAILED-P ask about one formula; CONSEQUENCES lists what is certain, forwards
;;;; from a narrative (projection) or backwards from observations (postdiction); ABDUCE finds the
;;;; shortest sequences of events that reach a goal (planning).

(in-package #:discrepancy-finder.event-calculus)

(defun possible-p (theory formula &key horizon)
  "Return true if FORMULA, with timepoints by number, is true in some model of THEORY, a theory, its
name or a reasoner.  HORIZON is as for MAKE-REASONER.  Signals THEORY-ERROR, NO-HORIZON."
  (with-reasoner-of (reasoner theory :horizon horizon)
    (with-question (reasoner formula)
      (eq (z3:check (reasoner-solver reasoner)) :sat))))

(defun consistent-p (theory &key horizon)
  "Return true if THEORY has a model.  The arguments are those of POSSIBLE-P."
  (with-reasoner-of (reasoner theory :horizon horizon)
    (eq (z3:check (reasoner-solver reasoner)) :sat)))

(defun entailed-p (theory formula &key horizon)
  "Return true if FORMULA is true in all models of THEORY, and as a second value true if THEORY has
any.  The arguments are those of POSSIBLE-P."
  (with-reasoner-of (reasoner theory :horizon horizon)
    (let ((entailed (not (possible-p reasoner (list :not formula)))))
      (values entailed (or (not entailed) (consistent-p reasoner))))))

(defun backbone (reasoner variables)
  "Return a table from those of VARIABLES that have the same value in all models to that value, 0 or
1; NIL if there is no model."
  (let ((clause-set (reasoner-clause-set reasoner)))
    (when (eq (z3:check-literals clause-set '()) :sat)
      (let* ((values (current-values reasoner))
             (open (copy-list variables))
             (table (make-hash-table)))
        ;; Each further model that differs from the first one leaves fewer candidates.
        (loop while open
              do (let ((variable (pop open)))
                   (if (eq (z3:check-literals clause-set
                                              (list (if (= 1 (sbit values variable))
                                                        (- variable)
                                                        variable)))
                           :sat)
                       (let ((others (current-values reasoner)))
                         (setf open (remove-if (lambda (candidate)
                                                 (/= (sbit values candidate)
                                                     (sbit others candidate)))
                                               open)))
                       (setf (gethash variable table) (sbit values variable)))))
        table))))

(defun consequences (theory &key horizon where)
  "Return what is certain in all models of THEORY that satisfy the formula WHERE: a list of atoms
that are true, such as (:holds-at (:alive) 3) or (:happens (:load) 0), a list of those that are
false, and a list of those that are open; and true if there is a model.  From a narrative this is
projection, from observations postdiction.  The arguments are those of MODELS."
  (with-reasoner-of (reasoner theory :horizon horizon)
    (with-question (reasoner where)
      (let* ((variables (atom-variables reasoner))
             (table (backbone reasoner variables))
             (true '()) (false '()) (open '()))
        (when table
          (dolist (variable variables)
            (let ((atom (variable-atom reasoner variable)))
              (case (gethash variable table)
                (1 (push atom true))
                (0 (push atom false))
                (t (push atom open))))))
        (values (nreverse true) (nreverse false) (nreverse open) (and table t))))))

;;; Abduction

(defun triggered-events (ground)
  "Return the names of the events that some sentence makes happen."
  (let ((names '()))
    (dolist (sentence (ground-theory-sentences ground) names)
      (map-positive-atoms (lambda (atom)
                            (when (eq (first atom) :event)
                              (pushnew (first (svref (ground-theory-events ground) (second atom)))
                                       names)))
                          (sentence-formula sentence)))))

(defun abducible-events (theory ground)
  (set-difference (mapcar #'first (theory-events theory)) (triggered-events ground)))

(defun goal-at (goal theory time)
  "Return the state formula GOAL of THEORY as a formula about TIME."
  (labels ((convert (form)
             (case (if (consp form) (first form) :term)
               (:term form)
               ((:and :or :not :implies :iff) (cons (first form) (mapcar #'convert (rest form))))
               ((:forall :exists) (list (first form) (second form) (convert (third form))))
               (:value-at (list :value-at (second form) time))
               (t (cond ((assoc (first form) (theory-fluents theory)) (list :holds-at form time))
                        ((mentions-value-p form) (mapcar #'convert form))
                        (t form))))))
    (convert (parse-formula goal theory :kind :state :blame "the goal"))))

(defun model-plan (model)
  "Return the list of the events of MODEL, for each timepoint a list."
  (destructuring-bind (first . last) (model-horizon model)
    (loop for time from first below last collect (model-events model time))))

(defun steps-of-question (theory form range)
  "Return how many steps of the horizon RANGE the formula FORM, or NIL, speaks of."
  (let ((last (car range)))
    (when form
      (let ((checked (parse-formula form theory :kind :query :blame "the question")))
        (check-question-times theory checked range)
        (map-question-times (lambda (time event)
                              (setf last (max last (if event (1+ time) time))))
                            theory checked)))
    (- last (car range))))

(defun abduce (theory goal &key horizon (shortest 0) (limit 1) where (minimal t) seed)
  "Return the shortest sequences of events, at most LIMIT, after which GOAL, a state formula, holds
in THEORY: a list of lists that have a list of events for each timepoint; and their length.  The
horizon grows from SHORTEST steps to HORIZON, the last timepoint; return NIL if that is not enough.
Events that no axiom makes happen are free to happen, also where the theory completes happens.
WHERE is a formula with timepoints by number that must be true, too.  Unless MINIMAL is NIL no event
happens without need.  Signals THEORY-ERROR, NO-HORIZON."
  (let* ((theory (if (theory-p theory) theory (find-theory theory)))
         (range (check-horizon theory horizon))
         (shortest (max shortest (steps-of-question theory where range)))
         (*horizon* range)
         (ground (ground theory)))
    (with-reasoner (reasoner theory :horizon (list (car range) (+ (car range) shortest))
                                    :ground ground :seed seed
                                    :open-events (abducible-events theory ground))
      (loop for last from (+ (car range) shortest) to (cdr range)
            do (extend-horizon reasoner last)
               (let* ((goal (goal-at goal theory last))
                      (models (models reasoner :limit limit :complete nil
                                               :minimize (and minimal '(:happens))
                                               :where (if where (list :and goal where) goal))))
                 (when models
                   (return (values (remove-duplicates (mapcar #'model-plan models) :test #'equal)
                                   (- last (car range))))))))))
