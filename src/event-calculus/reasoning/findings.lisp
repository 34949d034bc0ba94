;;;; What a theory's author may want to know: CHECK-THEORY.
;;;;
;;;; A FINDING has a severity: an :ERROR leaves no model, a :WARNING is a sentence or an event that
;;;; does nothing, a :NOTE may well be meant.  Whether something can ever happen is asked of the
;;;; theory without its narrative and its facts, with all events open that no axiom triggers.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (finding (:constructor make-finding (severity kind subject text &optional position))
                    (:copier nil))
  "Something that CHECK-THEORY found."
  (severity :note :type (member :error :warning :note) :read-only t)
  (kind nil :type keyword :read-only t)
  (subject nil :type keyword :read-only t)
  (text "" :type string :read-only t)
  (position nil :type (or null source:source-position) :read-only t))

(setf (documentation 'finding-severity 'function)
      "Return the severity of a finding: :ERROR, :WARNING or :NOTE."
      (documentation 'finding-kind 'function)
      "Return what a finding is about: :INCONSISTENT, :VACUOUS-AXIOM, :IMPOSSIBLE-EVENT,
:MISSING-EFFECT, :CONSTANT-FLUENT, :UNREAD-FLUENT, :UNCONSTRAINED-FLUENT or :EMPTY-COMPLETION."
      (documentation 'finding-subject 'function)
      "Return the name of the theory, axiom, event or fluent that a finding is about, a keyword."
      (documentation 'finding-text 'function)
      "Return the sentence of a finding."
      (documentation 'finding-position 'function)
      "Return the source position of the axiom that a finding is about, or NIL.")

(defmethod print-object ((finding finding) stream)
  (if *print-escape*
      (print-unreadable-object (finding stream :type t)
        (format stream "~(~a~): ~a" (finding-severity finding) (finding-text finding)))
      (format stream "~@[~a: ~]~(~a~): ~a"
              (finding-position finding) (finding-severity finding) (finding-text finding))))

(defun fact-clause-p (clause)
  "Return true if CLAUSE, (axiom kind condition head), is part of the narrative or a fact."
  (destructuring-bind (axiom kind condition head) clause
    (declare (ignore condition))
    (or (eq (axiom-label axiom) +facts+)
        (and (eq kind :sentence) (null (free-variables head))))))

