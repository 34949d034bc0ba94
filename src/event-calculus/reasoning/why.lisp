;;;; Why something must or cannot be so, in words.
;;;;
;;;; WHY and WHY-IMPOSSIBLE return an EXPLANATION: a minimal core, which names the axioms and their
;;;; instances, and sentences that derive the contradiction from it step by step, where such a
;;;; derivation needs no distinction of cases.  That a fluent persists over several timepoints is
;;;; one sentence, and that an event does not happen since nothing makes it happen is none.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (explanation (:constructor make-explanation (theory question core sentences axioms
                                                               persistent))
                        (:copier nil))
  "Why FORMULA must or cannot be true: made by WHY and WHY-IMPOSSIBLE."
  (theory nil :type theory :read-only t)
  (question nil :type string :read-only t)
  (core '() :type list :read-only t)
  (sentences '() :type list :read-only t)
  (axioms '() :type list :read-only t)
  (persistent '() :type list :read-only t))

(setf (documentation 'explanation-core 'function)
      "Return the minimal set of instances that an explanation rests on: a list of (name instance).
NAME is that of an axiom, or :inertia, :release, :not-released, :begin, :stop, :completion,
:exclusion or :exactly-one; INSTANCE a string."
      (documentation 'explanation-sentences 'function)
      "Return the list of the sentences, strings, that an explanation derives its claim by; NIL if
that takes a distinction of cases.")

(setf (documentation 'explanation-axioms 'function)
      "Return the list of the names of the theory's axioms that an explanation rests on."
      (documentation 'explanation-persistent 'function)
      "Return the list of the (fluent timepoint) that an explanation takes to persist, by inertia,
to the next timepoint.")

(defmethod print-object ((explanation explanation) stream)
  (print-unreadable-object (explanation stream :type t)
    (format stream "~a: ~d instance~:p" (explanation-question explanation)
            (length (explanation-core explanation)))))

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

(defun direct-derivations (reasoner core claim)
  "Return the derivations of the formula CLAIM from CORE without the assumption, or NIL."
  (let ((goal (and claim (question-literal reasoner claim))))
    (and goal
         (let ((derivations (unit-derivations (remove-if #'assumed-reason-p core) goal)))
           (and derivations
                (eql goal (derivation-literal (first (last derivations))))
                derivations)))))

(defun explanation-sentences-of (reasoner core claim supposition conclusion)
  "Return the sentences for CORE: a derivation of the formula CLAIM, or from SUPPOSITION, a
sentence, to a contradiction, after which comes CONCLUSION."
  (let ((direct (direct-derivations reasoner core claim)))
    (if direct
        (narrate reasoner direct)
        (let* ((derivations (unit-derivations core))
               (last (first (last derivations)))
               (assumed (find-if #'assumed-reason-p core)))
          (cond ((null derivations) '())
                ((null assumed) (narrate reasoner derivations :consistent nil))
                ((assumed-reason-p (derivation-reason last))
                 (append (narrate reasoner (butlast derivations)) (list conclusion)))
                (t (cons supposition (narrate reasoner derivations :consistent nil))))))))

(defun definition-entries (reason)
  "Return the entries for the effect axioms to which conditions in REASON refer."
  (let ((thing (source-thing (ground-reason-source reason))))
    (when (sentence-p thing)
      (loop for axiom in (sentence-definitions thing)
            collect (list (axiom-name axiom)
                          (format nil "an effect to which ~a refers"
                                  (axiom-words (sentence-axiom thing))))))))

(defun core-axioms (core)
  "Return the names of the axioms of the reasons CORE, and of the effects to which they refer."
  (remove-duplicates
   (loop for reason in core
         for axiom = (reason-axiom reason)
         for thing = (source-thing (ground-reason-source reason))
         unless (assumed-reason-p reason)
           append (append (and axiom (list (axiom-name axiom)))
                          (and (sentence-p thing)
                               (mapcar #'axiom-name (sentence-definitions thing)))))
   :from-end t))

(defun persistent-fluents (reasoner core)
  "Return a list of (fluent time) for the instances of inertia among the reasons CORE."
  (let ((fluents (ground-theory-fluents (encoder-ground (reasoner-encoder reasoner)))))
    (loop for reason in core
          for source = (ground-reason-source reason)
          when (eq (source-kind source) :inertia)
            collect (list (svref fluents (source-thing source)) (ground-reason-time reason)))))

(defun explain (theory question assumption claim supposition horizon)
  "Return the explanation why the formula ASSUMPTION is impossible, by deriving CLAIM, if any."
  (let ((horizon (check-horizon (as-theory theory)
                                (or horizon
                                    (and (reasoner-p theory) (reasoner-horizon theory))))))
    (check-question-times (as-theory theory) assumption horizon)
    (with-reasoner (reasoner (as-theory theory) :horizon horizon :tracked t
                                                :assumptions (list assumption))
      (let ((core (minimal-core reasoner)))
        (when core
          (make-explanation
           (reasoner-theory reasoner) question
           (remove-duplicates (loop for reason in core
                                    unless (assumed-reason-p reason)
                                      collect (reason-entry reasoner reason)
                                    append (definition-entries reason))
                              :test #'equal :from-end t)
           (explanation-sentences-of reasoner core claim supposition
                                     (format nil "So ~a." question))
           (core-axioms core)
           (persistent-fluents reasoner core)))))))

(defun as-theory (theory)
  (check-type theory (or theory reasoner symbol))
  (cond ((theory-p theory) theory)
        ((reasoner-p theory) (reasoner-theory theory))
        (t (find-theory theory))))

(defun question-form (theory formula)
  (parse-formula formula (as-theory theory) :kind :query :blame "the question"))

(defun negated-form (form)
  (if (eq (first form) :not) (second form) (list :not form)))

(defun form-words (form truth)
  "Return the words that FORM, a checked formula, is true, or false, or impossible."
  (let ((atom (if (eq (first form) :not) (second form) form)))
    (if (and (member (first atom) '(:holds-at :happens :released-at)) (not (eq truth :impossible))
             (integerp (third atom)))
        (literal-words atom (if (eq truth :true) (eq atom form) (not (eq atom form))))
        (format nil "~a is ~(~a~)" (formula-text form) truth))))

(defun why-impossible (theory formula &key horizon)
  "Return an EXPLANATION why FORMULA, with timepoints by number, is true in no model of THEORY, or
NIL if it is in one.  The arguments are those of POSSIBLE-P."
  (let ((form (question-form theory formula)))
    (explain theory (form-words form :impossible) form (negated-form form)
             (format nil "Suppose ~a." (form-words form :true)) horizon)))

(defun why (theory formula &key horizon)
  "Return an EXPLANATION why FORMULA, with timepoints by number, is true in all models of THEORY, or
NIL if it is not.  The arguments are those of POSSIBLE-P."
  (let ((form (question-form theory formula)))
    (explain theory (form-words form :true) (negated-form form) form
             (format nil "Suppose ~a." (form-words form :false)) horizon)))

(defun why-inconsistent (theory &key horizon)
  "Return an EXPLANATION why THEORY has no model, or NIL if it has one.  The arguments are those of
POSSIBLE-P."
  (explain theory (format nil "theory ~a is inconsistent" (name-text (theory-name
                                                                      (as-theory theory))))
           '(:and) nil nil horizon))

(defmethod describe-object ((explanation explanation) stream)
  (format stream "~&~a~:[, for which there is no derivation without cases or arithmetic~;~].~%"
          (explanation-question explanation) (explanation-sentences explanation))
  (format stream "~{  ~a~%~}" (explanation-sentences explanation))
  (format stream "It rests on~%")
  (loop for (name instance) in (explanation-core explanation)
        do (format stream "  ~a: ~a~%" (name-text name) instance)))
