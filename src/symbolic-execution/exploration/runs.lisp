;;;; Runs: the plan, once, along a prefix.
;;;;
;;;; Between runs everything is as before: what interpreted code has written to global variables and
;;;; objects is undone, random state and gensym counter are the same, output goes into the trace.

(in-package #:discrepancy-finder.symbolic-execution)

(defun call-plan (plan function arguments doom)
  "Call FUNCTION with ARGUMENTS for the plan named PLAN.  An error that the plan does not handle is
signaled as PLAN-BROKE, where the plan's top-level is left, after the function DOOM was called with
that condition."
  (handler-bind (((or error storage-condition)
                   (lambda (condition)
                     (let ((final (if (typep condition
                                             '(or symbolic-execution-error z3:z3-error
                                               z3:solver-unknown plan:plan-error))
                                      condition
                                      (make-condition 'plan-broke :plan plan
                                                                  :error condition))))
                       (funcall doom final)
                       (unless (eq final condition)
                         (error final))))))
    (if (plan:plan-top-level-p (plan:find-plan plan))
        (apply function arguments)
        (plan:ensure-top-level (lambda () (apply function arguments)) plan))))

(defun kept-error-p (path)
  "Return true if the run of PATH is over by an error of the plan that is an ending like others."
  (and (path-keep-errors path)
       (typep (path-fatal path) '(or plan-broke plan:plan-error))))

(defun run-plan-on (path function arguments)
  "Call FUNCTION, the interpreted plan, with ARGUMENTS on PATH, note how the run ends and return
what it prints.  Signals NONDETERMINISTIC-PLAN if the plan ends before it has met all decisions of
the prefix."
  (setf (path-handlers path) (plan:current-handlers))
  (let* ((output (make-string-output-stream))
         (*random-state* (sb-ext:seed-random-state 0))
         (*gensym-counter* 0)
         (*standard-output* output)
         (*plan-output* output)
         (*error-output* output)
         (*trace-output* output)
         (*path* path))
    (unwind-protect
         (catch path
           (plan:with-executive (path)
             (handler-case (progn (call-plan (path-plan path) function arguments
                                             (lambda (condition)
                                               (doom path condition)
                                               (when (kept-error-p path)
                                                 (plan:leave-plan path))))
                                  (unless (path-fatal path)
                                    (setf (path-ending path) :finished)))
               (plan:plan-failure (failure)
                 (unless (path-fatal path)
                   (setf (path-ending path) (type-of failure)))))))
      (undo-writes path))
    (check-ending path)
    (get-output-stream-string output)))

(defun check-ending (path)
  "Signal the error by which the run of PATH ended, or that it ended too early."
  ;; A cleanup form may have replaced the unwinding by a way out of its own.
  (when (and (path-fatal path) (not (kept-error-p path)))
    (error (path-fatal path)))
  (when (and (path-prefix path) (not (eq (path-ending path) :out-of-time)))
    (error 'nondeterministic-plan
           :plan (path-plan path) :found "its end"
           :expected (expected-text (first (path-prefix path))))))

