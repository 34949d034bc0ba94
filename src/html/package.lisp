(defpackage #:discrepancy-finder.html
  (:documentation "HTML and SVG from lists.")
  (:use #:cl)
  (:export #:write-node #:node-text #:value-string #:write-escaped))
