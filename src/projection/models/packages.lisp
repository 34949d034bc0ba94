;;;; Where the files are that a URDF file names.
;;;;
;;;; package://NAME/PATH is PATH in the package NAME, a folder of that name, which is looked for in
;;;;   1. the folders of *PACKAGE-PATH*, which callers of READ-URDF and LOAD-SCENE give,
;;;;   2. the folders of the environment variable ROS_PACKAGE_PATH, and share/ in those of
;;;;      AMENT_PREFIX_PATH,
;;;;   3. the folders above the URDF file.
;;;; A folder of the path is a package itself or holds packages.  file:///PATH is a file of the
;;;; machine; any other name is relative to the URDF file.

(in-package #:discrepancy-finder.projection)

(defvar *package-path* '()
  "The folders, strings or pathnames, in which packages are looked for first.")

(defun environment-folders (variable)
  (remove "" (uiop:split-string (or (uiop:getenv variable) "") :separator ":") :test #'string=))

(defun folder-pathname (folder)
  "Return the pathname of the directory FOLDER; a string is taken by its characters."
  (if (stringp folder)
      ;; UIOP's way from a file name to a directory would escape the characters of a pattern.
      (uiop:parse-native-namestring (concatenate 'string folder "/"))
      (uiop:ensure-directory-pathname folder)))

(defun folders-above (file)
  "Return the folders in which FILE is, the innermost first."
  (let ((folder (uiop:pathname-directory-pathname
                 (merge-pathnames (source:native-path file) (uiop:getcwd)))))
    (loop collect folder
          until (uiop:pathname-equal folder (uiop:pathname-parent-directory-pathname folder))
          do (setf folder (uiop:pathname-parent-directory-pathname folder)))))

(defun search-folders (file)
  "Return the folders in which packages that FILE names are looked for."
  (append (mapcar #'folder-pathname *package-path*)
          (mapcar #'folder-pathname (environment-folders "ROS_PACKAGE_PATH"))
          (loop for folder in (environment-folders "AMENT_PREFIX_PATH")
                collect (uiop:subpathname (folder-pathname folder) "share/"))
          (folders-above file)))

(defun package-candidates (name file)
  "Return the folders that can be the package NAME for FILE, existing ones only."
  (remove-if-not
   #'uiop:directory-exists-p
   (loop for folder in (search-folders file)
         when (equal (first (last (pathname-directory folder))) name)
           collect folder
         collect (merge-pathnames (uiop:parse-native-namestring
                                   (concatenate 'string name "/"))
                                  folder))))

(defun package-file (rest element)
  "Return the path of the file package://REST that ELEMENT names."
  (let* ((slash (or (position #\/ rest)
                    (urdf-problem element "package://~a names no file in a package" rest)))
         (name (subseq rest 0 slash))
         (candidates (or (package-candidates name *model-file*)
                         (urdf-problem element "the package ~a of package://~a is not found; ~
                                                ROS_PACKAGE_PATH can name the folder that holds it"
                                       name rest)))
         (files (loop for folder in candidates
                      collect (merge-pathnames
                               (uiop:parse-native-namestring (subseq rest (1+ slash))) folder))))
    (or (find-if #'uiop:file-exists-p files) (first files))))

(defun after-prefix (prefix text)
  "Return what follows PREFIX in TEXT, NIL if TEXT does not begin with it."
  (and (alexandria:starts-with-subseq prefix text) (subseq text (length prefix))))

(defun named-file (name element)
  "Return the path of the existing file that ELEMENT of the URDF file being read names with NAME."
  (let* ((package-rest (after-prefix "package://" name))
         (file-rest (after-prefix "file://" name))
         (path (cond (package-rest (package-file package-rest element))
                     ((and (search "://" name) (null file-rest))
                      (urdf-problem element "the file ~a cannot be fetched" name))
                     (t (merge-pathnames (source:native-path (or file-rest name))
                                         (uiop:pathname-directory-pathname
                                          (source:native-path *model-file*)))))))
    (unless (uiop:file-exists-p path)
      (urdf-problem element "there is no file ~a~@[, which should be ~a~]"
                    name (and (string/= name (source:native-name path))
                              (source:native-name path))))
    path))
