;;;; What can be wrong with a question.

(in-package #:discrepancy-finder.event-calculus)

(define-condition outside-horizon (event-calculus-error)
  ((time :initarg :time :reader outside-horizon-time :documentation "The timepoint, an integer.")
   (horizon :initarg :horizon :reader outside-horizon-horizon
            :documentation "(first . last), the timepoints in question.")
   (event :initarg :event :initform nil :reader outside-horizon-event
          :documentation "The event that is asked about, or NIL."))
  (:report (lambda (condition stream)
             (with-slots (time horizon event) condition
               (if (and event (eql time (cdr horizon)))
                   (format stream "No event happens at the last timepoint, ~d: to ask about ~a ~
                                   there give a longer horizon." time (formula-text event))
                   (format stream "Timepoint ~d lies outside of the horizon ~d to ~d."
                           time (car horizon) (cdr horizon))))))
  (:documentation "Signaled when a question names a timepoint that a reasoner says nothing about."))

(define-condition closed-reasoner (event-calculus-error)
  ((theory :initarg :theory :reader closed-reasoner-theory :documentation "The theory's name."))
  (:report (lambda (condition stream)
             (format stream "The reasoner of theory ~a is closed."
                     (name-text (closed-reasoner-theory condition)))))
  (:documentation "Signaled when a reasoner is asked after CLOSE-REASONER."))
