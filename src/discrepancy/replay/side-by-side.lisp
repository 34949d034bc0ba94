;;;; Side by side: what the theory says and what the simulation does, action by action.
;;;;
;;;; A COLUMN tells one side's values of the fluents; values are T, NIL, :OPEN (the theory allows
;;;; both) and :UNKNOWN (the fluent cannot be observed, or one side has stopped).  After each action
;;;; the table has the fluents that have changed or differ; the latter are marked with *.  Entry
;;;; points: SIDE-BY-SIDE-TEXT for a whole run, STEP-TEXT-OF for an action.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (case-run (:copier nil))
  "What is told side by side: RUN, made for TRACE in DOMAIN, with its STEP-COMPARISONS."
  (domain nil :read-only t)
  (trace nil :read-only t)
  (run nil :read-only t)
  (comparisons '() :type list :read-only t))

(defun compared-run (domain trace run comparison)
  "Return the CASE-RUN of RUN; COMPARISON is as for JUDGE-RUN."
  (make-case-run :domain domain :trace trace :run run
                 :comparisons (if (eq (run-validity run) :valid)
                                  (step-comparisons domain run trace :comparison comparison)
                                  '())))

(defun value-in (atom values)
  "Return the value of ATOM in VALUES, a list of (atom . value), or :UNKNOWN."
  (let ((entry (assoc atom values :test #'equal)))
    (if entry (cdr entry) :unknown)))

(defun trace-value (trace number atom)
  "Return the value of ATOM in the state number NUMBER of TRACE, or :UNKNOWN."
  (let ((state (nth number (symbolic:trace-states trace))))
    (if state
        (let ((value (ec:fluent-value state atom)))
          (if (typep value 'boolean) value :open))
        :unknown)))

(defun on-trace-p (case number)
  "Return true if the steps before NUMBER of the run of CASE are those of its trace, as far as the
run goes."
  (loop for step in (run-steps (case-run-run case))
        for expected in (symbolic:trace-steps (case-run-trace case))
        repeat number
        always (same-step-p step expected)))

(defun theory-at (case number atom)
  "Return what the theory says of ATOM after NUMBER steps of CASE."
  (let* ((comparison (and (plusp number) (nth (1- number) (case-run-comparisons case))))
         (value (if comparison
                    (value-in atom (step-comparison-theory comparison))
                    :unknown)))
    (cond ((not (eq value :unknown)) value)
          ((or (null comparison)
               (on-trace-p case (if (eq (step-comparison-verdict comparison) :outcome-forbidden)
                                    (1- number) ; instead, the theory has what the trace has
                                    number)))
           (trace-value (case-run-trace case) number atom))
          (t :unknown))))

(defun simulation-at (case number atom)
  "Return the value of ATOM that was observed after NUMBER steps of CASE."
  (let* ((run (case-run-run case))
         (step (and (plusp number) (nth (1- number) (run-steps run)))))
    (value-in atom (cond ((zerop number) (run-initial-state run))
                         (step (run-step-state step))))))

(defun rows-at (case number)
  "Return the list of (atom theory-value simulation-value) after NUMBER steps of CASE."
  (loop for atom across (ec:ground-theory-fluents
                         (symbolic:action-theory-ground (case-run-domain case)))
        collect (list atom (theory-at case number atom) (simulation-at case number atom))))

(defun differing-row-p (row)
  (destructuring-bind (atom theory simulation) row
    (declare (ignore atom))
    (and (typep theory 'boolean) (typep simulation 'boolean) (not (eq theory simulation)))))

(defun true-row-p (row)
  (or (member t (rest row)) (differing-row-p row)))

(defun changed-row-p (row before)
  "Return true if ROW differs, or one side has changed since the row BEFORE."
  (or (differing-row-p row)
      (loop for value in (rest row)
            for old in (rest before)
            thereis (not (or (eq value old) (eq value :unknown) (eq old :unknown))))))

;;; As text

(defun column-text (value)
  (ecase value
    ((t) "true")
    ((nil) "false")
    (:open "open")
    (:unknown "-")))

(defun row-width (case)
  "Return the width of the column with the fluents of CASE."
  (loop for atom across (ec:ground-theory-fluents
                         (symbolic:action-theory-ground (case-run-domain case)))
        maximize (length (ec:atom-text atom))))

(defun write-rows (case rows stream)
  (let ((width (row-width case)))
    (when rows
      (format stream "       ~va  theory  simulation~%" width ""))
    (dolist (row rows)
      (destructuring-bind (atom theory simulation) row
        (format stream "     ~:[ ~;*~] ~va  ~6a  ~a~%" (differing-row-p row) width
                (ec:atom-text atom) (column-text theory) (column-text simulation))))))

(defun simulation-text (case number)
  "Return what the simulation of CASE has made of the step NUMBER, counted from 0."
  (let* ((run (case-run-run case))
         (step (nth number (run-steps run)))
         (comparison (nth number (case-run-comparisons case)))
         (expected (nth number (symbolic:trace-steps (case-run-trace case)))))
    (if (null step)
        "not performed"
        (format nil "~:[success~;~:*~a~]~a" (run-step-failure step)
                (ecase (if comparison (step-comparison-verdict comparison) :not-judged)
                  (:agrees (if (and expected (not (same-step-p step expected)))
                               "; the theory allows it, but this is not the trace any more"
                               ""))
                  (:outcome-forbidden "; THE THEORY FORBIDS THIS OUTCOME")
                  (:state-forbidden "; THE THEORY FORBIDS THE STATE AFTER IT")
                  (:not-judged ""))))))

(defun beginning-text (case)
  "Return the table of the initial state of CASE: what is true."
  (with-output-to-string (stream)
    (format stream "  initially~%")
    (write-rows case (remove-if-not #'true-row-p (rows-at case 0)) stream)))

(defun step-text-of (case number)
  "Return the text of the step NUMBER, counted from 0, of CASE: the action, its outcome on both
sides, and the table of the fluents that have changed or differ."
  (let ((step (nth number (run-steps (case-run-run case))))
        (expected (nth number (symbolic:trace-steps (case-run-trace case)))))
    (with-output-to-string (stream)
      (format stream "  ~d. ~a~%     theory:     ~a~%     simulation: ~a~%" (1+ number)
              (if step (run-step-designator step) (symbolic:step-designator expected))
              (if expected (symbolic:step-text expected) "the trace has ended")
              (simulation-text case number))
      (write-rows case
                  (loop for row in (rows-at case (1+ number))
                        for before in (rows-at case number)
                        when (changed-row-p row before) collect row)
                  stream))))

(defun side-by-side-text (case)
  "Return the text of CASE, a CASE-RUN: the initial state and each action, on both sides."
  (format nil "~a~{~a~}" (beginning-text case)
          (loop for number below (max (length (run-steps (case-run-run case)))
                                      (length (symbolic:trace-steps (case-run-trace case))))
                collect (step-text-of case number))))
