;;;; Axioms about one arbitrary timepoint, and the order in which effect axioms are made ground.
;;;;
;;;; An axiom whose times are all ?time, or ?time and a distance, is made ground once for all
;;;; timepoints (CLAUSE-RELATIVE-P).  A condition may refer to effects, whose axioms come first then
;;;; (ORDER-EFFECTS).

(in-package #:discrepancy-finder.event-calculus)

(defun strip-quantifiers (form)
  "Return FORM without the universal quantifiers around it."
  (loop while (and (consp form) (eq (first form) :forall))
        do (setf form (third form)))
  form)

(defun argument-sorts (theory form)
  "Return the sorts of the arguments of the atom or term FORM."
  (rest (or (and (eq (first form) :value-at) '(:value-at :numeric-fluent :time))
            (signature theory form)
            (assoc (first form) (theory-numeric-fluents theory))
            (assoc (first form) (theory-predicates theory))
            (assoc (first form) (theory-fluents theory))
            (assoc (first form) (theory-events theory))
            (nth-value 1 (reified-symbol theory (first form)))
            (first (find-function theory (first form))))))

(defun time-of-term (theory term)
  "Return the time variable of TERM, a time, if it is that, or that plus or minus something without
time variables, and what is added: an integer, or NIL if that depends on other variables."
  (flet ((time-p (term) (and (variable-p term) (eq (variable-sort theory term) :time)))
         (distance-p (term)
           (notany (lambda (variable) (eq (variable-sort theory variable) :time))
                   (term-variables term))))
    (cond ((time-p term) (values term 0))
          ((and (consp term) (member (first term) '(:+ :-)) (= (length term) 3))
           (destructuring-bind (operator left right) term
             (cond ((and (time-p left) (distance-p right))
                    (values left (and (integerp right)
                                      (if (eq operator :+) right (- right)))))
                   ((and (eq operator :+) (time-p right) (distance-p left))
                    (values right (and (integerp left) left)))))))))

(defun relative-form-p (theory form &key step)
  "Return true, the time variable and the distances of the first and the last time from it if FORM
is about one arbitrary timepoint: it has one free time variable, which only stands in times of
atoms.  The times inside of quantifiers must be among those outside, with STEP also at the next
timepoint, for there only the quantifier's instance is dropped, and not FORM's, where they are
beyond the horizon."
  (let ((variable nil) (outer (list 0 (if step 1 0))) (inner (list 0 0)))
    (labels ((fail () (return-from relative-form-p nil))
             (check-time-term (term bound duration)
               (multiple-value-bind (found distance) (time-of-term theory term)
                 (when (or (null found) (member found bound)
                           (and variable (not (eq variable found)))
                           (and bound (null distance)))
                   (fail))
                 (setf variable found)
                 (when distance
                   (let ((span (if bound inner outer)))
                     (setf (first span) (min (first span) distance)
                           (second span) (max (second span) (+ distance duration)))))))
             (check-arguments (form bound)
               (loop with duration = (if (eq (first form) :happens) 1 0)
                     for term in (rest form)
                     for sort in (argument-sorts theory form)
                     do (if (eq sort :time)
                            (check-time-term term bound duration)
                            (check-term term bound))))
             (check-term (term bound)
               (cond ((and (variable-p term) (eq (variable-sort theory term) :time)) (fail))
                     ((atom term))
                     ((member (first term) '(:+ :- :* :/ :mod :=))
                      (dolist (part (rest term)) (check-term part bound)))
                     ((eq (first term) :value-at) (check-arguments term bound))
                     (t (dolist (sort (argument-sorts theory term))
                          (when (eq sort :time) (fail)))
                        (dolist (part (rest term)) (check-term part bound)))))
             (check (form bound)
               (cond ((atom form))
                     ((member (first form) '(:and :or :not :implies :iff))
                      (dolist (part (rest form)) (check part bound)))
                     ((member (first form) '(:forall :exists))
                      (check (third form) (append (second form) bound)))
                     ((eq (first form) :initially) (fail))
                     ((member (first form) *comparisons*)
                      (dolist (part (rest form)) (check-term part bound)))
                     ((or (< 1 (count :time (rest (assoc (first form)
                                                         (theory-predicates theory)))))
                          (and (assoc (first form) (theory-extensions theory))
                               (member :time (argument-sorts theory form)))
                          (and bound (member (first form) '(:stopped-in :started-in :clipped
                                                            :declipped))))
                      (fail))
                     (t (check-arguments form bound)))))
      (check (strip-quantifiers form) '())
      (when (or (< (first inner) (first outer)) (> (second inner) (second outer)))
        (fail))
      (values (and variable t) variable outer))))

(defun step-clause-p (theory kind condition head)
  "Return true if the effect axiom or axiom of a trajectory with CONDITION and HEAD is about one
arbitrary timepoint, the time of its head, and the next."
  (multiple-value-bind (relative variable span)
      (relative-form-p theory (list :implies condition head) :step t)
    (and relative
         (eq variable (if (eq kind :effect) (first (last head)) (third head)))
         (>= (first span) 0) (<= (second span) 1))))

(defun mentions-effects-p (form)
  "Return true if the meaning of FORM depends on the effect axioms."
  (and (consp form)
       (or (member (first form) '(:initiates :terminates :releases :stopped-in :started-in
                                  :clipped :declipped))
           (some #'mentions-effects-p (rest form)))))

(defun clause-relative-p (theory clause absolute-effects)
  "Return true if CLAUSE, (axiom kind condition head), is made ground once for all timepoints.
ABSOLUTE-EFFECTS is true if an effect axiom is not."
  (destructuring-bind (axiom kind condition head &rest heads) clause
    (declare (ignore axiom heads))
    (or (member kind '(:initially :value))
        (and (if (eq kind :sentence)
                 (relative-form-p theory head)
                 (step-clause-p theory kind condition head))
             (not (and absolute-effects (eq kind :sentence) (mentions-effects-p head)))))))

;;; The order of effect axioms

(defun mentioned-effects (form)
  "Return the effects to whose completed definitions FORM refers, as a list of (kind event fluent)."
  (when (consp form)
    (append (case (first form)
              ((:initiates :terminates :releases) (list (subseq form 0 3)))
              ((:stopped-in :clipped) (list (list :terminates :?event (third form))))
              ((:started-in :declipped) (list (list :initiates :?event (third form)))))
            (mapcan #'mentioned-effects (copy-list (rest form))))))

(defun meet-p (p q)
  "Return true if the effects P and Q, (kind event fluent), can be the same as far as names tell."
  (flet ((same-p (a b) (or (variable-p a) (variable-p b) (eq (first a) (first b)))))
    (and (eq (first p) (first q)) (same-p (second p) (second q)) (same-p (third p) (third q)))))

(defun order-effects (theory clauses)
  "Return CLAUSES, a list of (axiom kind condition head), so that the effects to which a condition
refers come before it.  Signals THEORY-ERROR if they depend on each other."
  (let ((done '()) (open '()))
    (labels ((place (clause)
               (unless (member clause done :test #'eq)
                 (destructuring-bind (axiom kind condition head &rest heads) clause
                   (declare (ignore head heads))
                   (when (member clause open :test #'eq)
                     (theory-problem theory axiom condition
                                     "the effects to which the condition refers depend on it"))
                   (push clause open)
                   (dolist (effect (and (eq kind :effect) (mentioned-effects condition)))
                     (dolist (other clauses)
                       (when (and (eq (second other) :effect) (meet-p effect (fourth other)))
                         (place other))))
                   (pop open))
                 (push clause done))))
      (mapc #'place clauses)
      (nreverse done))))
