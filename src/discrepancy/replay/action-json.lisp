;;;; Recorded actions as JSON values, and back.
;;;;
;;;; A description is an object with the keys class, quantifier and properties.  In it a keyword is
;;;; a string in lower case, a list an array, a pose {"pose": [x, y, z, qx, qy, qz, qw]}, a string
;;;; {"text": "..."}; other symbols and ratios are written as the arguments of plans are.  Reading
;;;; evaluates and interns nothing.

(in-package #:discrepancy-finder.discrepancy)

(define-condition unwritable-action (error)
  ((value :initarg :value :reader unwritable-action-value))
  (:documentation "Signaled when an action that holds VALUE is to be written as JSON."))

(defun lower-case-name-p (symbol)
  "Return true if the name of SYMBOL can be written in lower case."
  (string= (symbol-name symbol) (string-upcase (string-downcase (symbol-name symbol)))))

(defun value-json (value)
  "Return VALUE, a description or a value in one, as a JSON value.  Signals UNWRITABLE-ACTION."
  (typecase value
    (null (vector))
    ((eql t) :true)
    (double-float value)
    (single-float (json:object "single" (float value 1d0)))
    (integer value)
    (string (json:object "text" value))
    (pose (json:object "pose" (coerce (pose-components value) 'simple-vector)))
    (description (description-json value))
    ((and keyword (satisfies lower-case-name-p)) (string-downcase value))
    ((or symbol ratio) (symbolic:argument-to-json value))
    (cons (if (alexandria:proper-list-p value)
              (map 'vector #'value-json value)
              (error 'unwritable-action :value value)))
    (t (error 'unwritable-action :value value))))

(defun description-json (description)
  (json:object "class" (string-downcase (description-class description))
               "quantifier" (string-downcase (description-quantifier description))
               "properties" (map 'vector #'value-json (description-properties description))))

(defun writable-p (action)
  "Return true if the RECORDED-ACTION ACTION can be written to a replay file."
  (handler-case (progn (description-json (recorded-action-description action)) t)
    (unwritable-action () nil)))

;;; Reading

(define-condition unreadable-action (error)
  ((reason :initarg :reason :reader unreadable-action-reason))
  (:documentation "Signaled for a JSON value that is no action."))

(defun refuse-action (control &rest arguments)
  (error 'unreadable-action :reason (apply #'format nil control arguments)))

(defun keyword-from-json (text)
  (or (and (stringp text) (find-symbol (string-upcase text) '#:keyword))
      (refuse-action "~s is no name that the plan or the domain uses" text)))

(defun pose-from-json (numbers)
  (unless (and (typep numbers '(simple-vector 7))
               (every (lambda (number) (typep number 'double-float)) numbers))
    (refuse-action "a pose has seven numbers with a decimal point"))
  (components-pose (coerce numbers 'list)))

(defun single-from-json (number)
  (if (typep number '(double-float -3d38 3d38))
      (float number 1f0)
      (refuse-action "~s is no single float" number)))

(defun value-from-json (value)
  "Return what VALUE-JSON has made VALUE of.  Signals UNREADABLE-ACTION."
  (typecase value
    (simple-string (keyword-from-json value))
    (simple-vector (map 'list #'value-from-json value))
    (double-float value)
    (integer value)
    ((eql :true) t)
    (cons (destructuring-bind ((key . content) . more) value
            (cond (more (description-from-json value))
                  ((string= key "pose") (pose-from-json content))
                  ((string= key "single") (single-from-json content))
                  ((and (string= key "text") (stringp content)) content)
                  (t (argument-of value)))))
    (t (refuse-action "~s is no value of a property" value))))

(defun description-from-json (object)
  "Return the DESCRIPTION that OBJECT stands for, or what else the object stands for that has more
than one key."
  (if (and (consp object) (assoc "properties" object :test #'equal))
      (let ((class (keyword-from-json (value-of object "class" 'string)))
            (properties (value-from-json (value-of object "properties" 'simple-vector))))
        (unless (and (member class '(:action :motion :location :object :human))
                     (every (lambda (property) (and (consp property) (keywordp (first property))))
                            properties))
          (refuse-action "a designator has a class and properties (key value ...)"))
        (make-description :class class :properties properties
                          :quantifier (keyword-from-json (value-of object "quantifier" 'string))))
      (argument-of object)))

(defun action-from-json (object)
  "Return the RECORDED-ACTION that OBJECT stands for.  Signals UNREADABLE-ACTION and REPLAY-FAULT."
  (let ((description (description-from-json object)))
    (unless (and (description-p description)
                 (member (description-class description) '(:action :motion)))
      (refuse-action "an action or motion was expected"))
    (make-recorded-action :description description
                          :text (princ-to-string (designator-of description '())))))
