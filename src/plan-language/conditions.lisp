;;;; Conditions about plans as programs.  Failures, which plans signal and handle while they run,
;;;; stand in failures.lisp.

(in-package #:discrepancy-finder.plan-language)

(define-condition plan-error (error)
  ()
  (:documentation "Root of the errors in the use of the plan language."))

(define-condition plan-not-found (plan-error)
  ((name :initarg :name :reader plan-not-found-name
         :documentation "The name for which there is no plan."))
  (:report (lambda (condition stream)
             (format stream "There is no plan named ~(~a~); it would be defined by ~
                             def-top-level-cram-function or def-cram-function."
                     (plan-not-found-name condition))))
  (:documentation "Signaled when a plan is asked for that was never defined."))

(define-condition malformed-plan-form (plan-error)
  ((form :initarg :form :reader malformed-plan-form-form
         :documentation "The form that is not well-formed.")
   (expected :initarg :expected :reader malformed-plan-form-expected
             :documentation "What was expected, as a string."))
  (:report (lambda (condition stream)
             (let ((*print-pretty* nil) (*print-length* 8) (*print-level* 4))
               (format stream "In ~s, ~a was expected."
                       (malformed-plan-form-form condition)
                       (malformed-plan-form-expected condition)))))
  (:documentation "Signaled when a form of the plan language is expanded that is not well-formed."))

(define-condition nested-top-level (plan-error)
  ()
  (:report "top-level calls cannot be nested.")
  (:documentation "Signaled when a top-level is entered while another one runs."))

(define-condition no-executive (plan-error)
  ((designator :initarg :designator :reader no-executive-designator
               :documentation "The designator that was to be performed."))
  (:report (lambda (condition stream)
             (format stream "~a cannot be performed here: nothing executes plans; use run-plan or ~
                             with-executive."
                     (no-executive-designator condition))))
  (:documentation "Signaled by PERFORM outside of any executive."))

(define-condition designator-not-understood (plan-error)
  ((designator :initarg :designator :reader designator-not-understood-designator
               :documentation "The designator in question.")
   (executive :initarg :executive :reader designator-not-understood-executive
              :documentation "Who was to perform it.")
   (reason :initarg :reason :reader designator-not-understood-reason
           :documentation "Why it is not understood, as a string."))
  (:report (lambda (condition stream)
             (format stream "~a does not understand ~a: ~a."
                     (designator-not-understood-executive condition)
                     (designator-not-understood-designator condition)
                     (designator-not-understood-reason condition))))
  (:documentation "Signaled when an executive is asked to perform a designator that it cannot
interpret."))
