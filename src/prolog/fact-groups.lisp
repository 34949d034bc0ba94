;;;; DEF-FACT-GROUP and <-: how facts are written.

(in-package #:discrepancy-finder.prolog)

(defun check-goal (goal group form)
  (unless (or (symbolp goal) (consp goal))
    (error 'malformed-fact :group group :form form
                           :reason (format nil "~a is no goal" (goal-text goal)))))

(defun check-fact (form group)
  "Return (head goal*) for FORM, a fact of GROUP.  Signals MALFORMED-FACT."
  (flet ((problem (control &rest arguments)
           (error 'malformed-fact :group group :form form
                                  :reason (apply #'format nil control arguments))))
    (unless (and (consp form) (eq (first form) '<-))
      (problem "a fact is (<- (predicate argument*) goal*)"))
    (unless (null (cdr (last form)))
      (problem "it is a dotted list"))
    (unless (rest form)
      (problem "it has no head"))
    (let ((head (second form)))
      (unless (consp head)
        (problem "its head ~a is not (predicate argument*)" (goal-text head)))
      (unless (and (symbolp (first head)) (first head) (not (is-var (first head))))
        (problem "its predicate ~a is no name" (goal-text (first head)))))
    (dolist (goal (cddr form))
      (check-goal goal group form))
    (rest form)))

(defmacro def-fact-group (name (&rest extendable-predicates) &body facts)
  "Define the fact group NAME.  FACTS are (<- (predicate argument*) goal*): the head is true if all
the goals are.  The facts take the place of those that the group had.  Facts of a predicate are
tried in the order of the definitions of the groups and of the facts in them.  EXTENDABLE-PREDICATES
are the names of predicates that other groups may have facts of, too; for others a second group with
facts is warned about by PREDICATE-NOT-EXTENDABLE.  Returns NAME.  Signals MALFORMED-FACT when it
is expanded."
  (unless (and (symbolp name) name)
    (error 'malformed-fact :group nil :form name :reason "the name of a fact group is a symbol"))
  (dolist (predicate extendable-predicates)
    (unless (and (symbolp predicate) predicate (not (is-var predicate)))
      (error 'malformed-fact :group name :form predicate
                             :reason "it is no name of an extendable predicate")))
  `(define-fact-group ',name ',extendable-predicates
     ',(loop for fact in facts collect (check-fact fact name))))

(defmacro <- (&whole form head &body goals)
  "Inside DEF-FACT-GROUP, state that HEAD is true if GOALS are.  Anywhere else this signals
MALFORMED-FACT."
  (declare (ignore head goals))
  (error 'malformed-fact :group nil :form form :reason "facts stand in def-fact-group"))
