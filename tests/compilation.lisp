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

(test plans-load-without-a-warning
  (dolist (file (uiop:directory-files (root-file "plans/") "*.lisp"))
    (let ((text (with-output-to-string (*error-output*)
                  (is (not (null (plan:load-plan file))) "~a defines no plan" file))))
      (is (string= "" text) "~a: ~a" file text))))
