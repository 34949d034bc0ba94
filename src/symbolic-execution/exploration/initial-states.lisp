;;;; The initial state of all paths.
;;;;
;;;; Its fluents are variables, but for those that the theory fixes: with constants in their place
;;;; most of what a plan asks needs no Z3.  Entry point: INITIAL-STATE-OF.

(in-package #:discrepancy-finder.symbolic-execution)

(defun fixed-values (oracle propositions)
  "Return a list of the truth values of PROPOSITIONS, :OPEN for those that the solver of ORACLE,
whose last check has found a model, does not fix."
  (let ((model (values-in-model oracle propositions)))
    ;; Each model shows that those are open in which it differs from the first.
    (loop with open = (make-list (length propositions) :initial-element nil)
          for proposition in propositions
          for value in model
          for cell on open
          unless (car cell)
            do (when (and (z3:term-p proposition)
                          (not (eq (ask oracle (list (if value
                                                         (z3:negation proposition)
                                                         proposition)))
                                   :unsat)))
                 (setf (car cell) t))
          finally (return (loop for value in model
                                for is-open in open
                                collect (if is-open :open value))))))

(defun initial-state-of (oracle ground)
  "Return a symbolic initial state of the theory GROUND, whose conditions are assumed, and true if
there is such a state at all."
  (let ((state (ec:symbolic-state ground (oracle-context oracle))))
    (loop for (nil . proposition) in (ec:initial-conditions state)
          do (oracle-assume oracle proposition))
    (ecase (ask oracle)
      (:unsat (values state nil))
      (:unknown (values state t))
      (:sat
       (let ((values (make-hash-table :test 'equal)))
         (loop for atom across (ec:ground-theory-fluents ground)
               for variable across (ec:state-values state)
               for value in (fixed-values oracle (coerce (ec:state-values state) 'list))
               do (setf (gethash atom values) (if (eq value :open) variable value)))
         (values (ec:concrete-state ground (lambda (atom) (gethash atom values))
                                    :context (oracle-context oracle))
                 t))))))
