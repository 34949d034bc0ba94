;;;; Conditions of the search, but for those of the statistics (statistics-conditions.lisp).

(in-package #:discrepancy-finder.discrepancy)

(define-condition discrepancy-error (error)
  ()
  (:documentation "Root of the errors in domains, samples and replay files."))

(define-condition abstraction-error (discrepancy-error)
  ((name :initarg :name :reader abstraction-error-name :documentation "The abstraction's name.")
   (clause :initarg :clause :initform nil :reader abstraction-error-clause
           :documentation "The clause to blame, or NIL.")
   (reason :initarg :reason :reader abstraction-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (with-slots (name clause reason) condition
               (format stream "abstraction ~a~@[, in ~a~]: ~a." (ec:name-text name)
                       (and clause (ec:formula-text clause)) reason))))
  (:documentation "Signaled when an abstraction is not well-formed."))

(define-condition sampling-error (discrepancy-error)
  ((trace :initarg :trace :reader sampling-error-trace :documentation "The trace.")
   (reason :initarg :reason :reader sampling-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "No initial state can be sampled for ~a: ~a."
                     (sampling-error-trace condition) (sampling-error-reason condition))))
  (:documentation "Signaled when a trace's discrete initial state has no continuous ones."))

(define-condition replay-error (discrepancy-error)
  ((file :initarg :file :reader replay-error-file :documentation "The file.")
   (reason :initarg :reason :reader replay-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "~a: ~a." (replay-error-file condition)
                     (string-right-trim "." (replay-error-reason condition)))))
  (:documentation "Signaled when a replay file is missing, malformed, or does not fit its plan and
domain."))

(define-condition journal-error (discrepancy-error)
  ((file :initarg :file :reader journal-error-file :documentation "The file.")
   (reason :initarg :reason :reader journal-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "~a: ~a." (journal-error-file condition)
                     (journal-error-reason condition))))
  (:documentation "Signaled when the journal of a search is malformed, cannot be written, or is one
of another search."))

(define-condition invalid-argument (discrepancy-error)
  ((name :initarg :name :reader invalid-argument-name :documentation "The argument's name.")
   (value :initarg :value :reader invalid-argument-value :documentation "What was given.")
   (expected :initarg :expected :reader invalid-argument-expected
             :documentation "What was expected, as a string.")
   (reason :initarg :reason :initform nil
           :documentation "A clause in lower case that says more plainly what is wrong, or NIL."))
  (:report (lambda (condition stream)
             (with-slots (name value expected reason) condition
               (if reason
                   (format stream "~@(~a~)." reason)
                   (format stream "~(~a~) is ~s where ~a was expected." name value expected)))))
  (:documentation "Signaled when a search is asked for with an impossible argument."))

(define-condition discrepancy-found (condition)
  ((discrepancy :initarg :discrepancy :reader discrepancy-found-discrepancy
                :documentation "The DISCREPANCY."))
  (:report (lambda (condition stream)
             (format stream "Theory and simulation part at ~a."
                     (discrepancy-summary (discrepancy-found-discrepancy condition)))))
  (:documentation "Signaled by FIND-DISCREPANCIES with :on-discrepancy :signal, with the restarts
CONTINUE-SEARCH, NEXT-TRACE and ACCEPT."))
