;;;; The journal: what a search has run, so that it can be resumed.
;;;;
;;;; A journal is a file of JSON lines.  The first one, the header, tells which search it is of: a
;;;; search with another plan, domain or other options, budgets apart, is refused.  Each further
;;;; line is the run of a sample, under the key (hash of the trace, origin, index), written when the
;;;; run is over.  A search that is resumed takes these runs for its own, and so comes to the result
;;;; that it would have had without the interruption.  Designators are stored as text and,
;;;; where that can be written, as a description, of which a new one is made; where that would mean
;;;; something else, the text is all that is known.  A discrepancy that is taken from the journal is
;;;; confirmed by a run of its own, which has them in full.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *journal-format* "discrepancy-finder journal 1"
  "The value of \"format\" in the headers of journals.")

(defstruct (journal (:copier nil))
  "The FILE, its open STREAM, to which runs are written, and the LINES that were there, each (text .
number), by their keys.  ATOMS are those of the observed fluents, in their order."
  (file "" :type string :read-only t)
  (stream nil :read-only t)
  (lines (make-hash-table :test #'equal) :read-only t)
  (atoms '() :type list :read-only t))

;;; Runs as JSON

(defun state-bits (state)
  (map 'string (lambda (entry) (if (cdr entry) #\1 #\0)) state))

(defun state-from-bits (bits atoms)
  (loop for bit across bits for atom in atoms collect (cons atom (char= bit #\1))))

(defun candidate-json (outcome)
  (json:object "name" (symbolic:argument-to-json (symbolic:outcome-name outcome))
               "event" (if (symbolic:outcome-event outcome)
                           (ec:atom-text (symbolic:outcome-event outcome))
                           :null)
               "condition" (formula-as-text (symbolic:outcome-condition outcome))))

(defun candidate-from-json (object ground)
  (let ((event (json:get-key object "event")))
    (symbolic:make-outcome
     :name (symbolic:argument-from-json (json:get-key object "name"))
     :event (and (stringp event) (ec:text-atom event (ec:ground-theory-events ground)))
     :condition (formula-from-text (json:get-key object "condition")))))

(defun designator-json (designator)
  (handler-case (description-json (described designator))
    (unwritable-action () :null)))

(declaim (ftype function outcomes-like))   ; edits/examples.lisp

(defun designator-from-json (object text domain outcome candidates)
  "Return the designator that OBJECT describes, or its TEXT if none can be made, or one that cannot
have the CANDIDATES in DOMAIN where OUTCOME was seen."
  (handler-case
      (let ((designator (designator-of (description-from-json object) '())))
        (if (equal (mapcar #'outcome-key candidates)
                   (mapcar #'outcome-key
                           (outcomes-like (symbolic:action-outcomes domain designator) outcome)))
            designator
            text))
    (error () text)))

(defun run-step-json (step)
  (json:object "designator" (princ-to-string (run-step-designator step))
               "description" (designator-json (run-step-designator step))
               "outcome" (symbolic:argument-to-json (run-step-outcome step))
               "candidates" (map 'vector #'candidate-json (run-step-candidates step))
               "failure" (json-or-null (run-step-failure step))
               "state" (state-bits (run-step-state step))))

(defun run-step-from-json (object domain atoms)
  (let* ((ground (symbolic:action-theory-ground domain))
         (failure (json:get-key object "failure"))
         (outcome (symbolic:argument-from-json (json:get-key object "outcome")))
         (candidates (map 'list (lambda (candidate) (candidate-from-json candidate ground))
                          (json:get-key object "candidates"))))
    (make-run-step
     :designator (designator-from-json (json:get-key object "description" :null)
                                       (json:get-key object "designator")
                                       domain outcome candidates)
     :outcome outcome
     :candidates candidates
     :failure (and (stringp failure) failure)
     :state (state-from-bits (json:get-key object "state") atoms))))

(defun run-json (run)
  "Return the JSON object of RUN, without its sample."
  (json:object "validity" (if (eq (run-validity run) :valid) :true (run-validity run))
               "ending" (symbolic:argument-to-json (run-ending run))
               "initial" (state-bits (run-initial-state run))
               "steps" (map 'vector #'run-step-json (run-steps run))
               "final" (state-bits (run-final-state run))
               "values" (coerce (run-final-values run) 'simple-vector)
               "tolerances" (loop for (name value) on (run-tolerances run) by #'cddr
                                  collect (cons (symbol-name name) (decimal-double value)))
               "hash" (hash-text (run-hash run))
               "seconds" (run-seconds run)))

(defun run-from-json (object sample domain atoms)
  "Return the run of SAMPLE that OBJECT tells; ATOMS are the observed ones of DOMAIN."
  (let ((validity (json:get-key object "validity")))
    (make-run :sample sample :journaled-p t
              :validity (if (eq validity :true) :valid validity)
              :ending (symbolic:argument-from-json (json:get-key object "ending"))
              :initial-state (state-from-bits (json:get-key object "initial") atoms)
              :steps (map 'list (lambda (step) (run-step-from-json step domain atoms))
                          (json:get-key object "steps"))
              :final-state (state-from-bits (json:get-key object "final") atoms)
              :final-values (coerce (json:get-key object "values")
                                    '(simple-array double-float (*)))
              :tolerances (loop for (name . value) in (json:get-key object "tolerances")
                                append (list (intern name '#:keyword) value))
              :hash (parse-integer (json:get-key object "hash") :radix 16)
              :seconds (json:get-key object "seconds"))))

(defun judgement-json (judgement)
  (if judgement
      (json:object "verdict" (string-downcase (judgement-verdict judgement))
                   "divergence" (if (judgement-divergence judgement)
                                    (divergence-json (judgement-divergence judgement))
                                    :null))
      :null))

(defun divergence-from-json (object ground)
  (flet ((truth (value) (eq value :true)))
    (make-divergence
     :step (1- (json:get-key object "step"))
     :kind (find (json:get-key object "kind") '(:outcome :state) :test #'string-equal)
     :fluents (map 'list
                   (lambda (entry)
                     (list (ec:text-atom (aref entry 0) (ec:ground-theory-fluents ground))
                           (truth (aref entry 1)) (truth (aref entry 2))))
                   (json:get-key object "fluents")))))

(defun judgement-from-json (object ground comparison)
  (and (consp object)
       (let ((divergence (json:get-key object "divergence")))
         (make-judgement
          :comparison comparison
          :verdict (find (json:get-key object "verdict") '(:discrepancy :left-trace :consistent)
                         :test #'string-equal)
          :divergence (and (consp divergence) (divergence-from-json divergence ground))))))

;;; Lines

(defun line-key (draw)
  (format nil "~a ~(~a~) ~d" (hash-text (start-content (drawn-start draw))) (drawn-origin draw)
          (sample-index (drawn-sample draw))))

(defun refuse-line (file number &optional condition)
  "Signal JOURNAL-ERROR for line NUMBER of FILE, which CONDITION, an error, says is none."
  (error 'journal-error :file file
                        :reason (format nil "line ~d is no run of a search~@[ (~a)~]" number
                                        (and condition
                                             (string-right-trim
                                              "." (source:condition-sentence condition))))))

(defun run-of-line (line search draw)
  "Return the run of DRAW and the judgement on it (NIL for none) that LINE tells, of the journal of
SEARCH."
  (let ((object (json:parse line))
        (domain (search-domain search)))
    (values (run-from-json (json:get-key object "run") (drawn-sample draw) domain
                           (journal-atoms (search-journal search)))
            (judgement-from-json (json:get-key object "judgement")
                                 (symbolic:action-theory-ground domain)
                                 (search-comparison search)))))

(defun journaled-run (search draw)
  "Return the run of DRAW and the judgement on it (NIL for none) from the journal of SEARCH, or NIL
if it is not there.  Counts as a simulation.  Signals JOURNAL-ERROR."
  (let* ((journal (search-journal search))
         (line (and journal (gethash (line-key draw) (journal-lines journal)))))
    (when line
      (multiple-value-bind (run judgement)
          (handler-case (run-of-line (car line) search draw)
            (error (condition)
              (refuse-line (journal-file journal) (cdr line) condition)))
        (when (eq (run-validity run) :valid)
          (count-simulation))
        (values run judgement)))))

(defun write-line-whole (stream object)
  (write-line (json:encode object) stream)
  (finish-output stream))

(defun write-run (search draw run judgement)
  "Write RUN of DRAW, with JUDGEMENT or NIL, to the journal of SEARCH, if it has one."
  (let ((journal (search-journal search)))
    (when journal
      (write-line-whole (journal-stream journal)
                        (json:object "key" (line-key draw)
                                     "run" (run-json run)
                                     "judgement" (judgement-json judgement))))))

;;; Files

(defun header (search arguments paths)
  "Return the JSON object that tells which search SEARCH is, budgets apart."
  (flet ((text (value) (with-standard-io-syntax (prin1-to-string value))))
    (json:object
     "format" *journal-format*
     "plan" (text (plan:plan-name (search-plan search)))
     "domain" (text (symbolic:action-theory-name (search-domain search)))
     ;; Without their names, which depend on the working directory.
     "files" (loop for file in (source-files (search-plan search) (search-domain search))
                   collect (json-or-null (file-hash file)) into hashes
                   finally (return (coerce hashes 'simple-vector)))
     "constraint" (text (search-constraint search))
     "parameters" (text (search-parameters search))
     "arguments" (text arguments)
     "paths" (text paths)
     "rule" (text (list (search-rule-name search)
                        (confidence-rule-confidence (search-rule search))
                        (and (typep (search-rule search) 'zero-failure-rule)
                             (rule-delta (search-rule search)))))
     "seed" (text (search-seed search))
     "sampler" (text (search-sampler search))
     "targets" (text (and (search-targets search) t))
     "execution" (text (search-execution search))
     "compare" (text (list (search-compare search) (search-comparison search)))
     "keep-going" (text (search-keep-going search)))))

(defun check-header (file text header)
  "Signal JOURNAL-ERROR unless TEXT, the first line of FILE, is HEADER."
  (let ((object (handler-case (json:parse text)
                  (json:json-error () nil))))
    (flet ((refuse (control &rest arguments)
             (error 'journal-error :file file :reason (apply #'format nil control arguments))))
      (unless (and (consp object)
                   (equal (json:get-key object "format" nil) *journal-format*))
        (refuse "it is no journal of a search"))
      (loop for (key . value) in header
            unless (equalp value (json:get-key object key nil))
              do (refuse "it is the journal of another search: ~:[~a differs~;the files of plan or ~
                          domain have changed~]"
                         (string= key "files") key)))))

(defun whole-lines (file)
  "Return the list of the lines of FILE that are whole; what a killed process has left of its last
line is cut off from the file."
  (let* ((text (uiop:read-file-string file :external-format :utf-8))
         (end (position #\Newline text :from-end t))
         (whole (if end (subseq text 0 (1+ end)) "")))
    (unless (= (length whole) (length text))
      (write-file-whole (source:native-name file) whole))
    (uiop:split-string (string-right-trim '(#\Newline) whole) :separator '(#\Newline))))

(defun read-journal (file header table)
  "Put the lines of FILE, whose header must be HEADER, into TABLE."
  (destructuring-bind (first . lines) (whole-lines (source:native-path file))
    (check-header file first header)
    (loop for line in lines
          for number from 2
          ;; The key is the first thing in a line.
          for start = (search "\"key\":" line)
          for open = (and start (position #\" line :start (+ start 6)))
          for close = (and open (position #\" line :start (1+ open)))
          do (unless close
               (refuse-line file number))
             (setf (gethash (subseq line (1+ open) close) table) (cons line number)))))

(defun call-with-journal (search file arguments paths function)
  (if (null file)
      (funcall function)
      (let* ((header (header search arguments paths))
             (name (source:native-name (source:native-path file)))
             (lines (make-hash-table :test #'equal))
             (path (source:native-path file))
             (old (and (uiop:file-exists-p path)
                       (with-open-file (stream path :element-type '(unsigned-byte 8))
                         (plusp (file-length stream))))))
        (when old
          (read-journal name header lines))
        (handler-case
            (with-open-file (stream path :direction :output :if-exists :append
                                         :if-does-not-exist :create :external-format :utf-8)
              (unless old
                (write-line-whole stream header))
              (setf (slot-value search 'journal)
                    (make-journal :file name :stream stream :lines lines
                                  :atoms (observed-atoms
                                          (domain-observers (search-domain search)))))
              (funcall function))
          (file-error (condition)
            (if (equal (file-error-pathname condition) path)
                (error 'journal-error :file name :reason "it cannot be written")
                (error condition)))))))

(defmacro with-journal ((search file arguments paths) &body body)
  "Evaluate BODY, in which SEARCH has the journal in FILE, unless that is NIL.  Signals
JOURNAL-ERROR."
  `(call-with-journal ,search ,file ,arguments ,paths (lambda () ,@body)))
