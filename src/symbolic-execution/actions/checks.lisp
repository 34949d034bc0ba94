;;;; Checking an action binding against its theory, when it is registered.
;;;;
;;;; What is computed when the action is performed is taken for something of the right sort.

(in-package #:discrepancy-finder.symbolic-execution)

(defun placeholder (theory atom number)
  "Return a variable of the sort that the term with NUMBER of ATOM must have, or NIL if unknown."
  (let* ((name (and (symbolp (first atom)) (ec:name-keyword (first atom))))
         (declaration (or (assoc name (ec:theory-fluents theory))
                          (assoc name (ec:theory-events theory))
                          (assoc name (ec:theory-predicates theory))))
         (sort (nth number declaration)))
    (and sort (intern (format nil "?~a" sort) :keyword))))

(defun filled-in (theory template)
  "Return the formula TEMPLATE with a variable for each computed term, and the list of these.
Comparisons of computed terms are left out."
  (let ((variables '()))
    (labels ((computed-p (term) (and (consp term) (eq (first term) :computed)))
             (fill-in (form)
               (cond ((atom form) form)
                     ((member (and (symbolp (first form)) (ec:name-keyword (first form)))
                              '(:and :or :not :implies :iff))
                      (cons (first form) (mapcar #'fill-in (rest form))))
                     ((and (symbolp (first form))
                           (member (ec:name-keyword (first form)) '(:forall :exists)))
                      (list (first form) (second form) (fill-in (third form))))
                     ((notany #'computed-p (rest form)) form)
                     (t
                      (let ((terms (loop for term in (rest form)
                                         for number from 1
                                         collect (if (computed-p term)
                                                     (placeholder theory form number)
                                                     term))))
                        (cond ((and (member nil terms)
                                    (member (ec:name-keyword (first form))
                                            '(:= :/= :< :<= :> :>=)))
                               '(:and))
                              (t (loop for term in terms for old in (rest form)
                                       when (computed-p old) do (pushnew term variables))
                                 (cons (first form) terms))))))))
      (let ((formula (fill-in template)))
        (values formula (remove nil variables))))))

(defun unbound-term (template &optional bound)
  "Return a term of the formula TEMPLATE that is written as a variable and is neither bound nor a
property, or NIL."
  (cond ((atom template) nil)
        ((eq (first template) :computed) nil)
        ((and (symbolp (first template))
              (member (ec:name-keyword (first template)) '(:forall :exists)))
         (unbound-term (third template)
                       (append (alexandria:ensure-list (second template)) bound)))
        (t (loop for part in (rest template)
                 do (let ((found (if (and (question-mark-p part) (not (member part bound)))
                                     part
                                     (unbound-term part bound))))
                      (when found (return found)))))))

(defun check-template (domain template complain &key (kind :state) bound)
  "Call COMPLAIN with a format control and arguments if the formula TEMPLATE means nothing in the
theory of DOMAIN."
  (let ((theory (action-theory-theory domain))
        (unbound (unbound-term template bound)))
    (when unbound
      (funcall complain "~a is neither a property in the head of the action nor bound by a ~
                         quantifier"
               (ec:name-text unbound)))
    (multiple-value-bind (formula variables) (filled-in theory template)
      (handler-case
          (ec:parse-formula (if (eq kind :event) `(:happens ,formula ?time) formula) theory
                            :kind (if (eq kind :event) :constraint :state)
                            :variables (append (mapcar #'ec:name-keyword bound) variables))
        (ec:theory-error (condition)
          (funcall complain "~a in theory ~a" (ec:theory-error-reason condition)
                   (ec:name-text (ec:theory-name theory))))))))

(defun variable-sort-name (variable)
  "Return the name of the sort of VARIABLE, a keyword."
  (intern (string-right-trim "0123456789" (subseq (symbol-name variable) 1)) :keyword))

(defun check-element (domain template complain)
  "Check TEMPLATE, (fluent variable), of a VALUE-OF."
  (destructuring-bind (fluent &optional variable &rest more) template
    (cond ((or more (not (consp fluent)))
           (funcall complain "a fluent and a variable were expected after value-of"))
          ((not (question-mark-p variable))
           (funcall complain "a variable such as ?place was expected after the fluent of value-of"))
          ((/= 1 (count variable fluent))
           (funcall complain "~a must occur once in the fluent of value-of, and be no property"
                    (ec:name-text variable)))
          (t (check-template domain fluent complain :bound (list variable))))))

(defun initargs-of (class)
  "Return the initargs of the condition CLASS, a symbol."
  (let ((class (find-class class)))
    (loop for slot in (sb-mop:class-slots class)
          append (sb-mop:slot-definition-initargs slot))))

(defun check-failure (template complain)
  (destructuring-bind (class . initargs) template
    (unless (subtypep class 'plan:plan-failure)
      (funcall complain "~(~a~) is no plan failure" class))
    (let ((unknown (set-difference initargs (initargs-of class))))
      (when unknown
        (funcall complain "~(~a~) takes no initarg ~(~s~)~@[, only ~{~(~s~)~^, ~}~]" class
                 (first unknown) (initargs-of class))))))

(defun check-binding (domain binding)
  "Signal ACTION-PROBLEM if BINDING mentions something that the theory of DOMAIN does not have, or a
failure that is none."
  (dolist (mention (action-binding-mentions binding))
    (let ((template (mention-template mention)))
      (flet ((complain (control &rest arguments)
               (let ((*print-pretty* nil) (*print-gensym* nil))
                 (error 'action-problem
                        :designator (format nil "The action ~a, ~(~s~)" (binding-text binding)
                                            (plain-clause (mention-clause mention)))
                        :position (mention-position mention)
                        :reason (apply #'format nil control arguments)))))
        (ecase (mention-kind mention)
          (:event (check-template domain template #'complain :kind :event))
          (:formula (check-template domain template #'complain))
          (:element (check-element domain template #'complain))
          (:failure (check-failure template #'complain)))))))

(defun plain-clause (clause)
  "Return CLAUSE with symbols that print without their packages."
  (cond ((consp clause) (cons (plain-clause (car clause)) (plain-clause (cdr clause))))
        ((and (symbolp clause) clause (not (keywordp clause))) (make-symbol (symbol-name clause)))
        (t clause)))
