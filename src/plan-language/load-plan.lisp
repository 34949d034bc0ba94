;;;; Loading plans: a file, or an ASDF system of such files, as it is.
;;;;
;;;; A plan file is a Lisp file: it may define packages, facts, methods, functions, whatever.  Each
;;;; of its forms is read with its position and evaluated before the next is read, so that plans
;;;; know where they stand and the symbolic evaluator has their sources.
;;;;
;;;; HELPERS, functions that a plan file defines by DEFUN, are evaluated symbolically as well; their
;;;; sources are noted by *MACROEXPAND-HOOK*.  It sees each DEFUN that is expanded: at top level, in
;;;; PROGN and EVAL-WHEN, and those that macros of the file expand into, which an inspection of the
;;;; forms would miss.  DEFMETHOD forms are noted in the same way.
;;;;
;;;; Functions that close over something local would have a state of their own in the evaluator.  So
;;;; a top-level form with such definitions in it is evaluated by *CLOSURE-EVALUATOR*, if there is
;;;; one, and the functions that it defines are interpreted ones everywhere.
;;;;
;;;; Of a system, ASDF loads what it depends on and says which files it has in which order.  These
;;;; files are loaded as sources: compiled files have no positions.

(in-package #:discrepancy-finder.plan-language)

;;; Helpers

(defvar *closure-evaluator* nil
  "A function that evaluates a form so that the functions it defines are interpreted, or NIL.")

(defun definition-p (form operator environment)
  "Return true if FORM is a definition by OPERATOR that closes over nothing local."
  (and (eq (first form) operator)
       (global-environment-p environment)))

(defparameter *definers* '(defun defmethod defgeneric def-cram-function def-plan
                           def-top-level-cram-function)
  "Operators that define functions.")

(defun mentions-operator-p (form operators)
  "Return true if a list in FORM begins with one of OPERATORS."
  (and (consp form)
       (or (and (member (first form) operators) t)
           (loop for rest = form then (cdr rest)
                 while (consp rest)
                   thereis (mentions-operator-p (car rest) operators)))))

