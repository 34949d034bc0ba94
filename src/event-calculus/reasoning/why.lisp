;;;; Why something must or cannot be so, in words.
;;;;
;;;; WHY and WHY-IMPOSSIBLE return an EXPLANATION: a minimal core, which names the axioms and their
;;;; instances, and sentences that derive the contradiction from it step by step, where such a
;;;; derivation needs no distinction of cases.  That a fluent persists over several timepoints is
;;;; one sentence, and that an event does not happen since nothing makes it happen is none.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (explanation (:constructor make-explanation (theory question core sentences))
                        (:copier nil))
  "Why FORMULA must or cannot be true: made by WHY and WHY-IMPOSSIBLE."
  (theory nil :type theory :read-only t)
  (question nil :type string :read-only t)
  (core '() :type list :read-only t)
  (sentences '() :type list :read-only t))

(setf (documentation 'explanation-core 'function)
      "Return the minimal set of instances that an explanation rests on: a list of (name instance).
NAME is that of an axiom, or :inertia, :release, :not-released, :begin, :stop, :completion or
:exclusion; INSTANCE a string."
      (documentation 'explanation-sentences 'function)
      "Return the list of the sentences, strings, that an explanation derives its claim by; NIL if
that takes a distinction of cases.")

(defmethod print-object ((explanation explanation) stream)
  (print-unreadable-object (explanation stream :type t)
    (format stream "~a: ~d instance~:p" (explanation-question explanation)
            (length (explanation-core explanation)))))

(defun explanation-axioms (explanation)
  "Return the list of the names of the theory's axioms that EXPLANATION rests on."
  (remove-duplicates
   (loop for (name) in (explanation-core explanation)
         unless (member name '(:inertia :numeric-inertia :release :not-released :begin :stop :completion :exclusion))
           collect name)
   :from-end t))

;;; Texts

(defun time-words (atom)
  "Return the text of the ground ATOM and that of its timepoint, or NIL."
  (case (first atom)
    ((:holds-at :happens :released-at)
     (values (atom-text (second atom)) (third atom)))
    (t (values (atom-text atom) nil))))

(defun literal-words (atom positive)
  "Return a clause of English that ATOM is true, or false."
  (multiple-value-bind (text time) (time-words atom)
    (atom-words (first atom) positive text time)))

(defun atom-words (kind positive text time)
  (case kind
    (:holds-at (format nil "~a is ~:[false~;true~] at ~d" text positive time))
    (:happens (format nil "~a ~:[does not happen~;happens~] at ~d" text positive time))
    (:released-at (format nil "~a is ~:[not ~;~]released at ~d" text positive time))
    (t (format nil "~a is ~:[false~;true~]" text positive))))

(defun ground-formula-text (encoder formula shift)
  "Return the text of the ground FORMULA, moved by SHIFT timepoints, as a formula."
  (labels ((form (formula)
             (cond ((eq formula t) '(:and))
                   ((null formula) '(:or))
                   ((member (first formula) '(:and :not :iff))
                    (cons (first formula) (mapcar #'form (rest formula))))
                   ((eq (first formula) :or) (implication (rest formula)))
                   ((eq (first formula) :compare)
                    (cons (second formula) (mapcar #'number-form (cddr formula))))
                   (t (let ((code (atom-literal encoder (first formula) (second formula)
                                                (if (eq (first formula) :static)
                                                    0
                                                    (+ shift (third formula))))))
                        (if (integerp code)
                            (atom-of-code encoder code 0)
                            (if code '(:and) '(:or)))))))
           (number-form (term)
             (cond ((rationalp term) term)
                   ((eq (first term) :value)
                    (list :value-at
                          (svref (ground-theory-numerics (encoder-ground encoder)) (second term))
                          (+ shift (third term))))
                   (t (cons (first term) (mapcar #'number-form (rest term))))))
           (implication (parts)
             (let* ((negative (remove-if-not (lambda (part)
                                               (and (consp part) (eq (first part) :not)))
                                             parts))
                    (positive (set-difference parts negative))
                    (premises (mapcar (lambda (part) (form (second part))) negative))
                    (conclusions (mapcar #'form positive)))
               (flet ((join (operator forms)
                        (if (rest forms) (cons operator forms) (first forms))))
                 (cond ((null negative) (cons :or conclusions))
                       ((null positive) (list :not (join :and premises)))
                       (t (list :implies (join :and premises) (join :or conclusions))))))))
    (formula-text (form formula))))

(defun bindings-text (bindings time)
  (format nil "~{~a = ~a~^, ~}"
          (append (loop for (variable . value) in bindings
                        append (list (name-text variable) (term-text value)))
                  (and time (list "?time" time)))))

(defun effect-words (effect time ground)
  (let ((event (atom-text (svref (ground-theory-events ground) (effect-event effect))))
        (fluent (atom-text (svref (if (member effect
                                              (svref (ground-theory-effects ground)
                                                     (effect-event effect)))
                                      (ground-theory-fluents ground)
                                      (ground-theory-numerics ground))
                                  (effect-fluent effect)))))
    (format nil "~a ~(~a~) ~a at ~d" event (effect-kind effect) fluent
            (or (effect-time effect) time))))

(defun reason-axiom (reason)
  "Return the axiom of REASON, or NIL if it is an instance of a schema of the calculus."
  (let ((thing (source-thing (ground-reason-source reason))))
    (typecase thing
      (sentence (let ((axiom (sentence-axiom thing))) (and (axiom-p axiom) axiom)))
      (effect (effect-axiom thing))
      (gradual-change (gradual-change-axiom thing)))))

(defun reason-entry (reasoner reason)
  "Return (name instance) for the core of an explanation."
  (let* ((encoder (reasoner-encoder reasoner))
         (ground (encoder-ground encoder))
         (source (ground-reason-source reason))
         (thing (source-thing source))
         (time (ground-reason-time reason))
         (axiom (reason-axiom reason)))
    (flet ((fluent (number) (atom-text (svref (ground-theory-fluents ground) number))))
      (list
       (if axiom (axiom-name axiom) (source-kind source))
       (ecase (source-kind source)
         ((:sentence :initially)
          (format nil "~a~@[, for ~a~]"
                  (ground-formula-text encoder (sentence-formula thing)
                                       (if (eq (source-kind source) :initially)
                                           (car (reasoner-horizon reasoner))
                                           time))
                  (and (sentence-bindings thing)
                       (bindings-text (sentence-bindings thing)
                                      (if (sentence-absolute thing) nil time)))))
         (:effect (effect-words thing time ground))
         (:trajectory
          (format nil "the ~(~a~) of ~a makes ~a true at ~d" (gradual-change-kind thing)
                  (fluent (gradual-change-cause thing))
                  (if (gradual-change-term thing)
                      (atom-text (svref (ground-theory-numerics ground)
                                        (gradual-change-fluent thing)))
                      (fluent (gradual-change-fluent thing)))
                  (+ (or (gradual-change-time thing) time) (gradual-change-offset thing))))
         (:begin (format nil "~a may begin at ~d" (fluent thing) time))
         (:stop (format nil "~a lasts from ~d until an event ends it" (fluent thing) time))
         (:inertia (format nil "~a persists from ~d to ~d unless an event changes it"
                           (fluent thing) time (1+ time)))
         (:release (format nil "~a stays released, or not, from ~d to ~d unless an event changes ~
                                that" (fluent thing) time (1+ time)))
         (:numeric-inertia
          (format nil "~a keeps its value from ~d to ~d unless an event changes it"
                  (atom-text (svref (ground-theory-numerics ground) thing)) time (1+ time)))
         (:not-released (format nil "~a is not released at first" (fluent thing)))
         (:completion
          (destructuring-bind (kind number &optional dated) thing
            (let ((code (atom-literal encoder kind number (or dated time))))
              (format nil "~a only if an axiom makes it so"
                      (formula-text (atom-of-code encoder code 0))))))
         (:exclusion (format nil "at most one of ~:[~{~a~^, ~}~;the events~*~] at ~d" (eq thing t)
                             (if (listp thing) (mapcar #'name-text thing) '()) time)))))))

;;; Sentences

(defun derivation-because (reasoner derivation table)
  "Return the text after `because' for DERIVATION.  TABLE has the derivation of each literal."
  (let* ((reason (derivation-reason derivation))
         (source (ground-reason-source reason))
         (thing (source-thing source))
         (axiom (reason-axiom reason))
         (ground (encoder-ground (reasoner-encoder reasoner)))
         (premises (visible-premises reasoner derivation table)))
    (flet ((premise-words ()
             (format nil "~{~a~^ and ~}" premises)))
      (case (source-kind source)
        (:effect
         (let ((others (remove (effect-event-words reasoner reason) premises :test #'equal)))
           (if (effect-itself-p reasoner derivation)
               (format nil "~a (axiom ~a)~@[ where ~{~a~^ and ~}~]"
                       (effect-words thing (ground-reason-time reason) ground)
                       (name-text (axiom-name axiom)) others)
               (format nil "otherwise ~a (axiom ~a)~@[, and ~{~a~^ and ~}~]"
                       (effect-words thing (ground-reason-time reason) ground)
                       (name-text (axiom-name axiom)) premises))))
        (:inertia (format nil "~:[~;~:*~a, and ~]nothing changes it" (first premises)))
        (:not-released "nothing has released it")
        (:completion (format nil "no axiom makes it so~@[, since ~a~]"
                             (and premises (premise-words))))
        (:exclusion (format nil "~a, and only one of them can" (premise-words)))
        (t (format nil "~:[of ~;~:*~a (~]axiom ~a~2:*~:[~;)~]"
                   (and premises (premise-words))
                   (if axiom (name-text (axiom-name axiom)) (name-text (source-kind source)))))))))

(defun effect-event-words (reasoner reason)
  (let ((effect (source-thing (ground-reason-source reason))))
    (literal-words (list :happens
                         (svref (ground-theory-events
                                 (encoder-ground (reasoner-encoder reasoner)))
                                (effect-event effect))
                         (or (effect-time effect) (ground-reason-time reason)))
                   t)))

(defun visible-premises (reasoner derivation table)
  "Return the words for the premises of DERIVATION, those of auxiliary atoms in their place."
  (let ((words '()) (seen '()))
    (labels ((collect (literal)
               (unless (member literal seen)
                 (push literal seen)
                 (let ((atom (variable-atom reasoner (abs literal))))
                   (cond ((null atom)
                          (let ((other (gethash literal table)))
                            (when other (mapc #'collect (derivation-premises other)))))
                         ((silent-p reasoner literal table))
                         (t (pushnew (literal-words atom (plusp literal)) words
                                     :test #'equal)))))))
      (mapc #'collect (derivation-premises derivation)))
    (nreverse words)))

(defun silent-p (reasoner literal table)
  "Return true if LITERAL goes without saying: nothing makes an event happen or releases a fluent."
  (let ((derivation (gethash literal table)))
    (and derivation (minusp literal)
         (or (eq (source-kind (ground-reason-source (derivation-reason derivation))) :not-released)
             (member (first (variable-atom reasoner (- literal))) '(:released-at))
             (and (eq (source-kind (ground-reason-source (derivation-reason derivation)))
                      :completion)
                  (null (visible-premises reasoner derivation table)))))))

(defun inertia-step-p (reasoner derivation)
  "Return the premise of DERIVATION if it is the same fluent one timepoint earlier or later."
  (and (derivation-literal derivation)
       (eq (source-kind (ground-reason-source (derivation-reason derivation))) :inertia)
       (let ((atom (variable-atom reasoner (abs (derivation-literal derivation)))))
         (find-if (lambda (premise)
                    (let ((other (variable-atom reasoner (abs premise))))
                      (and (eq (first atom) :holds-at) (eq (first other) :holds-at)
                           (equal (second atom) (second other))
                           (eq (plusp premise) (plusp (derivation-literal derivation))))))
                  (derivation-premises derivation)))))

(defun derivation-sentences (reasoner derivations)
  "Return the sentences for DERIVATIONS, which end in a contradiction."
  (let ((table (make-hash-table)) (merged (make-hash-table)) (sentences '()))
    (dolist (derivation derivations)
      (when (derivation-literal derivation)
        (setf (gethash (derivation-literal derivation) table) derivation)))
    ;; What only passes on the value of a fluent by inertia is merged into what comes next.
    (dolist (derivation derivations)
      (let ((premise (inertia-step-p reasoner derivation)))
        (when premise
          (setf (gethash premise merged) t))))
    (dolist (derivation derivations (nreverse sentences))
      (let ((sentence (derivation-sentence reasoner derivation table merged
                                           (eq derivation (first (last derivations))))))
        (when sentence (push sentence sentences))))))

(defun derivation-origin (reasoner derivation table)
  "Return the derivation from which that of a fluent follows by inertia alone."
  (loop for premise = (inertia-step-p reasoner derivation)
        for earlier = (and premise (gethash premise table))
        while earlier do (setf derivation earlier)
        finally (return derivation)))

(defun derivation-sentence (reasoner derivation table merged claim)
  "Return the sentence for DERIVATION, or NIL if it needs none; CLAIM is true of the last one."
  (let ((literal (derivation-literal derivation)))
    (cond ((null literal)
           (let ((premises (visible-premises reasoner derivation table)))
             (format nil "~:[This~;But ~:*~{~a~^ and ~}: this~] contradicts ~a."
                     premises (contradiction-words reasoner derivation))))
          ((or (null (variable-atom reasoner (abs literal)))
               (and (silent-p reasoner literal table) (not claim))
               (assumption-p derivation)
               (and (gethash literal merged) (inertia-step-p reasoner derivation)))
           nil)
          (t (let* ((origin (derivation-origin reasoner derivation table))
                    (persists (not (eq origin derivation)))
                    (atom (variable-atom reasoner (abs literal))))
               (unless (and (gethash literal merged) (not persists))
                 (format nil "~a because ~a~:[~; and nothing ~:[initiates~;terminates~] it~]."
                         (literal-words atom (plusp literal))
                         (if (assumption-p origin)
                             (literal-words (variable-atom reasoner
                                                           (abs (derivation-literal origin)))
                                            (plusp literal))
                             (derivation-because reasoner origin table))
                         (or persists (effect-itself-p reasoner derivation)) (plusp literal))))))))

(defun effect-itself-p (reasoner derivation)
  "Return true if DERIVATION derives the effect from the event, and not the other way round."
  (let ((effect (source-thing (ground-reason-source (derivation-reason derivation))))
        (literal (derivation-literal derivation)))
    (and (effect-p effect)
         literal
         (let ((atom (variable-atom reasoner (abs literal))))
           (and (eq (first atom) :holds-at)
                (equal (second atom)
                       (svref (ground-theory-fluents (encoder-ground (reasoner-encoder reasoner)))
                              (effect-fluent effect)))
                (= (third atom) (1+ (or (effect-time effect)
                                        (ground-reason-time
                                         (derivation-reason derivation))))))))))

(defun assumption-p (derivation)
  (assumed-reason-p (derivation-reason derivation)))

(defun contradiction-words (reasoner derivation)
  (let* ((reason (derivation-reason derivation)) (axiom (reason-axiom reason)))
    (cond ((assumption-p derivation) "what was asked")
          (axiom (format nil "axiom ~a" (name-text (axiom-name axiom))))
          (t (second (reason-entry reasoner reason))))))

;;; Entry points

(defun question-literal (reasoner form)
  "Return the propositional literal of the formula FORM, with timepoints by number, or NIL if it is
none."
  (let* ((formula (ground-formula (encoder-ground (reasoner-encoder reasoner)) form
                                  :horizon (reasoner-horizon reasoner)))
         (negative (and (consp formula) (eq (first formula) :not)))
         (atom (if negative (second formula) formula)))
    (when (and (consp atom) (not (member (first atom) '(:and :or :not :iff :compare))))
      (let ((code (atom-literal (reasoner-encoder reasoner) (first atom) (second atom)
                                (or (third atom) 0))))
        (when (integerp code)
          (* (if negative -1 1) (encoder-variable (reasoner-encoder reasoner) code 0)))))))

(defun assumed-reason-p (reason)
  (let ((axiom (reason-axiom reason)))
    (and axiom (eq (axiom-name axiom) :assumption))))

(defun direct-derivations (reasoner core claim)
  "Return the derivations of the formula CLAIM from CORE without the assumption, or NIL."
  (let ((goal (and claim (question-literal reasoner claim))))
    (and goal
         (let ((derivations (unit-derivations (remove-if #'assumed-reason-p core) goal)))
           (and derivations
                (eql goal (derivation-literal (first (last derivations))))
                derivations)))))

(defun explain (theory question assumption claim horizon)
  "Return the explanation why the formula ASSUMPTION is impossible, by deriving CLAIM, if any."
  (let* ((as-reasoner (reasoner-p theory))
         (horizon (or horizon (and as-reasoner (reasoner-horizon theory)))))
    (with-reasoner (reasoner (as-theory theory) :horizon horizon :tracked t
                                                :assumptions (list assumption))
      (let ((core (minimal-core reasoner)))
        (when core
          (make-explanation
           (reasoner-theory reasoner) question
           (loop for reason in core
                 unless (assumed-reason-p reason) collect (reason-entry reasoner reason))
           (derivation-sentences reasoner
                                 (or (direct-derivations reasoner core claim)
                                     (unit-derivations core)))))))))

(defun as-theory (theory)
  (cond ((theory-p theory) theory)
        ((reasoner-p theory) (reasoner-theory theory))
        (t (find-theory theory))))

(defun question-form (theory formula)
  (parse-formula formula (as-theory theory) :kind :query :blame "the question"))

(defun why-impossible (theory formula &key horizon)
  "Return an EXPLANATION why FORMULA, with timepoints by number, is true in no model of THEORY, or
NIL if it is in one.  The arguments are those of POSSIBLE-P."
  (let ((form (question-form theory formula)))
    (explain theory (format nil "~a is impossible" (formula-text form)) form (negated-form form)
             horizon)))

(defun negated-form (form)
  (if (eq (first form) :not) (second form) (list :not form)))

(defun why (theory formula &key horizon)
  "Return an EXPLANATION why FORMULA, with timepoints by number, is true in all models of THEORY, or
NIL if it is not.  The arguments are those of POSSIBLE-P."
  (let ((form (question-form theory formula)))
    (explain theory (format nil "~a is true" (formula-text form)) (negated-form form) form
             horizon)))

(defun why-inconsistent (theory &key horizon)
  "Return an EXPLANATION why THEORY has no model, or NIL if it has one.  The arguments are those of
POSSIBLE-P."
  (explain theory (format nil "theory ~a is inconsistent" (name-text (theory-name
                                                                      (as-theory theory))))
           '(:and) nil horizon))

(defmethod describe-object ((explanation explanation) stream)
  (format stream "~&~a~:[, which only a distinction of cases shows~;~].~%"
          (explanation-question explanation) (explanation-sentences explanation))
  (format stream "~{  ~a~%~}" (explanation-sentences explanation))
  (format stream "It rests on~%")
  (loop for (name instance) in (explanation-core explanation)
        do (format stream "  ~a: ~a~%" (name-text name) instance)))
