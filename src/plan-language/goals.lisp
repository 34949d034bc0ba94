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

(defstruct (goal-definition (:constructor make-goal-definition (pattern variables function))
                            (:copier nil))
  "What to do for arguments that unify with PATTERN: call the function named FUNCTION with the
values of VARIABLES."
  (pattern '() :type list :read-only t)
  (variables '() :type list :read-only t)
  (function nil :type symbol))

(defvar *goals* (make-hash-table :test 'eq)
  "For each goal function the list of its GOAL-DEFINITIONs, in order of definition.")

(defun pursue-goal (name arguments)
  "Do what the first definition of the goal NAME says that fits ARGUMENTS."
  (dolist (definition (gethash name *goals*) (error 'no-goal-fits :name name :arguments arguments))
    (let ((pattern (goal-definition-pattern definition)))
      (multiple-value-bind (bindings fits) (prolog:unify pattern arguments)
        (when fits
          (return
            (call-in-task
             name `(goal (,name ,@pattern))
             (lambda ()
               (call-plan-function *executive* (goal-definition-function definition)
                                   (loop for variable in (goal-definition-variables definition)
                                         collect (prolog:var-value variable bindings))))
             :parameters (lambda () arguments))))))))

(defun register-goal (name pattern function &optional (variables (prolog:vars-in pattern)))
  "Let the function named FUNCTION, of VARIABLES of PATTERN, be what the goal NAME does for
arguments that unify with PATTERN."
  (let ((known (find pattern (gethash name *goals*) :key #'goal-definition-pattern :test #'equal)))
    (if known
        (setf (goal-definition-function known) function)
        (setf (gethash name *goals*)
              (append (gethash name *goals*)
                      (list (make-goal-definition pattern variables function))))))
  name)

(defmacro declare-goal (name lambda-list &optional documentation)
  "Define NAME as a goal function with LAMBDA-LIST, of required parameters."
  `(defun ,name ,lambda-list
     ,@(and documentation (list documentation))
     (pursue-goal ',name (list ,@lambda-list))))

(defun goal-function-name (name pattern)
  "Return the symbol that names the function of the goal NAME for PATTERN."
  (intern (short-form (cons name pattern)) (symbol-package name)))

(defmacro def-goal (&whole form (name &rest pattern) &body body &environment environment)
  "Define what the goal function NAME does when its arguments unify with PATTERN, in which symbols
with a question mark are variables.  (succeed value*) returns from BODY."
  (unless (and (symbolp name) (symbol-package name) (not (keywordp name)))
    (error 'malformed-plan-form :form form :expected "(name pattern*) after def-goal"))
  (let ((variables (prolog:vars-in pattern))
        (function (goal-function-name name pattern))
        (body `((declare (ignorable ,@(prolog:vars-in pattern)))
                (block goal
                  (flet ((succeed (&rest values)
                           (return-from goal (values-list values))))
                    (declare (ignorable #'succeed))
                    (source:with-definition (,name) (with-tags ,@body)))))))
    `(progn
       (defun ,function ,variables ,@body)
       ,@(when (global-environment-p environment)
           `((record-helper ',function ',variables ',body (source:form-position ',form))))
       (register-goal ',name ',pattern ',function))))

(defun succeed (&rest values)
  "Inside of DEF-GOAL, end the goal with VALUES.  Anywhere else this signals MALFORMED-PLAN-FORM."
  (error 'malformed-plan-form :form `(succeed ,@values) :expected "an enclosing def-goal"))

(defun describe-goal (name)
  "Return the list of the patterns for which the goal NAME is defined."
  (mapcar #'goal-definition-pattern (gethash name *goals*)))
