;;;; Goals: plan functions that are chosen by patterns.
;;;;
;;;; (declare-goal achieve (fact)) defines the function ACHIEVE; (def-goal (achieve (loc ?a ?b))
;;;; form*) says what to do for arguments that unify with the pattern.  Definitions are tried in
;;;; their order; the first that fits is used.

(in-package #:discrepancy-finder.plan-language)

(define-condition no-goal-fits (plan-error)
  ((name :initarg :name :reader no-goal-fits-name :documentation "The goal function's name.")
   (arguments :initarg :arguments :reader no-goal-fits-arguments
              :documentation "The list of what it was called with."))
  (:report (lambda (condition stream)
             (let ((*print-length* 6) (*print-level* 4) (*print-pretty* nil))
               (format stream "No def-goal of ~(~a~) fits the arguments ~s."
                       (no-goal-fits-name condition) (no-goal-fits-arguments condition)))))
  (:documentation "Signaled when a goal is called for which no definition fits."))

(defvar *goals* (make-hash-table :test 'eq)
  "For each goal function the list of its (pattern variables . function), in order of definition.")

(defun pursue-goal (name arguments)
  "Do what the first definition of the goal NAME says that fits ARGUMENTS."
  (loop for (pattern . function) in (gethash name *goals*)
        do (multiple-value-bind (bindings fits) (prolog:unify pattern arguments)
             (when fits
               (return-from pursue-goal
                 (call-in-task name `(goal (,name ,@pattern))
                               (lambda () (funcall (the function function) bindings))
                               :parameters (lambda () arguments))))))
  (error 'no-goal-fits :name name :arguments arguments))

(defun register-goal (name pattern function)
  "Let FUNCTION, of bindings, be what the goal NAME does for arguments that unify with PATTERN."
  (let ((known (assoc pattern (gethash name *goals*) :test #'equal)))
    (if known
        (setf (rest known) function)
        (setf (gethash name *goals*)
              (append (gethash name *goals*) (list (cons pattern function))))))
  name)

(defmacro declare-goal (name lambda-list &optional documentation)
  "Define NAME as a goal function with LAMBDA-LIST, of required parameters."
  `(defun ,name ,lambda-list
     ,@(and documentation (list documentation))
     (pursue-goal ',name (list ,@lambda-list))))

(defmacro def-goal (&whole form (name &rest pattern) &body body)
  "Define what the goal function NAME does when its arguments unify with PATTERN, in which symbols
with a question mark are variables.  (succeed value*) returns from BODY."
  (unless (symbolp name)
    (error 'malformed-plan-form :form form :expected "(name pattern*) after def-goal"))
  (let ((variables (prolog:vars-in pattern))
        (bindings (gensym "BINDINGS")))
    `(register-goal ',name ',pattern
                    (lambda (,bindings)
                      (declare (ignorable ,bindings))
                      (let ,(loop for variable in variables
                                  collect `(,variable (prolog:var-value ',variable ,bindings)))
                        (declare (ignorable ,@variables))
                        (block goal
                          (flet ((succeed (&rest values)
                                   (return-from goal (values-list values))))
                            (declare (ignorable #'succeed))
                            (with-tags ,@body))))))))

(defun succeed (&rest values)
  "Inside of DEF-GOAL, end the goal with VALUES.  Anywhere else this signals MALFORMED-PLAN-FORM."
  (error 'malformed-plan-form :form `(succeed ,@values) :expected "an enclosing def-goal"))

(defun describe-goal (name)
  "Return the list of the patterns for which the goal NAME is defined."
  (mapcar #'first (gethash name *goals*)))
