;;;; Shrinking: from a discrepancy to the smallest case that shows the same kind of it.
;;;;
;;;; A discrepancy of a long plan, drawn at random, tells little: most of what happens in it has
;;;; nothing to do with it.  SHRINK-DISCREPANCY leaves out actions and items (shrink-steps.lisp),
;;;; gives ordinary and round values to coordinates (shrink-coordinates.lisp), each only if the same
;;;; kind of discrepancy stays, and then looks for the nearest sample that passes (boundary.lisp).
;;;; It is deterministic but for the bound in seconds.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (shrinking (:copier nil))
  "What shrinking ORIGINAL came to: DISCREPANCY, the smaller one, and the BOUNDARY or NIL.
EXHAUSTED is NIL, or says when it was stopped by its bounds."
  (original nil :type discrepancy :read-only t)
  (discrepancy nil :type discrepancy :read-only t)
  (boundary nil :type (or null boundary) :read-only t)
  (runs 0 :type (integer 0) :read-only t)
  (seconds 0d0 :type double-float :read-only t)
  (exhausted nil :type (or null string) :read-only t))

(setf (documentation 'shrinking-discrepancy 'function)
      "Return the smaller DISCREPANCY."
      (documentation 'shrinking-original 'function)
      "Return the DISCREPANCY that was shrunk."
      (documentation 'shrinking-boundary 'function)
      "Return the BOUNDARY nearest to the smaller discrepancy, or NIL if none was found."
      (documentation 'shrinking-runs 'function)
      "Return the number of runs that shrinking took."
      (documentation 'shrinking-seconds 'function)
      "Return the seconds that shrinking took."
      (documentation 'shrinking-exhausted 'function)
      "Return NIL, or when shrinking was stopped by its bounds: \"after 200 runs\", for example.")

(defmethod print-object ((shrinking shrinking) stream)
  (print-unreadable-object (shrinking stream :type t)
    (format stream "~d run~:p: ~a" (shrinking-runs shrinking)
            (discrepancy-summary (shrinking-discrepancy shrinking)))))

(defun smallest-case (discrepancy)
  "Return the smaller DISCREPANCY that shrinking made of DISCREPANCY, or NIL if there is none."
  (let ((shrinking (discrepancy-shrunk discrepancy)))
    (and shrinking
         (not (eq (shrinking-discrepancy shrinking) discrepancy))
         (shrinking-discrepancy shrinking))))

(defun confirmed (shrinker)
  "Return the best case of SHRINKER after another run, which says whether it has the same bits."
  (let ((best (shrinker-best shrinker)))
    (if (eq best (shrinker-original shrinker))
        best
        (let ((again (run-case best)))
          (incf (shrinker-runs shrinker))
          (variation best :run (discrepancy-run best) :judgement (discrepancy-judgement best)
                          :actions (and (discrepancy-actions best)
                                        (mapcar #'recorded-step-action
                                                (run-steps (discrepancy-run best))))
                          :confirmed-p (= (run-hash again) (run-hash (discrepancy-run best))))))))

