;;;; The clauses of DEFINE-ACTION, when it is expanded: their shape, and the templates in them.
;;;;
;;;; A formula or event is a template: a list in the place of a term, or the name of a property, is
;;;; a Lisp form to be evaluated, a COMPUTED term; all else stands for itself.  What a quantifier
;;;; binds is a variable, also if a property has the same name.

(in-package #:discrepancy-finder.symbolic-execution)

(defparameter *clause-shapes*
  '((:domain . "the name of a domain, as in (:domain household)")
    (:event . "an event, as in (:event (name term*))")
    (:requires . "a formula, as in (:requires (not (blocked door)))")
    (:failure . "a failure class and options, as in (:failure class :when formula :event (name
term*) :initargs (key value*))")
    (:returns . "a form, as in (:returns object)"))
  "What each clause of a DEFINE-ACTION consists of.")

(defun clause-problem (form clause control &rest arguments)
  "Signal MALFORMED-PLAN-FORM for CLAUSE of the DEFINE-ACTION FORM."
  (error 'plan:malformed-plan-form
         :form (or clause (list (first form) (second form)))
         :plan nil
         :expected (apply #'format nil control arguments)))

(defun check-clause (form clause)
  (unless (and (alexandria:proper-list-p clause) (assoc (first clause) *clause-shapes*))
    (clause-problem form clause "one of ~{~(~s~)~^, ~} in each clause of a define-action"
                    (mapcar #'car *clause-shapes*)))
  (flet ((event-p (event)
           (and (alexandria:proper-list-p event) (symbolp (first event)) (first event))))
    (destructuring-bind (key &optional thing &rest more) clause
      (unless (if (eq key :failure)
                  (and thing (symbolp thing) (evenp (length more))
                       (loop for (option) on more by #'cddr
                             always (member option '(:when :event :initargs)))
                       (or (null (getf more :event)) (event-p (getf more :event)))
                       (alexandria:proper-list-p (getf more :initargs))
                       (evenp (length (getf more :initargs))))
                  (and (rest clause) (null more)
                       (case key
                         (:domain (and thing (symbolp thing)))
                         (:event (event-p thing))
                         (t t))))
        (clause-problem form clause "one thing after ~(~s~): ~a" key
                        (substitute #\Space #\Newline (cdr (assoc key *clause-shapes*))))))))

(defun check-clauses (form class type properties clauses)
  "Signal MALFORMED-PLAN-FORM unless CLASS, TYPE, PROPERTIES and CLAUSES of the DEFINE-ACTION FORM
are what they should be."
  (unless (and (symbolp class) (member (ec:name-keyword class) '(:motion :action))
               type (symbolp type))
    (clause-problem form nil "(motion type) or (action type) after define-action"))
  (unless (and (alexandria:proper-list-p properties) (every #'symbolp properties)
               (notany #'keywordp properties) (notany #'constantp properties)
               (alexandria:setp properties)
               (null (intersection properties lambda-list-keywords)))
    (clause-problem form nil "a list of variables, the properties, each once, after (~(~a ~a~))"
                    class type))
  (dolist (clause clauses) (check-clause form clause))
  (dolist (key '(:domain :event))
    (unless (= 1 (count key clauses :key #'first))
      (clause-problem form nil "exactly one clause (~(~s~) ...)" key)))
  (dolist (key '(:requires :returns))
    (unless (<= (count key clauses :key #'first) 1)
      (clause-problem form (find key clauses :key #'first :from-end t)
                      "at most one clause (~(~s~) ...)" key))))

(defun question-mark-p (term)
  (and (symbolp term) (plusp (length (symbol-name term)))
       (char= (char (symbol-name term) 0) #\?)))

(defun property-key (property)
  "Return the key of designators that the variable PROPERTY is bound to: ?object or object is
:object."
  (let ((name (symbol-name property)))
    (if (and (> (length name) 1) (char= (char name 0) #\?))
        (intern (subseq name 1) :keyword)
        (ec:name-keyword property))))

;;; Templates

(defun computed-p (term properties)
  (or (consp term) (and (member term properties) t)))

(defun map-template (function form properties)
  "Return the formula FORM with each computed term replaced by what FUNCTION returns for it, other
parts by what it returns for (quote part): a tree of calls of LIST, or data."
  (flet ((literal (thing) (funcall function thing nil)))
    (labels ((walk (form properties)
               (if (atom form)
                   (literal form)
                   (case (and (symbolp (first form)) (ec:name-keyword (first form)))
                     ((:and :or :not :implies :iff)
                      (cons (literal (first form))
                            (loop for part in (rest form) collect (walk part properties))))
                     ((:forall :exists)
                      (list (literal (first form)) (literal (second form))
                            (walk (third form)
                                  (set-difference properties
                                                  (alexandria:ensure-list (second form))))))
                     (t (cons (literal (first form))
                              (loop for term in (rest form)
                                    collect (funcall function term
                                                     (computed-p term properties)))))))))
      (walk form properties))))

(defun formula-data (form properties)
  "Return FORM with computed terms as (:computed form)."
  (map-template (lambda (part computed) (if computed (list :computed part) part))
                form properties))

(defun listing (tree)
  "Return the form that makes a list like TREE of the values of its leaves, which are (quote x) or
(:value form)."
  (cond ((eq (first tree) 'quote) tree)
        ((eq (first tree) :value) (second tree))
        (t `(list ,@(mapcar #'listing tree)))))

(defun formula-form (form properties term-form)
  "Return a form that evaluates to the formula FORM; computed terms are evaluated by what the
function TERM-FORM makes of them."
  (listing (map-template (lambda (part computed)
                           (if computed
                               (list :value (funcall term-form part))
                               `(quote ,part)))
                         form properties)))

(defun variables-in (form variables)
  "Return those of VARIABLES that occur in FORM."
  (if (consp form)
      (union (variables-in (car form) variables) (variables-in (cdr form) variables))
      (and (member form variables) (list form))))

;;; What is mentioned

(defun returned-questions (form)
  "Return the (value-of ...) and (truth-of ...) in FORM."
  (cond ((atom form) '())
        ((member (first form) '(value-of truth-of)) (list form))
        (t (append (returned-questions (car form)) (returned-questions (cdr form))))))

(defun question-properties (formula variable properties)
  "Return the variables of Lisp that may stand in FORMULA of a question of :RETURNS: PROPERTIES and
all that begin with a question mark, but for VARIABLE."
  (labels ((variables (form)
             (cond ((consp form) (union (variables (car form)) (variables (cdr form))))
                   ((and (question-mark-p form) (not (eq form variable))) (list form)))))
    (union properties (variables formula))))

(defun question-mentions (question position properties)
  (destructuring-bind (operator &optional formula variable &rest more) question
    (let ((data (formula-data formula (question-properties formula variable properties))))
      (list (make-mention
             :position (or (source:form-position question) position) :clause question
             :kind (if (eq operator 'value-of) :element :formula)
             :template (if (eq operator 'value-of) (list* data variable more) data))))))

(defun clause-mentions (form clause properties)
  "Return the mentions of CLAUSE of the DEFINE-ACTION FORM."
  (let ((position (or (source:form-position clause) (source:form-position form))))
    (flet ((mention (kind template)
             (list (make-mention :kind kind :clause clause :template template
                                 :position position)))
           (data (formula) (formula-data formula properties)))
      (destructuring-bind (key thing &rest options) clause
        (ecase key
          (:domain '())
          (:event (mention :event (data thing)))
          (:requires (mention :formula (data thing)))
          (:returns
           (loop for question in (returned-questions thing)
                 append (question-mentions question position properties)))
          (:failure
           (append (mention :failure
                            (cons thing (loop for (initarg) on (getf options :initargs) by #'cddr
                                              collect initarg)))
                   (and (getf options :event) (mention :event (data (getf options :event))))
                   (and (getf options :when) (mention :formula (data (getf options :when)))))))))))
