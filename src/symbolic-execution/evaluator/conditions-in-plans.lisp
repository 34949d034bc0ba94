;;;; HANDLER-BIND and HANDLER-CASE, whose expansions are SBCL's internal matter.

(in-package #:discrepancy-finder.symbolic-execution)

(define-analyzer (handler-bind sb-kernel::%handler-bind) (form scope)
  (destructuring-bind (bindings . body) (rest form)
    (unless (every (lambda (binding) (typep binding '(cons t (cons t null)))) bindings)
      (unsupported form "a binding of a handler is (type function)"))
    (let ((types (mapcar #'first bindings))
          (handlers (loop for (nil handler) in bindings collect (analyze handler scope)))
          (inside (analyze `(progn ,@body) scope)))
      (declare (type function inside))
      (code (frame)
        (plan:call-with-failure-handlers
         (loop for type in types for handler in handlers
               collect (cons type (handler-function (run handler frame))))
         (lambda () (run inside frame)))))))

(defun handler-function (designator)
  "Return the function that calls the function that DESIGNATOR is, and hands nothing on."
  (let ((function (function-to-call designator)))
    (declare (type function function))
    (lambda (condition)
      (funcall function condition)
      nil)))

(define-analyzer handler-case (form scope)
  (destructuring-bind (protected . clauses) (rest form)
    (let* ((no-error (find :no-error clauses :key #'first))
           (clauses (remove no-error clauses))
           (tags (loop for nil in clauses collect (gensym "CLAUSE")))
           (block (gensym "HANDLER-CASE"))
           (condition (gensym "CONDITION")))
      (analyze-form
       `(block ,block
          (let ((,condition nil))
            (tagbody
               (return-from ,block
                 ,(let ((guarded `(handler-bind
                                      ,(loop for (type) in clauses for tag in tags
                                             collect `(,type (lambda (signaled)
                                                               (setq ,condition signaled)
                                                               (go ,tag))))
                                    ,protected)))
                    (if no-error
                        `(multiple-value-call (lambda ,@(rest no-error)) ,guarded)
                        guarded)))
               ,@(loop for (nil lambda-list . body) in clauses for tag in tags
                       append (list tag
                                    `(return-from ,block
                                       ,(if lambda-list
                                            `(let ((,(first lambda-list) ,condition)) ,@body)
                                            `(let () ,@body))))))))
       scope))))
