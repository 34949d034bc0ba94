;;;; Results of searches as JSON: all that a report tells, for programs to read.
;;;;
;;;; RESULT-JSON is the entry point.  The object for a search holds one for each trace and one for
;;;; each discrepancy, which tells its trace in full.  States are arrays of the fluents that are
;;;; true; of the simulation only those in the array "observable" are known.  Keys are lower case,
;;;; words of several parts have underscores; steps and traces count from 1, samples from 0; units
;;;; are SI.  docs/results.md names all keys.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *result-format* "discrepancy-finder result 1"
  "The value of \"format\" in results.")

(defun texts-json (texts)
  (coerce texts 'simple-vector))

(defun atoms-json (atoms)
  (map 'vector #'ec:atom-text atoms))

(defun position-entries (position)
  "Return the entries \"file\" and \"line\" for a place in a plan, or NIL if it is not known."
  (json:object "file" (json-or-null (and position (source:source-position-file position)))
               "line" (json-or-null (and position (source:source-position-line position)))))

;;; Parameters and samples

(defun parameter-unit (parameter)
  "Return the unit of PARAMETER as a text, or NIL if it is not known."
  (case (parameter-axis parameter)
    ((:x :y :z) "m")
    (:yaw "rad")))

(defun parameter-json (parameter)
  (json:object "name" (parameter-name parameter)
               "body" (json-or-null (let ((body (parameter-body parameter)))
                                      (if (keywordp body) (ec:name-text body) body)))
               "min" (parameter-min parameter) "max" (parameter-max parameter)
               "unit" (json-or-null (parameter-unit parameter))
               "meaning" (json-or-null (parameter-meaning parameter))
               "tolerance" (json-boolean (tolerance-p parameter))))

(defun runs-json (runs &optional starts)
  "Return RUNS, a list of (run . judgement), with the values that were drawn, in the order of the
parameters; if there are several STARTS with the number of that which each is from."
  (map 'vector
       (lambda (entry)
         (destructuring-bind (run . judgement) entry
           (append
            (json:object "sample" (sample-index (run-sample run))
                         "verdict" (string-downcase (judgement-verdict judgement))
                         "values" (coerce (drawn-values (run-sample run)) 'simple-vector))
            (and (rest starts)
                 (json:object "start" (1+ (position (sample-parameters (run-sample run)) starts
                                                    :key #'start-parameters)))))))
       runs))

;;; Traces and runs

(defun trace-steps-json (trace)
  (map 'vector
       (lambda (step state)
         (append (json:object "designator" (symbolic:step-designator step)
                              "event" (json-or-null (and (symbolic:step-event step)
                                                         (ec:atom-text
                                                          (symbolic:step-event step))))
                              "outcome" (ec:name-text (symbolic:step-outcome step))
                              "state" (atoms-json (ec:state-fluents state)))
                 (position-entries (symbolic:step-position step))))
       (symbolic:trace-steps trace)
       (rest (symbolic:trace-states trace))))

(defun theory-side-json (trace)
  "Return what the theory says of TRACE."
  (json:object
   "arguments" (map 'vector #'symbolic:argument-to-json (symbolic:trace-arguments trace))
   "initial" (atoms-json (ec:state-fluents (symbolic:trace-initial-state trace)))
   "steps" (trace-steps-json trace)
   "final" (atoms-json (ec:state-fluents (symbolic:trace-final-state trace)))))

(defun run-steps-json (run)
  (map 'vector
       (lambda (step)
         (append (json:object "designator" (princ-to-string (run-step-designator step))
                              "outcome" (ec:name-text (run-step-outcome step))
                              "failure" (json-or-null (run-step-failure step))
                              "state" (atoms-json (observed-fluents (run-step-state step))))
                 (position-entries (run-step-position step))))
       (run-steps run)))

(defun simulation-side-json (run)
  "Return what was seen of RUN."
  (json:object
   "sample" (sample-index (run-sample run))
   "ending" (ec:name-text (run-ending run))
   "seconds" (run-seconds run)
   "hash" (hash-text (run-hash run))
   "observable" (atoms-json (mapcar #'car (run-initial-state run)))
   "initial" (atoms-json (observed-fluents (run-initial-state run)))
   "steps" (run-steps-json run)
   "final" (atoms-json (observed-fluents (run-final-state run)))))

(defun trace-number (discrepancy result)
  "Return the number of the trace in whose samples RESULT has DISCREPANCY, or NIL if it comes from
elsewhere."
  (let ((position (position-if (lambda (trace)
                                 (member discrepancy (trace-result-discrepancies trace)))
                               (result-traces result))))
    (and position (1+ position))))

(defun found-json (discrepancy result)
  "Return DISCREPANCY, which is in RESULT, with both sides in full; its file tells what a replay
needs."
  (let* ((judgement (discrepancy-judgement discrepancy))
         (divergence (judgement-divergence judgement))
         (run (discrepancy-run discrepancy))
         (trace (discrepancy-trace discrepancy))
         (step (nth (divergence-step divergence) (run-steps run))))
    (json:object
     "summary" (discrepancy-summary discrepancy)
     "kind" (kind-text discrepancy)
     "occurrences" (discrepancy-occurrences discrepancy)
     "origin" (string-downcase (discrepancy-origin discrepancy))
     "trace" (json-or-null (trace-number discrepancy result))
     "confirmed" (json-boolean (discrepancy-confirmed-p discrepancy))
     "file" (json-or-null (discrepancy-file discrepancy))
     "divergence" (append (divergence-json divergence)
                          (json:object "designator" (princ-to-string (run-step-designator step))
                                       "failure" (json-or-null (run-step-failure step))))
     "sample" (sample-json (discrepancy-sample discrepancy))
     "parameters" (map 'vector #'parameter-json
                       (remove-if #'fixed-p (sample-parameters
                                             (discrepancy-sample discrepancy))))
     "theory" (theory-side-json trace)
     "simulation" (simulation-side-json run)
     "runs" (runs-json (discrepancy-runs discrepancy))
     "explanation" (if (discrepancy-explanation discrepancy)
                       (explanation-json (discrepancy-explanation discrepancy))
                       :null)
     "shrunk" (if (discrepancy-shrunk discrepancy)
                  (shrinking-json (discrepancy-shrunk discrepancy))
                  :null))))

(defun drawn-parameters (starts)
  "Return the list of the PARAMETERs that are drawn for one of STARTS at least, those of the same
name as one, with all values that it can have."
  (let ((parameters (loop for start in starts
                          append (remove-if #'fixed-p (start-parameters start)))))
    (loop for parameter in (remove-duplicates parameters :key #'parameter-name :test #'string=
                                                         :from-end t)
          for same = (remove (parameter-name parameter) parameters
                             :key #'parameter-name :test-not #'string=)
          collect (make-parameter (parameter-body parameter) (parameter-axis parameter)
                                  (reduce #'min same :key #'parameter-min)
                                  (reduce #'max same :key #'parameter-max)
                                  (parameter-meaning parameter) (parameter-region parameter)))))

(defun start-json (start)
  "Return an initial state that samples were drawn from, and how many of them were valid."
  (json:object
   "initial" (atoms-json (ec:state-fluents (symbolic:trace-initial-state (start-trace start))))
   "parameters" (map 'vector #'parameter-json
                     (remove-if #'fixed-p (start-parameters start)))
   "accepted" (start-accepted start)
   "rejected" (start-rejected start)))

(defun trace-result-json (result confidence)
  "Return what sampling a trace came to, the TRACE-RESULT RESULT; CONFIDENCE is the whole search's."
  (let ((trace (trace-result-trace result)))
    (json:object
     "status" (string-downcase (trace-result-status result))
     "reason" (trace-result-reason result)
     "samples" (trace-result-samples result)
     "blind" (trace-result-blind result)
     "targeted" (trace-result-targeted result)
     "drawn" (trace-result-drawn result)
     "rejected" (trace-result-rejected result)
     "acceptance_rate" (json-or-null (trace-result-acceptance-rate result))
     "confidence" (trace-result-confidence result)
     "void" (json-or-null (trace-result-void result))
     "statement" (trace-result-statement result confidence)
     "warnings" (texts-json (trace-result-warnings result))
     "left_trace" (trace-result-left-trace result)
     "parameters" (map 'vector #'parameter-json
                       (drawn-parameters (trace-result-starts result)))
     "starts" (map 'vector #'start-json (trace-result-starts result))
     "theory" (theory-side-json trace)
     "simulation" (let ((entry (find :consistent (trace-result-runs result)
                                     :key (lambda (entry) (judgement-verdict (cdr entry))))))
                    (if entry (simulation-side-json (car entry)) :null))
     "runs" (runs-json (trace-result-runs result) (trace-result-starts result)))))

;;; The search

(defun tolerances-json (domain)
  (map 'vector #'parameter-json (tolerance-parameters (domain-scene domain))))

(defun phase-json (phase)
  (json:object "name" (string-downcase (phase-name phase))
               "simulations" (phase-simulations phase)
               "seconds" (phase-seconds phase)
               "simulation_seconds" (phase-simulation-seconds phase)))

(defun result-plan-json (result)
  (let ((plan (result-plan result)))
    (append (json:object "name" (ec:name-text (plan:plan-name plan)))
            (position-entries (plan:plan-position plan)))))

(defun result-domain-json (result)
  (let ((domain (result-domain result)))
    (json:object "name" (ec:name-text (symbolic:action-theory-name domain))
                 "theory" (ec:name-text (ec:theory-name (symbolic:action-theory-theory domain)))
                 "file" (json-or-null (domain-file domain)))))

(defun result-json (result)
  "Return RESULT, a SEARCH-RESULT, as a JSON object: status, headline, options, counts, seconds, and
for each trace what theory and simulation say, step by step, with the discrepancies found.
JSON:ENCODE makes a text of it."
  (let ((exploration (result-exploration result)))
    (json:object
     "format" *result-format*
     "status" (string-downcase (result-status result))
     "headline" (headline result)
     "reason" (result-reason result)
     "statement" (json-or-null (result-statement result))
     "plan" (result-plan-json result)
     "domain" (result-domain-json result)
     "constraint" (constraint-text (result-constraint result))
     "rule" (string-downcase (result-rule-name result))
     "confidence" (result-confidence result)
     "seed" (result-seed result)
     "sampler" (string-downcase (result-sampler result))
     "parameters" (loop for (name value) on (result-parameters result) by #'cddr
                        collect (cons (ec:name-text name) (decimal-double value)))
     "tolerances" (tolerances-json (result-domain result))
     "iterations" (result-iterations result)
     "simulations" (result-simulations result)
     "acceptance_rate" (json-or-null (result-acceptance-rate result))
     "seconds" (json:object "all" (result-seconds result)
                            "symbolic" (float (result-symbolic-seconds result) 1d0)
                            "simulation" (float (result-simulation-seconds result) 1d0)
                            "solver" (float (result-solver-seconds result) 1d0))
     "phases" (map 'vector #'phase-json (result-phases result))
     "stopped" (json-or-null (result-stopped result))
     "reused" (map 'vector (lambda (entry)
                             (destructuring-bind (discrepancies file text) entry
                               (json:object "file" file "verdict" text
                                            "shows" (json-boolean discrepancies))))
                   (result-reused result))
     "exploration" (json:object
                    "complete" (json-boolean (symbolic:exploration-complete-p exploration))
                    "gaps" (texts-json (mapcar #'princ-to-string
                                               (symbolic:exploration-gaps exploration))))
     "traces" (map 'vector (lambda (trace)
                            (trace-result-json trace (result-confidence result)))
                   (result-traces result))
     "discrepancies" (map 'vector (lambda (discrepancy) (found-json discrepancy result))
                          (result-discrepancies result)))))
