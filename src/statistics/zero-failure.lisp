;;;; The confidence rule :ZERO-FAILURE: enough blind samples, none of them a discrepancy.
;;;;
;;;; If more than the part delta of the initial region were discrepant, s independent samples would
;;;; all miss it with probability at most (1 - delta)^s.  So after
;;;;
;;;;   N(alpha, delta) = ceiling(ln alpha / ln(1 - delta))
;;;;
;;;; samples without a discrepancy at most the part delta is discrepant, with confidence 1 - alpha
;;;; (Clopper and Pearson's bound for no failure).  N is fixed in advance, so that asking after each
;;;; sample costs nothing, and nothing is assumed about the simulation.

(in-package #:discrepancy-finder.statistics)

(defclass guaranteed-rule (confidence-rule)
  ((asked :initarg :asked :reader rule-asked
          :documentation "The confidence asked for the whole search; the slot CONFIDENCE is what
this trace needs."))
  (:documentation "A rule whose verdict is true with the confidence asked for, in all traces of a
search jointly."))

(defmethod initialize-instance :after ((rule guaranteed-rule) &key)
  (unless (slot-boundp rule 'asked)
    (setf (slot-value rule 'asked) (confidence-rule-confidence rule))))

(defun rule-alpha (rule)
  (- 1 (confidence-rule-confidence rule)))

(defun alpha-share (rule number)
  "Return the confidence that leaves trace NUMBER its share alpha/(NUMBER (NUMBER + 1))."
  (- 1 (/ (- 1 (rule-asked rule)) (* number (1+ number)))))

(defun zero-failure-count (confidence delta)
  "Return the least number of samples without a discrepancy after which at most the part DELTA of
their region is discrepant, with CONFIDENCE; both are double floats in ]0, 1[."
  ;; A quotient that is whole but for rounding is that number.
  (max 1 (ceiling (- (/ (log (- 1 confidence)) (log1p (- delta))) 1d-9))))

(defun zero-failure-bound (count confidence)
  "Return the part of the region that is discrepant at most, with CONFIDENCE, after COUNT samples
without a discrepancy: 1 - alpha^(1/COUNT); 1 for no samples."
  (if (zerop count)
      1d0
      (- (expm1 (/ (log (- 1 confidence)) count)))))

(defun percent-text (fraction)
  "Return FRACTION in percent, rounded to six digits."
  (let ((percent (/ (round (* (rational fraction) 100000000)) 1000000)))
    (format nil "~a %" (number-text (if (integerp percent) percent (float percent 1d0))))))

(defclass zero-failure-rule (guaranteed-rule)
  ((delta :initarg :delta :initform 0.05d0 :reader rule-delta
          :documentation "The part of the initial region that may be discrepant all the same."))
  (:documentation "The rule that counts: enough blind samples without a discrepancy."))

(register-confidence-rule :zero-failure 'zero-failure-rule)

(defmethod initialize-instance :after ((rule zero-failure-rule) &key)
  (let ((value (slot-value rule 'delta)))
    (unless (and (realp value) (< 0 value 1))
      (error 'invalid-delta :value value))
    (setf (slot-value rule 'delta) (decimal-double value))))

(defmethod rule-for-trace ((rule zero-failure-rule) number)
  (make-instance (class-of rule) :confidence (alpha-share rule number) :asked (rule-asked rule)
                                 :delta (rule-delta rule)))

(defmethod evidence-verdict ((rule zero-failure-rule) evidence)
  (let ((count (evidence-blind evidence))
        (wanted (zero-failure-count (confidence-rule-confidence rule) (rule-delta rule))))
    (if (< count wanted)
        (not-yet count "~d of ~d blind samples" count wanted)
        (make-verdict :confident
                      (format nil "~d blind simulation~:p without a discrepancy: at ~a confidence ~
                                   at most ~a of the initial region is discrepant"
                              count (percent-text (confidence-rule-confidence rule))
                              (percent-text (rule-delta rule)))
                      :count count))))
