;;;; Confidence rules: after each sample without a discrepancy, is that enough?
;;;;
;;;; A *parameter sample* is what the rules see of a projection: the vector of the continuous
;;;; initial parameters that were drawn, and the vector of the continuous final parameters that were
;;;; observed.  The *parameter region* is where initial parameters were drawn from, and where final
;;;; ones must lie so that the theory allows them.  A *rule* is an object that carries the
;;;; confidence asked for; its *verdict* is :CONFIDENT or :CONTINUE, and says why.
;;;;
;;;; CONFIDENCE-VERDICT is the entry point; a search that adds one sample after the other keeps them
;;;; as EVIDENCE and asks EVIDENCE-VERDICT.  A new rule is a class, a method on one of the two and a
;;;; call of REGISTER-CONFIDENCE-RULE.

(in-package #:discrepancy-finder.statistics)

(defstruct (parameter-sample (:constructor make-parameter-sample (initial final &key (blind-p t)))
                             (:copier nil))
  "The continuous initial and final parameters of one projection, vectors of double floats in SI
units.  Parameters that are the same by construction in all samples are left out; discrete ones,
too.  BLIND-P is false if earlier samples had a say in where it was drawn."
  (initial #() :type vector :read-only t)
  (final #() :type vector :read-only t)
  (blind-p t :type boolean :read-only t))

(defmethod print-object ((sample parameter-sample) stream)
  (print-unreadable-object (sample stream :type t)
    (format stream "~{~,3f~^ ~} -> ~{~,3f~^ ~}"
            (coerce (parameter-sample-initial sample) 'list)
            (coerce (parameter-sample-final sample) 'list))))

(defstruct (parameter-region (:constructor make-parameter-region (initial-bounds final-bounds))
                             (:copier nil))
  "For each initial and each final parameter of a sample, in the same order, its bounds: a cons
(MIN . MAX) of double floats in SI units.  The parameter is at least MIN and less than MAX."
  (initial-bounds #() :type vector :read-only t)
  (final-bounds #() :type vector :read-only t))

(defmethod print-object ((region parameter-region) stream)
  (flet ((bounds-list (bounds)
           (loop for (min . max) across bounds collect min collect max)))
    (print-unreadable-object (region stream :type t)
      (format stream "~{[~,3f, ~,3f[~^ ~} -> ~{[~,3f, ~,3f[~^ ~}"
              (bounds-list (parameter-region-initial-bounds region))
              (bounds-list (parameter-region-final-bounds region))))))

(defstruct (verdict (:constructor make-verdict
                        (status reason
                         &key count intervals coefficients sigma z freedom parts))
                    (:copier nil))
  "What a confidence rule says about some samples."
  (status :continue :type (member :confident :continue) :read-only t)
  (reason "" :type string :read-only t)
  (count 0 :type unsigned-byte :read-only t)
  (intervals '() :type list :read-only t)
  (coefficients '() :type list :read-only t)
  (sigma '() :type list :read-only t)
  (z nil :type (or null double-float) :read-only t)
  (freedom nil :type (or null integer) :read-only t)
  (parts '() :type list :read-only t))

(setf (documentation 'make-parameter-sample 'function)
      "Return the parameter sample with the vectors INITIAL and FINAL of double floats (SI units).
BLIND-P is false if earlier samples had a say in where it was drawn."
      (documentation 'parameter-sample-initial 'function)
      "Return the vector of the initial parameters that were drawn for a sample."
      (documentation 'parameter-sample-final 'function)
      "Return the vector of the final parameters that were observed in a sample."
      (documentation 'parameter-sample-blind-p 'function)
      "Return true if a sample was drawn without regard to earlier ones."
      (documentation 'make-parameter-region 'function)
      "Return the region with the vectors INITIAL-BOUNDS and FINAL-BOUNDS of conses (MIN . MAX)."
      (documentation 'parameter-region-initial-bounds 'function)
      "Return the vector of the bounds (MIN . MAX) from which initial parameters are drawn."
      (documentation 'parameter-region-final-bounds 'function)
      "Return the vector of the bounds (MIN . MAX) in which the theory wants final parameters."
      (documentation 'verdict-status 'function)
      "Return :CONFIDENT if the samples are enough for the rule, or :CONTINUE."
      (documentation 'verdict-reason 'function)
      "Return why, as one clause for people, without a capital letter and a full stop."
      (documentation 'verdict-count 'function)
      "Return the number of samples that the verdict rests on."
      (documentation 'verdict-intervals 'function)
      "Return the list of the predicted intervals (LOWER . UPPER), one for each final parameter;
NIL if the samples do not suffice to predict."
      (documentation 'verdict-coefficients 'function)
      "Return the list of the vectors of coefficients, one for each final parameter, or NIL."
      (documentation 'verdict-sigma 'function)
      "Return the list of the rule's measures of spread, one for each final parameter, or NIL."
      (documentation 'verdict-z 'function)
      "Return the quantile that was used, or NIL."
      (documentation 'verdict-freedom 'function)
      "Return the residual degrees of freedom, samples less columns, of a verdict that rests on a
regression, else NIL."
      (documentation 'verdict-parts 'function)
      "Return an association list from the numbers of the parts of mixed evidence to the verdicts on
them, where a verdict rests on predictions from several parts; else NIL.")

(defmethod print-object ((verdict verdict) stream)
  (print-unreadable-object (verdict stream :type t)
    (format stream "~(~a~): ~a" (verdict-status verdict) (verdict-reason verdict))))

;;; Rules

(defclass confidence-rule ()
  ((confidence :initarg :confidence :initform 0.95d0 :reader confidence-rule-confidence
               :documentation "The confidence asked for, a double float in ]0, 1[."))
  (:documentation "The superclass of all confidence rules."))

(setf (documentation 'confidence-rule-confidence 'function)
      "Return the confidence that a rule asks for, a double float in ]0, 1[.")

(defmethod initialize-instance :after ((rule confidence-rule) &key)
  (let ((value (slot-value rule 'confidence)))
    (unless (and (realp value) (< 0 value 1))
      (error 'invalid-confidence :value value))
    (setf (slot-value rule 'confidence) (decimal-double value))))

(defmethod print-object ((rule confidence-rule) stream)
  (print-unreadable-object (rule stream :type t)
    (format stream "~a" (confidence-rule-confidence rule))))

(defgeneric confidence-verdict (rule samples region)
  (:documentation "Return the VERDICT of the confidence RULE on SAMPLES, a sequence of
PARAMETER-SAMPLEs in the order of their indices, none of them a discrepancy, that were drawn from
the PARAMETER-REGION REGION.")
  (:method (rule samples region)
    (let ((evidence (make-evidence region)))
      (map nil (lambda (sample) (add-sample evidence sample)) samples)
      (evidence-verdict rule evidence))))

(defgeneric evidence-verdict (rule evidence)
  (:documentation "Return the VERDICT of the confidence RULE on the samples in EVIDENCE, as
CONFIDENCE-VERDICT, at a cost that does not depend on how many there are."))

(defgeneric rule-for-trace (rule number)
  (:documentation "Return the rule that stands for RULE in the trace with NUMBER (from 1) of a
search.  Rules with a guarantee spend alpha/(NUMBER (NUMBER + 1)) on it, so that the guarantee holds
for all traces jointly; others stay what they are.")
  (:method (rule number)
    (declare (ignore number))
    rule))

(defvar *confidence-rules* '()
  "Association list from keywords to the names of subclasses of CONFIDENCE-RULE.")

(defun register-confidence-rule (name class)
  "Let the keyword NAME stand for the subclass of CONFIDENCE-RULE named CLASS.  Return NAME."
  (setf *confidence-rules* (acons name class (remove name *confidence-rules* :key #'car)))
  name)

(defun make-confidence-rule (name &rest arguments &key &allow-other-keys)
  "Return a new confidence rule of the kind that the keyword NAME stands for, such as :PAPER.
ARGUMENTS are those of the rule's class, which passes over others; all rules take :CONFIDENCE, a
real number in ]0, 1[ that defaults to 0.95.  Signal UNKNOWN-CONFIDENCE-RULE or INVALID-CONFIDENCE."
  (let ((entry (assoc name *confidence-rules*)))
    (unless entry
      (error 'unknown-confidence-rule
             :name name :known (sort (mapcar #'car *confidence-rules*) #'string<)))
    (apply #'make-instance (cdr entry) :allow-other-keys t arguments)))
