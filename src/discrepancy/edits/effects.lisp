;;;; Edits for a fluent that an action changes in the simulation and not in the theory, or the other
;;;; way round.
;;;;
;;;; A CHANGE is what was seen of a fluent at the divergence.  Its REPAIRS, best first, are edits of
;;;; the theory: an effect is added, under a condition that fits all transitions so far; an axiom
;;;; that states the effect too widely or too narrowly is replaced or removed; or the effect is left
;;;; open, by releasing the fluent from inertia.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (change (:copier nil))
  "The fluent ATOM had the truth value SEEN after TRANSITION, and the theory has the other one."
  (atom '() :type list :read-only t)
  (seen nil :type boolean :read-only t)
  (transition nil :read-only t))

(defun transition-truth (transition atom &optional (when :before))
  "Return T, NIL or :UNKNOWN: the value of ATOM before or after TRANSITION."
  (multiple-value-bind (truth known)
      (gethash atom (if (eq when :before)
                        (transition-before transition)
                        (transition-after transition)))
    (if known (and truth t) :unknown)))

(defun effect-predicate (value)
  "Return the predicate that states that an event gives a fluent the truth value VALUE."
  (if value :initiates :terminates))

;;; Rows: the instances of a lifted event and fluent in transitions.

(defun event-rows (theory transitions event fluent lifting)
  "Return (row before after) for each instance of the patterns EVENT and FLUENT of LIFTING in
TRANSITIONS: the fluent's truth values before and after."
  (loop for transition in transitions
        for (bindings matches) = (and (transition-event transition)
                                      (multiple-value-list
                                       (matching event (transition-event transition))))
        when matches
          append (loop for extended in (all-bindings theory bindings lifting)
                       for atom = (ground-pattern fluent extended)
                       collect (list (make-row (transition-before transition) extended)
                                     (transition-truth transition atom)
                                     (transition-truth transition atom :after)))))

(defun lifted-bindings (lifting)
  "Return the bindings of the variables of LIFTING to what they were made of."
  (loop for (variable nil . element) in lifting collect (cons variable element)))