(defun closes-over-p (form)
  "Return true if FORM, of a plan file, is likely to make functions with a state of their own:
definitions inside of bindings, or a variable whose value is or holds a closure."
  (and (consp form)
       (case (first form)
         ((let let* flet labels multiple-value-bind destructuring-bind)
          (mentions-operator-p (rest form) *definers*))
         ((defvar defparameter setf setq)
          (mentions-operator-p (rest form) '(lambda flet labels))))))

(defun evaluate-plan-form (form)
  (if (and *closure-evaluator* (closes-over-p form))
      (funcall *closure-evaluator* form)
      (eval form)))

(defun plan-file-hook (outer)
  "Return a function for *MACROEXPAND-HOOK*, where OUTER was, that lets definitions of functions
record their sources and definitions of packages see global names of packages only."
  (lambda (expander form environment)
    (let ((expansion (funcall outer expander form environment)))
      (cond ((atom form) expansion)
            ((definition-p form 'defmethod environment)
             `(record-method ,expansion ',form))
            ((definition-p form 'defun environment)
             (destructuring-bind (name lambda-list &rest body) (rest form)
               `(progn ,expansion
                       (record-helper ',name ',lambda-list ',body
                                      ,(source:form-position form)))))
            ;; What a package of the file uses as CPL is CRAM's; that this is also a nickname local
            ;; to the package in which the file begins to be read is not meant.
            ((eq (first form) 'defpackage)
             `(let ((*package* (find-package '#:keyword))) ,expansion))
            (t expansion)))))

(defun load-plan-sources (files name package)
  "Load FILES, which are NAME as a whole, in PACKAGE; return the plans that they define, in order."
  (let ((*noted-plans* '())
        (*macroexpand-hook* (plan-file-hook *macroexpand-hook*)))
    (source:load-sources files name :package package :evaluator #'evaluate-plan-form)
    (remove-duplicates (reverse *noted-plans*) :key #'plan-name)))

;;; Systems

(defvar *plan-locator* (constantly nil)
  "A function of a symbol that returns the name of the file that defines the plan of this name, or
NIL.")

(defun system-error (name reason)
  (error 'source:source-error :file name :reason reason))

(defun asdf-reason (condition)
  "Return what CONDITION, signaled by ASDF, says is wrong, as one line."
  (typecase condition
    (asdf:load-system-definition-error
     (source:condition-sentence (asdf/find-system:error-condition condition)))
    (asdf:missing-dependency
     (format nil "~a depends on ~(~a~), which ASDF does not find"
             (asdf:component-name (asdf/find-component:missing-required-by condition))
             (asdf/find-component:missing-requires condition)))
    (t (source:condition-sentence condition))))

(defun call-explaining-asdf (name function)
  "Call FUNCTION; an error that does not say itself where it is becomes a SOURCE-ERROR for the
system or file NAME."
  (handler-bind ((error (lambda (condition)
                          (unless (source:self-explaining-p condition)
                            (system-error name (asdf-reason condition))))))
    (let ((*compile-verbose* nil) (*compile-print* nil) (*load-verbose* nil))
      (funcall function))))

(defun defined-system (file)
  "Return the ASDF system that FILE, an .asd file, defines under its own name."
  (let ((path (source:native-path file))
        (name (source:native-name file)))
    (unless (uiop:file-exists-p path)
      (system-error name "no such file"))
    (call-explaining-asdf name (lambda () (asdf:load-asd (truename path))))
    (or (asdf:registered-system (pathname-name path))
        (system-error name (format nil "it defines no system named ~a" (pathname-name path))))))

(defun named-system (name)
  "Return the ASDF system with the name of the symbol NAME, or NIL."
  (let ((name (asdf:coerce-name name)))
    (call-explaining-asdf name (lambda () (asdf:find-system name nil)))))

(defun component-files (component name)
  "Return a list of the Lisp file that COMPONENT, of the system NAME, is; none if it is none."
  (typecase component
    (asdf:cl-source-file (list (asdf:component-pathname component)))
    ((or asdf:parent-component asdf:static-file) '())
    (t (system-error name (format nil "its component ~a is neither Lisp nor a static file, but a ~
                                       ~(~a~)"
                                  (asdf:component-name component)
                                  (type-of component))))))

(defun system-files (system)
  "Return the list of the Lisp files of SYSTEM itself, in the order in which they are to be loaded."
  (loop for component in (asdf:required-components system :other-systems nil
                                                          :goal-operation 'asdf:load-op
                                                          :keep-operation 'asdf:load-op)
        append (component-files component (asdf:component-name system))))

(defun load-system (system)
  "Load SYSTEM, its own files as sources, and return the list of the plans that these define."
  (let ((name (asdf:component-name system)))
    (load-plan-sources (call-explaining-asdf
                        name
                        (lambda ()
                          ;; All that it depends on.
                          (asdf:operate 'asdf:prepare-op system)
                          (system-files system)))
                       name
                       '#:common-lisp-user)))

(defun load-named (name)
  "Load the ASDF system NAME, a symbol, or the file that defines the plan of this name."
  (let* ((system (named-system name))
         (file (and (null system) (funcall *plan-locator* name))))
    (cond (system (load-system system))
          (file (load-plan file))
          (t (system-error (asdf:coerce-name name)
                           (format nil "ASDF finds no system of this name, and no file in plans/ ~
                                        defines a plan of this name"))))))

(defun load-plan (source)
  "Load plans and return the list of the PLANs that are defined, in their order, those that were
defined before included.  SOURCE is a file of plan definitions, read in the package
DISCREPANCY-FINDER-USER unless it says otherwise; or an .asd file; or a symbol, the name of an ASDF
system, or else of a plan that a file in plans/ defines.  Of a system, the Lisp files are loaded in
their order, after what it depends on.  Signals SOURCE-ERROR, which names file and line, if
something cannot be read or loaded."
  (cond ((symbolp source) (load-named source))
        ((equalp (pathname-type (source:native-path source)) "asd")
         (load-system (defined-system source)))
        (t (load-plan-sources (list source) (source:native-name source)
                              '#:discrepancy-finder-user))))
