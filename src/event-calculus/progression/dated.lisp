;;;; Axioms that compare timepoints or name them by number: their instances by time.
;;;;
;;;; (happens (load) 0), (implies (and (holds-at ?fluent ?time1) (< ?time1 ?time2)) ...) and their
;;;; kin are made ground for a horizon that lies far beyond the states so far.  An instance counts
;;;; as soon as the last timepoint that it speaks of is reached: its formula is final then.  One
;;;; that speaks of all timepoints to come is never looked at, and what DATED-LIMITS returns says
;;;; so.
;;;;
;;;; Trajectories are made ground again here if the range of their offsets grows with the horizon.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (dated (:copier nil))
  "The instances for the timepoints HORIZON of the axioms that OUTLINE does without."
  (horizon nil :type cons :read-only t)
  ;; tables from timepoints: the demands that are due then; the effects of events then, also those
  ;; on numbers; the supports of events and predicates then, each (kind number supports*) with one
  ;; list of supports for each completion
  (demands (make-hash-table) :type hash-table :read-only t)
  (effects (make-hash-table) :type hash-table :read-only t)
  (numeric-effects (make-hash-table) :type hash-table :read-only t)
  (supports (make-hash-table) :type hash-table :read-only t)
  ;; for each cause its trajectories
  (changes #() :type simple-vector :read-only t)
  ;; a table from (axiom . bindings) to formula and last timepoint
  (formulas (make-term-table) :type hash-table :read-only t)
  ;; a table from timepoints to limits
  (limits-of (make-hash-table) :type hash-table :read-only t))

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

;;; What counts when

(defun due-time (outline sentence)
  "Return the timepoint at which SENTENCE, an instance, can be judged."
  (let ((theory (ground-theory-theory (outline-ground outline)))
        (due (if (formula-reach (sentence-formula sentence))
                 (effective-last outline sentence)
                 (outline-first-time outline))))
    (loop for (variable . value) in (sentence-bindings sentence)
          when (eq (variable-sort theory variable) :time)
            do (setf due (max due value)))
    due))

