;;;; Coverage: which forms, outcomes and axioms an exploration has made use of.

(in-package #:discrepancy-finder.tests)

(def-suite coverage :in all)
(in-suite coverage)

(defparameter *covered-plan* "
(def-cram-function never-called (?lamp)
  (perform (a motion (type smashing) (lamp ?lamp))))
(def-top-level-cram-function lamp-plan ()
  ;; (perform \"in a comment <&>\")
  (let ((sentence \"(perform <this> & that\"))
    (when (string= sentence \"other\")
      (perform (a motion (type smashing) (lamp b))))
    (if (string/= sentence \"other\") (list sentence) (vector sentence))
    (with-failure-handling ((gripper-goal-not-reached () (return)))
      (perform (a motion (type toggling) (lamp a))))
    (unless (char= #\\( (char sentence 0)) (list 1))))
")

(defun call-with-coverage (function &key (text *covered-plan*))
  (make-lamp-domain)
  (with-file (file text)
    (plan:load-plan file)
    (let ((exploration (symbolic:explore-plan 'discrepancy-finder-user::lamp-plan
                                              :domain :lamps :constraint 'anything :coverage t)))
      (funcall function (symbolic:coverage exploration) file))))

(defun states-of-line (coverage line)
  "Return a list of (operator . state) for the forms that begin on LINE."
  (loop for form in (symbolic:coverage-forms coverage)
        when (= line (source:source-position-line (symbolic:covered-form-position form)))
          collect (cons (let ((operator (first (symbolic:covered-form-form form))))
                          (intern (symbol-name operator) :keyword))
                        (symbolic:covered-form-state form))))

(test forms-are-covered-or-not
  (call-with-coverage
   (lambda (coverage file)
     (declare (ignore file))
     (is (equal '((:perform . :never) (:a . :never)) (states-of-line coverage 3)))
     (is (equal '((:let . :covered)) (states-of-line coverage 6)))
     (is (equal '((:when . :one-branch) (:string= . :covered)) (states-of-line coverage 7)))
     (is (equal '((:perform . :never) (:a . :never)) (states-of-line coverage 8)))
     (is (alexandria:set-equal '((:if . :one-branch) (:string/= . :covered) (:list . :covered)
                                 (:vector . :never))
                               (states-of-line coverage 9) :test #'equal))
     (is (member '(:return . :covered) (states-of-line coverage 10) :test #'equal))
     (is (member '(:unless . :one-branch) (states-of-line coverage 12) :test #'equal)))))

(test branches-of-conditions
  (call-with-coverage
   (lambda (coverage file)
     (declare (ignore file))
     (is (equal '((:if . :covered)) (remove :if (states-of-line coverage 3)
                                            :key #'first :test-not #'eq)))
     (is (equal '(2 2) (getf (symbolic:coverage-figures coverage) :branches))))
   :text "
(def-top-level-cram-function lamp-plan ()
  (dotimes (i 2) (if (= i 0) 1 2))
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))))"))

(test outcomes-and-axioms-that-were-never-used
  (call-with-coverage
   (lambda (coverage file)
     (declare (ignore file))
     (is (equal '(("motion toggling: success" . t)
                  ("motion toggling: gripper-goal-not-reached" . t)
                  ("motion smashing: success"))
                (symbolic:coverage-outcomes coverage)))
     (is (equal '("motion smashing: success") (symbolic:never-taken-outcomes coverage)))
     (is (null (symbolic:never-exercised-axioms coverage)))))
  (call-with-coverage
   (lambda (coverage file)
     (declare (ignore file))
     (is (equal '(:toggle-on :toggle-off) (symbolic:never-exercised-axioms coverage)))
     (is (equal '("motion toggling: success" "motion toggling: gripper-goal-not-reached")
                (symbolic:never-taken-outcomes coverage))))
   :text "
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp a))))"))

(test coverage-is-recorded-on-request
  (signals-with (symbolic:coverage-not-recorded "lamp-plan" ":coverage t")
    (symbolic:coverage (explore-text "(def-top-level-cram-function lamp-plan () 1)"
                                     :constraint 'anything)))
  (call-with-coverage
   (lambda (coverage file)
     (declare (ignore file))
     (is (equal '(:one-branch)
                (remove-duplicates
                 (mapcar #'cdr (remove :when (states-of-line coverage 7)
                                       :key #'first :test-not #'eq))))
         "what an exploration without coverage has analyzed does not count"))))

(test coverage-as-text
  (call-with-coverage
   (lambda (coverage file)
     (let ((text (with-output-to-string (stream) (symbolic:print-coverage coverage stream))))
       (is (uiop:string-prefix-p "Coverage of lamp-plan in lamps: " text))
       (dolist (line (list file
                           "    3 -   (perform (a motion (type smashing) (lamp ?lamp))))"
                           "    5     ;; (perform \"in a comment <&>\")"
                           "    7 ~     (when (string= sentence \"other\")"
                           "   11 +       (perform (a motion (type toggling) (lamp a))))"
                           "  - motion smashing: success"
                           "  + motion toggling: gripper-goal-not-reached"
                           "  + broken-is-dark"))
         (is (search (format nil "~%~a~%" line) text) "~s is not in~%~a" line text))))))

;;; The page

(defun tags-balanced-p (page)
  "Return true if each element of PAGE is closed where it must be."
  (let ((open '()) (position 0))
    (loop for start = (position #\< page :start position)
          while start
          do (let* ((end (position #\> page :start start))
                    (tag (subseq page (1+ start) end))
                    (name (subseq tag 0 (position #\Space tag))))
               (cond ((char= (char tag 0) #\!))
                     ((char= (char tag 0) #\/)
                      (unless (equal (pop open) (subseq name 1)) (return-from tags-balanced-p nil)))
                     ((string= name "meta"))
                     (t (push name open)))
               (setf position end)))
    (null open)))

(defun page-of (coverage)
  (uiop:with-temporary-file (:pathname file :type "html")
    (symbolic:write-coverage-html coverage (namestring file))
    (values (uiop:read-file-string file :external-format :utf-8)
            (uiop:directory-files (uiop:pathname-directory-pathname file)
                                  (format nil "~a.part" (pathname-name file))))))

(test coverage-as-a-page
  (call-with-coverage
   (lambda (coverage file)
     (declare (ignore file))
     (multiple-value-bind (page parts) (page-of coverage)
       (is (null parts) "the temporary file is gone")
       (is (uiop:string-prefix-p "<!DOCTYPE html>" page))
       (is-true (tags-balanced-p page))
       (is (null (search "<script" page)))
       (is (null (search "<this>" page)))
       (dolist (part '("&quot;(perform &lt;this&gt; &amp; that&quot;"
                       "<span class=\"one-branch\">(when </span><span class=\"covered\">(string= "
                       "<span class=\"never\">(vector sentence)</span>"
                       "<li><span class=\"never\">motion smashing: success</span> (never)</li>"))
         (is (search part page) "~a is not in~%~a" part page))))))
