;;;; Reports in a browser: Chromium, without a window, shows what the JSON says.
;;;;
;;;; Run by `test --browser` only.  A script that is added to a copy of the page writes what can be
;;;; seen of it, as the browser lays it out, into an element; the browser's dump of the page is
;;;; read.

(in-package #:discrepancy-finder.tests)

(def-suite browser :in report
  :description "Does nothing unless *BROWSER* is true.")
(in-suite browser)

(defparameter *measuring-script* "
<pre id=\"seen\"></pre>
<script>
const seen = {};
const all = (selector) => Array.from(document.querySelectorAll(selector));
const texts = (selector) => all(selector).map((element) => element.innerText.trim());
const inside = (element) => {
  const box = element.getBoundingClientRect();
  return box.width > 0 && box.height > 0 && box.left >= 0
    && box.right <= document.documentElement.clientWidth; };
seen.title = document.title;
seen.banner = texts('.banner')[0];
seen.figures = texts('.figures dd');
seen.rows = texts('.timeline tbody tr:not(.note-row)');
seen.diverging = texts('tr.diverging');
seen.states = texts('.states tbody tr');
seen.parameters = texts('.strips tbody code');
seen.commands = texts('pre.command');
seen.headings = texts('h2');
seen.facts = texts('.facts')[0];
seen.crosses = all('svg.map path.failed').length;
seen.maps = all('svg.map').filter(inside).length;
seen.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
seen.cut = all('td, th, p, li, dd, pre').filter((element) => element.scrollWidth
                                                > element.clientWidth + 1
                  && getComputedStyle(element).overflowX == 'visible'
                  && getComputedStyle(element).display != 'inline').map((e) => e.innerText);
seen.passedColor = getComputedStyle(document.querySelector('.axis, .frame')).stroke;
// When all that was asked for has come, or has not.
addEventListener('load', () => {
  seen.requests = performance.getEntriesByType('resource').map((entry) => entry.name);
  document.getElementById('seen').textContent = JSON.stringify(seen); });
</script>
</body>"
  "Put at the end of a page.")

(defun unescaped (text)
  "Return TEXT with the character references that browsers write replaced."
  (loop for (reference character) in '(("&lt;" "<") ("&gt;" ">") ("&quot;" "\"")
                                       ("&nbsp;" " ") ("&amp;" "&"))
        do (setf text (replace-all text reference character)))
  text)

(defun seen-in-browser (page &key (width 1200))
  "Return what Chromium, in a window of WIDTH pixels, shows of the text PAGE: a JSON object."
  (let ((profile (namestring (merge-pathnames (format nil "df-browser-~36r/"
                                                      (random (expt 36 8)))
                                              (uiop:temporary-directory)))))
    (unwind-protect
         (with-file (file (replace-all page "</body>" *measuring-script*) "html")
           (let* ((dump (uiop:run-program
                         (list "chromium" "--headless" "--no-sandbox" "--disable-gpu"
                               (format nil "--user-data-dir=~a" profile)
                               (format nil "--window-size=~d,1000" width)
                               "--dump-dom" (format nil "file://~a" file))
                         :output :string :error-output nil))
                  (start (+ (search "id=\"seen\">" dump) (length "id=\"seen\">")))
                  (end (search "</pre>" dump :start2 start)))
             (json:parse (unescaped (subseq dump start end)))))
      (uiop:delete-directory-tree (pathname profile) :validate t :if-does-not-exist :ignore))))

