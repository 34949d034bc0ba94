;;;; Which definition a macro form stands in, so that what is wrong with it can be said to be there.

(in-package #:discrepancy-finder.source)

(defmacro with-definition ((name) &body body)
  "Evaluate BODY, in the macros of which ENCLOSING-DEFINITION returns the symbol NAME."
  `(symbol-macrolet ((enclosing-definition ,name)) ,@body))

(defun enclosing-definition (environment)
  "Return the name of the innermost WITH-DEFINITION around a macro form with ENVIRONMENT, or NIL."
  (multiple-value-bind (name known) (macroexpand-1 'enclosing-definition environment)
    (and known name)))
