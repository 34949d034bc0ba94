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

(defun file-text (file)
  (handler-case (uiop:read-file-string file :external-format :utf-8)
    (file-error () (error 'source-error :file (namestring file) :reason "no such file"))
    (error (condition)
      (error 'source-error :file (namestring file)
                           :reason (format nil "not a UTF-8 text: ~a"
                                           (condition-sentence condition))))))

(defun line-at (text offset)
  (1+ (count #\Newline text :end (min offset (length text)))))

(defun tracking-readtable (file text)
  "Return a standard readtable whose lists are entered in *POSITIONS*."
  (let* ((readtable (copy-readtable nil))
         (read-list (get-macro-character #\( readtable)))
    (set-macro-character
     #\( (lambda (stream character)
           (let ((line (line-at text (1- (file-position stream))))
                 (form (funcall read-list stream character)))
             (when (consp form)
               (setf (gethash form *positions*) (make-source-position file line)))
             form))
     nil readtable)
    readtable))

(defun skip-to-form (stream)
  "Skip white space and line comments of STREAM and return the offset of the next character."
  (loop for character = (peek-char t stream nil)
        while (eql character #\;)
        do (read-line stream nil))
  (file-position stream))

(defun read-form (stream file text)
  "Return the next form of STREAM, or STREAM itself at the end, and the offset where it begins."
  (let ((start (skip-to-form stream)))
    (handler-case (values (read stream nil stream) start)
      (end-of-file ()
        (error 'source-error :file file :line (line-at text start)
                             :reason "the form that begins here is not closed"))
      (error (condition)
        (error 'source-error :file file
                             :line (line-at text (or (file-position stream) start))
                             :reason (condition-sentence condition))))))

(defun map-forms (function file package)
  "Call FUNCTION with each form of FILE, read in PACKAGE, and the line where it begins."
  (let* ((name (namestring file))
         (text (file-text file))
         (*package* (find-package package))
         (*read-eval* nil)
         (*readtable* (tracking-readtable name text))
         (*read-default-float-format* 'double-float))
    (with-input-from-string (stream text)
      (loop
        (multiple-value-bind (form start) (read-form stream name text)
          (when (eq form stream)
            (return))
          (funcall function form (line-at text start)))))))

(defun read-source (file &key (package *package*))
  "Return the list of the forms in FILE, read in PACKAGE; nothing is evaluated.  Numbers with a
point are double floats.  Signals SOURCE-ERROR."
  (let ((forms '()))
    (map-forms (lambda (form line) (declare (ignore line)) (push form forms)) file package)
    (nreverse forms)))

(defgeneric self-explaining-p (condition)
  (:documentation "Return true if the report of CONDITION, signaled while a file is loaded, needs no
file and line in front of it.")
  (:method (condition) (typep condition 'source-error)))

(defun load-source (file &key (package *package*))
  "Read the forms of FILE in PACKAGE and evaluate each before the next is read, as LOAD does.
Return the true name of FILE.  Signals SOURCE-ERROR, which names file and line, also for an error
that occurs while a form is evaluated."
  (let ((name (namestring file)))
    (map-forms
     (lambda (form line)
       (handler-bind
           ((error (lambda (condition)
                     ;; Errors that say file and line themselves pass.
                     (unless (self-explaining-p condition)
                       (error 'source-error :file name :line line
                                            :reason (condition-sentence condition))))))
         ;; A plan file is code: this is its loader.
         (let ((*load-pathname* (pathname file)) (*load-truename* (truename file)))
           (eval form))))
     file package)
    (truename file)))