(defun strings-of (object key)
  (coerce (json-at object key) 'list))

(defmacro is-in (part text)
  "Check that the string PART is in TEXT."
  `(let ((part ,part) (text ,text))
     (is (search part text) "~s is not in ~s" part text)))

(defun check-rows (rows theory simulation)
  "Check that ROWS, texts, are the steps of THEORY and SIMULATION, objects of a result."
  (let ((steps (json-at theory "steps")) (runs (json-at simulation "steps")))
    (is (= (length rows) (max (length steps) (length runs))))
    (loop for row in rows
          for number from 0
          do (is-in (princ-to-string (1+ number)) row)
             (when (< number (length steps))
               (is-in (json-at steps number "designator") row)
               (is-in (json-at steps number "event") row))
             (if (< number (length runs))
                 (is-in (json-at runs number "outcome") row)
                 (is-in "not reached" row)))))

(defun check-layout (seen)
  "Check that nothing of SEEN sticks out, and that the page asked for nothing."
  (is (= 0 (json-at seen "overflow")))
  (is (equalp #() (json-at seen "cut")))
  (is (equalp #() (json-at seen "requests")))
  ;; The style sheet is in force.
  (is (string= "rgb(197, 203, 214)" (json-at seen "passedColor"))))

(defun check-figures (seen object)
  (is (equal (list (princ-to-string (json-at object "iterations"))
                   (princ-to-string (json-at object "simulations")))
             (subseq (strings-of seen "figures") 0 2))))

(test a-browser-shows-the-discrepancy
  (when *browser*
    (let* ((object (json-of (found-result)))
           (found (json-at object "discrepancies" 0))
           (page (report-page (found-result))))
      (dolist (width '(1200 700))
        (let ((seen (seen-in-browser page :width width)))
          (check-layout seen)
          (check-figures seen object)
          (is (string= "Discrepancy found: plan move-the-box" (json-at seen "title")))
          (is-in "Discrepancy found" (json-at seen "banner"))
          (is-in (json-at found "divergence" "failure") (json-at seen "banner"))
          (is-in (json-at found "kind") (first (strings-of seen "headings")))
          (check-rows (strings-of seen "rows") (json-at found "theory")
                      (json-at found "simulation"))
          (is-in (json-at found "divergence" "designator") (json-at seen "diverging" 0))
          (is-in "(holding-box) is true in the theory, false in the simulation."
                 (json-at seen "diverging" 1))
          (is (equal (map 'list (lambda (parameter) (json-at parameter "name"))
                          (json-at found "parameters"))
                     (strings-of seen "parameters")))
          (is (= 3 (length (json-at seen "states"))))
          (is (= 1 (json-at seen "maps")))
          (is (= 2 (json-at seen "crosses")))
          (is-in "box-delivered" (json-at seen "facts")))))))

(test a-browser-shows-a-long-trace-in-the-kitchen
  "The page of a plan of many steps and items fits into a narrow window."
  (when *browser*
    (let* ((plan (discrepancy:ensure-plan 'discrepancy-finder-user::looking-into-drawers))
           (result (df:find-discrepancies
                    (plan:plan-name plan)
                    :domain :kitchen-drawers
                    :constraint :successful-grasping :explain t))
           (found (json-at (json-of result) "discrepancies" 0))
           (page (report-page result)))
      (dolist (width '(1200 700))
        (let ((seen (seen-in-browser page :width width)))
          (check-layout seen)
          (check-rows (strings-of seen "rows") (json-at found "theory")
                      (json-at found "simulation"))
          (is (= 1 (json-at seen "maps"))))))))

(test the-browser-tests-see-what-is-wrong
  "The checks above could not fail if the page's defects were not seen."
  (when *browser*
    (let ((page (report-page (found-result))))
      (flet ((seen-with (old new)
               (is (search old page))
               (seen-in-browser (replace-all page old new) :width 700)))
        (is (plusp (json-at (seen-with "<main>" "<main style=\"width: 1500px\">")
                            "overflow")))
        (is (= 0 (json-at (seen-with "class=\"map\"" "class=\"map\" style=\"display: none\"")
                          "maps")))
        (is (equalp #("http://127.0.0.1:9/x.png")
                    (json-at (seen-with "</main>"
                                        "<img src=\"http://127.0.0.1:9/x.png\"></main>")
                             "requests")))
        (is (null (search "manipulation-pose-unreachable"
                          (json-at (seen-with "manipulation-pose-unreachable" "success")
                                   "banner"))))))))

(test a-browser-shows-the-replay-command
  (when *browser*
    (with-stored-discrepancy (file discrepancy)
      (let* ((result (found-result)) (own (df:result-discrepancy result))
             (before (discrepancy:discrepancy-file own)))
        (setf (discrepancy:discrepancy-file own) file)
        (unwind-protect
             (is (equal (list (format nil "./discrepancy-finder replay ~a" file))
                        (strings-of (seen-in-browser (report-page result)) "commands")))
          (setf (discrepancy:discrepancy-file own) before))))))

(test a-browser-shows-certificates-and-why-there-is-none
  (when *browser*
    (let* ((object (json-of (certified-result)))
           (seen (seen-in-browser (report-page (certified-result)))))
      (check-layout seen)
      (check-figures seen object)
      (is-in "No discrepancy found" (json-at seen "banner"))
      (is-in (json-at object "statement") (json-at seen "banner"))
      (check-rows (strings-of seen "rows") (json-at object "traces" 0 "theory")
                  (json-at object "traces" 0 "simulation"))
      (is (= 0 (json-at seen "crosses"))))
    (let ((seen (seen-in-browser (report-page (undecided-result)))))
      (check-layout seen)
      (is-in "Undecided" (json-at seen "banner"))
      (is-in "budget" (json-at seen "banner")))))
