;;;; Performing: a projection as the executive of plans.
;;;;
;;;; Performing a designator calls EXECUTE-DESIGNATOR, which the process modules of the other
;;;; folders implement.  What no process module is for, but a plan, is performed by that plan.  The
;;;; clock of plans is the time of the world.

(in-package #:discrepancy-finder.projection)

(defgeneric execute-designator (projection class type designator)
  (:documentation "Execute DESIGNATOR, of CLASS :motion or :action and TYPE (a keyword), in
PROJECTION.  A process module is a set of methods on this function.  Signals a PLAN-FAILURE if the
execution fails, DESIGNATOR-NOT-UNDERSTOOD if it cannot be interpreted.")
  (:method ((projection projection) class type designator)
    (error 'plan:designator-not-understood
           :designator designator :executive "The projection"
           :reason (format nil "no process module is for ~(~a~)s of type ~(~a~), and no plan for ~
                                one with these keys" class type))))

(defmethod plan:executive-clock ((projection projection))
  projection)

(defmethod plan:clock-time ((projection projection))
  (float (simulated-seconds projection) 1d0))

(defmethod plan:let-time-pass ((projection projection) seconds)
  (pass-time projection (ceiling seconds +time-step+)))

(defun executes-p (projection designator)
  "Return true if PROJECTION has a process module for DESIGNATOR."
  (let ((default (find-method #'execute-designator '() (list (find-class 'projection) t t t))))
    (not (eq default
             (first (compute-applicable-methods
                     #'execute-designator
                     (list projection (plan:designator-class-keyword designator)
                           (plan:desig-prop-value designator :type) designator)))))))

(defmethod plan:perform-with ((projection projection) designator position)
  (declare (ignore position))
  ;; What a user has a plan for is performed by that, also where a process module is for it.
  (if (or (desig:user-grounded-p designator)
          (and (not (executes-p projection designator)) (plan:plan-known-p designator)))
      (call-next-method)
      (plan:call-on-main
       (lambda ()
         ;; The float traps of C are set once an execution; the plan itself has those of Lisp.
         ;; On another thread than the task's, what resolves locations still finds the projection.
         (plan:with-executive (projection)
           (foreign:with-c-float-traps
             (execute-designator projection (plan:designator-class-keyword designator)
                                 (plan:desig-prop-value designator :type) designator)))))))

(defun pose-meant (value)
  "Return the pose that VALUE, of a designator that is performed, means, or NIL if it is nothing
with a pose.  Signals DESIGNATOR-REFERENCE-FAILURE if it is a location without a solution."
  (or (plan:designated-pose value)
      (when (typep value 'plan:location-designator)
        (plan:try-reference-designator value)
        nil)))

(defun misunderstood (designator reason)
  "Signal that DESIGNATOR is not understood for REASON, a format control without arguments."
  (error 'plan:designator-not-understood :designator designator :executive "The projection"
                                         :reason (format nil reason)))
