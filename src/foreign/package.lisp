(defpackage #:discrepancy-finder.foreign
  (:documentation "What every binding to a shared library needs: finding the library, opening it,
closing it before an image is saved, and calling into it with the float traps of C.")
  (:use #:cl)
  (:export
   ;; conditions
   #:foreign-library-missing #:foreign-library-missing-name #:foreign-library-missing-candidates
   ;; libraries
   #:define-library #:open-libraries #:close-libraries #:library-directory
   ;; time
   #:monotonic-nanoseconds #:monotonic-seconds #:processor-seconds
   ;; float traps
   #:with-c-float-traps))
