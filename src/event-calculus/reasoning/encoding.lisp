;;;; The Discrete Event Calculus in clauses.
;;;;
;;;; DEC5 to DEC12 for each ground fluent, with the completed definitions of initiates, terminates
;;;; and releases in place (explanation closure); DEC3 and DEC4 for each trajectory; the sentences;
;;;; the completion of happens and of other predicates where the theory asks for it.  The
;;;; released-at atoms of fluents that nothing can release are left out.  Entry point: ENCODE.

(in-package #:discrepancy-finder.event-calculus)

;;; DEC5 to DEC12

(defun effect-literal (encoder effect shift)
  "Return a literal that implies that the event of EFFECT happens and the guard holds."
  (formula-literal encoder (effect-formula effect) shift))

(defun effect-formula (effect)
  (fold :and (list (list :event (effect-event effect) 0) (effect-guard effect))))

(defun fluent-effects (ground fluent kind time)
  "Return the effects of KIND on FLUENT at any timepoint, with TIME also those at TIME only."
  (remove-if-not (lambda (effect)
                   (and (eq (effect-kind effect) kind)
                        (or (null (effect-time effect)) (eql (effect-time effect) time))))
                 (svref (ground-theory-effects-on ground) fluent)))

(defun effect-shift (effect time)
  "Return by how much the guard of EFFECT is to be moved to be about TIME, 0 in a template."
  (if (effect-time effect) 0 time))

(defun mention-atoms (encoder formula shift)
  "Let the atoms of FORMULA, moved by SHIFT timepoints, be counted although it is known to be true
or says nothing: in the Discrete Event Calculus Reasoner other clauses say so."
  (map-atoms (lambda (atom)
               (unless (eq (first atom) :compare)
                 (let ((literal (formula-literal encoder atom shift)))
                   (add-clause encoder (list literal (negate literal))))))
             formula))

(defun assert-effect (encoder effect time)
  "DEC9, DEC10, DEC11 and DEC12 for EFFECT at TIME."
  (let* ((event (negate (atom-literal encoder :event (effect-event effect) time)))
         (fluent (atom-literal encoder :fluent (effect-fluent effect) (1+ time)))
         (released (atom-literal encoder :released (effect-fluent effect) (1+ time)))
         (guard (negated (effect-guard effect)))
         (shift (effect-shift effect time)))
    (flet ((assert-head (literal)
             (assert-formula encoder guard shift (list event literal))))
      (when (or (and (eq (effect-kind effect) :releases) (eq released t))
                (known-release-p encoder (effect-guard effect)))
        (mention-atoms encoder (dated-effect-formula effect time) 0))
      (ecase (effect-kind effect)
        (:initiates (assert-head fluent) (assert-head (negate released)))
        (:terminates (assert-head (negate fluent)) (assert-head (negate released)))
        (:releases (assert-head released))))))

(defun dated-effect-formula (effect time)
  "Return the ground formula that the event of EFFECT happens at TIME and the guard holds."
  (fold :and (list (list :event (effect-event effect) time)
                   (shift-formula (effect-guard effect) (effect-shift effect time)))))

(defun effect-literals (encoder fluent kind time absolute)
  (loop for effect in (fluent-effects (encoder-ground encoder) fluent kind (and absolute time))
        collect (formula-literal encoder (dated-effect-formula effect time) 0)))

(defun encode-fluent (encoder fluent template time absolute)
  "Add DEC5 to DEC12 for FLUENT between TIME and the next timepoint.  ABSOLUTE is true if TIME is a
timepoint, and no distance."
  (let* ((ground (encoder-ground encoder))
         (release (svref (ground-theory-release ground) fluent))
         (now (atom-literal encoder :fluent fluent time))
         (next (atom-literal encoder :fluent fluent (1+ time)))
         (released (atom-literal encoder :released fluent time))
         (released-next (atom-literal encoder :released fluent (1+ time))))
    (dolist (kind '(:initiates :terminates :releases))
      (dolist (effect (fluent-effects ground fluent kind (and absolute time)))
        (with-source (encoder template absolute :effect effect)
          (assert-effect encoder effect time))))
    (flet ((literals (kind) (effect-literals encoder fluent kind time absolute)))
      (when (and (eq release :always) (mention-non-inertial-p encoder))
        ;; There the axioms DEC5 and DEC6 mention fluents that are always released, so that they
        ;; are atoms, and counted.
        (add-clause encoder (list now (negate now)))
        (add-clause encoder (list next (negate next))))
      (unless (eq release :always)
        (with-source (encoder template absolute :inertia fluent)
          (let ((initiated (literals :initiates)) (terminated (literals :terminates)))
            (add-clause encoder (list* (negate now) released-next next terminated))
            (add-clause encoder (list* now released-next (negate next) initiated)))))
      (when (eq release :possibly)
        (with-source (encoder template absolute :release fluent)
          (add-clause encoder (list* (negate released) released-next
                                     (append (literals :initiates) (literals :terminates))))
          (add-clause encoder (list* released (negate released-next) (literals :releases))))))))

(defun mention-non-inertial-p (encoder)
  "Return true if the theory asks for the third encoding of the Discrete Event Calculus Reasoner."
  (eql 3 (getf (theory-options (ground-theory-theory (encoder-ground encoder))) :encoding)))

(defun encode-fluents (encoder)
  (let* ((ground (encoder-ground encoder))
         (step (find-template encoder 0 1))
         (horizon (encoder-horizon encoder)))
    (dotimes (fluent (encoder-fluent-count encoder))
      (if (some #'effect-time (svref (ground-theory-effects-on ground) fluent))
          (loop for time from (car horizon) below (cdr horizon)
                do (setf (encoder-date encoder) time)
                   (encode-fluent encoder fluent (encoder-absolute encoder) time t)
                   (setf (encoder-date encoder) nil))
          (encode-fluent encoder fluent step 0 nil))
      (unless (manual-release-p ground fluent)
        (with-source (encoder (encoder-initial encoder) t :not-released fluent)
          (let ((released (atom-literal encoder :released fluent 0)))
            (when (integerp released)
              (add-clause encoder (list (- released))))))))))

(defun manual-release-p (ground fluent)
  (let ((manual (theory-manual-release (ground-theory-theory ground))))
    (or (eq manual t)
        (member (first (svref (ground-theory-fluents ground) fluent)) manual))))

;;; DEC3 and DEC4

(defun encode-trajectories (encoder cause kind start stop)
  "Add the axioms of the trajectories of KIND of the fluent CAUSE.  Effects of the kind START begin
them, those of the kind STOP end them."
  (let* ((ground (encoder-ground encoder))
         (changes (remove kind (svref (ground-theory-changes ground) cause)
                          :key #'gradual-change-kind :test-not #'eq))
         (dated (if (some #'effect-time (svref (ground-theory-effects-on ground) cause))
                    changes
                    (remove nil changes :key #'gradual-change-time)))
         (horizon (encoder-horizon encoder)))
    (let ((relative (set-difference changes dated)))
      ;; Where nothing begins a trajectory its instances vanish, with their atoms.
      (when (and relative (fluent-effects ground cause start nil))
        (encode-relative-trajectories encoder cause relative start stop)))
    (dolist (change dated)
      (if (gradual-change-time change)
          (encode-dated-trajectory encoder change (gradual-change-time change) start stop)
          (loop for time from (car horizon) below (cdr horizon)
                do (encode-dated-trajectory encoder change time start stop))))))

(defun encode-relative-trajectories (encoder cause changes start stop)
  "Add the axioms of the trajectories CHANGES of CAUSE as templates."
  (let* ((ground (encoder-ground encoder))
         (begin (fluent-effects ground cause start nil))
         (end (fluent-effects ground cause stop nil))
         (longest (reduce #'max changes :key #'gradual-change-offset :initial-value 0))
         (begun nil)
         (stopped (make-array (1+ longest) :initial-element nil)))
    (setf (encoder-once encoder) nil
          begun (new-code encoder))
    (dolist (effect begin)
      (with-source (encoder (find-template encoder 0 1) nil :begin effect)
        (assert-formula encoder (negated (effect-formula effect)) 0 (list begun))))
    ;; Not needed, but where no event can begin the trajectory its clauses are dropped early.
    (unless (encoder-tracked encoder)
      (with-source (encoder (find-template encoder 0 1) nil :begin nil)
        (add-clause encoder (cons (- begun) (loop for effect in begin
                                                  collect (effect-literal encoder effect 0))))))
    (loop for offset from 2 to longest
          do (with-source (encoder (find-template encoder 0 offset) nil :stop cause)
               (setf (svref stopped offset)
                     (disjunction-literal
                      encoder
                      (remove nil (cons (svref stopped (1- offset))
                                        (loop for effect in end
                                              collect (effect-literal encoder effect
                                                                      (1- offset)))))))))
    (dolist (change (reverse changes))
      (let ((offset (gradual-change-offset change)))
        (with-source (encoder (find-template encoder 0 offset) nil :trajectory change)
          (assert-formula encoder (negated (gradual-change-guard change)) 0
                          (list (- begun) (svref stopped offset)
                                (formula-literal encoder (changed-formula change 0) 0))))))))

(defun changed-formula (change time)
  "Return the ground formula that what CHANGE leads to, begun at TIME, is so."
  (let ((end (+ time (gradual-change-offset change))))
    (if (gradual-change-term change)
        (list :compare := (list :value (gradual-change-fluent change) end)
              (shift-formula (gradual-change-term change)
                             (if (gradual-change-time change) 0 time)))
        (list :fluent (gradual-change-fluent change) end))))

(defun encode-dated-trajectory (encoder change time start stop)
  "Add the axiom of the trajectory CHANGE that begins at the timepoint TIME."
  (let* ((ground (encoder-ground encoder))
         (cause (gradual-change-cause change))
         (end (+ time (gradual-change-offset change)))
         (shift (if (gradual-change-time change) 0 time)))
    (flet ((happening (kind time)
             (fold :or (loop for effect in (fluent-effects ground cause kind time)
                             collect (dated-effect-formula effect time)))))
      (when (and (<= end (cdr (encoder-horizon encoder)))
                 (fluent-effects ground cause start time))
        (with-source (encoder (encoder-absolute encoder) t :trajectory change)
          (assert-formula encoder
                          (fold :or (list* (negated (happening start time))
                                           (negated (shift-formula (gradual-change-guard change)
                                                                   shift))
                                           (changed-formula change time)
                                           (loop for between from (1+ time) below end
                                                 collect (happening stop between))))
                          0))))))

;;; Sentences, completion, exclusion

(defun known-release-p (encoder formula)
  "Return true if a part of FORMULA speaks of a release that is known to be, or not to be."
  (map-atoms (lambda (atom)
               (when (and (eq (first atom) :released)
                          (not (eq (svref (ground-theory-release (encoder-ground encoder))
                                          (second atom))
                                   :possibly)))
                 (return-from known-release-p t)))
             formula))

(defun encode-sentence (encoder sentence)
  (if (sentence-absolute sentence)
      (with-source (encoder (encoder-absolute encoder) t :sentence sentence)
        (when (known-release-p encoder (sentence-formula sentence))
          (mention-atoms encoder (sentence-formula sentence) 0))
        (assert-formula encoder (sentence-formula sentence) 0))
      (with-source (encoder (find-template encoder (sentence-first sentence)
                                           (sentence-last sentence))
                            nil :sentence sentence)
        (when (known-release-p encoder (sentence-formula sentence))
          (mention-atoms encoder (sentence-formula sentence) 0))
        (assert-formula encoder (sentence-formula sentence) 0))))

(defun excluded-atoms (ground names)
  "Return (kind index*) of the instances of the events or fluents NAMES; T means all events."
  (flet ((numbers (atoms)
           (loop for atom across atoms
                 for index from 0
                 when (or (eq names t) (member (first atom) names)) collect index)))
    (let ((events (numbers (ground-theory-events ground))))
      (if (or (eq names t) events)
          (cons :event events)
          (cons :fluent (numbers (ground-theory-fluents ground)))))))

(defun encode-exclusion (encoder kind names thing)
  "Add that at most one (:MUTEX) or exactly one (:XOR) of the instances of NAMES, T for all events,
is true; THING says where that comes from."
  (destructuring-bind (atom-kind . numbers) (excluded-atoms (encoder-ground encoder) names)
    (let* ((template (find-template encoder 0 (if (eq atom-kind :event) 1 0)))
           (literals (loop for number in numbers
                           collect (atom-literal encoder atom-kind number 0))))
      (with-source (encoder template nil (if (eq kind :xor) :exactly-one :exclusion) thing)
        (when (eq kind :xor)
          (add-clause encoder literals))
        (if (or (encoder-tracked encoder) (null (nthcdr 6 literals)))
            (loop for (first . others) on literals
                  do (dolist (other others)
                       (add-clause encoder (list (- first) (- other)))))
            (push literals (template-exclusions template)))))))

(defun make-empty-encoder (ground horizon tracked)
  (let ((fluents (length (ground-theory-fluents ground)))
        (events (length (ground-theory-events ground)))
        (predicates (length (atom-table-atoms (ground-theory-predicates ground))))
        (numerics (length (ground-theory-numerics ground)))
        (statics (length (atom-table-atoms (ground-theory-statics ground)))))
    (make-encoder :ground ground :horizon horizon :tracked tracked
                  :fluent-count fluents :event-count events :predicate-count predicates
                  :static-count statics :numeric-count numerics
                  :step-size (+ fluents fluents events predicates numerics)
                  :global-size (1+ statics))))

(defun encode (ground horizon &key tracked open-events assumptions)
  "Return an ENCODER with the clauses of GROUND, a ground theory for HORIZON.  With TRACKED each
source of clauses has a selector, a literal under which they hold.  OPEN-EVENTS names events whose
completion is left out, ASSUMPTIONS are sentences that are added."
  (let ((encoder (make-empty-encoder ground horizon tracked)))
    (encode-fluents encoder)
    (encode-numeric-fluents encoder)
    (dotimes (cause (encoder-fluent-count encoder))
      (encode-trajectories encoder cause :trajectory :initiates :terminates)
      (encode-trajectories encoder cause :anti-trajectory :terminates :initiates))
    (dolist (sentence (ground-theory-initial-conditions ground))
      (with-source (encoder (encoder-initial encoder) t :initially sentence)
        (assert-formula encoder (sentence-formula sentence) 0)))
    (dolist (sentence (append (ground-theory-sentences ground) assumptions))
      (encode-sentence encoder sentence))
    (let ((axiom (ground-theory-one-event-at-a-time ground)))
      (when axiom
        (encode-exclusion encoder :mutex t axiom)))
    (loop for (kind . names) in (theory-exclusions (ground-theory-theory ground))
          do (encode-exclusion encoder kind names names))
    (encode-completions encoder open-events)
    encoder))
