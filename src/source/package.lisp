(defpackage #:discrepancy-finder.source
  (:documentation "Lisp source files read with care: nothing is evaluated by the reader, and each
form knows its file and line.")
  (:use #:cl)
  (:export
   ;; positions
   #:source-position #:make-source-position #:source-position-file #:source-position-line
   #:form-position
   ;; names
   #:name-keyword
   ;; reading
   #:read-source #:load-source #:load-sources #:native-path #:native-name
   ;; definitions
   #:with-definition #:enclosing-definition
   ;; taking data apart
   #:destructuring-or
   ;; conditions
   #:source-error #:source-error-file #:source-error-line #:source-error-reason
   #:condition-sentence #:self-explaining-p))
