;;;; Coverage as text: the lines of the plan files, each with a mark.

(in-package #:discrepancy-finder.symbolic-execution)

(defun coverage-files (coverage)
  "Return the list of the files of the forms of COVERAGE, in order."
  (remove-duplicates (mapcar (lambda (form)
                               (source:source-position-file (covered-form-position form)))
                             (coverage-forms coverage))
                     :test #'equal :from-end t))

(defun forms-in-file (coverage file)
  (remove file (coverage-forms coverage) :test-not #'equal
          :key (lambda (form) (source:source-position-file (covered-form-position form)))))

(defun file-lines (file)
  "Return the list of the lines of FILE, or NIL if it is not there any more."
  (and (uiop:file-exists-p (source:native-path file))
       (uiop:read-file-lines (source:native-path file) :external-format :utf-8)))

(defun line-mark (forms line)
  "Return the mark of LINE: what is to be said of those of FORMS that begin on it."
  (let ((states (loop for form in forms
                      when (= line (source:source-position-line (covered-form-position form)))
                        collect (covered-form-state form))))
    (cond ((null states) #\Space)
          ((every (lambda (state) (eq state :never)) states) #\-)
          ((every (lambda (state) (eq state :covered)) states) #\+)
          (t #\~))))

(defun print-entries (title entries text stream)
  (when entries
    (format stream "~%~a~%" title)
    (loop for (entry . covered) in entries
          do (format stream "  ~:[-~;+~] ~a~%" covered (funcall text entry)))))

(defun print-coverage (coverage &optional (stream *standard-output*))
  "Print COVERAGE to STREAM: the figures; the plan files with a mark before each line on which forms
begin, + if all of these were evaluated in all ways, - if none was evaluated, ~ otherwise; the
outcomes of actions and the axioms, + if they were taken or exercised, else -."
  (format stream "Coverage of ~(~a~) in ~a: ~a~%" (coverage-plan coverage)
          (ec:name-text (coverage-domain coverage)) (figures-text coverage))
  (dolist (file (coverage-files coverage))
    (let ((forms (forms-in-file coverage file)))
      (format stream "~%~a~%" file)
      (loop for line in (file-lines file)
            for number from 1
            do (format stream "~a~%"
                     (string-right-trim " " (format nil "~5d ~a ~a" number
                                                    (line-mark forms number) line))))))
  (print-entries "Outcomes" (coverage-outcomes coverage) #'identity stream)
  (print-entries "Axioms" (coverage-axioms coverage) #'ec:name-text stream)
  (values))
