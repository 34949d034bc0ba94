;;;; What can be wrong with a .e file, and what is only strange in one.

(in-package #:discrepancy-finder.event-calculus)

(define-condition e-file-error (event-calculus-error)
  ((file :initarg :file :initform nil :reader e-file-error-file
         :documentation "The name of the file, of the text that stands for one, or NIL for a theory
that cannot be written.")
   (line :initarg :line :initform nil :reader e-file-error-line
         :documentation "The line, counted from 1, or NIL where none is to blame.")
   (reason :initarg :reason :reader e-file-error-reason
           :documentation "What is wrong and what was expected, as a string without a full stop."))
  (:report (lambda (condition stream)
             (with-slots (file line reason) condition
               (format stream "~@[~a~]~@[:~d~]~:[~;: ~]~a." file line file reason))))
  (:documentation "Signaled when a .e file is missing or not well-formed, or a theory cannot be said
in that language.  The report names file and line, and what was expected."))

(defmethod source:self-explaining-p ((condition e-file-error))
  t)

(define-condition e-file-warning (warning)
  ((file :initarg :file :reader e-file-warning-file
         :documentation "The name of the file, or of the text that stands for one.")
   (line :initarg :line :reader e-file-warning-line
         :documentation "The line, counted from 1.")
   (reason :initarg :reason :reader e-file-warning-reason
           :documentation "What is strange, as a string without a full stop."))
  (:report (lambda (condition stream)
             (with-slots (file line reason) condition
               (format stream "~a:~d: ~a." file line reason))))
  (:documentation "Signaled for what a .e file says in vain: an option that is not known."))

(defun e-problem (file line control &rest arguments)
  "Signal an E-FILE-ERROR."
  (error 'e-file-error :file file :line line :reason (apply #'format nil control arguments)))
