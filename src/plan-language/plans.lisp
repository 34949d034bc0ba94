;;;; Plans are functions whose source is kept.
;;;;
;;;; DEF-CRAM-FUNCTION and DEF-TOP-LEVEL-CRAM-FUNCTION define a Lisp function, compiled by SBCL, and
;;;; record lambda list, body and source position under its name: FIND-PLAN returns the record, from
;;;; which the symbolic evaluator works.  LOAD-PLAN loads a file of plans and records the source of
;;;; the functions that it defines by DEFUN, too: these are helpers, no plans, but the evaluator
;;;; interprets them in the same way.

(in-package #:discrepancy-finder.plan-language)

(defstruct (plan (:copier nil))
  "A plan's name and source."
  (name nil :type (or symbol cons) :read-only t)
  (lambda-list '() :type list :read-only t)
  (body '() :type list :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (top-level-p nil :type boolean :read-only t)
  (position nil :type (or null source:source-position) :read-only t)
  ;; What the definition was compiled to: if the name has another function now, this is out of date.
  (function nil :type (or null function) :read-only t)
  (helper-p nil :type boolean :read-only t))

(setf (documentation 'plan-name 'function)
      "Return the symbol that names a plan."
      (documentation 'plan-lambda-list 'function)
      "Return the lambda list of a plan."
      (documentation 'plan-body 'function)
      "Return the list of the declarations and forms of a plan."
      (documentation 'plan-documentation 'function)
      "Return the documentation string of a plan, or NIL."
      (documentation 'plan-top-level-p 'function)
      "Return true if a plan runs in a top-level of its own."
      (documentation 'plan-position 'function)
      "Return the source position of a plan, or NIL if it was not loaded by LOAD-PLAN.")

(defmethod print-object ((plan plan) stream)
  (print-unreadable-object (plan stream :type t)
    (format stream "~(~a~)~@[ at ~a~]" (plan-name plan)
            (and (plan-position plan) (princ-to-string (plan-position plan))))))

(defvar *plans* (make-hash-table :test 'equal)
  "The plan of each name.")

(defvar *method-sources* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The DEFMETHOD form of each method that LOAD-PLAN has loaded.")

(defvar *noted-plans* :none
  "The list of the plans that were recorded while LOAD-PLAN runs, the last one first.")

(defun plan-source (name)
  "Return the PLAN of the function named NAME, also if that is a helper that LOAD-PLAN has loaded,
or NIL.  One that was redefined since in another way has none."
  (let ((plan (gethash name *plans*)))
    (and plan (fboundp name) (eq (fdefinition name) (plan-function plan))
         plan)))

(defun find-plan (name)
  "Return the PLAN named by the symbol NAME, or by the symbol of the same name in the package
DISCREPANCY-FINDER-USER.  Signals PLAN-NOT-FOUND."
  (flet ((plan-of (name)
           (let ((plan (plan-source name)))
             (and plan (not (plan-helper-p plan)) plan))))
    (or (plan-of name)
        (plan-of (find-symbol (symbol-name name) '#:discrepancy-finder-user))
        (error 'plan-not-found :name name))))

(defun plans-in-files (files)
  "Return the list of the plans and helpers that are defined in one of FILES, strings as positions
have them, and are not out of date; in no particular order."
  (loop for plan being the hash-values of *plans*
        when (and (plan-position plan)
                  (member (source:source-position-file (plan-position plan)) files :test #'equal)
                  (eq plan (plan-source (plan-name plan))))
          collect plan))

(defun plans-mentioned (plan)
  "Return the list of PLAN and of the plans and helpers that its source mentions, and theirs."
  (let ((found '()))
    (labels ((visit (plan)
               (unless (member plan found :test #'eq)
                 (push plan found)
                 (walk (plan-lambda-list plan))
                 (walk (plan-body plan))))
             (walk (form)
               (cond ((consp form) (walk (car form)) (walk (cdr form)))
                     ((and form (symbolp form))
                      (let ((other (plan-source form)))
                        (when other (visit other)))))))
      (visit plan))
    (reverse found)))

(defun record-plan (plan)
  (unless (or (plan-helper-p plan) (eq *noted-plans* :none))
    (push plan *noted-plans*))
  (setf (gethash (plan-name plan) *plans*) plan))

(defun record-helper (name lambda-list body position)
  "Record the source of the function NAME, which was just defined with LAMBDA-LIST and BODY."
  (multiple-value-bind (forms declarations) (split-body body)
    (record-plan (make-plan :name name :lambda-list lambda-list
                            :body (append declarations forms)
                            :position position :helper-p t
                            :function (fdefinition name))))
  name)

(defun record-method (method form)
  "Record FORM, the DEFMETHOD form by which METHOD was just defined, and return METHOD."
  (setf (gethash method *method-sources*) form)
  method)

(defun method-source (method)
  "Return the DEFMETHOD form of METHOD if LOAD-PLAN has loaded it, or NIL."
  (values (gethash method *method-sources*)))

(defun split-body (body)
  "Return the forms, the declarations and the documentation string of the function body BODY."
  (alexandria:parse-body body :documentation t))

(defun parameters (lambda-list)
  "Return the variables of LAMBDA-LIST."
  (multiple-value-bind (required optional rest keywords) (alexandria:parse-ordinary-lambda-list
                                                           lambda-list)
    (append required (mapcar #'first optional) (and rest (list rest))
            (mapcar #'cadar keywords))))

(defun ignored-variables (declarations)
  (loop for (nil . specifiers) in declarations
        append (loop for (kind . arguments) in specifiers
                     when (eq kind 'ignore) append arguments)))

(defun task-form (name lambda-list declarations forms top-level-p)
  "Return the form that runs FORMS as the task of the plan NAME."
  (let ((body `(lambda ()
                 (source:with-definition (,name)
                   (block ,name (with-tags ,@forms)))))
        (parameters (remove-if (lambda (parameter)
                                 (member parameter (ignored-variables declarations)))
                               (parameters lambda-list))))
    (if top-level-p
        `(call-in-top-level ,body ',name)
        `(call-in-task ',name '(,name) ,body
                       :code '(,name ,lambda-list ,@forms)
                       :parameters (lambda () (list ,@parameters))))))

(defun global-environment-p (environment)
  "Return true if nothing local to a form is visible in the macro ENVIRONMENT."
  (or (null environment)
      (and (null (sb-c::lexenv-vars environment))
           (null (sb-c::lexenv-funs environment))
           (null (sb-c::lexenv-blocks environment))
           (null (sb-c::lexenv-tags environment)))))

(defun definition (form name lambda-list body top-level-p environment)
  "Return the expansion of FORM, which defines the plan NAME.  Inside of other forms a plan may
refer to what is local to them: then it is a function only, whose source would be of no use."
  (unless (and (symbolp name) (listp lambda-list))
    (error 'malformed-plan-form :form form :expected "(name (parameter*) form*)"))
  (when (or (macro-function name) (special-operator-p name))
    (error 'malformed-plan-form :form form :plan name
                                :expected "a name that is none of an operator"))
  (multiple-value-bind (forms declarations documentation) (split-body body)
    (let ((task (task-form name lambda-list declarations forms top-level-p)))
      `(progn
         (defun ,name ,lambda-list
           ,@(and documentation (list documentation))
           ,@declarations
           ,task)
         ,@(when (global-environment-p environment)
             `((record-plan
                (make-plan :name ',name :lambda-list ',lambda-list
                           :body '(,@declarations ,task)
                           :documentation ,documentation :top-level-p ,top-level-p
                           :position (source:form-position ',form)
                           :function (fdefinition ',name)))))
         ',name))))

(defmacro def-cram-function (&whole form name lambda-list &body body &environment environment)
  "Define NAME as a plan: a function that other plans call, each time in a task of its own.  Its
source is kept for FIND-PLAN.  Calling it outside of a top-level signals NOT-IN-TOP-LEVEL."
  (definition form name lambda-list body nil environment))

(defmacro def-plan (&whole form name lambda-list &body body &environment environment)
  "The same as DEF-CRAM-FUNCTION."
  (definition form name lambda-list body nil environment))

(defmacro def-top-level-cram-function (&whole form name lambda-list &body body
                                       &environment environment)
  "Define NAME as a plan that runs in a TOP-LEVEL of its own.  Its source is kept for FIND-PLAN."
  (definition form name lambda-list body t environment))

(defun ensure-top-level (function name)
  "Call FUNCTION in a top-level NAME of its own, unless one runs, and return its values."
  (if (outside-of-tasks-p)
      (call-in-top-level function name)
      (funcall function)))
