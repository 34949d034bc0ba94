;;;; Candidate edits, each checked by judging again all runs so far.
;;;;
;;;; CANDIDATE-EDITS is the entry point.  A run CONTRADICTS an edit if the theory agreed with it for
;;;; longer before the edit.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *edits-checked* 12
  "So many candidate edits of a discrepancy are checked at most.")

(defun refreshed-steps (domain run)
  "Return the steps of RUN with the outcomes that they can be in DOMAIN."
  (mapcar (lambda (step) (refreshed-step domain step)) (run-steps run)))

(defun first-divergence (domain run context)
  "Return the first divergence of RUN, of a domain that differs in theory and action bindings only,
by DOMAIN, or NIL.  CONTEXT is a Z3 context."
  (z3:with-released-terms (context)
    (z3:with-solver (solver context)
      (let ((state (free-state (symbolic:action-theory-ground domain) context
                               (run-initial-state run))))
        (loop for (nil . proposition) in (ec:initial-conditions state)
              do (z3:solver-assert solver proposition))
        (nth-value 1 (judge-steps domain solver state (refreshed-steps domain run) nil
                                  :consistent))))))

(defun agreed-steps (domain run context)
  "Return with how many steps of RUN the theory of DOMAIN agrees; one more than there are if it
agrees with all."
  (let ((divergence (first-divergence domain run context)))
    (if divergence
        (divergence-step divergence)
        (1+ (length (run-steps run))))))

(defun checked-edit (domain parts run runs agreed context)
  "Return the EDIT of PARTS (kind sentences replaced requirements) of DOMAIN, checked against RUNS,
or NIL if it makes no theory.  AGREED are the numbers of the steps of RUNS with which the theory
agrees now; RUN, one of RUNS, is that of the discrepancy."
  (destructuring-bind (kind sentences replaced &optional requirements) parts
    (flet ((edit (&rest figures)
             (apply #'make-edit :kind kind :sentences sentences :replaced replaced
                                :requirements requirements :runs (length runs) figures)))
      (let* ((edited (handler-case (edited-domain domain (edit))
                       (ec:theory-error () (return-from checked-edit nil))))
             (now (loop for run in runs collect (agreed-steps edited run context)))
             (place (position run runs)))
        (edit :removes-p (> (nth place now) (nth place agreed))
              :contradicted (loop for before in agreed for after in now
                                  count (< after before)))))))

(defun edit-weight (edit)
  "Return a number that is less for the better of two edits that remove a discrepancy and contradict
nothing: what is determined comes before what is left open, what is short before what is long."
  (labels ((size (form) (if (consp form)
                            (+ 1 (size (car form)) (size (cdr form)))
                            0)))
    (+ (ecase (edit-kind edit)
         ((:effect :requirement) 0)
         (:weaken 1000)
         ((:release :may-fail) 2000))
       (if (eq (edit-kind edit) :requirement)
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

(defun edit-parts-for (domain run runs divergence)
  "Return the parts (kind sentences replaced requirements) of edits for DIVERGENCE of RUN, best
first; RUNS are those to learn from."
  (let* ((number (divergence-step divergence))
         (transitions (loop for other in runs
                            append (remove nil (run-transitions domain other))))
         (transition (nth number (run-transitions domain run))))
    (cond ((null transition) '())
          ((eq (divergence-kind divergence) :outcome)
           (outcome-edits domain transitions transition))
          (t (state-edits domain transitions transition divergence)))))

(defun edits-for-run (domain run runs context)
  "Return the checked edits of DOMAIN for the first divergence of RUN, one of RUNS, best first."
  (let ((divergence (first-divergence domain run context)))
    (when divergence
      (let ((agreed (loop for run in runs collect (agreed-steps domain run context)))
            (candidates (remove-duplicates (edit-parts-for domain run runs divergence)
                                           :test #'equalp :from-end t)))
        (stable-sort (remove nil
                             (loop for parts in candidates
                                   repeat *edits-checked*
                                   collect (checked-edit domain parts run runs agreed context)))
                     #'better-edit-p)))))

(defun candidate-edits (discrepancy &key runs)
  "Return the list of the EDITs of the theory that DISCREPANCY calls for, the best one first, each
checked by judging again RUNS, a list of valid runs in the same domain, and the run of DISCREPANCY
itself; without RUNS those of the same trace that the search has made."
  (let* ((run (discrepancy-run discrepancy))
         (runs (adjoin run (or runs (known-runs discrepancy)))))
    (z3:with-context (context)
      (edits-for-run (discrepancy-domain discrepancy) run runs context))))

(defun known-runs (discrepancy)
  "Return the runs of the same trace as DISCREPANCY that the search has made."
  (if (slot-exists-p discrepancy 'runs)
      (slot-value discrepancy 'runs)
      '()))
