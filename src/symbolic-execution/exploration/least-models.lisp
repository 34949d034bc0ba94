;;;; Least models: the initial state that stands for all those of a path.
;;;;
;;;; Of the models of what the solver holds the least is taken: false before true in a fixed order,
;;;; of numbers the one next to 0.  So it depends on the path alone and not on what Z3 was asked
;;;; before.  All of this is done in a scope of the solver that is closed afterwards.  A model that
;;;; Z3 gives saves most questions: what it makes false need not be asked for.

(in-package #:discrepancy-finder.symbolic-execution)

(defun values-in-model (oracle propositions)
  "Return the list of the values of PROPOSITIONS in the model of the last check."
  (let ((solver (oracle-solver oracle)))
    (loop for proposition in propositions
          collect (if (z3:term-p proposition) (z3:model-value solver proposition) proposition))))

(defun assert-all (oracle propositions)
  (dolist (proposition propositions)
    (z3:solver-assert (oracle-solver oracle) proposition)))

(defstruct (assignment (:constructor make-assignment (oracle)) (:copier nil))
  "Values of terms: those that were SETTLED, and others by the model of a check that is made when it
is needed."
  (oracle nil :type oracle :read-only t)
  (settled (make-hash-table :test 'eq) :type hash-table :read-only t)
  (model-p nil :type boolean))

(defun settle (assignment term value)
  (setf (gethash term (assignment-settled assignment)) value))

(defun term-value (assignment term)
  "Return the value of TERM, or TERM if it is a constant.  Throws to ASSIGNMENT if Z3 finds no
model."
  (if (z3:term-p term)
      (multiple-value-bind (value known) (gethash term (assignment-settled assignment))
        (if known
            value
            (let ((oracle (assignment-oracle assignment)))
              (unless (assignment-model-p assignment)
                (unless (eq (ask oracle) :sat)
                  (throw assignment nil))
                (setf (assignment-model-p assignment) t))
              (settle assignment term (z3:model-value (oracle-solver oracle) term)))))
      term))

(defun fix-booleans (assignment propositions)
  "Settle PROPOSITIONS: they get the least list of truth values that the solver allows, and these
are asserted.  Throws to ASSIGNMENT if Z3 finds no model."
  (let ((oracle (assignment-oracle assignment)))
    (unless (eq (ask oracle) :sat)
      (throw assignment nil))
    (let ((values (values-in-model oracle propositions)) (pending '()))
      (loop while propositions
            do (let ((proposition (pop propositions)) (value (pop values)))
                 (when (z3:term-p proposition)
                   (let ((negation (z3:negation proposition)))
                     (when value
                       (assert-all oracle (shiftf pending '()))
                       (when (eq (ask oracle (list negation)) :sat)
                         (setf value nil
                               values (values-in-model oracle propositions))))
                     (settle assignment proposition value)
                     (push (if value proposition negation) pending)))))
      (assert-all oracle pending))))

(defun answer-to (oracle proposition)
  "Return whether PROPOSITION is allowed: :SAT, :UNSAT or :UNKNOWN."
  (if proposition
      (ask oracle (if (eq proposition t) '() (list proposition)))
      :unsat))

(defun allowed-p (oracle proposition)
  (eq (answer-to oracle proposition) :sat))

(defun least-bound (oracle between)
  "Return the least positive integer N for which (BETWEEN N), a proposition that grows weaker with
N, is allowed, or NIL if none up to 2^64 is, or Z3 cannot tell."
  (let ((high (loop for power from 0 to 64
                    do (case (answer-to oracle (funcall between (expt 2 power)))
                         (:sat (return (expt 2 power)))
                         (:unknown (return nil))))))
    (when high
      (let ((low (floor high 2)))       ; not allowed, or 0
        (loop while (> (- high low) 1)
              do (let ((middle (floor (+ low high) 2)))
                   (if (allowed-p oracle (funcall between middle))
                       (setf high middle)
                       (setf low middle))))
        high))))

(defun least-number (oracle term)
  "Return the number next to 0 that TERM can have: 0, else the least positive integer, else the
greatest negative one, else what Z3 finds first; and assert it.  Return NIL if none is found."
  (flet ((possibly (value)
           (and value (allowed-p oracle (z3:equals term value)) value)))
    (let ((value (or (possibly 0)
                     (possibly (least-bound oracle (lambda (n)
                                                     (z3:conjunction
                                                      (list (z3:less 0 term)
                                                            (z3:less-or-equal term n))))))
                     (let ((n (least-bound oracle (lambda (n)
                                                    (z3:conjunction
                                                     (list (z3:less term 0)
                                                           (z3:less-or-equal (- n) term)))))))
                       (possibly (and n (- n))))
                     (and (eq (ask oracle) :sat)
                          (z3:model-value (oracle-solver oracle) term)))))
      (when (rationalp value)
        (z3:solver-assert (oracle-solver oracle) (z3:equals term value))
        value))))

(defun proposition-p (term)
  (or (typep term 'boolean)
      (and (z3:term-p term) (eq (z3:sort-kind (z3:term-sort term)) :boolean))))

(defun fix-terms (assignment terms)
  "Settle TERMS, propositions and numbers: they get the least values, one after the other, that the
solver allows.  Throws to ASSIGNMENT if Z3 finds none."
  (loop while terms
        do (if (proposition-p (first terms))
               (let ((end (position-if-not #'proposition-p terms)))
                 (fix-booleans assignment (subseq terms 0 end))
                 (setf terms (and end (nthcdr end terms))))
               (let ((term (pop terms)))
                 (when (z3:term-p term)
                   (settle assignment term (or (least-number (assignment-oracle assignment) term)
                                               (throw assignment nil))))))))

(defun state-terms (state)
  "Return the propositions and numbers of STATE."
  (append (ec:state-propositions state) (coerce (ec:state-numbers state) 'list)))

(defun fix-states (assignment terms states)
  "Settle TERMS and then the propositions and numbers of STATES, which follow each other, the
earlier state first."
  (fix-terms assignment
             (append terms
                     ;; Where the theory leaves nothing open the initial state settles the rest.
                     (if (every #'ec:state-determined-p states)
                         (state-terms (first states))
                         (mapcan #'state-terms states)))))

(defun concrete-states-of (assignment states)
  "Return STATES, which follow each other, with the values of ASSIGNMENT."
  (let ((concrete '()))
    (dolist (state states (nreverse concrete))
      (push (ec:state-in-model state (lambda (term) (term-value assignment term))
                               (first concrete))
            concrete))))

(defun least-states (oracle states)
  "Return STATES, which follow each other, with truth values for their propositions: the least that
the solver of ORACLE allows, the earlier state first; NIL if it finds no model."
  (let ((assignment (make-assignment oracle)))
    (catch assignment
      (fix-states assignment '() states)
      (concrete-states-of assignment states))))
