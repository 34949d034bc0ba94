;;;; Symbolic arguments of a plan.
;;;;
;;;; :ARGUMENTS '((?object-type item-type) (?retries (integer 0 3))) gives parameters types; each
;;;; run calls the plan with symbolic values of these types.  A trace has the least concrete ones
;;;; that its path allows.  Entry points: PARAMETER-TYPES, MAKE-ARGUMENTS, CONCRETE-ARGUMENTS.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (argument (:copier nil))
  "What a call of a plan has in one place: VALUE, symbolic or, of a keyword, concrete, CONDITIONS
that are true of it, and CONCRETE, a function that returns its concrete value and is given the
function from terms to their values in a model."
  (value nil :read-only t)
  (conditions '() :type list :read-only t)
  (concrete #'identity :type function :read-only t))

(defun parameter-types (plan arguments)
  "Return a list of what a call of PLAN needs by ARGUMENTS, a list of (parameter type): in the order
of the lambda list (parameter type), and the keywords where there are keyword parameters.  Signals
UNSUPPORTED-FORM if ARGUMENTS is no such list, if a parameter is missing, or if there is none of
that name."
  (unless (and (alexandria:proper-list-p arguments)
               (every (lambda (argument)
                        (and (alexandria:proper-list-p argument) (= (length argument) 2)
                             (symbolp (first argument))))
                      arguments)
               (alexandria:setp arguments :key #'first :test #'string=))
    (error 'unsupported-form :form arguments
                             :reason "a list of (parameter type) was expected, one of each"))
  (multiple-value-bind (required optional rest keywords)
      (alexandria:parse-ordinary-lambda-list (plan:plan-lambda-list plan))
    (declare (ignore rest))
    (labels ((complain (control names)
               (error 'unsupported-form
                      :form (list* (plan:plan-name plan) (plan:plan-lambda-list plan))
                      :reason (format nil "~@?~{ ~(~a~)~^,~}" control names)))
             (given (name) (find name arguments :key #'first :test #'string=))
             (missing (names) (remove-if #'given names)))
      (let* ((optional (mapcar #'first optional))
             (last (if (some #'given (mapcar #'cadar keywords))
                       (1- (length optional)) ; keywords come after all of these
                       (position-if #'given optional :from-end t)))
             (needed (append required (subseq optional 0 (if last (1+ last) 0))))
             (known (append required optional (mapcar #'cadar keywords))))
        (when (missing needed)
          (complain "it needs a type for each of its parameters, and got none for"
                    (missing needed)))
        (let ((strange (set-difference (mapcar #'first arguments) known :test #'string=)))
          (when strange
            (complain "it has no parameter" strange)))
        (append (mapcar #'given needed)
                (loop for ((keyword name)) in keywords
                      when (given name) collect keyword and collect (given name)))))))

(defun make-arguments (types theory context)
  "Return the list of the ARGUMENTs for TYPES, what PARAMETER-TYPES returns, of THEORY, with their
variables in the Z3 CONTEXT.  Signals UNKNOWN-ARGUMENT-TYPE."
  (loop for entry in types
        collect (if (keywordp entry)
                    (make-argument :value entry :concrete (constantly entry))
                    (destructuring-bind (parameter type) entry
                      (multiple-value-bind (value conditions concrete)
                          (make-symbolic-argument parameter type theory context)
                        (make-argument :value value :conditions conditions
                                       :concrete concrete))))))

(defgeneric terms-to-fix (value)
  (:documentation "Return the terms whose least values, one after the other, make the symbolic VALUE
of an argument its least concrete one: of elements the first.")
  (:method (value) (declare (ignore value)) '())
  (:method ((value symbolic-boolean)) (list (symbolic-boolean-proposition value)))
  (:method ((value symbolic-number)) (list (symbolic-number-term value)))
  (:method ((value symbolic-element))
    (loop for (nil . proposition) in (symbolic-element-choices value)
          collect (z3:negation proposition))))

(defun argument-terms (argument)
  "Return the terms on which the value of ARGUMENT depends, the more important ones first."
  (terms-to-fix (argument-value argument)))

(defun concrete-arguments (assignment arguments)
  "Return the list of the concrete values of ARGUMENTS by ASSIGNMENT."
  (loop for argument in arguments
        collect (funcall (argument-concrete argument)
                         (lambda (term) (term-value assignment term)))))
