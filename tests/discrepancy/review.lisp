;;;; Verdicts on plans that rest on what a stored discrepancy contradicts.

(in-package #:discrepancy-finder.tests)

(def-suite review :in all)
(in-suite review)

(defun call-with-store (function)
  "Call FUNCTION with the name of a folder that holds the discrepancy of Example 1."
  (let ((folder (namestring (uiop:ensure-directory-pathname
                             (format nil "~areview-~d/" (namestring (uiop:temporary-directory))
                                     (sb-unix:unix-getpid))))))
    (ensure-directories-exist folder)
    (unwind-protect
         (progn (discrepancy:save-discrepancy (found-in-example 1)
                                              (format nil "~afound.json" folder))
                (funcall function folder))
      (uiop:delete-directory-tree (pathname folder) :validate t :if-does-not-exist :ignore))))

(defun reviewed (plan property store)
  (discrepancy:review-plan plan :domain :two-regions :property property :store store))

(test a-verdict-on-a-plan-that-picks-up-is-in-doubt
  (call-with-store
   (lambda (folder)
     (dolist (property '(:no-failure (:never box-delivered)))
       (let* ((review (reviewed 'discrepancy-finder-user::move-the-box property folder))
              (doubt (first (discrepancy:review-doubts review)))
              (text (discrepancy:review-text review)))
         (is (eq (if (eq property :no-failure) :verified :counterexample)
                 (discrepancy:review-verdict review)))
         (is-true (nth-value 1 (discrepancy:review-verdict review)))
         (is (equal '((:binding :action :picking-up)) (discrepancy:doubt-grounds doubt)))
         (is (eq :same-bits (discrepancy:doubt-status doubt)))
         (is (search "IN DOUBT" text))
         (is (search "found.json: pick-up ends with manipulation-pose-unreachable, with reach = 0.5"
                     text)
             "~a" text))))))

(plan:def-top-level-cram-function review-drives-only ()
  (let ((?pose (discrepancy-finder.geometry:make-pose 1.5 0 0)))
    (plan:perform (plan:a motion (type going) (pose ?pose)))))

(test a-verdict-on-a-plan-that-only-drives-is-not
  (call-with-store
   (lambda (folder)
     (let ((review (reviewed 'review-drives-only :no-failure folder)))
       (is (equal '(:verified nil) (multiple-value-list (discrepancy:review-verdict review))))
       (is (null (discrepancy:review-doubts review)))
       (is (search "No stored discrepancy touches the verdict (1 replayed)."
                   (discrepancy:review-text review)))))))

(test a-discrepancy-that-does-not-show-again-casts-no-doubt
  (call-with-store
   (lambda (folder)
     (let* ((file (format nil "~afound.json" folder))
            (text (uiop:read-file-string file)))
       (with-open-file (stream file :direction :output :if-exists :supersede)
         (write-string (let ((start (search "\"box.x\": " text)))
                         (format nil "~a\"box.x\": 1.6~a" (subseq text 0 start)
                                 (subseq text (position #\, text :start start))))
                       stream))
       (let ((review (reviewed 'discrepancy-finder-user::move-the-box :no-failure folder)))
         (is (null (discrepancy:review-doubts review)))
         (is (search "it does not show again: the run is consistent now"
                     (discrepancy:review-text review))))))))

(test a-file-that-cannot-be-read-is-reported-and-a-missing-folder-is-empty
  (call-with-store
   (lambda (folder)
     (let ((file (format nil "~abroken.json" folder)))
       (with-open-file (stream file :direction :output)
         (write-string "{\"domain\": {\"name\": \"two-regions\"}}" stream))
       (let ((review (reviewed 'discrepancy-finder-user::move-the-box :no-failure folder)))
         (is (= 1 (length (discrepancy:review-doubts review))))
         (is (search "broken.json" (discrepancy:review-text review)))))))
  (is (null (discrepancy:review-doubts
             (reviewed 'discrepancy-finder-user::move-the-box :no-failure
                       "/nonexistent-folder/")))))

(test what-the-paths-of-a-plan-rest-on
  (let* ((verification (symbolic:verify-plan 'discrepancy-finder-user::move-the-box
                                             :domain :two-regions :property :no-failure
                                             :coverage t))
         (grounds (symbolic:exploration-grounds
                   (symbolic:verification-exploration verification))))
    (flet ((among-p (ground) (member ground grounds :test #'equal)))
      (is-true (among-p '(:axiom :move-carries-there)))
      (is-true (among-p '(:inertia :holding-box :move t)))
      (is-true (among-p '(:inertia :box-in :move nil)) "the box in r1, on the first way")
      (is-true (among-p '(:inertia :robot-in :pick-up t)))
      (is-false (among-p '(:inertia :holding-box :put-down t)))
      (is-true (among-p '(:binding :motion :going))))))

;;; docs/explanations.md

(defun shows-lines-p (text lines)
  "Check that all LINES, but for \"...\", are lines of TEXT, in this order."
  (let ((start 0))
    (dolist (line lines)
      (unless (string= line "...")
        (let ((place (search (format nil "~a~%" line) text :start2 start)))
          (is-true place "~s is not in~%~a" line text)
          (when place (setf start place)))))))

(test the-text-on-explanations-shows-one
  (shows-lines-p (discrepancy:explanation-text
                  (discrepancy:explain-discrepancy (found-in-example 1) :runs '()))
                 (text-block "docs/explanations.md" "  why (timepoint n is after step n)")))

(test the-text-on-explanations-shows-a-review
  (call-with-store
   (lambda (folder)
     (shows-lines-p (discrepancy:review-text
                     (reviewed 'discrepancy-finder-user::move-the-box :no-failure folder))
                    (text-block "docs/explanations.md" "#<VERIFICATION")))))
