;;;; What can be wrong with designators: as forms, and when they are resolved.

(in-package #:discrepancy-finder.designators)

(define-condition malformed-designator (error)
  ((form :initarg :form :reader malformed-designator-form
         :documentation "The form that is not well-formed.")
   (expected :initarg :expected :reader malformed-designator-expected
             :documentation "What was expected, as a string.")
   (plan :initarg :plan :initform nil :reader malformed-designator-plan
         :documentation "The name of the plan that the form stands in, or NIL.")
   (position :initarg :position :initform nil :reader malformed-designator-position
             :documentation "The source position of the form, or NIL if it is not known."))
  (:report (lambda (condition stream)
             (let ((*print-pretty* nil) (*print-length* 8) (*print-level* 4))
               (format stream "~@[~a: ~]In ~s~@[ of the plan ~(~a~)~], ~a was expected."
                       (let ((position (malformed-designator-position condition)))
                         (and position (princ-to-string position)))
                       (malformed-designator-form condition)
                       (malformed-designator-plan condition)
                       (malformed-designator-expected condition)))))
  (:documentation "Signaled when a form that makes a designator is expanded, or MAKE-DESIGNATOR
called, and what it says is no designator."))

(defmethod source:self-explaining-p ((condition malformed-designator))
  (malformed-designator-position condition))

(define-condition unknown-designator-key (style-warning)
  ((key :initarg :key :reader unknown-designator-key-key
        :documentation "The key in question, a keyword.")
   (suggestion :initarg :suggestion :reader unknown-designator-key-suggestion
               :documentation "The known key that is most like it.")
   (form :initarg :form :reader unknown-designator-key-form
         :documentation "The designator form.")
   (plan :initarg :plan :initform nil :reader unknown-designator-key-plan
         :documentation "The name of the plan that the form stands in, or NIL.")
   (position :initarg :position :initform nil :reader unknown-designator-key-position
             :documentation "The source position of the form, or NIL if it is not known."))
  (:report (lambda (condition stream)
             (let ((*print-pretty* nil) (*print-length* 8) (*print-level* 4))
               (format stream "~@[~a: ~]In ~s~@[ of the plan ~(~a~)~], the key ~(~s~) is unknown; ~
                               did you mean ~(~s~)?"
                       (let ((position (unknown-designator-key-position condition)))
                         (and position (princ-to-string position)))
                       (unknown-designator-key-form condition)
                       (unknown-designator-key-plan condition)
                       (unknown-designator-key-key condition)
                       (unknown-designator-key-suggestion condition)))))
  (:documentation "Signaled as a warning when a designator form is expanded that has a key which
nobody declared and which is much like a declared one.  DECLARE-DESIGNATOR-KEYS declares keys."))

(define-condition designator-error (simple-error)
  ((designator :initarg :designator :initform nil :reader designator-error-designator
               :documentation "The designator in question, or NIL."))
  (:default-initargs :format-control "A designator cannot be resolved.")
  (:documentation "Signaled when a designator cannot be resolved to what it describes."))

(defun designator-error (designator control &rest arguments)
  "Signal a DESIGNATOR-ERROR about DESIGNATOR whose report is made of CONTROL and ARGUMENTS."
  (error 'designator-error :designator designator
                           :format-control control :format-arguments arguments))

(define-condition invalid-location-function (error)
  ((function :initarg :function :reader invalid-location-function-function
             :documentation "The name of the generator or validation function.")
   (problem :initarg :problem :reader invalid-location-function-problem
            :documentation "What is wrong with it, as a string."))
  (:report (lambda (condition stream)
             (format stream "~(~s~) ~a." (invalid-location-function-function condition)
                     (invalid-location-function-problem condition))))
  (:documentation "Signaled when a generator or validation function of locations is named that is
not registered, or is registered with a priority that is no number."))

(define-condition property-type-error (error)
  ((designator :initarg :designator :reader property-type-error-designator
               :documentation "The designator in question.")
   (key :initarg :key :reader property-type-error-key
        :documentation "The key of the property.")
   (value :initarg :value :reader property-type-error-value
          :documentation "The value that the designator has there.")
   (expected :initarg :expected :reader property-type-error-expected
             :documentation "The types that the value may have, as a list of names."))
  (:report (lambda (condition stream)
             (format stream "~(~s~) of ~a must be ~{~(~a~)~^ or ~}, not ~a."
                     (property-type-error-key condition)
                     (property-type-error-designator condition)
                     (property-type-error-expected condition)
                     (description-text (property-type-error-value condition)))))
  (:documentation "Signaled by the predicate PROPERTY for a value of a wrong type while prolog's
*BREAK-ON-LISP-ERRORS* is true."))
