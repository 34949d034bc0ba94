;;;; The HTML page of a result: well formed, self-contained, with the JSON and the pictures.

(in-package #:discrepancy-finder.tests)

(in-suite report)

(defun report-page (result)
  "Return the text of the report of RESULT."
  (with-file (file "" "html")
    (df:write-report result file)
    (uiop:read-file-string file :external-format :utf-8)))

(defun occurrences-of (part text)
  "Return how often PART occurs in TEXT."
  (loop for start = 0 then (+ position (length part))
        for position = (search part text :start2 start)
        while position count t))

(defun misplaced-tag (page)
  "Return the first end tag in PAGE that does not fit, or tags that are not closed, or NIL."
  (let ((open '()) (position 0))
    (loop
      (let ((start (position #\< page :start position)))
        (unless start (return open))
        (let* ((end (position #\> page :start start))
               (closing (char= #\/ (char page (1+ start))))
               (name-start (if closing (+ start 2) (1+ start)))
               (name (subseq page name-start
                             (position-if (lambda (character) (find character '(#\Space #\>)))
                                          page :start name-start))))
          (cond ((or (char= #\! (char page (1+ start)))
                     (member name '("meta" "br" "hr" "link") :test #'string=)))
                ((not closing) (push name open))
                ((equal name (first open)) (pop open))
                (t (return name)))
          (setf position (1+ end)))))))

(defun page-json (page)
  "Return the JSON value in the script element of PAGE."
  (let* ((begin (search "id=\"result\">" page))
         (start (+ begin (length "id=\"result\">"))))
    (json:parse (subseq page start (search "</script>" page :start2 start)))))

(test a-page-is-well-formed-and-needs-nothing-else
  (dolist (result (list (found-result) (certified-result) (undecided-result)))
    (let ((page (report-page result)))
      (is-true (uiop:string-prefix-p "<!DOCTYPE html>" page))
      (is (null (misplaced-tag page)))
      (dolist (part '("http:" "https:" "src=" "@import" "url(" "<link" "href="))
        (is-false (shows-p part page) "~s is in the page" part)))))

(test a-page-holds-the-json-of-the-result
  (is (equalp (json-of (found-result)) (page-json (report-page (found-result))))))

(test a-page-shows-each-sample-and-each-step
  (let* ((page (report-page (found-result)))
         (object (page-json page)))
    (is-true (shows-p "<h1>Discrepancy found</h1>" page))
    ;; Robot and box of the failing sample on the map; a halo below each cross.
    (is (= 2 (occurrences-of "class=\"halo\"" page)))
    ;; Two passing samples: robot and box; one in the legend.
    (is (= 5 (occurrences-of "class=\"passed\"" page)))
    (is (= (* 2 (length (json-at object "discrepancies" 0 "parameters")))
           (occurrences-of "class=\"tick-passed\"" page)))
    (is (= (length (json-at object "discrepancies" 0 "parameters"))
           (occurrences-of "class=\"tick-failed\"" page)))
    ;; One on the map, one in the legend.
    (is (= 2 (occurrences-of "class=\"trail failing\"" page)))
    (is (= 1 (occurrences-of "id=\"step-2\"" page)))
    (is (= 2 (occurrences-of "class=\"not-run\"" page)))
    (is-true (shows-p "The discrepancy was not stored." page))))

(test steps-name-files-without-folders
  (let ((node (report::node-text (report::step-name-node
                                  (json:object "designator" "(a motion (type going))"
                                               "file" "/a/b/c.lisp" "line" 3)))))
    (is (search "title=\"/a/b/c.lisp:3\">c.lisp:3<" node))))

(test what-is-no-html-is-escaped
  (is (string= "&lt;b&gt; &amp; &quot;" (report::node-text "<b> & \"")))
  (is (string= "<code title=\"&quot;\">1</code>"
               (report::node-text '(:code (:title "\"" :class nil) 1))))
  (is (string= "{\"a\":\"\\u003c/script>\"}"
               (report::script-text (json:encode (json:object "a" "</script>"))))))

(test a-report-that-cannot-be-written-is-an-error
  (signals-with (df:replay-error "/proc/nowhere")
    (df:write-report (certified-result) "/proc/nowhere/report.html")))

;;; Regions as polygons

(defun polygon-kinds (description)
  (mapcar #'first (report::description-polygons description '(0 0) '(4 4))))

(test regions-are-polygons
  (is (equal '(:inside) (polygon-kinds '(:box (:x 0 1)))))
  (is (equal '((:inside (0 0) (1 0) (1 4) (0 4)))
             (report::description-polygons '(:box (:x 0 1)) '(0 0) '(4 4))))
  (is (equal '(:inside :inside) (polygon-kinds '(:union (:box (:x 0 1)) (:box (:x 2 3))))))
  (is (equal '(:inside :without) (polygon-kinds '(:difference (:box (:x 0 3)) (:box (:x 1 2))))))
  (is (equal '(:around) (polygon-kinds '(:where (:box (:x 0 1)) evenp))))
  (is (equal '((:inside (2 1) (2 2) (1 2) (1 1)))
             (report::description-polygons '(:intersection (:box (:x 1 3) (:y 0 2))
                                             (:box (:x 0 2) (:y 1 3)))
                                           '(0 0) '(4 4)))))

(test polygons-are-clipped
  (is (= 1 (report::polygon-area (report::clipped '((-1 -1) (1 -1) (1 1) (-1 1))
                                                  '(0 0) '(4 4)))))
  (is (= 1/2 (report::polygon-area (report::clipped '((0 0) (2 0) (0 2)) '(0 1) '(1 2)))))
  (is (null (report::clipped '((5 5) (6 5) (6 6)) '(0 0) '(4 4)))))

;;; Labels and numbers

(test labels-do-not-cover-each-other
  (let* ((labels (loop for y from 100 to 104
                       collect (report::make-label 200 y "a region" "region" "start")))
         (nodes (report::label-nodes labels 400 '()))
         (ys (loop for (nil attributes) in nodes collect (getf attributes :y))))
    (is (= 5 (length ys)))
    (is (loop for (y . others) on ys
              always (every (lambda (other) (>= (abs (- y other)) 13)) others))))
  (is (null (report::label-nodes (list (report::make-label 10 10 "x" "item" "start")) 12
                                 '((0 100 10))))))

(test numbers-of-steps-are-ranges
  (is (string= "1–3, 5" (report::numbers-text '(1 2 3 5))))
  (is (string= "1, 3, …, 9" (report::numbers-text '(1 3 5 7 9)))))
