;;;; Making the packages of the table, where CRAM is absent.
;;;;
;;;; Loading this file defines the packages of the table.  Where CRAM itself is there, that is its
;;;; package cram-language or the system of this name, it defines none: half of one plan language
;;;; and half of another are no good.  Else it leaves alone what is there of a single package: one
;;;; of its name or one of its nicknames, or CRAM's own system for it that ASDF finds.  One sentence
;;;; says so.  Loading it again changes nothing.  COMPAT-REPORT tells what was done.

(in-package #:discrepancy-finder.cram-compat)

(defvar *defined-packages* '()
  "The packages that DEFINE-PACKAGES has made in this image.")

(defvar *report* '()
  "What COMPAT-REPORT returns.")

(defun foreign-package (entry)
  "Return the package that bears the name or a nickname of ENTRY and is not of our making, or NIL."
  (loop for name in (cons (compat-package-name entry) (compat-package-nicknames entry))
        for package = (find-package name)
        when (and package (not (member package *defined-packages*)))
          return package))

(defun system-file (name)
  "Return the file in which ASDF finds the system NAME, or NIL."
  (let ((found (asdf:search-for-system-definition name)))
    (typecase found
      (pathname found)
      (asdf:system (asdf:system-source-file found)))))

(defun define-package (entry)
  "Define the package of ENTRY, or bring the one that was defined before up to date."
  (let ((package (or (find-package (compat-package-name entry))
                     (make-package (compat-package-name entry) :use '()
                                   :nicknames (compat-package-nicknames entry)))))
    (pushnew package *defined-packages*)
    (setf (documentation package t) (compat-package-documentation entry))
    (import (compat-package-symbols entry) package)
    (export (compat-package-symbols entry) package)
    package))

(defun define-user-package ()
  "Define CRAM-USER, the package in which users of CRAM type."
  (let ((language (find-package '#:cram-language)))
    (unless (or (find-package '#:cram-user) (find-package '#:cpl-user)
                (not (member language *defined-packages*)))
      (let ((package (make-package '#:cram-user :nicknames '(#:cpl-user) :use (list language))))
        (setf (documentation package t) "The package in which users of CRAM type.")
        (push package *defined-packages*)))))

(defun original (entry)
  "Return the package or the file of CRAM's, or of somebody else's, for which ENTRY would be a
substitute, or NIL."
  (or (foreign-package entry)
      (system-file (compat-package-system entry))))

(defun define-packages ()
  "Define the packages of the table that are absent; return what COMPAT-REPORT is to return."
  (let ((cram (original (find "CRAM-LANGUAGE" (compat-packages)
                              :key #'compat-package-name :test #'string=))))
    (prog1 (loop for entry in (compat-packages)
                 for name = (compat-package-name entry)
                 for original = (or cram (original entry))
                 collect (if original
                             (list name :left-alone original)
                             (list name :defined (define-package entry))))
      (define-user-package))))

(defun compat-report ()
  "Return what became of the packages of CRAM: a list of (name :defined package) and of (name
:left-alone original), the original being the package that existed before or the file of the ASDF
system because of which it was left alone."
  (copy-tree *report*))

(defun report-sentence (report)
  "Return a sentence about the packages that REPORT says were left alone, or NIL if none was."
  (let ((names (loop for (name what) in report
                     when (eq what :left-alone) collect (string-downcase name))))
    (cond ((null names) nil)
          ((= (length names) (length report))
           "CRAM itself is here: discrepancy-finder/cram-compat defines none of its packages.")
          (t (format nil "discrepancy-finder/cram-compat leaves alone what is here already: ~
                          ~{~a~^, ~}."
                     names)))))

(let ((report (let ((*package* (find-package '#:keyword)))
                ;; FIND-PACKAGE sees the local nicknames of the current package; KEYWORD has none.
                (define-packages))))
  (unless (equal report *report*)
    (format *error-output* "~@[~&~a~%~]" (report-sentence report)))
  (setf *report* report))
