;;;; .e files: what is refused, files that load others, and hostile files.

(in-package #:discrepancy-finder.tests)

(in-suite e-files)

;;; Errors

(test errors-name-file-and-line
  (loop for (text . parts)
          in '(("sort agent
agent nathan" "text:2:" "upper-case" "nathan")
               ("sort Agent" "text:1:" "lower-case" "Agent")
               ("agent Nathan" "text:1:" "agent is neither a keyword nor a declared sort")
               ("sort a: b" "text:1:" "there is no sort b")
               ("sort a: b
sort b: a" "text:1:" "the sort a is a part of itself")
               ("sort a b" "text:1:" "the end of the line was expected" "\"b\"")
               ("sort a, b
a C
b C" "text:3:" "C is a constant of sort a already" "b! C")
               ("sort a
a C(a)" "text:2:" "a must be a reified sort")
               ("sort a
a 1, 3" "text:1:" "no range")
               ("fluent F(a)" "text:1:" "there is no sort a")
               ("fluent F(integer)" "text:1:" "an argument of F needs a sort with a range")
               ("fluent F(
; nothing" "text:2:" "the name of a sort was expected, but the end of the file was found")
               ("function F()" "text:1:" "\":\"" "the end of the file")
               ("sort a
fluent F(a)

fluent F()" "text:4:" "declared in another way at text:2")
               ("predicate HoldsAt(fluent)" "text:1:" "event calculus" "fluent, time")
               ("event AND()" "text:1:" "AND cannot be declared")
               ("range a 0 1" "text:1:" "there is no sort a to give a range")
               ("range time 3 1" "text:1:" "the range of time is empty")
               ("range time 3" "text:1:" "an integer was expected")
               ("noninertial F" "text:1:" "there is no fluent F")
               ("event E()
manualrelease E" "text:2:" "there is no fluent E")
               ("mutex A" "text:1:" "there is no event or fluent A")
               ("completion Theta Ab" "text:1:" "there is no predicate Ab to complete")
               ("option encoding 4" "text:1:" "encoding is 2 or 3, not \"4\"")
               ("option trajectory maybe" "text:1:" "on or off")
               ("option weighted on" "text:1:" "not supported")
               ("option" "text:1:" "the name of an option")
               ("load" "text:1:" "the name of a file")
               ("

load no/such.e ; here" "text:3:" "there is no file \"no/such.e\"")
               ("P()." "text:1:" "there is no predicate P")
               ("predicate P()
P() & Q()." "text:2:" "there is no predicate Q")
               ("sort a
predicate P(a)
P()." "text:3:" "P takes 1 argument, not 0")
               ("sort a
predicate P(a)
P(C)." "text:3:" "C is not declared")
               ("sort a
predicate P(a)
[b1] P(b1)." "text:3:" "the variable b1 has no sort: there is no sort b")
               ("[Time] P()." "text:1:" "upper-case")
               ("HoldsAt(F(),0)." "text:1:" "there is no fluent F")
               ("Happens(E,0)." "text:1:" "there is no event E")
               ("fluent F()
Happens(F(),0)." "text:2:" "there is no event F, only a symbol of sort fluent")
               ("HoldsAt(3,0)." "text:1:" "a fluent was expected, but the number 3")
               ("HoldsAt(0)." "text:1:" "HoldsAt takes 2 arguments, not 1")
               ("fluent F()
F()." "text:2:" "the fluent F can only stand in a predicate")
               ("event E()
!E()." "text:2:" "the event E can only stand in a predicate")
               ("function F(): integer
F()." "text:2:" "the term F")
               ("3." "text:1:" "the number 3 was found where a formula")
               ("1+2." "text:1:" "a term was found where a formula")
               ("predicate P()
P()=1." "text:2:" "the predicate P was found where a term")
               ("(1=1)=1." "text:1:" "a formula was found where a term")
               ("1=2=3." "text:1:" "comparisons in a row")
               ("1.5=2." "text:1:" "1.5 is not an integer")
               ("1=123456789012345678901." "text:1:" "too large")
               ("predicate P()
P()

" "text:2:" "\".\" was expected after the formula of line 2" "the end of the file")
               ("predicate P()
P() &
& P()." "text:3:" "a formula or a term was expected, but \"&\"")
               ("predicate P()
[time
P()." "text:3:" "\"]\" for the \"[\" of line 2")
               ("predicate P()
(P()
." "text:3:" "\")\" for the \"(\" of line 2")
               ("[] P()." "text:1:" "a variable was expected")
               ("predicate P()
P() # Q()." "text:2:" "\"#\"")
               ("predicate P()
Label: ." "text:2:" "a formula or a term was expected"))
        do (let ((report (report-of 'ec:e-file-error (lambda () (ec:parse-e-text text)))))
             (is-true report "nothing was signaled for ~a" text)
             (is (null (find #\Newline report)))
             (dolist (part parts)
               (is-true (search part report) "~s is not in: ~a" part report)))))

(test error-data
  (handler-case (ec:parse-e-text (format nil "~%P().") :name "x.e")
    (ec:e-file-error (condition)
      (is (equal "x.e" (ec:e-file-error-file condition)))
      (is (eql 2 (ec:e-file-error-line condition)))
      (is (equal "there is no predicate P" (ec:e-file-error-reason condition)))
      (is (equal "x.e:2: there is no predicate P." (princ-to-string condition))))
    (:no-error (theory) (fail "~a was read" theory))))

(test errors-of-the-checker-name-the-line
  (signals-with (ec:theory-error "text:" "terminates cannot stand here")
    (e-theory "[thing] Terminates(Go(),Lit(thing),0) | P().")))

(test unknown-options-are-warned-about
  (let ((conditions '()))
    (handler-bind ((ec:e-file-warning (lambda (condition)
                                        (push condition conditions)
                                        (muffle-warning condition))))
      (is (equal '() (ec:theory-options (ec:parse-e-text (format nil "~%option nonsense 3"))))))
    (is (equal '("text:2: there is no option nonsense.") (mapcar #'princ-to-string conditions)))
    (is (eql 2 (ec:e-file-warning-line (first conditions))))
    (is (equal "text" (ec:e-file-warning-file (first conditions))))
    (is (equal "there is no option nonsense" (ec:e-file-warning-reason (first conditions))))))

;;; Files

(defun call-with-e-files (files function)
  "Call FUNCTION with the name of a temporary folder, with a slash, that holds FILES: a list of
(path text)."
  (let ((folder (format nil "~ae-files-~36r/" (uiop:native-namestring (uiop:temporary-directory))
                        (random (expt 36 8) (make-random-state t)))))
    (unwind-protect
         (progn
           (loop for (path text) in files
                 for file = (uiop:parse-native-namestring (concatenate 'string folder path))
                 do (ensure-directories-exist file)
                    (with-open-file (stream file :direction :output :external-format :utf-8)
                      (write-string text stream)))
           (funcall function folder))
      (uiop:delete-directory-tree (uiop:parse-native-namestring folder)
                                  :validate t :if-does-not-exist :ignore))))

(defmacro with-e-files ((folder &rest files) &body body)
  `(call-with-e-files ',files (lambda (,folder) ,@body)))

(defun predicate-names (theory)
  (mapcar (lambda (declaration) (symbol-name (first declaration))) (ec:theory-predicates theory)))

(test loaded-files
  (with-e-files (folder ("Main.e" "predicate Main1()
load a/A.e
predicate Main2()")
                        ("a/A.e" "predicate A1()
load b/B.e ; below
load C.e
predicate A2()")
                        ("a/b/B.e" "predicate B()
load C.e
load a/A.e")
                        ("C.e" "predicate C()
load Main.e"))
    (let ((theory (ec:load-e-theory (concatenate 'string folder "Main.e"))))
      (is (equal '("Main1" "A1" "B" "C" "A2" "Main2") (predicate-names theory))
          "each file is read once, at its first place, also in a circle")
      (is (eq :|Main| (ec:theory-name theory)))
      (is (eq :e (ec:theory-syntax theory)))
      (is (equal (concatenate 'string folder "Main.e") (ec:theory-file theory)))
      (is (eq theory (ec:find-theory :|Main|))))
    (is (equal '("A1" "B" "C" "Main1" "Main2" "A2")
               (predicate-names (ec:read-e-theory (concatenate 'string folder "a/A.e")))))))

(test errors-in-loaded-files-name-them
  (with-e-files (folder ("Main.e" "load Other.e") ("Other.e" "
P().")
                        ("Lost.e" "

load Nowhere.e"))
    (signals-with (ec:e-file-error
                   (concatenate 'string folder "Other.e:2: there is no predicate P."))
      (ec:read-e-theory (concatenate 'string folder "Main.e")))
    (signals-with (ec:e-file-error (concatenate 'string folder "Lost.e:3: ")
                                   "\"Nowhere.e\"" "current folder")
      (ec:read-e-theory (concatenate 'string folder "Lost.e")))
    (signals-with (ec:e-file-error "None.e: no such file.")
      (ec:read-e-theory (concatenate 'string folder "None.e")))
    (signals-with (ec:e-file-error "it is a folder")
      (ec:read-e-theory folder))))

(test files-in-the-current-folder
  (with-e-files (folder ("Here.e" "predicate Here()"))
    (uiop:with-current-directory ((uiop:parse-native-namestring folder))
      (is (equal '("Here") (predicate-names (ec:parse-e-text "load Here.e")))))))

(test foundations-are-built-in
  (with-e-files (folder ("foundations/EC.e" "predicate FromDisk()")
                        ("foundations/Mine.e" "predicate Mine()")
                        ("Main.e" "load foundations/Root.e
load foundations/EC.e
load foundations/Mine.e"))
    (is (equal '("Mine") (predicate-names
                          (ec:read-e-theory (concatenate 'string folder "Main.e"))))))
  (is (equal '() (ec:theory-options (ec:parse-e-text "load foundations/EC.e"))))
  (is (equal '(:dec t) (ec:theory-options (ec:parse-e-text "load x/foundations/DEC.e"))))
  (is (equal '(:ectraj t :trajectory t)
             (ec:theory-options (ec:parse-e-text "load foundations/ECTraj.e"))))
  (is (equal '(:trajectory t) (ec:theory-options (ec:parse-e-text "option trajectory on")))))

(test causal-constraints-are-loaded-on-demand
  (let ((theory (ec:parse-e-text "load foundations/ECCausal.e
fluent A()
event Go()
[time] Started(A(),time) -> Happens(Go(),time).")))
    (is (equal (ec:theory-predicates (ec:find-theory :causal-constraints))
               (ec:theory-predicates theory)))
    (is (= 5 (length (ec:theory-axioms theory))))
    (is (eq :started (first (second (ec:axiom-formula
                                     (first (last (ec:theory-axioms theory)))))))))
  (signals-with (ec:e-file-error "there is no predicate Started")
    (ec:parse-e-text "fluent A()
[time] Started(A(),time).")))

;;; Hostile files

(test empty-files
  (dolist (text (list "" " " (string #\Newline) "; only a comment" (string #\Tab)))
    (is (equal '() (ec:theory-axioms (ec:parse-e-text text))))))

(test white-space
  (let ((text "predicate P()~aP()~a&~a~aP().~aP()."))
    (flet ((read-with (line-break)
             (mapcar (lambda (axiom)
                       (list (source:source-position-line (ec:axiom-position axiom))
                             (ec:axiom-formula axiom)))
                     (ec:theory-axioms
                      (ec:parse-e-text (format nil text line-break #\Tab line-break line-break
                                               line-break))))))
      (let ((expected '((2 (:and (:p) (:p))) (5 (:p)))))
        (is (equal expected (read-with (string #\Newline))))
        (is (equal expected (read-with (coerce '(#\Return #\Newline) 'string))))
        (is (equal expected (read-with (string #\Return))))))))

(test texts-in-unicode
  (with-e-files (folder ("Größe.e" "sort größe
größe Öl
fluent Schön(größe)
HoldsAt(Schön(Öl),0)."))
    (let ((theory (ec:read-e-theory (concatenate 'string folder "Größe.e"))))
      (is (eq :|Größe| (ec:theory-name theory)))
      (is (equal '(:holds-at (:|Schön| :|Öl|) 0)
                 (ec:axiom-formula (first (ec:theory-axioms theory)))))))
  (is (equal '("P") (predicate-names
                     (ec:parse-e-text (format nil "~apredicate P()"
                                              #\Zero_width_no-break_space))))
      "a byte order mark"))

(test deep-and-long-formulas
  (flet ((repeated (count text) (format nil "~v@{~a~:*~}" count text)))
    (dolist (text (list (format nil "~aP()~a." (repeated 10000 "(") (repeated 10000 ")"))
                        (format nil "~aP()." (repeated 10000 "!"))
                        (format nil "~aP()." (repeated 10000 "P() -> "))
                        (format nil "1=~a1." (repeated 10000 "1+"))
                        (format nil "1=~a1~a." (repeated 100 "(")
                                (repeated 100 (format nil "~a)" (repeated 90 "+1"))))
                        (format nil "P(~a" (repeated 100000 "P("))
                        (format nil "~a P()." (repeated 10000 "[time]"))))
      (signals-with (ec:e-file-error "text:2:" "nested in more than 1000 levels")
        (ec:parse-e-text (format nil "predicate P()~%~a" text))))
    (let ((formula (ec:axiom-formula
                    (first (ec:theory-axioms
                            (ec:parse-e-text (format nil "predicate P()~%~aP()."
                                                     (repeated 10000 "P() & "))))))))
      (is (= 10002 (length formula)) "a conjunction is flat, however long"))
    (is (equal '(:not (:p))
               (ec:axiom-formula
                (first (ec:theory-axioms
                        (ec:parse-e-text (format nil "predicate P()~%~a!P()~a."
                                                 (repeated 900 "(") (repeated 900 ")"))))))))))

(test bytes-that-are-no-text
  (uiop:with-temporary-file (:pathname file :type "e")
    (with-open-file (stream file :direction :output :if-exists :supersede
                                 :element-type '(unsigned-byte 8))
      (write-sequence #(102 0 255 254 195 40 10 7) stream))
    (signals-with (ec:e-file-error "it is not a UTF-8 text")
      (ec:read-e-theory file)))
  (signals-with (ec:e-file-error "text:2: " "the character Nul")
    (ec:parse-e-text (format nil "predicate P()~%P() ~a." (code-char 0)))))

(test random-texts-are-theories-or-errors
  "Texts of random words of the language: whatever comes, it is a theory or an error of this layer."
  (let ((state (sb-ext:seed-random-state 4))
        (words #("sort" "reified" "predicate" "function" "fluent" "event" "range" "option" "ignore"
                 "completion" "mutex" "xor" "noninertial" "manualrelease" "on" "encoding" "time"
                 "a" "a1" "b" "P" "Q" "F" "C" "Happens" "HoldsAt" "Initiates" "(" ")" "()" "[" "]"
                 "{" "}" "," "." ":" "!" "&" "|" "->" "<->" "=" "!=" "<" ">=" "+" "-" "*" "/" "%"
                 "0" "1"
                 "
" "
" ";" "#" "P()." "sort a
a C
predicate P()
" "[a1]" "{a}" "Happens(F(),0)"))
        (theories 0))
    (handler-bind ((ec:e-file-warning #'muffle-warning))
      (dotimes (i 3000)
        (let ((text (format nil "~{~a~^ ~}" (loop repeat (random 12 state)
                                                  collect (aref words (random (length words)
                                                                              state))))))
          (handler-case (progn (ec:parse-e-text text)
                               (incf theories))
            (ec:event-calculus-error ())
            (serious-condition (condition)
              (fail "~s: ~a: ~a" text (type-of condition) condition))))))
    (is (< 100 theories 2900) "~d of 3000 texts are theories" theories)))

(test reading-interns-keywords-only
  (let ((before (loop for package in (list-all-packages)
                      unless (eq package (find-package '#:keyword))
                        sum (let ((count 0))
                              (do-symbols (symbol package count) (incf count))))))
    (ec:parse-e-text "sort brandnew
brandnew Freshly
fluent Unseen(brandnew)
Label: HoldsAt(Unseen(Freshly),0).")
    (is (= before (loop for package in (list-all-packages)
                        unless (eq package (find-package '#:keyword))
                          sum (let ((count 0))
                                (do-symbols (symbol package count) (incf count))))))))

(test kinds-are-not-mixed
  (is (search "F is a fluent and E an event"
              (report-of 'ec:e-file-error
                         (lambda ()
                           (ec:parse-e-text "fluent F()
event E()
mutex F, E
range time 0 1")))))
  (is (search "the sort agent has both a range and constants"
              (report-of 'ec:e-file-error
                         (lambda ()
                           (ec:parse-e-text "sort agent
agent A
range agent 0 1"))))))

(test names-of-files-are-shown-as-they-are
  (let ((theory (ec:parse-e-text "fluent F()
range time 0 100000000
[time] HoldsAt(F(),time)." :name "Big")))
    (is (search "theory Big: the timepoints"
                (report-of 'ec:theory-error (lambda () (ec:consistent-p theory)))))))
