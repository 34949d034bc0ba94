;;;; Sampling one trace: what is known of it so far, and what each run adds.
;;;;
;;;; A TRACE-SEARCH draws samples (targets.lisp says which), has them run, and keeps what the
;;;; confidence rule needs; besides, the first runs themselves, for those who explain a discrepancy.
;;;; What can be certified is what blind samples have shown: CONCLUDE tells it.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *rejection-limit* 200
  "So many rejected samples in a row mean that the trace cannot be sampled.")

(defparameter *repetition-limit* 50
  "A search that keeps going leaves a trace after so many finds of known kinds in a row.")

(defconstant +most-runs+ 1000
  "So many runs of a trace are kept.")

(defstruct (trace-search (:copier nil))
  "The sampling of a trace in progress, from its STARTS, by RULE.  FAILED counts the initial states
that cannot be sampled.  DISCREPANCIES are newest first; IN-A-ROW counts the rejected samples since
the last valid one, FINDS all discrepancies, REPEATED those of known kinds since the last agreement;
PENDING are the values (start initial . final) of the present ROUND of strata, RUNS conses
(run . judgement), both newest first; REASONS counts why samples were rejected."
  (search nil :read-only t)
  (trace nil :read-only t)
  (content 0 :type (unsigned-byte 64) :read-only t)
  (starts #() :type simple-vector :read-only t)
  (failed 0 :type (integer 0) :read-only t)
  (rule nil :read-only t)
  (evidence nil :read-only t)
  (targeting nil :read-only t)
  (drawn 0 :type (integer 0))
  (accepted 0 :type (integer 0))
  (rejected 0 :type (integer 0))
  (reasons (make-hash-table :test #'equal) :read-only t)
  (in-a-row 0 :type (integer 0))
  (repeated 0 :type (integer 0))
  (finds 0 :type (integer 0))
  (left 0 :type (integer 0))
  (round 0 :type (integer 0))
  (pending '() :type list)
  (run-count 0 :type (integer 0))
  (runs '() :type list)
  (void nil :type (or null string))
  (verdict nil)
  (discrepancies '() :type list))

(defun make-start-evidence (starts)
  "Return EVIDENCE of samples from STARTS, still without any."
  (if (= 1 (length starts))
      (make-evidence (start-region (svref starts 0)))
      (make-mixed-evidence (map 'list #'start-region starts))))

(defun begin-trace (search trace)
  "Return the TRACE-SEARCH for TRACE.  Signals SAMPLING-ERROR."
  (multiple-value-bind (starts failed) (starts-of (search-domain search) trace)
    (make-trace-search :search search :trace trace :starts starts :failed failed
                       :content (content-hash (symbolic:trace-text trace))
                       :rule (rule-for-trace (search-rule search)
                                             (1+ (length (search-results search))))
                       :evidence (make-start-evidence starts)
                       :targeting (and (search-targets search)
                                       (make-targeting (map 'list #'start-region starts))))))

(defun blind-draw (trace-search)
  (let* ((search (trace-search-search trace-search))
         (seed (search-seed search))
         (index (1- (incf (trace-search-drawn trace-search))))
         (start (pick-start (trace-search-starts trace-search) seed
                            (trace-search-content trace-search) index)))
    (make-draw (draw-sample (start-parameters start) seed (start-content start) index
                            :sampler (search-sampler search))
               :blind start)))

(defun targeted-draw (trace-search)
  (let* ((seed (search-seed (trace-search-search trace-search)))
         (targeting (trace-search-targeting trace-search))
         (index (next-target targeting))
         (start (pick-start (trace-search-starts trace-search) seed
                            (target-content (trace-search-content trace-search)) index)))
    (make-draw (target-sample (targeting-aim targeting (start-number start))
                              (start-parameters start) seed (start-content start) index)
               :targeted start)))

(defun next-draw (trace-search)
  "Return the next DRAW of TRACE-SEARCH."
  (ecase (next-origin (trace-search-targeting trace-search))
    (:blind (blind-draw trace-search))
    (:targeted (targeted-draw trace-search))))

;;; The end of a trace

(defun trace-confidence (trace-search)
  "Return the confidence that a guarantee for TRACE-SEARCH needs: trace i of a search gets
alpha/(i (i + 1))."
  (let ((number (1+ (length (search-results (trace-search-search trace-search)))))
        (alpha (- 1 (confidence-rule-confidence
                     (search-rule (trace-search-search trace-search))))))
    (- 1 (/ alpha (* number (1+ number))))))

(defun rule-warnings (trace-search)
  "Return the sentences that warn of what the rule has not asked for."
  (let* ((verdict (trace-search-verdict trace-search))
         (freedom (and verdict (verdict-freedom verdict)))
         (rule (trace-search-rule trace-search)))
    (and freedom (<= freedom 1) (typep rule 'paper-rule)
         (eq (verdict-status verdict) :confident)
         (list (format nil "The rule ~(~a~) has judged by ~d sample~:p with ~d residual degree~:p ~
                            of freedom: the spread of the residuals has no say in it, nor has the ~
                            confidence."
                       (search-rule-name (trace-search-search trace-search))
                       (verdict-count verdict) (max 0 freedom))))))

(defun start-warnings (trace-search)
  "Return the sentences that warn of initial states of which nothing is known."
  (let ((starts (trace-search-starts trace-search)) (failed (trace-search-failed trace-search)))
    (append
     (and (symbolic:trace-more-p (trace-search-trace trace-search))
          (list (format nil "The trace has more initial states than the ~d that were drawn from."
                        (length starts))))
     (and (plusp failed)
          (list (format nil "Of the trace's initial states ~d cannot be sampled." failed)))
     (loop for start across starts
           when (never-met-p start starts)
             collect (format nil "No sample of the initial state ~a was valid."
                             (state-text (ec:state-fluents (symbolic:trace-initial-state
                                                            (start-trace start)))))))))

(defun trace-warnings (trace-search)
  "Return the sentences that warn of what the verdict on TRACE-SEARCH does not show."
  (append (start-warnings trace-search) (rule-warnings trace-search)))

(defun conclude (trace-search status reason &optional stop)
  "Return the TRACE-RESULT of TRACE-SEARCH, and STOP: whether the whole search ends."
  (let ((evidence (trace-search-evidence trace-search)))
    (values (make-trace-result
             :trace (trace-search-trace trace-search) :reason reason
             :starts (coerce (trace-search-starts trace-search) 'list)
             :status (if (plusp (trace-search-finds trace-search)) :discrepancy status)
             :verdict (trace-search-verdict trace-search)
             :confidence (trace-confidence trace-search)
             :blind (evidence-blind evidence)
             :targeted (+ (evidence-targeted evidence) (length (trace-search-pending trace-search)))
             :drawn (trace-search-drawn trace-search)
             :accepted (trace-search-accepted trace-search)
             :rejected (trace-search-rejected trace-search)
             :left-trace (trace-search-left trace-search)
             :void (trace-search-void trace-search)
             :runs (reverse (trace-search-runs trace-search))
             :warnings (trace-warnings trace-search)
             :discrepancies (reverse (trace-search-discrepancies trace-search)))
            stop)))

(defun conclude-early (trace-search reason)
  "Return what CONCLUDE returns where the whole search has to end because of REASON."
  (let ((verdict (trace-search-verdict trace-search)))
    (setf (search-stopped (trace-search-search trace-search)) reason)
    (conclude trace-search :undecided
              (format nil "~a~@[; ~a~]" reason (and verdict (verdict-reason verdict)))
              t)))

(defun conclude-certified (trace-search verdict)
  "Return what CONCLUDE returns where the rule is satisfied by VERDICT."
  (if (trace-search-void trace-search)
      (conclude trace-search :undecided
                (format nil "~a, so that there is no certificate" (trace-search-void trace-search)))
      (conclude trace-search :certified (verdict-reason verdict))))

;;; What a run adds

(defun keep-run (trace-search run judgement)
  (when (<= (incf (trace-search-run-count trace-search)) +most-runs+)
    (push (cons run judgement) (trace-search-runs trace-search))))

(defun void (trace-search control &rest arguments)
  "Note why TRACE-SEARCH can have no certificate; the first reason stays."
  (unless (trace-search-void trace-search)
    (setf (trace-search-void trace-search) (apply #'format nil control arguments))))

(defun reason-class (reason)
  "Return the text REASON with # for each number, so that equal reasons are counted as one."
  (with-output-to-string (stream)
    (loop with inside = nil
          for character across reason
          for number = (and (find character "0123456789.") t)
          do (cond ((not number) (write-char character stream))
                   ((not inside) (write-char #\# stream)))
             (setf inside number))))

(defun frequent-reason (trace-search)
  "Return why samples of TRACE-SEARCH were rejected most often."
  (let ((reason nil) (most 0))
    (maphash (lambda (class entry)
               (declare (ignore class))
               (when (> (car entry) most)
                 (setf most (car entry) reason (cdr entry))))
             (trace-search-reasons trace-search))
    reason))

(defun count-rejection (trace-search start)
  "Count a rejected sample of START; if it seems that none is valid, leave START out."
  (incf (start-rejected start))
  (when (never-met-p start (trace-search-starts trace-search))
    (leave-out-part (trace-search-evidence trace-search) (start-number start))))

(defun note-rejection (trace-search draw run)
  "Count the invalid RUN of DRAW; conclude if there were too many in a row."
  (let* ((reason (run-validity run))
         (class (reason-class reason))
         (reasons (trace-search-reasons trace-search)))
    (incf (trace-search-rejected trace-search))
    (count-rejection trace-search (drawn-start draw))
    ;; The example that is shown is the first one.
    (incf (car (or (gethash class reasons)
                   (setf (gethash class reasons) (cons 0 reason)))))
    (when (> (incf (trace-search-in-a-row trace-search)) *rejection-limit*)
      (conclude trace-search :skipped
                (if (zerop (trace-search-accepted trace-search))
                    (format nil "no valid initial state was found: all ~d samples were rejected, ~
                                 most of them like this: ~a"
                            (trace-search-rejected trace-search) (frequent-reason trace-search))
                    (format nil "~d samples in a row were rejected, most of them like this: ~a"
                            (trace-search-in-a-row trace-search)
                            (frequent-reason trace-search)))))))

(defun add-values (trace-search start initial final blind-p)
  "Add a sample of the start with the number START to the evidence of TRACE-SEARCH."
  (add-sample (trace-search-evidence trace-search)
              (make-parameter-sample initial final :blind-p blind-p)
              start))

(defun flush-round (trace-search blind-p)
  "Add the pending samples of TRACE-SEARCH to its evidence."
  (loop for (start initial . final) in (reverse (trace-search-pending trace-search))
        do (add-values trace-search start initial final blind-p))
  (setf (trace-search-pending trace-search) '()))

(defun add-blind-evidence (trace-search draw run)
  "Add RUN of DRAW, which was made without regard to others, to the evidence of TRACE-SEARCH: as a
blind sample if draws are independent, or if it is in a round of strata of which no sample was
lost."
  (let* ((sampler (search-sampler (trace-search-search trace-search)))
         (sample (drawn-sample draw))
         (round (floor (sample-index sample) +cells+)))
    (when (/= round (trace-search-round trace-search))
      (flush-round trace-search nil)
      (setf (trace-search-round trace-search) round))
    (push (list* (start-number (drawn-start draw)) (drawn-values sample) (run-final-values run))
          (trace-search-pending trace-search))
    (cond ((not (eq sampler :stratified)) (flush-round trace-search (eq sampler :independent)))
          ((= (length (trace-search-pending trace-search)) +cells+)
           (flush-round trace-search t)))))

(defun add-evidence (trace-search draw run)
  "Add RUN of DRAW, which the theory allows, to the evidence of TRACE-SEARCH."
  (let ((start (start-number (drawn-start draw)))
        (values (drawn-values (drawn-sample draw))))
    (if (drawn-blindly-p draw)
        (add-blind-evidence trace-search draw run)
        (add-values trace-search start values (run-final-values run) nil))
    (when (trace-search-targeting trace-search)
      (note-values (trace-search-targeting trace-search) start values (run-final-values run)))))

(defun predicted-inside-p (trace-search verdict)
  "Return true if what VERDICT predicts for each start lies in the regions that are no boxes, too."
  (loop for (number . predicted) in (or (verdict-parts verdict) (list (cons 0 verdict)))
        for start = (svref (trace-search-starts trace-search) number)
        always (inside-final-regions-p (start-outputs start) (verdict-intervals predicted)
                                       (start-resting start))))

(defun note-agreement (trace-search draw run)
  "Ask the confidence rule after RUN of DRAW, which the theory allows; conclude if it is satisfied."
  (setf (trace-search-repeated trace-search) 0)
  (add-evidence trace-search draw run)
  (let ((verdict (evidence-verdict (trace-search-rule trace-search)
                                   (trace-search-evidence trace-search))))
    (setf (trace-search-verdict trace-search) verdict)
    (when (and (eq (verdict-status verdict) :confident)
               (predicted-inside-p trace-search verdict))
      (conclude-certified trace-search verdict))))
