;;;; The operators of the plan language that know fluents: lifted as their namesakes are.

(in-package #:discrepancy-finder.symbolic-execution)

(defun register-fluent-operator (name)
  "Let the operator on fluents NAME do what the lifted version of its namesake in Common Lisp does
where no fluent is among its arguments."
  (let ((original (fdefinition name))
        (lifted (lifted-function (find-symbol (symbol-name name) '#:cl)))
        (description (describe-decision name)))
    (declare (function original lifted))
    (register-lifted name :lifted
                     (lambda (&rest arguments)
                       (declare (dynamic-extent arguments))
                       (if (some #'plan:fluentp arguments)
                           (call-opaque original (copy-list arguments) description)
                           (apply lifted arguments))))))

(mapc #'register-fluent-operator
      '(discrepancy-finder.cpl:< discrepancy-finder.cpl:> discrepancy-finder.cpl:=
        discrepancy-finder.cpl:+ discrepancy-finder.cpl:- discrepancy-finder.cpl:*
        discrepancy-finder.cpl:/ discrepancy-finder.cpl:eq discrepancy-finder.cpl:eql
        discrepancy-finder.cpl:not))
