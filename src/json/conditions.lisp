(in-package #:discrepancy-finder.json)

(define-condition json-error (error)
  ((reason :initarg :reason :reader json-error-reason
           :documentation "What is wrong, as a string without a full stop.")
   (position :initarg :position :initform nil :reader json-error-position
             :documentation "Where in the text, counted in characters from 0, or NIL if the error
is in a value and not in a place of a text."))
  (:report (lambda (condition stream)
             (format stream "JSON~@[ at character ~d~]: ~a."
                     (json-error-position condition) (json-error-reason condition))))
  (:documentation "Signaled for a text that is not JSON, for a Lisp object that has no JSON text,
and for a key that an object lacks."))

(defun refuse (position control &rest arguments)
  "Signal JSON-ERROR at POSITION, which may be NIL, with the reason that CONTROL formats."
  (error 'json-error :position position :reason (apply #'format nil control arguments)))