(defun enter-demands (outline dated sentences)
  (let ((seen (make-term-table)))
    (loop for (due . sentence)
            in (stable-sort (loop for sentence in sentences
                                  collect (cons (due-time outline sentence) sentence))
                            #'< :key #'car)
          for formula = (sentence-formula sentence)
          do (setf (gethash (instance-key sentence) (dated-formulas dated)) (list formula due))
             (unless (gethash formula seen)
               (setf (gethash formula seen) t)
               (push (sentence-demand outline sentence)
                     (gethash due (dated-demands dated)))))))

(defun enter-support (dated kind index time position count support)
  (let ((entry (find-if (lambda (entry)
                          (and (eq (first entry) kind) (eql (second entry) index)))
                        (gethash time (dated-supports dated)))))
    (unless entry
      (setf entry (list* kind index (make-list count :initial-element '())))
      (push entry (gethash time (dated-supports dated))))
    (push support (nth (+ 2 position) entry))))

(defun atom-labels (ground kind index)
  "Return the labels under which the atom of KIND with the number INDEX is completed."
  (ecase kind
    (:event (event-labels (ground-theory-theory ground)))
    (:predicate (predicate-labels ground index))))

(defun enter-supports (outline dated sentence)
  "Enter what SENTENCE supports, at which timepoint, under each completion."
  (map-positive-atoms
   (lambda (atom)
     (when (member (first atom) '(:event :predicate))
       (destructuring-bind (kind index time) atom
         (loop with labels = (atom-labels (outline-ground outline) kind index)
               for label in labels
               for position from 0
               when (supporting-p (sentence-axiom sentence) label)
                 do (dolist (support (atom-supports kind index (list (cons sentence time))))
                      (enter-support dated kind index time position (length labels) support))))))
   (sentence-formula sentence)))

(defun dated-supports-at (outline time)
  "Return what has supports at TIME only: a list of (kind number supports*)."
  (and (outline-dated-p outline)
       (values (gethash time (dated-supports (outline-dated-until outline time))))))

(defun dated-alternatives (outline kind number time)
  "Return the supports that the atom of KIND with NUMBER has at TIME only, a list for each of its
completions."
  (loop for (other-kind other-number . alternatives) in (dated-supports-at outline time)
        when (and (eq kind other-kind) (eql number other-number))
          return alternatives))

(defun enter-effects (outline dated ground)
  (flet ((enter (vector table)
           (loop for effects across vector
                 do (dolist (effect effects)
                      (when (effect-time effect)
                        (push effect (gethash (effect-time effect) table)))))))
    (enter (ground-theory-effects ground) (dated-effects dated))
    (enter (ground-theory-effects-on-numeric ground) (dated-numeric-effects dated))
    (loop for effects being the hash-values of (dated-numeric-effects dated)
          do (note-numeric-limits outline effects))))

(defun compute-dated (outline horizon)
  "Return the dated instances of OUTLINE for HORIZON."
  (let ((ground (outline-ground outline)))
    (multiple-value-bind (copy sentences) (ground-until ground horizon (dated-clauses ground))
      (let ((dated (make-dated :horizon horizon :changes (ground-theory-changes copy))))
        (enter-demands outline dated sentences)
        (dolist (sentence sentences) (enter-supports outline dated sentence))
        (enter-effects outline dated copy)
        (set-release outline copy)
        dated))))

(defun needs-dated-p (ground)
  "Return true if GROUND has dated instances or trajectories that grow with the horizon."
  (and (or (ground-theory-absolute-clauses ground)
           (and (growing-offsets-p (ground-theory-theory ground))
                (trajectory-clauses (ground-theory-theory ground))))
       t))

(defun dated-sentences (outline)
  "Return the dated sentences of OUTLINE for some horizon."
  (and (outline-dated-p outline)
       (nth-value 1 (ground-until (outline-ground outline) (dated-horizon (outline-dated outline))
                                  (dated-clauses (outline-ground outline))))))

(defun outline-dated-until (outline time)
  "Return the dated instances of OUTLINE for a horizon far beyond TIME."
  (let* ((first (outline-first-time outline))
         (dated (outline-dated outline))
         (last (+ first 8 (* 2 (- time first)))))
    (if (and dated (>= (cdr (dated-horizon dated)) last))
        dated
        (setf (outline-dated outline)
              (compute-dated outline (cons first (if dated (+ last (- last first)) last)))))))

;;; Exactness

(defun open-ended-p (outline time due)
  "Return true if what is DUE, seen from TIME, is so only because the horizon of the dated
instances ends somewhere: it speaks of all timepoints to come."
  (and (outline-dated-p outline)
       (> (* 2 due) (+ time (cdr (dated-horizon (outline-dated-until outline time)))))))

(defun compare-instances (outline dated time)
  "Return the axioms of those instances for a horizon that ends at TIME that are never due, and
true if the others are those of DATED that are due by then."
  (let ((endless '()) (same t)
        (formulas (make-term-table))
        (ground (outline-ground outline)))
    (dolist (sentence (nth-value 1 (ground-until ground (cons (outline-first-time outline) time)
                                                 (dated-clauses ground))))
      (let ((key (instance-key sentence)))
        (setf (gethash key formulas) t)
        (destructuring-bind (formula &optional (due most-positive-fixnum))
            (gethash key (dated-formulas dated) '(nil))
          (cond ((and (< due most-positive-fixnum) (open-ended-p outline time due))
                 (pushnew (sentence-axiom sentence) endless))
                ((not (and (<= due time) (equal formula (sentence-formula sentence))))
                 (setf same nil))))))
    (loop for key being the hash-keys of (dated-formulas dated) using (hash-value value)
          do (unless (or (> (second value) time) (gethash key formulas))
               (setf same nil)))
    (values endless same)))

(defun dated-limits (outline time)
  "Return the limits, (axiom . reason), of what is known at TIME of the axioms that compare
timepoints, and true if but for these the instances for a horizon that ends at TIME are judged."
  (let* ((dated (outline-dated-until outline time))
         (entry (or (gethash time (dated-limits-of dated))
                    (setf (gethash time (dated-limits-of dated))
                          (multiple-value-bind (endless same)
                              (compare-instances outline dated time)
                            (cons same
                                  (loop for axiom in endless
                                        collect (cons axiom *to-come*))))))))
    (values (cdr entry) (car entry))))
