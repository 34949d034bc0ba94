(in-package #:discrepancy-finder.statistics)

(defun number-text (number)
  "Return the shortest decimal text of the real NUMBER, a string."
  (let ((*read-default-float-format* 'double-float))
    (princ-to-string (if (integerp number) number (decimal-double number)))))

(define-condition invalid-confidence (error)
  ((value :initarg :value :reader invalid-confidence-value
          :documentation "The object that was given as a confidence."))
  (:report (lambda (condition stream)
             (format stream "A confidence lies between 0 and 1, both excluded, which ~a does not."
                     (let ((value (invalid-confidence-value condition)))
                       (if (realp value) (number-text value) value)))))
  (:documentation "Signaled when a confidence rule is made with a confidence that is not a real
number between 0 and 1."))

(define-condition unknown-confidence-rule (error)
  ((name :initarg :name :reader unknown-confidence-rule-name
         :documentation "The object that was given as the name of a rule.")
   (known :initarg :known :reader unknown-confidence-rule-known
          :documentation "The list of the names of all rules, sorted."))
  (:report (lambda (condition stream)
             (format stream "There is no confidence rule ~(~a~); there is ~{~(~a~)~^, ~}."
                     (unknown-confidence-rule-name condition)
                     (unknown-confidence-rule-known condition))))
  (:documentation "Signaled when a confidence rule is sought by a name that no rule has."))

(define-condition invalid-delta (error)
  ((value :initarg :value :reader invalid-delta-value
          :documentation "The object that was given as a part of the region."))
  (:report (lambda (condition stream)
             (format stream "A part of the initial region lies between 0 and 1, both excluded, ~
                             which ~a does not."
                     (let ((value (invalid-delta-value condition)))
                       (if (realp value) (number-text value) value)))))
  (:documentation "Signaled when a confidence rule is made with a delta that is not a real number
between 0 and 1."))
