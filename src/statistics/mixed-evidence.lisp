;;;; Mixed evidence: samples from several regions, of which each sample draws one.
;;;;
;;;; Where a discrete choice is open each choice is a PART with a region of its own: other
;;;; parameters, other bounds.  Which part a sample is from is drawn blindly.  What counts blind
;;;; samples counts those of all parts; what predicts by a regression has one for each part, and is
;;;; satisfied if it is for each.  A part from which no sample is valid can be left out: nothing is
;;;; claimed of it.

(in-package #:discrepancy-finder.statistics)

(defstruct (mixed-evidence (:include evidence) (:constructor %make-mixed-evidence (parts))
                           (:copier nil))
  "What samples from several regions have shown: PARTS is the vector of what those from each have;
IN is the list of the numbers of those that are not left out."
  (parts #() :type simple-vector :read-only t)
  (in '() :type list))

(defun make-mixed-evidence (regions)
  "Return EVIDENCE of samples from the PARAMETER-REGIONs REGIONS, a list, still without any."
  (let ((evidence (%make-mixed-evidence (map 'simple-vector #'make-evidence regions))))
    (setf (mixed-evidence-in evidence)
          (loop for number below (length regions) collect number))
    evidence))

(defmethod add-sample ((evidence mixed-evidence) sample &optional (part 0))
  (if (parameter-sample-blind-p sample)
      (incf (evidence-blind evidence))
      (incf (evidence-targeted evidence)))
  (add-sample (svref (mixed-evidence-parts evidence) part) sample)
  ;; A part that was left out is met after all.
  (unless (member part (mixed-evidence-in evidence))
    (setf (mixed-evidence-in evidence) (sort (cons part (mixed-evidence-in evidence)) #'<)))
  evidence)

(defun leave-out-part (evidence part)
  "Let the part with the number PART, from which no sample is valid so far, have no say in EVIDENCE
until there is one."
  (setf (mixed-evidence-in evidence) (remove part (mixed-evidence-in evidence))))

(defgeneric rule-for-part (rule count)
  (:documentation "Return the rule that stands for RULE in each of COUNT parts of mixed evidence, so
that what it says of all of them holds as RULE would have it.")
  (:method (rule count)
    (declare (ignore count))
    rule))

(defmethod rule-for-part ((rule prediction-rule) count)
  (make-instance (class-of rule) :confidence (- 1 (/ (rule-alpha rule) count))
                                 :asked (rule-asked rule)))

(defmethod evidence-verdict (rule (evidence mixed-evidence))
  (let* ((in (mixed-evidence-in evidence))
         (rule (rule-for-part rule (max 1 (length in))))
         (verdicts (loop for part in in
                         collect (evidence-verdict rule (svref (mixed-evidence-parts evidence)
                                                               part))))
         (place (position :continue verdicts :key #'verdict-status))
         (count (evidence-blind evidence)))
    (cond ((null in) (not-yet count "no sample is valid"))
          (place
           (make-verdict :continue
                         (format nil "initial state ~d: ~a" (1+ (nth place in))
                                 (verdict-reason (nth place verdicts)))
                         :count count))
          (t
           (make-verdict :confident
                         (format nil "after ~d samples from ~d initial state~:p every final ~
                                      parameter is predicted inside its bounds, from each of them"
                                 count (length in))
                         :count count :parts (mapcar #'cons in verdicts))))))
