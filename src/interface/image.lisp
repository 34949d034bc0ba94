;;;; The executable image.

(in-package #:discrepancy-finder)

(defun executable-directory ()
  (make-pathname :name nil :type nil :version nil :defaults (truename sb-ext:*runtime-pathname*)))

(defun image-directories ()
  "Return the directories in which the executable looks for plans/ and models/: the one above the
build folder, and the build folder itself, which holds copies."
  (let ((directory (executable-directory)))
    (list (uiop:pathname-parent-directory-pathname directory) directory)))

(defun copy-data (target)
  "Copy plans/ and models/ of the source tree into the directory TARGET."
  (let ((root (asdf:system-source-directory "discrepancy-finder")))
    (dolist (folder '("plans/" "models/"))
      (uiop:collect-sub*directories
       (merge-pathnames folder root) (constantly t) (constantly t)
       (lambda (directory)
         (dolist (file (uiop:directory-files directory))
           (let ((copy (merge-pathnames (enough-namestring file root) target)))
             (ensure-directories-exist copy)
             (uiop:copy-file file copy))))))))

(defun save-executable (file)
  "Save the running Lisp as the executable FILE, with plans and models beside it, and end the
process.  The foreign libraries are closed first and opened again when the executable starts."
  (copy-data (make-pathname :name nil :type nil :version nil :defaults file))
  (foreign:close-libraries)
  (let ((temporary (make-pathname :type "new" :defaults file)))
    (sb-ext:save-lisp-and-die temporary :toplevel #'main :executable t
                                        :save-runtime-options t)))
