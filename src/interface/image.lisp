;;;; The executable image.

(in-package #:discrepancy-finder)

(defun executable-directory ()
  (make-pathname :name nil :type nil :version nil :defaults (truename sb-ext:*runtime-pathname*)))

(defun image-directories ()
  "Return the directories in which the executable looks for plans/ and models/: the one above the
build folder, and the build folder itself, which holds copies."
  (let ((directory (executable-directory)))
    (list (uiop:pathname-parent-directory-pathname directory) directory)))

(defun save-executable (file)
  "Save the running Lisp as the executable FILE and end the process.  The foreign libraries are
closed first and opened again when the executable starts."
  (foreign:close-libraries)
  (sb-ext:save-lisp-and-die file :toplevel #'main :executable t :save-runtime-options t))
