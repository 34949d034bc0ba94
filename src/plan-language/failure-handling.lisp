;;;; Failure handling: what a plan does about failures.
;;;;
;;;; WITH-FAILURE-HANDLING handles a failure before the stack is unwound, and its handlers may
;;;; RETRY; retry counters bound how often.  The macros expand into lambdas and calls of ordinary
;;;; functions, so that compiled and symbolically executed plans share one meaning.

(in-package #:discrepancy-finder.plan-language)

(defun retry ()
  "Inside a handler of WITH-FAILURE-HANDLING, begin its body again.  Anywhere else this signals
MALFORMED-PLAN-FORM."
  (error 'malformed-plan-form :form '(retry) :plan (current-plan-name)
                              :expected "an enclosing handler of with-failure-handling"))

(define-compiler-macro retry (&whole form &environment environment)
  ;; The local function of WITH-FAILURE-HANDLING shadows this: here nobody will handle it.
  (warn 'misplaced-retry :form form :plan (source:enclosing-definition environment))
  form)

(defun handled-condition (condition type)
  "Return what a clause for TYPE handles of CONDITION: itself, the error in an envelope, or NIL."
  (cond ((typep condition type) condition)
        ((and (typep condition 'common-lisp-error-envelope)
              (typep (envelop-error condition) type))
         (envelop-error condition))))

(defun call-with-failure-handlers (handlers body)
  "Call BODY; each condition signaled meanwhile is handed to every handler of the list HANDLERS of
(type . function) whose type it has, in order.  One that returns has declined."
  (handler-bind ((condition (lambda (condition)
                              (loop for (type . handler) in handlers
                                    for handled = (handled-condition condition type)
                                    when handled
                                      do (funcall handler handled)))))
    (funcall body)))

(defun class-name-p (thing)
  (and thing (symbolp thing) (not (keywordp thing))))

(defun failure-clause-p (clause)
  "Return true if CLAUSE is (class ([variable]) form*), where class may be (or class+)."
  (and (alexandria:proper-list-p clause) (rest clause)
       (destructuring-bind (type variables &rest forms) clause
         (declare (ignore forms))
         (and (or (class-name-p type)
                  (and (alexandria:proper-list-p type) (eq (first type) 'or) (rest type)
                       (every #'class-name-p (rest type))))
              (or (null variables)
                  (and (alexandria:proper-list-p variables) (null (rest variables))
                       (class-name-p (first variables))
                       (not (constantp (first variables)))))))))

(defun failure-handlers (clause)
  "Return the list of the forms for the (type . function) of CLAUSE.  There is one for each of the
classes in an OR, as in CRAM: a failure of several of them is handed to the clause several times."
  (destructuring-bind (type (&optional (variable nil named)) &body handler) clause
    (let ((parameter (if named variable (gensym "FAILURE"))))
      (loop for class in (if (and (consp type) (eq (first type) 'or)) (rest type) (list type))
            collect `(cons ',class (lambda (,parameter)
                                     (declare (ignorable ,parameter))
                                     ,@handler))))))

(defmacro with-failure-handling (&whole form clauses &body body &environment environment)
  "Evaluate BODY and return its values.  CLAUSES are (type ([variable]) form*): when a condition of
TYPE, a class or (or class*), is signaled in BODY, the forms run before the stack is unwound.  They
may call RETRY, leave by RETURN, or end normally: then the next clause that fits and after it the
outer handlers have their turn.  Semantics are CRAM's."
  (unless (and (alexandria:proper-list-p clauses) (every #'failure-clause-p clauses))
    (error 'malformed-plan-form
           :form form :plan (source:enclosing-definition environment)
           :expected "a list of clauses (class ([variable]) form*)"))
  (let ((again (gensym "AGAIN")))
    `(block nil
       (tagbody
          ,again
          (return
            (call-with-failure-handlers
             (flet ((retry () (go ,again)))
               (declare (ignorable #'retry))
               (list ,@(loop for clause in clauses append (failure-handlers clause))))
             (lambda () ,@body)))))))

;;; Retry counters

(defstruct (retry-counter (:constructor make-retry-counter (initial count)))
  "How often something may still be tried again; INITIAL is called for the number at a reset."
  (initial #'identity :type function :read-only t)
  (count 0 :type integer))

(defun take-retry (counter)
  "Count one retry of COUNTER and return true, or return NIL if none is left."
  (when (plusp (retry-counter-count counter))
    (decf (retry-counter-count counter))
    t))

(defun restart-counter (counter)
  (setf (retry-counter-count counter) (funcall (retry-counter-initial counter))))

(defun counter-form (name form environment)
  "Return the form for the retry counter NAME that is lexically visible in ENVIRONMENT.  Signals
MALFORMED-PLAN-FORM for FORM if there is none."
  (let ((variable (and (class-name-p name) (counter-variable name))))
    (if (and variable (nth-value 1 (macroexpand-1 variable environment)))
        variable
        (error 'malformed-plan-form
               :form form :plan (source:enclosing-definition environment)
               :expected (format nil "a retry counter ~(~a~) of an enclosing with-retry-counters"
                                 name)))))

(defun counter-variable (name)
  "Return the symbol under which the retry counter NAME is known: not NAME itself, which the plan
may use for a variable of its own."
  (intern (format nil "RETRY-COUNTER ~a:~a"
                  (package-name (or (symbol-package name) *package*)) name)
          '#:discrepancy-finder.plan-language))

(defun check-counters (bindings form environment)
  (unless (and (alexandria:proper-list-p bindings)
               (every (lambda (binding)
                        (and (alexandria:proper-list-p binding) (= (length binding) 2)
                             (class-name-p (first binding))))
                      bindings))
    (error 'malformed-plan-form
           :form form :plan (source:enclosing-definition environment)
           :expected "a list of counters (name number)")))

(defmacro with-retry-counters (&whole form bindings &body body &environment environment)
  "Evaluate BODY with retry counters: BINDINGS are (name number).  In BODY, (do-retry name form*)
evaluates the forms and counts down while retries are left and returns NIL afterwards,
(get-counter name) returns what is left, (reset-counter name) starts again."
  (check-counters bindings form environment)
  (let ((variables (loop for nil in bindings collect (gensym "COUNTER"))))
    `(let ,(loop for variable in variables
                 for (nil number) in bindings
                 collect `(,variable (make-retry-counter (lambda () ,number) ,number)))
       (declare (ignorable ,@variables))
       (symbol-macrolet ,(loop for variable in variables
                               for (name nil) in bindings
                               collect `(,(counter-variable name) ,variable))
         ,@body))))

(defmacro do-retry (&whole form name &body forms &environment environment)
  "Inside WITH-RETRY-COUNTERS, evaluate FORMS and count down the counter NAME if it has retries
left; else return NIL."
  `(when (take-retry ,(counter-form name form environment)) ,@forms))

(defmacro get-counter (&whole form name &environment environment)
  "Inside WITH-RETRY-COUNTERS, return the number of retries that the counter NAME has left."
  `(retry-counter-count ,(counter-form name form environment)))

(defmacro reset-counter (&whole form name &environment environment)
  "Inside WITH-RETRY-COUNTERS, give the counter NAME its initial number of retries again."
  `(restart-counter ,(counter-form name form environment)))
