;;;; Process modules: what executes motions.
;;;;
;;;; DEF-PROCESS-MODULE defines a function of a motion designator under a name.  It serves only
;;;; inside of WITH-PROCESS-MODULES-RUNNING.  Which module is for which motion is said by facts of
;;;; the predicate MATCHING-PROCESS-MODULE, which can be used, by AVAILABLE-PROCESS-MODULE.

(in-package #:discrepancy-finder.plan-language)

(define-condition process-module-not-running (simple-plan-failure)
  ((name :initarg :name :reader process-module-not-running-name
         :documentation "The name of the process module."))
  (:report (lambda (condition stream)
             (format stream "The process module ~(~a~) is not running."
                     (process-module-not-running-name condition))))
  (:documentation "Signaled by PM-EXECUTE for a process module that does not run."))

(defvar *process-modules* (make-hash-table :test 'eq)
  "The function of each process module.")

(defstruct (running-module (:constructor make-running-module (name free)) (:copier nil))
  "A process module that runs.  It executes one motion at a time: FREE is a fluent that says whether
it can execute the next."
  (name nil :type symbol :read-only t)
  (free nil :read-only t))

(define-task-variable *running-process-modules* '()
  "The process modules that run: a list of (alias . RUNNING-MODULE).")

(defun run-module (alias name)
  (check-process-module name)
  (cons alias (make-running-module name (make-fluent :name (list name 'is 'free) :value t))))

(defmacro def-process-module (name (designator) &body body)
  "Define the process module NAME: it executes motions by evaluating BODY with DESIGNATOR bound to
the motion designator.  A failure of BODY is one of the motion."
  (multiple-value-bind (forms declarations documentation)
      (alexandria:parse-body body :documentation t)
    `(progn
       (setf (gethash ',name *process-modules*)
             (lambda (,designator)
               ,@(and documentation (list documentation))
               ,@declarations
               ,@forms))
       ',name)))

(defun check-process-module (name)
  (unless (gethash name *process-modules*)
    (error 'process-module-not-found :name name)))

(defun call-with-process-modules (specifications function)
  (let ((modules (loop for specification in specifications
                       collect (if (consp specification)
                                   (run-module (first specification) (second specification))
                                   (run-module specification specification)))))
    (progv '(*running-process-modules*) (list (append modules *running-process-modules*))
      (funcall function))))

(defmacro with-process-modules-running ((&rest modules) &body body)
  "Evaluate BODY, in which motions can be executed by MODULES: names of process modules, or (alias
name).  Signals PROCESS-MODULE-NOT-FOUND."
  `(call-with-process-modules ',modules (lambda () ,@body)))

(defun get-running-process-modules ()
  "Return the list of the names, or aliases, of the process modules that run."
  (mapcar #'car *running-process-modules*))

(defun running-process-module (name)
  (cdr (assoc name *running-process-modules*)))

(defun pm-execute (name designator)
  "Let the process module NAME, a name or alias, execute the motion DESIGNATOR in a task of its own,
when it is free, and return the primary value.  Signals PROCESS-MODULE-NOT-RUNNING and what the
module fails with."
  (let* ((running (or (running-process-module name)
                      (fail 'process-module-not-running :name name)))
         (module (running-module-name running)))
    (values
     (call-in-task (list "process module" module)
                   `(process-module ,module)
                   (lambda () (execute-motion running designator))
                   :parameters (lambda () (list designator))))))

(defun execute-motion (running designator)
  "Evaluate the body of the process module RUNNING for DESIGNATOR."
  (wait-for (running-module-free running))
  (setf (value (running-module-free running)) nil)
  (unwind-protect (funcall (the function (gethash (running-module-name running)
                                                  *process-modules*))
                           (current-desig designator))
    (setf (value (running-module-free running)) t)))

;;; Matching

(prolog:def-fact-group process-modules (matching-process-module available-process-module
                                        projection-running))

(loop for (name text) in
      '((matching-process-module
         "(matching-process-module ?designator ?name): the process module is for the motion.")
        (available-process-module
         "(available-process-module ?name): the process module can be used now.")
        (projection-running
         "(projection-running ?name): the plan is only projected."))
      do (setf (documentation name 'prolog:predicate) text))

(defun matching-process-modules (designator)
  "Return the list of the names of the process modules that are for DESIGNATOR, can be used and run,
in the order of the facts."
  (let ((names '()))
    (prolog:lazy-dolist (bindings (prolog:prolog `(and (matching-process-module ,designator ?name)
                                                       (available-process-module ?name))))
      (let ((name (prolog:var-value '?name bindings)))
        (when (running-process-module name)
          (pushnew name names))))
    (nreverse names)))

(defun usable-process-modules (designator)
  "Return the list of the process modules that can execute DESIGNATOR, or fail if there is none."
  (or (matching-process-modules designator)
      (fail "No matching process module found for ~a~@[ in the plan ~(~a~)~].~@[  Those that run: ~
             ~{~(~a~)~^, ~}.~]"
            designator (current-plan-name) (get-running-process-modules))))

(defun execute-by-one-of (modules designator)
  (handler-case (try-each-in-order (module modules)
                  (pm-execute module designator))
    (composite-failure (failure)
      (fail (first (composite-failures failure))))))

(defun pm-execute-matching (designator)
  "Let the first process module that matches DESIGNATOR and does not fail execute it, and return its
primary value.  If all fail, fail like the first of them."
  (execute-by-one-of (usable-process-modules designator) designator))

(defun perform-motion (designator)
  "Resolve the motion DESIGNATOR and let a matching process module execute it."
  (let ((modules (usable-process-modules designator)))
    (try-reference-designator designator)
    (execute-by-one-of modules designator)))
