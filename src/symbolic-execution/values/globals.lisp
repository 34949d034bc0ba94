;;;; Global variables: compiled code may look at objects that they hold.
;;;;
;;;; What is stored in a global variable is decided, but an object that it holds may be changed
;;;; later by interpreted code.  Before compiled code of the user's runs, the variables that
;;;; interpreted code mentions are looked through, if anything was changed since the last time.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *mentioned-globals* '()
  "The global variables that interpreted code mentions, those of the system left out.")

(defun note-global (symbol)
  "Note that interpreted code mentions the global variable SYMBOL."
  (let ((package (symbol-package symbol)))
    (unless (and package (system-package-p package))
      (pushnew symbol *mentioned-globals*))))

(defun system-function-p (function)
  "Return true if FUNCTION belongs to Lisp or to this system: it knows nothing of the user's global
variables."
  (let* ((name (sb-kernel:%fun-name function))
         (symbol (if (consp name) (second name) name)))
    (and symbol
         (symbolp symbol)
         (symbol-package symbol)
         (system-package-p (symbol-package symbol)))))

(defun decide-globals (description)
  "Decide what is inside of the values of the global variables that interpreted code mentions."
  (let ((path *path*))
    (unless (= (path-searched path) (path-writes path))
      (dolist (symbol (reverse *mentioned-globals*))
        (when (boundp symbol)
          (decided (symbol-value symbol) description)))
      (setf (path-searched path) (path-writes path)))))
