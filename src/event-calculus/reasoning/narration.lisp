;;;; Derivations in words.
;;;;
;;;; Each literal that is derived from a minimal core gets a sentence, A BECAUSE B, unless it goes
;;;; without saying: an auxiliary atom, an event that nothing makes happen, a fluent that nothing
;;;; releases, and the timepoints that a fluent only passes through by inertia.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (narration (:copier nil))
  "The derivations of each literal, by literal, the literals that are only passed on, and whether
the theory is consistent, so that what one event initiates no other can terminate."
  (reasoner nil :type reasoner :read-only t)
  (table (make-hash-table) :type hash-table :read-only t)
  (passed-on (make-hash-table) :type hash-table :read-only t)
  (consistent t :type boolean :read-only t))

(defun derivation-source (derivation)
  (ground-reason-source (derivation-reason derivation)))

(defun derivation-of (narration literal)
  (gethash literal (narration-table narration)))

(defun literal-atom (narration literal)
  (variable-atom (narration-reasoner narration) (abs literal)))

(defun literal-text (narration literal)
  (literal-words (literal-atom narration literal) (plusp literal)))

(defun assumed-reason-p (reason)
  (let ((axiom (reason-axiom reason)))
    (and axiom (eq (axiom-name axiom) +assumption+))))

(defun silent-p (narration literal)
  "Return true if LITERAL goes without saying."
  (let* ((derivation (derivation-of narration literal))
         (kind (and derivation (source-kind (derivation-source derivation)))))
    (and derivation (minusp literal)
         (or (member kind '(:not-released :release))
             (and (eq kind :completion) (null (premise-texts narration derivation)))))))

(defun premise-literals (narration derivation)
  "Return the literals that DERIVATION rests on and that need to be said, those of auxiliary atoms
in their place."
  (let ((literals '()) (seen '()))
    (labels ((collect (literal)
               (unless (member literal seen)
                 (push literal seen)
                 (cond ((null (literal-atom narration literal))
                        (let ((other (derivation-of narration literal)))
                          (when other (mapc #'collect (derivation-premises other)))))
                       ((not (silent-p narration literal)) (push literal literals))))))
      (mapc #'collect (derivation-premises derivation)))
    (nreverse literals)))

(defun premise-texts (narration derivation &optional but)
  "Return the words for the premises of DERIVATION without the literals BUT."
  (loop for literal in (premise-literals narration derivation)
        unless (member literal but) collect (literal-text narration literal)))

(defun joined (texts)
  (format nil "~{~a~^ and ~}" texts))

;;; Inertia

(defun passed-on-premise (narration derivation)
  "Return the premise of DERIVATION, by inertia, that is the same fluent at another timepoint."
  (let ((literal (derivation-literal derivation)))
    (and literal
         (eq (source-kind (derivation-source derivation)) :inertia)
         (let ((atom (literal-atom narration literal)))
           (find-if (lambda (premise)
                      (let ((other (literal-atom narration premise)))
                        (and (eq (first atom) :holds-at) (eq (first other) :holds-at)
                             (equal (second atom) (second other))
                             (eq (plusp premise) (plusp literal)))))
                    (derivation-premises derivation))))))

(defun origin (narration derivation)
  "Return the derivation from which that of a fluent follows by inertia alone, the literal that it
derives, and the words for what else that takes."
  (let ((literal (derivation-literal derivation)) (others '()))
    (loop for premise = (passed-on-premise narration derivation)
          while premise
          do (setf others (append others (premise-texts narration derivation (list premise)))
                   literal premise
                   derivation (derivation-of narration premise))
          while derivation)
    (values derivation literal (remove-duplicates others :test #'equal))))

;;; Because

(defun effect-itself-p (narration derivation)
  "Return true if DERIVATION derives the effect from the event, and not the other way round."
  (let ((effect (source-thing (derivation-source derivation)))
        (literal (derivation-literal derivation))
        (ground (encoder-ground (reasoner-encoder (narration-reasoner narration)))))
    (and (eq (source-kind (derivation-source derivation)) :effect)
         literal
         (let ((atom (literal-atom narration literal)))
           (and (eq (first atom) :holds-at)
                (equal (second atom)
                       (svref (ground-theory-fluents ground) (effect-fluent effect)))
                (= (third atom) (1+ (or (effect-time effect)
                                        (ground-reason-time
                                         (derivation-reason derivation))))))))))

(defun event-literal (narration derivation)
  "Return the premise of DERIVATION that the event of its effect happens."
  (let ((effect (source-thing (derivation-source derivation)))
        (events (ground-theory-events
                 (encoder-ground (reasoner-encoder (narration-reasoner narration))))))
    (find-if (lambda (literal)
               (let ((atom (literal-atom narration literal)))
                 (and (plusp literal) (eq (first atom) :happens)
                      (equal (second atom) (svref events (effect-event effect))))))
             (derivation-premises derivation))))

(defun effect-because (narration derivation)
  (let* ((reason (derivation-reason derivation))
         (effect (source-thing (derivation-source derivation)))
         (words (effect-words effect (ground-reason-time reason)
                              (encoder-ground (reasoner-encoder
                                               (narration-reasoner narration)))))
         (axiom (axiom-words (effect-axiom effect))))
    (if (or (effect-itself-p narration derivation)
            (eq (source-kind (derivation-source derivation)) :begin))
        (format nil "~a (~a)~@[, where ~{~a~^ and ~}~]" words axiom
                (premise-texts narration derivation (list (event-literal narration derivation))))
        (format nil "otherwise ~a (~a)~@[, and ~{~a~^ and ~}~]" words axiom
                (premise-texts narration derivation)))))

(defun trajectory-because (narration derivation)
  "Return why the fluent of a trajectory holds: what began it, and that nothing ends it."
  (let* ((change (source-thing (derivation-source derivation)))
         (reason (derivation-reason derivation))
         (fluents (ground-theory-fluents
                   (encoder-ground (reasoner-encoder (narration-reasoner narration)))))
         (begin (loop for literal in (derivation-premises derivation)
                      for other = (derivation-of narration literal)
                      when (and other (eq (source-kind (derivation-source other)) :begin))
                        return other))
         (others (loop for literal in (derivation-premises derivation)
                       when (and (literal-atom narration literal)
                                 (not (silent-p narration literal)))
                         collect (literal-text narration literal))))
    (if begin
        (format nil "~a~@[, where ~{~a~^ and ~}~]~@[, and nothing ~a~] (~a)"
                (effect-because narration begin) others
                (and (> (gradual-change-offset change) 1)
                     (format nil "~:[initiates~;terminates~] ~a until ~d"
                             (eq (gradual-change-kind change) :trajectory)
                             (atom-text (svref fluents (gradual-change-cause change)))
                             (+ (or (gradual-change-time change) (ground-reason-time reason))
                                (gradual-change-offset change))))
                (axiom-words (gradual-change-axiom change)))
        (format nil "~a (~a)" (joined (premise-texts narration derivation))
                (axiom-words (gradual-change-axiom change))))))

(defun because (narration derivation)
  "Return the text after `because' for DERIVATION."
  (let* ((source (derivation-source derivation))
         (axiom (reason-axiom (derivation-reason derivation)))
         (premises (premise-texts narration derivation)))
    (case (source-kind source)
      ((:effect :begin) (effect-because narration derivation))
      (:trajectory (trajectory-because narration derivation))
      (:inertia (format nil "~@[~a, and ~]nothing else changes it"
                        (and premises (joined premises))))
      (:not-released "nothing has released it")
      (:completion (format nil "no axiom makes it so~@[, since ~a~]"
                           (and premises (joined premises))))
      ((:exclusion :exactly-one)
       (format nil "~@[~a, and ~]~:[only ~;~]one of them ~:[can~;must~]"
               (and premises (joined premises))
               (plusp (derivation-literal derivation)) (plusp (derivation-literal derivation))))
      (t (let ((name (if axiom (axiom-words axiom) (name-text (source-kind source)))))
           (if premises
               (format nil "~a (~a)" (joined premises) name)
               (format nil "of ~a" name)))))))

;;; Sentences

(defun persistence-words (narration derivation literal)
  "Return why the fluent of LITERAL, by DERIVATION, persists: since when, and what would end it."
  (multiple-value-bind (origin first others) (origin narration derivation)
    (format nil "~a and nothing ~:[initiates~;terminates~] it~@[, since ~{~a~^ and ~}~]"
            (cond ((and origin (effect-itself-p narration origin)) (because narration origin))
                  ((or (null origin) (assumed-reason-p (derivation-reason origin)))
                   (literal-text narration first))
                  (t (format nil "~a (because ~a)" (literal-text narration first)
                             (because narration origin))))
            (plusp literal) others)))

(defun derivation-sentence (narration derivation last)
  "Return the sentence for DERIVATION, or NIL if it needs none; LAST is true of the last one."
  (let ((literal (derivation-literal derivation)))
    (cond ((null literal)
           (format nil "~:[This~;But ~:*~a: this~] contradicts ~a."
                   (let ((premises (premise-texts narration derivation)))
                     (and premises (joined premises)))
                   (contradiction-words narration derivation)))
          ((or (null (literal-atom narration literal))
               (assumed-reason-p (derivation-reason derivation))
               (and (not last)
                    (or (silent-p narration literal)
                        (gethash literal (narration-passed-on narration)))))
           nil)
          (t (format nil "~a because ~a." (literal-text narration literal)
                     (cond ((passed-on-premise narration derivation)
                            (persistence-words narration derivation literal))
                           ((and (effect-itself-p narration derivation)
                                 (narration-consistent narration))
                            (format nil "~a~:[~;,~] and nothing ~:[initiates~;terminates~] it"
                                    (because narration derivation)
                                    (search ", where" (because narration derivation))
                                    (plusp literal)))
                           (t (because narration derivation))))))))

(defun contradiction-words (narration derivation)
  (let* ((reason (derivation-reason derivation)) (axiom (reason-axiom reason)))
    (cond (axiom (axiom-words axiom))
          ((eq (source-kind (derivation-source derivation)) :inertia)
           (format nil "inertia: ~a" (second (reason-entry (narration-reasoner narration) reason))))
          (t (second (reason-entry (narration-reasoner narration) reason))))))

(defun narrate (reasoner derivations &key (consistent t))
  "Return the sentences for DERIVATIONS, which end in a claim or in a contradiction."
  (let ((narration (make-narration :reasoner reasoner :consistent consistent)))
    (dolist (derivation derivations)
      (when (derivation-literal derivation)
        (setf (gethash (derivation-literal derivation) (narration-table narration)) derivation)))
    (dolist (derivation derivations)
      (let ((premise (passed-on-premise narration derivation)))
        (when premise
          (setf (gethash premise (narration-passed-on narration)) t))))
    (loop for (derivation . more) on derivations
          for sentence = (derivation-sentence narration derivation (null more))
          when sentence collect sentence)))
