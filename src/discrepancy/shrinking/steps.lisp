;;;; Shrinking a trace: fewer actions, fewer items.
;;;;
;;;; What follows after theory and simulation have parted is left out first.  Then the actions are
;;;; performed without the plan, and those that the discrepancy does not need are left out.  The
;;;; theory, which costs nothing, is asked first: it says which actions are possible without others,
;;;; and which the divergent fluents need.  Simulation has the last word: the discrepancy must stay,
;;;; and samples that passed with all actions, the WITNESSES, must still pass, or else there might
;;;; be another cause, which the missing actions have prevented.  Items that no action mentions any
;;;; more are left out of the world; what the theory says of them is then unobserved.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (short-step (:copier nil))
  "A step that may be left out: the RECORDED-ACTION and the OUTCOME that the theory expects."
  (action nil :type recorded-action :read-only t)
  (outcome nil :read-only t))

(defun recorded-step-action (step)
  "Return the action of STEP, a RUN-STEP, as a RECORDED-ACTION."
  (let ((designator (run-step-designator step)))
    (make-recorded-action :description (described designator)
                          :text (princ-to-string designator)
                          :position (run-step-position step))))

(defun expected-outcome (domain step trace-step diverges)
  "Return the outcome of STEP, a RUN-STEP, that the theory of DOMAIN expects: the one that it had,
or, where it DIVERGES by that, the one of TRACE-STEP, the trace's step or NIL."
  (let ((outcomes (if diverges
                      (symbolic:action-outcomes domain (run-step-designator step))
                      (run-step-candidates step))))
    (or (find-if (lambda (outcome)
                   (and trace-step
                        (eq (symbolic:outcome-name outcome) (symbolic:step-outcome trace-step))
                        (equal (symbolic:outcome-event outcome) (symbolic:step-event trace-step))))
                 outcomes)
        (first outcomes))))

(defun short-steps (discrepancy)
  "Return the SHORT-STEPs of the run of DISCREPANCY, up to the divergence."
  (let ((divergence (judgement-divergence (discrepancy-judgement discrepancy))))
    (loop for step in (run-steps (discrepancy-run discrepancy))
          for number from 0 to (divergence-step divergence)
          collect (make-short-step
                   :action (recorded-step-action step)
                   :outcome (expected-outcome
                             (discrepancy-domain discrepancy) step
                             (nth number (symbolic:trace-steps (discrepancy-trace discrepancy)))
                             (and (= number (divergence-step divergence))
                                  (eq (divergence-kind divergence) :outcome)))))))

(defun short-trace (discrepancy steps context)
  "Return the trace of STEPS, a list of SHORT-STEPs, from the initial state of that of DISCREPANCY,
or NIL if the theory does not allow it.  CONTEXT is a Z3 context."
  (let* ((trace (discrepancy-trace discrepancy))
         (ground (symbolic:action-theory-ground (discrepancy-domain discrepancy)))
         (trace-steps (loop for step in steps
                            for outcome = (short-step-outcome step)
                            for action = (short-step-action step)
                            collect (symbolic:make-trace-step
                                     :designator (recorded-action-text action)
                                     :event (symbolic:outcome-event outcome)
                                     :outcome (symbolic:outcome-name outcome)
                                     :position (recorded-action-position action))))
         (states (symbolic:states-along ground
                                        (ec:state-fluents (symbolic:trace-initial-state trace))
                                        trace-steps :context context)))
    (when (and states
               (loop for step in steps
                     for state in states
                     always (eq t (ec:holds (symbolic:outcome-condition (short-step-outcome step))
                                            (list state)))))
      (symbolic:make-execution-trace :plan (symbolic:trace-plan trace)
                                     :arguments (symbolic:trace-arguments trace)
                                     :steps trace-steps :states states))))

(defun predicts-p (trace fluents)
  "Return true if the final state of TRACE has the values that the theory has in FLUENTS, those of a
divergence."
  (loop for (atom theory) in fluents
        always (eq theory (ec:fluent-value (symbolic:trace-final-state trace) atom))))

(defun improve-by-steps (shrinker steps)
  "Make STEPS, SHORT-STEPs, the actions of the best case if the discrepancy stays the same; return
true if it does."
  (let ((trace (short-trace (shrinker-best shrinker) steps (shrinker-context shrinker))))
    (and trace
         (improve-with-witnesses shrinker
                                 :trace trace :actions (mapcar #'short-step-action steps)))))

(defun shrink-actions (shrinker)
  "Leave out actions of the best case of SHRINKER."
  (let* ((best (shrinker-best shrinker))
         (fluents (divergence-fluents (judgement-divergence (discrepancy-judgement best))))
         (steps (short-steps best))
         (last (last steps)))
    (when (and (every #'short-step-outcome steps)
               (every (lambda (step) (writable-p (short-step-action step))) steps)
               (improve-by-steps shrinker steps))
      (let* ((foreseen (smallest-list (butlast steps)
                                      (lambda (some)
                                        (let ((trace (short-trace best (append some last)
                                                                  (shrinker-context shrinker))))
                                          (and trace (predicts-p trace fluents))))))
             (start (if (improve-by-steps shrinker (append foreseen last))
                        foreseen
                        (butlast steps))))
        (smallest-list start
                       (lambda (some) (improve-by-steps shrinker (append some last)))
                       :pairs (<= (length start) 12))))))

;;; Items

(defun mentions-p (value name)
  "Return true if NAME, a keyword, occurs in VALUE, a description or a value in one."
  (typecase value
    (description (mentions-p (description-properties value) name))
    (cons (or (mentions-p (car value) name) (mentions-p (cdr value) name)))
    (t (eq value name))))

(defun unmentioned-items (discrepancy)
  "Return the names of the items of which no action and no divergent fluent of DISCREPANCY speaks."
  (let* ((scene (domain-scene (discrepancy-domain discrepancy)))
         (trace (discrepancy-trace discrepancy))
         (spoken-of (list (mapcar #'symbolic:step-event (symbolic:trace-steps trace))
                          (mapcar #'first (divergence-fluents
                                           (judgement-divergence
                                            (discrepancy-judgement discrepancy))))
                          (loop for step in (run-steps (discrepancy-run discrepancy))
                                collect (described (run-step-designator step))))))
    (loop for item in (projection:scene-item-names scene)
          unless (or (mentions-p spoken-of item)
                     (mentions-p spoken-of (projection:scene-item-type scene item)))
            collect item)))

(defun improve-without-items (shrinker items)
  "Leave ITEMS out of the world of the best case if the discrepancy stays the same; return true if
it does."
  (let* ((best (shrinker-best shrinker))
         (domain (domain-without-items (discrepancy-domain best) items))
         (trace (discrepancy-trace best)))
    (improve-with-witnesses shrinker
                            :domain domain
                            :left-out (append (discrepancy-left-out best) items)
                            :sample (restricted-sample (discrepancy-sample best)
                                                       (initial-parameters domain trace)))))

(defun shrink-items (shrinker)
  "Leave items out of the world of the best case of SHRINKER."
  (let ((items (unmentioned-items (shrinker-best shrinker))))
    (when (and items (not (improve-without-items shrinker items)) (rest items))
      (dolist (item items)
        (improve-without-items shrinker (list item))))))
