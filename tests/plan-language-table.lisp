;;;; docs/plan-language.md is executed: each row of its tables is a test.
;;;;
;;;; A table whose third column is headed `form` or `at the prompt` has rows of five cells: the
;;;; operator, what is asked, the form, its outcome and the log.  The document says what they mean
;;;; and has a block of Lisp with the helpers that the forms use.  A row whose question does not end
;;;; with "(alone)" is evaluated a second time beside an idle task, so that all its tasks have
;;;; strands of their own, and twice with another seed: the outcome is a function of the seed.

(in-package #:discrepancy-finder.tests)

(def-suite plan-language-table :in all)
(in-suite plan-language-table)

(defun plan-language-document ()
  (uiop:read-file-lines (root-file "docs/plan-language.md")))

;;; Reading

(defstruct row
  "A row of a table.  PROMPT is true if its form is not to be put into a top-level."
  line operator question form outcome log prompt)

(defun table-cells (line)
  "Return the list of the cells of LINE of a table, without blanks around and backquotes."
  (mapcar (lambda (cell) (string-trim " " cell))
          (butlast (rest (uiop:split-string line :separator "|")))))

(defun without-backquotes (cell)
  (string-trim "`" cell))

(defun row-from (cells number prompt)
  (destructuring-bind (operator question . code) cells
    (destructuring-bind (form outcome log) (mapcar #'without-backquotes code)
      (make-row :line number :operator operator :question question
                :form form :outcome outcome :log log :prompt prompt))))

(defun table-rows (lines)
  "Return the rows to be executed of the document LINES, and the list of the numbers of lines that
look like a row but are none."
  (let ((kind nil) (rows '()) (malformed '()))
    (loop for line in lines
          for number from 1
          for cells = (and (uiop:string-prefix-p "|" line) (table-cells line))
          do (cond ((null cells) (setf kind nil))
                   ((null kind)
                    (setf kind (cond ((equal "form" (third cells)) :top-level)
                                     ((equal "at the prompt" (third cells)) :prompt)
                                     (t :other))))
                   ((eq kind :other))
                   ((uiop:string-prefix-p "---" (first cells)))
                   ((/= 5 (length cells)) (push number malformed))
                   (t (push (row-from cells number (eq kind :prompt)) rows))))
    (values (nreverse rows) malformed)))

(defun lisp-block (lines)
  "Return the text of the first block of Lisp of the document LINES."
  (let ((beginning (member "```lisp" lines :test #'string=)))
    (format nil "~{~a~%~}" (ldiff (rest beginning)
                                  (member "```" beginning :test #'string=)))))

(defun call-as-user (function)
  "Call FUNCTION as if the user was at the prompt.  Compiler notes and warnings are of no interest:
rows show what is wrong on purpose, too."
  (let ((*package* (find-package '#:discrepancy-finder-user))
        (*read-default-float-format* 'double-float)
        (*print-case* :downcase) (*print-pretty* nil) (*print-length* nil) (*print-level* nil)
        (*error-output* (make-broadcast-stream)))
    (handler-bind ((warning #'muffle-warning))
      (funcall function))))

(defvar *helpers* nil
  "The text of the document's helpers that are loaded.")

(defun load-helpers (lines)
  (let ((text (lisp-block lines)))
    (unless (equal text *helpers*)
      (call-as-user (lambda ()
                      (with-input-from-string (stream text)
                        (loop for form = (read stream nil stream)
                              until (eq form stream)
                              do (eval form)))))
      (setf *helpers* text))))

;;; Executing

(defun values-text (values)
  (if values (format nil "~{~s~^ ~}" values) "no values"))

(defun outcome-of (function)
  "Call FUNCTION and return what its row would show: the outcome and the log."
  (funcall 'discrepancy-finder-user::reset)
  (let ((outcome (call-as-user
                  (lambda ()
                    (handler-case (values-text (multiple-value-list (funcall function)))
                      ((or serious-condition plan:policy-condition) (condition)
                        (format nil "signals ~s" (type-of condition))))))))
    (list outcome
          (call-as-user (lambda ()
                          (format nil "~{~s~^ ~}"
                                  (reverse (symbol-value
                                            'discrepancy-finder-user::*log*))))))))

(defun row-function (row)
  (call-as-user (lambda ()
                  (compile nil `(lambda () ,(read-from-string (row-form row)))))))

(defun row-alone-p (row)
  (uiop:string-suffix-p (row-question row) "(alone)"))

(defun expected-outcome (row)
  (list (row-outcome row) (row-log row)))

(defun in-top-level (function)
  (lambda () (plan:top-level (funcall function))))

(defun beside-an-idle-task (function)
  (lambda () (plan:top-level (plan:pursue (funcall function)
                                          (plan:wait-for (plan:make-fluent))))))

(defun with-seed (seed function)
  (lambda () (let ((plan:*scheduling-seed* seed)) (funcall function))))

(defun mismatch-text (row how found expected)
  (format nil "line ~d~a: ~a~%  is      ~{~a, log ~a~}~%  and not ~{~a, log ~a~}"
          (row-line row) how (row-form row) found expected))

(defun row-mismatches (row)
  "Evaluate ROW in all ways that it is to be evaluated in, and return a list of texts that say what
was not as the row says."
  (let ((function (row-function row)) (mismatches '()))
    (flet ((try (how function expected)
             (let ((found (outcome-of function)))
               (unless (equal expected found)
                 (push (mismatch-text row how found expected) mismatches)))))
      (cond ((row-prompt row) (try "" function (expected-outcome row)))
            (t
             (try "" (in-top-level function) (expected-outcome row))
             (unless (row-alone-p row)
               (try " beside an idle task" (beside-an-idle-task function) (expected-outcome row))
               (let ((seeded (with-seed 7 (beside-an-idle-task function))))
                 (try " again with the same seed" seeded (outcome-of seeded)))))))
    (nreverse mismatches)))

(defun table-mismatches (lines)
  (load-helpers lines)
  (mapcan #'row-mismatches (table-rows lines)))

;;; The tests

(test every-row-of-the-tables-is-true
  (let ((lines (plan-language-document)))
    (load-helpers lines)
    (multiple-value-bind (rows malformed) (table-rows lines)
      (is (null malformed) "not five cells in the lines ~a" malformed)
      (dolist (row rows)
        (let ((mismatches (row-mismatches row)))
          (is (null mismatches) "~{~a~^~%~}" mismatches))))))

(defun changed-row-mismatches (column text)
  "Return the mismatches of the document with the cell COLUMN of the row for which par's result is
asked replaced by TEXT, and the number of its line."
  (let* ((lines (plan-language-document))
         (row (find-if (lambda (row) (and (equal "`par`" (row-operator row))
                                          (equal "result" (row-question row))))
                       (table-rows lines)))
         (cells (table-cells (elt lines (1- (row-line row))))))
    (setf (elt cells column) text)
    (load-helpers lines)
    (values (table-mismatches
             (append (make-list (- (row-line row) 3) :initial-element "")
                     (list "| operator | asked | form | outcome | log |"
                           "|---|---|---|---|---|"
                           (format nil "|~{ ~a |~}" cells))))
            (row-line row))))

(test a-changed-row-is-noticed
  (loop for (column text) in '((2 "`(par 1 2)`") (3 "`7`") (4 "`:something`"))
        do (multiple-value-bind (mismatches line) (changed-row-mismatches column text)
             (is (= 2 (length mismatches)))
             (is (search (format nil "line ~d" line) (first mismatches))))))

(defparameter *operators-and-questions*
  '(("top-level" "result" "failure")
    ("named-top-level" "result" "failure")
    ("def-top-level-cram-function" "result" "failure")
    ("seq" "result" "failure" "evaporation" "suspension")
    ("par" "result" "failure" "evaporation" "suspension")
    ("pursue" "result" "failure" "evaporation" "suspension")
    ("try-all" "result" "failure" "evaporation" "suspension")
    ("try-in-order" "result" "failure" "evaporation" "suspension")
    ("try-each-in-order" "result" "failure" "evaporation" "suspension")
    ("partial-order" "result" "failure" "evaporation" "suspension")
    ("par-loop" "result" "failure" "evaporation" "suspension")
    ("with-tags" "result" "failure" "evaporation" "suspension")
    (":tag" "result" "failure" "evaporation" "suspension")
    ("with-task-suspended" "result" "failure" "evaporation" "suspension")
    ("suspend" "result" "suspension") ("wake-up" "result") ("evaporate" "result" "evaporation")
    ("unwind-protect" "result" "failure" "evaporation" "suspension")
    ("on-suspension" "result" "failure" "evaporation" "suspension")
    ("retry-after-suspension" "result" "failure" "evaporation" "suspension")
    ("without-scheduling" "result" "failure" "evaporation" "suspension")
    ("status" "result" "failure" "evaporation" "suspension")
    ("result" "result" "failure" "evaporation")
    ("def-cram-function" "result" "failure" "evaporation" "suspension")
    ("def-plan" "result" "failure") ("declare-goal" "result" "failure")
    ("def-goal" "result" "failure" "evaporation" "suspension")
    ("with-policy" "result" "failure" "evaporation" "suspension")
    ("with-policies" "result" "failure") ("with-named-policy" "result" "failure")
    ("timeout-policy" "result" "failure")
    ("fail" "result" "failure")
    ("with-failure-handling" "result" "failure" "evaporation" "suspension")
    ("retry" "result") ("with-retry-counters" "result" "failure" "evaporation" "suspension")
    ("do-retry" "result") ("get-counter" "result") ("reset-counter" "result")
    ("*break-on-plan-failures*" "result") ("make-fluent" "result") ("value" "result")
    ("pulse" "result") ("pulsed" "result")
    ("fl<" "result") ("fl>" "result") ("fl=" "result") ("fl+" "result") ("fl-" "result")
    ("fl*" "result") ("fl/" "result") ("fl-eq" "result") ("fl-eql" "result") ("fl-not" "result")
    ("fl-and" "result") ("fl-or" "result") ("fl-pulsed" "result") ("fl-funcall" "result")
    ("fl-apply" "result") ("fl-value-changed" "result")
    ("wait-for" "result" "failure" "evaporation" "suspension" "timeout")
    ("whenever" "result" "failure" "evaporation" "suspension")
    ("sleep" "result" "evaporation" "suspension")
    ("perform" "result" "failure" "evaporation" "suspension")
    ("def-process-module" "result" "failure" "evaporation" "suspension")
    ("pm-execute" "result" "failure") ("with-process-modules-running" "result" "failure")
    ("on-event" "result") ("holds" "result" "failure"))
  "What the tables must have rows for.")

(defun question-asked-p (question row)
  (uiop:string-prefix-p question (row-question row)))

(test the-tables-are-complete
  (let ((rows (table-rows (plan-language-document))))
    (loop for (operator . questions) in *operators-and-questions*
          for own = (remove (format nil "`~a`" operator) rows
                            :key #'row-operator :test #'string/=)
          do (dolist (question questions)
               (is (some (lambda (row) (question-asked-p question row)) own)
                   "no row says what the ~a of ~a is" question operator)))))
