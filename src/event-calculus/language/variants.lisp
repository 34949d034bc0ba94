;;;; Variants of theories: the same vocabulary with other axioms.
;;;;
;;;; What is asked about a run of events, or about a theory with a sentence more or less, is asked of
;;;; a variant: THEORY-VARIANT.  It is registered nowhere.

(in-package #:discrepancy-finder.event-calculus)

(defun parse-named-axiom (theory name formula)
  "Return an axiom of THEORY named NAME, a symbol, with FORMULA as it is written in DEFINE-THEORY."
  (let ((name (name-keyword name)))
    (make-axiom :name name
                :formula (normalize formula (theory-name theory)
                                    (format nil "axiom ~a" (name-text name))))))

(defun theory-variant (theory &key (axioms (theory-axioms theory)) added complete-events)
  "Return a theory like THEORY with AXIOMS, a list of AXIOMs, and those ADDED: a list of (name
formula).  With COMPLETE-EVENTS no event happens unless an axiom makes it happen.  It has no state
constraints.  Signals THEORY-ERROR."
  (make-checked-theory
   :name (theory-name theory) :documentation (theory-documentation theory)
   :syntax (theory-syntax theory) :file (theory-file theory)
   :extended-files (theory-extended-files theory)
   :sorts (theory-sorts theory)
   :predicates (theory-predicates theory) :extensions (theory-extensions theory)
   :functions (theory-functions theory)
   :fluents (theory-fluents theory) :numeric-fluents (theory-numeric-fluents theory)
   :non-inertial (theory-non-inertial theory) :manual-release (theory-manual-release theory)
   :events (theory-events theory)
   :axioms (append axioms
                   (loop for (name formula) in added
                         collect (parse-named-axiom theory name formula)))
   :completions (let ((entry (list nil (name-keyword :happens)))
                      (completions (theory-completions theory)))
                  (if (and complete-events
                           (not (member entry completions :test #'equal)))
                      (append completions (list entry))
                      completions))
   :exclusions (theory-exclusions theory)
   :time-range (theory-time-range theory) :offset-range (theory-offset-range theory)
   :options (theory-options theory)))

(defun about-the-beginning-p (axiom)
  "Return true if AXIOM says what is initially true."
  (labels ((look (form)
             (and (consp form)
                  (or (eq (first form) :initially) (some #'look (rest form))))))
    (look (axiom-formula axiom))))
