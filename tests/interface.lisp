;;;; The command line, in a process of its own: texts, exit statuses, set-up.

(in-package #:discrepancy-finder.tests)

(def-suite interface :in all)
(in-suite interface)

(defvar *executable-is-built* nil
  "True when the script has been run once, which builds the executable if it is out of date.")

(defun executable ()
  "Return the path of the executable, built."
  (unless *executable-is-built*
    (run-command (list (root-file "discrepancy-finder") "--version"))
    (setf *executable-is-built* t))
  (root-file "build/discrepancy-finder"))

(defun run-command (command &key (directory (root-file "")) environment)
  "Run COMMAND, a list of strings, and return its standard output, error output and status."
  (uiop:run-program (append (list "env" "-C" directory) environment command)
                    :output :string :error-output :string :ignore-error-status t))

(defun df-command (&rest words)
  "Run the executable with WORDS in an empty directory, and return output, errors and status."
  (let ((directory (namestring (ensure-directories-exist
                                (merge-pathnames (format nil "df-~36r/" (random (expt 36 8)))
                                                 (uiop:temporary-directory))))))
    (unwind-protect
         (run-command (cons (executable) words)
                      :directory directory
                      :environment '("DISCREPANCY_FINDER_COMMAND=discrepancy-finder"))
      (uiop:delete-directory-tree (pathname directory) :validate t))))

(defmacro complains ((&rest words) &rest parts)
  "Check that the executable with WORDS ends with status 2, prints nothing, and complains in one
line that contains PARTS."
  `(multiple-value-bind (output errors status) (df-command ,@words)
     (is (= 2 status) "status ~d" status)
     (is (string= "" output))
     (is (= 1 (count #\Newline errors)) "not one line: ~a" errors)
     (is (eql 0 (search "discrepancy-finder: " errors)) "~a" errors)
     (dolist (part (list ,@parts))
       (is (search part errors) "~s is not in: ~a" part errors))))

(test help-and-version-are-ours
  (multiple-value-bind (output errors status) (df-command "--version")
    (is (string= (format nil "discrepancy-finder ~a~%" (df:version)) output))
    (is (string= "" errors))
    (is (= 0 status)))
  (dolist (words '(("--help") ("find" "--help") ("replay" "--help")))
    (multiple-value-bind (output errors status) (apply #'df-command words)
      (is (search "Usage: discrepancy-finder" output))
      (is (string= "" errors))
      (is (= 0 status)))))

(test bad-input-is-one-sentence-and-status-2
  (complains ("frob") "frob")
  (complains ("find") "plan is missing")
  (complains ("find" "move-the-box") "--domain")
  (complains ("find" "no-such-plan" "--domain" "two-regions") "no-such-plan")
  (complains ("find" "plans/none.lisp" "--domain" "two-regions") "plans/none.lisp" "no such file")
  (complains ("find" "move-the-box" "--domain" "nowhere") "nowhere")
  (complains ("find" "move-the-box" "--domain") "--domain needs a value")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--confidence" "1.5") "1.5")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--confidence" "much") "much")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--seed" "x") "seed" "x")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--set" "reach") "reach")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--set" "reech=1") "reech")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--rule" "magic") "magic")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--delta" "0.1")
             "The rule paper takes no delta.")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--traces" "all")
             "traces" "every-state")
  (complains ("find" "move-the-box" "--domain" "two-regions" "--frob" "1") "--frob")
  (complains ("simulate" "move-the-box" "--domain" "two-regions" "--state" "box=1") "body.axis")
  (complains ("replay" "no.json") "no.json" "no such file")
  (complains ("replay") "one file")
  (with-file (file (format nil "(in-package #:discrepancy-finder-user)~%~%(def-top-level"))
    (complains ("find" file "--domain" "two-regions") file ":3: " "not closed"))
  (with-file (file (format nil "(in-package #:discrepancy-finder-user)~%(print #.(+ 1 1))"))
    (complains ("find" file "--domain" "two-regions") file ":2: " "#."))
  (with-file (file "(in-package #:discrepancy-finder-user)")
    (complains ("find" file "--domain" "two-regions") "no top-level plan")))

(defparameter *bad-domain*
  "(in-package #:discrepancy-finder-user)
(define-theory bad (:sorts (region r1)) (:fluents (robot-in region)) (:events (move region))
  (:axioms (moves (initiates (move ?regin) (robot-in ?regin) ?time))))")

(test a-malformed-theory-names-the-axiom
  (with-file (file *bad-domain*)
    (complains ("find" "move-the-box" "--domain" file) ":3: " "axiom moves" "?regin")))

(defun without-times (text)
  "Return TEXT with every number of seconds replaced."
  (with-output-to-string (stream)
    (dolist (line (uiop:split-string text :separator '(#\Newline)))
      (format stream "~a~%" (if (search "s in symbolic execution" line)
                                "  T s in symbolic execution, T s in simulation"
                                line)))))

(defun without-directories (text)
  "Return TEXT with the source tree's path removed."
  (let ((root (root-file "")))
    (loop for position = (search root text)
          while position
          do (setf text (concatenate 'string (subseq text 0 position)
                                     (subseq text (+ position (length root))))))
    text))

(defun golden-text (name)
  (uiop:read-file-string (root-file (format nil "tests/golden/~a.txt" name))))

(defmacro is-golden (name text)
  "Check TEXT against the golden file NAME, line by line."
  `(let ((expected (uiop:split-string (golden-text ,name) :separator '(#\Newline)))
         (found (uiop:split-string (string-right-trim '(#\Newline) ,text)
                                   :separator '(#\Newline))))
     (loop for line in (append expected nil)
           for number from 1
           for other = (nth (1- number) found)
           do (unless (and (string= line "") (null other))
                (is (equal line other) "~a:~d~%expected ~a~%found    ~a" ,name number line other)))
     (is (<= (length found) (length expected)))))

(test the-reports-are-as-they-should-be
  (dolist (reach '("0.8" "0.5"))
    (multiple-value-bind (output errors status)
        (df-command "find" "move-the-box" "--domain" "two-regions" "--set"
                    (format nil "reach=~a" reach) "--seed" "1" "--save" "found.json")
      (is (string= "" errors))
      (is (= (if (string= reach "0.8") 0 1) status))
      (is-golden (format nil "find-~a" reach) (without-directories (without-times output))))))

(defun refresh-golden ()
  "Write the golden files anew from what the executable prints.  Look at the difference."
  (flet ((refresh (name output)
           (with-open-file (stream (root-file (format nil "tests/golden/~a.txt" name))
                                   :direction :output :if-exists :supersede
                                   :external-format :utf-8)
             (write-string (string-right-trim '(#\Newline)
                                              (without-directories (without-times output)))
                           stream)
             (terpri stream))))
    (refresh "demo" (df-command "demo"))
    (dolist (reach '("0.8" "0.5"))
      (refresh (format nil "find-~a" reach)
               (df-command "find" "move-the-box" "--domain" "two-regions" "--set"
                           (format nil "reach=~a" reach) "--seed" "1" "--save" "found.json")))))

(test the-demo-explains-itself
  (multiple-value-bind (output errors status) (df-command "demo")
    (is (string= "" errors))
    (is (= 0 status))
    (is-golden "demo" (without-directories (without-times output)))))

(test undecided-is-status-3
  (multiple-value-bind (output errors status)
      (df-command "find" "move-the-box" "--domain" "two-regions" "--budget" "1")
    (declare (ignore errors))
    (is (= 3 status))
    (is (search "UNDECIDED" output))))

(test a-replay-in-another-process-has-the-same-bits
  (with-stored-discrepancy (file discrepancy)
    (multiple-value-bind (output errors status) (df-command "replay" file)
      (is (string= "" errors))
      (is (= 1 status))
      (is (eql 0 (search "SAME BITS" output)))
      (is (search (discrepancy::hash-text (df:run-hash (df:discrepancy-run discrepancy)))
                  output)))))

(test a-sample-is-the-same-in-another-process
  "The state hash of a run from the same state, here and in the executable."
  (let ((run (df:run-plan 'discrepancy-finder-user::move-the-box
                          :domain :two-regions :state '((:box :x 1.3 :y 0.41)))))
    (is (search (discrepancy::hash-text (df:run-hash run))
                (df-command "simulate" "move-the-box" "--domain" "two-regions"
                            "--state" "box.x=1.3" "--state" "box.y=0.41")))))

(test simulate-takes-pictures
  "Before and after each of three motions; DIR is made, and what cannot be is one sentence."
  (let ((folder (namestring (merge-pathnames (format nil "df-pictures-~36r/" (random (expt 36 8)))
                                             (uiop:temporary-directory)))))
    (unwind-protect
         (multiple-value-bind (output errors status)
             (df-command "simulate" "find-object" "--domain" "table-top" "--frames" folder)
           (is (string= "" errors))
           (is (= 0 status))
           (is (search (format nil "5 frames, two pictures each, in ~a" folder) output))
           (is (= 11 (length (uiop:directory-files folder)))))
      (uiop:delete-directory-tree (pathname folder) :validate t :if-does-not-exist :ignore)))
  (complains ("simulate" "find-object" "--domain" "table-top" "--frames" "/proc/nowhere")
             "/proc/nowhere" "cannot be written"))

(test simulate-runs-in-a-scene
  (multiple-value-bind (output errors status)
      (df-command "simulate" "find-object" "--scene" (root-file "models/table-top")
                  "--fidelity" "full")
    (is (string= "" errors))
    (is (= 0 status))
    (is (search "finally (finished" output))
    (is (search "cereal at 0.4000 0.6500" output)))
  (complains ("simulate" "find-object" "--scene" "no-such-scene") "no-such-scene")
  (complains ("simulate" "find-object" "--scene" "x" "--domain" "table-top") "--domain")
  (complains ("simulate" "find-object" "--domain" "table-top" "--fidelity" "half") "half"))

(test exploring-lists-the-traces
  (multiple-value-bind (output errors status)
      (df-command "explore" "move-the-box" "--domain" "two-regions")
    (is (string= "" errors))
    (is (= 0 status))
    (is (search "1 trace on 1 path, complete" output))))

;;; Set-up

(defun copied-build (function)
  "Call FUNCTION with a copy of the build folder, elsewhere, that holds no compiled files."
  (let ((directory (merge-pathnames (format nil "df-build-~36r/" (random (expt 36 8)))
                                    (uiop:temporary-directory))))
    (ensure-directories-exist directory)
    (executable)
    (unwind-protect
         (progn
           (dolist (name '("discrepancy-finder" "libdiscrepancy-finder-bullet.so"))
             (run-command (list "cp" "-p" (root-file (format nil "build/~a" name))
                                (namestring directory))))
           (dolist (name '("models" "plans"))
             (run-command (list "cp" "-r" (root-file (format nil "build/~a" name))
                                (namestring directory))))
           (funcall function (namestring directory)))
      (uiop:delete-directory-tree directory :validate t))))

(test the-build-folder-can-be-moved
  (copied-build
   (lambda (directory)
     (multiple-value-bind (output errors status)
         (run-command (list (format nil "~adiscrepancy-finder" directory)
                            "find" "move-the-box" "--domain" "two-regions")
                      :directory "/")
       (is (string= "" errors))
       (is (= 0 status))
       (is (search "NO DISCREPANCY" output)))
     (uiop:delete-file-if-exists (format nil "~alibdiscrepancy-finder-bullet.so" directory))
     (multiple-value-bind (output errors status)
         (run-command (list (format nil "~adiscrepancy-finder" directory) "demo") :directory "/")
       (is (string= "" output))
       (is (= 2 status))
       (is (= 1 (count #\Newline errors)))
       (is (search "Bullet shim is missing" errors))))))

(defun as-somebody-without-rights (command)
  "Return COMMAND, to be run by a user who is not root."
  (if (zerop (parse-integer (uiop:run-program '("id" "-u") :output '(:string :stripped t))))
      (append '("setpriv" "--reuid=65534" "--regid=65534" "--clear-groups") command)
      command))

(test without-root-and-sudo-the-script-says-what-to-install
  "Run the script as a user without rights, with a PATH that holds no sudo, when a package of
Debian's that surely is not installed is asked for as well."
  (let ((tools (merge-pathnames (format nil "df-tools-~36r/" (random (expt 36 8)))
                                (uiop:temporary-directory)))
        (script (merge-pathnames (format nil "df-script-~36r" (random (expt 36 8)))
                                 (uiop:temporary-directory))))
    (ensure-directories-exist tools)
    (unwind-protect
         (progn
           (run-command (list "cp" (root-file "discrepancy-finder") (namestring script)))
           (dolist (tool '("bash" "env" "dirname" "readlink" "id" "dpkg-query" "sed" "grep"
                           "apt-get"))
             (run-command (list "ln" "-s"
                                (uiop:run-program (list "sh" "-c" (format nil "command -v ~a" tool))
                                                  :output '(:string :stripped t))
                                (namestring tools))))
           (run-command (list "chmod" "755" (namestring tools)))
           (multiple-value-bind (output errors status)
               (run-command (as-somebody-without-rights
                             (list "env" (format nil "PATH=~a" (namestring tools))
                                   "DISCREPANCY_FINDER_EXTRA_PACKAGES=openclipart-png"
                                   (namestring (merge-pathnames "bash" tools))
                                   (namestring script) "demo"))
                            :directory "/")
             (is (string= "" output))
             (is (= 2 status) "status ~d: ~a" status errors)
             (is (search "apt-get install -y --no-install-recommends openclipart-png" errors)
                 "~a" errors)))
      (uiop:delete-directory-tree tools :validate t)
      (uiop:delete-file-if-exists script))))

(test a-second-start-builds-nothing
  (executable)
  (multiple-value-bind (output errors status)
      (run-command (list (root-file "discrepancy-finder") "--version"))
    (is (search "discrepancy-finder" output))
    (is (string= "" errors) "nothing is built or installed: ~a" errors)
    (is (= 0 status))))
