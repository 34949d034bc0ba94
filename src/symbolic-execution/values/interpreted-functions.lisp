;;;; Interpreted functions: real functions whose bodies the evaluator runs.
;;;;
;;;; An interpreted function can be called in two ways.  Its CODE, a compiled closure, takes and
;;;; returns symbolic values: so calls the evaluator, and so do the lifted functions.  The function
;;;; itself, which is what compiled code calls, returns nothing symbolic.
;;;;
;;;; Programs make closures all the time, and a funcallable instance takes a microsecond.  So an
;;;; interpreted function is a closure over nothing but its code, and known by its name.

(in-package #:discrepancy-finder.symbolic-execution)

(declaim (inline interpreted-function-p interpreted-function-code))
(defun interpreted-function-p (thing)
  "Return true if THING is an interpreted function."
  (and (sb-kernel:closurep thing)
       (eq (sb-kernel:%simple-fun-name (sb-kernel:%closure-fun thing)) 'interpreted)))

(deftype interpreted-function ()
  "A function whose body the evaluator runs; its code may be given symbolic values."
  '(satisfies interpreted-function-p))

(defun interpreted-function-code (function)
  "Return the compiled closure that takes and returns symbolic values for FUNCTION, interpreted."
  (declare (type function function))
  (the function (sb-kernel:%closure-index-ref function 0)))

(defun decided-values (&rest values)
  "Return VALUES with nothing symbolic in them."
  (declare (dynamic-extent values))
  (values-list (loop for value in values
                     collect (decided value "what a function returns to compiled code"))))

(defun named-function (function name documentation)
  "Return FUNCTION, an interpreted one just made, which prints as NAME and has DOCUMENTATION, unless
these are NIL."
  (let ((function (if name (sb-impl::set-closure-name function t name) function)))
    (when documentation
      (setf (documentation function t) documentation))
    function))

(defun make-interpreted-function (code)
  "Return an interpreted function with CODE."
  (declare (type function code))
  (sb-int:named-lambda interpreted (&rest arguments)
    (if (symbolic-run-p)
        (multiple-value-call #'decided-values (apply code arguments))
        (apply code arguments))))
