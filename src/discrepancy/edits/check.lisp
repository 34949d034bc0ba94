;;;; Candidate edits, each checked by judging again all runs so far.
;;;;
;;;; CANDIDATE-EDITS is the entry point.  A run CONTRADICTS an edit if the theory agreed with it
;;;; further before the edit.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *edits-checked* 12
  "So many candidate edits of a discrepancy are checked at most.")

(defun refreshed-steps (domain run)
  "Return the steps of RUN with the outcomes that they can be in DOMAIN."
  (mapcar (lambda (step) (refreshed-step domain step)) (run-steps run)))

(defun initial-observation (domain run)
  "Return what was observed at the beginning of RUN, with the fluents of coordinate ranges that
DOMAIN has and the domain of RUN had not, by the run's sample."
  (append (run-initial-state run)
          (loop for observer in (domain-observers domain)
                for value = (and (coordinate-range-p observer)
                                 (not (assoc (coordinate-range-atom observer)
                                             (run-initial-state run) :test #'equal))
                                 (sample-coordinate (run-sample run)
                                                    (coordinate-range-body observer)
                                                    (coordinate-range-axis observer)))
                when value
                  collect (cons (coordinate-range-atom observer)
                                (in-coordinate-range-p observer value)))))

(defun first-divergence (domain run context &optional memory)
  "Return the first divergence of RUN, of a domain that differs in theory and action bindings only,
by DOMAIN, or NIL.  CONTEXT is a Z3 context, MEMORY a memory of judgements or NIL."
  (nth-value 1 (judged-steps domain (initial-observation domain run) (refreshed-steps domain run)
                             :context context :memory memory)))

(defun agreement (domain run context &optional memory)
  "Return how far the theory of DOMAIN agrees with RUN: twice the number of the steps before the
first divergence, one more if at that step the outcome agrees and the state does not.  CONTEXT and
MEMORY are as for FIRST-DIVERGENCE."
  (let ((divergence (first-divergence domain run context memory)))
    (cond ((null divergence) (* 2 (1+ (length (run-steps run)))))
          ((eq (divergence-kind divergence) :outcome) (* 2 (divergence-step divergence)))
          (t (1+ (* 2 (divergence-step divergence)))))))

(defun over-p (deadline)
  "Return true if DEADLINE, a time (s) or NIL for never, has passed."
  (and deadline (> (foreign:monotonic-seconds) deadline)))

(defun agreements (domain runs context memory &optional deadline)
  "Return how far the theory of DOMAIN agrees with each of RUNS, in order, and true; NIL and NIL if
that is not known by the DEADLINE."
  (values (loop for run in runs
                when (over-p deadline) do (return-from agreements (values '() nil))
                collect (agreement domain run context memory))
          t))

(defun event-possible-p (domain event context)
  "Return true if the theory of DOMAIN allows EVENT in some state, an initial one or not."
  (call-with-any-state
   domain context
   (lambda (solver state)
     (multiple-value-bind (next conditions)
         (ec:progress state (ec:event-number (symbolic:action-theory-ground domain) event))
       (declare (ignore next))
       (consistent-p solver (mapcar #'cdr conditions))))))

(defun requirements-possible-p (domain edit transition context)
  "Return true if the requirements of EDIT, for the action of TRANSITION, leave DOMAIN, which is
edited, a state in which the action can succeed."
  (or (null (edit-requirements edit))
      (event-possible-p domain (transition-success transition) context)))

(defun checked-edit (domain parts transition run runs agreed context &optional deadline)
  "Return the EDIT of PARTS (kind sentences replaced requirements ranges support) of DOMAIN, checked
against RUNS, or NIL if it makes no theory, or one in which the action of TRANSITION can never
succeed, or the check takes longer than to the DEADLINE.  AGREED tells how far the theory agrees
with RUNS now; RUN, one of RUNS, is that of the discrepancy."
  (destructuring-bind (kind sentences replaced &optional requirements ranges support) parts
    (flet ((edit (&rest figures)
             (apply #'make-edit :kind kind :sentences sentences :replaced replaced
                                :requirements requirements :ranges ranges :support support
                                :runs (length runs) figures)))
      (let ((edited (handler-case (edited-domain domain (edit))
                      (ec:theory-error () nil)))
            (place (position run runs)))
        (when (and edited (requirements-possible-p edited (edit) transition context))
          (multiple-value-bind (now known)
              (agreements edited runs context (make-memory) deadline)
            (when known
              (edit :removes-p (> (nth place now) (nth place agreed))
                    :contradicted (loop for before in agreed for after in now
                                        count (< after before))))))))))

(defun speaks-of-elements-p (edit)
  "Return true if a requirement of EDIT has elements of the theory in it."
  (some (lambda (requirement)
          (or (mentions-element-p (requirement-pattern requirement))
              (mentions-element-p (requirement-formula requirement))))
        (edit-requirements edit)))

(defun edit-weight (edit)
  "Return a number that is less for the better of two edits that remove a discrepancy and contradict
nothing: what is determined comes before what is left open, what is short before what is long, what
holds for all elements before what speaks of some."
  (labels ((size (form) (if (consp form)
                            (+ 1 (size (car form)) (size (cdr form)))
                            0)))
    (+ (ecase (edit-kind edit)
         ((:effect :requirement) (if (speaks-of-elements-p edit) 500 0))
         (:weaken 1000)
         (:region (if (find :unless (edit-requirements edit) :key #'requirement-mode) 1750 1500))
         ((:release :may-fail) 2000)
         (:guess 3000))
       (if (edit-requirements edit)
           (reduce #'+ (edit-requirements edit)
                   :key (lambda (requirement) (size (requirement-formula requirement))))
           (size (edit-sentences edit))))))

(defun better-edit-p (edit other)
  "Return true if EDIT is better than OTHER: it removes the discrepancy, contradicts fewer runs, or
says more."
  (flet ((key (edit)
           (list (if (edit-removes-p edit) 0 1) (edit-contradicted edit) (edit-weight edit))))
    (loop for one in (key edit)
          for two in (key other)
          do (cond ((< one two) (return t))
                   ((> one two) (return nil))))))

(defun divergence-of-effects (domain run context)
  "Return the first divergence of RUN by the theory of DOMAIN without its sentences about states, or
NIL: where an effect leads to a state that these forbid, it is seen which."
  (first-divergence (edited-domain domain (make-edit
                                           :kind :weaken
                                           :replaced (mapcar #'ec:axiom-name
                                                             (ec:state-axioms
                                                              (symbolic:action-theory-theory
                                                               domain)))))
                    run context))

(defun edits-of-effects (domain transitions transition run divergence context)
  "Return the parts of edits for DIVERGENCE of RUN, that the success of TRANSITION is forbidden: if
the reason is a state that its effects would lead to."
  (let ((effects (and (transition-succeeded-p transition)
                      (divergence-of-effects domain run context))))
    (when (and effects (eq (divergence-kind effects) :state)
               (= (divergence-step effects) (divergence-step divergence)))
      (state-edits domain transitions transition effects))))

(defun edit-parts-for (domain transition run runs agreed deciding divergence context)
  "Return the parts (kind sentences replaced requirements ranges support) of edits for DIVERGENCE of
RUN at TRANSITION, best first; RUNS are those to learn from, AGREED tells how far the theory agrees
with them, and DECIDING is as for REGION-EDITS."
  (let ((transitions (loop for run in runs append (remove nil (run-transitions domain run)))))
    (append (region-edits domain transition divergence run runs agreed deciding)
            (if (eq (divergence-kind divergence) :outcome)
                (append (edits-of-effects domain transitions transition run divergence context)
                        (outcome-edits domain transitions transition context))
                (state-edits domain transitions transition divergence)))))

(defun edits-for-run (domain run runs context &key deciding deadline)
  "Return the checked edits of DOMAIN for the first divergence of RUN, one of RUNS, best first:
those whose check is done by the DEADLINE, a time (s) or NIL.  DECIDING is as for REGION-EDITS."
  (let* ((divergence (first-divergence domain run context))
         (transition (and divergence
                          (nth (divergence-step divergence) (run-transitions domain run)))))
    (multiple-value-bind (agreed known)
        (if transition
            (agreements domain runs context (make-memory) deadline)
            (values '() nil))
      (when known
        (stable-sort
         (loop with checked = 0
               for parts in (remove-duplicates (edit-parts-for domain transition run runs agreed
                                                               deciding divergence context)
                                               :test #'equalp :from-end t)
               for edit = (and (not (over-p deadline))
                               (checked-edit domain parts transition run runs agreed context
                                             deadline))
               when edit
                 collect edit and do (incf checked)
               until (= checked *edits-checked*))
         #'better-edit-p)))))

(defun plain-runs (entries)
  "Return the runs in ENTRIES, a list of runs and of (run . judgement)."
  (loop for entry in entries collect (if (consp entry) (car entry) entry)))

(defun without-futile (edits)
  "Return EDITS without those that do not remove the discrepancy, if others do."
  (if (some #'edit-removes-p edits)
      (remove-if-not #'edit-removes-p edits)
      edits))

(defun without-guesses (edits)
  "Return EDITS, best first, without the guesses where something better removes the discrepancy and
contradicts nothing; else with the best two."
  (flet ((guess-p (edit) (eq (edit-kind edit) :guess)))
    (if (some (lambda (edit)
                (and (not (guess-p edit)) (edit-removes-p edit) (zerop (edit-contradicted edit))))
              edits)
        (remove-if #'guess-p edits)
        (let ((more (nthcdr 2 (remove-if-not #'guess-p edits))))
          (remove-if (lambda (edit) (member edit more)) edits)))))

(defun candidate-edits (discrepancy &key (runs (append (discrepancy-runs discrepancy)
                                                       (discrepancy-other-runs discrepancy)))
                                      deciding guesses max-seconds)
  "Return the list of the EDITs of the theory that DISCREPANCY calls for, the best one first, each
checked by judging again RUNS, a list of valid runs or of (RUN . JUDGEMENT) in the same domain, and
the run of DISCREPANCY itself.  By default RUNS are those that the search had made, of this trace
and of earlier ones.  DECIDING is a list of (parameter . value) of what is known to decide: with the
value, all else as in DISCREPANCY, theory and simulation agree.  With GUESSES preconditions of what
has succeeded in no run are not left out; those that do not remove the discrepancy are, if others
do.  What is not checked within MAX-SECONDS (NIL: no limit) is not in the list."
  (let* ((deadline (and max-seconds (+ (foreign:monotonic-seconds) max-seconds)))
         (run (discrepancy-run discrepancy))
         (runs (adjoin run (plain-runs runs)))
         (edits (z3:with-context (context)
                  (edits-for-run (discrepancy-domain discrepancy) run runs context
                                :deciding deciding :deadline deadline))))
    (without-futile (if guesses edits (without-guesses edits)))))
