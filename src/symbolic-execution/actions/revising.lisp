;;;; Revising an action binding: what its success requires is changed.
;;;;
;;;; A REQUIREMENT is a state formula over the variables of a pattern of the event of success, such
;;;; as (:robot-in :?region) over (:put-down :?region).  A pattern with elements for some of its
;;;; variables, (:put-down :r1), is about the events with these.

(in-package #:discrepancy-finder.symbolic-execution)

(defun pattern-bindings (pattern event)
  "Return the list of (variable . element) that makes PATTERN the ground EVENT, and true; or NIL and
NIL if it is about others."
  (loop for term in (rest pattern)
        for part in (rest event)
        for element = (if (symbolp part) (ec:name-keyword part) part)
        if (and (symbolp term) (char= #\? (char (symbol-name term) 0)))
          collect (cons term element) into bindings
        else unless (equal term element)
               do (return (values '() nil))
        finally (return (values bindings t))))

(defun required-of (requirement bindings)
  "Return the formula REQUIREMENT with BINDINGS for its variables."
  (if (typep requirement 'boolean)
      requirement
      (sublis bindings requirement)))

(defun combined (operator old new neutral)
  "Return the formula (OPERATOR OLD NEW), where one that is NEUTRAL can be left out and the opposite
decides."
  (cond ((eq old neutral) new)
        ((eq new neutral) old)
        ((or (eq old (not neutral)) (eq new (not neutral))) (not neutral))
        (t (list operator old new))))

(defun negated-formula (formula)
  (if (typep formula 'boolean) (not formula) (list :not formula)))

(defun outcomes-with-requirement (descriptions required failures mode)
  "Return DESCRIPTIONS, lists of name, event, condition and initargs, success first, where success
requires the formula REQUIRED, as REVISED-BINDING says."
  (destructuring-bind ((success event condition initargs) . others) descriptions
    (append
     (list (list success event
                 (ecase mode
                   (:also (combined :and condition required t))
                   (:instead required)
                   ((:unless :may-fail) condition))
                 initargs))
     (loop for (name event condition initargs) in others
           collect (list name event
                         (cond ((not (member name failures)) condition)
                               ((eq mode :may-fail) t)
                               ((eq mode :instead) (negated-formula required))
                               (t (combined :or condition (negated-formula required) nil)))
                         initargs))
     (loop for name in failures
           unless (find name others :key #'first)
             collect (list name nil
                           (or (eq mode :may-fail) (negated-formula required))
                           '())))))

(defun revised-outcomes (descriptions pattern requirement failures mode)
  "Return DESCRIPTIONS revised as REVISED-BINDING says."
  (multiple-value-bind (bindings matches) (pattern-bindings pattern (second (first descriptions)))
    (if matches
        (outcomes-with-requirement descriptions (required-of requirement bindings) failures mode)
        descriptions)))

(defun revised-binding (binding pattern requirement &key failures (mode :also))
  "Return BINDING with a new requirement of success.  REQUIREMENT is a state formula of keywords
over the variables of PATTERN, which stands for the event of success; T requires nothing.  Actions
whose event does not fit PATTERN are as they were.  FAILURES
are the failure classes that happen where it does not hold; those that BINDING lacks are added.
MODE is :ALSO, where what was required still is, :INSTEAD, :UNLESS, where success is possible all
the same, or :MAY-FAIL: then REQUIREMENT is ignored, and FAILURES may happen whatever is the case."
  (let ((describe (action-binding-describe-outcomes binding)))
    (make-action-binding
     :class (action-binding-class binding) :type (action-binding-type binding)
     :outcomes (append (action-binding-outcomes binding)
                       (set-difference failures (action-binding-outcomes binding)))
     :mentions (action-binding-mentions binding) :position (action-binding-position binding)
     :result (action-binding-result binding) :properties (action-binding-properties binding)
     :describe-outcomes
     (lambda (domain designator)
       (revised-outcomes (funcall describe domain designator) pattern requirement failures
                         mode)))))
