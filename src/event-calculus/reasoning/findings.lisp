;;;; What a theory's author may want to know: CHECK-THEORY.
;;;;
;;;; A FINDING has a severity: an :ERROR leaves no model, a :WARNING is a sentence or an event that
;;;; does nothing, a :NOTE may well be meant.  Whether something can ever happen is asked of the
;;;; theory without its narrative and its facts, with all events open that no axiom triggers, and,
;;;; as it may need the narrative, of the theory as it is.

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
      "Return what a finding is about: :INCONSISTENT, :BEYOND-HORIZON, :VACUOUS-AXIOM,
:IMPOSSIBLE-EVENT, :MISSING-EFFECT, :CONSTANT-FLUENT, :EMPTY-COMPLETION, :EMPTY-SORT,
:MISSING-VALUE, :UNREAD-FLUENT or :UNCONSTRAINED-FLUENT."
      (documentation 'finding-subject 'function)
      "Return the name of the theory, axiom, event, fluent, sort or function that a finding is
about, a keyword."
      (documentation 'finding-text 'function)
      "Return the sentence of a finding."
      (documentation 'finding-position 'function)
      "Return the source position of the axiom or declaration that a finding is about, or NIL.")

(defmethod print-object ((finding finding) stream)
  (if *print-escape*
      (print-unreadable-object (finding stream :type t)
        (format stream "~(~a~): ~a" (finding-severity finding) (finding-text finding)))
      (format stream "~@[~a: ~]~(~a~): ~a"
              (finding-position finding) (finding-severity finding) (finding-text finding))))

