;;;; Reading replay files.  Every value is checked against what the plan and the domain know; what
;;;; does not fit is a REPLAY-ERROR that names the file and the key.

(in-package #:discrepancy-finder.discrepancy)

(define-condition replay-fault (error)
  ((reason :initarg :reason :reader replay-fault-reason))
  (:documentation "Signaled within a file; READ-REPLAY-FILE, which knows its name, makes it
REPLAY-ERROR."))

(defun replay-problem (control &rest arguments)
  (error 'replay-fault :reason (apply #'format nil control arguments)))

(defun value-of (object key type)
  "Return the value of KEY in the JSON OBJECT; TYPE is a Lisp type that it must have."
  (unless (listp object)
    (replay-problem "an object with the key ~s was expected" key))
  (let ((value (json:get-key object key)))
    (unless (typep value type)
      (replay-problem "the value of ~s is not of the kind expected" key))
    value))

(defun keyword-of (object key choices)
  "Return the one of the keywords CHOICES that KEY names in OBJECT."
  (or (find (value-of object key 'string) choices :test #'string-equal)
      (replay-problem "~s is ~s where one of ~{~(~a~)~^, ~} was expected" key
                      (value-of object key 'string) choices)))

(defun double-of (object key)
  "Return the number that KEY has in OBJECT as a double float."
  (let ((value (value-of object key 'real)))
    (if (typep value '(or double-float (integer -1000000000 1000000000)))
        (float value 1d0)
        (replay-problem "the number of ~s is too large" key))))

(defun atom-of (text candidates kind)
  (or (and (stringp text) (ec:text-atom text candidates))
      (replay-problem "~s is no ~a of the theory" text kind)))

(defun failure-classes (&optional (class (find-class 'plan:plan-failure)))
  (cons (class-name class)
        (mapcan #'failure-classes (copy-list (sb-mop:class-direct-subclasses class)))))

(defun outcome-of (text)
  "Return the outcome named by TEXT: :SUCCESS or a failure class that exists."
  (if (string= text "success")
      :success
      (or (find text (failure-classes) :test #'string-equal)
          (replay-problem "there is no failure class ~a" text))))

(defun symbol-of (text)
  "Return the plan name that TEXT names, or NIL.  Nothing is interned."
  (find-symbol (if (string= text (string-downcase text)) (string-upcase text) text)
               '#:discrepancy-finder-user))

(defun locate-near (file folder)
  "Return FILE as LOCATE-FILE finds it, or below FOLDER, the replay file's, or the one above."
  (or (locate-file file)
      (loop for directory in (list folder (uiop:pathname-parent-directory-pathname folder))
            for candidate = (merge-pathnames (uiop:parse-native-namestring file) directory)
            when (uiop:file-exists-p candidate)
              return (uiop:native-namestring candidate))))

(defun read-plan (object folder)
  (let* ((name (value-of object "name" 'string))
         (file (value-of object "file" '(or string (eql :null))))
         (plan (or (let ((symbol (symbol-of name))) (and symbol (plan:plan-source symbol)))
                   (let ((located (and (stringp file) (locate-near file folder))))
                     (when located (plan:load-plan located))
                     (let ((symbol (symbol-of name))) (and symbol (plan:plan-source symbol)))))))
    (or plan
        (replay-problem "there is no plan ~a~@[; its file ~a is not found~]" name
                        (and (stringp file) (not (locate-near file folder)) file)))))

(defun read-domain (object folder)
  (let* ((name (value-of object "name" 'string))
         (file (value-of object "file" '(or string (eql :null)))))
    (flet ((registered ()
             (find name (symbolic:all-action-theories)
                   :key (lambda (domain) (ec:name-text (symbolic:action-theory-name domain)))
                   :test #'string=)))
      (or (registered)
          (let ((located (and (stringp file) (locate-near file folder))))
            (when located (load-domain located))
            (registered))
          (replay-problem "there is no domain ~a~@[; its file ~a is not found~]" name
                          (and (stringp file) (not (locate-near file folder)) file))))))

(defun read-parameters (object scene)
  (loop for (name . value) in object
        for key = (find-symbol (string-upcase name) :keyword)
        do (unless (and key (projection:scene-knows-p scene key) (typep value 'double-float))
             (replay-problem "~s: ~a is no parameter of the scene with a number" "parameters" name))
        append (handler-case (projection:normalized-parameters scene (list key value))
                 (projection:impossible-parameter (condition)
                   (replay-problem "~s: ~a" "parameters"
                                   (string-right-trim "." (princ-to-string condition)))))))

(defun read-step (object domain)
  (let ((event (value-of object "event" '(or string (eql :null)))))
    (symbolic:make-trace-step
     :designator (value-of object "designator" 'string)
     :event (and (stringp event)
                 (atom-of event (ec:ground-theory-events (symbolic:action-theory-ground domain))
                          "event"))
     :outcome (outcome-of (value-of object "outcome" 'string)))))

(defun read-states (ground fluents steps)
  "Return the states of the theory GROUND along STEPS, from the one in which just FLUENTS hold; the
theory must allow them."
  (multiple-value-bind (states refused) (symbolic:states-along ground fluents steps)
    (when refused
      (replay-problem "the theory as it is now does not allow ~:[step ~d of the trace~;the trace's ~
                       initial state~]" (zerop refused) refused))
    states))

(defun argument-of (value)
  (handler-case (symbolic:argument-from-json value)
    (symbolic:invalid-trace (condition)
      (replay-problem "~s: ~a" "arguments" (symbolic:invalid-trace-reason condition)))))

(defun read-arguments (object plan)
  (let ((arguments (map 'list #'argument-of (value-of object "arguments" 'simple-vector))))
    (handler-case (check-plan-arguments (plan:plan-name plan) arguments)
      (invalid-argument () (replay-problem "~s do not fit the plan" "arguments")))
    arguments))

(defun read-trace (object plan domain)
  (let* ((ground (symbolic:action-theory-ground domain))
         (true (map 'list
                    (lambda (text) (atom-of text (ec:ground-theory-fluents ground) "fluent"))
                    (value-of object "initial" 'simple-vector)))
         (steps (map 'list (lambda (step) (read-step step domain))
                     (value-of object "steps" 'simple-vector))))
    (unless steps
      (replay-problem "the trace has no steps"))
    (symbolic:make-execution-trace
     :plan (plan:plan-name plan) :steps steps :arguments (read-arguments object plan)
     :states (read-states ground true steps))))

(defun parameter-value (values parameter)
  "Return the value of PARAMETER in the JSON object VALUES, which must be within its bounds."
  (let ((value (double-of values (parameter-name parameter))))
    (unless (<= (parameter-min parameter) value (parameter-max parameter))
      (replay-problem "~a is ~a, which is not between ~a and ~a" (parameter-name parameter) value
                      (parameter-min parameter) (parameter-max parameter)))
    value))

(defun read-sample (object parameters)
  (let ((values (append (value-of object "values" 'list)
                        ;; Where no tolerance is drawn there is no such key.
                        (and (json:get-key object "tolerances" nil)
                             (value-of object "tolerances" 'list)))))
    (unless (= (length values) (length parameters))
      (replay-problem "the sample has ~d values where the trace has ~d parameters"
                      (length values) (length parameters)))
    (make-sample (let ((index (value-of object "index" '(or (integer 0) (eql :null)))))
                   (and (integerp index) index))
                 parameters
                 (coerce (loop for parameter in parameters
                               collect (parameter-value values parameter))
                         '(simple-array double-float (*))))))

(defun read-left-out (object scene)
  "Return the names of the items of SCENE that OBJECT leaves out."
  (loop for text across (value-of object "left-out" 'simple-vector)
        collect (or (find text (projection:scene-item-names scene)
                          :key #'ec:name-text :test #'equal)
                    (replay-problem "~s: the scene has no item ~a" "left-out" text))))

(defun read-actions (object)
  "Return the RECORDED-ACTIONs that OBJECT tells, with no places in the plan."
  (loop for description across (value-of object "actions" 'simple-vector)
        collect (handler-case (action-from-json description)
                  (unreadable-action (condition)
                    (replay-problem "~s: ~a" "actions" (unreadable-action-reason condition))))))

(defun read-constraint (text domain)
  "Return the state constraint in TEXT, as CONSTRAINT-TEXT makes it: its name, or a formula."
  (let ((constraint (find text (ec:theory-state-constraints (symbolic:action-theory-theory domain))
                          :key (lambda (constraint)
                                 (ec:name-text (ec:state-constraint-name constraint)))
                          :test #'string=)))
    (cond (constraint (ec:state-constraint-name constraint))
          ((string= text "any-action") :any-action)
          ((alexandria:starts-with #\( text)
           (handler-case (formula-from-text text)
             (error ()
               (replay-problem "~s: ~a cannot be read" "constraint" text))))
          (t (replay-problem "the theory has no state constraint ~a" text)))))

(defun read-recorded-run (object)
  "Return the state hash and the verdict that were recorded, as a list."
  (let ((hash (value-of object "hash" 'string)))
    (unless (and (= (length hash) 16) (every (lambda (c) (digit-char-p c 16)) hash))
      (replay-problem "~s is no state hash" hash))
    (list (parse-integer hash :radix 16)
          (keyword-of object "verdict" '(:discrepancy)))))

(defun changed-files (object folder)
  "Return the names of the files whose text has changed since the discrepancy was stored."
  (loop for (file . hash) in (value-of object "files" 'list)
        unless (equal hash (json-or-null (file-hash (or (locate-near file folder) file))))
          collect file))

(defun check-strings (object key)
  "Check that KEY has an array of strings in OBJECT."
  (unless (every #'stringp (value-of object key 'simple-vector))
    (replay-problem "~s is no array of strings" key)))

(defun newer-part (object)
  "Return the JSON object that has what files of the first format lack: OBJECT, or, if it is of that
format, one that says what was always so then."
  (if (equal (json:get-key object "format" nil) *replay-format*)
      object
      (json:object "comparison" "consistent" "actions" (vector) "left-out" (vector))))

(defun check-replay (object)
  "Check the parts of OBJECT that can be checked without plan and domain, which are code and are
loaded only for a file that has this form."
  (check-format object)
  (dolist (key '("plan" "domain" "parameters" "files" "trace" "sample" "run"))
    (value-of object key 'list))
  (value-of object "seed" '(unsigned-byte 64))
  (value-of object "constraint" 'string)
  (keyword-of object "execution" '(:trace :plan))
  (keyword-of object "compare" '(:final :every-step))
  (let ((run (value-of object "run" 'list)))
    (read-recorded-run run)
    (check-strings run "final")
    (value-of (value-of run "divergence" 'cons) "step" '(integer 1)))
  (check-strings (value-of object "trace" 'list) "initial")
  (keyword-of (newer-part object) "comparison" '(:consistent :exact))
  (check-strings (newer-part object) "left-out")
  (value-of (newer-part object) "actions" 'simple-vector)
  (value-of (value-of object "sample" 'list) "index" '(or (unsigned-byte 32) (eql :null))))

(defun check-format (object)
  (unless (and (listp object)
               (member (json:get-key object "format" nil) (cons *replay-format* *older-formats*)
                       :test #'equal))
    (replay-problem "it is no replay file: ~s should be ~s" "format" *replay-format*)))

(defun parse-replay (object folder)
  "Return what OBJECT, the content of a replay file in FOLDER, tells: a property list."
  (check-replay object)
  (let* ((plan (read-plan (value-of object "plan" 'list) folder))
         (domain (read-domain (value-of object "domain" 'list) folder))
         (parameters (read-parameters (value-of object "parameters" 'list) (domain-scene domain)))
         (left-out (read-left-out (newer-part object) (domain-scene domain)))
         (domain (domain-without-items (domain-with-parameters domain parameters) left-out))
         (trace (read-trace (value-of object "trace" 'list) plan domain)))
    (list :plan plan :domain domain :parameters parameters :trace trace
          :actions (read-actions (newer-part object)) :left-out left-out
          :constraint (read-constraint (value-of object "constraint" 'string) domain)
          :execution (keyword-of object "execution" '(:trace :plan))
          :compare (keyword-of object "compare" '(:final :every-step))
          :comparison (keyword-of (newer-part object) "comparison" '(:consistent :exact))
          :seed (value-of object "seed" '(unsigned-byte 64))
          :sample (read-sample (value-of object "sample" 'list)
                               (handler-case (initial-parameters domain trace)
                                 (sampling-error (condition)
                                   (replay-problem "~a" (sampling-error-reason condition)))))
          :recorded (read-recorded-run (value-of object "run" 'list))
          :changed-files (changed-files object folder))))

(defun read-replay-file (file)
  "Return the property list that PARSE-REPLAY makes of FILE.  Signals REPLAY-ERROR."
  (let ((path (source:native-path file)))
    (flet ((refuse (reason)
             (error 'replay-error :file (source:native-name path) :reason reason)))
      (cond ((uiop:directory-exists-p (uiop:ensure-directory-pathname path))
             (refuse "it is a folder"))
            ((not (uiop:file-exists-p path)) (refuse "no such file")))
      (handler-case (parse-replay (json:parse (uiop:read-file-string path :external-format :utf-8))
                                  (uiop:pathname-directory-pathname (truename path)))
        (replay-fault (fault) (refuse (replay-fault-reason fault)))
        (json:json-error (condition) (refuse (source:condition-sentence condition)))
        (file-error () (refuse "it cannot be read"))
        (stream-error () (refuse "it is not a UTF-8 text"))))))
