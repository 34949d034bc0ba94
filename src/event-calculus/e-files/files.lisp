;;;; .e files on disk, and the files that they load.
;;;;
;;;; A file is looked for in the folder of the file that loads it, in each folder above that one,
;;;; and in the current folder; it is read once, however often it is loaded.  The foundations,
;;;; which say in the language itself what the event calculus is, are built in and never read from
;;;; disk.

(in-package #:discrepancy-finder.event-calculus)

(defparameter *foundations* '("Root.e" "EC.e" "DEC.e" "ECTraj.e" "ECCausal.e")
  "The files of a folder \"foundations\" that are built in.")

(defun absolute-path (path)
  (merge-pathnames (merge-pathnames path) (uiop:getcwd)))

(defun e-file-text (path name)
  "Return the text of the file at PATH; NAME names it in errors."
  (flet ((problem (reason) (e-problem name nil reason)))
    (when (uiop:directory-exists-p (uiop:ensure-directory-pathname path))
      (problem "it is a folder"))
    (handler-case (uiop:read-file-string path :external-format :utf-8)
      (file-error () (problem (if (uiop:file-exists-p path) "it cannot be read" "no such file")))
      (stream-error () (problem "it is not a UTF-8 text")))))

(defun foundation-name (path)
  "Return the name of the foundation that a file loads by PATH, or NIL."
  (let* ((parts (uiop:split-string path :separator '(#\/ #\\)))
         (folder (first (last parts 2))))
    (and (rest parts) (string= folder "foundations")
         (find (first (last parts)) *foundations* :test #'string=))))

(defun folders-above (folder)
  "Return the list of the directory pathname FOLDER and of those above it, the nearest first."
  (loop with directory = (pathname-directory folder)
        for length from (length directory) downto 1
        collect (make-pathname :directory (subseq directory 0 length) :defaults folder)))

(defun find-e-file (path folder)
  "Return the file that a statement in a file in FOLDER means by PATH, or NIL."
  (let ((relative (uiop:parse-native-namestring path)))
    (if (uiop:absolute-pathname-p relative)
        (uiop:file-exists-p relative)
        (loop for candidate in (append (folders-above folder) (list (uiop:getcwd)))
              thereis (uiop:file-exists-p
                       (uiop:parse-native-namestring
                        (concatenate 'string (uiop:native-namestring candidate) path)))))))

(defun expand-loads (statements folder seen)
  "Return STATEMENTS, of a file in FOLDER, with those of the loaded files in the place of the :LOAD
statements, and a statement :FOUNDATION (name) for a foundation.  SEEN is a table of the true names
of the files that were read already."
  (loop for statement in statements
        append (if (eq (statement-kind statement) :load)
                   (loaded-statements statement (first (statement-data statement)) folder seen)
                   (list statement))))

(defun loaded-statements (statement path folder seen)
  "Return the statements that the :LOAD STATEMENT, in a file in FOLDER, stands for."
  (let ((foundation (foundation-name path))
        (file (find-e-file path folder)))
    (flet ((problem (control &rest arguments)
             (apply #'e-problem (statement-file statement) (statement-line statement)
                    control arguments)))
      (cond (foundation
             (list (make-statement :foundation (list foundation) (statement-file statement)
                                   (statement-line statement))))
            ((null file)
             (problem "there is no file \"~a\" in ~a, in a folder above it or in the current folder"
                      path (uiop:native-namestring folder)))
            ((gethash (uiop:native-namestring (truename file)) seen) '())
            (t (e-file-statements file (uiop:native-namestring file) seen))))))

(defun e-file-statements (path name seen)
  "Return the statements of the file at PATH and of those that it loads; NAME names it in errors."
  (let ((text (e-file-text path name)))
    (setf (gethash (uiop:native-namestring (truename path)) seen) t)
    (expand-loads (read-statements text name)
                  (truename (uiop:pathname-directory-pathname (absolute-path path)))
                  seen)))
