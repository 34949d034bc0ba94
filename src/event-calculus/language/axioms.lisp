;;;; Axioms: what each of them is, and the making of a theory from declarations and axioms.
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

(defun axiom-clauses (axiom theory)
  "Return the clauses of AXIOM: a list of (kind condition head).  KIND is :EFFECT, :TRAJECTORY,
:INITIALLY, :VALUE (of a function) or :SENTENCE, whose condition is T."
  (labels ((heads (form condition)
             (case (first form)
               (:forall (heads (third form) condition))
               (:implies (heads (third form) (conjoin condition (second form))))
               (:and (let ((clauses (mapcar (lambda (part) (heads part condition)) (rest form))))
                       (and clauses (notany #'null clauses)
                            (apply #'append clauses))))
               (t (let ((kind (head-kind form)))
                    (cond (kind (list (list kind condition form)))
                          ((and (eq (first form) :=) (eq condition t) (consp (second form))
                                (find-function theory (first (second form))))
                           (list (list :value t form)))))))))
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

(defun check-clause (theory axiom kind condition head)
  (let ((scope (make-scope :theory theory :axiom axiom)))
    (flet ((check-condition (form)
             (unless (eq form t)
               (check-formula scope form)
               (let ((wrong (misplaced-effect (list :not form))))
                 (when wrong
                   (scope-problem scope wrong "~a cannot stand here, only as the head of an axiom ~
                                               or in a condition"
                                  (name-text (first wrong))))))))
      (ecase kind
        ((:effect :trajectory)
         (let ((arity (length (rest (assoc (first head) *standard-predicates*)))))
           (check-arity scope head arity arity))
         (if (numeric-trajectory-p theory head)
             (check-numeric-trajectory scope head)
             (check-predication scope head))
         (check-condition condition))
        (:initially
         (unless (eq condition t)
           (scope-problem scope head "initially stands alone: its condition belongs inside"))
         (check-arity scope head 1 1)
         (check-formula (make-scope :theory theory :axiom axiom :kind :state) (second head)))
        (:value (check-formula scope head))
        (:sentence
         (check-formula scope head)
         (let ((wrong (misplaced-effect head)))
           (when wrong
             (scope-problem scope wrong "~a cannot stand here, only as the head of an axiom: ~
                                         completion needs (implies condition head)"
                            (name-text (first wrong))))))))))

(defun check-axiom (theory axiom)
  "Check AXIOM of THEORY.  Signals THEORY-ERROR."
  (loop for (kind condition head) in (axiom-clauses axiom theory)
        do (check-clause theory axiom kind condition head)))

;;; Declarations

(defun check-argument-sorts (theory option declaration sorts)
  (dolist (sort sorts)
    (cond ((not (theory-sort theory sort))
           (theory-problem theory option declaration "there is no sort ~a" (name-text sort)))
          ((and (eq sort :integer) (not (equal option ":functions")))
           (theory-problem theory option declaration
                           "the sort integer has no range: declare a sort with (:range low high)"
                           )))))

(defun check-signatures (theory)
  (loop for (option declarations) in `((":predicates" ,(theory-predicates theory))
                                       (":functions" ,(mapcar #'first (theory-functions theory)))
                                       (":fluents" ,(theory-fluents theory))
                                       (":numeric-fluents" ,(theory-numeric-fluents theory))
                                       (":events" ,(theory-events theory)))
        do (loop for (declaration . others) on declarations
                 do (when (assoc (first declaration) others)
                      (theory-problem theory option declaration "~a is declared twice"
                                      (name-text (first declaration))))
                    (check-argument-sorts theory option declaration (rest declaration))))
  (loop for (nil sort) in (theory-functions theory)
        do (check-argument-sorts theory ":functions" nil (list sort))))

(defun check-sorts (theory)
  (loop for (sort . others) on (theory-sorts theory)
        for name = (sort-name sort)
        do (when (find-sort others name)
             (theory-problem theory ":sorts" nil "~a is declared twice" (name-text name)))
           (dolist (parent (sort-parents sort))
             (unless (theory-sort theory parent)
               (theory-problem theory ":sorts" nil "there is no sort ~a, the parent of ~a"
                               (name-text parent) (name-text name)))
             (when (subsort-p (theory-sorts theory) parent name)
               (theory-problem theory ":sorts" nil "~a is below itself" (name-text name))))
           (loop for declaration in (sort-terms sort)
                 do (check-argument-sorts theory ":sorts" declaration (rest declaration)))))

(defun check-names (theory)
  "Check the names of fluents, events and predicates that declarations mention."
  (flet ((check (option names known kind)
           (dolist (name names)
             (unless (assoc name known)
               (theory-problem theory option nil "there is no ~a ~a" kind (name-text name))))))
    (check ":non-inertial-fluents" (theory-non-inertial theory) (theory-fluents theory) "fluent")
    (when (listp (theory-manual-release theory))
      (check ":manual-release" (theory-manual-release theory) (theory-fluents theory) "fluent"))
    (loop for (key . names) in (theory-exclusions theory)
          do (check (format nil "~(~s~)" key) names
                    (append (theory-fluents theory) (theory-events theory)) "fluent or event"))
    (loop for (nil predicate) in (theory-completions theory)
          do (unless (or (member predicate *effect-predicates*) (eq predicate :happens)
                         (assoc predicate (theory-predicates theory)))
               (theory-problem theory ":completion" nil "there is no predicate ~a to complete"
                               (name-text predicate))))))

(defun check-extensions (theory)
  (loop for (name . tuples) in (theory-extensions theory)
        for sorts = (rest (assoc name (theory-predicates theory)))
        do (dolist (tuple tuples)
             (unless (and (= (length tuple) (length sorts))
                          (loop for element in tuple
                                for sort in sorts
                                always (element-of-sort-p theory element sort)))
               (theory-problem theory ":predicates" tuple
                               "the arguments of ~a are of the sorts ~{~a~^, ~}" (name-text name)
                               (mapcar #'name-text sorts))))
           (when (find name (theory-completions theory) :key #'second)
             (theory-problem theory ":completion" nil "~a is given as a table already"
                             (name-text name)))))

(defun check-axioms (theory)
  (loop for (axiom . others) on (theory-axioms theory)
        do (check-axiom theory axiom)
           (when (find (axiom-name axiom) others :key #'axiom-name)
             (theory-problem theory axiom nil "another axiom has the same name"))))

(defun make-checked-theory (&rest parts
                            &key extends name documentation syntax file sorts predicates
                              extensions functions fluents numeric-fluents non-inertial manual-release events axioms completions
                              exclusions time-range offset-range options)
  "Return the theory NAME of the given parts, which are as the readers of a THEORY return them;
those of the theories EXTENDS come first.  Signals THEORY-ERROR if they do not fit together."
  (declare (ignore name documentation syntax file))
  (flet ((all (reader own)
           (remove-duplicates (append (mapcan (lambda (theory) (copy-list (funcall reader theory)))
                                              extends)
                                      own)
                              :test #'equalp :from-end t))
         (own-or-inherited (own reader)
           (or own (some reader extends))))
    (let ((theory
            (apply #'make-theory :allow-other-keys t
                   :sorts (all #'theory-sorts sorts)
                   :predicates (all #'theory-predicates predicates)
                   :extensions (all #'theory-extensions extensions)
                   :functions (all #'theory-functions functions)
                   :fluents (all #'theory-fluents fluents)
                   :numeric-fluents (all #'theory-numeric-fluents numeric-fluents)
                   :non-inertial (all #'theory-non-inertial non-inertial)
                   :manual-release (if (or (eq manual-release t)
                                           (find t extends :key #'theory-manual-release))
                                       t
                                       (all #'theory-manual-release manual-release))
                   :events (all #'theory-events events)
                   :axioms (all #'theory-axioms axioms)
                   :completions (all #'theory-completions completions)
                   :exclusions (all #'theory-exclusions exclusions)
                   :time-range (own-or-inherited time-range #'theory-time-range)
                   :offset-range (own-or-inherited offset-range #'theory-offset-range)
                   :options (append options (mapcan (lambda (theory)
                                                      (copy-list (theory-options theory)))
                                                    extends))
                   parts)))
      (check-sorts theory)
      (check-signatures theory)
      (check-names theory)
      (check-extensions theory)
      (check-axioms theory)
      theory)))
