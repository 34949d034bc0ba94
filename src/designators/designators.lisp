;;;; Designators: symbolic descriptions of actions, motions, locations, objects and humans.
;;;;
;;;; A designator holds a DESCRIPTION, the list of its properties (key value*); a key may occur more
;;;; than once.  What it describes is found out when it is used (reference.lisp).  Designators that
;;;; turn out to describe the same are chained (chains.lisp): each knows its PARENT, the older one,
;;;; and its SUCCESSOR.  MAKE-DESIGNATOR makes one, DESIG-PROP-VALUE reads it.

(in-package #:discrepancy-finder.designators)

(defclass designator ()
  ((description :initarg :description :reader properties :reader description
                :documentation "The list of the properties, (key value*) each.")
   (quantifier :initarg :quantifier :initform :a :reader quantifier
               :documentation "Which of the things that fit are meant: :a, :the, :some or :all.")
   (parent :initform nil :reader parent
           :documentation "The designator that this one was equated to, the next older, or NIL.")
   (successor :initform nil :reader successor
              :documentation "The next younger designator of the chain, or NIL.")
   (effective :initform nil :reader effective
              :documentation "True once what the designator describes was found.")
   (timestamp :initform nil :reader timestamp
              :documentation "When that was first, by *TIMESTAMP-FUNCTION*, or NIL.")
   (data :initform nil :initarg :data :accessor data
         :documentation "What the designator describes, a solution or what perception saw; or NIL.")
   (solutions :initform nil
              :documentation "The lazy list of the solutions from DATA on; private."))
  (:documentation "A description by properties, resolved when it is used."))

(defclass action-designator (designator) ()
  (:documentation "Describes something that a robot does, as a plan sees it."))
(defclass motion-designator (designator) ()
  (:documentation "Describes a movement that a process module executes."))
(defclass location-designator (designator) ()
  (:documentation "Describes a place."))
(defclass object-designator (designator) ()
  (:documentation "Describes a thing in the world."))
(defclass human-designator (designator) ()
  (:documentation "Describes a human."))

(defgeneric designator-class-keyword (designator)
  (:documentation "Return :action, :motion, :location, :object or :human for DESIGNATOR.")
  (:method ((designator action-designator)) :action)
  (:method ((designator motion-designator)) :motion)
  (:method ((designator location-designator)) :location)
  (:method ((designator object-designator)) :object)
  (:method ((designator human-designator)) :human))

(defparameter *designator-classes* '(:action :motion :location :object :human)
  "The keywords of the designator classes.")

(defun class-keyword (type)
  "Return the keyword of the designator class that TYPE, a symbol such as MOTION, :MOTION or
MOTION-DESIGNATOR, or the class itself, means, or NIL."
  (typecase type
    (class (class-keyword (class-name type)))
    ((and symbol (not null))
     (let ((name (symbol-name type)))
       (find-if (lambda (keyword)
                  (or (string= name keyword)
                      (string= name (format nil "~a-DESIGNATOR" keyword))))
                *designator-classes*)))))

(defun check-class (type)
  "Return the keyword of the designator class TYPE, or signal MALFORMED-DESIGNATOR."
  (or (class-keyword type)
      (error 'malformed-designator
             :form `(make-designator ,type)
             :expected "one of :action, :motion, :object, :location, :human")))

(defun new-designator (type description quantifier)
  ;; Constant class names: SBCL compiles these to constructors.
  (macrolet ((made (class)
               `(make-instance ',class :description description :quantifier quantifier)))
    (ecase (if (member type *designator-classes*) type (check-class type))
      (:action (made action-designator))
      (:motion (made motion-designator))
      (:location (made location-designator))
      (:object (made object-designator))
      (:human (made human-designator)))))

(defun make-designator (type description &optional parent)
  "Return a designator of TYPE (:action, :motion, :location, :object or :human) with DESCRIPTION, a
list of (key value*).  With PARENT, a designator, it is equated to that.  Signals
MALFORMED-DESIGNATOR for another type or what is no such list."
  (unless (and (listp description) (every #'consp description))
    (error 'malformed-designator :form `(make-designator ,type ,description)
                                 :expected "a list of (key value*)"))
  (let ((designator (new-designator type description :a)))
    (when parent
      (equate parent designator))
    designator))

(defun make-quantified-designator (type description quantifier)
  "Like MAKE-DESIGNATOR, with the QUANTIFIER :a, :the, :some or :all."
  (new-designator type description quantifier))

(defmacro with-designators ((&rest bindings) &body body)
  "Evaluate BODY with variables bound, one after the other, to new designators: a binding is
(variable type description), type and description evaluated, as for MAKE-DESIGNATOR."
  `(let* ,(loop for (variable type description) in bindings
                collect `(,variable (make-designator ,type ,description)))
     ,@body))

;;; Properties

(defun desig-prop-values (designator key)
  "Return the list of the values of KEY in DESIGNATOR, a designator or NIL, one for each time that
KEY occurs."
  (and designator
       (loop for (property value) in (properties designator)
             when (eq property key) collect value)))

(defun desig-prop-value (designator key)
  "Return the first value of KEY in DESIGNATOR, a designator or NIL; NIL if there is none."
  (and designator
       (second (assoc key (properties designator) :test #'eq))))

(defmacro with-desig-props ((&rest keys) designator &body body)
  "Evaluate BODY with a variable for each of KEYS, symbols, bound to the first value that the value
of DESIGNATOR, a designator or NIL, has for the keyword of that name."
  (alexandria:with-gensyms (the-designator)
    `(let* ((,the-designator ,designator)
            ,@(loop for key in keys
                    collect `(,key (desig-prop-value ,the-designator
                                                     ,(source:name-keyword key)))))
       (declare (ignorable ,the-designator))
       ,@body)))
