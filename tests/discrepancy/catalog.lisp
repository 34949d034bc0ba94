;;;; The catalog: what the repository ships is found by its name.

(in-package #:discrepancy-finder.tests)

(def-suite catalog :in all)
(in-suite catalog)

(defun top-level-plans-of-all-files ()
  "Load every file in plans/ and return the names of the top-level plans, in alphabetical order."
  (sort (loop for file in (uiop:directory-files (root-file "plans/") "*.lisp")
              append (plan-names (remove-if-not #'plan:plan-top-level-p (plan:load-plan file))))
        #'string<))

(test every-shipped-plan-is-in-the-catalog
  (let ((names (top-level-plans-of-all-files)))
    (is (subsetp '("bowl-and-spoon" "bowl-and-spoon-closing" "carry-to-the-table") names
                 :test #'string=))
    (is (equal names (discrepancy::shelf-names discrepancy::*plan-shelf*)))))

(test every-shipped-domain-is-in-the-catalog
  (let ((names (discrepancy::shelf-names discrepancy::*domain-shelf*)))
    (is (equal '("bowl-and-spoon" "bowl-and-spoon-closing" "kitchen" "kitchen-drawers" "table-top"
                 "two-regions" "two-regions-minimal")
               names))
    (dolist (name names)
      (is (string= name (ec:name-text (symbolic:action-theory-name
                                       (discrepancy:ensure-domain
                                        (intern (string-upcase name) '#:keyword)))))))))

(test a-file-is-found-by-what-it-defines
  (flet ((files (name shelf)
           (mapcar #'file-namestring (discrepancy::defining-files name shelf))))
    (is (equal "drawers.lisp" (first (files :kitchen-drawers discrepancy::*domain-shelf*))))
    (is (equal "bowl-and-spoon.lisp"
               (first (files 'bowl-and-spoon-closing discrepancy::*plan-shelf*))))
    (is (null (files :nowhere discrepancy::*domain-shelf*)))))

(test a-line-defines-a-name
  (flet ((name (line) (discrepancy::defined-name line "(define-abstraction ")))
    (is (string= "kitchen" (name "(define-abstraction Kitchen")))
    (is (string= "kitchen" (name "(define-abstraction kitchen (:theory \"x.lisp\"))")))
    (is (null (name " (define-abstraction kitchen")))
    (is (null (name ";; (define-abstraction kitchen")))))

(test names-are-loaded-where-nothing-is-defined-yet
  (is (string= "(bowl-and-spoon bowl-and-spoon-closing) kitchen-drawers"
               (last-line-of-another-process
                "discrepancy-finder"
                '(format t "~&~(~a ~a~)~%"
                  (mapcar #'plan:plan-name
                   (last (df:load-plan 'discrepancy-finder-user::bowl-and-spoon-closing) 2))
                  (symbolic:action-theory-name
                   (df:load-domain 'discrepancy-finder-user::kitchen-drawers)))))))

(test unknown-names-are-told-with-the-known-ones
  (signals-with (df:plan-not-found "no plan named no-such-plan" "setting-the-table")
    (discrepancy:ensure-plan 'no-such-plan))
  (signals-with (df:domain-not-found "no domain named nowhere" "kitchen-drawers")
    (discrepancy:ensure-domain :nowhere))
  (signals-with (df:domain-not-found "no domain named nowhere" "kitchen-drawers")
    (df:load-domain 'nowhere))
  (signals-with (df:source-error "no-such-plan" "plans/")
    (df:load-plan 'no-such-plan)))
