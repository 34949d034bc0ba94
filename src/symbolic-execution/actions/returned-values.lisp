;;;; What perform returns: questions about the state after the action.
;;;;
;;;; The form of :RETURNS is interpreted with a function that answers its (value-of ...) and
;;;; (truth-of ...).  The answers are propositions of the state, as symbolic values.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *interpreted-lambdas* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The interpreted function of each lambda expression.")

(defun interpreted-lambda (form)
  "Return the interpreted function of the lambda expression FORM."
  (or (gethash form *interpreted-lambdas*)
      (setf (gethash form *interpreted-lambdas*) (evaluate `(function ,form)))))

(defun question-formula (formula designator)
  "Return FORMULA with the values of its computed terms, (:computed value form)."
  (cond ((atom formula) formula)
        ((eq (first formula) :computed)
         (term-of (second formula) (third formula) designator))
        (t (loop for part in formula collect (question-formula part designator)))))

(defun truth-in (domain state formula)
  "Return whether FORMULA, in which fluents stand for themselves, holds in STATE."
  (let ((formula (ground-state-formula domain formula (constantly "a truth-of"))))
    (note-looks (ec:formula-footprint formula))
    (symbolic-boolean (ec:holds formula (list state)))))

(defun value-in (domain state fluent variable)
  "Return the element in the place of VARIABLE for which FLUENT holds in STATE, the first one if
there are several, NIL if there is none."
  (let ((rest t)
        (ground (action-theory-ground domain))
        (choices '()))
    (flet ((add (value proposition)
             (when proposition (push (cons value proposition) choices))))
      (dolist (element (ec:sort-elements (action-theory-theory domain)
                                         (variable-sort-name variable)))
        (let* ((number (ec:find-fluent ground (substitute element variable fluent)))
               (holds (svref (ec:state-values state) number)))
          (note-looks (ash 1 number))
          (add element (z3:conjunction (list rest holds)))
          (setf rest (z3:conjunction (list rest (z3:negation holds))))))
      (add nil rest))
    (symbolic-element (nreverse choices))))

(defun answer (domain designator state kind formula &optional variable)
  "Answer the question of KIND in a :RETURNS."
  (let ((formula (question-formula formula designator)))
    (ecase kind
      (:truth-of (truth-in domain state formula))
      (:value-of (value-in domain state formula variable)))))

(defun result-function (domain binding designator)
  "Return a function of the state after the action that returns the value of perform, or NIL."
  (let ((properties (loop for key in (action-binding-properties binding)
                          collect (plan:desig-prop-value designator key)))
        (form (action-binding-result binding)))
    (and form
         (lambda (state)
           (apply (the function (interpreted-lambda form))
                  (lambda (&rest question) (apply #'answer domain designator state question))
                  properties)))))

(defun outcome-value (outcome state)
  "Return what perform returns after OUTCOME, in STATE."
  (and (outcome-result outcome)
       (funcall (outcome-result outcome) state)))
