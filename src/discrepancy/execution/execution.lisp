;;;; Execution: a plan run concretely from a sample, and what was seen of it.
;;;;
;;;; EXECUTE-SAMPLE builds the world, lets it settle, checks that the sample is valid, and runs the
;;;; compiled plan with a MONITOR for its executive.  The monitor lets the projection perform each
;;;; designator and records event, outcome and observed state.  With :EXECUTION :TRACE the run stops
;;;; at the first step that differs from the trace's, or at the trace's end; with :PLAN it goes on
;;;; to the plan's end.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *penetration-tolerance* 1d-3
  "The depth (m) to which bodies may penetrate each other in a valid sample.")

(defstruct (run-step (:copier nil))
  "A performed designator: OUTCOME is :SUCCESS or a failure class, CANDIDATES the outcomes of the
action binding that it can be (none if the binding has no such outcome), FAILURE the failure in
words, STATE what was observed afterwards."
  (designator nil :read-only t)
  (outcome :success :type symbol :read-only t)
  (candidates '() :type list :read-only t)
  (failure nil :type (or null string) :read-only t)
  (position nil :read-only t)
  (state '() :type list :read-only t))

(setf (documentation 'run-step-designator 'function)
      "Return the designator that was performed in a step."
      (documentation 'run-step-outcome 'function)
      "Return the outcome of a step: :SUCCESS or the class of the failure."
      (documentation 'run-step-failure 'function)
      "Return the failure of a step in words, or NIL."
      (documentation 'run-step-state 'function)
      "Return what was observed after a step: a list of (atom . truth).")

(defmethod print-object ((step run-step) stream)
  (print-unreadable-object (step stream :type t)
    (format stream "~a -> ~(~a~)" (run-step-designator step) (run-step-outcome step))))

(defstruct (run (:copier nil))
  "A concrete execution.  VALIDITY is :VALID or a sentence that says why the sample is not; ENDING
is :TRACE-DONE, :LEFT-TRACE, :FINISHED, :TOO-MANY-STEPS or the class of an unhandled failure.
JOURNALED-P is true if it was read from a journal."
  (sample nil :read-only t)
  (journaled-p nil :type boolean :read-only t)
  (validity :valid :read-only t)
  (ending nil :read-only t)
  (initial-state '() :type list :read-only t)
  (steps '() :type list :read-only t)
  (final-state '() :type list :read-only t)
  (final-values #() :type vector :read-only t)
  (tolerances '() :type list :read-only t)
  (hash 0 :type (unsigned-byte 64) :read-only t)
  (seconds 0d0 :type double-float :read-only t))

(setf (documentation 'run-sample 'function)
      "Return the SAMPLE from which a run begins."
      (documentation 'run-validity 'function)
      "Return :VALID, or a sentence that says why the sample of a run is not valid."
      (documentation 'run-ending 'function)
      "Return how a run ended: :TRACE-DONE, :LEFT-TRACE, :FINISHED, :TOO-MANY-STEPS, :NOT-RUN or
the class of an unhandled failure."
      (documentation 'run-initial-state 'function)
      "Return what was observed at the beginning of a run: a list of (atom . truth)."
      (documentation 'run-steps 'function)
      "Return the list of the steps of a run."
      (documentation 'run-final-state 'function)
      "Return what was observed at the end of a run: a list of (atom . truth)."
      (documentation 'run-final-values 'function)
      "Return the vector of the final parameters of a run (m, rad)."
      (documentation 'run-tolerances 'function)
      "Return the property list of the values that the scene's tolerances had in a run."
      (documentation 'run-hash 'function)
      "Return the hash of the bits of the final state of a run."
      (documentation 'run-seconds 'function)
      "Return the simulated time (s) of a run.")

(defmethod print-object ((run run) stream)
  (print-unreadable-object (run stream :type t)
    (format stream "~:[invalid~;~:*~d step~:p~], ~(~a~), ~,2f s simulated,~{ ~a~}"
            (and (eq (run-validity run) :valid) (length (run-steps run)))
            (run-ending run) (run-seconds run)
            (mapcar #'ec:atom-text (observed-fluents (run-final-state run))))))

(defparameter *step-limit* 1000
  "A run is ended after so many performed designators.")

(defclass monitor ()
  ((domain :initarg :domain :reader monitor-domain)
   (projection :initarg :projection :reader monitor-projection)
   (expected :initarg :expected :accessor monitor-expected
             :documentation "The steps of the trace that are still to come, or :NONE.")
   (handlers :initform (plan:current-handlers) :reader monitor-handlers
             :documentation "The condition handlers from outside the plan.")
   (ending :initform nil :accessor monitor-ending
           :documentation "Why the run is being left, or NIL.")
   (fatal :initform nil :accessor monitor-fatal
          :documentation "The error that ends the run, or NIL.")
   (steps :initform '() :accessor monitor-steps :documentation "Newest first.")
   (on-step :initarg :on-step :initform nil :reader monitor-on-step
            :documentation "A function of the list of the steps, called after each, or NIL."))
  (:documentation "The executive of a recorded run."))

(defun leave-run (monitor ending)
  "Leave the run of MONITOR; ENDING, a keyword, says why."
  (setf (monitor-ending monitor) ending)
  (plan:leave-plan monitor ending))

(defun fitting-outcomes (outcomes failure)
  "Return those of OUTCOMES that FAILURE, a condition or NIL for success, can be."
  (remove-if-not (lambda (outcome)
                   (let ((name (symbolic:outcome-name outcome)))
                     (if failure
                         (and (not (eq name :success)) (typep failure name))
                         (eq name :success))))
                 outcomes))

(defun same-step-p (step expected)
  (some (lambda (outcome)
          (and (equal (symbolic:outcome-event outcome) (symbolic:step-event expected))
               (eq (symbolic:outcome-name outcome) (symbolic:step-outcome expected))))
        (run-step-candidates step)))

(defun note-step (monitor step)
  "Record STEP and leave the run if there is nothing more to compare with."
  (push step (monitor-steps monitor))
  (when (monitor-on-step monitor)
    (funcall (monitor-on-step monitor) (reverse (monitor-steps monitor))))
  (unless (eq (monitor-expected monitor) :none)
    (let ((expected (pop (monitor-expected monitor))))
      (cond ((not (same-step-p step expected)) (leave-run monitor :left-trace))
            ((null (monitor-expected monitor)) (leave-run monitor :trace-done))))))

(defun record-step (monitor designator position outcomes failure)
  "Record that DESIGNATOR, which may have OUTCOMES, was performed and ended in FAILURE or NIL."
  (note-step monitor
             (make-run-step :designator designator :position position
                            :outcome (if failure (type-of failure) :success)
                            :candidates (fitting-outcomes outcomes failure)
                            :failure (and failure (source:condition-sentence failure))
                            :state (discrete-state (monitor-domain monitor)
                                                   (monitor-projection monitor)))))

(defun call-watched (monitor function)
  "Call FUNCTION, which is no business of the plan, on the thread of the top-level."
  (plan:call-on-main
   (lambda ()
     (plan:with-handlers ((monitor-handlers monitor))
       (handler-bind ((error (lambda (condition)
                               (setf (monitor-fatal monitor) condition))))
         (funcall function))))))

(defun perform-concretely (monitor designator position)
  "Let the projection of MONITOR perform DESIGNATOR; what it has no process module for, but the plan
has a plan for, is performed by that plan, whose own motions are no steps.  Return the failure or
NIL, and the result."
  (let* ((projection (monitor-projection monitor))
         (native (or (projection:executes-p projection designator)
                     (not (plan:plan-known-p designator)))))
    (flet ((attempt (function)
             (handler-case (values nil (funcall function))
               (plan:plan-failure (failure) failure))))
      (if native
          (call-watched monitor
                        (lambda ()
                          (attempt (lambda ()
                                     (plan:perform-with projection designator position)))))
          (attempt (lambda ()
                     (plan:with-executive (projection)
                       (plan:generic-perform designator))))))))

(defmethod plan:executive-clock ((monitor monitor))
  (plan:executive-clock (monitor-projection monitor)))

(defmethod plan:perform-with ((monitor monitor) designator position)
  (cond ((monitor-fatal monitor) nil)   ; an error unwinds: let it go on
        ((monitor-ending monitor) (plan:leave-plan monitor (monitor-ending monitor)))
        ((symbolic:entered-p (monitor-domain monitor) designator) (call-next-method))
        ((>= (length (monitor-steps monitor)) *step-limit*) (leave-run monitor :too-many-steps))
        (t
         (let* ((plan (plan:current-plan-name))
                (outcomes (call-watched monitor
                                        (lambda ()
                                          (symbolic:action-outcomes (monitor-domain monitor)
                                                                    designator
                                                                    :plan plan
                                                                    :position position)))))
           (multiple-value-bind (failure result) (perform-concretely monitor designator position)
             (call-watched monitor
                           (lambda ()
                             (record-step monitor designator position outcomes failure)))
             (if failure
                 (plan:fail failure)
                 result))))))

(defun sample-validity (projection trace state)
  "Return :VALID if the settled PROJECTION with the discrete STATE is an initial state of TRACE, or
a sentence that says why not."
  (multiple-value-bind (depth names) (projection:interpenetration projection)
    (let ((differing (and trace
                          (loop for (atom . truth) in state
                                unless (eq truth (ec:fluent-value
                                                  (symbolic:trace-initial-state trace) atom))
                                  collect (ec:atom-text atom)))))
      (cond ((> depth *penetration-tolerance*)
             (format nil "~{~a and ~a~} penetrate each other by ~,4f m" names depth))
            (differing (format nil "after settling, ~{~a~^, ~} differ~@[s~] from the trace"
                               differing (null (rest differing))))
            (t :valid)))))

(defun observed-final-values (domain projection trace)
  (coerce (loop for parameter in (final-parameters domain trace)
                collect (coordinate (projection:observed-pose projection
                                                              (parameter-body parameter))
                                    (parameter-axis parameter)))
          '(simple-array double-float (*))))

(defun run-monitored (monitor plan function)
  "Call FUNCTION, which does what PLAN (a symbol) does, under MONITOR and return how it ended.
Random numbers are the same in every run, and the same as in symbolic execution."
  (count-simulation)
  (let ((*random-state* (sb-ext:seed-random-state 0))
        (*gensym-counter* 0))
    (prog1 (catch monitor
             (plan:with-executive (monitor)
               (handler-case
                   (progn (symbolic:call-plan plan function '()
                                              (lambda (condition)
                                                (setf (monitor-fatal monitor) condition)))
                          :finished)
                 (plan:plan-failure (failure) (type-of failure)))))
      ;; A cleanup form may have replaced the unwinding by a way out of its own.
      (when (monitor-fatal monitor)
        (error (monitor-fatal monitor))))))

(defun projection-tolerances (projection)
  "Return the property list of the values that the tolerances of the scene have in PROJECTION."
  (loop for (name) in (projection:scene-tolerances (projection:projection-scene projection))
        append (list name (projection:projection-parameter projection name))))

(defmacro with-open-projection ((variable form) &body body)
  "Evaluate BODY with VARIABLE bound to the projection that FORM makes, and close that afterwards."
  `(call-timed (lambda ()
                 (let ((,variable ,form))
                   (unwind-protect (progn ,@body)
                     (projection:close-projection ,variable))))))

(defun plan-function (plan arguments actions)
  "Return a function that calls PLAN (a symbol) with ARGUMENTS, or, if there are ACTIONS, performs
these."
  (if actions
      (lambda () (plan:ensure-top-level (lambda () (perform-actions actions)) plan))
      (lambda () (apply plan arguments))))

(defun execute-sample (domain plan sample &key trace (execution :trace) arguments actions
                                            (output (make-broadcast-stream)) (fidelity :fast)
                                            observer on-step)
  "Run PLAN (a symbol) with ARGUMENTS in a new world of DOMAIN that begins with SAMPLE, and return
the RUN; if there are ACTIONS, RECORDED-ACTIONs, perform these in the place of the plan.  With a
TRACE the sample must map to its initial state, else the run is invalid and has no steps; EXECUTION
is :TRACE or :PLAN, FIDELITY :FAST or :FULL.  What the plan prints goes to OUTPUT.
OBSERVER is a function of a projection, a designator and a failure, or NIL, as for
PROJECTION:WATCH-PROJECTION; it is called once more at the end.  ON-STEP is NIL or a function of a
projection, the observed initial state and the list of the RUN-STEPs so far, called after each.  The
same arguments give the same bits, provided that the plan does not read global variables that it
writes."
  (with-open-projection (projection (projection:make-projection
                                     (domain-scene domain)
                                     :poses (sample-poses (domain-scene domain) sample)
                                     :joints (sample-joints sample)
                                     :parameters (sample-tolerances sample)
                                     :fidelity fidelity))
    ;; What is built into something else is invalid, however it comes apart.
    (let* ((built (sample-validity projection nil '()))
           (settled (projection:settle projection))
           (initial-state (discrete-state domain projection))
           (validity (cond ((not (eq built :valid)) built)
                           ((not settled) "it does not come to rest")
                           (t (sample-validity projection trace initial-state)))))
      (flet ((result (ending steps)
               (make-run :sample sample :validity validity :ending ending
                         :tolerances (projection-tolerances projection)
                         :initial-state initial-state :steps steps
                         :final-state (discrete-state domain projection)
                         :final-values (if trace
                                           (observed-final-values domain projection trace)
                                           #())
                         :hash (projection:state-hash projection)
                         :seconds (float (projection:simulated-seconds projection) 1d0))))
        (when observer
          (projection:watch-projection projection observer))
        (if (eq validity :valid)
            (let* ((monitor (make-instance 'monitor
                                           :domain domain :projection projection
                                           :on-step (and on-step
                                                         (lambda (steps)
                                                           (funcall on-step projection
                                                                    initial-state steps)))
                                           :expected (if (and trace (eq execution :trace))
                                                         (symbolic:trace-steps trace)
                                                         :none)))
                   (ending (let ((*standard-output* output))
                             (run-monitored monitor plan
                                              (plan-function plan arguments actions)))))
              (when observer
                (funcall observer projection nil nil))
              (result ending (reverse (monitor-steps monitor))))
            (result :not-run '()))))))

(defun check-state-argument (state)
  "Signal INVALID-ARGUMENT unless STATE is a list of (body axis value ...)."
  (unless (and (alexandria:proper-list-p state)
               (every (lambda (entry)
                        (and (alexandria:proper-list-p entry) (oddp (length entry))
                             (symbolp (first entry))))
                      state))
    (error 'invalid-argument :name 'state :value state
                             :expected "a list of (body axis number ...)")))

(defun state-sample (scene state seed)
  "Return the sample of SCENE in which the bodies have the coordinates in STATE, the argument of
RUN-PLAN, and the tolerances the values that SEED draws, or those in the middle if it is NIL."
  (check-state-argument state)
  (unless (typep seed '(or null (unsigned-byte 64)))
    (error 'invalid-argument :name 'seed :value seed :expected "an integer from 0 to 2^64 - 1"))
  (draw-sample
   (append (loop for (body . coordinates) in state
                 append (loop for (axis value) on coordinates by #'cddr
                              do (unless (and (assoc axis *axes*) (realp value))
                                   (error 'invalid-argument :name 'state
                                                            :value (list body axis value)
                                                            :expected "(body axis number)"))
                                 (projection:check-movable scene body)
                              collect (make-parameter (ec:name-keyword body) axis
                                                      (decimal-double value)
                                                      (decimal-double value))))
           (and seed (tolerance-parameters scene)))
   (or seed 0) 0 0))

(defun run-plan (plan &key domain state parameters arguments seed (fidelity :fast) observer)
  "Run PLAN (a symbol) concretely in DOMAIN (a domain or its name) and return the RUN.  STATE is a
list of (BODY axis value ...), such as ((box :x 1.3 :y 0.41)); what it leaves out is as in the
scene.  PARAMETERS is a property list of scene parameters, ARGUMENTS are the plan's.  With SEED, an
integer, the tolerances of the scene that PARAMETERS does not give are drawn; else they are in the
middle of their ranges.  FIDELITY is :FAST or :FULL, OBSERVER as for EXECUTE-SAMPLE.  Signals
PLAN-NOT-FOUND, DOMAIN-NOT-FOUND, UNKNOWN-BODY, UNKNOWN-PARAMETER, INVALID-ARGUMENT."
  (let* ((plan (plan:plan-name (ensure-plan plan)))
         (domain (domain-with-parameters (ensure-domain domain) parameters))
         (sample (state-sample (domain-scene domain) state seed)))
    (check-plan-arguments plan arguments)
    (execute-sample domain plan sample :arguments arguments :output *standard-output*
                                       :fidelity fidelity :observer observer)))

(defun check-plan-arguments (plan arguments)
  "Signal INVALID-ARGUMENT unless PLAN (a symbol) can be called with the list ARGUMENTS."
  (multiple-value-bind (required optional rest keywords)
      (alexandria:parse-ordinary-lambda-list (plan:plan-lambda-list (plan:find-plan plan)))
    (unless (and (listp arguments) (<= (length required) (length arguments))
                 (or rest keywords
                     (<= (length arguments) (+ (length required) (length optional)))))
      (error 'invalid-argument :name 'arguments :value arguments
                               :expected (format nil "a list for the lambda list ~(~s~)"
                                                 (plan:plan-lambda-list
                                                  (plan:find-plan plan)))))))
