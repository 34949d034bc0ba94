;;;; Conditions of the transforms layer.

(in-package #:discrepancy-finder.transforms)

(define-condition transforms-error (error)
  ()
  (:documentation "Root of the errors about vectors, quaternions, poses and frames."))

(define-condition unsuitable-value (transforms-error)
  ((role :initarg :role :reader unsuitable-value-role
         :documentation "What the value was given for, such as \"the x of a 3d-vector\".")
   (expected :initarg :expected :reader unsuitable-value-expected
             :documentation "What would have been suitable, such as \"a finite real number\".")
   (value :initarg :value :reader unsuitable-value-value
          :documentation "What was given."))
  (:report (lambda (condition stream)
             (let ((*print-pretty* nil) (*print-length* 8) (*print-level* 3))
               (format stream "~@(~a~) must be ~a, but it is ~s."
                       (unsuitable-value-role condition)
                       (unsuitable-value-expected condition)
                       (unsuitable-value-value condition)))))
  (:documentation "Signaled when a number, a vector, a pose or the like is expected and something
else is given."))

(define-condition zero-length (transforms-error)
  ((kind :initarg :kind :reader zero-length-kind
         :documentation "What has no length, such as \"quaternion\"."))
  (:report (lambda (condition stream)
             (format stream "A ~a of length zero has no direction." (zero-length-kind condition))))
  (:documentation "Signaled when the direction of a zero vector or the rotation of a zero quaternion
is asked for."))

(define-condition unknown-frame (transforms-error)
  ((name :initarg :name :reader unknown-frame-name
         :documentation "The name of the frame, a string.")
   (known :initarg :known :reader unknown-frame-known
          :documentation "The names of the frames that are known, a sorted list of strings."))
  (:report (lambda (condition stream)
             (format stream "The frame ~s is unknown; known ~[are~;is~:;are~] ~{~s~^, ~}."
                     (unknown-frame-name condition)
                     (length (unknown-frame-known condition))
                     (unknown-frame-known condition))))
  (:documentation "Signaled when *TRANSFORMER* is asked for a frame that it does not know."))

(define-condition frame-mismatch (warning)
  ((operation :initarg :operation :reader frame-mismatch-operation
              :documentation "The name of the function that warns.")
   (expected :initarg :expected :reader frame-mismatch-expected
             :documentation "The frame that was expected, a string.")
   (found :initarg :found :reader frame-mismatch-found
          :documentation "The frame that was found, a string."))
  (:report (lambda (condition stream)
             (format stream "~(~a~) multiplies transforms whose frames do not fit: ~s was expected ~
                             where ~s is."
                     (frame-mismatch-operation condition)
                     (frame-mismatch-expected condition)
                     (frame-mismatch-found condition))))
  (:documentation "Warned of when stamped transforms are multiplied whose frames do not fit
together.  As in CRAM this is no error: the product is returned all the same."))
