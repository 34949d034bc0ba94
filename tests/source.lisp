(in-package #:discrepancy-finder.tests)

(def-suite source :in all)
(in-suite source)

(test forms-know-their-lines
  (with-file (file (format nil ";; a comment~%(one~%  (two))~%#| block |#~%(three)"))
    (let ((forms (source:read-source file :package '#:discrepancy-finder.tests)))
      (is (equal '((one (two)) (three)) forms))
      (is (= 2 (source:source-position-line (source:form-position (first forms)))))
      (is (= 3 (source:source-position-line (source:form-position (second (first forms))))))
      (is (= 5 (source:source-position-line (source:form-position (second forms)))))
      (is (null (source:form-position '(one)))))))

(test numbers-are-double-floats
  (with-file (file "(0.1 1.5e3)")
    (is (equal '((0.1d0 1.5d3)) (source:read-source file)))))

(defvar *evaluated* nil
  "Set by a file that should not be able to.")

(test reading-evaluates-nothing
  (setf *evaluated* nil)
  (with-file (file (format nil "(+ 1 1)~%(a #.(setf discrepancy-finder.tests::*evaluated* t))"))
    (signals-with (source:source-error ":2: " "#.") (source:read-source file))
    (signals-with (source:source-error ":2: " "#.") (source:load-source file)))
  (is (null *evaluated*)))

(test what-cannot-be-read-is-named
  (signals-with (source:source-error "no/such.lisp" "no such file")
    (source:read-source "no/such.lisp"))
  (with-file (file (format nil "(fine)~%~%(not (closed)~%"))
    (signals-with (source:source-error ":3: " "not closed") (source:read-source file)))
  (with-file (file (format nil "(fine)~%(nowhere:symbol)"))
    (signals-with (source:source-error ":2: ") (source:read-source file)))
  (with-file (file (format nil "(fine)~%)"))
    (signals-with (source:source-error ":2: ") (source:read-source file))))

(test an-error-while-loading-is-named
  (with-file (file (format nil "(+ 1 1)~%~%(error \"this~~%is wrong\")"))
    (signals-with (source:source-error ":3: " "this is wrong") (source:load-source file))))

(test warnings-are-a-line-each
  (with-file (file (format nil "(defun unused-of-the-tests (x) 1)~%~%(defun later-of-the-tests ()~
                                ~%  (defined-below-of-the-tests no-such-variable-of-the-tests))~
                                ~%(defun defined-below-of-the-tests (x) x)"))
    (let* ((text (with-output-to-string (*error-output*) (source:load-source file)))
           (lines (remove "" (uiop:split-string text :separator '(#\Newline)) :test #'string=)))
      (is (= 2 (length lines)) "~a" text)
      (is (search ":1: warning: The variable X is defined but never used" (first lines)))
      (is (search ": warning: undefined variable" (second lines))))))

(test odd-files
  (with-file (file (format nil "~c(one)" (code-char #xfeff)))
    (is (equal '((one)) (source:read-source file :package '#:discrepancy-finder.tests))
        "a byte order mark"))
  (with-file (file "#1=(a . #1#)")
    (signals-with (source:source-error "#=") (source:read-source file)))
  (with-file (file (make-string 300000 :initial-element #\())
    (signals-with (source:source-error ":1: ") (source:read-source file)))
  (signals-with (source:source-error "folder")
    (source:read-source (namestring (uiop:temporary-directory)))))

(test what-the-debugger-says-is-not-lost
  "Where nobody handles an error, what is said of it goes where *ERROR-OUTPUT* was."
  (with-file (file "(invoke-debugger (make-condition 'simple-error
                                     :format-control \"nobody handles this\"))")
    (is (search "nobody handles this"
                (with-output-to-string (*error-output*)
                  (catch 'left
                    (let ((sb-ext:*invoke-debugger-hook*
                            (lambda (condition hook)
                              (declare (ignore hook))
                              (format *error-output* "~a" condition)
                              (throw 'left nil))))
                      (source:load-source file))))))))