(defun fact-clause-p (clause)
  "Return true if CLAUSE, (axiom kind condition head), is part of the narrative or a fact."
  (destructuring-bind (axiom kind condition head &rest heads) clause
    (declare (ignore condition heads))
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

(defun never-p (reasoners form)
  "Return true if FORM can be true in none of REASONERS."
  (notany (lambda (reasoner) (ever-p reasoner form)) reasoners))

(defun horizon-text ()
  "Return \"within the timepoints 0 to 3\", for the horizon in question."
  (format nil "within the timepoints ~d to ~d" (car *horizon*) (cdr *horizon*)))

(defun clause-premise (kind condition head)
  "Return what must be true for a clause to say anything, or NIL if it always does."
  (flet ((with-condition (form) (if (eq condition t) form (conjoin condition form))))
    (case kind
      (:effect (with-condition (list :happens (second head) (first (last head)))))
      (:trajectory (if (eq condition t) nil condition))
      (:sentence (let ((form (strip-quantifiers head)))
                   (and (eq (first form) :implies) (not (static-form-p (second form)))
                        (second form)))))))

(defun time-beyond-horizon (theory axiom)
  "Return a timepoint outside of the horizon that AXIOM gives by number, or NIL."
  (map-question-times (lambda (time event)
                        (unless (<= (car *horizon*) time
                                    (if event (1- (cdr *horizon*)) (cdr *horizon*)))
                          (return-from time-beyond-horizon time)))
                      theory (axiom-formula axiom))
  nil)

(defun axioms-beyond-horizon (theory)
  (loop for axiom in (theory-axioms theory)
        for time = (time-beyond-horizon theory axiom)
        when time
          collect (make-finding :warning :beyond-horizon (axiom-name axiom)
                                (format nil "axiom ~a says nothing ~a: it is about ~d"
                                        (name-text (axiom-name axiom)) (horizon-text) time)
                                (axiom-position axiom))))

(defun instantiated-p (reasoners axiom)
  "Return true if AXIOM has an instance for one of REASONERS."
  (some (lambda (reasoner)
          (let ((ground (encoder-ground (reasoner-encoder reasoner))))
            (or (eq axiom (ground-theory-one-event-at-a-time ground))
                (gethash axiom (ground-theory-instantiated ground)))))
        reasoners))

(defun axioms-without-instances (reasoners theory)
  (loop for axiom in (theory-axioms theory)
        unless (or (time-beyond-horizon theory axiom) (instantiated-p reasoners axiom))
          collect (make-finding
                   :warning :no-instance (axiom-name axiom)
                   (format nil "axiom ~a says nothing: each instance has an argument outside of ~
                                its sort, a time outside of the horizon, or a function without ~
                                a value" (name-text (axiom-name axiom)))
                   (axiom-position axiom))))

(defun vacuous-axioms (reasoners theory)
  (loop for axiom in (theory-axioms theory)
        when (and (not (time-beyond-horizon theory axiom)) (instantiated-p reasoners axiom))
          nconc (loop for (kind condition head) in (axiom-clauses axiom theory)
                      for premise = (clause-premise kind condition head)
                      when (and premise (never-p reasoners premise))
                        collect (make-finding
                                 :warning :vacuous-axiom (axiom-name axiom)
                                 (format nil "axiom ~a never applies: ~a is never true ~a"
                                         (name-text (axiom-name axiom)) (formula-text premise)
                                         (horizon-text))
                                 (axiom-position axiom)))))

(defun schematic-atom (declaration)
  "Return the atom of DECLARATION, (name sort*), with variables as arguments."
  (cons (first declaration)
        (loop for sort in (rest declaration)
              for number from 1
              collect (intern (format nil "?~a~d" (symbol-name sort) number) :keyword))))

(defun declaration-finding (severity kind declaration control &rest arguments)
  "Return a finding about what DECLARATION, (name sort*), declares."
  (make-finding severity kind (first declaration) (apply #'format nil control arguments)
                (place-of declaration)))

(defun impossible-events (reasoners theory)
  (loop for declaration in (theory-events theory)
        when (never-p reasoners (list :happens (schematic-atom declaration) :?time))
          collect (declaration-finding :warning :impossible-event declaration
                                       "the event ~a can never happen ~a"
                                       (name-text (first declaration)) (horizon-text))))

(defun constant-fluents (reasoners theory)
  (loop for declaration in (theory-fluents theory)
        for atom = (schematic-atom declaration)
        when (never-p reasoners (list :not (list :iff (list :holds-at atom :?time)
                                                 (list :holds-at atom '(:+ :?time 1)))))
          collect (declaration-finding :note :constant-fluent declaration
                                       "the fluent ~a can never change ~a"
                                       (name-text (first declaration)) (horizon-text))))

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
                                        (:effect (list condition
                                                       (and (eq (first head) :assigns)
                                                            (fourth head))))
                                        (:trajectory
                                         (list condition (second head)
                                               (and (numeric-trajectory-p theory head)
                                                    (third (fourth head)))))
                                        (:initially nil)
                                        (t (unless (fact-clause-p (list axiom kind condition head))
                                             head)))))
          (mapcar #'state-constraint-formula (theory-state-constraints theory))))

(defun unread-fluents (theory)
  (let ((forms (condition-forms theory)))
    (loop for declaration in (append (theory-fluents theory) (theory-numeric-fluents theory))
          for name = (first declaration)
          unless (mentioned-p name forms)
            collect (declaration-finding :note :unread-fluent declaration
                                         "no axiom and no state constraint reads the fluent ~a"
                                         (name-text name)))))

(defun numbers-never-set (theory)
  "Findings on numeric fluents that no axiom changes."
  (let ((forms (loop for axiom in (theory-axioms theory)
                     nconc (loop for (kind nil head) in (axiom-clauses axiom theory)
                                 collect (case kind
                                           (:effect (third head))
                                           (:trajectory (fourth head)))))))
    (loop for declaration in (theory-numeric-fluents theory)
          unless (mentioned-p (first declaration) forms)
            collect (declaration-finding :note :constant-fluent declaration
                                         "nothing changes the numeric fluent ~a"
                                         (name-text (first declaration))))))

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
    (loop for declaration in (theory-events theory)
          for name = (first declaration)
          unless (or (mentioned-p name forms) (mentions-event-variable-p theory forms))
            collect (declaration-finding :warning :missing-effect declaration
                                         "the event ~a changes nothing" (name-text name)))))

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

;;; What declarations leave empty

(defun empty-sorts (theory)
  (loop for sort in (theory-sorts theory)
        for name = (sort-name sort)
        when (zerop (sort-size theory name))
          collect (make-finding :warning :empty-sort name
                                (format nil "the sort ~a has no elements" (name-text name))
                                (place-of sort))))

(defun some-text (atoms)
  "Return the text of the first of ATOMS and the number of the others."
  (format nil "~{~a~^, ~}~@[ and ~d more~]"
          (mapcar #'atom-text (subseq atoms 0 (min 3 (length atoms))))
          (and (> (length atoms) 3) (- (length atoms) 3))))

(defun functions-without-values (ground theory)
  (loop for (declaration) in (theory-functions theory)
        for instances = (reduce #'* (rest declaration)
                                :key (lambda (sort) (sort-size theory sort)))
        for (missing number) = (and (<= instances +most-instances+)
                                    (multiple-value-list (missing-values ground declaration)))
        when missing
          collect (declaration-finding (if (= (length missing) number) :warning :note)
                                       :missing-value declaration "no axiom gives ~a a value"
                                       (some-text missing))))

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
      (append
       ;; What is not inertial is open whenever no axiom says what it is.
       (loop for declaration in (theory-fluents theory)
             for name = (first declaration)
             for atoms = (and (not (member name (theory-non-inertial theory)))
                              (remove name open :key #'first :test-not #'eq))
             when atoms
               collect (declaration-finding :note :unconstrained-fluent declaration
                                            "~a may be true or false at ~d" (some-text atoms)
                                            first))
       (unconstrained-numbers reasoner theory)))))

(defun open-number-p (reasoner model atom time)
  "Return true if the value that the numeric fluent ATOM has in MODEL at TIME may be another one."
  (let ((value (model-number model atom time)))
    (or (null value)
        (and (rationalp value)
             (possible-p reasoner (list :/= (list :value-at atom time) value))))))

(defun unconstrained-numbers (reasoner theory)
  "Findings on numeric fluents that may have any of several values at the first timepoint."
  (let ((first (car (reasoner-horizon reasoner)))
        (model (and (theory-numeric-fluents theory) (first (models reasoner :limit 1)))))
    (when model
      (loop for declaration in (theory-numeric-fluents theory)
            for atoms = (remove-if-not (lambda (atom) (open-number-p reasoner model atom first))
                                       (ground-terms theory (first declaration)
                                                     (rest declaration)))
            when atoms
              collect (declaration-finding :note :unconstrained-fluent declaration
                                           "~a may have several values at ~d" (some-text atoms)
                                           first)))))

(defun names-text (names)
  "Return the text of the list NAMES, as in: a, b and c."
  (format nil "~{~#[~;~a~;~a and ~a~:;~@{~a~#[~; and ~:;, ~]~}~]~}" (mapcar #'name-text names)))

(defun inconsistency (theory horizon)
  (let* ((names (explanation-axioms (why-inconsistent theory :horizon horizon)))
         (axioms (remove-if-not (lambda (axiom) (member (axiom-name axiom) names))
                                (theory-axioms theory))))
    (list (make-finding :error :inconsistent (theory-name theory)
                        (format nil "the theory has no model~[~;: axiom ~a contradicts ~
                                     itself~:;: axioms ~a contradict each other~]"
                                (length names) (names-text names))
                        (some #'axiom-position axioms)))))

(defun default-horizon (theory)
  "Return the last timepoint for a theory that has no range of them: 3, or what its axioms need."
  (let ((last 3))
    (dolist (axiom (theory-axioms theory) last)
      (map-question-times (lambda (time event)
                            (setf last (max last (if event (1+ time) time))))
                          theory (axiom-formula axiom)))))

(defun findings-within (theory horizon)
  "Return the list of the FINDINGs about THEORY within HORIZON, (first . last)."
  (let ((*horizon* horizon)
        (*exact-names* (eq (theory-syntax theory) :e)))
    (if (not (consistent-p theory :horizon horizon))
        (inconsistency theory horizon)
        (let ((ground (general-ground-theory theory)))
          (append
           (axioms-beyond-horizon theory)
           (with-reasoner (general theory :horizon horizon :ground ground
                                          :open-events (abducible-events theory ground))
             (with-reasoner (reasoner theory :horizon horizon)
               (let ((reasoners (list general reasoner)))
                 (append (axioms-without-instances reasoners theory)
                         (vacuous-axioms reasoners theory)
                         (impossible-events reasoners theory)
                         (events-without-effect theory)
                         (constant-fluents reasoners theory)))))
           (numbers-never-set theory)
           (empty-completions theory)
           (empty-sorts theory)
           (functions-without-values ground theory)
           (unread-fluents theory)
           (unconstrained-fluents theory horizon))))))

(defun check-theory (theory &key horizon)
  "Return the list of the FINDINGs about THEORY, a theory or its name: is it inconsistent, which
axioms have no instance or never apply, which events can never happen or change nothing, which
fluents never change, are never read, or are open at first, which sorts have no elements and which
functions no values.
HORIZON is as for MAKE-REASONER; where the theory has none the last timepoint is 3, or the last that
an axiom gives by number, and five more where there are warnings of which less is left then.
Signals THEORY-NOT-FOUND, NO-HORIZON."
  (let ((theory (as-theory theory)))
    (if (or horizon (theory-time-range theory))
        (findings-within theory (check-horizon theory horizon))
        (let* ((horizon (check-horizon theory (default-horizon theory)))
               (findings (findings-within theory horizon))
               ;; An event may need more preparation than there was time for.
               (later (if (find :warning findings :key #'finding-severity)
                          (findings-within theory (cons (car horizon) (+ 5 (cdr horizon))))
                          findings)))
          (if (< (length later) (length findings)) later findings)))))
