;;;; The DEFINE-ACTION form, which writes an action binding.
;;;;
;;;; A formula or event in it is a template: a list in the place of a term, or the name of a
;;;; property, is a Lisp form to be evaluated; all else stands for itself.

(in-package #:discrepancy-finder.symbolic-execution)

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

(defun region-of (place)
  "Inside DEFINE-ACTION, return the element of the domain's theory that stands for PLACE, a pose or
a location designator, or NIL if none does.  Anywhere else this signals MALFORMED-PLAN-FORM."
  (error 'plan:malformed-plan-form :form `(region-of ,place)
                                   :expected "an enclosing define-action"))
