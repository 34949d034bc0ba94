(defpackage #:discrepancy-finder.json
  (:documentation "JSON text (RFC 8259) in and out, the same with each JSON library: doubles keep
their bits, keys keep their order, {} and [] differ, and nothing in a text is evaluated.")
  (:use #:cl)
  (:export
   ;; conditions
   #:json-error #:json-error-position #:json-error-reason
   ;; reading
   #:parse #:library-name
   ;; writing
   #:encode #:write-value
   ;; objects
   #:object #:get-key))
