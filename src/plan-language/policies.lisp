;;;; Policies: conditions under which a body must not go on.
;;;;
;;;; A policy has parameters and up to four parts: :INIT runs first and must be true, :CHECK is
;;;; asked every 0.01 s of the plan's clock while the body runs, and when it is true the body
;;;; evaporates, :RECOVER runs, and WITH-POLICY fails with POLICY-CHECK-CONDITION-MET.  :CLEAN-UP
;;;; runs in any case.  An executive performs a designator as a whole: policies are checked between
;;;; performs.

(in-package #:discrepancy-finder.plan-language)

(defstruct (policy (:constructor %make-policy) (:copier nil))
  "A policy; its parts are functions of its parameters."
  (name nil :type symbol :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (init nil :read-only t)
  (check nil :read-only t)
  (recover nil :read-only t)
  (clean-up nil :read-only t))

(defmethod print-object ((policy policy) stream)
  (print-unreadable-object (policy stream :type t)
    (format stream "~(~a~)" (policy-name policy))))

(defvar *policies* (make-hash-table :test 'eq)
  "The policy of each name.")

(defvar *policy-start* 0
  "The time (s) at which the policy that is being checked began.")

(defun policy-age ()
  "In a part of a policy, return for how long (s) it has been in force."
  (- (now) *policy-start*))

(defmacro make-policy (&whole form name parameters &body properties)
  "Return a policy with NAME (unevaluated) and PARAMETERS, a lambda list.  PROPERTIES are an
optional documentation string and (:init form*), (:check form*), (:recover form*), (:clean-up
form*)."
  (let ((documentation (and (stringp (first properties)) (pop properties))))
    (dolist (property properties)
      (unless (and (consp property) (member (first property)
                                             '(:init :check :recover :clean-up)))
        (error 'malformed-plan-form
               :form form
               :expected "(:init form*), (:check form*), (:recover form*) or (:clean-up form*)")))
    `(%make-policy
      :name ',name :documentation ,documentation
      ,@(loop for (part . forms) in properties
              append `(,part (lambda ,parameters
                               (declare (ignorable ,@(set-difference parameters
                                                                     lambda-list-keywords)))
                               ,@forms))))))

(defmacro define-policy (name parameters &body properties)
  "Define the policy NAME for WITH-NAMED-POLICY, and return it; see MAKE-POLICY."
  `(setf (gethash ',name *policies*) (make-policy ,name ,parameters ,@properties)))

(defmethod documentation ((name symbol) (kind (eql 'policy)))
  (let ((policy (gethash name *policies*)))
    (and policy (policy-documentation policy))))

(defun named-policy (name)
  "Return the policy NAME.  Signals POLICY-NOT-FOUND."
  (or (gethash name *policies*)
      (fail 'policy-not-found :name name)))

(defun run-part (part parameters)
  (if part (apply part parameters) t))

(defun watch (policy parameters start)
  "Return when the check of POLICY is true."
  (setf (strand-poller (current-strand)) t)
  (let ((*policy-start* start))
    (loop until (apply (policy-check policy) parameters)
          do (sleep* 1/100))))

(defun call-with-policy (policy parameters function)
  (let* ((start (now))
         (met nil)
         (values
           (unwind-protect
                (progn
                  (unless (let ((*policy-start* start))
                            (run-part (policy-init policy) parameters))
                    (fail 'policy-init-failed :policy policy :parameters parameters))
                  (prog1
                      (if (policy-check policy)
                          (pursue (progn (watch policy parameters start) (setf met t))
                                  (multiple-value-list (funcall (the function function))))
                          (multiple-value-list (funcall (the function function))))
                    (when met
                      (run-part (policy-recover policy) parameters))))
             (run-part (policy-clean-up policy) parameters))))
    (if met
        (fail 'policy-check-condition-met :policy policy :parameters parameters)
        (values-list values))))

(defmacro with-policy (policy (&rest parameters) &body body)
  "Evaluate BODY under POLICY with PARAMETERS and return its values.  Signals POLICY-INIT-FAILED and
POLICY-CHECK-CONDITION-MET, which are no plan failures: a clause must name them."
  `(call-with-policy ,policy (list ,@parameters) (lambda () ,@body)))

(defmacro with-named-policy (name (&rest parameters) &body body)
  "The same as WITH-POLICY for the policy that DEFINE-POLICY has given NAME (evaluated)."
  `(with-policy (named-policy ,name) ,parameters ,@body))

(defmacro with-policies ((&rest policies) &body body)
  "Evaluate BODY under several POLICIES, a list of (policy (parameter*)), the first outermost."
  (reduce (lambda (policy inner) `(with-policy ,(first policy) ,(second policy) ,inner))
          policies :from-end t :initial-value `(progn ,@body)))

(defmacro with-named-policies ((&rest policies) &body body)
  "Evaluate BODY under several POLICIES, a list of (name (parameter*)), the first outermost."
  `(with-policies ,(loop for (name parameters) in policies
                         collect `((named-policy ,name) ,parameters))
     ,@body))

(define-policy timeout-policy (seconds)
  "The body may take SECONDS of the plan's clock."
  (:check (>= (policy-age) seconds)))
