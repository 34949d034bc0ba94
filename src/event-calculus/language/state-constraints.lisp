;;;; State constraints: formulas over a few successive timepoints.
;;;;
;;;; A path of a plan on which a state constraint comes true is a trace worth simulating.
;;;; (define-state-constraint NAME (THEORY) (?time) formula) names one; the formula speaks of ?time
;;;; and (+ ?time n) through holds-at and happens.  In a theory's file the theory is left out.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (state-constraint (:copier nil))
  "A formula over SPAN + 1 successive timepoints, ?time to ?time + SPAN."
  (name nil :type keyword :read-only t)
  (theory nil :type theory :read-only t)
  (formula nil :type list :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (span 0 :type (integer 0) :read-only t))

(setf (documentation 'state-constraint-p 'function)
      "Return true if its argument is a STATE-CONSTRAINT."
      (documentation 'state-constraint-name 'function)
      "Return the name of a state constraint, a keyword."
      (documentation 'state-constraint-theory 'function)
      "Return the theory of a state constraint."
      (documentation 'state-constraint-formula 'function)
      "Return the formula of a state constraint, a tree of keywords."
      (documentation 'state-constraint-documentation 'function)
      "Return the documentation string of a state constraint, or NIL."
      (documentation 'state-constraint-span 'function)
      "Return the number of timepoints after ?time that a state constraint looks at.")

(defmethod print-object ((constraint state-constraint) stream)
  (print-unreadable-object (constraint stream :type t)
    (format stream "~a of ~a" (name-text (state-constraint-name constraint))
            (name-text (theory-name (state-constraint-theory constraint))))))

(defun formula-span (form)
  "Return the number of timepoints after ?time that FORM looks at: an event at t ends at t + 1."
  (if (consp form)
      (case (first form)
        (:holds-at (or (time-offset (third form)) 0))
        (:happens (1+ (or (time-offset (third form)) 0)))
        (t (reduce #'max (rest form) :key #'formula-span :initial-value 0)))
      0))

(defun parse-state-constraint (theory definition)
  "Return the state constraint of THEORY written as DEFINITION: (name (?time) [documentation]
formula).  Signals THEORY-ERROR."
  (destructuring-bind (name &optional variables &rest body) definition
    (unless (and name (symbolp name))
      (theory-problem theory nil nil "~a cannot be the name of a state constraint"
                      (written-text name)))
    (let ((documentation (and (stringp (first body)) (pop body)))
          (blame (format nil "state constraint ~a" (name-text name))))
      (unless (and (proper-list-p variables) (= (length variables) 1)
                   (time-variable-p (first variables))
                   (= (length body) 1))
        (theory-problem theory blame nil "(~a (?time) formula) was expected" (name-text name)))
      (let ((formula (parse-formula (first body) theory :kind :constraint :blame blame)))
        (make-state-constraint :name (name-keyword name) :theory theory :formula formula
                               :documentation documentation :span (formula-span formula))))))

(defun register-state-constraint (theory constraint)
  (setf (theory-state-constraints theory)
        (append (remove (state-constraint-name constraint) (theory-state-constraints theory)
                        :key #'state-constraint-name)
                (list constraint)))
  constraint)

(defmacro define-state-constraint (&whole form name (theory) (time) &body body)
  "Define the state constraint NAME of the theory THEORY.  BODY is an optional documentation string
and a formula over the timepoints TIME (which must be ?time) and (+ ?time n).  Signals THEORY-ERROR
and THEORY-NOT-FOUND when evaluated."
  `(let ((theory (find-theory ',theory))
         (*place* (place-of ',form)))
     (register-state-constraint theory (parse-state-constraint theory '(,name (,time) ,@body)))))

(defun find-state-constraint (name theory)
  "Return the state constraint of THEORY named by the symbol NAME; with NIL its only one.  Signals
STATE-CONSTRAINT-NOT-FOUND."
  (let ((constraints (theory-state-constraints theory)))
    (or (if name
            (find (name-keyword name) constraints :key #'state-constraint-name)
            (and (= (length constraints) 1) (first constraints)))
        (error 'state-constraint-not-found
               :name name :theory (theory-name theory)
               :known (mapcar #'state-constraint-name constraints)))))
