;;;; Built-in predicates that look at terms and call Lisp.
;;;;
;;;; Lisp functions are called with the values of the arguments.  An argument that is an unbound
;;;; variable makes the goal fail; an error makes it fail with the warning LISP-ERROR-IN-GOAL.

(in-package #:discrepancy-finder.prolog)

(defvar *break-on-lisp-errors* nil
  "True if an error in a Lisp function that a goal calls is left to its handlers and the debugger,
and if ASSERT-TYPE is to signal errors.  False if the goal fails with a warning.")

(define-test == (proof) (left right)
  "The two terms unify."
  (unify-terms proof left right))

(define-test equal (proof) (left right)
  "The two terms unify, as by ==."
  (unify-terms proof left right))

(define-test bound (proof) (term)
  "The term is no unbound variable."
  (not (variable-p (deref term))))

(define-test ground (proof) (term)
  "There is no unbound variable in the term."
  (null (nth-value 1 (externalise term))))

(defun function-of (form)
  "Return the function that FORM names: a function, its name, or (function name)."
  (if (and (consp form) (eq (first form) 'function))
      (fdefinition (second form))
      (coerce form 'function)))

(defun call-lisp (goal function arguments names)
  "Return the value of FUNCTION for ARGUMENTS as a term, and true; or NIL and NIL if it signals an
error, of which is warned.  Symbols in the value that are in NAMES become variables."
  (let ((value (if *break-on-lisp-errors*
                   (apply (function-of function) arguments)
                   (handler-case (apply (function-of function) arguments)
                     (error (error)
                       (warn 'lisp-error-in-goal :goal goal :error error)
                       (return-from call-lisp (values nil nil)))))))
    (values (if (names-table names) (internalise value names) value)
            t)))

(defun apply-to-terms (name function arguments)
  "Return the value of the Lisp function FUNCTION for the terms ARGUMENTS, and true; or NIL and NIL
if an argument is unbound or there is an error.  NAME is the predicate for whose goal that is done."
  (if (some (lambda (argument) (variable-p (variable-target argument))) arguments)
      (values nil nil)
      (multiple-value-bind (forms unbound) (externalise (cons function arguments))
        (call-lisp (cons name forms) (first forms) (rest forms) (placeholder-names unbound)))))

(defun unify-value (proof name function arguments result)
  "Unify RESULT with the value of the Lisp FUNCTION for ARGUMENTS."
  (multiple-value-bind (value returned) (apply-to-terms name function arguments)
    (and returned (unify-terms proof result value))))

(define-test lisp-fun (proof) (function argument-or-result &rest arguments-and-result)
  "The result, the last argument, unifies with the first value of the Lisp function for the
arguments before.  False if one of these is an unbound variable."
  (let ((all (cons argument-or-result arguments-and-result)))
    (unify-value proof 'lisp-fun function (butlast all) (first (last all)))))

(define-test lisp-pred (proof) (function &rest arguments)
  "The Lisp function is true of the arguments.  False if one of these is an unbound variable."
  (values (apply-to-terms 'lisp-pred function arguments)))

(define-test lisp-type (proof) (object type)
  "The object is of the Lisp type."
  (values (apply-to-terms 'lisp-type 'typep (list object type))))

(define-test instance-of (proof) (type object)
  "The object is of the Lisp type."
  (values (apply-to-terms 'instance-of 'typep (list object type))))

(define-test assert-type (proof) (object type &optional (context ""))
  "True.  While *BREAK-ON-LISP-ERRORS* is true, an error is signaled if the object is not of the
Lisp type; the context, a string, is part of its report."
  (when *break-on-lisp-errors*
    (let ((object (externalise object)) (type (externalise type)))
      (unless (typep object type)
        (error 'simple-type-error
               :datum object :expected-type type
               :format-control "~a: ~s is not of type ~(~s~)."
               :format-arguments (list (externalise context) object type)))))
  t)

(define-test symbol-value (proof) (symbol value)
  "The value is that of the special variable symbol."
  (unify-value proof 'symbol-value 'symbol-value (list symbol) value))

(define-test set-symbol-value (proof) (symbol value)
  "True; sets the special variable symbol to the value.  That is not undone."
  (nth-value 1 (apply-to-terms 'set-symbol-value 'set (list symbol value))))

(define-test slot-value (proof) (object slot-name value)
  "The value is that of the slot of the object."
  (unify-value proof 'slot-value 'slot-value (list object slot-name) value))

(alias-predicate 'get-slot-value 'slot-value)

(define-test format (proof) (destination-or-control &rest arguments)
  "True; writes by FORMAT, to the standard output if the first argument is a string."
  ;; Unbound variables are written by their names.
  (let ((forms (externalise (cons destination-or-control arguments))))
    (nth-value 1 (call-lisp (cons 'format forms) 'format
                            (if (stringp (first forms)) (cons t forms) forms)
                            (make-names '())))))

(define-test warn (proof) (control &rest arguments)
  "True; signals a warning by WARN."
  (apply #'warn (values (externalise (cons control arguments))))
  t)

(define-test error (proof) (control &rest arguments)
  "Signals an error by ERROR."
  (apply #'error (values (externalise (cons control arguments)))))

(define-test string-concat (proof) (string-or-result &rest strings-and-result)
  "The last argument unifies with the strings before, one after the other."
  (let ((all (cons string-or-result strings-and-result)))
    (unify-value proof 'string-concat
                 (lambda (&rest strings) (apply #'concatenate 'string strings))
                 (butlast all) (first (last all)))))

(macrolet ((comparisons (&rest names)
             `(progn
                ,@(loop for name in names
                        collect `(define-test ,name (proof) (number &rest numbers)
                                   ,(format nil "The numbers fulfil the Lisp function ~a." name)
                                   (values (apply-to-terms ',name ',name
                                                           (cons number numbers))))))))
  (comparisons < > <= >= = /=))
