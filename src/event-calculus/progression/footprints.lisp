;;;; Footprints: which fluents an event looks at and which it changes.
;;;;
;;;; Two events that happen one after the other can change places if neither changes what the other
;;;; looks at or changes.  An event looks at the fluents in the conditions of its effects, in the
;;;; sentences about it (preconditions) and in the state constraints on the fluents that it changes;
;;;; what it triggers belongs to it.  Sets of fluents are integers, a bit for each fluent by number.
;;;; Where a theory looks at more than one step, or leaves fluents open, ORDER-MATTERS-P is true and
;;;; footprints mean nothing.  Entry points: ORDER-MATTERS-P, EVENT-FOOTPRINT, FORMULA-FOOTPRINT.

(in-package #:discrepancy-finder.event-calculus)

(defun fluent-set (numbers)
  (let ((set 0))
    (dolist (number numbers set)
      (setf set (logior set (ash 1 number))))))

(defun formula-footprint (formula)
  "Return the set of the fluents in the ground FORMULA and true if it mentions events."
  (values (fluent-set (formula-fluents formula)) (mentions-event-p formula)))

(defun happens-unless-asked-p (definition)
  "Return true if DEFINITION can make its event happen where no other event happens."
  (loop for supports in (definition-alternatives definition)
          thereis (loop for support in supports
                          thereis (let ((formula (support-formula support)))
                                    (map-atoms (lambda (atom)
                                                 (when (eq (first atom) :event)
                                                   (setf formula
                                                         (replace-atom formula atom nil))))
                                               (support-formula support))
                                    formula))))

(defun order-matters-p (ground)
  "Return true if the theory GROUND may tell two events that have nothing to do with each other by
their order: it speaks of several steps, of all steps, or leaves something open in between."
  (let ((outline (ground-outline ground)))
    (and (or (outline-memory-p outline) (outline-late-p outline) (outline-dated-p outline)
             (outline-loose-fluents outline) (outline-causes outline)
             (outline-state-demands outline) (outline-other-demands outline)
             (outline-limits outline)
             (plusp (length (ground-theory-numerics ground)))
             (plusp (hash-table-count (outline-predicates outline)))
             (loop for definition being the hash-values of (outline-events outline)
                     thereis (or (definition-ahead-p definition)
                                 (happens-unless-asked-p definition))))
         t)))

(defun event-and-consequences (outline event)
  "Return the list of EVENT and the numbers of all events that it may trigger, and those that these
may trigger."
  (let ((events (list event)))
    (loop for new = (loop for number being the hash-keys of (outline-events outline)
                            using (hash-value definition)
                          unless (member number events)
                            when (loop for supports in (definition-alternatives definition)
                                         thereis (loop for support in supports
                                                         thereis (mentions-one-p support events)))
                              collect number)
          while new do (setf events (append events new)))
    events))

(defun mentions-one-p (support events)
  (map-atoms (lambda (atom)
               (when (and (eq (first atom) :event) (member (second atom) events))
                 (return-from mentions-one-p t)))
             (support-formula support))
  nil)

(defun event-footprint (ground event)
  "Return the sets of the fluents that the event with the number EVENT of GROUND looks at, and
changes.  With NIL for EVENT nothing happens."
  (let ((outline (ground-outline ground)) (looks 0) (changes 0))
    (flet ((look-at (formula)
             (setf looks (logior looks (formula-footprint formula)))))
      (dolist (event (and event (event-and-consequences outline event)))
        (dolist (influence (svref (outline-influences outline) event))
          (setf changes (logior changes (ash 1 (influence-fluent influence))))
          (loop for guards in (list (influence-initiates influence)
                                    (influence-terminates influence)
                                    (influence-releases influence))
                do (dolist (guard guards) (look-at (cdr guard))))
          (dolist (demand (svref (outline-state-demands-of outline) (influence-fluent influence)))
            (look-at (demand-formula demand))))
        (dolist (demand (svref (outline-event-demands-of outline) event))
          (look-at (demand-formula demand)))
        (let ((definition (gethash event (outline-events outline))))
          (when definition
            (dolist (supports (definition-alternatives definition))
              (dolist (support supports) (look-at (support-formula support))))))))
    (values looks changes)))

;;; Which axioms matter

(defun demand-axioms (demands)
  (remove-if-not #'axiom-p (mapcar #'demand-axiom demands)))

(defun initial-axioms (ground)
  "Return the list of the axioms that say something of the initial state of GROUND: facts, and
sentences about single timepoints."
  (let ((outline (ground-outline ground)))
    (remove-duplicates
     (append (remove-if-not #'axiom-p (mapcar #'sentence-axiom
                                              (ground-theory-initial-conditions ground)))
             (demand-axioms (outline-static-demands outline))
             (demand-axioms (outline-state-demands outline))
             (loop for demands across (outline-state-demands-of outline)
                   append (demand-axioms demands))))))

(defun axioms-about-event (ground event)
  "Return the list of the axioms that say when the ground EVENT, a list, can happen."
  (remove-duplicates
   (demand-axioms (svref (outline-event-demands-of (ground-outline ground))
                         (find-event ground event)))))

(defun effects-of-event (state event)
  "Return the list of the axioms by which the ground EVENT may have an effect in STATE."
  (let ((ground (state-ground state)))
    (loop for effect in (append (svref (ground-theory-effects ground) (find-event ground event)))
          when (handler-case (holds (effect-guard effect) (list state))
                 ;; a condition on events or other timepoints
                 (error () t))
            collect (effect-axiom effect))))

(defun axioms-used (state next)
  "Return the list of the axioms that say something of the step from STATE to NEXT: those by which
what happened may have an effect, and sentences about several timepoints."
  (remove-duplicates
   (append (loop for (event . proposition) in (state-happenings next)
                 when proposition append (effects-of-event state event))
           (loop for (event . proposition) in (state-happenings next)
                 when proposition append (axioms-about-event (state-ground state) event))
           (demand-axioms (outline-other-demands (ground-outline (state-ground state)))))))
