;;;; The command line of searches: results as files, progress, interruption, what is said of stored
;;;; discrepancies.

(in-package #:discrepancy-finder.tests)

(in-suite interface)

(defun call-in-folder (function)
  "Call FUNCTION with the name of an empty directory that is deleted afterwards."
  (let ((directory (namestring (ensure-directories-exist
                                (merge-pathnames (format nil "df-folder-~36r/"
                                                         (random (expt 36 8)))
                                                 (uiop:temporary-directory))))))
    (unwind-protect (funcall function directory)
      (uiop:delete-directory-tree (pathname directory) :validate t))))

(defun df-in (directory &rest words)
  "Run the executable with WORDS in DIRECTORY, and return output, errors and status."
  (run-command (cons (executable) words) :directory directory
               :environment '("DISCREPANCY_FINDER_COMMAND=discrepancy-finder")))

(test a-search-writes-json-and-a-page
  (call-in-folder
   (lambda (directory)
     (multiple-value-bind (output errors status)
         (df-in directory "find" "move-the-box" "--domain" "two-regions" "--set" "reach=0.5"
                "--json" "result.json" "--report" "result.html")
       (is (string= "" errors))
       (is (= 1 status))
       (is (eql 0 (search "DISCREPANCY" output)))
       (let ((object (json:parse (uiop:read-file-string
                                  (merge-pathnames "result.json" directory))))
             (page (uiop:read-file-string (merge-pathnames "result.html" directory)
                                          :external-format :utf-8)))
         (is (equalp object (page-json page)))
         (is (string= "discrepancies/move-the-box-1-4b1adfe8.json"
                      (json-at object "discrepancies" 0 "file")))
         (is (string= "discrepancies/move-the-box-1-4b1adfe8-small.json"
                      (json-at object "discrepancies" 0 "shrunk" "file")))
         (is (search "discrepancy-finder replay discrepancies/move-the-box-1-4b1adfe8.json"
                     page))))
     ;; The store's discrepancy shows again, and nothing else is looked for.
     (multiple-value-bind (output errors status)
         (df-in directory "find" "move-the-box" "--domain" "two-regions" "--set" "reach=0.5"
                "--json" "-" "--no-shrink" "--no-explain")
       (is (string= "" errors))
       (is (= 1 status))
       (let ((object (json:parse output)))
         (is (string= "reused" (json-at object "discrepancies" 0 "origin")))
         (is (eq :null (json-at object "discrepancies" 0 "shrunk")))
         (is (= 1 (length (json-at object "reused"))))))
     (multiple-value-bind (output errors status)
         (df-in directory "explain" "discrepancies/move-the-box-1-4b1adfe8.json" "--runs" "0")
       (is (string= "" errors))
       (is (= 1 status))
       (is (search "axiom pick-up-holds" output)))
     (multiple-value-bind (output errors status)
         (df-in directory "shrink" "discrepancies/move-the-box-1-4b1adfe8.json"
                "--save" "small.json")
       (is (string= "" errors))
       (is (= 1 status))
       (is (search "2 of 4 steps are left" output)))
     ;; The search has stored the smallest case, too.
     (is (string= (uiop:read-file-string (merge-pathnames "small.json" directory))
                  (uiop:read-file-string
                   (merge-pathnames "discrepancies/move-the-box-1-4b1adfe8-small.json" directory))))
     (multiple-value-bind (output errors status)
         (df-in directory "replay" "discrepancies/move-the-box-1-4b1adfe8-small.json")
       (is (string= "" errors))
       (is (= 1 status))
       (is (eql 0 (search "SAME BITS" output)))))))

(test what-cannot-be-written-is-an-error
  "Before the search where that can be known: nothing can be written to /proc, and everything until
the end to /dev/full."
  (flet ((find-box (&rest words)
           (apply #'df-command "find" "move-the-box" "--domain" "two-regions"
                  "--no-shrink" "--no-explain" "--store" "none" words)))
    (dolist (option '("--json" "--report" "--save"))
      (dolist (file '("/proc/x.html" "/no/such/folder/x" "/tmp" ""))
        (multiple-value-bind (output errors status) (find-box option file)
          (is (string= "" output))
          (is (search (if (string= file "") option file) errors))
          (is (= 2 status)))))
    (multiple-value-bind (output errors status) (find-box "--report" "/dev/full")
      (is (search "NO DISCREPANCY" output))
      (is (search "/dev/full" errors))
      (is (= 2 status)))
    (multiple-value-bind (output errors status)
        (find-box "--set" "reach=0.5" "--json" "/dev/full")
      (is (eql 0 (search "DISCREPANCY" output)))
      (is (search "/dev/full" errors))
      (is (= 1 status)))))

(test a-store-that-cannot-be-written-is-said-in-a-sentence
  (multiple-value-bind (output errors status)
      (df-command "find" "move-the-box" "--domain" "two-regions" "--set" "reach=0.5"
                  "--no-shrink" "--no-explain" "--store" "/proc/store")
    (is (eql 0 (search "DISCREPANCY" output)))
    (is (eql 0 (search "discrepancy-finder: /proc/store/" errors)) "~a" errors)
    (is (= 1 (count #\Newline errors)))
    (is (= 1 status))))

(test verifying-has-exit-statuses
  (flet ((status (&rest words)
           (nth-value 2 (apply #'df-command "verify" "move-the-box" "--domain" "two-regions"
                               words))))
    (is (= 1 (status "--never" "box-delivered")))
    (is (= 0 (status "--property" "no-failure"))))
  (complains ("verify" "move-the-box" "--domain" "two-regions") "property")
  (complains ("verify" "move-the-box" "--domain" "two-regions" "--never" "no-such") "no-such")
  (complains ("explain" "no.json") "no.json" "no such file")
  (complains ("shrink") "one file")
  (complains ("verify" "move-the-box" "--bogus") "no option --bogus")
  (complains ("explain" "--bogus" "3" "no.json") "no option --bogus"))

(test names-are-those-of-the-catalog
  (multiple-value-bind (output errors status)
      (df-command "explore" "bowl-and-spoon-closing" "--domain" "bowl-and-spoon-closing"
                  "--constraint" "successful-grasping")
    (is (string= "" errors))
    (is (= 0 status))
    (is (search "bowl-and-spoon-closing" output)))
  (complains ("explore" "move-the-box" "--domain" "nowhere") "nowhere" "two-regions-minimal")
  (complains ("explore" "no-such-plan" "--domain" "kitchen") "no-such-plan" "move-the-box"))

(defparameter *two-ways* "(in-package #:discrepancy-finder-user)
(def-cram-function go-to (?place) (perform (a motion (type going) (pose ?place))))
(def-top-level-cram-function one-way () (go-to (make-pose 0.5 0 0)))
(def-top-level-cram-function other-way () (go-to (make-pose 1.5 0 0)))"
  "A file of two top-level plans.")

(test refine-takes-names-after-a-file
  (with-file (file *two-ways*)
    (flet ((plans (&rest arguments)
             (mapcar #'symbol-name (df::plan-arguments arguments))))
      (is (equal '("ONE-WAY") (plans file "one-way")))
      (is (equal '("MOVE-THE-BOX" "OTHER-WAY" "ONE-WAY" "MOVE-THE-BOX")
                 (plans "move-the-box" file "other-way" "one-way" "move-the-box"))))
    (complains ("refine" file "--domain" "two-regions") file "name one of one-way, other-way.")
    (complains ("refine" file "move-the-box" "--domain" "two-regions") "name one of")
    (complains ("refine" "--domain" "two-regions") "A plan is missing.")
    (multiple-value-bind (output errors status)
        (df-command "refine" file "other-way" "--domain" "two-regions")
      (is (search "no discrepancy is left along other-way" output))
      (is (string= "" errors))
      (is (= 0 status)))))

(test every-subcommand-has-help
  (let ((output (df-command "--help")))
    (dolist (name '("demo" "find" "explore" "verify" "simulate" "replay" "explain" "shrink"
                    "refine" "check-theory" "reason" "test" "bench"))
      (is (search (format nil "~%  ~a " name) output) "~a is not listed" name)
      (multiple-value-bind (output errors status) (df-command name "--help")
        (is (eql 0 (search (format nil "Usage: discrepancy-finder ~a" name) output)))
        (is (string= "" errors))
        (is (= 0 status))))))

;;; Progress

(test progress-is-a-line
  (is (string= "simulating, trace 2, 1 simulation, 3 s"
               (df::progress-text :phase :generate :trace 2 :simulations 1 :seconds 3.9d0)))
  (is (string= "exploring the plan, 0 simulations, 1 kind of discrepancies, 0 s"
               (df::progress-text :phase :explore :trace 0 :discrepancies 1 :verdict nil))))

(test progress-is-for-terminals
  "The program script, of Debian's essential packages, runs a command on a terminal of its own."
  (flet ((output (command)
           (run-command (list "script" "-qec" command "/dev/null")
                        :directory "/tmp" :environment '("TERM=xterm"))))
    (let* ((command (format nil "~a find move-the-box --domain two-regions" (executable)))
           (shown (output command)))
      (is (search "simulating, trace 1, 1 simulation" shown))
      (is (search (format nil "~c[K" #\Escape) shown))
      (is (search "NO DISCREPANCY" shown))
      ;; With standard error elsewhere nothing of it is seen.
      (is (not (search (format nil "~c[K" #\Escape)
                       (output (format nil "~a 2>&1 | cat" command))))))))

(test what-is-no-search-tells-what-it-does
  "A plan file that takes its time to load makes a command that is sure to run for seconds."
  (with-file (file "(cl:sleep 1.5) (def-top-level-cram-function slow () nil)")
    (flet ((output (plan streams)
             (run-command (list "script" "-qec"
                                (format nil "~a explore ~a --domain two-regions ~a"
                                        (executable) plan streams)
                                "/dev/null")
                          :directory "/tmp" :environment '("TERM=xterm"))))
      (let ((shown (output file "")))
        (is (search "exploring the plan, 1 s" shown))
        (is (search (format nil "~c[K" #\Escape) shown))
        (is (search "EXPLORATION of slow" shown)))
      (is (not (search "exploring the plan" (output "move-the-box" ""))))
      (is (not (search (format nil "~c[K" #\Escape) (output file "2>&1 | cat")))))))

(defun lines-in (file)
  (if (uiop:file-exists-p file)
      (length (uiop:read-file-lines file))
      0))

(defun interrupted-search (directory signal)
  "Begin a long search in DIRECTORY, send SIGNAL when it has simulated something, and return its
output, errors and status."
  (let* ((journal (merge-pathnames "journal" directory))
         (process (uiop:launch-program
                   (list (executable) "find" "move-the-box" "--domain" "two-regions"
                         "--rule" "zero-failure" "--delta" "0.00001" "--budget" "1000000"
                         "--resume" (namestring journal))
                   :output :stream :error-output :stream :directory directory)))
    (loop until (or (> (lines-in journal) 3) (not (uiop:process-alive-p process)))
          do (sleep 0.05))
    (run-command (list "kill" (format nil "-~a" signal)
                       (princ-to-string (uiop:process-info-pid process))))
    (let ((output (uiop:slurp-stream-string (uiop:process-info-output process)))
          (errors (uiop:slurp-stream-string (uiop:process-info-error-output process))))
      (values output errors (uiop:wait-process process)))))

(test an-interrupted-search-tells-what-it-has-found
  (dolist (signal '("INT" "TERM"))
    (call-in-folder
     (lambda (directory)
       (multiple-value-bind (output errors status) (interrupted-search directory signal)
         (is (= 3 status))
         (is (search "UNDECIDED" output))
         (is (search "interrupted" output))
         (is (search "the search ends after this simulation" errors)))))))
