;;;; Replay: a discrepancy as a file, and the run that the file repeats.
;;;;
;;;; SAVE-DISCREPANCY writes a JSON file with all that the run depends on: plan, domain, parameters,
;;;; trace, the sample's numbers, and a hash of the bits of the final state; for one that was shrunk
;;;; also the actions that are performed in the place of the plan, and the items that are left out.
;;;; REPLAY runs it again, in any process, and tells "same bits" from "same verdict, other bits" and
;;;; "other verdict".  Reading a file evaluates nothing, and a file that is not right in every part
;;;; is refused.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *replay-format* "discrepancy-finder discrepancy 2"
  "The value of \"format\" in replay files.")
(defparameter *older-formats* '("discrepancy-finder discrepancy 1")
  "The other formats that are read: 1 has no shrunk discrepancies.")

(defun file-hash (file)
  "Return the hash of the text in FILE, or NIL if it cannot be read."
  (let ((located (locate-file file)))
    (and located
         (ignore-errors (hash-text (content-hash (uiop:read-file-string
                                                  located :external-format :utf-8)))))))

(defun plan-file (plan)
  "Return the name of the file that defines PLAN, or NIL."
  (and (plan:plan-position plan) (source:source-position-file (plan:plan-position plan))))

(defun source-files (plan domain)
  "Return the names of the files that the runs of PLAN in DOMAIN depend on."
  (remove-duplicates (remove nil (append (mapcar #'plan-file (plan:plans-mentioned plan))
                                         (domain-files domain)
                                         (projection:scene-files (domain-scene domain))))
                     :test #'equal :from-end t))

;;; Writing

(defun json-boolean (value)
  (if value :true :false))

(defun json-or-null (value)
  (or value :null))

(defun trace-json (trace)
  (json:object
   "arguments" (map 'vector #'symbolic:argument-to-json (symbolic:trace-arguments trace))
   "initial" (map 'vector #'ec:atom-text (ec:state-fluents (symbolic:trace-initial-state trace)))
   "steps" (map 'vector
                (lambda (step)
                  (json:object
                   "designator" (symbolic:step-designator step)
                   "event" (json-or-null (and (symbolic:step-event step)
                                              (ec:atom-text (symbolic:step-event step))))
                   "outcome" (string-downcase (symbolic:step-outcome step))))
                (symbolic:trace-steps trace))))

(defun sample-json (sample)
  "Return the JSON object of SAMPLE; it has a key \"tolerances\" if some were drawn."
  (let ((values (loop for parameter in (sample-parameters sample)
                      for value across (sample-values sample)
                      collect (list parameter (parameter-name parameter) value))))
    (flet ((entries (tolerance)
             (loop for (parameter name value) in values
                   when (eq tolerance (tolerance-p parameter))
                     collect (cons name value))))
      (append (json:object "index" (json-or-null (sample-index sample)) "values" (entries nil))
              (and (entries t) (json:object "tolerances" (entries t)))))))

(defun divergence-json (divergence)
  (json:object "step" (1+ (divergence-step divergence))
               "kind" (string-downcase (divergence-kind divergence))
               "fluents" (map 'vector
                              (lambda (entry)
                                (destructuring-bind (atom theory simulation) entry
                                  (vector (ec:atom-text atom) (json-boolean theory)
                                          (json-boolean simulation))))
                              (divergence-fluents divergence))))

(defun discrepancy-json (discrepancy)
  (let* ((plan (discrepancy-plan discrepancy))
         (domain (discrepancy-domain discrepancy))
         (run (discrepancy-run discrepancy)))
    (json:object
     "format" *replay-format*
     "plan" (json:object "name" (ec:name-text (plan:plan-name plan))
                         "file" (json-or-null (plan-file plan)))
     "domain" (json:object "name" (ec:name-text (symbolic:action-theory-name domain))
                           "file" (json-or-null (domain-file domain)))
     "files" (loop for file in (source-files plan domain)
                   collect (cons file (json-or-null (file-hash file))))
     "constraint" (constraint-text (discrepancy-constraint discrepancy))
     "parameters" (loop for (name value) on (discrepancy-parameters discrepancy) by #'cddr
                        collect (cons (ec:name-text name) (decimal-double value)))
     "execution" (string-downcase (discrepancy-execution discrepancy))
     "compare" (string-downcase (discrepancy-compare discrepancy))
     "comparison" (string-downcase (discrepancy-comparison discrepancy))
     "seed" (discrepancy-seed discrepancy)
     "trace" (trace-json (discrepancy-trace discrepancy))
     "actions" (map 'vector
                    (lambda (action) (description-json (recorded-action-description action)))
                    (discrepancy-actions discrepancy))
     "left-out" (map 'vector #'ec:name-text (discrepancy-left-out discrepancy))
     "sample" (sample-json (discrepancy-sample discrepancy))
     "run" (json:object
            "hash" (hash-text (run-hash run))
            "verdict" (string-downcase (judgement-verdict (discrepancy-judgement discrepancy)))
            "final" (map 'vector #'ec:atom-text (observed-fluents (run-final-state run)))
            "divergence" (divergence-json (judgement-divergence
                                           (discrepancy-judgement discrepancy)))))))

(defun write-to (path text)
  (with-open-file (stream path :direction :output :if-exists :supersede :external-format :utf-8)
    (write-string text stream)))

(defun write-file-whole (file text)
  "Write TEXT to FILE, which either keeps its old content or gets all of the new.  A link stays one,
and what is no regular file is written to as it is.  Signals REPLAY-ERROR if that cannot be."
  (let* ((path (merge-pathnames (source:native-path file)))
         (path (or (ignore-errors (truename path)) path))
         (name (source:native-name path))
         (temporary (format nil "~a.part~d" name (sb-unix:unix-getpid))))
    (flet ((problem (reason)
             (error 'replay-error :file (source:native-name file) :reason reason)))
      (when (or (string= (source:native-name file) "") (uiop:directory-pathname-p path))
        (problem "it is a folder"))
      (handler-case
          (if (member (sb-impl::native-file-kind name) '(nil :file))
              (write-to (source:native-path temporary) text)
              (with-open-file (stream path :direction :output :if-exists :append)
                (write-string text stream)))
        ((or stream-error file-error) () (problem "it cannot be written")))
      (when (and (uiop:file-exists-p (source:native-path temporary))
                 (not (sb-unix:unix-rename temporary name)))
        (uiop:delete-file-if-exists (source:native-path temporary))
        (problem "it cannot be replaced")))))

(defun default-file (discrepancy)
  "Return a file name for DISCREPANCY in the folder discrepancies/, which is made if need be."
  (ensure-directories-exist "discrepancies/")
  (format nil "discrepancies/~a-~d-~a.json"
          (file-name (plan:plan-name (discrepancy-plan discrepancy)))
          (discrepancy-seed discrepancy)
          (subseq (hash-text (run-hash (discrepancy-run discrepancy))) 0 8)))

(defun save-discrepancy (discrepancy &optional file)
  "Write DISCREPANCY to FILE and return the file's name.  By default the file is in the folder
discrepancies/, under a name made of plan, seed and state hash.  Signals REPLAY-ERROR."
  (let ((file (or file (default-file discrepancy))))
    (write-file-whole file (format nil "~a~%" (json:encode (discrepancy-json discrepancy)
                                                           :pretty t)))
    (setf (discrepancy-file discrepancy) (source:native-name file))))

;;; Replaying

(defstruct (replay-result (:conc-name replay-) (:copier nil))
  "What a replay came to: STATUS is :SAME-BITS, :SAME-VERDICT (other bits) or :OTHER-VERDICT."
  (status :other-verdict :type (member :same-bits :same-verdict :other-verdict) :read-only t)
  (discrepancy nil :read-only t)
  (run nil :read-only t)
  (judgement nil :read-only t)
  (compared nil :type case-run :read-only t)
  (recorded-hash 0 :type (unsigned-byte 64) :read-only t)
  (changed-files '() :type list :read-only t))

(setf (documentation 'replay-status 'function)
      "Return :SAME-BITS, :SAME-VERDICT (other bits) or :OTHER-VERDICT."
      (documentation 'replay-discrepancy 'function)
      "Return the discrepancy that shows again, or NIL.")

(defun replay-verdict (result)
  "Return the verdict on the replayed run: :DISCREPANCY, :CONSISTENT, :LEFT-TRACE, or :INVALID if
the initial state is not one of the trace any more."
  (if (eq (run-validity (replay-run result)) :valid)
      (judgement-verdict (replay-judgement result))
      :invalid))

(defmethod print-object ((result replay-result) stream)
  (print-unreadable-object (result stream :type t)
    (format stream "~(~a~)" (replay-status result))))

(defun replay (file &key step)
  "Run the discrepancy stored in FILE again and return a REPLAY-RESULT.  Reading FILE evaluates
nothing; but the plan and the domain that it names, which are code, are loaded from the files that
it names, unless they are defined.  With STEP each action is told as soon as it is performed, on
both sides, and T asks at *QUERY-IO* before the next one, :DEBUGGER signals REPLAY-STOPPED in the
debugger; a function of the number of actions performed, that text and the projection returns :NEXT,
or :FINISH for no more stops.  Signals REPLAY-ERROR, SOURCE-ERROR."
  (check-argument 'step step (or (member step '(nil t :debugger)) (functionp step))
                  "nil, t, :debugger or a function")
  (destructuring-bind (&key plan domain parameters trace constraint execution compare comparison
                         (seed 0) actions left-out sample recorded changed-files)
      (read-replay-file file)
    (let* ((run (execute-sample domain (plan:plan-name plan) sample
                                :trace trace :execution execution
                                :arguments (symbolic:trace-arguments trace) :actions actions
                                :on-step (and step
                                              (stepper domain trace sample comparison step))))
           (judgement (if (eq (run-validity run) :valid)
                          (judge-run domain run trace :compare compare :comparison comparison)
                          (make-judgement :verdict :left-trace)))
           (same-bits (= (run-hash run) (first recorded)))
           (same-verdict (eq (judgement-verdict judgement) (second recorded))))
      (make-replay-result
       :status (cond ((and same-bits same-verdict) :same-bits)
                     (same-verdict :same-verdict)
                     (t :other-verdict))
       :run run :judgement judgement
       :compared (compared-run domain trace run comparison)
       :recorded-hash (first recorded) :changed-files changed-files
       :discrepancy (and (eq (judgement-verdict judgement) :discrepancy)
                         (make-discrepancy
                          :plan plan :domain domain :parameters parameters :execution execution
                          :compare compare :seed seed :trace trace :sample sample :run run
                          :constraint constraint :actions actions :left-out left-out
                          :judgement judgement :confirmed-p same-bits
                          :file (source:native-name file)))))))

(defun replay-text (result &key (steps t))
  "Return the report of the REPLAY-RESULT RESULT, a text of several lines: whether it came out the
same, and, if STEPS, what theory and simulation have of each action, side by side."
  (let* ((compared (replay-compared result))
         (run (replay-run result)))
    (with-output-to-string (stream)
      (format stream "~a~%"
              (ecase (replay-status result)
                (:same-bits "SAME BITS: the replayed run ends in the recorded state, bit for bit.")
                (:same-verdict "SAME VERDICT, OTHER BITS: the replayed run is judged as recorded.")
                (:other-verdict
                 "OTHER VERDICT: the replayed run is not judged as recorded.")))
      (format stream "  state hash ~a, recorded ~a~%" (hash-text (run-hash run))
              (hash-text (replay-recorded-hash result)))
      (dolist (file (replay-changed-files result))
        (format stream "  ~a has changed since~%" file))
      (when (replay-discrepancy result)
        (describe-shrinking (replay-discrepancy result) stream))
      (describe-sample (case-run-domain compared) run stream)
      (cond ((not (eq (run-validity run) :valid))
             (format stream "  the initial state is not valid any more: ~a~%" (run-validity run)))
            (t
             (when steps
               (write-string (side-by-side-text compared) stream))
             (if (replay-discrepancy result)
                 (describe-divergence (replay-discrepancy result) stream)
                 (format stream "  theory and simulation agree; final state ~a~%"
                         (state-text (observed-fluents (run-final-state run))))))))))
