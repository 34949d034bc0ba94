;;;; Verification: does a safety property hold on all paths?
;;;;
;;;; A property is a formula over ?time that must be true at every timepoint; or that no failure, or
;;;; no error, leaves the plan.  The answer is a VERIFICATION: a counterexample, which is a trace,
;;;; or that there is none, on all paths or on those within the bounds.  Entry point: VERIFY-PLAN.

(in-package #:discrepancy-finder.symbolic-execution)

(defclass verification ()
  ((property :initarg :property :reader verification-property
             :documentation "The property as it was given: a name, a formula, (:never constraint),
:NO-FAILURE or :NO-ERROR.")
   (counterexample :initarg :counterexample :initform nil :reader verification-counterexample
                   :documentation "A trace at whose end the property is violated, or NIL.")
   (problem :initarg :problem :initform nil :reader verification-problem
            :documentation "The failure class or the error, a condition, that leaves the plan at the
end of the counterexample of :NO-FAILURE and :NO-ERROR; else NIL.")
   (exploration :initarg :exploration :reader verification-exploration
                :documentation "The EXPLORATION, with all its figures."))
  (:documentation "Whether a plan has a property."))

(defun verification-verdict (verification)
  "Return :COUNTEREXAMPLE, :VERIFIED (on every path from every initial state that the theory
allows), or :VERIFIED-UP-TO-BOUNDS, see VERIFICATION-BOUNDS."
  (cond ((verification-counterexample verification) :counterexample)
        ((exploration-complete-p (verification-exploration verification)) :verified)
        (t :verified-up-to-bounds)))

(defun verification-bounds (verification)
  "Return what was not explored: a list of sentences."
  (exploration-gaps (verification-exploration verification)))

(defun verdict-text (verification)
  (let ((trace (verification-counterexample verification)))
    (ecase (verification-verdict verification)
      (:counterexample
       (format nil "violated after ~d step~:p" (length (trace-steps trace))))
      (:verified
       (format nil "verified on ~[no path~;its only path~:;all ~:*~d paths~]"
               (exploration-paths (verification-exploration verification))))
      (:verified-up-to-bounds
       (format nil "verified on ~d path~:p, up to bounds"
               (exploration-paths (verification-exploration verification)))))))

(defmethod print-object ((verification verification) stream)
  (print-unreadable-object (verification stream :type t)
    (let ((*print-pretty* nil) (*print-length* 6) (*print-level* 3))
      (format stream "~(~s~) of ~(~a~): ~a" (verification-property verification)
              (plan:plan-name (exploration-plan (verification-exploration verification)))
              (verdict-text verification)))))

(defmethod describe-object ((verification verification) stream)
  (let ((trace (verification-counterexample verification))
        (problem (verification-problem verification)))
    (format stream "~a~%" verification)
    (when trace
      (format stream "  counterexample~@[ with arguments~{ ~(~s~)~}~]: initially~{ ~a~}~%"
              (trace-arguments trace)
              (mapcar #'ec:atom-text (ec:state-fluents (trace-initial-state trace))))
      (dolist (step (trace-steps trace))
        (format stream "    ~@[~a: ~]~a: ~a~%" (and (step-position step)
                                                    (princ-to-string (step-position step)))
                (step-designator step) (step-text step)))
      (format stream "    finally~{ ~a~}~%"
              (mapcar #'ec:atom-text (ec:state-fluents (trace-final-state trace)))))
    (when problem
      (format stream "  ~a~%" (if (typep problem 'condition)
                                  (source:condition-sentence problem)
                                  (format nil "the plan ends in ~(~a~)" problem))))
    (describe-figures (verification-exploration verification) stream)))

;;; Properties

(defun negated-constraint (property domain)
  "Return the state constraint that PROPERTY, a formula, a constraint or its name, is violated."
  (let* ((theory (action-theory-theory domain))
         (formula (if (consp property)
                      property
                      (ec:state-constraint-formula (resolve-constraint property domain)))))
    (ec:parse-state-constraint theory (list :violated '(?time) (list :not formula)))))

(defun violation (property domain)
  "Return what an exploration of DOMAIN looks for when PROPERTY is to be verified: a state
constraint, or PROPERTY itself."
  (check-option :property property
                "a formula, a state constraint, (:never x), :no-failure or :no-error"
                (and property (not (any-action-p property))))
  (cond ((member property '(:no-failure :no-error)) property)
        ((and (consp property) (eq (first property) :never))
         (check-option :never (rest property) "one constraint" (= (length property) 2))
         (resolve-constraint (second property) domain))
        (t (negated-constraint property domain))))

(defun leaves-by-failure-p (path)
  "Return true if a failure leaves the plan at the end of PATH."
  (let ((ending (path-ending path)))
    (and (not (keywordp ending))
         (subtypep ending 'plan:plan-failure))))

(defun trace-of-ending (exploration wanted-p)
  "Run paths of EXPLORATION until WANTED-P is true of one, and return its trace; NIL if there is
none."
  (loop until (or (frontier-empty-p (exploration-frontier exploration))
                  (bound-reached-p exploration))
        do (report-progress exploration)
           (let ((trace (call-timed exploration
                                    (lambda ()
                                      (let ((run (run-next-path exploration)))
                                        (and run (funcall wanted-p (run-path run))
                                             (prog1 (first (whole-trace run))
                                               (note-missed exploration run))))))))
             (when trace (return trace)))))

(defun trace-of-error (exploration)
  "Run paths of EXPLORATION until an error leaves the plan; return the trace and the error, or NIL."
  (let ((problem nil))
    (values (trace-of-ending exploration
                             (lambda (path)
                               (setf problem (path-fatal path))))
            problem)))

(defun verify-plan (plan &rest options &key domain property &allow-other-keys)
  "Return a VERIFICATION whether PLAN (a symbol) in DOMAIN (an ACTION-THEORY or its name) has
PROPERTY on every path, from every initial state and with all arguments:
  a formula over ?time and (+ ?time n), or the name of a state constraint: it holds at every
                    timepoint, as far as the path goes
  (:never X)        the constraint or formula X never comes true
  :no-failure       no plan failure leaves the plan
  :no-error         no other error leaves the plan
The other options are those of MAKE-EXPLORATION but CONSTRAINT and TRACES.  The search ends with
the first counterexample.  Signals what MAKE-EXPLORATION and NEXT-TRACE signal; the restart
STOP-EXPLORING ends the search."
  (let* ((domain (if (typep domain 'action-theory) domain (find-action-theory domain)))
         (violation (violation property domain))
         (ending-p (symbolp violation))
         (exploration (apply #'make-exploration plan domain
                             :constraint (if ending-p :any-action violation)
                             :traces (if ending-p :last :first-instance)
                             :keep-errors (eq property :no-error)
                             (alexandria:remove-from-plist options :domain :property)))
         (trace nil) (problem nil))
    (explore-all exploration
                 (lambda (exploration)
                   (case violation
                     (:no-failure
                      (setf trace (trace-of-ending exploration #'leaves-by-failure-p)
                            problem (and trace (trace-ending trace))))
                     (:no-error
                      (setf (values trace problem) (trace-of-error exploration)))
                     (t (setf trace (next-trace exploration))))
                   nil))
    (make-instance 'verification :property property :counterexample trace
                                 :problem (and trace problem)
                                 :exploration exploration)))
