;;;; The tables of docs/plan-language.md hold under symbolic execution, too.
;;;;
;;;; Each row whose form returns is made a plan and explored: values and log must be those of the
;;;; row.  The theory has nothing to say about these plans, so that each has one path.

(in-package #:discrepancy-finder.tests)

(def-suite symbolic-table :in all)
(in-suite symbolic-table)

(defvar *emitted* nil
  "The values of the row that is explored.")

(defun emit-values (&rest values)
  (setf *emitted* (values-text values)))

(defun explored-outcome (row)
  "Explore a plan with the form of ROW and return what its row would show."
  (setf *emitted* "nothing")
  (funcall 'discrepancy-finder-user::reset)
  (call-as-user
   (lambda ()
     (eval `(plan:def-top-level-cram-function discrepancy-finder-user::table-row ()
              (multiple-value-call #'emit-values ,(read-from-string (row-form row)))))
     (handler-case (symbolic:explore-plan 'discrepancy-finder-user::table-row
                                          :domain :lamps :constraint 'anything)
       (serious-condition (condition)
         (setf *emitted* (format nil "signals ~a" condition))))
     (list *emitted*
           (format nil "~{~s~^ ~}"
                   (reverse (symbol-value 'discrepancy-finder-user::*log*)))))))

(defparameter *different-rows*
  '(("(type swimming)"
     . "What has no action binding is a gap in the domain, not the plan's matter.")
    ("(task-path a)" . "The path ends in the name of the plan that the row is made.")
    ("(report (retry))" . "The sentence names the plan that the row is made.")
    ("(return-from out 1)"
     . "The evaluator's jump is noticed where it begins, also a CONTROL-ERROR."))
  "Parts of the forms of rows that show something else under symbolic execution, and why.")

(defun explored-p (row)
  "Return true if ROW is to hold under symbolic execution: its form is that of a plan and returns."
  (not (or (row-prompt row)
           (uiop:string-prefix-p "signals" (row-outcome row))
           (some (lambda (entry) (search (car entry) (row-form row))) *different-rows*))))

(test rows-of-the-tables-are-true-under-symbolic-execution
  (let ((lines (plan-language-document)))
    (load-helpers lines)
    (make-lamp-domain)
    (dolist (row (remove-if-not #'explored-p (table-rows lines)))
      (let ((found (explored-outcome row)))
        (is (equal (expected-outcome row) found)
            "~a" (mismatch-text row " under symbolic execution" found (expected-outcome row)))))))
