;;;; The names of CRAM's ASDF systems.
;;;;
;;;; The systems of plan files depend on systems of CRAM.  Where ASDF finds none of such a name,
;;;; these registrations make it believe that it is loaded, which, so far as plans go, it is.

(in-package #:discrepancy-finder.cram-compat)

(defparameter *further-systems*
  '("cram-core" "cram-math" "cram-test-utilities" "cram-execution-trace" "cl-tf2"
    "cram-manipulation-interfaces")
  "Systems of CRAM without a package of the table that systems of plans depend on.")

(dolist (system (remove-duplicates
                 (append (mapcar #'compat-package-system (compat-packages)) *further-systems*)
                 :test #'string=))
  (asdf:register-preloaded-system system))
