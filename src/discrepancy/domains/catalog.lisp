;;;; The catalog: plans and domains by name.
;;;;
;;;; A plan or domain that is not defined yet is looked for as plans/NAME.lisp or
;;;; models/NAME/domain.lisp, in the current directory and in the data directories: the source tree,
;;;; or what stands beside the executable.

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

(defun ensure-plan (name &optional file)
  "Return the plan named by the symbol NAME.  If there is none, load FILE, or plans/NAME.lisp where
FILE is NIL.  Signals PLAN-NOT-FOUND and SOURCE-ERROR."
  (or (handler-case (plan:find-plan name) (plan:plan-not-found () nil))
      (let ((located (locate-file (or file (format nil "plans/~a.lisp" (file-name name))))))
        (when located (plan:load-plan located))
        (plan:find-plan name))))

(defun ensure-domain (domain &optional file)
  "Return DOMAIN if it is a domain, or the domain named by the symbol DOMAIN.  If there is none,
load FILE, or models/NAME/domain.lisp where FILE is NIL.  Signals DOMAIN-NOT-FOUND, SOURCE-ERROR and
what DEFINE-ABSTRACTION signals."
  (cond ((typep domain 'domain) domain)
        ((or (null domain) (not (symbolp domain)))
         (error 'invalid-argument :name 'domain :value domain
                                  :expected "a domain or the name of one"))
        ((find (ec:name-keyword domain) (symbolic:all-action-theories)
               :key #'symbolic:action-theory-name))
        (t (let ((located (locate-file (or file (format nil "models/~a/domain.lisp"
                                                        (file-name domain))))))
             (when located (load-domain located))
             (symbolic:find-action-theory domain)))))
