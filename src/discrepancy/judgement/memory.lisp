;;;; Memory: runs that are the same for the theory are judged once.
;;;;
;;;; What is judged of a run is discrete: what was observed at its beginning, and for each step the
;;;; ways in which the action can end, the one that was seen, and what was observed after it.  Runs
;;;; from samples next to each other have, as a rule, all of that in common.  A MEMORY keeps the
;;;; answers by it: a table that MAKE-MEMORY makes and JUDGED-STEPS (judgement.lisp) asks.

(in-package #:discrepancy-finder.discrepancy)

(defun make-memory ()
  (ec:make-term-table))

(defun read-back-p (step)
  "Return true if nothing but the text is known of the designator of STEP, read from a journal."
  (stringp (run-step-designator step)))

(defun outcome-key (outcome)
  (list (symbolic:outcome-name outcome) (symbolic:outcome-event outcome)
        (symbolic:outcome-condition outcome)))

(defun step-key (domain step)
  "Return what the theory of DOMAIN can tell of STEP."
  (list (run-step-outcome step)
        (mapcar #'outcome-key (run-step-candidates step))
        (unless (read-back-p step)
          (mapcar #'outcome-key (symbolic:action-outcomes domain (run-step-designator step))))
        (run-step-state step)))

(defun judging-key (domain observed steps trace)
  "Return what the judgement in DOMAIN on STEPS, which follow the state OBSERVED, depends on; with
TRACE, unless that is NIL, it is compared."
  (list domain trace observed (loop for step in steps collect (step-key domain step))))
