;;;; What can be wrong with a file of forms, and reports on one line.

(in-package #:discrepancy-finder.source)

(define-condition source-error (error)
  ((file :initarg :file :reader source-error-file
         :documentation "The file as the user named it.")
   (line :initarg :line :initform nil :reader source-error-line
         :documentation "The line, counted from 1, or NIL where none is to blame.")
   (reason :initarg :reason :reader source-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "~a~@[:~d~]: ~a."
                     (source-error-file condition)
                     (source-error-line condition)
                     (string-right-trim "." (source-error-reason condition)))))
  (:documentation "Signaled when a file of Lisp forms is missing or cannot be read or loaded."))

(defun one-line (text)
  "Return TEXT with every run of white space made one space."
  (format nil "~{~a~^ ~}"
          (remove "" (uiop:split-string text :separator '(#\Space #\Newline #\Tab))
                  :test #'string=)))

(defun condition-sentence (condition)
  "Return the report of CONDITION as a string of one line, without the details that SBCL's reader
adds about its stream."
  (one-line
   (typecase condition
     (reader-error
      (if (typep condition 'simple-condition)
          (apply #'format nil (simple-condition-format-control condition)
                 (simple-condition-format-arguments condition))
          (princ-to-string condition)))
     (t (princ-to-string condition)))))
