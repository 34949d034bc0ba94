;;;; Evaluating ground formulas along a chain of states, and resolving definitions.
;;;;
;;;; A STEP is a transition in work: from a state, with the events given, to the next state once it
;;;; is known.  EVALUATE returns the proposition of a ground formula; its distances are from a base
;;;; time.  The value of an event or a predicate is that of its definition, found when it is first
;;;; asked for.  Where a definition leads back to itself, as with (or (happens a) (happens b)), the
;;;; atom becomes a variable, and that it is equivalent to its definition becomes a condition; and
;;;; where a definition looks ahead that condition is left pending until the timepoints exist.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (step-in-work (:conc-name step-) (:constructor make-step) (:copier nil))
  "A transition from STATE, the latest one that is complete.  GIVEN is the list of the numbers of
the events given."
  (state nil :type state :read-only t)
  (given '() :type list :read-only t)
  (next nil :type (or null state))
  ;; tables from numbers to propositions or :IN-WORK: of the events, of the predicates at the time
  ;; of STATE, and of those at the next one
  (events nil :type (or null hash-table))
  (predicates nil :type (or null hash-table))
  (next-predicates nil :type (or null hash-table))
  ;; (axiom . proposition), latest first, and what is to be added to the pending list
  (conditions '() :type list)
  (pending '() :type list)
  ;; whether a variable was opened
  (opened-p nil :type boolean))

(declaim (inline step-outline step-time))
(defun step-outline (step)
  (state-outline (step-state step)))

(defun step-time (step)
  (state-time (step-state step)))

(defun require-condition (step axiom proposition)
  (unless (eq proposition t)
    (push (cons axiom proposition) (step-conditions step))))

(defun open-atom (step kind number time)
  "Return the variable for an atom that the theory leaves open."
  (setf (step-opened-p step) t)
  (fresh-variable (state-context (step-state step)) (step-outline step) kind number time))

(defun state-at (step time)
  "Return the state at TIME, not after the next state of STEP."
  (declare (type fixnum time))
  (let ((state (step-state step)))
    (if (> time (state-time state))
        (step-next step)
        (loop until (= time (state-time state))
              do (setf state (state-predecessor state))
              finally (return state)))))

;;; Definitions

(defun all-alternatives (outline kind number definition time)
  "Return the alternatives of an atom at TIME: those of DEFINITION, or NIL, and the dated ones,
without supports that begin before the first timepoint."
  (flet ((in-time (supports)
           (if (every (lambda (support)
                        (>= (+ time (support-first support)) (outline-first-time outline)))
                      supports)
               supports
               (remove-if (lambda (support)
                            (< (+ time (support-first support)) (outline-first-time outline)))
                          supports))))
    (let ((dated (dated-alternatives outline kind number time))
          (usual (and definition (mapcar #'in-time (definition-alternatives definition)))))
      (cond ((and usual dated) (mapcar #'append usual dated))
            ;; without any support it is false
            (t (or usual dated (list '())))))))

(defun alternatives-formula (alternatives time)
  "Return the ground formula, with timepoints, of the ALTERNATIVES of an atom at TIME."
  (fold :and (loop for supports in alternatives
                   collect (fold :or (loop for support in supports
                                           collect (shift-formula (support-formula support)
                                                                  time))))))

(defun alternatives-ahead-p (outline alternatives time now)
  "Return true if the ALTERNATIVES of an atom at TIME cannot be evaluated when the events up to NOW
are known."
  (loop for supports in alternatives
          thereis (loop for support in supports
                        for formula = (support-formula support)
                          thereis (or (support-ahead-p support)
                                      (and (> time now)
                                           (depends-on-events-p formula
                                                                (outline-predicates outline)))))))

(defun alternatives-value (step alternatives time)
  (z3:conjunction
   (loop for supports in alternatives
         collect (let ((terms '()))
                   (dolist (support supports (z3:disjunction terms))
                     (let ((value (evaluate step (support-formula support) time)))
                       (cond ((eq value t) (return t))
                             (value (push value terms)))))))))

(defun leave-pending (step kind number time alternatives)
  "Return a variable for an atom whose definition looks ahead; that they are equivalent is
pending."
  (let ((formula (fold-iff (list kind number time) (alternatives-formula alternatives time))))
    (push (list* (max (formula-end (step-outline step) formula)
                      (+ time (loop for supports in alternatives
                                    maximize (reduce #'max supports :key #'support-last
                                                                    :initial-value 0))))
                 nil formula)
          (step-pending step))
    (open-atom step kind number time)))

(defun resolve (step table kind number time definition)
  "Return the value of an atom at TIME by DEFINITION, or NIL if it has dated supports only, and
enter it into TABLE."
  (multiple-value-bind (value known) (gethash number table)
    (cond ((eq value :in-work)
           (setf (gethash number table) (open-atom step kind number time)))
          (known value)
          (t
           (let ((alternatives (all-alternatives (step-outline step) kind number definition time)))
             (if (alternatives-ahead-p (step-outline step) alternatives time (step-time step))
                 (setf (gethash number table)
                       (leave-pending step kind number time alternatives))
                 (resolve-now step table number time alternatives)))))))

(defun resolve-now (step table number time alternatives)
  (setf (gethash number table) :in-work)
  (let* ((value (alternatives-value step alternatives time))
         (meanwhile (gethash number table)))
    (cond ((eq meanwhile :in-work) (setf (gethash number table) value))
          (t (require-condition step nil (z3:equivalence meanwhile value))
             meanwhile))))

;;; Atoms

(defun step-event (step number)
  "Return the proposition that the event NUMBER happens in STEP."
  (if (member number (step-given step))
      t
      (let* ((outline (step-outline step))
             (definition (gethash number (outline-events outline))))
        (if (or definition (dated-alternatives outline :event number (step-time step)))
            (resolve step
                     (or (step-events step) (setf (step-events step) (make-hash-table)))
                     :event number (step-time step) definition)
            nil))))

(defun event-at (step number time)
  (if (= time (step-time step))
      (step-event step number)
      (cdr (assoc number (state-events (state-at step (1+ time)))))))

(defun predicate-at (step number time)
  (let* ((outline (step-outline step))
         (definition (gethash number (outline-predicates outline)))
         (now (step-time step)))
    (cond ((and (null definition)
                (null (predicate-labels (outline-ground outline) number)))
           (open-atom step :predicate number time))
          ((< time now)
           (let ((table (state-predicates (state-at step (1+ time)))))
             (and table (values (gethash number table)))))
          ((= time now)
           (resolve step
                    (or (step-predicates step) (setf (step-predicates step) (make-hash-table)))
                    :predicate number time definition))
          (t (resolve step
                      (or (step-next-predicates step)
                          (setf (step-next-predicates step) (make-hash-table)))
                      :predicate number time definition)))))

(defun static-value (step number)
  (let ((statics (state-statics (step-state step))))
    (cond ((< number (length statics)) (svref statics number))
          ;; no axiom mentions it
          ((completion-labels (ground-theory-theory (outline-ground (step-outline step)))
                              (first (aref (atom-table-atoms
                                            (ground-theory-statics
                                             (outline-ground (step-outline step))))
                                           number)))
           nil)
          (t (open-atom step :static number nil)))))

;;; Formulas

(defun evaluate (step formula base)
  "Return the proposition of the ground FORMULA, whose distances are from the timepoint BASE."
  (declare (type fixnum base))
  (if (atom formula)
      formula
      (ecase (first formula)
        (:fluent (let* ((time (+ base (the fixnum (third formula))))
                        (state (step-state step)))
                   (svref (state-values (if (= time (the fixnum (state-time state)))
                                            state
                                            (state-at step time)))
                          (second formula))))
        (:event (event-at step (second formula) (+ base (the fixnum (third formula)))))
        (:not (z3:negation (evaluate step (second formula) base)))
        (:and (let ((terms '()))
                (dolist (part (rest formula) (z3:conjunction (nreverse terms)))
                  (let ((value (evaluate step part base)))
                    (cond ((eq value t))
                          ((null value) (return nil))
                          (t (push value terms)))))))
        (:or (let ((terms '()))
               (dolist (part (rest formula) (z3:disjunction (nreverse terms)))
                 (let ((value (evaluate step part base)))
                   (cond ((null value))
                         ((eq value t) (return t))
                         (t (push value terms)))))))
        (:iff (z3:equivalence (evaluate step (second formula) base)
                              (evaluate step (third formula) base)))
        (:predicate (predicate-at step (second formula) (+ base (the fixnum (third formula)))))
        (:released (svref (state-released (state-at step (+ base (the fixnum (third formula)))))
                          (second formula)))
        (:static (static-value step (second formula)))
        (:compare (evaluate-comparison step formula base)))))

(defun holds (formula states &optional event)
  "Return the proposition that the ground FORMULA is true in the list STATES, which follow each
other: the states at ?time, ?time + 1, ....  EVENT is what happens after the last of them: the
number of an event, NIL for none, or a list of numbers; events before are known to the states.
Signals UNDETERMINED."
  (evaluate (make-step :state (first (last states)) :given (if (listp event) event (list event)))
            formula (state-time (first states))))
