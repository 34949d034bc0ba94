;;;; Shots: samples run once more, to see where everything was.
;;;;
;;;; Runs are deterministic, so that what a picture needs and a search does not keep - the way that
;;;; the base has driven, where things stood at the beginning and at the end - is had by running a
;;;; sample again.  TAKE-SHOT does that.

(in-package #:discrepancy-finder.report)

(defstruct (shot (:copier nil))
  "What a run of SAMPLE looks like: BEFORE and AFTER are outlines as OUTLINES-FROM-ABOVE returns
them, TRAIL is the way of the base, a list of (x y yaw), and STOPS are the places (x y yaw) where
the base was after each performed designator.  VERDICT is :PASSED, :FAILED or :LEFT."
  (sample nil :read-only t)
  (verdict :passed :type (member :passed :failed :left) :read-only t)
  (before '() :type list :read-only t)
  (after '() :type list :read-only t)
  (trail '() :type list :read-only t)
  (stops '() :type list :read-only t))

(defun take-shot (domain plan trace execution sample verdict)
  "Run SAMPLE of TRACE in DOMAIN again, and return the SHOT of it.  PLAN is a symbol, EXECUTION
:TRACE or :PLAN, and VERDICT what was judged of it."
  (let ((before '()) (after '()) (trail '()) (stops '()) (calls 0))
    (flet ((observe (projection designator failure)
             (declare (ignore failure))
             (when (= (incf calls) 1)
               (setf before (projection:outlines-from-above projection))
               (projection:record-trail projection))
             (setf trail (projection:base-trail projection))
             (if designator
                 (push (first (last trail)) stops)
                 (setf after (projection:outlines-from-above projection)))))
      (discrepancy:execute-sample domain plan sample
                                  :trace trace :execution execution
                                  :arguments (symbolic:trace-arguments trace)
                                  :observer #'observe))
    (make-shot :sample sample :verdict verdict :before before :after after :trail trail
               :stops (reverse stops))))

;;; Which samples are shown

(defparameter *shot-limit* 16
  "At most so many samples of a trace are run again for a map.")

(defun entry-verdict (entry)
  (ecase (discrepancy:judgement-verdict (cdr entry))
    (:consistent :passed)
    (:discrepancy :failed)
    (:left-trace :left)))

(defun entry-shot (result trace execution entry)
  "Return the shot of ENTRY, a (run . judgement)."
  (take-shot (discrepancy:result-domain result)
             (plan:plan-name (discrepancy:result-plan result))
             trace execution (discrepancy:run-sample (car entry)) (entry-verdict entry)))

(defun without-pictures (entry)
  "Return the shot of ENTRY, a (run . judgement), with the sample and the verdict alone."
  (make-shot :sample (discrepancy:run-sample (car entry)) :verdict (entry-verdict entry)))

(defun entries-shots (result trace-of execution entries)
  "Return the shots of ENTRIES, of which the first *SHOT-LIMIT* are run again; TRACE-OF is a
function of a run."
  (loop for entry in entries
        for count from 0
        collect (if (< count *shot-limit*)
                    (entry-shot result (funcall trace-of (car entry)) execution entry)
                    (without-pictures entry))))

(defun trace-shots (result trace-result)
  "Return the shots for the map of TRACE-RESULT, in which no discrepancy was found."
  (entries-shots result (lambda (run) (discrepancy:run-trace trace-result run)) :trace
                 (discrepancy:trace-result-runs trace-result)))

(defun discrepancy-shots (result discrepancy)
  "Return the shots for the map of DISCREPANCY, which is in RESULT: its own first, then those of
other samples from the same discrete state."
  (let* ((run (discrepancy:discrepancy-run discrepancy))
         (sample (discrepancy:discrepancy-sample discrepancy))
         (trace (discrepancy:discrepancy-trace discrepancy))
         (trace-result (find-if (lambda (trace-result)
                                  (member discrepancy
                                          (discrepancy:trace-result-discrepancies trace-result)))
                                (discrepancy:result-traces result)))
         (entries (if trace-result
                      (remove trace (discrepancy:trace-result-runs trace-result)
                              :test-not #'eq
                              :key (lambda (entry)
                                     (discrepancy:run-trace trace-result (car entry))))
                      (discrepancy:discrepancy-runs discrepancy)))
         (others (remove-if (lambda (entry)
                              (or (eq (car entry) run)
                                  (eq (discrepancy:run-sample (car entry)) sample)))
                            entries)))
    (entries-shots result (constantly trace) (discrepancy:discrepancy-execution discrepancy)
                   (cons (cons run (discrepancy:discrepancy-judgement discrepancy)) others))))
