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

(defun least-values (oracle propositions)
  "Return the least list of truth values of PROPOSITIONS that the solver of ORACLE allows, and add
them to its assertions; :NONE if it finds no model."
  (unless (eq (ask oracle) :sat)
    (return-from least-values :none))
  (let ((values (values-in-model oracle propositions)) (settled '()) (pending '()))
    (loop while propositions
          do (let ((proposition (pop propositions)) (value (pop values)))
               (when (z3:term-p proposition)
                 (let ((negation (z3:negation proposition)))
                   (when value
                     (assert-all oracle (shiftf pending '()))
                     (when (eq (ask oracle (list negation)) :sat)
                       (setf value nil
                             values (values-in-model oracle propositions))))
                   (push (if value proposition negation) pending)))
               (push value settled)))
    (assert-all oracle pending)
    (nreverse settled)))

(defun allowed-p (oracle proposition)
  (and proposition
       (eq (ask oracle (if (eq proposition t) '() (list proposition))) :sat)))

(defun least-bound (oracle between)
  "Return the least positive integer N for which (BETWEEN N), a proposition that grows weaker with
N, is allowed, or NIL if none up to 2^64 is."
  (let ((high (loop for power from 0 to 64
                    when (allowed-p oracle (funcall between (expt 2 power)))
                      return (expt 2 power))))
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

(defun fix-numbers (oracle numbers)
  "Add to the assertions of ORACLE's solver values for the terms among NUMBERS, one after the
other."
  (dolist (number numbers)
    (when (z3:term-p number)
      (least-number oracle number))))

(defun least-states (oracle states)
  "Return STATES, which follow each other, with truth values for their propositions: the least that
the solver of ORACLE allows, the earlier state first; NIL if it finds no model."
  (let ((concrete '()))
    (dolist (state states)
      (when (eq (least-values oracle (ec:state-propositions state)) :none)
        (return-from least-states nil))
      (fix-numbers oracle (coerce (ec:state-numbers state) 'list))
      ;; Where the theory leaves nothing open the initial state has settled the rest.
      (when (every #'ec:state-determined-p states)
        (return)))
    (when (eq (ask oracle) :sat)
      (dolist (state states (nreverse concrete))
        (push (ec:state-in-model state
                                 (lambda (term) (z3:model-value (oracle-solver oracle) term))
                                 (first concrete))
              concrete)))))
