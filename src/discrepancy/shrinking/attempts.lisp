;;;; Attempts: is the discrepancy still there in a smaller case?
;;;;
;;;; A SHRINKER holds the smallest discrepancy so far, BEST.  ATTEMPT runs a case that differs from
;;;; it in the sample, the actions or the items, and says what came of it:
;;;;   :SAME     a discrepancy of the same kind (the discrepancy is the second value)
;;;;   :PASSING  what the trace says
;;;;   :OTHER    something else: the case is not valid, leaves the trace, or has another discrepancy
;;;;   :UNKNOWN  the runs or the seconds are used up, or the theory does not know the case
;;;; No case is run twice.

(in-package #:discrepancy-finder.discrepancy)

(defclass shrinker ()
  ((original :initarg :original :reader shrinker-original)
   (best :initarg :best :accessor shrinker-best)
   (kind :initarg :kind :reader shrinker-kind)
   (context :initarg :context :reader shrinker-context :documentation "A Z3 context.")
   (memory :initform (make-memory) :reader shrinker-memory)
   (max-runs :initarg :max-runs :reader shrinker-max-runs)
   (deadline :initarg :deadline :reader shrinker-deadline)
   (runs :initform 0 :accessor shrinker-runs)
   (exhausted :initform nil :accessor shrinker-exhausted
              :documentation "What was used up, as a text, or NIL.")
   (witnesses :initform '() :accessor shrinker-witnesses
              :documentation "Samples that pass and have to go on passing.")
   (known :initform (make-hash-table :test 'equal) :reader shrinker-known
          :documentation "What came of the cases that were run."))
  (:documentation "The shrinking of a discrepancy in progress."))

(defun exhausted-p (shrinker)
  "Return true if SHRINKER may not run anything more, and note why."
  (or (shrinker-exhausted shrinker)
      (setf (shrinker-exhausted shrinker)
            (cond ((>= (shrinker-runs shrinker) (shrinker-max-runs shrinker))
                   (format nil "after ~d runs" (shrinker-runs shrinker)))
                  ((> (foreign:monotonic-seconds) (shrinker-deadline shrinker))
                   "when its time was over")))))

(defun variation (best &key (domain (discrepancy-domain best)) (trace (discrepancy-trace best))
                         (actions (discrepancy-actions best))
                         (left-out (discrepancy-left-out best))
                         (sample (discrepancy-sample best))
                         run judgement confirmed-p)
  "Return a discrepancy like BEST but for the other arguments."
  (make-discrepancy :plan (discrepancy-plan best) :domain domain
                    :constraint (discrepancy-constraint best)
                    :parameters (discrepancy-parameters best)
                    :execution (discrepancy-execution best) :compare (discrepancy-compare best)
                    :seed (discrepancy-seed best) :origin (discrepancy-origin best)
                    :trace trace :sample sample :actions actions :left-out left-out
                    :run run :judgement judgement :confirmed-p confirmed-p))

(defun run-case (discrepancy &key (sample (discrepancy-sample discrepancy)) (fidelity :fast)
                               observer)
  "Run the plan or the actions of DISCREPANCY from SAMPLE and return the RUN.  FIDELITY and OBSERVER
are as for EXECUTE-SAMPLE."
  (execute-sample (discrepancy-domain discrepancy)
                  (plan:plan-name (discrepancy-plan discrepancy)) sample
                  :trace (discrepancy-trace discrepancy)
                  :execution (discrepancy-execution discrepancy)
                  :arguments (symbolic:trace-arguments (discrepancy-trace discrepancy))
                  :actions (discrepancy-actions discrepancy)
                  :fidelity fidelity :observer observer))

(defun performed-trace (trace run)
  "Return TRACE with the designators as RUN has performed them: what was detected is where it was
this time."
  (let ((performed (mapcar #'run-step-designator (run-steps run))))
    (symbolic:make-execution-trace
     :plan (symbolic:trace-plan trace) :arguments (symbolic:trace-arguments trace)
     :states (symbolic:trace-states trace)
     :steps (loop for step in (symbolic:trace-steps trace)
                  collect (symbolic:make-trace-step
                           :designator (if performed
                                           (princ-to-string (pop performed))
                                           (symbolic:step-designator step))
                           :event (symbolic:step-event step)
                           :outcome (symbolic:step-outcome step)
                           :position (symbolic:step-position step))))))

(defun same-kind (shrinker case run judgement)
  "Return CASE with its RUN and JUDGEMENT if it is a discrepancy of the kind of SHRINKER, else NIL."
  (let* ((trace (discrepancy-trace case))
         (found (variation case :run run :judgement judgement
                                :trace (if (discrepancy-actions case)
                                           (performed-trace trace run)
                                           trace))))
    (and (equal (discrepancy-kind found) (shrinker-kind shrinker))
         found)))

(defun judged-case (shrinker case)
  "Run CASE, a discrepancy without a run, and return what came of it and the discrepancy or NIL."
  (let ((run (progn (incf (shrinker-runs shrinker)) (run-case case))))
    (if (or (not (eq (run-validity run) :valid)) (eq (run-ending run) :too-many-steps))
        (values :other nil)
        (let ((judgement (judge-run (discrepancy-domain case) run (discrepancy-trace case)
                                    :context (shrinker-context shrinker)
                                    :memory (shrinker-memory shrinker)
                                    :compare (discrepancy-compare case)
                                    :comparison (discrepancy-comparison
                                                 (shrinker-original shrinker)))))
          (ecase (judgement-verdict judgement)
            (:left-trace (values :other nil))
            (:consistent (values :passing nil))
            (:discrepancy
             (let ((found (same-kind shrinker case run judgement)))
               (if found
                   (values :same found)
                   (values :other nil)))))))))

(defun attempt (shrinker &rest changes)
  "Run what differs from the best case of SHRINKER by CHANGES, arguments of VARIATION, and return
what came of it, as the head of this file says, and the discrepancy if it is the same."
  (let* ((case (apply #'variation (shrinker-best shrinker) changes))
         (key (list (discrepancy-left-out case) (discrepancy-actions case)
                    (coerce (sample-values (discrepancy-sample case)) 'list)))
         (known (gethash key (shrinker-known shrinker))))
    (cond (known (values-list known))
          ((exhausted-p shrinker) :unknown)
          (t (values-list (setf (gethash key (shrinker-known shrinker))
                                (multiple-value-list (judged-case shrinker case))))))))

(defun restricted-sample (sample parameters)
  "Return SAMPLE for PARAMETERS, which are some of its own."
  (make-sample (sample-index sample) parameters
               (coerce (loop for parameter in parameters
                             collect (loop for own in (sample-parameters sample)
                                           for value across (sample-values sample)
                                           when (string= (parameter-name own)
                                                         (parameter-name parameter))
                                             return value))
                       '(simple-array double-float (*)))))

(defun witnesses-pass-p (shrinker discrepancy)
  "Return true if the witnesses of SHRINKER pass in the case of DISCREPANCY."
  (loop with parameters = (sample-parameters (discrepancy-sample discrepancy))
        for witness in (shrinker-witnesses shrinker)
        always (eq :passing
                   (attempt shrinker
                            :domain (discrepancy-domain discrepancy)
                            :trace (discrepancy-trace discrepancy)
                            :actions (discrepancy-actions discrepancy)
                            :left-out (discrepancy-left-out discrepancy)
                            :sample (restricted-sample witness parameters)))))

(defun improve-with-witnesses (shrinker &rest changes)
  "Attempt CHANGES, which leave something out; if the discrepancy is the same, and what passed with
the whole still passes, make it the best case and return true."
  (multiple-value-bind (came-of-it smaller) (apply #'attempt shrinker changes)
    (when (and (eq came-of-it :same) (witnesses-pass-p shrinker smaller))
      (setf (shrinker-best shrinker) smaller)
      t)))

(defun improve (shrinker &rest changes)
  "Attempt CHANGES; if the discrepancy is the same, make it the best case and return true."
  (multiple-value-bind (came-of-it smaller) (apply #'attempt shrinker changes)
    (when (eq came-of-it :same)
      (setf (shrinker-best shrinker) smaller)
      t)))

;;; Smaller lists

(defun window-sizes (length)
  "Return decreasing numbers from LENGTH to 1."
  (loop for size = length then (min (1- size) (floor (* 3 size) 4))
        while (plusp size) collect size))

(defun without-window (list start size)
  (append (subseq list 0 start) (nthcdr (+ start size) list)))

(defun without-some (list test size)
  "Return LIST without windows of SIZE elements, from the end on, wherever TEST is true of what is
left."
  (loop with start = (- (length list) size)
        while (>= start 0)
        do (let ((smaller (without-window list start size)))
             (if (funcall test smaller)
                 (setf list smaller
                       start (min start (- (length list) size)))
                 (decf start))))
  list)

(defun without-a-pair (list test)
  "Return LIST without two of its elements if TEST is true of what is left, or NIL."
  (loop for i from 0 below (length list)
        do (loop for j from (1+ i) below (length list)
                 for smaller = (without-window (without-window list j 1) i 1)
                 do (when (funcall test smaller)
                      (return-from without-a-pair (values smaller t))))))

(defun smallest-list (list test &key pairs)
  "Return a list made of LIST, for which TEST is true, by leaving out elements, so that TEST is true
of it and not of what is left when one more is left out (or, with PAIRS, two more).  Delta
debugging: windows of neighbours are left out, first large ones, then small ones."
  (dolist (size (window-sizes (length list)))
    (when (<= size (length list))
      (setf list (without-some list test size))))
  (loop
    (let ((smaller (without-some list test 1)))
      (multiple-value-bind (fewer found) (and pairs (= (length smaller) (length list))
                                              (without-a-pair smaller test))
        (cond (found (setf list fewer))
              ((= (length smaller) (length list)) (return list))
              (t (setf list smaller)))))))
