;;;; Making a theory ground.
;;;;
;;;; GROUND makes the axioms about one arbitrary timepoint ground, once for all timepoints;
;;;; HORIZON-SENTENCES does the rest for given timepoints.  Which is which is decided by
;;;; RELATIVE-FORM-P.

(in-package #:discrepancy-finder.event-calculus)

;;; Instances

(defun call-with-instances (ground axiom variables time-variable filters function)
  "Call FUNCTION with the compilation for the free VARIABLES of AXIOM; it returns a function that is
called with each environment.  TIME-VARIABLE, if any, is bound to 0."
  (multiple-value-bind (compilation level)
      (extend-compilation (make-compilation :ground ground)
                          (if time-variable (cons time-variable variables) variables))
    (let ((environment (make-array +environment-size+ :initial-element nil))
          (instance (funcall (the function function) compilation))
          (*instances* (cons axiom 0)))
      (when time-variable
        (setf (svref environment (cdr (assoc time-variable (compilation-slots compilation)))) 0))
      (funcall (the function (compile-instances compilation variables filters level))
               (lambda (environment)
                 (count-instance ground)
                 ;; The timepoint in question is one of the horizon, whatever is said of it.
                 (setf *definitions* '()
                       *span* (if time-variable
                                  (cons 0 0)
                                  (cons most-positive-fixnum most-negative-fixnum)))
                 (funcall (the function instance) environment)
                 ;; It was not dropped.
                 (setf (gethash axiom (ground-theory-instantiated ground)) t))
               environment))))

(defun bindings-in (compilation environment variables)
  (loop for variable in variables
        collect (cons variable
                      (svref environment (cdr (assoc variable (compilation-slots compilation)))))))

(defun conditions-of (condition)
  (filters-of (list :implies condition '(:and)) t))

(defun add-effect (ground effect)
  "Put EFFECT into the tables of GROUND."
  (let ((event (effect-event effect)) (fluent (effect-fluent effect)))
    (push effect (svref (ground-theory-effects ground) event))
    (push effect (svref (ground-theory-effects-on ground) fluent))
    (when (and (eq (effect-kind effect) :releases)
               (null (svref (ground-theory-release ground) fluent)))
      (setf (svref (ground-theory-release ground) fluent) :possibly))))

(defun compile-heads (compilation heads)
  "Return a list of functions that drop the instance if one of HEADS, of effects, has none."
  (loop for (nil event fluent) in (remove :effect heads :key #'head-kind :test-not #'eq)
        collect (compile-event compilation event)
        collect (if (numeric-atom-p (compilation-theory compilation) fluent)
                    (compile-numeric compilation fluent)
                    (compile-fluent compilation fluent))))

(defun ground-effect (ground axiom condition head other-heads)
  "Add the instances of an effect axiom to GROUND; it has none where one of OTHER-HEADS has none."
  (let* ((theory (ground-theory-theory ground))
         (time-variable (and *relative*
                             (nth-value 1 (relative-form-p theory
                                                           (list :implies condition head)
                                                           :step t))))
         (variables (remove time-variable
                            (free-variables (list* :implies condition head other-heads)))))
    (call-with-instances
     ground axiom variables time-variable (and (consp condition) (conditions-of condition))
     (lambda (compilation)
       (let* ((numeric (numeric-atom-p theory (third head)))
              (assigns (eq (first head) :assigns))
              (event (compile-event compilation (second head)))
              (fluent (if numeric
                          (compile-numeric compilation (third head))
                          (compile-fluent compilation (third head))))
              (term (if assigns
                        (compile-number compilation (fourth head))
                        (compile-constant nil)))
              (time (compile-time compilation (first (last head)) :event t))
              (others (compile-heads compilation other-heads))
              (guard (if (eq condition t)
                         (compile-constant t)
                         (compile-formula compilation condition))))
         (declare (type function event fluent term time guard))
         (lambda (environment)
           (dolist (other others)
             (funcall (the function other) environment))
           (let* ((time (funcall time environment))
                  (guard (funcall guard environment))
                  (event (funcall event environment))
                  (fluent (funcall fluent environment))
                  (effect (make-effect :kind (first head) :event event :fluent fluent
                                       :guard guard :time (if *relative* nil time) :axiom axiom
                                       :term (funcall term environment)
                                       :bindings (bindings-in compilation environment
                                                              variables))))
             (cond ((null guard))
                   (numeric (push effect
                                  (svref (ground-theory-effects-on-numeric ground) fluent)))
                   (t (add-effect ground effect))))))))))

(defun ground-trajectory (ground axiom condition head)
  "Add the instances of an axiom of a trajectory to GROUND."
  (let* ((theory (ground-theory-theory ground))
         (time-variable (and *relative*
                             (nth-value 1 (relative-form-p theory
                                                           (list :implies condition head)
                                                           :step t))))
         (variables (remove time-variable (free-variables (list :implies condition head)))))
    (call-with-instances
     ground axiom variables time-variable (and (consp condition) (conditions-of condition))
     (lambda (compilation)
       (destructuring-bind (kind cause time change offset) head
         (let* ((numeric (numeric-trajectory-p theory head))
               (cause (compile-fluent compilation cause))
               (time (compile-time compilation time))
               (fluent (if numeric
                           (compile-numeric compilation (second change))
                           (compile-fluent compilation change)))
               (term (if numeric
                         (compile-number compilation (third change))
                         (compile-constant nil)))
               (offset (compile-term compilation offset))
               (guard (if (eq condition t)
                          (compile-constant t)
                          (compile-formula compilation condition))))
           (declare (type function cause time fluent term offset guard))
           (lambda (environment)
             (let ((time (funcall time environment))
                   (guard (funcall guard environment))
                   (offset (funcall offset environment))
                   (cause (funcall cause environment))
                   (fluent (funcall fluent environment)))
               (when (and guard (typep offset '(integer 1)))
                 (push (make-gradual-change
                        :kind kind :cause cause :fluent fluent :offset offset :guard guard
                        :term (funcall term environment)
                        :time (if *relative* nil time) :axiom axiom
                        :bindings (bindings-in compilation environment variables))
                       (svref (ground-theory-changes ground) cause)))))))))))

(defun ground-sentence (ground axiom formula)
  "Return the instances of the sentence FORMULA, in order."
  (let* ((theory (ground-theory-theory ground))
         (formula (strip-quantifiers formula))
         (time-variable (and *relative* (nth-value 1 (relative-form-p theory formula))))
         (variables (remove time-variable (free-variables formula)))
         (sentences '()))
    (call-with-instances
     ground axiom variables time-variable (filters-of formula t)
     (lambda (compilation)
       (let ((function (compile-formula compilation formula)))
         (declare (type function function))
         (lambda (environment)
           (let ((formula (funcall function environment)))
             (unless (eq formula t)
               (destructuring-bind (first . last) *span*
                 (let ((timeless (> first last)))
                   (push (make-sentence :axiom axiom :formula formula
                                        :bindings (bindings-in compilation environment variables)
                                        :first (if timeless 0 first) :last (if timeless 0 last)
                                        :absolute (or timeless (not *relative*))
                                        :definitions *definitions*)
                         sentences)))))))))
    (nreverse sentences)))

;;; Whole theories

(defun ground-clause (ground axiom kind condition head other-heads)
  "Add the instances of one clause of AXIOM to GROUND; return those that are sentences."
  (ecase kind
    (:effect (ground-effect ground axiom condition head other-heads) '())
    (:trajectory (ground-trajectory ground axiom condition head) '())
    (:sentence (ground-sentence ground axiom head))
    (:initially (ground-sentence ground axiom (second head)))))

(defun make-empty-ground-theory (theory)
  (let* ((fluents (coerce (ground-symbols theory (theory-fluents theory) nil) 'simple-vector))
         (numerics (coerce (ground-symbols theory (theory-numeric-fluents theory) nil)
                           'simple-vector))
         (events (coerce (ground-symbols theory (theory-events theory) nil) 'simple-vector))
         (always (theory-non-inertial theory))
         (manual (theory-manual-release theory)))
    (flet ((lists (atoms) (make-array (length atoms) :initial-element '())))
      (make-ground-theory
       :theory theory :fluents fluents :events events :numerics numerics
       :numeric-index (index-table numerics) :effects-on-numeric (lists numerics)
       :fluent-index (index-table fluents) :event-index (index-table events)
       :effects (lists events) :effects-on (lists fluents) :changes (lists fluents)
       :release (map 'simple-vector
                     (lambda (fluent)
                       (cond ((member (first fluent) always) :always)
                             ((or (eq manual t) (member (first fluent) manual)) :possibly)))
                     fluents)))))

(defparameter *clause-order* '(:effect :trajectory :initially :sentence)
  "The order in which clauses are made ground, after those for values of functions, so that each
finds what it refers to.")

(defun add-clauses (ground clauses)
  "Make CLAUSES, a list of (axiom kind condition head), ground; return the sentences and the initial
conditions among them."
  (let ((sentences '()) (initial '())
        (clauses (order-effects (ground-theory-theory ground) clauses)))
    (ground-values ground clauses)
    (dolist (wanted *clause-order* (values (nreverse sentences) (nreverse initial)))
      (loop for (axiom kind condition head . other-heads) in clauses
            when (eq kind wanted)
              do (dolist (sentence (ground-clause ground axiom kind condition head
                                                      other-heads))
                   (if (eq kind :initially)
                       (push sentence initial)
                       (push sentence sentences)))))))

(defun one-event-clause-p (theory clause)
  "Return true if CLAUSE says that events that happen at the same timepoint are the same."
  (let ((form (strip-quantifiers (fourth clause))))
    (and (eq (second clause) :sentence)
         (eq (first form) :implies)
         (let ((premise (second form)) (conclusion (third form)))
           (and (eq (first premise) :and) (= (length premise) 3) (eq (first conclusion) :=)
                (destructuring-bind (first second) (rest premise)
                  (and (eq (first first) :happens) (eq (first second) :happens)
                       (eq (third first) (third second)) (variable-p (third first))
                       (every (lambda (term)
                                (and (variable-p term) (eq (variable-sort theory term) :event)))
                              (list (second first) (second second)))
                       (not (eq (second first) (second second)))
                       (or (equal (rest conclusion) (list (second first) (second second)))
                           (equal (rest conclusion)
                                  (list (second second) (second first)))))))))))

(defun speaks-of-later-p (form)
  "Return true if FORM, the condition of an effect, may speak of a time after that of the effect: of
an event, which ends one later, or of a time that is computed."
  (and (consp form)
       (or (member (first form) '(:happens :+ :-))
           (some #'speaks-of-later-p (rest form)))))

(defun ground (theory)
  "Return the GROUND-THEORY of THEORY."
  (let* ((ground (make-empty-ground-theory theory))
         (*relative* t)
         (*span* (cons 0 0))
         (*definitions* '())
         (all-clauses (loop for axiom in (theory-axioms theory)
                            append (loop for clause in (axiom-clauses axiom theory)
                                         collect (cons axiom clause))))
         (clauses (remove-if (lambda (clause) (one-event-clause-p theory clause)) all-clauses))
         ;; Sentences on effects that look ahead say less at the end of a horizon.
         (absolute-effects
           (find-if (lambda (clause)
                      (and (eq (second clause) :effect)
                           (or (not (clause-relative-p theory clause nil))
                               (speaks-of-later-p (third clause)))))
                    clauses))
         (absolute (remove-if (lambda (clause)
                                (clause-relative-p theory clause absolute-effects))
                              clauses)))
    (setf (ground-theory-absolute-clauses ground) absolute
          (ground-theory-one-event-at-a-time ground)
          (first (find-if (lambda (clause) (one-event-clause-p theory clause)) all-clauses)))
    (multiple-value-bind (sentences initial)
        (add-clauses ground (remove-if (lambda (clause) (member clause absolute)) clauses))
      (setf (ground-theory-sentences ground) sentences
            (ground-theory-initial-conditions ground) initial))
    ground))

(defun ground-for-horizon (ground horizon)
  "Return GROUND together with the instances of its other axioms for the timepoints HORIZON."
  (let* ((copy (copy-with-own-effects ground))
         (*relative* nil)
         (*horizon* horizon)
         (*span* (cons 0 0))
         (*definitions* '()))
    (multiple-value-bind (sentences initial)
        (add-clauses copy (ground-theory-absolute-clauses ground))
      (declare (ignore initial))
      (setf (ground-theory-sentences copy)
            (append (ground-theory-sentences ground) sentences))
      copy)))
