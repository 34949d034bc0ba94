;;;; What can be wrong with facts, goals and bindings.  Errors are mistakes in the form of a fact or
;;;; goal; what CRAM prints and goes on with is a warning here.

(in-package #:discrepancy-finder.prolog)

(defun one-line (text)
  "Return TEXT with every run of white space made one space."
  (with-output-to-string (out)
    (let ((between nil))
      (loop for character across text
            do (cond ((member character '(#\Space #\Newline #\Tab)) (setf between t))
                     (t (when between (write-char #\Space out))
                        (setf between nil)
                        (write-char character out)))))))

(defun goal-text (goal)
  "Return GOAL as one line of text, shortened."
  (let ((*print-length* 12) (*print-level* 5) (*print-pretty* nil) (*print-case* :downcase))
    (one-line (prin1-to-string goal))))

(define-condition malformed-fact (error)
  ((group :initarg :group :reader malformed-fact-group
          :documentation "The name of the fact group, or NIL outside of any.")
   (form :initarg :form :reader malformed-fact-form
         :documentation "The form that is no fact.")
   (reason :initarg :reason :reader malformed-fact-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "~a ~:[outside of any fact group~*~;in the fact group ~(~a~)~]: ~a."
                     (goal-text (malformed-fact-form condition))
                     (malformed-fact-group condition) (malformed-fact-group condition)
                     (malformed-fact-reason condition))))
  (:documentation "Signaled when a form of DEF-FACT-GROUP is not (<- (predicate argument*)
goal*)."))

(define-condition malformed-goal (error)
  ((goal :initarg :goal :reader malformed-goal-goal
         :documentation "The goal, with the values of its variables.")
   (reason :initarg :reason :reader malformed-goal-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "The goal ~a cannot be proved: ~a."
                     (goal-text (malformed-goal-goal condition))
                     (malformed-goal-reason condition))))
  (:documentation "Signaled when a goal is not a list (predicate argument*) at the time of its proof
or has too few or too many arguments for a built-in predicate."))

(define-condition unknown-predicate (warning)
  ((goal :initarg :goal :reader unknown-predicate-goal
         :documentation "The goal, with the values of its variables.")
   (query :initarg :query :reader unknown-predicate-query
          :documentation "The query in whose proof the goal occurs.")
   (arities :initarg :arities :initform '() :reader unknown-predicate-arities
            :documentation "The numbers of arguments with which the predicate is known."))
  (:report (lambda (condition stream)
             (let ((goal (unknown-predicate-goal condition)))
               (format stream "No predicate ~(~s~) with ~d argument~:p is known~@[, only with ~
                               ~{~a~^, ~}~]; the goal ~a of the query ~a fails."
                       (first goal) (length (rest goal))
                       (unknown-predicate-arities condition)
                       (goal-text goal) (goal-text (unknown-predicate-query condition))))))
  (:documentation "Signaled as a warning when a goal has a predicate that no fact, built-in or list
of extendable predicates mentions; the goal fails."))

(define-condition predicate-not-extendable (style-warning)
  ((predicate :initarg :predicate :reader predicate-not-extendable-predicate
              :documentation "The name of the predicate.")
   (group :initarg :group :reader predicate-not-extendable-group
          :documentation "The name of the fact group that adds facts.")
   (other :initarg :other :reader predicate-not-extendable-other
          :documentation "The name of the fact group that has facts already, or NIL for a built-in
predicate, whose facts are never used."))
  (:report (lambda (condition stream)
             (format stream "The fact group ~(~a~) adds facts to the predicate ~(~s~), ~
                             ~:[which is built in~*~;which the fact group ~(~a~) defines and ~
                             no fact group declares extendable~]."
                     (predicate-not-extendable-group condition)
                     (predicate-not-extendable-predicate condition)
                     (predicate-not-extendable-other condition)
                     (predicate-not-extendable-other condition))))
  (:documentation "Signaled as a warning when a second fact group defines a predicate that none
lists as extendable.  The facts are added nevertheless, as in CRAM."))

(define-condition lisp-error-in-goal (warning)
  ((goal :initarg :goal :reader lisp-error-in-goal-goal
         :documentation "The goal, with the values of its variables.")
   (error :initarg :error :reader lisp-error-in-goal-error
          :documentation "The error that the Lisp function signaled."))
  (:report (lambda (condition stream)
             (format stream "~a failed by an error: ~a"
                     (goal-text (lisp-error-in-goal-goal condition))
                     (one-line (princ-to-string (lisp-error-in-goal-error condition))))))
  (:documentation "Signaled as a warning when the Lisp function that a goal calls signals an error
and *BREAK-ON-LISP-ERRORS* is false; the goal fails."))

(define-condition variable-not-bound (error)
  ((variable :initarg :variable :reader variable-not-bound-variable
             :documentation "The Prolog variable."))
  (:report (lambda (condition stream)
             (format stream "The variable ~(~s~) has no value."
                     (variable-not-bound-variable condition))))
  (:documentation "Signaled by WITH-VARS-STRICTLY-BOUND for a variable that has no value."))
