;;;; The evaluator: forms made into closures over run-time frames.
;;;;
;;;; ANALYZE turns a form into CODE, a function of a frame, once; calling it evaluates the form.
;;;; Special operators, and macros whose expansions would be SBCL's internal matter, have an
;;;; analyzer each; every other macro is expanded.  Values may be symbolic: an IF on one is a
;;;; decision, and of the functions that are called only those get one that can do something with
;;;; it (calls.lisp).  Interpreted functions are real functions and take them as they are.  Where
;;;; nothing is symbolic this is an ordinary evaluator: EVALUATE.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *analyzers* (make-hash-table :test 'eq)
  "The analyzer of each special operator: a function of form and scope that returns code.")

(defmacro define-analyzer (operators (form scope) &body body)
  "Define how forms with one of OPERATORS, a symbol or a list of some, are made into code."
  `(dolist (operator ',(if (listp operators) operators (list operators)))
     (setf (gethash operator *analyzers*)
           (lambda (,form ,scope) (declare (ignorable ,form ,scope)) ,@body))))

(defun unsupported (form reason)
  "Signal UNSUPPORTED-FORM."
  (error 'unsupported-form :form form :reason reason :position (source:form-position form)))

(defvar *problem-observer* nil
  "A function that is called with each error that is met when a form is analyzed, or NIL.")

(defun complaining-code (condition)
  "Return the code that signals CONDITION, an error met when a form was analyzed, past the plan's
handlers if a plan runs: like compiled code, a form complains when it is reached."
  (when *problem-observer*
    (funcall *problem-observer* condition))
  (code (frame)
    (if *path*
        (outside-the-plan (*path*) (error condition))
        (error condition))))

(defun constant-code (value)
  (case value
    ((nil) (code (frame) nil))
    ((t) (code (frame) t))
    (t (code (frame) value))))

(defun analyze (form scope)
  "Return the code of FORM in SCOPE, where its values are needed."
  (let ((*exits* '()) (*tails* '()) (*jumps* 0))
    (analyze-form form scope)))

(defun analyze-form (form scope)
  "The same where the values of FORM are those of the form around it: the exits stay as they are."
  (cond ((symbolp form) (analyze-symbol form scope))
        ((atom form) (constant-code form))
        (t (handler-case (with-form-noted (form) (analyze-compound form scope))
             (unsupported-form (condition) (complaining-code condition))
             (error (condition)
               (complaining-code
                (make-condition 'unsupported-form
                                :form form :reason (source:condition-sentence condition)
                                :position (source:form-position form))))))))

(defun analyze-compound (form scope)
  (let ((operator (first form)))
    (cond ((consp operator)
           (unless (member (first operator) '(lambda sb-int:named-lambda))
             (unsupported form "its operator is neither a symbol nor a lambda expression"))
           (analyze-lambda-call form scope))
          ((not (symbolp operator)) (unsupported form "its operator is no symbol"))
          ((not (listp (cdr (last form)))) (unsupported form "it is no proper list"))
          (t (let ((local (function-meaning operator scope))
                   (analyzer (gethash operator *analyzers*)))
               (cond ((eq local :macro) (analyze-macro form scope))
                     (local (analyze-local-call form local scope))
                     (analyzer (funcall analyzer form scope))
                     ((special-operator-p operator)
                      (unsupported form "an unknown special operator"))
                     ((macro-function operator) (analyze-macro form scope))
                     (t (analyze-global-call form scope))))))))

(defun expand (form scope)
  "Return the expansion of the macro FORM.  Expanding it is no part of what a plan does."
  (let ((*path* nil))
    (macroexpand-1 form (scope-environment scope))))

(defun analyze-macro (form scope)
  (analyze-form (expand form scope) scope))

(defun analyze-symbol (symbol scope)
  (let ((meaning (variable-meaning symbol scope)))
    (cond ((place-p meaning) (frame-reader meaning scope))
          ((eq meaning :symbol-macro) (analyze-macro symbol scope))
          ((eq meaning :constant) (constant-code (symbol-value symbol)))
          (t (note-global symbol)
             (code (frame) (symbol-value symbol))))))

(defun analyze-all (forms scope)
  (mapcar (lambda (form) (analyze form scope)) forms))

(defun analyze-body (forms scope)
  "Return the code that evaluates FORMS in order and returns the values of the last."
  (if (null forms)
      (constant-code nil)
      (let ((rest (rest forms)))
        (if (null rest)
            (analyze-form (first forms) scope)
            (multiple-value-bind (first leaves) (analyze-statement (first forms) scope)
              (sequence-code first leaves (analyze-body rest scope)))))))

(defun sequence-code (first leaves second)
  "Return the code that runs FIRST and then SECOND.  LEAVES: FIRST may return a jump."
  (declare (type function first second))
  (if leaves
      (code (frame)
        (multiple-value-bind (value payload) (run first frame)
          (if (jump-p value)
              (values value payload)
              (run second frame))))
      (code (frame)
        (run first frame)
        (run second frame))))

;;; What a form was, for those who ask

(defstruct (site (:constructor make-site (form)) (:copier nil))
  "A form in the plan; TEXT is its description once that was asked for."
  (form nil :read-only t)
  (text nil :type (or null string)))

(defun describe-form (form)
  "Return a text for FORM in the description of a decision."
  (let ((position (source:form-position form))
        (*print-length* 4) (*print-level* 3) (*print-pretty* nil))
    (format nil "~@[~a: ~]~(~s~)" (and position (princ-to-string position)) form)))

(defun site-description (site)
  (or (site-text site)
      (setf (site-text site) (describe-form (site-form site)))))

;;; The null lexical environment

(defun evaluate-form (form)
  (funcall (the function (analyze form (make-scope))) (vector nil)))

(defun evaluate (form)
  "Evaluate FORM, which may be any form of Common Lisp, in the null lexical environment and return
its values.  What a top-level PROGN defines is known in the forms that follow.  Signals
UNSUPPORTED-FORM if FORM is malformed, and what its evaluation signals."
  (loop
    (if (and (consp form) (symbolp (first form)) (not (gethash (first form) *analyzers*))
             (macro-function (first form)))
        (setf form (expand form (make-scope)))
        (return)))
  (if (and (consp form)
           (or (eq (first form) 'progn)
               (and (eq (first form) 'eval-when)
                    (intersection '(:execute eval) (second form)))))
      (loop for (subform . more) on (if (eq (first form) 'progn) (rest form) (cddr form))
            while more
            do (evaluate subform)
            finally (return (evaluate subform)))
      (evaluate-form form)))
