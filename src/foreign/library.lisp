;;;; Shared libraries of the system.
;;;;
;;;; A binding declares its library with DEFINE-LIBRARY, which also opens it.  Before an
;;;; executable image is saved CLOSE-LIBRARIES closes them all; the image calls OPEN-LIBRARIES when
;;;; it starts.  A candidate is a file name for the dynamic linker, or (:beside "libx.so"): a file
;;;; beside the running executable, else in the build folder of the source tree.  So a build folder
;;;; can be moved as a whole.

(in-package #:discrepancy-finder.foreign)

(defvar *libraries* '()
  "List of (key name candidates hint handle), in order of definition; handle is NIL when closed.")

(defun library-directory ()
  "Return the folder that holds the shared libraries made by the build: that of the running
executable if it is one of ours, else build/ in the source tree."
  (let ((executable sb-ext:*runtime-pathname*))
    (if (and executable sb-ext:*core-pathname*
             (equal (truename executable) (truename sb-ext:*core-pathname*)))
        (make-pathname :name nil :type nil :version nil :defaults (truename executable))
        (asdf:system-relative-pathname "discrepancy-finder" "build/"))))

(defun candidate-name (candidate)
  (if (stringp candidate)
      candidate
      (namestring (merge-pathnames (second candidate) (library-directory)))))

(defun open-library (library)
  (destructuring-bind (name candidates hint handle) (rest library)
    (unless handle
      (let ((files (mapcar #'candidate-name candidates)))
        (setf (fifth library)
              (or (some (lambda (file) (ignore-errors (cffi:load-foreign-library file))) files)
                  (error 'foreign-library-missing :name name :candidates files :hint hint)))))))

(defun open-libraries ()
  "Open every declared library that is not open.  Signal FOREIGN-LIBRARY-MISSING if one of them
cannot be opened."
  (mapc #'open-library *libraries*)
  (values))

(defun close-libraries ()
  "Close every declared library, so that a saved image does not reopen them by absolute paths."
  (dolist (library *libraries* (values))
    (when (fifth library)
      (cffi:close-foreign-library (fifth library))
      (setf (fifth library) nil))))

(defun ensure-library (key name candidates hint)
  (unless (assoc key *libraries*)
    (setf *libraries* (append *libraries* (list (list key name candidates hint nil)))))
  (open-library (assoc key *libraries*)))

(defmacro define-library (key name candidates &key hint)
  "Declare the library of NAME (a string for people), known by the symbol KEY, and open it, now and
whenever OPEN-LIBRARIES is called.  CANDIDATES are tried in order: a string is a file name for the
dynamic linker, (:beside string) a file of the build folder.  HINT says how to get the library.
Signals FOREIGN-LIBRARY-MISSING."
  `(eval-when (:load-toplevel :execute)
     (ensure-library ',key ',name ',candidates ',hint)))
