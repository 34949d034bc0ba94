;;;; Hooks: generic functions all of whose methods run.
;;;;
;;;; A method is defined with a name of its own as qualifier, so that several users can hook in:
;;;; (defmethod on-event my-hook ((event object-attached)) ...).  The results are appended.

(in-package #:discrepancy-finder.plan-language)

(define-method-combination hooks ()
  ((methods *))
  "Call all methods, whatever their qualifier, the most specific first, and append their results, if
these are lists."
  `(append ,@(loop for method in methods
                   collect `(alexandria:ensure-list (call-method ,method)))))

(defmacro define-hook (name lambda-list &optional documentation)
  "Define the hook NAME: a generic function with LAMBDA-LIST all of whose methods are called."
  `(defgeneric ,name ,lambda-list
     (:method-combination hooks)
     ,@(and documentation `((:documentation ,documentation)))
     (:method nothing ,(loop for parameter in lambda-list
                             collect parameter)
       (declare (ignorable ,@(set-difference lambda-list lambda-list-keywords)))
       '())))
