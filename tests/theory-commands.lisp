;;;; The subcommands about theories, in a process of their own: reason and check-theory.

(in-package #:discrepancy-finder.tests)

(def-suite theory-commands :in all)
(in-suite theory-commands)

(defun theory-path (name)
  (root-file (format nil "tests/theories/~a" name)))

(defmacro prints ((&rest words) (&key (status 0) (errors "")) &rest lines)
  "Check that the executable with WORDS prints LINES, complains with ERRORS, and ends with STATUS."
  `(multiple-value-bind (output errors status) (df-command ,@words)
     (is (string= (format nil "~{~a~%~}" (list ,@lines)) output) "found~%~a" output)
     (is (string= ,errors errors) "complained ~a" errors)
     (is (= ,status status) "status ~d" status)))

(defun last-line (text)
  (first (last (uiop:split-string (string-right-trim '(#\Newline) text) :separator '(#\Newline)))))

;;; reason

(test reason-prints-a-model
  (dolist (file '("yale-shooting.lisp" "yale-shooting.e"))
    (prints ("reason" (theory-path file)) ()
            "model 1:"
            "0" "Alive(Turkey)." "Happens(Load(), 0)."
            "1" "+Loaded()." "Happens(Sneeze(), 1)."
            "2" "Happens(Shoot(Turkey), 2)."
            "3" "-Alive(Turkey)." "-Loaded()."
            "P"
            "1 models")))

(test reason-prints-the-other-literals-at-the-end
  (with-file (file "(define-theory lamps
  (:sorts (lamp a b) (count (:range 0 3)))
  (:predicates (near lamp lamp) (bright lamp time))
  (:fluents (lit lamp) (counted count))
  (:non-inertial-fluents (flickering))
  (:events (switch lamp))
  (:axioms (initiates (switch ?lamp) (lit ?lamp) ?time)
           (initially (not (lit ?lamp)))
           (initially (iff (counted ?count) (= ?count 2)))
           (iff (bright ?lamp ?time) (holds-at (lit ?lamp) ?time))
           (iff (near ?lamp1 ?lamp2) (/= ?lamp1 ?lamp2))
           (holds-at (flickering) ?time))
  (:narrative (happens (switch b) 0))
  (:completion happens) (:time 0 1))")
    (prints ("reason" file) ()
            "model 1:"
            "0" "Counted(2)." "Flickering()." "Happens(Switch(B), 0)."
            "1" "+Lit(B)."
            "P" "Bright(B, 1)." "Near(A, B)." "Near(B, A)."
            "ReleasedAt(Flickering(), 0)." "ReleasedAt(Flickering(), 1)."
            "1 models")))

(test reason-prints-numbers
  (with-file (file "(define-theory tank
  (:sorts (tank left right))
  (:numeric-fluents (level tank))
  (:events (halve tank))
  (:axioms (assigns (halve ?tank) (level ?tank) (/ (value-at (level ?tank) ?time) 2) ?time))
  (:facts (= (value-at (level left) 0) 5) (= (value-at (level right) 0) -1))
  (:narrative (happens (halve left) 1))
  (:completion happens) (:time 0 2))")
    (prints ("reason" file) ()
            "model 1:"
            "0" "Level(Left)=5." "Level(Right)=-1."
            "1" "Happens(Halve(Left), 1)."
            "2" "Level(Left)=5/2."
            "P"
            "1 models")))

(test reason-prints-several-models
  (multiple-value-bind (output errors status) (df-command "reason" (theory-path "bus-ride.lisp"))
    (is (uiop:string-prefix-p (format nil "model 1:~%0~%") output))
    (is (string= "1 models" (last-line output)))
    (is (string= "" errors))
    (is (= 0 status)))
  (multiple-value-bind (output errors status) (df-command "reason" (theory-path "chess-board.e"))
    (loop for number from 1 to 3
          do (is (search (format nil "~%model ~d:~%0~%" number) (format nil "~%~a" output))))
    (is (string= "3 models" (last-line output)))
    (is (string= "" errors))
    (is (= 0 status))))

(test no-model-is-an-answer
  (dolist (file '("inconsistency-1.lisp" "inconsistency-1.e" "nixon-diamond-1.lisp"))
    (prints ("reason" (theory-path file)) () "0 models")))

(defparameter *sixteen-models*
  "(define-theory sixteen (:fluents (a) (b) (c) (d)) (:time 0 1))")

(test reason-stops-after-10-models
  (with-file (file *sixteen-models*)
    (flet ((count-of (output) (count-if (lambda (line) (uiop:string-prefix-p "model " line))
                                        (uiop:split-string output :separator '(#\Newline)))))
      (multiple-value-bind (output errors status) (df-command "reason" file)
        (is (= 10 (count-of output)))
        (is (string= "10 models" (last-line output)))
        (is (search "--all" errors))
        (is (= 1 (count #\Newline errors)))
        (is (= 0 status)))
      (dolist (words (list (list "--all" file) (list file "--all")
                           (list file "--all" "--horizon" "3")
                           (list "--horizon" "3" "--all" file)))
        (multiple-value-bind (output errors status) (apply #'df-command "reason" words)
          (is (= 16 (count-of output)) "~a" words)
          (is (string= "16 models" (last-line output)))
          (is (string= "" errors))
          (is (= 0 status))))
      ;; Ten models are no reason to speak of more.
      (with-file (file "(define-theory ten (:sorts (n (:range 1 10))) (:non-inertial-fluents (f n))
                          (:xor (f)) (:time 0 0))")
        (multiple-value-bind (output errors) (df-command "reason" file)
          (is (string= "10 models" (last-line output)))
          (is (string= "" errors)))))))

(test a-horizon-at-the-command-line
  (dolist (words '(("--horizon" "1") ("--horizon=1")))
    (multiple-value-bind (output errors status)
        (apply #'df-command "reason" (root-file "models/two-regions/theory.lisp") words)
      (is (uiop:string-prefix-p (format nil "model 1:~%0~%BoxIn(R2).~%RobotIn(R1).~%") output))
      (is (string= "3 models" (last-line output)))
      (is (string= "" errors))
      (is (= 0 status))))
  (multiple-value-bind (output errors status)
      (df-command "reason" (theory-path "yale-shooting.lisp") "--horizon" "1")
    (is (search (format nil "~%1~%+Loaded().~%P~%1 models~%") output)
        "the theory's own horizon can be another one")
    (is (string= "" errors))
    (is (= 0 status))))

(test the-same-models-in-another-process
  "Which models come first, too, is the same at every call."
  (dolist (name '("coin-tosses.lisp" "coin-tosses.e" "roulette-four.lisp" "zoo-plan.lisp"))
    (let ((file (theory-path name)))
      (is (string= (with-output-to-string (stream)
                     (ec:print-e-models (ec:models (if (uiop:string-suffix-p name ".e")
                                                       (ec:load-e-theory file)
                                                       (ec:load-theory file)))
                                        stream))
                   (df-command "reason" file))
          "~a" name))))

;;; check-theory

(test check-theory-finds-nothing
  (prints ("check-theory" (root-file "models/two-regions/theory.lisp")) ()
          "0 findings in 1 sort, 3 fluents, 3 events, 17 axioms"))

(test check-theory-says-what-it-finds
  (with-file (file "(define-theory lamp
  (:fluents (lit))
  (:events (switch))
  (:axioms (initially (not (lit)))
           (switching
            (initiates (switch) (lit) ?time))
           (odd (implies (and (holds-at (lit) ?time) (not (holds-at (lit) ?time)))
                         (terminates (switch) (lit) ?time)))))")
    (multiple-value-bind (output errors status) (df-command "check-theory" file)
      (is (uiop:string-prefix-p (format nil "~a:7: warning: axiom odd" file) output) "~a" output)
      (is (uiop:string-prefix-p "1 finding in " (last-line output)))
      (is (= 2 (count #\Newline output)))
      (is (string= "" errors))
      (is (= 1 status)))))

(test notes-do-not-change-the-status
  (multiple-value-bind (output errors status)
      (df-command "check-theory" (root-file "models/table-top/theory.lisp"))
    (is (= 3 (count #\Newline output :end (search "3 findings" output))))
    (is (search "note: " output))
    (is (null (search "warning: " output)))
    (is (string= "" errors))
    (is (= 0 status))))

(test check-theory-finds-nothing-wrong-in-the-kitchen
  "To take a spoon out of a drawer needs more than three steps."
  (multiple-value-bind (output errors status)
      (df-command "check-theory" (root-file "models/kitchen/theory.lisp"))
    (is (search "note: (in spoon drawer-1)" output))
    (is (uiop:string-prefix-p "1 finding in 7 sorts, 2 predicates, 16 fluents, 10 events, 59 axioms"
                              (last-line output)))
    (is (string= "" errors))
    (is (= 0 status))))

(test check-theory-of-a-contradiction
  (dolist (name '("inconsistency-2.lisp" "inconsistency-2.e"))
    (multiple-value-bind (output errors status) (df-command "check-theory" (theory-path name))
      (is (search "error: " output))
      (is (search "no model" output))
      (is (uiop:string-prefix-p "1 finding in " (last-line output)))
      (is (string= "" errors))
      (is (= 1 status)))))

(test check-theory-names-things-as-their-file-does
  (let ((output (df-command "check-theory" (theory-path "yale-shooting.e"))))
    (is (search "Sneeze" output))
    (is (null (find #\| output)) "~a" output)))

(test check-theory-up-to-a-horizon
  (with-file (file "(define-theory slow (:fluents (a) (b) (c) (d)) (:events (e))
  (:axioms (initially (and (not (a)) (not (b)) (not (c)) (not (d))))
           (initiates (e) (a) ?time)
           (implies (holds-at (a) ?time) (initiates (e) (b) ?time))
           (implies (holds-at (b) ?time) (initiates (e) (c) ?time))
           (implies (holds-at (c) ?time) (initiates (e) (d) ?time))))")
    (is (= 1 (nth-value 2 (df-command "check-theory" file "--horizon" "2"))))
    (is (= 0 (nth-value 2 (df-command "check-theory" file "--horizon" "5"))))))

;;; Errors

(test broken-theories-at-the-command-line
  (dolist (command '("reason" "check-theory"))
    (complains (command) "one file")
    (complains (command "a.lisp" "b.lisp") "one file")
    (complains (command "nowhere.lisp") "nowhere.lisp" "no such file")
    (complains (command "nowhere.e") "nowhere.e" "no such file")
    (complains (command (root-file "models")) "models" "folder")
    (complains (command (root-file "models/")) "models" "folder")
    (complains (command (root-file "models/two-regions/domain.lisp")) "domain.lisp:4: "
               "define-theory")
    (complains (command (root-file "build/discrepancy-finder")) "discrepancy-finder" "UTF-8")
    (complains (command "/dev/null") "/dev/null" "no define-theory")
    (complains (command (root-file "models/two-regions/theory.lisp") "--horizon" "soon")
               "--horizon" "soon")
    (complains (command (root-file "models/two-regions/theory.lisp") "--horizon" "-1") "-1")
    (complains (command (root-file "models/two-regions/theory.lisp") "--horizon") "--horizon")
    (complains (command (root-file "models/two-regions/theory.lisp") "--frob" "1") "--frob")
    (with-file (file (format nil "(define-theory bad~%  (:fluents (f))~%  (:axioms~%~
                                  (a (holds-at (g) 0))))"))
      (complains (command file) file ":4: " "axiom a" "g"))
    (with-file (file (format nil "(define-theory bad~%  (:fluents (f s)))"))
      (complains (command file) file ":2: " "no sort s"))
    (with-file (file (format nil "(define-theory bad~%  (:fluents (f)~%"))
      (complains (command file) file ":1: " "not closed"))
    (with-file (file (format nil "(define-theory bad~%  (:fluents #.(quit)))"))
      (complains (command file) file ":2: " "#."))
    (with-file (file (format nil "sort lamp~%lamp A~%fluent Lit(lamp)~%HoldsAt(Dim(A),0).~%") "e")
      (complains (command file) file ":4" "Dim"))
    (with-file (file "sort lamp" "lisp")
      (complains (command file) file "define-theory"))
    (with-file (file "(define-theory x (:fluents (f)) (:time 0 1))" "e")
      (complains (command file) file ":1")))
  (complains ("reason" (root-file "models/two-regions/theory.lisp")) "two-regions" "--horizon"))

(test the-help-of-the-theory-commands
  (dolist (command '("reason" "check-theory"))
    (multiple-value-bind (output errors status) (df-command command "--help")
      (is (search (format nil "Usage: discrepancy-finder ~a FILE" command) output))
      (is (search "--horizon" output))
      (is (string= "" errors))
      (is (= 0 status)))
    (is (search command (df-command "--help")))))