(defun general-ground-theory (theory)
  "Return THEORY made ground without its facts and its narrative."
  (let ((ground (ground theory)))
    (setf (ground-theory-absolute-clauses ground)
          (remove-if #'fact-clause-p (ground-theory-absolute-clauses ground)))
    ground))

;;; What can ever be

(defun ever-p (reasoner form)
  "Return true if FORM, with its free variables read as `for some', can be true in REASONER."
  (let* ((variables (free-variables form))
         (formula (ground-formula (encoder-ground (reasoner-encoder reasoner))
                                  (if variables (list :exists variables form) form)
                                  :horizon (reasoner-horizon reasoner))))
    (and formula
         (eq (z3:check (reasoner-solver reasoner)
                       (list (formula-proposition reasoner formula)))
             :sat))))

(defun clause-premise (kind condition head)
  "Return what must be true for a clause to say anything, or NIL if it always does."
  (flet ((with-condition (form) (if (eq condition t) form (conjoin condition form))))
    (case kind
      (:effect (with-condition (list :happens (second head) (fourth head))))
      (:trajectory (if (eq condition t) nil condition))
      (:sentence (let ((form (strip-quantifiers head)))
                   (and (eq (first form) :implies) (not (static-form-p (second form)))
                        (second form)))))))

(defun vacuous-axioms (reasoner theory)
  (loop for axiom in (theory-axioms theory)
        nconc (loop for (kind condition head) in (axiom-clauses axiom theory)
                    for premise = (clause-premise kind condition head)
                    when (and premise (not (ever-p reasoner premise)))
                      collect (make-finding
                               :warning :vacuous-axiom (axiom-name axiom)
                               (format nil "axiom ~a never applies: ~a is never true"
                                       (name-text (axiom-name axiom)) (formula-text premise))
                               (axiom-position axiom)))))

(defun schematic-atom (declaration)
  "Return the atom of DECLARATION, (name sort*), with variables as arguments."
  (cons (first declaration)
        (loop for sort in (rest declaration)
              for number from 1
              collect (intern (format nil "?~a~d" (symbol-name sort) number) :keyword))))

(defun impossible-events (reasoner theory)
  (loop for declaration in (theory-events theory)
        unless (ever-p reasoner (list :happens (schematic-atom declaration) :?time))
          collect (make-finding :warning :impossible-event (first declaration)
                                (format nil "the event ~a can never happen"
                                        (name-text (first declaration))))))

(defun constant-fluents (reasoner theory)
  (loop for declaration in (theory-fluents theory)
        for atom = (schematic-atom declaration)
        unless (ever-p reasoner (list :not (list :iff (list :holds-at atom :?time)
                                                 (list :holds-at atom '(:+ :?time 1)))))
          collect (make-finding :note :constant-fluent (first declaration)
                                (format nil "the fluent ~a can never change"
                                        (name-text (first declaration))))))

;;; What axioms mention

(defun mentioned-p (name form)
  (cond ((consp form) (some (lambda (part) (mentioned-p name part)) form))
        (t (eq form name))))

(defun condition-forms (theory)
  "Return the formulas of THEORY in which fluents are read: all but the heads of effects and initial
conditions."
  (append (loop for axiom in (theory-axioms theory)
                unless (eq (axiom-label axiom) +facts+)
                  nconc (loop for (kind condition head) in (axiom-clauses axiom theory)
                              collect (case kind
                                        ((:effect) condition)
                                        (:trajectory (list condition (second head)))
                                        (:initially nil)
                                        (t (unless (fact-clause-p (list axiom kind condition head))
                                             head)))))
          (mapcar #'state-constraint-formula (theory-state-constraints theory))))

(defun unread-fluents (theory)
  (let ((forms (condition-forms theory)))
    (loop for (name) in (theory-fluents theory)
          unless (mentioned-p name forms)
            collect (make-finding :note :unread-fluent name
                                  (format nil "no axiom and no state constraint reads the fluent ~a"
                                          (name-text name))))))

(defun events-without-effect (theory)
  "Findings on events that neither have effects nor are a reason for anything else."
  (let ((forms (loop for axiom in (theory-axioms theory)
                     nconc (loop for (kind condition head) in (axiom-clauses axiom theory)
                                 collect (case kind
                                           (:effect (list condition (second head)))
                                           (:trajectory condition)
                                           (t (let ((form (strip-quantifiers head)))
                                                (and (eq (first form) :implies)
                                                     (makes-event-happen-p (third form))
                                                     (second form)))))))))
    (loop for (name) in (theory-events theory)
          unless (or (mentioned-p name forms) (mentions-event-variable-p theory forms))
            collect (make-finding :warning :missing-effect name
                                  (format nil "the event ~a changes nothing" (name-text name))))))

(defun empty-completions (theory)
  (loop for (label predicate) in (theory-completions theory)
        when (and label (notany (lambda (axiom) (eq (axiom-label axiom) label))
                                (theory-axioms theory)))
          collect (make-finding :note :empty-completion predicate
                                (format nil "no axiom has the label ~a, so ~a is never true"
                                        (name-text label) (name-text predicate)))))

(defun makes-event-happen-p (form)
  (mentioned-p :happens form))

(defun mentions-event-variable-p (theory forms)
  (cond ((consp forms) (some (lambda (form) (mentions-event-variable-p theory form)) forms))
        (t (and (variable-p forms) (eq (variable-sort theory forms) :event)))))

;;; The beginning

(defun unconstrained-fluents (theory horizon)
  "Findings on fluents that may be true or false at the first timepoint."
  (with-reasoner (reasoner theory :horizon horizon)
    (let* ((encoder (reasoner-encoder reasoner))
           (first (car (reasoner-horizon reasoner)))
           (variables (loop for number below (encoder-fluent-count encoder)
                            for variable = (encoder-variable
                                            encoder (atom-literal encoder :fluent number first) 0)
                            when (= 1 (sbit (reasoner-occurring reasoner) variable))
                              collect variable))
           (table (backbone reasoner variables))
           (open (and table
                      (loop for variable in variables
                            unless (gethash variable table)
                              collect (second (variable-atom reasoner variable))))))
      (loop for (name) in (theory-fluents theory)
            for atoms = (remove name open :key #'first :test-not #'eq)
            when atoms
              collect (make-finding
                       :note :unconstrained-fluent name
                       (format nil "~{~a~^, ~}~@[ and ~d more~] may be true or false at ~d"
                               (mapcar #'atom-text (subseq atoms 0 (min 3 (length atoms))))
                               (and (> (length atoms) 3) (- (length atoms) 3)) first))))))

(defun inconsistency (theory horizon)
  (let ((explanation (why-inconsistent theory :horizon horizon)))
    (list (make-finding :error :inconsistent (theory-name theory)
                        (format nil "the theory has no model: ~{~a~^, ~} contradict each other"
                                (mapcar #'name-text (explanation-axioms explanation)))))))

(defun check-theory (theory &key horizon)
  "Return the list of the FINDINGs about THEORY, a theory or its name: is it inconsistent, which
axioms never apply, which events can never happen or change nothing, which fluents never change, are
never read, or are open at first.  HORIZON is as for MAKE-REASONER; where the theory has none it is 3
timepoints.  Signals THEORY-NOT-FOUND, NO-HORIZON."
  (let* ((theory (as-theory theory))
         (horizon (check-horizon theory (or horizon (if (theory-time-range theory) nil 3))))
         (*horizon* horizon))
    (if (not (consistent-p theory :horizon horizon))
        (inconsistency theory horizon)
        (let ((ground (general-ground-theory theory)))
          (append
           (with-reasoner (reasoner theory :horizon horizon :ground ground
                                           :open-events (abducible-events theory ground))
             (append (vacuous-axioms reasoner theory)
                     (impossible-events reasoner theory)
                     (events-without-effect theory)
                     (constant-fluents reasoner theory)))
           (empty-completions theory)
           (unread-fluents theory)
           (unconstrained-fluents theory horizon))))))
