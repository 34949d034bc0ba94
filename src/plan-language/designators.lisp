;;;; Designators: symbolic descriptions of actions, motions, objects and locations.
;;;;
;;;; (a motion (type going) (pose ?goal)) makes one.  Its keys and the symbols in its values become
;;;; keywords, symbols that begin with ? are variables, numbers and strings stand for themselves,
;;;; a nested (an object ...) is a designator, any other list a list.  (when ?x (key value)) is
;;;; there only if ?x is true.  DESIG-PROP-VALUE reads them.

(in-package #:discrepancy-finder.plan-language)

(defclass designator ()
  ((description :initarg :description :reader properties
                :documentation "The list of the (key value) pairs."))
  (:documentation "A description by properties, to be resolved when it is used."))

(defclass action-designator (designator) ()
  (:documentation "Describes something that a robot does, as a plan sees it."))
(defclass motion-designator (designator) ()
  (:documentation "Describes a movement that a process module executes."))
(defclass object-designator (designator) ()
  (:documentation "Describes a thing in the world."))
(defclass location-designator (designator) ()
  (:documentation "Describes a place."))

(defparameter *designator-classes*
  '((:action . action-designator) (:motion . motion-designator)
    (:object . object-designator) (:location . location-designator))
  "The designator class that each keyword stands for.")

(defun make-designator (type description)
  "Return a designator of TYPE (:action, :motion, :object or :location) with DESCRIPTION, a list of
(key value) pairs.  Signals MALFORMED-PLAN-FORM for another type."
  (let ((class (cdr (assoc type *designator-classes*))))
    (unless class
      (error 'malformed-plan-form :form `(make-designator ,type)
                                  :expected "one of :action, :motion, :object, :location"))
    (make-instance class :description description)))

(defun designator-class-keyword (designator)
  "Return :action, :motion, :object or :location for DESIGNATOR."
  (car (rassoc (class-name (class-of designator)) *designator-classes*)))

(defun desig-prop-values (designator key)
  "Return the list of all values of KEY in DESIGNATOR, a designator or NIL."
  (and designator
       (loop for (property value) in (properties designator)
             when (eq property key) collect value)))

(defun desig-prop-value (designator key)
  "Return the first value of KEY in DESIGNATOR, a designator or NIL; NIL if there is none."
  (first (desig-prop-values designator key)))

(defun description-text (value)
  (typecase value
    (designator
     (let ((keyword (designator-class-keyword value)))
       (format nil "(~:[a~;an~] ~(~a~)~{ (~(~a~) ~a)~})"
               (member keyword '(:action :object)) keyword
               (loop for (key value) in (properties value)
                     collect key collect (description-text value)))))
    (pose (format nil "~,3f ~,3f ~,3f" (pose-x value) (pose-y value) (pose-z value)))
    (symbol (string-downcase value))
    (list (format nil "(~{~a~^ ~})" (mapcar #'description-text value)))
    (t (princ-to-string value))))

(defmethod print-object ((designator designator) stream)
  (write-string (description-text designator) stream))

(defun designated-pose (thing)
  "Return the pose that THING means: THING itself if it is a pose, the pose of a location
designator, or else NIL."
  (typecase thing
    (pose thing)
    (location-designator (designated-pose (desig-prop-value thing :pose)))))

;;; Reading (a ...) forms

(defun variable-symbol-p (symbol)
  (let ((name (symbol-name symbol)))
    (and (plusp (length name)) (char= (char name 0) #\?))))

(defun value-form (value)
  "Return the form that evaluates to the property value written as VALUE."
  (typecase value
    (null nil)
    (keyword value)
    (symbol (if (variable-symbol-p value) value (source:name-keyword value)))
    (cons (if (and (symbolp (first value))
                   (member (symbol-name (first value)) '("A" "AN" "THE") :test #'string=)
                   (consp (rest value)) (symbolp (second value))
                   (assoc (source:name-keyword (second value)) *designator-classes*))
              (designator-form (second value) (cddr value) value)
              `(list ,@(mapcar #'value-form value))))
    (t value)))

(defun property-form (property form)
  "Return a form for the list of the pairs that PROPERTY of the designator FORM stands for:
(key value), or (when test property) for one that is there only if the test is true."
  (unless (and (consp property) (symbolp (first property)) (consp (rest property)))
    (error 'malformed-plan-form :form form :expected "properties of the form (key value)"))
  (if (and (string= (first property) "WHEN") (= (length property) 3) (consp (third property)))
      `(when ,(second property) ,(property-form (third property) form))
      `(list (list ,(source:name-keyword (first property))
                   ,@(mapcar #'value-form (rest property))))))

(defun designator-form (type properties form)
  (unless (and (symbolp type) (assoc (source:name-keyword type) *designator-classes*))
    (error 'malformed-plan-form
           :form form :expected "action, motion, object or location after the article"))
  `(make-designator ,(source:name-keyword type)
                    (append ,@(loop for property in properties
                                    collect (property-form property form)))))

(defmacro a (&whole form type &body properties)
  "Return a new designator of TYPE (action, motion, object, location), unevaluated, with
PROPERTIES, a list of (key value)."
  (designator-form type properties form))

(defmacro an (&whole form type &body properties)
  "The same as A."
  (designator-form type properties form))
