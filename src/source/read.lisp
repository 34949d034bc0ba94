;;;; Reading files of Lisp forms.
;;;;
;;;; READ-SOURCE returns the forms of a file as data (theories, scenes); LOAD-SOURCE evaluates
;;;; them one by one (plans, domains).  Both read with *READ-EVAL* false, so that reading never
;;;; runs code, and both remember for every list in the file the line on which it begins:
;;;; FORM-POSITION asks for it.  What is wrong is a SOURCE-ERROR that names file and line.

(in-package #:discrepancy-finder.source)

(defstruct (source-position (:constructor make-source-position (file line)) (:copier nil))
  "A line of a file."
  (file "" :type string :read-only t)
  (line 0 :type (integer 1) :read-only t))

(setf (documentation 'make-source-position 'function)
      "Return the source position of the line, an integer, of the file, a string."
      (documentation 'source-position-file 'function)
      "Return the file of a source position, as the user named it."
      (documentation 'source-position-line 'function)
      "Return the line of a source position, counted from 1.")

(defmethod print-object ((position source-position) stream)
  (if *print-escape*
      (print-unreadable-object (position stream :type t)
        (format stream "~a:~d" (source-position-file position) (source-position-line position)))
      (format stream "~a:~d" (source-position-file position) (source-position-line position))))

(defmethod make-load-form ((position source-position) &optional environment)
  (make-load-form-saving-slots position :environment environment))

(defvar *positions* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The source position of each list that was read by this file and is still in use.")

(defun form-position (form)
  "Return the SOURCE-POSITION at which the list FORM begins, or NIL if it is no list or was not
read by READ-SOURCE or LOAD-SOURCE."
  (values (gethash form *positions*)))

(defun native-path (file)
  "Return the pathname of FILE; a string is taken by its characters, so that a bracket in it makes
no pattern."
  (if (stringp file) (uiop:parse-native-namestring file) file))

(defun native-name (file)
  "Return the name of FILE, a string or a pathname, as the system knows it."
  (uiop:native-namestring (native-path file)))

(defun file-text (file)
  (let ((path (native-path file)))
    (flet ((problem (reason)
             (error 'source-error :file (native-name path) :reason reason)))
      (when (uiop:directory-exists-p (uiop:ensure-directory-pathname path))
        (problem "it is a folder"))
      (handler-case
          ;; Some editors begin a file with a byte order mark.
          (string-left-trim '(#\Zero_width_no-break_space)
                            (uiop:read-file-string path :external-format :utf-8))
        (file-error () (problem (if (uiop:file-exists-p path) "it cannot be read" "no such file")))
        (stream-error () (problem "it is not a UTF-8 text"))))))

(defun line-starts (text)
  "Return the vector of the offsets at which the lines of TEXT begin."
  (coerce (cons 0 (loop for character across text
                        for offset from 1
                        when (char= character #\Newline) collect offset))
          'simple-vector))

(defun line-at (starts offset)
  "Return the number, from 1, of the line in which OFFSET lies, by binary search in STARTS."
  (let ((low 0) (high (length starts)))
    (loop while (< (1+ low) high)
          do (let ((middle (floor (+ low high) 2)))
               (if (<= (svref starts middle) offset)
                   (setf low middle)
                   (setf high middle))))
    (1+ low)))

(defun refuse-label (stream character argument)
  (declare (ignore stream argument))
  (error "#~a is not understood in a file of data" character))

(defun tracking-readtable (file starts data)
  "Return a standard readtable whose lists are entered in *POSITIONS*.  For DATA, labels by which a
list can contain itself are refused."
  (let* ((readtable (copy-readtable nil))
         (read-list (get-macro-character #\( readtable)))
    (set-macro-character
     #\( (lambda (stream character)
           (let ((line (line-at starts (1- (file-position stream))))
                 (form (funcall read-list stream character)))
             (when (consp form)
               (setf (gethash form *positions*) (make-source-position file line)))
             form))
     nil readtable)
    (when data
      (dolist (character '(#\= #\#))
        (set-dispatch-macro-character #\# character #'refuse-label readtable)))
    readtable))

(defun skip-block-comment (stream)
  "If STREAM is at a block comment, skip it and return true."
  (let ((start (file-position stream)))
    (read-char stream)
    (cond ((eql (peek-char nil stream nil) #\|)
           (read-char stream)
           (funcall (get-dispatch-macro-character #\# #\|) stream #\| nil)
           t)
          (t (file-position stream start)
             nil))))

(defun skip-to-form (stream)
  "Skip white space and comments of STREAM and return the offset of the next character."
  (loop for character = (peek-char t stream nil)
        do (cond ((eql character #\;) (read-line stream nil))
                 ((and (eql character #\#) (skip-block-comment stream)))
                 (t (return))))
  (file-position stream))

(defun read-form (stream file starts)
  "Return the next form of STREAM, or STREAM itself at the end, and the offset where it begins."
  (let ((start (file-position stream)))
    (handler-case (progn (setf start (skip-to-form stream))
                         (values (read stream nil stream) start))
      (end-of-file ()
        (error 'source-error :file file :line (line-at starts start)
                             :reason "the form that begins here is not closed"))
      (storage-condition ()
        (error 'source-error :file file :line (line-at starts start)
                             :reason "the form that begins here is nested too deeply"))
      (error (condition)
        (error 'source-error :file file
                             :line (line-at starts (max start (1- (file-position stream))))
                             :reason (condition-sentence condition))))))

(defun map-forms (function file package &key data)
  "Call FUNCTION with each form of FILE, read in PACKAGE, and the line where it begins.  DATA: the
forms are not evaluated."
  (let* ((name (native-name file))
         (text (file-text file))
         (starts (line-starts text))
         (*package* (find-package package))
         (*read-eval* nil)
         (*readtable* (tracking-readtable name starts data))
         (*read-default-float-format* 'double-float))
    (with-input-from-string (stream text)
      (loop
        (multiple-value-bind (form start) (read-form stream name starts)
          (when (eq form stream)
            (return))
          (funcall function form (line-at starts start)))))))

(defun read-source (file &key (package *package*))
  "Return the list of the forms in FILE, read in PACKAGE; nothing is evaluated.  Numbers with a
point are double floats.  Signals SOURCE-ERROR."
  (let ((forms '()))
    (map-forms (lambda (form line) (declare (ignore line)) (push form forms)) file package
               :data t)
    (nreverse forms)))

(defgeneric self-explaining-p (condition)
  (:documentation "Return true if the report of CONDITION, signaled while a file is loaded, needs no
file and line in front of it.")
  (:method (condition) (typep condition 'source-error)))

(defun loading-problem (condition file line)
  "Signal a SOURCE-ERROR for CONDITION, signaled by a form at LINE of FILE."
  (error 'source-error
         :file file :line line
         :reason (typecase condition
                   ;; What the compiler could not make sense of, with its own first words.
                   (sb-int:compiled-program-error
                    (one-line (sb-kernel::program-error-message condition)))
                   (t (condition-sentence condition)))))

(defun debugger-hook-with-errors (hook errors)
  "Return a value of *INVOKE-DEBUGGER-HOOK* that does as HOOK with ERRORS for *ERROR-OUTPUT*."
  (lambda (condition self)
    (let ((*error-output* errors))
      (when hook
        (funcall hook condition self)))))

(defun call-with-warning-lines (function)
  "Call FUNCTION with a function that it calls with the file and the line, or NIL, that it is at.
Of what the compiler says meanwhile the warnings are printed, a line each."
  (let ((errors *error-output*)
        (file nil)
        (line nil))
    (let ((sb-ext:*invoke-debugger-hook*
            (debugger-hook-with-errors sb-ext:*invoke-debugger-hook* errors))
          (*error-output* (make-broadcast-stream)))
      (handler-bind ((warning (lambda (condition)
                                (unless (typep condition 'sb-kernel:redefinition-warning)
                                  (format errors "~&~a~@[:~d~]: warning: ~a~%" file line
                                          (condition-sentence condition)))
                                (muffle-warning condition))))
        (funcall function (lambda (new-file new-line)
                            (setf file new-file
                                  line new-line)))))))

(defun expansion-problem (condition)
  "Return what was wrong when the compiler, which has signaled CONDITION, expanded a macro."
  (let ((inner (sb-int:encapsulated-condition condition)))
    (or (and (typep inner 'simple-condition)
             (find-if (lambda (argument) (typep argument 'condition))
                      (simple-condition-format-arguments inner)))
        inner)))

(defun evaluate-form (form file line evaluator)
  "Call EVALUATOR with FORM, which begins at LINE of FILE; an error is a SOURCE-ERROR if it does not
say itself where it is."
  (handler-bind ((error (lambda (condition)
                          (unless (self-explaining-p condition)
                            (loading-problem condition (native-name file) line))))
                 ;; The compiler would make code of it that fails when it is reached.
                 (sb-c:compiler-error
                   (lambda (condition)
                     (loading-problem (expansion-problem condition) (native-name file) line))))
    ;; A plan file is code: this is its loader.
    (let ((*load-pathname* file) (*load-truename* (truename file)))
      (funcall evaluator form))))

(defun load-sources (files name &key (package *package*) (evaluator #'eval))
  "Load FILES one after the other, as LOAD-SOURCE does each, and return the list of their true
names.  Functions that any of the files defines are not undefined in another one.  NAME is what a
warning names that concerns them as a whole.  EVALUATOR is called with each form.  Signals
SOURCE-ERROR."
  (let ((files (mapcar #'native-path files)))
    (call-with-warning-lines
     (lambda (note-place)
       (with-compilation-unit (:override t)
         (dolist (file files)
           (let ((native-name (native-name file)))
             (map-forms (lambda (form line)
                          (funcall note-place native-name line)
                          (evaluate-form form file line evaluator))
                        file package)))
         (funcall note-place name nil))))
    (mapcar #'truename files)))

(defun load-source (file &key (package *package*))
  "Read the forms of FILE in PACKAGE and evaluate each before the next is read, as LOAD does.
Return the true name of FILE.  Signals SOURCE-ERROR, which names file and line, also for an error
that occurs while a form is evaluated."
  (first (load-sources (list file) (native-name file) :package package)))
