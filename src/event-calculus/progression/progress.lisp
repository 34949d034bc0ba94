;;;; Progression: what is true after known events.
;;;;
;;;; PROGRESS makes the next state and returns what must be true for that step to be possible: that
;;;; no effects conflict and that the sentences are true whose last timepoint this is.  Constants
;;;; are folded: where everything is known Z3 is not needed.  Entry points: INITIAL-CONDITIONS,
;;;; PROGRESS.

(in-package #:discrepancy-finder.event-calculus)

;;; Judging

(defun judge-demand (step demand base)
  (require-condition step (demand-axiom demand) (evaluate step (demand-formula demand) base)))

(defun judge-pending (step next)
  "Judge what is pending and due at NEXT; the rest stays pending."
  (setf (state-pending next)
        (loop for entry in (append (step-pending step) (state-pending (step-state step)))
              for (due axiom . formula) = entry
              if (<= due (state-time next))
                do (require-condition step axiom (evaluate step formula 0))
              else
                collect entry)))

(defun judge-step (step events)
  "Judge the demands that look at more than one timepoint and end with the next state of STEP."
  (let* ((outline (step-outline step))
         (demands-of (outline-event-demands-of outline))
         (single (null (rest events)))
         (judged '())
         (end (1+ (step-time step))))
    (loop for (number) in events
          do (dolist (demand (svref demands-of number))
               (unless (and (not single) (member demand judged))
                 (unless single (push demand judged))
                 (judge-demand step demand (step-time step)))))
    (dolist (demand (outline-other-demands outline))
      (let ((base (- end (demand-last demand))))
        (when (>= base (outline-first-time outline))
          (judge-demand step demand base))))))

(defun judge-changed-fluents (step next)
  "Judge the demands on the state NEXT whose fluents have changed."
  (let ((old (state-values (step-state step))) (new (state-values next))
        (demands-of (outline-state-demands-of (step-outline step))))
    (declare (type simple-vector old new demands-of))
    (flet ((changed-p (fluent) (not (eq (svref old fluent) (svref new fluent)))))
      (dotimes (fluent (length new))
        (when (changed-p fluent)
          (dolist (demand (svref demands-of fluent))
            ;; once, though several of its fluents have changed
            (when (eql fluent (find-if #'changed-p (demand-fluents demand)))
              (judge-demand step demand (state-time next)))))))))

(defun judge-dated (step time)
  (let ((outline (step-outline step)))
    (when (outline-dated-p outline)
      (dolist (demand (gethash time (dated-demands (outline-dated-until outline time))))
        (judge-demand step demand 0)))))

;;; Entry points

(defun initial-conditions (state)
  "Return what must be true of the initial STATE: a list of (axiom . proposition), the theory's
INITIALLY axioms and its sentences about single timepoints.  The axiom is an AXIOM, a list such as
(:xor name*) or (:completion predicate), or NIL where there is no single one."
  (let* ((outline (state-outline state))
         (step (make-step :state state))
         (time (state-time state))
         (judged (make-hash-table :test 'eq)))
    (dolist (sentence (ground-theory-initial-conditions (outline-ground outline)))
      (require-condition step (sentence-axiom sentence)
                         (evaluate step (sentence-formula sentence) time)))
    (dolist (demand (outline-static-demands outline)) (judge-demand step demand time))
    (loop for demands across (outline-state-demands-of outline)
          do (dolist (demand demands)
               (unless (gethash demand judged)
                 (setf (gethash demand judged) t)
                 (judge-demand step demand time))))
    (dolist (demand (outline-state-demands outline)) (judge-demand step demand time))
    (judge-dated step time)
    (nreverse (step-conditions step))))

(defun resolve-predicates (step)
  "Return a table of the predicates that have supports at the time of STEP, or NIL."
  (let ((outline (step-outline step)) (time (step-time step)))
    (loop for number being the hash-keys of (outline-predicates outline)
          do (predicate-at step number time))
    (loop for (kind number) in (dated-supports-at outline time)
          when (eq kind :predicate) do (predicate-at step number time))
    (step-predicates step)))

(defun cause-turns (outline turns)
  (and (outline-causes outline)
       (loop for turn in turns
             when (and (member (first turn) (outline-causes outline))
                       (not (eq (second turn) :ahead))
                       (or (second turn) (third turn)))
               collect (list (first turn) (second turn) (third turn)))))

(defun progress (state event)
  "Return the state after EVENT, the number of an event, NIL for none, or a list of numbers,
happened in STATE, and what must be true for that: a list of (axiom . proposition), as for
INITIAL-CONDITIONS.  The events that the theory triggers happen, too, and no others.  Signals
UNDETERMINED if the theory leaves something open and the state has no Z3 context."
  (let* ((step (make-step :state state :given (if (listp event) event (list event))))
         (outline (step-outline step))
         (events (happening-events step))
         (turns (event-turns step events))
         (next (make-state :outline outline :context (state-context state)
                           :time (1+ (state-time state)) :predecessor state
                           :statics (state-statics state) :events events
                           :turns (cause-turns outline turns)
                           :values (copy-seq (state-values state))
                           :released (if (outline-loose-fluents outline)
                                         (copy-seq (state-released state))
                                         (state-released state))
                           :numbers (copy-seq (state-numbers state))
                           :loose-numbers (copy-seq (state-loose-numbers state))))
         (mixed (set-fluents step next turns)))
    (setf (step-next step) next)
    (set-numbers step next events)
    (close-open-fluents step next mixed (apply-changes step next))
    (close-open-numbers step next)
    (when (outline-exclusions outline) (require-exclusions step events))
    (judge-step step events)
    (judge-changed-fluents step next)
    (dolist (demand (outline-state-demands outline))
      (judge-demand step demand (state-time next)))
    (judge-dated step (state-time next))
    (setf (state-predicates next) (resolve-predicates step))
    (judge-pending step next)
    (setf (state-determined-p next)
          (and (state-determined-p state) (not (step-opened-p step))))
    (values next (nreverse (step-conditions step)))))
