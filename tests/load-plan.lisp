;;;; LOAD-PLAN: files and ASDF systems of plans, helpers, what is wrong with them.

(in-package #:discrepancy-finder.tests)

(def-suite load-plan :in all)
(in-suite load-plan)

(defmacro with-plan-files ((folder &rest names-and-texts) &body body)
  "Evaluate BODY with FOLDER bound to the name of a new folder of files with names and texts."
  `(call-with-plan-files (lambda (,folder) ,@body) (list ,@names-and-texts)))

(defun call-with-plan-files (function names-and-texts)
  (let ((folder (uiop:ensure-directory-pathname
                 (uiop:with-temporary-file (:pathname file) (namestring file)))))
    (unwind-protect
         (progn
           (loop for (name text) on names-and-texts by #'cddr
                 do (let ((file (merge-pathnames name folder)))
                      (ensure-directories-exist file)
                      (with-open-file (stream file :direction :output)
                        (write-string text stream))))
           (funcall function (namestring folder)))
      (uiop:delete-directory-tree folder :validate t :if-does-not-exist :ignore))))

(defun plan-names (plans)
  (mapcar (lambda (plan) (string-downcase (plan:plan-name plan))) plans))

(defun load-quietly (source)
  (let ((*error-output* (make-broadcast-stream)))
    (plan:load-plan source)))

(defun helper-lines (package)
  "Return the list of (name . line) of the functions of PACKAGE with a source, by line."
  (sort (loop for symbol being the present-symbols of package
              for source = (plan:plan-source symbol)
              when source
                collect (cons (string-downcase symbol)
                              (let ((position (plan:plan-position source)))
                                (and position (source:source-position-line position)))))
        #'string< :key #'car))

;;; Files

(test load-plan-returns-the-plans-of-a-file-in-their-order
  (with-file (file "(defpackage load-plan-1 (:use :cl))
(in-package load-plan-1)
(discrepancy-finder.plan-language:def-plan second-by-name () 1)
(defun helper () 2)
(discrepancy-finder.plan-language:def-plan first-by-name () 3)
(progn (discrepancy-finder.plan-language:def-plan last-one () 4))")
    (let ((expected '("second-by-name" "first-by-name" "last-one")))
      (is (equal expected (plan-names (plan:load-plan file))))
      (is (equal expected (plan-names (plan:load-plan file)))
          "plans that are defined again are returned again"))))

(test a-plan-that-is-defined-twice-is-returned-once
  (with-file (file "(def-plan twice () 1) (def-plan other () 2) (def-plan twice () 3)")
    (let ((plans (load-quietly file)))
      (is (equal '("other" "twice") (plan-names plans)))
      (is (eq (second plans) (plan:find-plan 'twice)) "the later definition counts"))))

(test load-plan-leaves-the-package-and-the-reader-alone
  (with-file (file "(defpackage load-plan-2 (:use :cl)) (in-package load-plan-2)
(defparameter *number* 0.1)
(setf *readtable* (copy-readtable nil))
(discrepancy-finder.plan-language:def-plan reading () *number*)")
    (let ((package *package*) (readtable *readtable*) (hook *macroexpand-hook*))
      (plan:load-plan file)
      (is (eq package *package*))
      (is (eq readtable *readtable*))
      (is (eq hook *macroexpand-hook*))
      (is (eql 0.1d0 (symbol-value (find-symbol "*NUMBER*" '#:load-plan-2)))))))

(test packages-of-a-plan-file-use-global-packages
  "CPL is a nickname local to the package in which the file begins to be read."
  (with-file (file "(defpackage load-plan-3 (:use :cpl)) (in-package load-plan-3)")
    (plan:load-plan file)
    (is (equal '("CRAM-LANGUAGE")
               (mapcar #'package-name (package-use-list '#:load-plan-3))))))

;;; Helpers

(test functions-of-a-plan-file-have-sources
  (with-file (file "(defpackage load-plan-4 (:use :cl)) (in-package load-plan-4)
(defun plain (x) \"Doc.\" (declare (type number x)) (1+ x))
(progn (defun in-progn () 1))
(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun in-eval-when () 1))
(defmacro define-it (name) `(defun ,name () 1))
(define-it by-macro)
(let ((count 0)) (defun over-variable () (incf count)))
(flet ((one () 1)) (defun over-function () (one)))
(macrolet ((one () 1)) (defun over-macro () (one)))
(defun (setf plain) (value x) (list value x))
(when nil (defun never () 1))
(defgeneric generic (x) (:method (x) x))
(discrepancy-finder.plan-language:def-plan a-plan () 1)")
    (let ((plans (plan:load-plan file)))
      (is (equal '("a-plan") (plan-names plans)) "helpers are no plans")
      (is (equal '(("a-plan" . 14) ("by-macro") ("in-eval-when" . 5) ("in-progn" . 3)
                   ("plain" . 2))
                 (helper-lines '#:load-plan-4))))
    (let ((source (plan:plan-source (find-symbol "PLAIN" '#:load-plan-4))))
      (is (equal "((DECLARE (TYPE NUMBER X)) (1+ X))"
                 (let ((*package* (find-package '#:load-plan-4)) (*print-pretty* nil))
                   (prin1-to-string (plan:plan-body source)))))
      (signals plan:plan-not-found (plan:find-plan (plan:plan-name source))))))

(test a-helper-that-was-redefined-has-no-source-any-more
  (with-file (file "(defun redefined-helper () 1)")
    (plan:load-plan file)
    (let ((name (find-symbol "REDEFINED-HELPER" '#:discrepancy-finder-user)))
      (is-true (plan:plan-source name))
      (setf (fdefinition name) (lambda () 2))
      (is (null (plan:plan-source name)))
      (fmakunbound name)
      (is (null (plan:plan-source name))))))

(test a-plan-that-becomes-a-helper-is-no-plan-any-more
  (with-file (file "(def-plan changing () 1)")
    (plan:load-plan file))
  (with-file (file "(defun changing () 1)")
    (is (null (load-quietly file)))
    (signals plan:plan-not-found (plan:find-plan 'changing))))

;;; Systems

(defparameter *plan-system-files*
  '("plan-system-1.asd" "
(defsystem plan-system-1
  :depends-on (alexandria (:version \"alexandria\" \"0\") (:feature :no-such-feature no-such-thing))
  :components ((:module \"parts\"
                :components ((:static-file \"data.lisp\")
                             (:file \"late\" :depends-on (\"early\"))
                             (:file \"early\" :depends-on (\"package\")) (:file \"package\")
                             (:file \"never\" :if-feature :no-such-feature)))
               (:file \"last\" :depends-on (\"parts\"))))"
    "parts/package.lisp" "(defpackage plan-system-1 (:use :discrepancy-finder.cpl)
  (:export #:order))
(in-package plan-system-1)
(defparameter order '())"
    "parts/data.lisp" "(this is not evaluated)"
    "parts/early.lisp" "(in-package :plan-system-1)
(push :early order)
(def-cram-function early () (helper))"
    "parts/late.lisp" "(in-package :plan-system-1)
(push :late order)
(def-cram-function late () (early))
(defun helper () (alexandria:ensure-list 1))"
    "parts/never.lisp" "(error \"This is loaded.\")"
    "last.lisp" "(push :last plan-system-1:order)
(plan-system-1::def-top-level-cram-function plan-system-1::main () (plan-system-1::late))"))

(defun call-with-plan-system (function &rest changes)
  (call-with-plan-files function
                        (append *plan-system-files* changes)))

(test a-system-of-plans-is-loaded-in-the-order-of-its-dependencies
  (call-with-plan-system
   (lambda (folder)
     (let* ((asd (concatenate 'string folder "plan-system-1.asd"))
            (plans nil)
            (warnings (with-output-to-string (*error-output*)
                        (setf plans (plan:load-plan asd)))))
       (is (string= "" warnings) "functions of later files are not undefined: ~a" warnings)
       (is (equal '("early" "late" "main") (plan-names plans)))
       (is (equal '(:last :late :early) (symbol-value (find-symbol "ORDER" '#:plan-system-1))))
       (is (equal '(1) (funcall (plan:plan-name (third plans)))))
       (let ((position (plan:plan-position (second plans))))
         (is (= 3 (source:source-position-line position)))
         (is (uiop:string-suffix-p (source:source-position-file position) "parts/late.lisp")))
       (is-true (plan:plan-source (find-symbol "HELPER" '#:plan-system-1)))
       ;; Once it is known to ASDF its name is enough.
       (is (equal '("early" "late" "main") (plan-names (load-quietly :plan-system-1))))
       (is (equal '("early" "late" "main") (plan-names (load-quietly 'plan-system-1))))))))

(defun asd-problem (name text &rest files)
  "Return the report of the SOURCE-ERROR that loading NAME.asd with TEXT signals."
  (call-with-plan-files
   (lambda (folder)
     (report-of 'source:source-error
                (lambda () (load-quietly (format nil "~a~a.asd" folder name)))))
   (list* (format nil "~a.asd" name) text files)))

(defmacro asd-problem-says ((name text &rest files) &rest parts)
  `(let ((report (asd-problem ,name ,text ,@files)))
     (is-true report)
     (is (null (find #\Newline (or report ""))) "one line: ~a" report)
     (dolist (part (list ,@parts))
       (is (search part (or report "")) "~s is not in: ~a" part report))))

(test what-is-wrong-with-a-system
  (signals-with (source:source-error "no-such-plan-system" "ASDF finds no system")
    (plan:load-plan :no-such-plan-system))
  (signals-with (source:source-error "/no/such/system.asd" "no such file")
    (plan:load-plan "/no/such/system.asd"))
  (asd-problem-says ("plan-system-2" "(defsystem plan-system-2 :components (")
                    "plan-system-2.asd" "end of file")
  (asd-problem-says ("plan-system-3" "(defsystem plan-system-33)")
                    "plan-system-3.asd" "it defines no system named plan-system-3")
  (asd-problem-says ("plan-system-4" "(defsystem plan-system-4 :components ((:plan \"a\")))")
                    "plan-system-4.asd" "PLAN")
  (asd-problem-says ("plan-system-5" "(defsystem plan-system-5 :depends-on (no-such-thing))")
                    "plan-system-5" "no-such-thing")
  (asd-problem-says ("plan-system-6"
                     "(defsystem plan-system-6 :components ((:c-source-file \"a\")))")
                    "plan-system-6" "component a" "c-source-file")
  (asd-problem-says ("plan-system-7" "(defsystem plan-system-7 :components ((:file \"missing\")))")
                    "missing.lisp: no such file")
  (asd-problem-says ("plan-system-8" "(defsystem plan-system-8 :components ((:file \"bad\")))"
                                     "bad.lisp" (format nil "(list)~%~%(error \"so bad\")"))
                    "bad.lisp:3: so bad"))
