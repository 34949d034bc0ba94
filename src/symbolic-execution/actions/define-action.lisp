;;;; The DEFINE-ACTION form, which writes an action binding.
;;;;
;;;; Terms are compiled; symbolic values in the properties that a computed term uses are decided
;;;; before, and so is its value: an event is ground.  The form of :RETURNS is interpreted, so that
;;;; values in what perform returns stay symbolic.

(in-package #:discrepancy-finder.symbolic-execution)

(defun term-of (value form designator)
  "Return VALUE, the value of FORM in a DEFINE-ACTION, decided, if it can be an element of a sort."
  (let ((value (if (typep value '(or symbol rational))
                   value
                   (decided value (format nil "~(~s~) of an action" (plain-clause form))))))
    (if (or (and value (symbolp value)) (rationalp value))
        value
        (error 'action-problem
               :designator designator
               :reason (format nil "~(~a~) is ~:[~s, which is no element of the theory~;~
                                    in no region~]" form (null value) value)))))

(defun place-region (domain place &optional sort)
  "Return the region of DOMAIN, one of SORT if that is given, in which PLACE, a pose or a location
designator, lies, or NIL."
  (let ((pose (plan:designated-pose (decided place "the place of an action"))))
    (and pose (region-of-pose domain pose sort))))

(defun decided-form (form properties)
  "Return a form for FORM in which symbolic values in PROPERTIES are decided.  A property of a
designator can be read before."
  (let ((used (if (and (consp form)
                       (member (first form) '(plan:desig-prop-value region-of))
                       (every #'atom (rest form)))
                  '()
                  (variables-in form properties))))
    (if (and used (consp form))
        `(let ,(loop for property in used
                     collect `(,property (decided ,property "a property of an action")))
           ,form)
        form)))

(defun outcome-forms (clauses properties)
  "Return the forms of the outcomes of an action with CLAUSES, success first: lists of name, event,
condition, initargs."
  (let ((event (second (assoc :event clauses)))
        (requires (second (assoc :requires clauses))))
    (labels ((term-form (term)
               `(term-of ,(decided-form term properties) ',term designator))
             (template (form)
               (formula-form form properties #'term-form))
             (initargs-form (initargs)
               `(list ,@(loop for (key form) on initargs by #'cddr
                              append `(,key (decided ,form "a slot of a failure"))))))
      (cons
       `(list :success ,(template event) ,(if requires (template requires) t) '())
       (loop for (key name . options) in clauses
             when (eq key :failure)
               collect (destructuring-bind (&key (when nil whenp) event initargs) options
                         `(list ',name ,(and event (template event))
                                ,(cond (whenp (template when))
                                       (requires `(list :not ,(template requires)))
                                       (t nil))
                                ,(initargs-form initargs))))))))

(defun result-form (form properties)
  "Return the lambda expression, to be interpreted, of the value of perform: a function of one that
answers questions about the state after the action and of PROPERTIES."
  `(lambda (answer ,@properties)
     (declare (ignorable answer ,@properties))
     (macrolet ((value-of (fluent variable) (expand-value-of fluent variable ',properties))
                (truth-of (formula) (expand-truth-of formula ',properties)))
       ,form)))

(defun question-form (formula variable properties)
  (formula-form formula (question-properties formula variable properties)
                (lambda (term) `(list :computed ,term ',term))))

(defun expand-value-of (fluent variable properties)
  `(funcall answer :value-of ,(question-form fluent variable properties) ',variable))

(defun expand-truth-of (formula properties)
  `(funcall answer :truth-of ,(question-form formula nil properties)))

(defmacro define-action (&whole form (class type) properties &body clauses)
  "Say what the designators of CLASS (motion or action) and TYPE mean in a domain.  PROPERTIES are
variables for the designator's values of the keys of that name; a question mark in front is no part
of the key.  CLAUSES:
  (:domain NAME)                the domain this belongs to
  (:event (EVENT term*))        what happens on success
  (:requires formula)           when success is possible; fluents stand for themselves
  (:failure CLASS [:when formula] [:event (EVENT term*)] [:initargs (key form*)])
                                how it may fail, with what effects; :when defaults to the negation
                                of :requires, :initargs are those of the condition
  (:returns form)               the value of perform
A term that is a property or a list is evaluated; there, (region-of x) is the
region of a pose or of a location designator.  In :RETURNS, (value-of (FLUENT term*) ?x) is the
element of the sort of ?x for which the fluent holds in the state after the action, or NIL, and
(truth-of formula) whether a formula holds there: values that may be symbolic.  All other variables
?y in these are evaluated, too.  Signals
MALFORMED-PLAN-FORM for a clause of a wrong shape, ACTION-PROBLEM for one that means nothing in the
theory, and DOMAIN-NOT-FOUND."
  (check-clauses form class type properties clauses)
  (let ((returns (assoc :returns clauses)))
    `(register-action
      ',(second (assoc :domain clauses))
      (make-action-binding
       :class ,(ec:name-keyword class) :type ,(ec:name-keyword type)
       :outcomes '(:success ,@(loop for (key failure) in clauses
                                    when (eq key :failure) collect failure))
       :mentions ',(loop for clause in clauses
                         append (clause-mentions form clause properties))
       :position ,(source:form-position form)
       :result ',(and returns (result-form (second returns) properties))
       :properties ',(mapcar #'property-key properties)
       :describe-outcomes
       (lambda (domain designator)
         (declare (ignorable domain designator))
         (let ,(loop for property in properties
                     collect `(,property (plan:desig-prop-value designator
                                                                ,(property-key property))))
           (declare (ignorable ,@properties))
           (flet ((region-of (place &optional sort) (place-region domain place sort)))
             (declare (ignorable #'region-of))
             (list ,@(outcome-forms clauses properties)))))))))

(defun region-of (place &optional sort)
  "Inside DEFINE-ACTION, return the element of the domain's theory, one of SORT (a symbol) if that
is given, that stands for PLACE, a pose or a location designator, or NIL if none does.  Anywhere
else this signals MALFORMED-PLAN-FORM."
  (declare (ignore sort))
  (error 'plan:malformed-plan-form :form `(region-of ,place)
                                   :expected "an enclosing define-action"))

(defmacro value-of (&whole form fluent variable)
  "Inside the :RETURNS of DEFINE-ACTION, return the element of the sort of VARIABLE for which FLUENT
holds after the action, possibly symbolic, or NIL if it holds for none.  Anywhere else this signals
MALFORMED-PLAN-FORM."
  (declare (ignore fluent variable))
  (error 'plan:malformed-plan-form :form form :expected "an enclosing define-action"))

(defmacro truth-of (&whole form formula)
  "Inside the :RETURNS of DEFINE-ACTION, return whether FORMULA, in which fluents stand for
themselves, holds after the action: T, NIL or a symbolic boolean.  Anywhere else this signals
MALFORMED-PLAN-FORM."
  (declare (ignore formula))
  (error 'plan:malformed-plan-form :form form :expected "an enclosing define-action"))