(defun axiom-name-for (theory parts taken)
  "Return a name for an axiom, of the words PARTS, that neither THEORY nor the list TAKEN has."
  (loop for number from 1
        for name = (intern (format nil "~{~a~^-~}~[~;~:;-~:*~d~]" parts number) :keyword)
        unless (or (member name taken) (find name (ec:theory-axioms theory) :key #'ec:axiom-name))
          return name))

(defun effect-sentence (predicate event fluent condition)
  "Return the sentence that EVENT has an effect on FLUENT under CONDITION, a list of literals."
  (implication condition (list predicate event fluent :?time)))

(defun effect-hypotheses (domain transitions transition atom value)
  "Return (values sentences consistent-p event fluent): the sentences, best first, by which the
event of TRANSITION gives ATOM the truth value VALUE; CONSISTENT-P is true if they fit all of
TRANSITIONS, else there is one, without a condition."
  (let* ((theory (symbolic:action-theory-theory domain))
         (event (transition-event transition))
         (lifting (lifting theory (list (cons :event event) (cons :fluent atom))))
         (lifted-event (lifted theory event :event lifting))
         (lifted-fluent (lifted theory atom :fluent lifting))
         (rows (event-rows theory transitions lifted-event lifted-fluent lifting))
         (conditions (best-conditions
                      domain
                      (condition-literals domain (mapcar (lambda (entry)
                                                           (list (first entry) (second entry)))
                                                         lifting))
                      (list (make-row (transition-before transition) (lifted-bindings lifting)))
                      (loop for (row nil after) in rows
                            when (eq after (not value)) collect row)
                      :good-rows (loop for (row before after) in rows
                                       when (and (eq after value) (eq before (not value)))
                                         collect row))))
    (values (loop for condition in (or conditions '(()))
                  collect (effect-sentence (effect-predicate value) lifted-event lifted-fluent
                                           condition))
            (and conditions t) lifted-event lifted-fluent)))

;;; Repairs: lists of (kind sentences replaced).

(defun effect-axiom-names (theory value transition atom)
  "Return the names of the axioms of THEORY by which the event of TRANSITION gives the fluent of
ATOM the truth value VALUE."
  (mapcar #'ec:axiom-name
          (ec:effect-axioms theory (effect-predicate value) (first (transition-event transition))
                            (first atom))))

(defun acting-axiom-names (domain known value transition atom)
  "Return those of the names KNOWN, of axioms, by which the event of TRANSITION can have given ATOM
the truth value VALUE: their conditions were not seen to be false before."
  (let ((acting (loop for (name . condition)
                        in (ec:effect-conditions (symbolic:action-theory-ground domain)
                                                 (effect-predicate value)
                                                 (transition-event transition) atom)
                      when (or (null condition)
                               (formula-truth (symbolic:action-theory-theory domain) condition
                                              (transition-before transition) '()))
                        collect name)))
    (remove-if-not (lambda (name) (member name acting)) known)))

(defun missing-effect-repairs (domain transitions change)
  "Return the repairs for an effect that the simulation has and the theory has not."
  (let* ((theory (symbolic:action-theory-theory domain))
         (transition (change-transition change))
         (atom (change-atom change))
         (value (change-seen change))
         (known (effect-axiom-names theory value transition atom)))
    (multiple-value-bind (sentences consistent event fluent)
        (effect-hypotheses domain transitions transition atom value)
      (flet ((name (predicate)
               (axiom-name-for theory (list (first event) predicate (first fluent)) '())))
        (append
         ;; One sentence instead of all that were not enough, else one more.
         (loop for sentence in (and consistent sentences)
               append (and known
                           (list (list :effect (list (list (first known) sentence)) known)))
               collect (list :effect
                             (list (list (name (effect-predicate value)) sentence)) '()))
         (list (list :release
                     (list (list (name :releases)
                                 (effect-sentence :releases event fluent
                                                  (list (if value (list :not fluent) fluent)))))
                     '()))
         (unless consistent
           (list (list :effect
                       (list (list (name (effect-predicate value)) (first sentences)))
                       '()))))))))

(defun supporting-transition (transitions event-name atom value)
  "Return a transition whose event is of EVENT-NAME, and an instance of the fluent of ATOM that it
gave the truth value VALUE, or NIL."
  (dolist (transition transitions)
    (when (eq (first (transition-event transition)) event-name)
      (loop for fluent being the hash-keys of (transition-after transition) using (hash-value after)
            when (and (eq (first fluent) (first atom)) (eq (and after t) value)
                      (eq (transition-truth transition fluent) (not value)))
              do (return-from supporting-transition (values transition fluent))))))

(defun wrong-effect-repairs (domain transitions change)
  "Return the repairs for an effect that the theory has and the simulation has not.  Of the
axioms that state it those are wrong that acted in the transition."
  (let* ((theory (symbolic:action-theory-theory domain))
         (transition (change-transition change))
         (atom (change-atom change))
         (value (not (change-seen change)))
         (event-name (first (transition-event transition)))
         (known (effect-axiom-names theory value transition atom))
         (wrong (acting-axiom-names domain known value transition atom)))
    (when wrong
      (multiple-value-bind (support instance)
          (supporting-transition transitions event-name atom value)
        (multiple-value-bind (sentences consistent)
            (and support (effect-hypotheses domain transitions support instance value))
          (append
           (loop for sentence in (and consistent sentences)
                 collect (list :effect (list (list (first wrong) sentence)) wrong))
           (list (list :weaken '() wrong))
           ;; What leaves the fluent open must not meet another effect on it.
           (let* ((lifting (lifting theory (list (cons :event (transition-event transition))
                                                 (cons :fluent atom))))
                  (event (lifted theory (transition-event transition) :event lifting))
                  (fluent (lifted theory atom :fluent lifting)))
             (list (list :release
                         (list (list (axiom-name-for theory (list (first event) :releases
                                                                  (first fluent))
                                                     '())
                                     (effect-sentence :releases event fluent
                                                      (list (if value
                                                                (list :not fluent)
                                                                fluent)))))
                         known)))))))))

(defun change-repairs (domain transitions change)
  "Return the repairs for CHANGE, best first."
  (let ((before (transition-truth (change-transition change) (change-atom change))))
    (cond ((null (transition-event (change-transition change))) '())
          ((eq before (change-seen change)) (wrong-effect-repairs domain transitions change))
          ((eq before :unknown) '())
          (t (missing-effect-repairs domain transitions change)))))

(defun change-kind (theory change)
  "Return what is the same for changes that the same repairs are for."
  (let* ((atom (change-atom change))
         (event (transition-event (change-transition change)))
         (lifting (lifting theory (list (cons :event event) (cons :fluent atom)))))
    (list (change-seen change)
          (eq (change-seen change) (transition-truth (change-transition change) atom))
          (lifted theory event :event lifting) (lifted theory atom :fluent lifting))))

(defun combined-repairs (lists)
  "Return combinations of one repair of each of LISTS: of the best ones, and with one of the others
in the place of one of these."
  (if (some #'null lists)
      '()
      (let ((best (mapcar #'first lists)))
        (cons best
              (loop for number from 0
                    for list in lists
                    append (loop for repair in (rest list)
                                 collect (append (subseq best 0 number) (list repair)
                                                 (nthcdr (1+ number) best))))))))

(defun merged-repairs (repairs)
  "Return the parts of an edit that REPAIRS, lists of (kind sentences replaced), make together."
  (list (or (find :release (mapcar #'first repairs))
            (find :weaken (mapcar #'first repairs))
            (first (first repairs)))
        (loop with names = '()
              for (nil sentences) in repairs
              append (loop for (name formula) in sentences
                           for own = (if (member name names)
                                         (intern (format nil "~a-~d" name (1+ (length names)))
                                                 :keyword)
                                         name)
                           do (push own names)
                           collect (list own formula)))
        (remove-duplicates (loop for (nil nil replaced) in repairs append replaced)
                           :from-end t)))

(defun state-edits (domain transitions transition divergence)
  "Return the parts (kind sentences replaced) of edits for DIVERGENCE, of the state after
TRANSITION, best first."
  (let* ((theory (symbolic:action-theory-theory domain))
         (changes (loop for (atom nil seen) in (divergence-fluents divergence)
                        collect (make-change :atom atom :seen (and seen t)
                                             :transition transition))))
    (when (transition-event transition)
      (mapcar #'merged-repairs
              (combined-repairs
               (mapcar (lambda (change) (change-repairs domain transitions change))
                       (remove-duplicates changes :test #'equal :from-end t
                                                  :key (lambda (change)
                                                         (change-kind theory change)))))))))
