;;;; Revising: a theory with some of its axioms left out and others added.
;;;;
;;;; REVISED-THEORY makes a new theory; the old one stays as it is.  EFFECT-AXIOMS and EVENT-AXIOMS
;;;; find what there is to be left out.

(in-package #:discrepancy-finder.event-calculus)

(defun about-the-beginning-p (axiom)
  "Return true if AXIOM says what is initially true."
  (labels ((look (form)
             (and (consp form)
                  (or (eq (first form) :initially) (some #'look (rest form))))))
    (look (axiom-formula axiom))))

(defun revised-theory (theory &key without with fluents complete-events)
  "Return THEORY without the axioms whose names are in the list WITHOUT, and with those of WITH, a
list of (name formula), in the place of older ones of the same name.  The state constraints are
kept.  FLUENTS are further ones, as THEORY-FLUENTS has them.  With COMPLETE-EVENTS no event happens
unless an axiom makes it happen.  The new theory is not registered.  Signals THEORY-ERROR."
  (let* ((axioms (loop for (name formula) in with
                       collect (make-axiom
                                :name (name-keyword name)
                                :formula (normalize formula (theory-name theory)
                                                    (format nil "axiom ~a" (name-text name))))))
         (rest (theory-without theory (append without (mapcar #'axiom-name axioms)))))
    (inherit-state-constraints
     (make-checked-theory :extends (list rest) :axioms axioms :fluents fluents
                          :name (theory-name theory) :documentation (theory-documentation theory)
                          :syntax (theory-syntax theory) :file (theory-file theory)
                          :completions (and complete-events '((nil :happens))))
     (list theory))))

(defun effect-axioms (theory predicate event fluent)
  "Return the list of the axioms of THEORY that state an effect by PREDICATE (:initiates,
:terminates or :releases) of the event on the fluent with the names EVENT and FLUENT, and nothing
else."
  (remove-if-not (lambda (axiom)
                   (let ((clauses (axiom-clauses axiom theory)))
                     (destructuring-bind (kind condition head &rest others) (first clauses)
                       (declare (ignore condition))
                       (and (eq kind :effect) (null others) (null (rest clauses))
                            (eq (first head) predicate)
                            (consp (second head)) (eq (first (second head)) event)
                            (consp (third head)) (eq (first (third head)) fluent)))))
                 (theory-axioms theory)))

(defun names-event-p (form event)
  "Return true if FORM says that the event named EVENT happens."
  (and (consp form)
       (or (and (eq (first form) :happens) (consp (second form)) (eq (first (second form)) event))
           (some (lambda (part) (names-event-p part event)) (rest form)))))

(defun event-axioms (theory event)
  "Return the list of the sentences of THEORY, effects apart, that say when the event named EVENT
may happen."
  (remove-if-not (lambda (axiom)
                   (and (names-event-p (axiom-formula axiom) event)
                        (eq :sentence (first (first (axiom-clauses axiom theory))))))
                 (theory-axioms theory)))
