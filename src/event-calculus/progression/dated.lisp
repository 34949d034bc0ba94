;;;; Axioms that compare timepoints or name them by number: their instances by time.
;;;;
;;;; (happens (load) 0), (implies (and (holds-at ?fluent ?time1) (< ?time1 ?time2)) ...) and their
;;;; kin are made ground for a horizon that lies far beyond the states so far.  An instance counts as
;;;; soon as the last timepoint that it speaks of is reached: its formula is final then.  One that
;;;; speaks of all timepoints to come is never looked at, and what DATED-LIMITS returns says so: it
;;;; compares the instances with those for the horizon that ends now.
;;;;
;;;; Trajectories are made ground again here if the range of their offsets grows with the horizon.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (dated (:copier nil))
  "The instances for the timepoints HORIZON of the axioms that OUTLINE does without."
  (horizon nil :type cons :read-only t)
  ;; tables from timepoints: the demands that are due then; the effects of events then; the
  ;; supports of events and predicates then, each (kind number supports*) with one list of supports
  ;; for each completion
  (demands (make-hash-table) :type hash-table :read-only t)
  (effects (make-hash-table) :type hash-table :read-only t)
  (supports (make-hash-table) :type hash-table :read-only t)
  ;; for each cause its trajectories
  (changes #() :type simple-vector :read-only t)
  ;; a table from (axiom . bindings) to formula and last timepoint
  (formulas (make-hash-table :test 'equal) :type hash-table :read-only t)
  ;; a table from timepoints to limits
  (limits (make-hash-table) :type hash-table :read-only t))

(defun lift-universals (form)
  "Return FORM with universal quantifiers in the conclusion of an implication moved outside: it has
more instances then, each about fewer timepoints."
  (let ((form (strip-quantifiers form)))
    (if (eq (first form) :implies)
        (destructuring-bind (premise conclusion) (rest form)
          (let ((inner (lift-universals conclusion)))
            (cond ((intersection (free-variables premise) (bound-variables conclusion)) form)
                  ((eq (first inner) :implies)
                   (list :implies (conjoin premise (second inner)) (third inner)))
                  (t (list :implies premise inner)))))
        form)))

(defun bound-variables (form)
  (cond ((atom form) '())
        ((member (first form) '(:forall :exists))
         (append (second form) (bound-variables (third form))))
        (t (mapcan #'bound-variables (copy-list (rest form))))))

(defun dated-clauses (ground)
  (loop for (axiom kind condition head) in (ground-theory-absolute-clauses ground)
        collect (list axiom kind condition
                      (if (eq kind :sentence) (lift-universals head) head))))

(defun growing-offsets-p (theory)
  "Return true if the range of the sort OFFSET of THEORY depends on the horizon."
  (null (theory-offset-range theory)))

(defun trajectory-clauses (theory)
  (loop for axiom in (theory-axioms theory)
        append (loop for (kind condition head) in (axiom-clauses axiom theory)
                     when (eq kind :trajectory) collect (list axiom kind condition head))))

(defun ground-until (ground horizon clauses)
  "Return a copy of GROUND with the instances for HORIZON of CLAUSES, and the list of its dated
sentences."
  (let ((copy (copy-with-own-effects ground))
        (theory (ground-theory-theory ground))
        (*horizon* horizon)
        (*span* (cons 0 0)))
    (when (growing-offsets-p theory)
      (let ((relative (remove-if-not (lambda (clause) (clause-relative-p theory clause nil))
                                     (trajectory-clauses theory)))
            (*relative* t))
        (setf (ground-theory-changes copy)
              (make-array (length (ground-theory-fluents ground)) :initial-element '()))
        (add-clauses copy relative)))
    (let ((*relative* nil))
      (values copy (add-clauses copy clauses)))))

(defun instance-key (sentence)
  (cons (axiom-name (sentence-axiom sentence)) (sentence-bindings sentence)))

(defun add-dated-supports (dated theory sentences)
  "Enter what SENTENCES support, at which timepoint, under each completion of THEORY."
  (flet ((enter (time kind index position count support)
           (let* ((entries (gethash time (dated-supports dated)))
                  (entry (find-if (lambda (entry)
                                    (and (eq (first entry) kind) (eql (second entry) index)))
                                  entries)))
             (unless entry
               (setf entry (list* kind index (make-list count :initial-element '())))
               (push entry (gethash time (dated-supports dated))))
             (push support (nth (+ 2 position) entry)))))
    (dolist (sentence sentences)
      (map-positive-atoms
       (lambda (atom)
         (when (member (first atom) '(:event :predicate))
           (destructuring-bind (kind index time) atom
             (loop with labels = (if (eq kind :event)
                                     (event-labels theory)
                                     '())
                   for label in labels
                   for position from 0
                   when (supporting-p sentence label)
                     do (dolist (support (atom-supports kind index (list (cons sentence time))))
                          (enter time kind index position (length labels) support))))))
       (sentence-formula sentence)))))
