;;;; What can go wrong when plans are executed symbolically.

(in-package #:discrepancy-finder.symbolic-execution)

(define-condition symbolic-execution-error (error)
  ()
  (:documentation "Root of the errors of symbolic execution."))

(define-condition unsupported-form (symbolic-execution-error program-error)
  ((form :initarg :form :reader unsupported-form-form :documentation "The form, or its operator.")
   (reason :initarg :reason :reader unsupported-form-reason
           :documentation "Why it cannot be evaluated, as a string.")
   (position :initarg :position :initform nil :reader unsupported-form-position
             :documentation "Its source position, or NIL."))
  (:report (lambda (condition stream)
             (with-slots (form reason position) condition
               (let ((*print-length* 6) (*print-level* 3) (*print-pretty* nil))
                 (format stream "~@[~a: ~]The symbolic evaluator cannot evaluate ~s: ~a."
                         (and position (princ-to-string position)) form reason)))))
  (:documentation "Signaled when a plan contains a form that the symbolic evaluator does not
know."))

(define-condition nondeterministic-plan (symbolic-execution-error)
  ((plan :initarg :plan :reader nondeterministic-plan-plan :documentation "The plan's name.")
   (expected :initarg :expected :reader nondeterministic-plan-expected
             :documentation "The decision that was recorded, as a string.")
   (found :initarg :found :reader nondeterministic-plan-found
          :documentation "The decision that was met, as a string."))
  (:report (lambda (condition stream)
             (with-slots (plan expected found) condition
               (format stream "The plan ~(~a~) is not deterministic: run again, it met ~a where it ~
                               had met ~a."
                       plan found expected))))
  (:documentation "Signaled when a replay of a path meets another decision than the recorded one."))

(define-condition plan-broke (symbolic-execution-error)
  ((plan :initarg :plan :reader plan-broke-plan :documentation "The plan's name.")
   (error :initarg :error :reader plan-broke-error :documentation "The error."))
  (:report (lambda (condition stream)
             (let ((position (plan:plan-position (plan:find-plan (plan-broke-plan condition)))))
               (format stream "~@[~a: ~]the plan ~(~a~) ends in an error: ~a"
                       (and position (princ-to-string position)) (plan-broke-plan condition)
                       (source:condition-sentence (plan-broke-error condition))))))
  (:documentation "Signaled when a plan signals an error, not a failure, that it does not handle."))

(define-condition action-problem (symbolic-execution-error)
  ((designator :initarg :designator :reader action-problem-designator
               :documentation "The designator in question.")
   (reason :initarg :reason :reader action-problem-reason
           :documentation "What is wrong, as a string.")
   (plan :initarg :plan :initform nil :reader action-problem-plan
         :documentation "The name of the plan that performs it, or NIL.")
   (position :initarg :position :initform nil :reader action-problem-position
             :documentation "Where it is performed, a source position, or NIL."))
  (:report (lambda (condition stream)
             (format stream "~@[~a: ~]~a~@[ in the plan ~(~a~)~]: ~a."
                     (let ((position (action-problem-position condition)))
                       (and position (princ-to-string position)))
                     (action-problem-designator condition)
                     (action-problem-plan condition)
                     (action-problem-reason condition))))
  (:documentation "Signaled when an action binding cannot say what a designator means in its
theory."))

(defmethod source:self-explaining-p ((condition action-problem))
  (and (action-problem-position condition) t))

(define-condition invalid-trace (symbolic-execution-error)
  ((reason :initarg :reason :reader invalid-trace-reason
           :documentation "What is wrong, as a string."))
  (:report (lambda (condition stream)
             (format stream "This is no trace as JSON: ~a." (invalid-trace-reason condition))))
  (:documentation "Signaled when a JSON text is no trace, or none that its theory allows, and when a
trace cannot be written as JSON."))

(define-condition file-output-refused (symbolic-execution-error)
  ((file :initarg :file :reader file-output-refused-file :documentation "The file's name.")
   (plan :initarg :plan :reader file-output-refused-plan :documentation "The plan's name."))
  (:report (lambda (condition stream)
             (format stream "The plan ~(~a~) changes the file ~a; on each path it would do so ~
                             again, and that cannot be undone (:file-output t allows it)."
                     (file-output-refused-plan condition) (file-output-refused-file condition))))
  (:documentation "Signaled when a plan opens a file for output, renames or deletes one under
symbolic execution, unless :FILE-OUTPUT allows it."))

(define-condition unknown-argument-type (symbolic-execution-error)
  ((parameter :initarg :parameter :reader unknown-argument-type-parameter
              :documentation "The parameter, a symbol.")
   (type :initarg :type :reader unknown-argument-type-type :documentation "Its type, as given.")
   (sorts :initarg :sorts :reader unknown-argument-type-sorts
          :documentation "The names, keywords, of the theory's sorts."))
  (:report (lambda (condition stream)
             (with-slots (parameter type sorts) condition
               (format stream "The parameter ~(~a~) cannot be of type ~(~s~): it must be boolean, ~
                               integer, (integer low high), real, (real low high), ~
                               (member object ...)~:[~; or a sort of the theory,~:*~{ ~a~^,~}~]."
                       parameter type (mapcar #'ec:name-text sorts)))))
  (:documentation "Signaled when a symbolic argument of a plan has a type that is none."))

(define-condition domain-not-found (symbolic-execution-error)
  ((name :initarg :name :reader domain-not-found-name :documentation "The name in question.")
   (known :initarg :known :initform '() :reader domain-not-found-known
          :documentation "The names, strings, of domains that files in models/ define, or NIL."))
  (:report (lambda (condition stream)
             (format stream "There is no domain named ~(~a~)~@[; it would be defined by ~
                             define-abstraction, and the files in models/ define ~{~a~^, ~}~]."
                     (domain-not-found-name condition) (domain-not-found-known condition))))
  (:documentation "Signaled when a domain is asked for that was never defined."))

(define-condition coverage-not-recorded (symbolic-execution-error)
  ((plan :initarg :plan :reader coverage-not-recorded-plan :documentation "The plan's name."))
  (:report (lambda (condition stream)
             (format stream "The coverage of ~(~a~) was not recorded: explore it with :coverage t."
                     (coverage-not-recorded-plan condition))))
  (:documentation "Signaled when the coverage of an exploration is asked for that did not record
it."))
