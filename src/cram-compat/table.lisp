;;;; The table of CRAM's packages: which global names stand for which symbols of ours.
;;;;
;;;; A file of plans names the packages of CRAM: cram-language or cpl, cram-designators or desig.
;;;; Each DEFINE-COMPAT-PACKAGE gives such a package's name, its nicknames, the ASDF system in
;;;; which CRAM has it, and its symbols: a list of groups, each the name of a package of ours and
;;;; names of symbols in it.  Symbols are not copied: cpl:seq IS the SEQ of our plan language.  A
;;;; name that our package does not export is an error when its entry is compiled.  The entries
;;;; stand in language-names.lisp, executive-names.lisp and geometry-names.lisp; packages.lisp makes
;;;; the packages.
;;;;
;;;; No two packages have different symbols of the same name, so that a package can use any of them
;;;; together; only the operators that know fluents differ between cram-language and common-lisp.

(in-package #:discrepancy-finder.cram-compat)

(defstruct (compat-package (:copier nil))
  "A package of CRAM that is made of symbols of ours."
  (name "" :type string :read-only t)
  (nicknames '() :type list :read-only t)
  (system "" :type string :read-only t)
  (documentation "" :type string :read-only t)
  (symbols '() :type list :read-only t))

(setf (documentation 'compat-package-name 'function)
      "Return the name of a package of CRAM."
      (documentation 'compat-package-nicknames 'function)
      "Return the list of the nicknames of a package of CRAM."
      (documentation 'compat-package-system 'function)
      "Return the name of the ASDF system in which CRAM has a package."
      (documentation 'compat-package-symbols 'function)
      "Return the list of the symbols of ours that a package of CRAM is to export.")

(defmethod print-object ((package compat-package) stream)
  (print-unreadable-object (package stream :type t)
    (format stream "~a, ~d symbols" (compat-package-name package)
            (length (compat-package-symbols package)))))

(defvar *compat-packages* '()
  "The list of the COMPAT-PACKAGEs, the last one first.")

(defun compat-packages ()
  "Return the list of the COMPAT-PACKAGEs: what this layer would define in an image without CRAM."
  (reverse *compat-packages*))

(defun group-symbols (group)
  "Return the list of the external symbols that GROUP, (package name*) or (package :all), means."
  (destructuring-bind (package . names) group
    (if (equal names '(:all))
        (loop for symbol being the external-symbols of package collect symbol)
        (loop for name in names
              collect (multiple-value-bind (symbol status)
                          (find-symbol (string name) package)
                        (unless (eq status :external)
                          (error "~a does not export ~a." package name))
                        symbol)))))

(defun add-compat-package (package)
  (setf *compat-packages*
        (cons package (remove (compat-package-name package) *compat-packages*
                              :key #'compat-package-name :test #'string=))))

(defmacro define-compat-package (name nicknames system documentation &body groups)
  "Enter the package NAME of CRAM in the table, with NICKNAMES, the name of its ASDF SYSTEM and
GROUPS of symbols, (package name*) or (package :all)."
  `(add-compat-package
    (make-compat-package
     :name ,(string name) :nicknames ',(mapcar #'string nicknames) :system ,system
     :documentation ,documentation
     :symbols ',(remove-duplicates (mapcan #'group-symbols groups)))))
