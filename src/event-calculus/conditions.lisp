;;;; What can be wrong with a theory, or with a question to it.

(in-package #:discrepancy-finder.event-calculus)

(defvar *exact-names* nil
  "True if names are to be shown by their characters, as .e files have them.")

(define-condition event-calculus-error (error)
  ()
  (:documentation "Root of the errors in theories and in questions to them."))

(define-condition theory-error (event-calculus-error)
  ((theory :initarg :theory :reader theory-error-theory :documentation "The theory's name.")
   (axiom :initarg :axiom :initform nil :reader theory-error-axiom
          :documentation "What is wrong within the theory, as a string such as \"axiom
move-leaves\", or NIL.")
   (form :initarg :form :initform nil :reader theory-error-form
         :documentation "The sub-form to blame, or NIL.")
   (reason :initarg :reason :reader theory-error-reason
           :documentation "What is wrong, as a string without a full stop.")
   (position :initarg :position :initform nil :reader theory-error-position
             :documentation "The source position of sub-form, axiom or clause, or NIL.")
   (exact-names :initarg :exact-names :initform nil :reader theory-error-exact-names
                :documentation "True if the theory was read from a .e file, whose names have
upper and lower case."))
  (:report (lambda (condition stream)
             (with-slots (theory axiom form reason position exact-names) condition
               (let ((*exact-names* exact-names))
                 (format stream "~@[~a: ~]theory ~a~@[, ~a~]~@[, in ~a~]: ~a."
                         (and position (princ-to-string position))
                         (formula-text theory) axiom (and form (formula-text form)) reason)))))
  (:documentation "Signaled when a theory is not well-formed.  The report names file and line where
known, the axiom, the sub-form and what was expected."))

(defmethod source:self-explaining-p ((condition theory-error))
  (and (theory-error-position condition) t))

(define-condition theory-not-found (event-calculus-error)
  ((name :initarg :name :reader theory-not-found-name :documentation "The name in question."))
  (:report (lambda (condition stream)
             (format stream "There is no theory named ~a."
                     (formula-text (theory-not-found-name condition)))))
  (:documentation "Signaled when a theory is asked for that was never defined."))

(define-condition state-constraint-not-found (event-calculus-error)
  ((name :initarg :name :reader state-constraint-not-found-name
         :documentation "The name in question.")
   (theory :initarg :theory :reader state-constraint-not-found-theory
           :documentation "The theory that has no such constraint.")
   (known :initarg :known :initform '() :reader state-constraint-not-found-known
          :documentation "The names of the constraints that the theory has."))
  (:report (lambda (condition stream)
             (with-slots (name theory known) condition
               (format stream "Theory ~a has ~:[~:[no state constraint~;several state constraints, ~
                               so name one~]~;no state constraint named ~:*~a~*~]~@[: ~{~a~^, ~}~]."
                       (name-text theory) (and name (name-text name)) known
                       (mapcar #'name-text known)))))
  (:documentation "Signaled when a state constraint is asked for that was never defined."))

(define-condition unknown-atom (event-calculus-error)
  ((atom :initarg :atom :reader unknown-atom-atom :documentation "The ground atom, a list.")
   (kind :initarg :kind :reader unknown-atom-kind
         :documentation "What it should be: \"fluent\" or \"event\".")
   (theory :initarg :theory :reader unknown-atom-theory :documentation "The theory's name."))
  (:report (lambda (condition stream)
             (with-slots (atom kind theory) condition
               (format stream "~a is no ground ~a of theory ~a."
                       (if (stringp atom) atom (formula-text atom)) kind (name-text theory)))))
  (:documentation "Signaled when a ground fluent or event is named that the theory does not have."))

(define-condition no-horizon (event-calculus-error)
  ((theory :initarg :theory :reader no-horizon-theory :documentation "The theory's name.")
   (horizon :initarg :horizon :initform nil :reader no-horizon-horizon
            :documentation "What was given as the horizon, or NIL."))
  (:report (lambda (condition stream)
             (with-slots (theory horizon) condition
               (if horizon
                   (format stream "~s is no horizon: the last timepoint, or a list of the first ~
                                   and the last, was expected." horizon)
                   (format stream "Theory ~a says nothing of timepoints (:time first last), so a ~
                                   horizon must be given."
                           (name-text theory))))))
  (:documentation "Signaled when it is not known which timepoints a question is about."))

(define-condition undetermined (event-calculus-error)
  ((atom :initarg :atom :reader undetermined-atom :documentation "The ground atom, a list.")
   (kind :initarg :kind :reader undetermined-kind
         :documentation ":FLUENT, :RELEASED, :EVENT, :PREDICATE, :STATIC (a timeless atom), :NUMBER
or :NUMBER-RELEASED.")
   (time :initarg :time :reader undetermined-time :documentation "The timepoint, or NIL.")
   (theory :initarg :theory :reader undetermined-theory :documentation "The theory's name."))
  (:report (lambda (condition stream)
             (with-slots (atom kind time theory) condition
               (format stream "Theory ~a leaves open ~a~@[ at ~d~], and the state has no Z3 ~
                               context for a variable."
                       (name-text theory)
                       (format nil (ecase kind
                                     (:fluent "whether ~a holds")
                                     ((:released :number-released) "whether ~a is released")
                                     (:event "whether ~a happens")
                                     ((:predicate :static) "whether ~a is true")
                                     (:number "the number of ~a"))
                               (formula-text atom))
                       time))))
  (:documentation "Signaled when a state without a Z3 context is progressed to a state of which the
theory does not determine everything."))
