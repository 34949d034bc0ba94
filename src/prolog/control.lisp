;;;; Built-in predicates that prove other goals: conjunction, cut, negation, conditionals, and those
;;;; that collect or count solutions.
;;;;
;;;; A cut in a goal that is an argument of AND or OR or a branch of -> belongs to the fact around;
;;;; in all other arguments it is local.

(in-package #:discrepancy-finder.prolog)

(defun go-on (proof goals barrier next)
  "Prove the terms GOALS before NEXT."
  (setf (proof-frame proof) (if goals (make-frame goals nil barrier next) next))
  t)

(defun then (function next)
  "Return the frame in which FUNCTION is called with the proof, as a goal, before NEXT."
  (make-frame (list (lambda (proof next)
                      (when (funcall function proof)
                        (setf (proof-frame proof) next)
                        t)))
              nil nil next))

(defun commit-to (choices)
  "Return a function that gives up all choices of its argument made after CHOICES, and succeeds."
  (lambda (proof) (setf (proof-choices proof) choices) t))

(define-test true (proof) ()
  "True."
  t)

(define-test fail (proof) ()
  "False."
  nil)

(define-control and (proof barrier next) (&rest goals)
  "All goals are true."
  (go-on proof goals barrier next))

(define-control or (proof barrier next) (&rest goals)
  "One of the goals is true; they are tried in their order."
  (when goals
    (when (rest goals)
      (push-choice proof (make-frame (list (cons 'or (rest goals))) nil barrier next)))
    (go-on proof (list (first goals)) barrier next)))

(define-control cut (proof barrier next) ()
  "True; gives up all choices made since the goal of this fact was called: those in goals before the
cut and other facts of the predicate.  In a query it gives up all other solutions."
  (setf (proof-choices proof) barrier
        (proof-frame proof) next)
  t)

(define-control call (proof barrier next) (goal &rest arguments)
  "The goal with the arguments added at its end is true."
  (let* ((target (deref goal))
         (longer (cond ((null arguments) target)
                       ((consp target) (append (list (car target)) (proper-arguments target)
                                               arguments))
                       (t (cons target arguments)))))
    (prove-goal proof longer (proof-choices proof) next)))

(defun prove-not (proof goals next)
  (let ((before (proof-choices proof)))
    (push-choice proof next)
    (go-on proof goals (proof-choices proof)
           (then (lambda (proof) (setf (proof-choices proof) before) nil) nil))))

(define-control not (proof barrier next) (&rest goals)
  "The goals cannot all be true.  No variable is bound by that."
  (prove-not proof goals next))

(define-control forall (proof barrier next) (condition goal)
  "The goal is true for each solution of the condition.  No variable is bound by that."
  (prove-not proof (list condition (list 'not goal)) next))

(define-control once (proof barrier next) (&rest goals)
  "All goals are true; gives up all solutions but the first."
  (let ((before (proof-choices proof)))
    (go-on proof goals before (then (commit-to before) next))))

(define-control -> (proof barrier next) (condition goal &optional (else '(fail)))
  "If the condition is true, the goal for its first solution; if not, the other goal, without which
it is false."
  (let ((before (proof-choices proof)))
    (push-choice proof (make-frame (list else) nil barrier next))
    (go-on proof (list condition) (proof-choices proof)
           (then (commit-to before) (make-frame (list goal) nil barrier next)))))

(define-control *-> (proof barrier next) (condition goal &optional (else '(fail)))
  "If the condition is true, the goal for each of its solutions; if not, the other goal, without
which it is false."
  (let ((found nil))
    (push-choice proof (then (lambda (proof) (declare (ignore proof)) (not found))
                             (make-frame (list else) nil barrier next)))
    (go-on proof (list condition) (proof-choices proof)
           (then (lambda (proof) (declare (ignore proof)) (setf found t))
                 (make-frame (list goal) nil barrier next)))))

(define-control every (proof barrier next) (goals &optional (list nil predicate-p))
  "With one argument, all goals of the list are true; with two, (predicate* element) is true for all
elements of the list, the first argument being a predicate or a goal to which CALL adds the
element."
  (flet ((elements (list)
           (loop for tail = (deref list) then (deref (cdr tail))
                 while (consp tail) collect (car tail))))
    (go-on proof
           (if predicate-p
               (loop for element in (elements list) collect (list 'call goals element))
               (loop for goal in (elements goals) collect (list 'call goal)))
           (proof-choices proof) next)))

(define-control take (proof barrier next) (number goal)
  "The goal is true; gives up its solutions after the first NUMBER ones."
  (let ((left (deref number))
        (before (proof-choices proof)))
    (unless (integerp left)
      (malformed (list 'take number goal) "the number of solutions is no integer"))
    (when (plusp left)
      (go-on proof (list goal) before
             (then (lambda (proof)
                     (when (zerop (decf left))
                       (setf (proof-choices proof) before))
                     t)
                   next)))))

(defun collect-solutions (proof template goal function next)
  "Collect a copy of TEMPLATE for each solution of GOAL, then call FUNCTION with the list; it
returns whether to go on to NEXT."
  (let ((found '()))
    (push-choice proof (then (lambda (proof)
                               (declare (ignore proof))
                               (funcall function (reverse found)))
                             next))
    (go-on proof (list goal) (proof-choices proof)
           (then (lambda (proof)
                   (declare (ignore proof))
                   (push (copy-term template) found)
                   nil)
                 nil))))

(define-control findall (proof barrier next) (template goal list)
  "The list has the values of the template for all solutions of the goal, in their order; it may be
empty.  No variable of template and goal is bound by that."
  (collect-solutions proof template goal
                     (lambda (found) (unify-terms proof list found))
                     next))

(define-control bagof (proof barrier next) (template goal list)
  "As FINDALL, but false if there is no solution."
  (collect-solutions proof template goal
                     (lambda (found) (and found (unify-terms proof list found)))
                     next))

(define-control setof (proof barrier next) (template goal list)
  "As BAGOF, but of values that are EQUAL the list has only the first."
  (collect-solutions proof template goal
                     (lambda (found)
                       (and found
                            (unify-terms proof list
                                         (remove-duplicates found :test #'equal :from-end t))))
                     next))

(alias-predicate 'set-of 'setof)

(define-control filter-bindings (proof barrier next) (variables &rest goals)
  "All goals are true; of their variables only those in the list of variables are bound by that."
  (let ((copy (copy-term (cons variables goals))))
    (go-on proof (rest copy) (proof-choices proof)
           (then (lambda (proof) (unify-terms proof variables (first copy))) next))))

(define-control generate-values (proof barrier next) (generator value)
  "The value is one of those that the generator makes, each when it is asked for: a lazy list, or a
function without parameters that returns the next value at each call and NIL at the end."
  (let ((source (deref generator)))
    (labels ((values-of (function)
               (let ((value (funcall function)))
                 (if value (lazy-cons value (values-of function)) '()))))
      (try-elements proof value (if (functionp source) (values-of source) source) next))))
