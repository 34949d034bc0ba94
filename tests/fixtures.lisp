;;;; What several suites use: temporary files, texts, the domain of Example 1.

(in-package #:discrepancy-finder.tests)

(defun call-with-temporary-file (text type function)
  (uiop:with-temporary-file (:pathname file :type type)
    (with-open-file (stream file :direction :output :if-exists :supersede :external-format :utf-8)
      (write-string text stream))
    (funcall function (namestring file))))

(defmacro with-file ((file text &optional (type "lisp")) &body body)
  "Evaluate BODY with FILE bound to the name of a temporary file that holds TEXT."
  `(call-with-temporary-file ,text ,type (lambda (,file) ,@body)))

(defun report-of (condition-class function)
  "Call FUNCTION and return the report of the condition of CONDITION-CLASS that it signals, or NIL."
  (handler-case (progn (funcall function) nil)
    (serious-condition (condition)
      (if (typep condition condition-class)
          (princ-to-string condition)
          (format nil "~a: ~a" (type-of condition) condition)))))

(defmacro signals-with ((condition-class &rest parts) &body body)
  "Check that BODY signals a condition of CONDITION-CLASS whose report is one line and contains each
of the strings PARTS."
  `(let ((report (report-of ',condition-class (lambda () ,@body))))
     (is-true report "nothing was signaled")
     (is (null (find #\Newline (or report ""))) "more than one line: ~a" report)
     (dolist (part (list ,@parts))
       (is (search part (or report "")) "~s is not in: ~a" part report))))

(defun root-file (name)
  "Return the path of NAME in the source tree."
  (namestring (asdf:system-relative-pathname "discrepancy-finder" name)))

(defun two-regions ()
  "Return the domain of Example 1."
  (discrepancy:ensure-domain :two-regions))

(defun resident-megabytes ()
  "Return the megabytes of memory that this process has."
  (with-open-file (stream "/proc/self/statm")
    (read stream)
    (/ (* 4096 (read stream)) 1d6)))

(defun last-line-of-another-process (system &rest forms)
  "Return the last line that FORMS print, evaluated one after the other in a new process that has
loaded SYSTEM (a string) from this source tree."
  (let ((forms (list* '(require :asdf)
                      `(asdf:load-asd ,(namestring (asdf:system-source-file "discrepancy-finder")))
                      `(asdf:load-system ,system)
                      forms)))
    (uiop:run-program
     (list* (namestring sb-ext:*runtime-pathname*)
            "--noinform" "--no-sysinit" "--no-userinit" "--non-interactive"
            (loop for form in forms
                  collect "--eval"
                  collect (with-standard-io-syntax
                            (let ((*package* (find-package '#:keyword)) (*print-readably* nil))
                              (prin1-to-string form)))))
     :output (lambda (stream)
               (loop for line = (read-line stream nil)
                     while line for last = line finally (return last))))))

(defun call-in-new-folder (function)
  "Call FUNCTION with the name of a new folder, and delete that afterwards."
  (let ((folder (ensure-directories-exist
                 (merge-pathnames (format nil "discrepancy-finder-~36r/" (random (expt 36 8)))
                                  (uiop:temporary-directory)))))
    (unwind-protect (funcall function (namestring folder))
      (uiop:delete-directory-tree folder :validate t))))
