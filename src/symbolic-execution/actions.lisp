;;;; Action bindings: what the designators of a plan mean in a theory.
;;;;
;;;; An ACTION-THEORY is a theory with action bindings.  A binding, written with DEFINE-ACTION, says
;;;; which designators it is for, which event happens when the action succeeds, what that requires,
;;;; and which failures it may end in.  ACTION-OUTCOMES applies it to a designator.  Symbolic
;;;; execution asks which outcomes the theory allows; the judgement of a projected run asks whether
;;;; it allows the outcome that was seen.

(in-package #:discrepancy-finder.symbolic-execution)

(defclass action-theory ()
  ((name :initarg :name :reader action-theory-name :type keyword
         :documentation "The name, a keyword.")
   (theory :initarg :theory :reader action-theory-theory :type ec:theory
           :documentation "The THEORY.")
   (ground :reader action-theory-ground :type ec:ground-theory
           :documentation "The same, ground.")
   (actions :initarg :actions :initform '() :accessor action-theory-actions
            :documentation "List of action bindings, the youngest first."))
  (:documentation "A theory and what designators mean in it."))

(defmethod initialize-instance :after ((domain action-theory) &key theory)
  (setf (slot-value domain 'ground) (ec:ground theory)))

(defmethod print-object ((domain action-theory) stream)
  (print-unreadable-object (domain stream :type t)
    (format stream "~a: ~d action~:p" (ec:name-text (action-theory-name domain))
            (length (action-theory-actions domain)))))

(defgeneric region-of-pose (action-theory pose)
  (:documentation "Return the element of a sort of ACTION-THEORY (a keyword) that stands for the
place of POSE, or NIL if none does."))

(defvar *domains* (make-hash-table :test 'eq)
  "The action theory of each name, a keyword.")

(defun find-action-theory (name)
  "Return the ACTION-THEORY (the domain) named by the symbol NAME.  Signals DOMAIN-NOT-FOUND."
  (or (gethash (ec:name-keyword name) *domains*)
      (error 'domain-not-found :name name)))

;;; Registry

(defun register-action-theory (domain)
  "Make DOMAIN the ACTION-THEORY of its name, and return it."
  (setf (gethash (action-theory-name domain) *domains*) domain))

(defun all-action-theories ()
  "Return the list of all registered ACTION-THEORYs."
  (alexandria:hash-table-values *domains*))

;;; Bindings

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

;;; The DEFINE-ACTION form.  A formula or event in it is a template: a list in the place of a term,
;;; or the name of a property, is a Lisp form to be evaluated; all else stands for itself.

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun term-template (term properties)
    (cond ((or (consp term) (member term properties)) `(term-of ,term ',term designator))
          (t `',term)))

  (defun formula-template (form properties)
    "Return a form that evaluates to the state formula written as FORM."
    (if (atom form)
        `',form
        (let ((operator (ec:name-keyword (first form))))
          (case operator
            ((:and :or :not :implies :iff)
             `(list ',(first form)
                    ,@(loop for part in (rest form) collect (formula-template part properties))))
            ((:forall :exists)
             `(list ',(first form) ',(second form)
                    ,(formula-template (third form) properties)))
            (t `(list ',(first form)
                      ,@(loop for term in (rest form)
                              collect (term-template term properties))))))))

  (defun check-clauses (form clauses)
    "Signal MALFORMED-PLAN-FORM unless CLAUSES of the DEFINE-ACTION FORM are what they should be."
    (flet ((complain (expected)
             (error 'plan:malformed-plan-form :form form :expected expected)))
      (dolist (clause clauses)
        (unless (and (consp clause)
                     (member (first clause) '(:domain :event :requires :failure :returns)))
          (complain "one of :domain, :event, :requires, :failure, :returns in each clause"))
        (unless (if (eq (first clause) :failure)
                    (and (symbolp (second clause)) (second clause) (evenp (length (cddr clause))))
                    (= (length clause) 2))
          (complain (format nil "one thing after ~(~s~)" (first clause)))))
      (dolist (key '(:domain :event))
        (unless (= 1 (count key clauses :key #'first))
          (complain (format nil "exactly one clause (~(~s~) ...)" key))))
      (dolist (event (clause-events clauses))
        (unless (and (consp event) (symbolp (first event)))
          (complain "an event such as (name term*)")))))

  (defun clause-events (clauses)
    "Return the events that CLAUSES of a DEFINE-ACTION mention."
    (loop for (key . arguments) in clauses
          for event = (case key
                        (:event (first arguments))
                        (:failure (getf (rest arguments) :event)))
          when event collect event)))

(defun term-of (value form designator)
  "Return VALUE, the value of FORM in a DEFINE-ACTION, if it can be an element of a sort."
  (if (and value (symbolp value))
      value
      (error 'action-problem
             :designator designator
             :reason (format nil "~(~a~) is ~:[~s, which is no element of the theory~;~
                                  in no region~]" form (null value) value))))

(defun place-region (domain place)
  "Return the region of DOMAIN in which PLACE, a pose or a location designator, lies, or NIL."
  (let ((pose (plan:designated-pose place)))
    (and pose (region-of-pose domain pose))))

(defmacro define-action (&whole form (class type) properties &body clauses)
  "Say what the designators of CLASS (motion or action) and TYPE mean in a domain.  PROPERTIES are
bound to the designator's values of these keys.  CLAUSES:
  (:domain NAME)                the domain this belongs to
  (:event (EVENT term*))        what happens on success
  (:requires formula)           when success is possible; fluents stand for themselves
  (:failure CLASS [:when formula] [:event (EVENT term*)])   how it may fail; :when defaults to the
                                negation of :requires
  (:returns form)               the value of perform
A term that is a property or a list is evaluated; there, (region-of x) is the
region of a pose or of a location designator."
  (check-clauses form clauses)
  (let ((domain (second (assoc :domain clauses)))
        (event (second (assoc :event clauses)))
        (requires (second (assoc :requires clauses))))
    (flet ((event-form (event)
             (and event (formula-template event properties)))
           (condition-form (formula)
             (formula-template formula properties)))
      `(register-action
        ',domain
        (make-action-binding
         :class ,(ec:name-keyword class) :type ,(ec:name-keyword type)
         :events ',(clause-events clauses)
         :failures ',(loop for (key failure) in clauses when (eq key :failure) collect failure)
         :describe-outcomes
         (lambda (domain designator)
           (declare (ignorable domain designator))
           (let ,(loop for property in properties
                       collect `(,property (plan:desig-prop-value
                                            designator ,(ec:name-keyword property))))
             (declare (ignorable ,@properties))
             (flet ((region-of (place) (place-region domain place)))
               (declare (ignorable #'region-of))
               (list
                (list :success ,(event-form event) ,(if requires (condition-form requires) t)
                      ,(second (assoc :returns clauses)))
                ,@(loop for (key name . arguments) in clauses
                        when (eq key :failure)
                          collect (destructuring-bind (&key (when nil whenp) event) arguments
                                    `(list ',name ,(event-form event)
                                           ,(cond (whenp (condition-form when))
                                                  (requires `(list :not ,(condition-form requires)))
                                                  (t nil))
                                           nil))))))))))))

(defun action-outcomes (domain designator &key plan position)
  "Return the list of the OUTCOMEs that DESIGNATOR may have in DOMAIN, success first.  Signals
ACTION-PROBLEM if there is no binding for it or its arguments mean nothing in the theory; it names
the PLAN that performs it and the source POSITION where it does."
  (handler-bind ((action-problem (lambda (condition)
                                   (setf (slot-value condition 'plan) plan
                                         (slot-value condition 'position) position))))
    (describe-outcomes domain designator)))

(defun describe-outcomes (domain designator)
  (let ((binding (find-action-binding domain designator))
        (ground (action-theory-ground domain)))
    (unless binding
      (error 'action-problem :designator designator
                             :reason (format nil "the domain ~a has no action binding for it"
                                             (ec:name-text (action-theory-name domain)))))
    (loop for (name event condition value)
            in (funcall (action-binding-describe-outcomes binding) domain designator)
          collect (make-outcome
                   :name name :value value
                   :event (and event
                               (let ((atom (mapcar #'ec:name-keyword event)))
                                 (ec:find-event ground atom)
                                 atom))
                   :condition (if (typep condition 'boolean)
                                  condition
                                  (ec:ground-formula
                                   ground
                                   (ec:parse-formula
                                    condition (action-theory-theory domain)
                                    :blame (format nil "action ~a" designator))))))))

(defun region-of (place)
  "Inside DEFINE-ACTION, return the element of the domain's theory that stands for PLACE, a pose or
a location designator, or NIL if none does.  Anywhere else this signals MALFORMED-PLAN-FORM."
  (error 'plan:malformed-plan-form :form `(region-of ,place)
                                   :expected "an enclosing define-action"))
