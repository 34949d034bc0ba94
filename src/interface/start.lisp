;;;; What the shell script discrepancy-finder loads into a plain SBCL: building the executable,
;;;; running the tests, running the benchmarks.

(require :asdf)
(asdf:load-asd (merge-pathnames "../../discrepancy-finder.asd" *load-truename*))

(defun build-executable ()
  "Load the system, with CRAM's packages for plan files that use them, and save it as
build/discrepancy-finder.new."
  (handler-case (progn (asdf:load-system "discrepancy-finder")
                       (asdf:load-system "discrepancy-finder/cram-compat"))
    (error (condition)
      (format *error-output* "~&~a~%" condition)
      (sb-ext:exit :code 2 :abort t)))
  (uiop:symbol-call '#:discrepancy-finder '#:save-executable
                    (asdf:system-relative-pathname "discrepancy-finder"
                                                   "build/discrepancy-finder.new")))

(defun option-p (name)
  (member name (rest sb-ext:*posix-argv*) :test #'string=))

(defun run-tests ()
  "Run the test suites, the long ones, too, if --long is on the command line, and those that look at
reports in a browser, if --browser is.  The last line of output counts the checks; the exit status
is 0 if none failed, else 1."
  (handler-bind ((warning #'muffle-warning))
    (let ((*standard-output* (make-broadcast-stream)))
      (asdf:load-system "discrepancy-finder/tests")))
  (sb-ext:exit :code (if (uiop:symbol-call '#:discrepancy-finder.tests '#:report-all-tests
                                           :long (option-p "--long")
                                           :browser (option-p "--browser"))
                         0
                         1)
               :abort nil))

(defun run-benchmarks ()
  "Run the benchmarks."
  (handler-bind ((warning #'muffle-warning))
    (let ((*standard-output* (make-broadcast-stream)))
      (asdf:load-system "discrepancy-finder/bench")))
  (uiop:symbol-call '#:discrepancy-finder.bench '#:print-benchmarks))
