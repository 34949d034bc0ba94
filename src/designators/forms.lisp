;;;; The forms that make designators: (a motion (type going) (target (a location (pose ?goal)))).
;;;;
;;;; Nothing in such a form is evaluated but variables, and what is what is decided when the form is
;;;; expanded, as CRAM does it.  Of values,
;;;;   ?x                   is a variable, evaluated;
;;;;   a symbol with a value (a special variable or constant that is bound by now) is that value;
;;;;   any other symbol     is the keyword of its name, as the type and the keys are;
;;;;   (an object ...)      after any of a, an, the, some, all, is a designator;
;;;;   any other list       is the list of its elements, which are values in turn, so that no
;;;;                        function can be called there;
;;;;   anything else        is itself.
;;;; Of properties, (when test property*) stands for PROPERTY* if TEST, which is evaluated, is true,
;;;; else for none; NIL stands for none.  Symbols are compared by name, whatever their package.

(in-package #:discrepancy-finder.designators)

(defparameter *quantifiers*
  '(("A" . :a) ("AN" . :a) ("THE" . :the) ("SOME" . :some) ("ALL" . :all))
  "The quantifier that each article stands for.")

(defun article-quantifier (article)
  (and (symbolp article)
       (cdr (assoc (symbol-name article) *quantifiers* :test #'string=))))

(defun malformed (expected form &optional part)
  "Signal MALFORMED-DESIGNATOR for PART of FORM."
  (error 'malformed-designator
         :form form :plan *plan* :expected expected
         :position (or (source:form-position part) (source:form-position form))))

(defun variable-symbol-p (symbol)
  (let ((name (symbol-name symbol)))
    (and (plusp (length name)) (char= (char name 0) #\?))))

(defun symbol-form (symbol)
  (cond ((keywordp symbol) symbol)
        ((variable-symbol-p symbol) symbol)
        ((not (boundp symbol)) (source:name-keyword symbol))
        ((eq (symbol-value symbol) symbol) symbol)
        (t (value-form (symbol-value symbol)))))

(defun value-form (value)
  "Return the form that evaluates to the property value written as VALUE."
  (cond ((symbolp value) (symbol-form value))
        ((atom value) value)
        ((article-quantifier (first value))
         (designator-form (article-quantifier (first value)) value))
        ((not (alexandria:proper-list-p value))
         (malformed "a list without a dot" value))
        (t `(list ,@(mapcar #'value-form value)))))

(defun conditional-p (property)
  (and (symbolp (first property)) (string= (first property) "WHEN")))

(defun property-forms (property class form)
  "Return the list of the forms that evaluate to the properties for which PROPERTY, of the
designator FORM of CLASS, stands unconditionally."
  (cond ((null property) '())
        ((not (and (alexandria:proper-list-p property) (symbolp (first property))
                   (first property)))
         (malformed "properties of the form (key value)" form property))
        ((null (rest property))
         (malformed (format nil "a value after the key ~(~a~), as in (key value)"
                            (first property))
                    form property))
        (t (let ((key (source:name-keyword (first property))))
             (check-key class key property form)
             `((list ,key ,@(mapcar #'value-form (rest property))))))))

(defun properties-form (properties class form)
  "Return the form that evaluates to the list of PROPERTIES of the designator FORM of CLASS."
  (flet ((segment (property)
           (if (and (consp property) (alexandria:proper-list-p property)
                    (conditional-p property))
               (if (and (cddr property) (every #'listp (cddr property)))
                   `(when ,(second property)
                      ,(properties-form (cddr property) class form))
                   (malformed "(when test (key value))" form property))
               (property-forms property class form))))
    (let ((segments (mapcar #'segment properties)))
      (if (notany (lambda (segment) (eq (first segment) 'when)) segments)
          `(list ,@(apply #'append segments))
          `(append ,@(loop for segment in segments
                           if (eq (first segment) 'when) collect segment
                           else if segment collect `(list ,@segment)))))))

(defun designator-form-in (environment quantifier form)
  (let ((*plan* (source:enclosing-definition environment)))
    (designator-form quantifier form)))

(defun designator-form (quantifier form)
  "Return the form that makes the designator with QUANTIFIER for which FORM, (article type
property*), stands."
  (unless (alexandria:proper-list-p form)
    (malformed "a list without a dot" form))
  (destructuring-bind (&optional type &rest properties) (rest form)
    (let ((class (and type (symbolp type)
                      (find type *designator-classes* :test #'string=))))
      (unless class
        (malformed "action, motion, object, location or human after the article" form))
      (let ((description (properties-form properties class form)))
        (if (eq quantifier :a)
            `(make-designator ,class ,description)
            `(make-quantified-designator ,class ,description ,quantifier))))))

(defmacro a (&whole form &optional type &body properties &environment environment)
  "Return a new designator of TYPE (action, motion, location, object or human, unevaluated) with
PROPERTIES, a list of (key value*) or (when test (key value*)).  In a value, ?x is a variable, a
special variable that is bound its value, another symbol a keyword, (an object ...) a designator,
any other list a list.  Signals MALFORMED-DESIGNATOR and warns with UNKNOWN-DESIGNATOR-KEY when it
is expanded."
  (declare (ignore type properties))
  (designator-form-in environment :a form))

(defmacro an (&whole form &optional type &body properties &environment environment)
  "The same as A."
  (declare (ignore type properties))
  (designator-form-in environment :a form))

(defmacro all (&whole form &optional type &body properties &environment environment)
  "Like A: a designator for all things that have the PROPERTIES; its quantifier is :all."
  (declare (ignore type properties))
  (designator-form-in environment :all form))

(defmacro the (&whole form &optional type &body properties &environment environment)
  "Like A: a designator for the only thing that has the PROPERTIES; its quantifier is :the.  Where
TYPE is none of a designator, this is CL:THE."
  (if (and (symbolp type) (find type *designator-classes* :test #'string=)
           (every #'listp properties))
      (designator-form-in environment :the form)
      `(cl:the ,type ,@properties)))
