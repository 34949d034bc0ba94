;;;; Coverage: what an exploration has made use of, of plans, action bindings and theory.
;;;;
;;;; COVERAGE returns a value object made from the recorder of an exploration.  Counted are the
;;;; forms that the evaluator knows, of all plans and helpers in the files that the exploration
;;;; has run; the ways of conditions; the outcomes of the domain's action bindings; the axioms.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (covered-form (:copier nil))
  "A FORM of a plan and its POSITION.  STATE is :COVERED, :ONE-BRANCH if a condition in it was never
true or never false, or :NEVER."
  (form nil :type cons :read-only t)
  (position nil :read-only t)
  (state :never :type (member :covered :one-branch :never) :read-only t))

(setf (documentation 'covered-form-form 'function)
      "Return the form, as it was read."
      (documentation 'covered-form-position 'function)
      "Return the source position of a form."
      (documentation 'covered-form-state 'function)
      "Return :COVERED, :ONE-BRANCH (evaluated, but a condition in it was never true or never false)
or :NEVER.")

(defmethod print-object ((form covered-form) stream)
  (print-unreadable-object (form stream :type t)
    (format stream "~a ~(~a~)" (covered-form-position form) (covered-form-state form))))

(defstruct (coverage (:constructor %make-coverage) (:copier nil))
  "What an exploration of PLAN in DOMAIN has made use of.  FORMS are in the order of the files.
BRANCHES is (taken . all) ways of conditions.  OUTCOMES and AXIOMS are lists of (name . covered),
the names of outcomes texts."
  (plan nil :type symbol :read-only t)
  (domain nil :type keyword :read-only t)
  (forms '() :type list :read-only t)
  (branches '(0 . 0) :type cons :read-only t)
  (outcomes '() :type list :read-only t)
  (axioms '() :type list :read-only t))

(setf (documentation 'coverage-forms 'function)
      "Return the list of the COVERED-FORMs of a coverage, in the order of the files."
      (documentation 'coverage-outcomes 'function)
      "Return a list of (text . taken) for the outcomes of all action bindings of the domain."
      (documentation 'coverage-axioms 'function)
      "Return a list of (name . exercised) for the axioms of the theory, the names keywords.")

(defun covered-count (entries)
  (count-if #'cdr entries))

(defun coverage-figures (coverage)
  "Return the figures of COVERAGE as a property list: :FORMS, :BRANCHES, :OUTCOMES and :AXIOMS, each
a list of how many were covered and how many there are."
  (let ((forms (coverage-forms coverage)))
    (flet ((figures (entries) (list (covered-count entries) (length entries))))
      (list :forms (list (count :never forms :key #'covered-form-state :test-not #'eq)
                         (length forms))
            :branches (list (car (coverage-branches coverage)) (cdr (coverage-branches coverage)))
            :outcomes (figures (coverage-outcomes coverage))
            :axioms (figures (coverage-axioms coverage))))))

(defun never-taken-outcomes (coverage)
  "Return the list of the texts of the outcomes that no path of COVERAGE takes."
  (mapcar #'car (remove-if #'cdr (coverage-outcomes coverage))))

(defun never-exercised-axioms (coverage)
  "Return the list of the names, keywords, of the axioms that no step of COVERAGE makes use of."
  (mapcar #'car (remove-if #'cdr (coverage-axioms coverage))))

(defmethod print-object ((coverage coverage) stream)
  (print-unreadable-object (coverage stream :type t)
    (write-string (figures-text coverage) stream)))

(defun figures-text (coverage)
  (format nil "~{~{~d of ~d ~a~}~^, ~}"
          (loop for (key figures) on (coverage-figures coverage) by #'cddr
                collect (append figures (list (string-downcase key))))))

;;; Making one

(defun record-state (record)
  (cond ((not (form-record-covered record)) :never)
        ((every (lambda (branch) (and (car branch) (cdr branch))) (form-record-branches record))
         :covered)
        (t :one-branch)))

(defun record< (one other)
  "Return true if the form of ONE comes before that of OTHER: by file, line, and from outside in."
  (flet ((file (record) (source:source-position-file (form-record-position record)))
         (line (record) (source:source-position-line (form-record-position record))))
    (cond ((string/= (file one) (file other)) (and (string< (file one) (file other)) t))
          ((/= (line one) (line other)) (< (line one) (line other)))
          (t (< (form-record-number one) (form-record-number other))))))

(defun analyze-neighbours (recorder)
  "Let RECORDER know the forms of the plans that were never called and stand in the same files."
  (let ((*recorder* recorder)
        (files (remove-duplicates
                (loop for record being the hash-values of (recorder-records recorder)
                      collect (source:source-position-file (form-record-position record)))
                :test #'equal)))
    (dolist (plan (plan:plans-in-files files))
      (handler-case (interpreted-plan plan)
        (unsupported-form () nil)))))

(defun domain-outcomes (domain recorder)
  "Return a list of (text . taken) for the outcomes of the action bindings of DOMAIN."
  (loop for binding in (reverse (action-theory-actions domain))
        append (loop for name in (action-binding-outcomes binding)
                     for number from 0
                     collect (cons (format nil "~a: ~a" (binding-text binding) (ec:name-text name))
                                   (and (member (list* (action-binding-class binding)
                                                       (action-binding-type binding) number)
                                                (recorder-outcomes recorder) :test #'equal)
                                        t)))))

(defun coverage (exploration)
  "Return the COVERAGE of EXPLORATION, which was made with the option :COVERAGE T, so far.  Signals
COVERAGE-NOT-RECORDED."
  (let ((recorder (exploration-recorder exploration))
        (domain (exploration-domain exploration)))
    (unless recorder
      (error 'coverage-not-recorded :plan (plan:plan-name (exploration-plan exploration))))
    (analyze-neighbours recorder)
    (let* ((records (sort (alexandria:hash-table-values (recorder-records recorder)) #'record<))
           (branches (mapcan (lambda (record) (copy-list (form-record-branches record))) records)))
      (%make-coverage
       :plan (plan:plan-name (exploration-plan exploration))
       :domain (action-theory-name domain)
       :forms (loop for record in records
                    collect (make-covered-form :form (form-record-form record)
                                               :position (form-record-position record)
                                               :state (record-state record)))
       :branches (cons (loop for (true . false) in branches
                             sum (+ (if true 1 0) (if false 1 0)))
                       (* 2 (length branches)))
       :outcomes (domain-outcomes domain recorder)
       :axioms (loop for axiom in (ec:theory-axioms (action-theory-theory domain))
                     collect (cons (ec:axiom-name axiom)
                                   (and (member axiom (recorder-axioms recorder)) t)))))))
