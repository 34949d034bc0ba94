;;;; Grounds: what of a theory the outcome of an exploration rests on.
;;;;
;;;; The GROUNDS of a step are the axioms that say something of it, the fluents that keep their
;;;; truth value by inertia through its event, and the action binding.  Those of a trace are its
;;;; steps' together; those of an exploration, which must record its coverage, are those of all its
;;;; paths.

(in-package #:discrepancy-finder.symbolic-execution)

(defun axiom-ground (axiom)
  (list :axiom (ec:axiom-name axiom)))

(defun exploration-grounds (exploration)
  "Return what the paths of EXPLORATION, which was made with the option :COVERAGE T, rest on so far:
a list of (:axiom name), (:inertia fluent event truth) with the names of a fluent and of an event
through which it keeps the value TRUTH, and (:binding class type) of an action binding; all names
are keywords.  Signals COVERAGE-NOT-RECORDED."
  (let ((recorder (exploration-recorder exploration)))
    (unless recorder
      (error 'coverage-not-recorded :plan (plan:plan-name (exploration-plan exploration))))
    (append (mapcar #'axiom-ground (reverse (recorder-axioms recorder)))
            (loop for entry being the hash-keys of (recorder-persistences recorder)
                  collect entry)
            (remove-duplicates (loop for entry in (reverse (recorder-outcomes recorder))
                                     collect (list :binding (first entry) (second entry)))
                               :test #'equal))))

(defun step-binding-p (step class type)
  "Return true if the designator of the trace step STEP is of CLASS and TYPE, keywords."
  (search (format nil " ~(~a~) (type ~a)" class (ec:name-text type)) (step-designator step)))

(defun trace-grounds (trace domain)
  "Return what TRACE, explored in DOMAIN, rests on, as EXPLORATION-GROUNDS does."
  (remove-duplicates
   (append
    (mapcar #'axiom-ground (ec:initial-axioms (action-theory-ground domain)))
    (loop for (state next) on (trace-states trace)
          while next
          append (mapcar #'axiom-ground (ec:axioms-used state next))
          append (persistences state next))
    (loop for binding in (action-theory-actions domain)
          for class = (action-binding-class binding)
          for type = (action-binding-type binding)
          when (some (lambda (step) (step-binding-p step class type)) (trace-steps trace))
            collect (list :binding class type)))
   :test #'equal :from-end t))
