;;;; Evidence: the samples that a rule has seen, in a form that does not grow.
;;;;
;;;; Only blind samples are evidence for a rule: a sample that was drawn where a discrepancy seemed
;;;; likely says nothing about how much of the region is free of them.  The others are counted.

(in-package #:discrepancy-finder.statistics)

(defstruct (evidence (:constructor nil) (:copier nil))
  "What samples have shown: BLIND counts the blind ones, TARGETED the others."
  (blind 0 :type (integer 0))
  (targeted 0 :type (integer 0)))

(defstruct (region-evidence (:include evidence)
                            (:constructor %make-evidence (region regression lowest highest))
                            (:conc-name evidence-)
                            (:copier nil))
  "What samples from REGION have shown."
  (region nil :type parameter-region :read-only t)
  (regression nil :type regression :read-only t)
  (lowest #() :type simple-vector :read-only t)
  (highest #() :type simple-vector :read-only t))

(setf (documentation 'evidence-blind 'function)
      "Return the number of the blind samples in EVIDENCE."
      (documentation 'evidence-targeted 'function)
      "Return the number of the samples in EVIDENCE that are not blind, and count for no rule.")

(defmethod print-object ((evidence evidence) stream)
  (print-unreadable-object (evidence stream :type t)
    (format stream "~d blind, ~d targeted" (evidence-blind evidence)
            (evidence-targeted evidence))))

(defun make-evidence (region)
  "Return EVIDENCE of samples from the PARAMETER-REGION REGION, still without any."
  (let ((outputs (length (parameter-region-final-bounds region))))
    (%make-evidence region
                    (make-regression (length (parameter-region-initial-bounds region)) outputs)
                    (make-array outputs :initial-element nil)
                    (make-array outputs :initial-element nil))))

(defgeneric add-sample (evidence sample &optional part)
  (:documentation "Add the PARAMETER-SAMPLE SAMPLE, which is no discrepancy, to EVIDENCE, if that is
mixed to the part with the number PART, from 0; return EVIDENCE."))

(defmethod add-sample ((evidence region-evidence) sample &optional part)
  (declare (ignore part))
  (cond ((parameter-sample-blind-p sample)
         (incf (evidence-blind evidence))
         (add-observation (evidence-regression evidence) (parameter-sample-initial sample)
                          (parameter-sample-final sample))
         (loop for value across (parameter-sample-final sample)
               for index from 0
               do (symbol-macrolet ((lowest (svref (evidence-lowest evidence) index))
                                    (highest (svref (evidence-highest evidence) index)))
                    (setf lowest (if lowest (min lowest value) value)
                          highest (if highest (max highest value) value)))))
        (t (incf (evidence-targeted evidence))))
  evidence)

(defun observed-intervals (evidence)
  "Return the list of the intervals (LOWER . UPPER) of the final parameters that were observed."
  (map 'list #'cons (evidence-lowest evidence) (evidence-highest evidence)))
