;;;; The evaluator: forms of a plan made into closures over run-time frames.
;;;;
;;;; ANALYZE turns a form into a function of a frame, once; calling that function evaluates the
;;;; form.  Special operators have an analyzer each (special-operators.lisp); every other macro is
;;;; expanded.  Values may be symbolic booleans: an IF on one is a decision, NOT of one is one, and
;;;; every call of a compiled function decides its symbolic arguments first, so that compiled code
;;;; never sees one.  Interpreted functions are real functions and take them as they are.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *analyzers* (make-hash-table :test 'eq)
  "The analyzer of each special operator: a function of form and scope that returns a closure.")

(defmacro define-analyzer (operator (form scope) &body body)
  "Define how forms with OPERATOR are made into closures."
  `(setf (gethash ',operator *analyzers*)
         (lambda (,form ,scope) (declare (ignorable ,scope)) ,@body)))

(defun unsupported (form reason)
  "Signal UNSUPPORTED-FORM, past the plan's handlers if a plan runs."
  (flet ((complain ()
           (error 'unsupported-form :form form :reason reason
                                    :position (source:form-position form))))
    (if *path*
        (outside-the-plan (*path*) (complain))
        (complain))))

(defun constant-closure (value)
  (lambda (frame) (declare (ignore frame)) value))

(defun analyze (form scope)
  "Return a function of one argument, a frame of SCOPE, that evaluates FORM."
  (cond ((symbolp form) (analyze-symbol form scope))
        ((atom form) (constant-closure form))
        ((consp (first form)) (analyze-lambda-call form scope))
        ((not (symbolp (first form))) (unsupported form "its operator is no symbol"))
        ((local-kind (first form) scope)
         (if (eq (local-kind (first form) scope) :macro)
             (analyze-macro form scope)
             (analyze-local-call form scope)))
        ((gethash (first form) *analyzers*) (funcall (gethash (first form) *analyzers*) form scope))
        ((special-operator-p (first form)) (unsupported form "an unknown special operator"))
        ((macro-function (first form)) (analyze-macro form scope))
        (t (analyze-global-call form scope))))

(defun local-kind (symbol scope)
  "Return :function or :macro if SYMBOL names a local one in SCOPE, else NIL."
  (multiple-value-bind (kind local)
      (sb-cltl2:function-information symbol (scope-environment scope))
    (and local kind)))

(defun analyze-macro (form scope)
  (analyze (macroexpand-1 form (scope-environment scope)) scope))

(defun analyze-symbol (symbol scope)
  (ecase (variable-kind symbol scope)
    (:constant (constant-closure (symbol-value symbol)))
    (:symbol-macro (analyze-macro symbol scope))
    (:lexical (multiple-value-call #'frame-reader (variable-address symbol scope)))
    ((:special :global nil) (lambda (frame) (declare (ignore frame)) (symbol-value symbol)))))

(defun analyze-body (forms scope)
  "Return a closure that evaluates FORMS in order and returns the values of the last."
  (let ((closures (mapcar (lambda (form) (analyze form scope)) forms)))
    (case (length closures)
      (0 (constant-closure nil))
      (1 (first closures))
      (t (let ((butlast (butlast closures)) (last (first (last closures))))
           (lambda (frame)
             (dolist (closure butlast) (funcall (the function closure) frame))
             (funcall (the function last) frame)))))))

;;; Calls

(defun describe-form (form)
  "Return a text for FORM in the description of a decision."
  (let ((position (source:form-position form))
        (*print-length* 4) (*print-level* 3) (*print-pretty* nil))
    (format nil "~@[~a: ~]~(~s~)" (and position (princ-to-string position)) form)))

(defun evaluate-arguments (closures frame)
  (loop for closure in closures collect (funcall (the function closure) frame)))

(defun call-function (function arguments description)
  "Call FUNCTION with ARGUMENTS; a compiled function gets no symbolic value."
  (let ((version (known-version function)))
    (if version
        (apply (the function version) arguments)
        (call-opaque function arguments description))))

(defun analyze-arguments (forms scope)
  (mapcar (lambda (form) (analyze form scope)) forms))

(defun analyze-lambda-call (form scope)
  (let ((function (analyze `(function ,(first form)) scope))
        (arguments (analyze-arguments (rest form) scope)))
    (lambda (frame) (apply (funcall function frame) (evaluate-arguments arguments frame)))))

(defun analyze-local-call (form scope)
  (let ((reader (multiple-value-call #'frame-reader (function-address (first form) scope)))
        (arguments (analyze-arguments (rest form) scope)))
    (lambda (frame)
      (apply (the function (funcall reader frame)) (evaluate-arguments arguments frame)))))

(defun global-function (name)
  "Return the function that a call of NAME means: a plan is interpreted, all else is compiled."
  (let ((plan (and (symbolp name) (plan:plan-source name))))
    (if plan (interpreted-plan plan) (fdefinition name))))

(defparameter *transparent-functions*
  (list* 'list 'cons 'list* plan:*control-functions*)
  "Compiled functions that hand symbolic values on as they are.")

(defun analyze-transparent-call (name arguments)
  (lambda (frame)
    (apply (fdefinition name) (evaluate-arguments arguments frame))))

(defun analyze-global-call (form scope)
  (let* ((name (first form))
         (arguments (analyze-arguments (rest form) scope))
         (description (describe-form form)))
    (case name
      (funcall
       (lambda (frame)
         (destructuring-bind (function . values) (evaluate-arguments arguments frame)
           (call-function (if (symbolp function) (global-function function) function)
                          values description))))
      (plan:perform
       (let ((position (source:form-position form)))
         (lambda (frame)
           (apply #'plan:perform (append (evaluate-arguments arguments frame)
                                         (and (= (length arguments) 1) (list position)))))))
      (t
       (if (member name *transparent-functions*)
           (analyze-transparent-call name arguments)
           (lambda (frame)
             (let ((version (lifted-function name)))
               (if version
                   (apply (the function version) (evaluate-arguments arguments frame))
                   (call-function (global-function name) (evaluate-arguments arguments frame)
                                  description)))))))))

;;; Plans

(defvar *interpreted-plans* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The interpreted function of each PLAN that was called.")

(defun interpreted-plan (plan)
  "Return the interpreted function of PLAN."
  (or (gethash plan *interpreted-plans*)
      (setf (gethash plan *interpreted-plans*)
            (multiple-value-bind (forms declarations) (alexandria:parse-body (plan:plan-body plan))
              (funcall (analyze-lambda (plan:plan-name plan) (plan:plan-lambda-list plan)
                                       `(,@declarations
                                         (block ,(plan:plan-name plan) ,@forms))
                                       (make-scope))
                       (vector nil))))))
