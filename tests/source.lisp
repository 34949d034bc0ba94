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