(defun find-witnesses (shrinker)
  "Return at most two samples that pass in the original of SHRINKER: the ordinary one, if it does,
and the last one that the search has seen, or else one that is drawn."
  (let* ((original (shrinker-original shrinker))
         (ordinary (ordinary-sample (domain-scene (discrepancy-domain original))
                                    (discrepancy-sample original)))
         (seen (find-if (lambda (judgement)
                          (and judgement (eq (judgement-verdict judgement) :consistent)))
                        (discrepancy-runs original) :key #'cdr :from-end t))
         (passing (if seen
                      (run-sample (car seen))
                      (passing-sample shrinker 8))))
    (append (and (eq :passing (attempt shrinker :sample ordinary)) (list ordinary))
            (and passing (list passing)))))

(defun shrink-discrepancy (discrepancy &key (max-runs 300) (max-seconds 60))
  "Shrink DISCREPANCY to a smaller one of the same kind, find the nearest sample that passes, and
return a SHRINKING.  It takes at most MAX-RUNS runs, and one to confirm the result, and begins none
after MAX-SECONDS.  Signals INVALID-ARGUMENT."
  (check-argument 'max-runs max-runs (typep max-runs '(integer 0)) "an integer from 0 on")
  (check-argument 'max-seconds max-seconds (and (realp max-seconds) (>= max-seconds 0))
                  "a number of seconds")
  (let ((start (foreign:monotonic-seconds)))
    (z3:with-context (context)
      (let ((shrinker (make-instance
                       'shrinker
                       :original discrepancy :best discrepancy :context context
                       :kind (discrepancy-kind discrepancy)
                       :max-runs max-runs :deadline (+ start max-seconds))))
        (setf (shrinker-witnesses shrinker) (find-witnesses shrinker))
        (unless (discrepancy-actions discrepancy)
          (shrink-actions shrinker))
        (shrink-items shrinker)
        (shrink-coordinates shrinker)
        (round-coordinates shrinker)
        (let ((boundary (find-boundary shrinker)))
          (make-shrinking :original discrepancy :discrepancy (confirmed shrinker)
                          :boundary boundary :runs (shrinker-runs shrinker)
                          :seconds (- (foreign:monotonic-seconds) start)
                          :exhausted (shrinker-exhausted shrinker)))))))

;;; Telling

(defun step-count (discrepancy)
  (length (symbolic:trace-steps (discrepancy-trace discrepancy))))

(defun mattering-text (discrepancy)
  "Return a text of the values of DISCREPANCY that are not the ordinary ones, or NIL."
  (let ((sample (discrepancy-sample discrepancy)))
    (format nil "~{~a~^, ~}"
            (loop for number in (mattering-numbers discrepancy)
                  collect (value-text (nth number (sample-parameters sample))
                                      (aref (sample-values sample) number))))))

(defun shrinking-text (shrinking &key (command "./discrepancy-finder"))
  "Return a text of several lines that tells SHRINKING: what is left, the smaller discrepancy, and
the nearest sample that passes.  COMMAND is as for DISCREPANCY-TEXT."
  (let* ((original (shrinking-original shrinking))
         (discrepancy (shrinking-discrepancy shrinking))
         (drawn (count-if-not #'fixed-p (sample-parameters (discrepancy-sample discrepancy))))
         (ordinary (- drawn (length (mattering-numbers discrepancy)))))
    (with-output-to-string (stream)
      (format stream "shrunk in ~d run~:p~@[, stopped ~a~]~%" (shrinking-runs shrinking)
              (shrinking-exhausted shrinking))
      (format stream "  ~d of ~d step~:p ~:[are~;is~] left~%"
              (step-count discrepancy) (step-count original) (= 1 (step-count discrepancy)))
      (format stream "  ~d of ~d drawn values ~:[are~;is~] ordinary~@[; what matters: ~a~]~%"
              ordinary drawn (= ordinary 1)
              (and (< ordinary drawn) (mattering-text discrepancy)))
      (if (shrinking-boundary shrinking)
          (format stream "  nearest sample that passes: ~a~%"
                  (boundary-text (shrinking-boundary shrinking)))
          (format stream "  no sample that passes was found~%"))
      (write-string (discrepancy-text discrepancy :command command) stream))))

(defun shrinking-json (shrinking)
  "Return the JSON object of SHRINKING: the smaller discrepancy, as in its replay file, the name of
that or null, how many of the steps are left, the values that matter, the boundary or null, and what
it took."
  (let ((boundary (shrinking-boundary shrinking)))
    (json:object
     "discrepancy" (discrepancy-json (shrinking-discrepancy shrinking))
     "file" (json-or-null (discrepancy-file (shrinking-discrepancy shrinking)))
     "steps" (vector (step-count (shrinking-original shrinking))
                     (step-count (shrinking-discrepancy shrinking)))
     "left-out" (map 'vector #'ec:name-text
                     (discrepancy-left-out (shrinking-discrepancy shrinking)))
     "mattering" (loop with sample = (discrepancy-sample (shrinking-discrepancy shrinking))
                       for number in (mattering-numbers (shrinking-discrepancy shrinking))
                       collect (cons (parameter-name (nth number (sample-parameters sample)))
                                     (aref (sample-values sample) number)))
     "boundary" (if boundary
                    (map 'vector
                         (lambda (change)
                           (destructuring-bind (parameter failing passing) change
                             (json:object "parameter" (parameter-name parameter)
                                          "failing" failing "passing" passing)))
                         (changed-values boundary))
                    :null)
     "runs" (shrinking-runs shrinking)
     "stopped" (json-or-null (shrinking-exhausted shrinking)))))
