;;;; How editors indent the forms of the plan language.
;;;;
;;;; SLIME and Sly learn the indentation of macros with &BODY by themselves.  For others they look
;;;; into tables that programs may register; REGISTER-INDENTATION does that for whichever of the two
;;;; is there.  Call it again when you connect to an image that was already loaded.

(in-package #:discrepancy-finder.plan-language)

(defparameter *indentation*
  '(("DEF-CRAM-FUNCTION" (4 &lambda &body))
    ("DEF-TOP-LEVEL-CRAM-FUNCTION" (4 &lambda &body))
    ("DEF-PLAN" (4 &lambda &body))
    ("DEF-GOAL" (&lambda &body))
    ("DEF-PROCESS-MODULE" (4 &lambda &body))
    ("WITH-FAILURE-HANDLING" ((&whole 6 &rest (&whole 1 4 &rest 2)) &body))
    ("WITH-RETRY-COUNTERS" ((&whole 4 &rest (&whole 1 1)) &body))
    ("DO-RETRY" 1)
    ("WHENEVER" 1)
    ("WITH-POLICY" 2)
    ("PARTIAL-ORDER" 1)
    ("DEF-FACT-GROUP" 2)
    ("<-" 1)
    (":TAG" 1)
    ("PAR" 0) ("PURSUE" 0) ("TRY-ALL" 0) ("TRY-IN-ORDER" 0) ("SEQ" 0) ("TOP-LEVEL" 0))
  "For each operator its indentation, in the words of Emacs's cl-indent.")

(defun indentation-table ()
  (let ((table (make-hash-table :test 'eq)))
    (loop for (name indentation) in *indentation*
          do (dolist (package '(#:discrepancy-finder.plan-language #:discrepancy-finder.prolog
                                #:keyword))
               (let ((symbol (find-symbol (string-left-trim ":" name) package)))
                 (when symbol
                   (setf (gethash symbol table) indentation)))))
    table))

(defvar *indentation-table* nil
  "The table that was registered.")

(defun register-indentation ()
  "Tell SLIME's and Sly's Lisp sides, where they are loaded, how forms of the plan language are
indented.  Return the list of the names of the packages that were told."
  (setf *indentation-table* (or *indentation-table* (indentation-table)))
  (loop for package in '(#:swank #:slynk)
        for variable = (and (find-package package)
                            (find-symbol (string '#:*application-hints-tables*) package))
        when (and variable (boundp variable))
          do (pushnew *indentation-table* (symbol-value variable))
          and collect package))

(register-indentation)
