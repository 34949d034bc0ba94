;;;; The table of functions that may be given symbolic values.
;;;;
;;;; A global function is of one of three kinds.  A LIFTED one has a version that understands
;;;; symbolic arguments.  A TRANSPARENT one hands them on as they are: a version of it, where it
;;;; needs one, decides what it must know (where in the list?) and nothing else.  All others are
;;;; OPAQUE: CALL-OPAQUE decides whatever is symbolic in their arguments.
;;;;
;;;; #'NAME is the function of Common Lisp itself: whoever calls it asks CODE-OF what to call, so
;;;; that compiled code which is given it gets what it knows.
;;;;
;;;; Functions that change objects note on a path how to change them back (NOTE-UNDO).
;;;;
;;;; Entry points: FUNCTION-KIND, LIFTED-FUNCTION, CODE-OF, CALL-OPAQUE for the evaluator,
;;;; DEFINE-LIFTED and DEFINE-TRANSPARENT for the table.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *lifted-functions* (make-hash-table :test 'equal)
  "A list (kind function always) for each name of a lifted or transparent function: the function
that stands for it, or NIL if that is the function itself, and whether it must be called on every
path, also while there is nothing symbolic.")

(defvar *known-functions* (make-hash-table :test 'eq)
  "The function to be called for each function of Common Lisp that has a lifted version, and for
each lifted version.")

(defun register-lifted (name kind function &optional always)
  "Let FUNCTION, or with NIL the function NAME itself, stand for NAME, which is of KIND; ALWAYS, on
every path."
  (setf (gethash name *lifted-functions*) (list kind function always))
  (let ((original (and (fboundp name) (fdefinition name))))
    (when original
      (setf (gethash original *known-functions*) (or function original))))
  (when function
    (setf (gethash function *known-functions*) function))
  name)

(defmacro define-lifted (name lambda-list &body body)
  "Define the version with LAMBDA-LIST and BODY of the function NAME that understands symbolic
arguments.  NAME may be a list of names of functions that change something or call functions: their
version is called on every path, also while there is nothing symbolic."
  `(register-version ',name :lifted
                     (sb-int:named-lambda ,(list 'lifted name) ,lambda-list ,@body)))

(defmacro define-transparent (name lambda-list &body body)
  "Define the version with LAMBDA-LIST and BODY of the function NAME, which hands on symbolic
values.  Where BODY is missing the version calls NAME with its required and optional arguments, of
which those whose names do not begin with ANY are decided first."
  `(register-version ',name :transparent
                     (sb-int:named-lambda ,(list 'transparent name) ,lambda-list
                       ,@(or body (transparent-body name lambda-list)))))

(defun register-version (names kind function)
  (let ((always (and (consp names) (not (eq (first names) 'setf)))))
    (dolist (name (if always names (list names)))
      (when (or (consp name) (fboundp name))
        (register-lifted name kind function always)))))

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun any-p (variable)
    (uiop:string-prefix-p "ANY" (symbol-name variable)))

  (defun describe-decision (place)
    "Return PLACE, a name or a description, as the description of a decision."
    (if (stringp place)
        place
        (format nil "an argument of ~(~a~)" place)))

  (defun transparent-body (name lambda-list)
    "Return the body of a version that only settles the arguments in LAMBDA-LIST."
    (multiple-value-bind (required optional rest keys)
        (alexandria:parse-ordinary-lambda-list lambda-list)
      (when keys (error "Write a body for ~s." name))
      (flet ((settling (variables)
               (loop for variable in variables
                     unless (any-p variable)
                       collect `(when (symbolic-value-p ,variable)
                                  (setf ,variable (settled ,variable ,(describe-decision name)))))))
        `(     ,@(settling (append required (mapcar #'first optional)))
          ,(cond (rest
                  `(apply #',name ,@required ,@(mapcar #'first optional)
                          ,(if (any-p rest)
                               rest
                               `(settled-each ,rest ,(describe-decision name)))))
                 (optional
                  (labels ((call (variables options)
                             (if options
                                 (destructuring-bind (variable init suppliedp) (first options)
                                   (declare (ignore init))
                                   (let ((more (call (append variables (list variable))
                                                     (rest options))))
                                     (if suppliedp
                                         `(if ,suppliedp ,more (,name ,@variables))
                                         more)))
                                 `(,name ,@variables))))
                    (call required optional)))
                 (t (if (symbolp name)
                        `(,name ,@required)
                        `(funcall #',name ,@required)))))))))

(defun function-versions (name)
  "Return the kind of the global function NAME, a symbol or (setf symbol), :LIFTED, :TRANSPARENT or
:OPAQUE; the function that may be given symbolic arguments in its place, or NIL if it is itself or
there is none; and true if that must be called on every path, also while there is nothing symbolic."
  (let ((entry (gethash name *lifted-functions*)))
    (if entry
        (values-list entry)
        (definition-version name))))

(defun lifted-function (name)
  "Return the function that understands symbolic arguments for the global function NAME, a symbol
or (setf symbol), or NIL if it is the function itself or there is none."
  (nth-value 1 (function-versions name)))

(defun function-kind (name)
  "Return :LIFTED, :TRANSPARENT or :OPAQUE for the global function NAME, a symbol or (setf symbol):
may it be given symbolic arguments?"
  (values (function-versions name)))

(defun definition-version (name)
  "Return what FUNCTION-VERSIONS does for NAME, which is not in the table, by what it is defined as:
functions of structures and accessors of classes are transparent."
  (let ((structure-version (structure-version name))
        (function (and (fboundp name) (fdefinition name))))
    (cond (structure-version (values :transparent structure-version (consp name)))
          ((and (typep function 'standard-generic-function) (accessor-p function))
           (values :transparent (accessor-version function) (consp name)))
          (t (values :opaque nil nil)))))

(defun call-opaque (function arguments description)
  "Call FUNCTION, which may be compiled, with the list ARGUMENTS, in which everything symbolic is
decided first, and return its values."
  (cond ((symbolic-run-p)
         (unless (system-function-p function)
           (decide-globals description))
         (apply (the function function)
                (mapcar (lambda (argument) (decided argument description)) arguments)))
        (t (apply (the function function) arguments))))

(defvar *named-versions* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The version, or NIL, of functions that are not in the table.")

(defun known-version (function)
  "Return the function to be called for FUNCTION, an object, if that may be given symbolic values,
or NIL."
  (cond ((typep function 'interpreted-function) (interpreted-function-code function))
        ((gethash function *known-functions*))
        ((typep function 'generic-function)
         (generic-function-code function (sb-mop:generic-function-name function)))
        (t (multiple-value-bind (version known) (gethash function *named-versions*)
             (if known
                 version
                 (setf (gethash function *named-versions*) (named-version function)))))))

(defun named-version (function)
  "Return the version of FUNCTION, not in the table, if it has one because of its definition."
  (let ((name (sb-kernel:%fun-name function)))
    (and (typep name '(or symbol (cons (eql setf))))
         (fboundp name)
         (eq (fdefinition name) function)
         (nth-value 1 (definition-version name)))))

(defun code-of (function)
  "Return the function to be called for FUNCTION, an object or a name: one that may be given
symbolic values."
  (typecase function
    (symbol (let ((version (lifted-function function)))
              (or version (code-of (global-function function)))))
    (function (cond ((known-version function))
                    ((not *path*) function)
                    (t (lambda (&rest arguments)
                         (call-opaque function arguments (function-description function))))))
    (t function)))

(defun function-description (function)
  "Return how FUNCTION, an object or a name, is called in the description of a decision."
  (let ((name (if (functionp function) (sb-kernel:%fun-name function) function)))
    (format nil "an argument of ~(~a~)" (if (or (symbolp name) (consp name)) name "a function"))))
