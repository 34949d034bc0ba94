;;;; Traces as JSON text.
;;;;
;;;; A text has the plan, its arguments, the true fluents (and the numbers) of each state, the steps
;;;; and decisions with their places in the plan.  Reading evaluates nothing and interns nothing;
;;;; the states are made again by the theory, which must allow them.  Entry points: TRACE-TO-JSON,
;;;; TRACE-FROM-JSON.

(in-package #:discrepancy-finder.symbolic-execution)

(defparameter *trace-format* "discrepancy-finder trace 1"
  "The value of \"format\" in such texts.")

(defun refuse-trace (control &rest arguments)
  (error 'invalid-trace :reason (apply #'format nil control arguments)))

;;; Writing

(defun value-json (value)
  "Return VALUE, an argument or the name of something, as a JSON value."
  (typecase value
    (null :false)
    ((eql t) :true)
    (string value)
    (integer value)
    (ratio (json:object "ratio" (princ-to-string value)))
    (symbol (json:object "symbol" (symbol-name value)
                         "package" (if (symbol-package value)
                                       (package-name (symbol-package value))
                                       :null)))
    (t (refuse-trace "~s cannot be written as JSON" value))))

(defun position-json (position)
  (if position
      (json:object "file" (source:source-position-file position)
                   "line" (source:source-position-line position))
      :null))

(defun state-json (state)
  (json:object "true" (map 'vector #'ec:atom-text (ec:state-fluents state))
               "numbers" (map 'vector #'princ-to-string (ec:state-numbers state))))

(defun step-json (step)
  (json:object "designator" (step-designator step)
               "event" (if (step-event step) (ec:atom-text (step-event step)) :null)
               "outcome" (value-json (step-outcome step))
               "position" (position-json (step-position step))))

(defun decision-json (decision)
  (json:object "text" (taken-text decision) "choice" (taken-choice decision)
               "time" (taken-time decision)))

(defun trace-to-json (trace)
  "Return TRACE as a JSON text.  Signals INVALID-TRACE if an argument cannot be written."
  (json:encode
   (json:object "format" *trace-format*
                "plan" (value-json (trace-plan trace))
                "arguments" (map 'vector #'value-json (trace-arguments trace))
                "states" (map 'vector #'state-json (trace-states trace))
                "steps" (map 'vector #'step-json (trace-steps trace))
                "decisions" (map 'vector #'decision-json (trace-decisions trace))
                "ending" (value-json (trace-ending trace))
                "output" (trace-output trace))))

;;; Reading

(defun part (object key type)
  "Return the value of KEY in the JSON OBJECT, which must be of TYPE."
  (let ((value (json:get-key object key)))
    (unless (typep value type)
      (refuse-trace "~s is not what it should be" key))
    value))

(defun symbol-from-json (object)
  (let* ((name (part object "symbol" 'string))
         (package-name (part object "package" '(or string (eql :null))))
         (package (and (stringp package-name) (find-package package-name))))
    (or (and package (find-symbol name package))
        (refuse-trace "there is no symbol ~a in package ~a" name package-name))))

(defun value-from-json (value)
  (cond ((eq value :true) t)
        ((eq value :false) nil)
        ((stringp value) value)
        ((integerp value) value)
        ((and (consp value) (assoc "ratio" value :test #'equal))
         (number-from-text (part value "ratio" 'string)))
        ((consp value) (symbol-from-json value))
        (t (refuse-trace "~s is no argument" value))))

(defun number-from-text (text)
  (let ((slash (position #\/ text)))
    (handler-case
        (if slash
            (/ (parse-integer text :end slash) (parse-integer text :start (1+ slash)))
            (parse-integer text))
      (arithmetic-error () (refuse-trace "~s is no number" text))
      (parse-error () (refuse-trace "~s is no number" text)))))

(defun atom-from-json (text atoms kind)
  (or (and (stringp text) (find text atoms :key #'ec:atom-text :test #'string=))
      (refuse-trace "the theory has no ~a ~a" kind text)))

(defun position-from-json (object)
  (if (eq object :null)
      nil
      (source:make-source-position (part object "file" 'string)
                                   (part object "line" '(integer 1)))))

(defun step-from-json (object ground)
  (let ((event (part object "event" '(or string (eql :null)))))
    (make-trace-step
     :designator (part object "designator" 'string)
     :event (and (stringp event)
                 (atom-from-json event (ec:ground-theory-events ground) "event"))
     :outcome (symbol-from-json (part object "outcome" 'list))
     :position (position-from-json (part object "position" '(or list (eql :null)))))))

(defun decision-from-json (object)
  (make-trace-decision :text (part object "text" 'string) :choice (part object "choice" 'string)
                       :time (part object "time" '(integer 0))))

(defun state-from-json (object ground)
  "Return the list of the true fluents and that of the numbers of the state in OBJECT."
  (list (map 'list
             (lambda (text) (atom-from-json text (ec:ground-theory-fluents ground) "fluent"))
             (part object "true" 'simple-vector))
        (map 'list
             (lambda (text)
               (if (stringp text)
                   (number-from-text text)
                   (refuse-trace "~s is no number" text)))
             (part object "numbers" 'simple-vector))))

(defun list-from-json (object key function)
  (map 'list function (part object key 'simple-vector)))

(defun trace-from-json (text domain)
  "Return the EXECUTION-TRACE in the JSON TEXT, for DOMAIN, an ACTION-THEORY or its name.  Signals
JSON-ERROR, and INVALID-TRACE if the text is no trace or the theory does not allow it."
  (let* ((domain (if (typep domain 'action-theory) domain (find-action-theory domain)))
         (ground (action-theory-ground domain))
         (object (json:parse text)))
    (unless (and (listp object) (equal (json:get-key object "format" nil) *trace-format*))
      (refuse-trace "it is not in the format ~s" *trace-format*))
    (let ((steps (list-from-json object "steps" (lambda (step) (step-from-json step ground))))
          (given (list-from-json object "states" (lambda (state) (state-from-json state ground)))))
      (unless (= (length given) (1+ (length steps)))
        (refuse-trace "it has ~d state~:p and ~d step~:p" (length given) (length steps)))
      (multiple-value-bind (states refused)
          (states-along ground (first (first given)) steps :states given)
        (when (or refused (null states))
          (refuse-trace "the theory does not allow its ~:[state after step ~d~;initial state~]"
                        (eql refused 0) refused))
        (make-execution-trace
         :plan (symbol-from-json (part object "plan" 'list))
         :arguments (list-from-json object "arguments" #'value-from-json)
         :steps steps :states states
         :decisions (list-from-json object "decisions" #'decision-from-json)
         :ending (symbol-from-json (part object "ending" 'list))
         :output (part object "output" 'string))))))
