;;;; Action bindings: what the designators of one kind mean in a theory.
;;;;
;;;; A binding says which designators it is for, which event happens when the action succeeds, what
;;;; that requires, and which failures it may end in.  DEFINE-ACTION writes one.  Entry points:
;;;; REGISTER-ACTION, FIND-ACTION-BINDING.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (mention (:type list) (:copier nil))
  "What a clause of a binding mentions of the theory: KIND is :EVENT, :FORMULA, :FAILURE or
:ELEMENT, CLAUSE the clause as it was written, TEMPLATE an event, a formula, a failure class with
its initargs, or a fluent and a variable.  A term that is computed is (:computed form) in it.
POSITION is the clause's."
  (kind nil :type keyword :read-only t)
  (clause nil :read-only t)
  (template nil :read-only t)
  (position nil :read-only t))

(defstruct (action-binding (:copier nil))
  "Designators of CLASS (:motion or :action) and TYPE.  OUTCOMES are the names of the outcomes,
:SUCCESS first, MENTIONS what is to be checked by the theory.  DESCRIBE-OUTCOMES is a function of
an action theory and a designator.  RESULT is the lambda expression of the value of perform, see
RESULT-FORM, PROPERTIES the keys of its further arguments."
  (class nil :type keyword :read-only t)
  (type nil :type keyword :read-only t)
  (outcomes '(:success) :type list :read-only t)
  (mentions '() :type list :read-only t)
  (position nil :read-only t)
  (result nil :type list :read-only t)
  (properties '() :type list :read-only t)
  (describe-outcomes #'identity :type function :read-only t))

(setf (documentation 'action-binding-class 'function)
      "Return the class of the designators that an action binding is for: :MOTION or :ACTION."
      (documentation 'action-binding-type 'function)
      "Return the type of the designators that an action binding is for, a keyword.")

(defmethod print-object ((binding action-binding) stream)
  (print-unreadable-object (binding stream :type t)
    (write-string (binding-text binding) stream)))

(defun binding-text (binding)
  "Return class and type of the designators of BINDING as words."
  (format nil "~(~a~) ~a" (action-binding-class binding)
          (ec:name-text (action-binding-type binding))))

(defstruct (outcome (:copier nil))
  "One way in which an action can end: NAME is :SUCCESS or a failure class, EVENT the ground event
that happens (a list) or NIL, CONDITION the ground formula under which it is possible.  INITARGS
are those of the failure; RESULT is NIL or a function of the state after the action that returns
the value of perform.  NUMBER is its place among the outcomes of BINDING."
  (name nil :type symbol :read-only t)
  (event nil :type list :read-only t)
  (condition t :type (or boolean list) :read-only t)
  (initargs '() :type list :read-only t)
  (result nil :type (or null function) :read-only t)
  (binding nil :read-only t)
  (number 0 :type (integer 0) :read-only t))

(setf (documentation 'action-binding-class 'function)
      "Return the class of the designators of an action binding, :MOTION or :ACTION."
      (documentation 'action-binding-type 'function)
      "Return the type of the designators of an action binding, a keyword."
      (documentation 'make-outcome 'function)
      "Return a new OUTCOME; see the structure for the arguments."
      (documentation 'outcome-name 'function)
      "Return the name of an outcome: :SUCCESS or a failure class."
      (documentation 'outcome-event 'function)
      "Return the ground event of an outcome, a list of keywords, or NIL."
      (documentation 'outcome-condition 'function)
      "Return the ground formula under which an outcome is possible.")

(defmethod print-object ((outcome outcome) stream)
  (print-unreadable-object (outcome stream :type t)
    (format stream "~(~a~)~@[ ~a~]" (outcome-name outcome)
            (and (outcome-event outcome) (ec:atom-text (outcome-event outcome))))))

(defun register-action (domain-name binding)
  "Make BINDING an action binding of the domain named DOMAIN-NAME, in place of an older one for the
same designators.  Signals DOMAIN-NOT-FOUND and ACTION-PROBLEM."
  (let ((domain (find-action-theory domain-name)))
    (check-binding domain binding)
    (setf (action-theory-actions domain)
          (cons binding
                (remove-if (lambda (old)
                             (and (eq (action-binding-class old) (action-binding-class binding))
                                  (eq (action-binding-type old) (action-binding-type binding))))
                           (action-theory-actions domain))))
    binding))

(defun find-action-binding (domain designator)
  "Return the binding of DOMAIN for DESIGNATOR, or NIL.  Signals ACTION-PROBLEM if DESIGNATOR is no
designator."
  (unless (typep designator 'plan:designator)
    (error 'action-problem :designator designator :reason "it is no designator"))
  (let ((class (plan:designator-class-keyword designator))
        (type (decided (plan:desig-prop-value designator :type) "the type of a designator")))
    (find-if (lambda (binding)
               (and (eq (action-binding-class binding) class)
                    (eq (action-binding-type binding) type)))
             (action-theory-actions domain))))
