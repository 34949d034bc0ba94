;;;; Axioms: what each of them is.
;;;;
;;;; An axiom is taken apart into CLAUSES, (kind condition head): effect axioms, condition implies
;;;; (initiates event fluent time), axioms of trajectories, initial conditions, values of
;;;; functions, and sentences, which are all the rest.  Predicate completion computes the
;;;; circumscription of a predicate where it occurs positively only in heads; so the effect
;;;; predicates may stand nowhere else but in conditions.

(in-package #:discrepancy-finder.event-calculus)

(defun conjoin (p q)
  (cond ((eq p t) q)
        ((eq q t) p)
        ((and (consp p) (eq (first p) :and)) (append p (list q)))
        (t (list :and p q))))

(defun head-kind (form)
  (case (first form)
    ((:initiates :terminates :releases :assigns) :effect)
    ((:trajectory :anti-trajectory) :trajectory)
    (:initially :initially)))

(defun value-equation (theory form)
  "Return FORM, an equation one side of which applies a function of THEORY, with that on the left,
or NIL if it is none."
  (flet ((application-p (term)
           (and (consp term) (find-function theory (first term)))))
    (when (and (eq (first form) :=) (= (length form) 3))
      (destructuring-bind (left right) (rest form)
        (cond ((application-p left) form)
              ((application-p right) (list := right left)))))))

(defun with-other-heads (clauses)
  "Return CLAUSES, each with the heads of the others, of which all or none has an instance."
  (loop for (kind condition head) in clauses
        collect (list* kind condition head
                       (remove head (mapcar #'third clauses) :test #'eq))))

(defun axiom-clauses (axiom theory)
  "Return the clauses of AXIOM: a list of (kind condition head . other-heads).  KIND is :EFFECT,
:TRAJECTORY, :INITIALLY, :VALUE (of a function) or :SENTENCE.  The condition of the last two is T;
the head of a :VALUE is an equation with the function on the left, or implies one under a condition
that only compares terms."
  (labels ((heads (form condition)
             (case (first form)
               (:forall (heads (third form) condition))
               (:implies (heads (third form) (conjoin condition (second form))))
               (:and (let ((clauses (mapcar (lambda (part) (heads part condition)) (rest form))))
                       (and clauses (notany #'null clauses)
                            (with-other-heads (apply #'append clauses)))))
               (t (let ((kind (head-kind form))
                        (equation (value-equation theory form)))
                    (cond (kind (list (list kind condition form)))
                          ((null equation) nil)
                          ((eq condition t) (list (list :value t equation)))
                          ((static-form-p condition)
                           (list (list :value t (list :implies condition equation))))))))))
    (or (heads (axiom-formula axiom) t)
        (list (list :sentence t (axiom-formula axiom))))))

(defun misplaced-effect (form)
  "Return a sub-formula of the sentence FORM that states an effect, or NIL.  What stands in a
condition, negatively or within a definition (iff) or for some event only (exists), is replaced by
the completed definition."
  (labels ((effect-p (form) (member (first form) *effect-predicates*))
           (look (form positive)
             (case (first form)
               (:not (look (second form) (not positive)))
               (:implies (or (look (second form) (not positive)) (look (third form) positive)))
               (:iff (find-if #'effect-p (rest form)))
               (:forall (look (third form) positive))
               (:exists nil)
               ((:and :or) (some (lambda (part) (look part positive)) (rest form)))
               (t (and positive (effect-p form) form)))))
    (look form t)))

(defun head-only-part (form)
  "Return a sub-formula of FORM that can only be the head of an axiom, or NIL: of what effects lead
to later nothing can be asked."
  (case (first form)
    ((:assigns :trajectory :anti-trajectory) form)
    ((:forall :exists) (head-only-part (third form)))
    ((:and :or :not :implies :iff) (some #'head-only-part (rest form)))))

(defun numeric-trajectory-p (theory head)
  "Return true if HEAD, of a trajectory, leads to a number: (= numeric-fluent term)."
  (let ((change (fourth head)))
    (and (member (first head) '(:trajectory :anti-trajectory))
         (consp change) (eq (first change) :=) (= (length change) 3)
         (numeric-atom-p theory (second change)))))

(defun check-numeric-trajectory (scope head)
  (destructuring-bind (cause time change offset) (rest head)
    (check-term scope cause :fluent head)
    (check-term scope time :time head)
    (check-term scope (second change) :numeric-fluent head)
    (check-term scope (third change) :integer head)
    (check-term scope offset :offset head)))

(defun check-gradual-change (scope head)
  "Check the head of an axiom of a trajectory."
  (let ((change (fourth head)))
    (if (and (consp change) (eq (first change) :=) (= (length change) 3))
        (check-numeric-trajectory scope head)
        (check-predication scope head))))

(defun check-value (scope form)
  "Check FORM, that a function has a value, perhaps under a condition."
  (check-formula scope form)
  (destructuring-bind (application value) (rest (if (eq (first form) :implies) (third form) form))
    (when (rationalp value)
      (check-number scope value
                    (second (find-function (scope-theory scope) (first application))) form))))

(defun check-clause (theory axiom kind condition head)
  (let ((scope (make-scope :theory theory :axiom axiom)))
    (flet ((refuse (form where)
             (when form
               (scope-problem scope form "~a cannot stand ~a" (name-text (first form)) where))))
      (ecase kind
        ((:effect :trajectory)
         (let ((arity (length (rest (assoc (first head) *standard-predicates*)))))
           (check-arity scope head arity arity))
         (if (eq kind :trajectory)
             (check-gradual-change scope head)
             (check-predication scope head))
         (unless (eq condition t)
           (check-formula scope condition)
           (refuse (head-only-part condition) "in a condition, only as the head of an axiom")
           (refuse (misplaced-effect (list :not condition))
                   "here, only as the head of an axiom or in a condition")))
        (:initially
         (unless (eq condition t)
           (scope-problem scope head "initially stands alone: its condition belongs inside"))
         (check-arity scope head 1 1)
         (check-formula (make-scope :theory theory :axiom axiom :kind :state) (second head)))
        (:value (check-value scope head))
        (:sentence
         (check-formula scope head)
         (refuse (misplaced-effect head)
                 "here, only as the head of an axiom: completion needs (implies condition head)")
         (refuse (head-only-part head) "in a condition, only as the head of an axiom"))))))

(defun check-axiom (theory axiom)
  "Check AXIOM of THEORY.  Signals THEORY-ERROR."
  (let ((scope (make-scope :theory theory :axiom axiom)))
    (check-structure scope (axiom-formula axiom) (constantly nil))
    (check-variable-count scope (axiom-formula axiom))
    (loop for (kind condition head) in (axiom-clauses axiom theory)
          do (check-clause theory axiom kind condition head))))
