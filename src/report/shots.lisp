;;;; Shots: samples run once more, to see where everything was.
;;;;
;;;; Runs are deterministic, so that what a picture needs and a search does not keep - the way that
;;;; the base has driven, where things stood at the beginning and at the end - is had by running a
;;;; sample again.  TAKE-SHOT does that.

(in-package #:discrepancy-finder.report)

(defstruct (shot (:copier nil))
  "What a run of SAMPLE looks like: BEFORE and AFTER are outlines as OUTLINES-FROM-ABOVE returns
them, TRAIL is the way of the base, a list of (x y yaw), and STOPS are the places (x y yaw) where the
base was after each performed designator.  VERDICT is :PASSED, :FAILED or :LEFT."
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
  "At most so many passing samples of a trace are run again.")

(defun result-shot (result trace sample verdict execution)
  (take-shot (discrepancy:result-domain result)
             (plan:plan-name (discrepancy:result-plan result))
             trace execution sample verdict))

(defun passing-shots (result trace-result)
  "Return shots of passing samples of TRACE-RESULT."
  (let* ((trace (discrepancy:trace-result-trace trace-result))
         (domain (discrepancy:result-domain result))
         (parameters (discrepancy:initial-parameters domain trace)))
    (loop with wanted = (min *shot-limit* (discrepancy:trace-result-samples trace-result))
          for index from 0 below (+ (discrepancy:trace-result-samples trace-result)
                                    (discrepancy:trace-result-rejected trace-result))
          while (plusp wanted)
          collect (prog1 (result-shot result trace
                                      (discrepancy:draw-sample
                                       parameters (discrepancy:result-seed result)
                                       (discrepancy:content-hash (symbolic:trace-text trace))
                                       index)
                                      :passed :trace)
                    (decf wanted)))))

(defun trace-shots (result trace-result)
  "Return the shots for the map of TRACE-RESULT, in which no discrepancy was found."
  (passing-shots result trace-result))

(defun discrepancy-shots (result discrepancy)
  "Return the shots for the map of DISCREPANCY, which is in RESULT: its own first."
  (let ((trace-result (find-if (lambda (trace-result)
                                 (member discrepancy (discrepancy:trace-result-discrepancies
                                                      trace-result)))
                               (discrepancy:result-traces result))))
    (cons (result-shot result (discrepancy:discrepancy-trace discrepancy)
                       (discrepancy:discrepancy-sample discrepancy) :failed
                       (discrepancy:discrepancy-execution discrepancy))
          (and trace-result (passing-shots result trace-result)))))
