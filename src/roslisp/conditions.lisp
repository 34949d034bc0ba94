;;;; Conditions of the roslisp layer.

(in-package #:discrepancy-finder.roslisp)

(define-condition roslisp-error (error)
  ()
  (:documentation "Root of the errors in the use of this layer."))

(define-condition malformed-log-call (roslisp-error)
  ((form :initarg :form :reader malformed-log-call-form
         :documentation "The form that is not well-formed."))
  (:report (lambda (condition stream)
             (let ((*print-pretty* nil) (*print-length* 8) (*print-level* 4))
               (format stream "In ~s, an optional name, an optional condition, a format string and ~
                               its arguments were expected."
                       (malformed-log-call-form condition)))))
  (:documentation "Signaled when a call of ROS-INFO or the like is expanded that has no format
string."))

(define-condition unknown-debug-level (roslisp-error)
  ((level :initarg :level :reader unknown-debug-level-level
          :documentation "What was given for a level."))
  (:report (lambda (condition stream)
             (let ((*print-pretty* nil))
               (format stream "~s is no debug level; these are :debug, :info, :warn, :error and ~
                               :fatal."
                       (unknown-debug-level-level condition)))))
  (:documentation "Signaled by SET-DEBUG-LEVEL."))

(define-condition not-a-function (roslisp-error)
  ((value :initarg :value :reader not-a-function-value
          :documentation "What was given for a function."))
  (:report (lambda (condition stream)
             (let ((*print-pretty* nil))
               (format stream "~s cannot be registered: a function or the name of one was expected."
                       (not-a-function-value condition)))))
  (:documentation "Signaled when something is registered that cannot be called."))
