;;;; Action bindings: what the designators of one kind mean in a theory.
;;;;
;;;; A binding says which designators it is for, which event happens when the action succeeds, what
;;;; that requires, and which failures it may end in.  Entry points: REGISTER-ACTION,
;;;; FIND-ACTION-BINDING.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (action-binding (:copier nil))
  "Designators of CLASS (:motion or :action) and TYPE, the events (name argument*) and failure
classes that DESCRIBE-OUTCOMES, a function of an action theory and a designator, may mention."
  (class nil :type keyword :read-only t)
  (type nil :type keyword :read-only t)
  (events '() :type list :read-only t)
  (failures '() :type list :read-only t)
  (describe-outcomes #'identity :type function :read-only t))

(defmethod print-object ((binding action-binding) stream)
  (print-unreadable-object (binding stream :type t)
    (format stream "~(~a ~a~)" (action-binding-class binding) (action-binding-type binding))))

(defstruct (outcome (:copier nil))
  "One way in which an action can end: NAME is :SUCCESS or a failure class, EVENT the ground event
that happens (a list) or NIL, CONDITION the ground formula under which it is possible, VALUE what
perform returns."
  (name nil :type symbol :read-only t)
  (event nil :type list :read-only t)
  (condition t :type (or boolean list) :read-only t)
  (value nil :read-only t))

(setf (documentation 'outcome-name 'function)
      "Return the name of an outcome: :SUCCESS or a failure class."
      (documentation 'outcome-event 'function)
      "Return the ground event of an outcome, a list of keywords, or NIL."
      (documentation 'outcome-condition 'function)
      "Return the ground formula under which an outcome is possible.")

(defmethod print-object ((outcome outcome) stream)
  (print-unreadable-object (outcome stream :type t)
    (format stream "~(~a~)~@[ ~a~]" (outcome-name outcome)
            (and (outcome-event outcome) (ec:atom-text (outcome-event outcome))))))

(defun check-binding (domain binding)
  "Signal ACTION-PROBLEM if BINDING mentions an event that the theory of DOMAIN does not have, or a
failure that is none."
  (flet ((problem (control &rest arguments)
           (error 'action-problem :designator (format nil "The action binding ~(~a ~a~)"
                                                      (action-binding-class binding)
                                                      (action-binding-type binding))
                                  :reason (apply #'format nil control arguments))))
    (loop for (name . arguments) in (action-binding-events binding)
          for declaration = (assoc (ec:name-keyword name)
                                   (ec:theory-events (action-theory-theory domain)))
          do (unless declaration
               (problem "theory ~a has no event ~a"
                        (ec:name-text (ec:theory-name (action-theory-theory domain)))
                        (ec:name-text name)))
             (unless (= (length arguments) (length (rest declaration)))
               (problem "the event ~a takes ~d argument~:p, not ~d" (ec:name-text name)
                        (length (rest declaration)) (length arguments))))
    (dolist (failure (action-binding-failures binding))
      (unless (subtypep failure 'plan:plan-failure)
        (problem "~(~a~) is no plan failure" failure)))))

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
  (find-if (lambda (binding)
             (and (eq (action-binding-class binding) (plan:designator-class-keyword designator))
                  (eq (action-binding-type binding) (plan:desig-prop-value designator :type))))
           (action-theory-actions domain)))
