;;;; Statements: what a search has shown, in sentences that are true.
;;;;
;;;; Whatever the confidence rule says, the number of blind samples without a discrepancy supports a
;;;; statement of its own: with s of them at most 1 - a^(1/s) of the initial region is discrepant,
;;;; at confidence 1 - a.  This holds however it was decided when to stop: to claim a part below p
;;;; takes so many samples that a region of which p is discrepant would pass all of them with a
;;;; probability below a.  Trace i gets a = alpha/(i (i + 1)), so that the statements on all traces
;;;; hold jointly at confidence 1 - alpha.

(in-package #:discrepancy-finder.discrepancy)

(defun percent-text (fraction)
  "Return FRACTION in percent with as few digits as it has."
  (string-right-trim "." (string-right-trim "0" (format nil "~,6f" (* 100 fraction)))))

(defun bound-text (fraction)
  "Return FRACTION in percent, rounded up to a digit behind the point."
  (percent-text (/ (ceiling (* 1000 fraction)) 1000d0)))

(defun trace-result-bound (result)
  "Return the part of the initial region of the trace of RESULT that is discrepant at most, at
TRACE-RESULT-CONFIDENCE, or NIL if the samples tell nothing of it."
  (and (not (eq (trace-result-status result) :discrepancy))
       (null (trace-result-void result))
       (plusp (trace-result-blind result))
       (zero-failure-bound (trace-result-blind result) (trace-result-confidence result))))

(defun counts-text (blind all)
  (format nil "~d blind simulation~:p of ~d" blind all))

(defun part-text (result)
  "Return what part of the initial region of the trace of RESULT its samples tell of."
  (let ((starts (count-if #'plusp (trace-result-starts result) :key #'start-accepted)))
    (format nil (if (plusp (trace-result-left-trace result))
                    "the part of ~a from which the trace is followed"
                    "~a")
            (if (< 1 starts)
                (format nil "the initial region (of ~d discrete states)" starts)
                "the initial region"))))

(defun trace-result-statement (result confidence)
  "Return the sentence, without a full stop, on what the number of blind samples of the trace of
RESULT shows at the CONFIDENCE of the whole search, whatever the rule says; or why it shows
nothing."
  (let ((bound (trace-result-bound result)))
    (cond (bound
           (format nil "at ~a % confidence at most ~a % of ~a is discrepant (~a, which agree)"
                   (percent-text confidence) (bound-text bound)
                   (part-text result)
                   (counts-text (trace-result-blind result) (trace-result-samples result))))
          ((eq (trace-result-status result) :discrepancy) "there is a discrepancy")
          ((trace-result-void result)
           (format nil "nothing is shown of the initial region: ~a" (trace-result-void result)))
          (t (format nil "nothing is shown of the initial region: ~:[no sample agrees~;none of the ~
                          samples is blind~]"
                     (plusp (trace-result-samples result)))))))

(defun result-statement (result)
  "Return the sentence on what the numbers of blind samples of RESULT show for all its traces
jointly, whatever the confidence rule says; NIL if they show nothing, or a discrepancy was found."
  (let ((bounds (mapcar #'trace-result-bound (result-traces result))))
    (and bounds
         (every #'identity bounds)
         (null (result-discrepancies result))
         (format nil "At ~a % confidence at most ~a % of the initial region of ~:[each of the ~d ~
                      traces~;the only trace~*~] is discrepant (~a)."
                 (percent-text (result-confidence result))
                 (bound-text (reduce #'max bounds))
                 (null (rest bounds)) (length bounds)
                 (counts-text (reduce #'+ (result-traces result) :key #'trace-result-blind)
                              (reduce #'+ (result-traces result)
                                      :key #'trace-result-samples))))))
