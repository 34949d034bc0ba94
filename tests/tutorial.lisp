;;;; The tutorial is executed: its files are written, its commands run in a shell, its forms
;;;; evaluated, and what comes out is compared with what it shows.
;;;;
;;;; In docs/tutorial.md a line **`NAME`** before a code block says that the block is the file NAME;
;;;; a console block holds commands, $ before each, and what they print; a Lisp block whose first
;;;; line begins with * is a transcript.  (REFRESH-TUTORIAL) writes what comes out into the text.

(in-package #:discrepancy-finder.tests)

(def-suite tutorial :in all)
(in-suite tutorial)

(defun tutorial-file ()
  (root-file "docs/tutorial.md"))

(defstruct part
  "Consecutive LINES of a text.  KIND is :TEXT, or what is in a code block: :FILE, which is to be
written to NAME, :CONSOLE or :TRANSCRIPT."
  (kind :text) (name nil) (lines '()))

(defun block-kind (fence name first-line)
  (cond (name :file)
        ((string= fence "```console") :console)
        ((uiop:string-prefix-p "* " first-line) :transcript)
        (t :text)))

(defun text-parts (lines)
  "Return the list of the parts of a text; their lines, in order, are LINES."
  (let ((parts (list (make-part))) (name nil) (inside nil))
    (loop for (line next) on lines
          for fence = (uiop:string-prefix-p "```" line)
          do (when (uiop:string-prefix-p "**`" line)
               (setf name (subseq line 3 (position #\` line :start 3))))
             (when (and fence inside)
               (push (make-part) parts))
             (push line (part-lines (first parts)))
             (when (and fence (not inside))
               (push (make-part :kind (block-kind line name next) :name (shiftf name nil)) parts))
             (when fence
               (setf inside (not inside))))
    (dolist (part parts (nreverse parts))
      (setf (part-lines part) (nreverse (part-lines part))))))

(defun tutorial-parts ()
  (text-parts (uiop:read-file-lines (tutorial-file))))

(defun console-entries (lines)
  "Return the list of (command output-line*) of the LINES of a console block."
  (let ((entries '()))
    (dolist (line lines (mapcar #'reverse (nreverse entries)))
      (if (uiop:string-prefix-p "$ " line)
          (push (list (subseq line 2)) entries)
          (push line (first entries))))))

;;; Running

(defun shell-script (parts)
  "Return a script that writes the files of PARTS and runs their commands, with a line of one #
after the output of each."
  (with-output-to-string (script)
    (dolist (part parts)
      (case (part-kind part)
        (:file (format script "cat >'~a' <<'END-OF-FILE'~%~{~a~%~}END-OF-FILE~%" (part-name part)
                       (part-lines part)))
        (:console (loop for (command) in (console-entries (part-lines part))
                        do (format script "(exit $status); ~a~%status=$?; echo '#'~%" command)))))))

(defun split-outputs (text)
  "Return the list of lists of lines that stand before each line of one # in TEXT."
  (let ((outputs '()) (output '()))
    (dolist (line (uiop:split-string text :separator '(#\Newline)) (nreverse outputs))
      (if (string= line "#")
          (push (nreverse (shiftf output '())) outputs)
          (push line output)))))

(defun run-shell (script folder)
  "Run SCRIPT in FOLDER, with the executable on the PATH, and return all that it prints."
  (uiop:run-program (list "env" "-C" folder "DISCREPANCY_FINDER_COMMAND=discrepancy-finder"
                          (format nil "PATH=~a:~a"
                                  (string-right-trim "/" (directory-namestring (executable)))
                                  (uiop:getenv "PATH"))
                          "sh" "-c" (format nil "exec 2>&1~%status=0~%~a" script))
                    :output :string :ignore-error-status t))

(defun run-transcript (lines folder)
  "Return the list of (form-text output) that evaluating the forms of LINES in FOLDER gives."
  (let ((* nil)
        (*package* (find-package '#:discrepancy-finder-user))
        (*default-pathname-defaults* (pathname folder)))
    (loop for (text) in (transcript-entries lines)
          collect (list text (entry-output text)))))

(defun run-tutorial (parts)
  "Do what PARTS of the tutorial tell.  Return the list of the outputs of all commands, each a list
of lines, and the list of the (form-text output) of all transcripts."
  (call-in-new-folder
   (lambda (folder)
     (values (split-outputs (run-shell (shell-script parts) folder))
             (loop for part in parts
                   when (eq (part-kind part) :transcript)
                     append (run-transcript (part-lines part)
                                            (concatenate 'string folder "night-watch/")))))))

;;; Comparing

(defun number-end (line start)
  "Return the position in LINE after the number that begins at START, or NIL if there is none."
  (let ((end (position-if-not (lambda (character)
                                (or (digit-char-p character) (char= character #\.)))
                              line :start start)))
    (and end (> end start) (digit-char-p (char line start)) end)))

(defun without-seconds (line)
  "Return LINE with T in the place of each number of seconds, such as 0.04 s."
  (with-output-to-string (stream)
    (loop with start = 0
          while (< start (length line))
          do (let ((end (number-end line start)))
               (cond ((null end)
                      (write-char (char line start) stream)
                      (incf start))
                     (t
                      (let ((seconds (and (uiop:string-prefix-p " s" (subseq line end))
                                          (not (and (> (length line) (+ end 2))
                                                    (alphanumericp (char line (+ end 2))))))))
                        (write-string (if seconds "T" (subseq line start end)) stream)
                        (setf start end))))))))

(test the-tutorial-is-executed
  (let ((parts (tutorial-parts)))
    (multiple-value-bind (outputs evaluated) (run-tutorial parts)
      (let ((entries (loop for part in parts
                           when (eq (part-kind part) :console)
                             append (console-entries (part-lines part)))))
        (is (< 10 (length entries)))
        (is (= (length entries) (length outputs)))
        (loop for (command . shown) in entries
              for output in outputs
              do (is (equal (mapcar #'without-seconds shown) (mapcar #'without-seconds output))
                     "~a~%prints~%~{~a~%~}" command output)))
      (let ((shown (loop for part in parts
                         when (eq (part-kind part) :transcript)
                           append (transcript-entries (part-lines part)))))
        (is (< 2 (length shown)))
        (loop for (text output) in evaluated
              for (nil expected) in shown
              do (is (string= (without-seconds expected) (without-seconds output))
                     "~a~%shows ~a" text output))))))

(test seconds-are-no-part-of-the-tutorial
  (is (string= "T s, 1.5 m at 0.5 m/s, T s." (without-seconds "0.04 s, 1.5 m at 0.5 m/s, 2 s.")))
  (is (string= "3 samples" (without-seconds "3 samples"))))

;;; Writing

(defun refreshed-lines (part outputs evaluated)
  "Return the lines of PART with what comes out, and how many of OUTPUTS and EVALUATED were used."
  (ecase (part-kind part)
    ((:text :file) (values (part-lines part) 0 0))
    (:console (let ((entries (console-entries (part-lines part))))
                (values (loop for (command) in entries
                              for output in outputs
                              collect (format nil "$ ~a" command)
                              append output)
                        (length entries) 0)))
    (:transcript (let ((entries (transcript-entries (part-lines part))))
                   (values (loop for (text) in entries
                                 for (nil output) in evaluated
                                 collect (format nil "* ~a" text)
                                 append (uiop:split-string output :separator '(#\Newline)))
                           0 (length entries))))))

(defun refresh-tutorial ()
  "Write into docs/tutorial.md what its commands and forms print now."
  (let ((parts (tutorial-parts)))
    (multiple-value-bind (outputs evaluated) (run-tutorial parts)
      (with-open-file (stream (tutorial-file) :direction :output :if-exists :supersede
                                              :external-format :utf-8)
        (dolist (part parts)
          (multiple-value-bind (lines commands forms) (refreshed-lines part outputs evaluated)
            (format stream "~{~a~%~}" lines)
            (setf outputs (nthcdr commands outputs)
                  evaluated (nthcdr forms evaluated))))))))
