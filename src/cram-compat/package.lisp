(defpackage #:discrepancy-finder.cram-compat
  (:documentation "CRAM's global packages, built on the plan language, where CRAM itself is absent.")
  (:use #:cl))
