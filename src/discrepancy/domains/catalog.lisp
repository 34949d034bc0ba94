;;;; The catalog: plans and domains by name.
;;;;
;;;; A plan or domain that is not defined yet is looked for in the files plans/*.lisp or
;;;; models/*/*.lisp, in the current directory and in the data directories: the source tree, or what
;;;; stands beside the executable.  What a file defines is told by its lines, which are not read as
;;;; Lisp: one that begins with "(define-abstraction NAME" or "(def-top-level-cram-function NAME"
;;;; defines NAME.  A file named after what it defines, plans/NAME.lisp or models/NAME/domain.lisp,
;;;; is tried first, and need not have such a line.

(in-package #:discrepancy-finder.discrepancy)

(defvar *data-directories* '()
  "The directories, after the current one, that hold plans/ and models/.")

(defun use-data-directories (directories)
  "Look for plans/ and models/ in the list DIRECTORIES, after the current directory."
  (setf *data-directories* directories))

(defun locate-file (file)
  "Return FILE, a relative or absolute file name, if it exists, or the first file of this name under
the data directories; NIL if there is none."
  ;; A name is taken by its characters: one with a bracket in it is no pattern.
  (let ((path (if (pathnamep file) file (uiop:parse-native-namestring file))))
    (if (uiop:file-exists-p path)
        (uiop:native-namestring path)
        (loop for directory in *data-directories*
              for candidate = (merge-pathnames path directory)
              when (uiop:file-exists-p candidate) return (uiop:native-namestring candidate)))))

(defun file-name (name)
  (string-downcase (symbol-name name)))

;;; What files define

(defstruct (shelf (:copier nil))
  "Files that define things of one sort: those that match PATTERN, by lines that begin with OPERATOR
and a name.  A file named after what it defines has the name that the format control USUAL gives."
  (pattern nil :type pathname :read-only t)
  (operator "" :type string :read-only t)
  (usual "" :type string :read-only t))

(defparameter *plan-shelf*
  (make-shelf :pattern #p"plans/*.lisp" :operator "(def-top-level-cram-function "
              :usual "plans/~a.lisp"))

(defparameter *domain-shelf*
  (make-shelf :pattern #p"models/*/*.lisp" :operator "(define-abstraction "
              :usual "models/~a/domain.lisp"))

(defun shelf-files (shelf)
  "Return the names of the files of SHELF: those of the current directory, relative to it, come
first."
  (flet ((files (directory)
           (sort (mapcar #'uiop:native-namestring
                         (uiop:directory* (merge-pathnames (shelf-pattern shelf) directory)))
                 #'string<)))
    (append (mapcar (lambda (file)
                      (uiop:native-namestring
                       (uiop:enough-pathname (uiop:parse-native-namestring file)
                                             (uiop:getcwd))))
                    (files (uiop:getcwd)))
            (mapcan #'files *data-directories*))))

(defun defined-name (line operator)
  "Return the name that LINE defines, in lower case, if it begins with OPERATOR, or NIL."
  (when (uiop:string-prefix-p operator (string-downcase line))
    (let ((start (length operator)))
      (string-downcase
       (subseq line start (position-if (lambda (character) (find character " ()"))
                                       line :start start))))))

(defun defined-names (file operator)
  "Return the names that FILE defines by OPERATOR; none if the file cannot be read."
  (loop for line in (ignore-errors
                     (uiop:read-file-lines (uiop:parse-native-namestring file)
                                           :external-format :utf-8))
        for name = (defined-name line operator)
        when name collect name))

(defun shelf-names (shelf)
  "Return the names of all that the files of SHELF define, in the order of the alphabet."
  (sort (remove-duplicates (loop for file in (shelf-files shelf)
                                 append (defined-names file (shelf-operator shelf)))
                           :test #'string=)
        #'string<))

(defun defining-files (name shelf)
  "Return the names of files that may define NAME, a symbol, the most likely one first."
  (let ((usual (locate-file (format nil (shelf-usual shelf) (file-name name))))
        (others (remove-if-not (lambda (file)
                                 (member (file-name name)
                                         (defined-names file (shelf-operator shelf))
                                         :test #'string=))
                               (shelf-files shelf))))
    (if usual (cons usual others) others)))

;;; Entry points

(defun loaded-definition (find load name shelf)
  "Return what FIND returns for NAME, a symbol; while that is NIL, LOAD the files of SHELF that may
define NAME."
  (or (funcall find name)
      (loop for file in (defining-files name shelf)
            do (funcall load file)
              thereis (funcall find name))))

(defun known-plan (name)
  (handler-case (plan:find-plan name) (plan:plan-not-found () nil)))

(defun ensure-plan (name)
  "Return the plan named by the symbol NAME.  If there is none, load the file of the catalog that
defines it.  Signals PLAN-NOT-FOUND, which tells the names in the catalog, and SOURCE-ERROR."
  (or (loaded-definition #'known-plan #'plan:load-plan name *plan-shelf*)
      (error 'plan:plan-not-found :name name :known (shelf-names *plan-shelf*))))

;; LOAD-PLAN takes a name, too.
(setf plan:*plan-locator* (lambda (name) (first (defining-files name *plan-shelf*))))

(defun domain-not-found (name)
  (error 'symbolic:domain-not-found :name name :known (shelf-names *domain-shelf*)))

(defun domain-file-named (name)
  "Return the name of the file of the catalog that defines the domain NAME, a symbol.  Signals
DOMAIN-NOT-FOUND."
  (or (first (defining-files name *domain-shelf*)) (domain-not-found name)))

(defun known-domain (name)
  (find (ec:name-keyword name) (symbolic:all-action-theories)
        :key #'symbolic:action-theory-name))

(defun ensure-domain (domain)
  "Return DOMAIN if it is a domain, or the domain named by the symbol DOMAIN.  If there is none,
load the file of the catalog that defines it.  Signals DOMAIN-NOT-FOUND, which tells the names
in the catalog, SOURCE-ERROR and what DEFINE-ABSTRACTION signals."
  (cond ((typep domain 'domain) domain)
        ((or (null domain) (not (symbolp domain)))
         (error 'invalid-argument :name 'domain :value domain
                                  :expected "a domain or the name of one"))
        ((loaded-definition #'known-domain #'load-domain domain *domain-shelf*))
        (t (domain-not-found domain))))
