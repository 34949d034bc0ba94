(in-package #:discrepancy-finder.foreign)

(define-condition foreign-library-missing (error)
  ((name :initarg :name :reader foreign-library-missing-name
         :documentation "What the library is, as a string for people.")
   (candidates :initarg :candidates :reader foreign-library-missing-candidates
               :documentation "The file names that were tried, in order.")
   (hint :initarg :hint :reader foreign-library-missing-hint
         :documentation "How to get it, as a string."))
  (:report (lambda (condition stream)
             (format stream "The library of ~a is missing (tried ~{~a~^, ~}): ~a."
                     (foreign-library-missing-name condition)
                     (foreign-library-missing-candidates condition)
                     (foreign-library-missing-hint condition))))
  (:documentation "Signaled when no candidate of a shared library can be opened."))
