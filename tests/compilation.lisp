;;;; The system compiles without a warning, style warnings included.

(in-package #:discrepancy-finder.tests)

(def-suite compilation :in all)
(in-suite compilation)

(test no-warning-in-the-build
  "The log of the last build of the executable, which compiles what has changed."
  (executable)
  (let ((log (root-file "build/build.log")))
    (is (null (and (uiop:file-exists-p log)
                   (find-if (lambda (line) (search "WARNING" line))
                            (uiop:read-file-lines log)))))))
