;;;; What is wrong with a theory is said in one sentence, with file and line.
;;;;
;;;; MALFORMED checks a theory whose last clause is wrong, written at the REPL and in a file: the
;;;; report is one line, names the theory and what else is asked for, and begins with file and line
;;;; where there are any.

(in-package #:discrepancy-finder.tests)

(def-suite malformed-theories :in all)
(in-suite malformed-theories)

(defun theory-text (clauses)
  "Return the text of the theory BAD with CLAUSES, one a line."
  (let ((*package* (find-package '#:discrepancy-finder.tests))
        (*print-case* :downcase) (*print-pretty* nil) (*print-length* nil) (*print-level* nil))
    (format nil "(define-theory bad~{~%  ~s~})" clauses)))

(defun flaw (report parts)
  "Return what is wrong with REPORT, a string or NIL, which is to contain PARTS; NIL if nothing is."
  (cond ((null report) "nothing was signaled")
        ((find #\Newline report) "more than one line")
        ((char/= #\. (char report (1- (length report)))) "no full stop")
        (t (let ((missing (remove-if (lambda (part) (search part report)) parts)))
             (and missing (format nil "~{~s~^, ~} is not in it" missing))))))

(defun check-malformed (clauses parts)
  (flet ((check (function parts beginning)
           (let* ((report (report-of 'ec:theory-error function))
                  (flaw (or (flaw report parts)
                            (and (not (uiop:string-prefix-p beginning report))
                                 (format nil "it does not begin with ~a" beginning)))))
             (is (null flaw) "~a: ~a~%~a" (theory-text (last clauses)) flaw report))))
    (check (lambda () (ec::parse-theory 'bad clauses)) parts "theory bad")
    (with-file (file (theory-text clauses))
      (check (lambda () (ec:load-theory file)) '()
             (format nil "~a:~d: theory bad" file (1+ (length clauses)))))))

(defmacro malformed ((&rest parts) &rest clauses)
  "Check that the theory with CLAUSES, of which the last is wrong, is refused in a sentence that
contains PARTS."
  `(check-malformed ',clauses ',parts))

;;; Clauses

(test malformed-clauses
  (malformed ("frob" ":sorts" ":axioms") (:frob x))
  (malformed (":sorts") (:sorts a))
  (malformed (":fluents") (:fluents (f)) (fluents . 3))
  (malformed ("(name ...)" ":fluents" "f") (:fluents f))
  (malformed ("(name ...)" ":events" "(e \"x\")") (:events (e "x")))
  (malformed ("(name ...)" ":predicates" "(1 2)") (:predicates (1 2)))
  (malformed ("(name ...)" ":non-inertial-fluents") (:non-inertial-fluents f))
  (malformed ("(name ...)" ":numeric-fluents") (:numeric-fluents 3.5))
  (malformed (":functions" "(distance place)" "((name sort ...) sort)")
             (:sorts (place)) (:functions (distance place)))
  (malformed (":functions" "((name sort ...) sort)") (:functions ((f) integer integer)))
  (malformed (":time" "(0)") (:time 0))
  (malformed (":time" "(3 2)") (:time 3 2))
  (malformed (":time" "(0 five)") (:time 0 five))
  (malformed (":time" "(0 1.5)") (:time 0 1.5))
  (malformed (":offset" "(2 1)") (:offset 2 1))
  (malformed (":extends" "no-such-theory") (:extends no-such-theory))
  (malformed (":extends" "\"causal-constraints\"") (:extends "causal-constraints"))
  (malformed (":extends" "(causal-constraints)") (:extends (causal-constraints)))
  (malformed (":manual-release" "lit") (:manual-release lit))
  (malformed (":manual-release" "(f)") (:fluents (f)) (:manual-release (f)))
  (malformed (":completion" "holds-at") (:completion holds-at))
  (malformed (":completion" "flies") (:completion flies))
  (malformed (":completion" "(a b c)" "(label predicate)") (:completion (a b c)))
  (malformed (":completion" "3" "(label predicate)") (:completion 3))
  (malformed (":mutex" "e") (:events (e)) (:mutex e))
  (malformed (":mutex" "go") (:events (e)) (:mutex (e go)))
  (malformed (":xor" "(1 2)") (:xor (1 2)))
  (malformed (":mutex" "f" "e") (:events (e)) (:fluents (f)) (:mutex (e f))))

(test malformed-sorts
  (malformed (":sorts" "(place (:range 3 1))") (:sorts (place (:range 3 1))))
  (malformed (":sorts" "(place (:range low high))") (:sorts (place (:range low high))))
  (malformed (":sorts" "place" "range") (:sorts (place (:range 1 2) (:range 4 5))))
  (malformed (":sorts" "place" "range") (:sorts (place (:range 1 2) hall)))
  (malformed (":sorts" "area" "place") (:sorts (place (:parent area))))
  (malformed (":sorts" "below itself") (:sorts (place (:parent place))))
  (malformed (":sorts" "below itself") (:sorts (a (:parent b)) (b (:parent c)) (c (:parent a))))
  (malformed (":sorts" "fluent") (:sorts (place (:parent fluent) hall)))
  (malformed (":sorts" "time") (:sorts (place (:parent time) hall)))
  (malformed (":sorts" "(place hall 3)" "3 cannot be a name") (:sorts (place hall 3)))
  (malformed (":sorts" "\"hall\" cannot be a name") (:sorts (place "hall")))
  (malformed (":sorts" "?hall cannot be a name") (:sorts (place ?hall)))
  (malformed (":sorts" "cannot be a name") (:sorts (place nil)))
  (malformed (":sorts" "cannot be a name") (:sorts (?place hall)))
  (malformed (":sorts" "stands twice") (:sorts (place hall hall)))
  (malformed (":sorts" "place is declared twice") (:sorts (place hall) (place kitchen)))
  (malformed (":sorts" "time is a sort of the language") (:sorts (time noon)))
  (malformed (":sorts" "digit") (:sorts (place1 hall)))
  (malformed (":sorts" "and is a word of the language") (:sorts (place and)))
  (malformed (":sorts" "(:kind x)" ":parent" ":range" ":terms") (:sorts (place (:kind x))))
  (malformed (":sorts" "(name ...)") (:sorts (belief (:terms b))))
  (malformed (":sorts" "(b-at area)" "there is no sort area")
             (:sorts (belief (:terms (b-at area)))))
  (malformed (":sorts" "belief" "wish")
             (:sorts (belief (:terms (b-wish wish))) (wish (:terms (w-belief belief)))))
  (malformed (":sorts" "belief" "fluent")
             (:fluents (f belief)) (:sorts (belief (:terms (b fluent))))))

(test malformed-tables
  (malformed (":predicates" "(hall attic)" "place, place")
             (:sorts (place hall)) (:predicates ((near place place) (hall attic))))
  (malformed (":predicates" "(hall)" "place, place")
             (:sorts (place hall)) (:predicates ((near place place) (hall))))
  (malformed (":predicates" "(hall ?place)")
             (:sorts (place hall)) (:predicates ((near place place) (hall ?place))))
  (malformed (":predicates" "(2 4)" "step")
             (:sorts (step (:range 0 3))) (:predicates ((next step step) (0 1) (2 4))))
  (malformed (":predicates" "((name sort ...) (element ...) ...)")
             (:sorts (place hall)) (:predicates ((near place place) hall hall)))
  (malformed (":predicates" "near is declared twice")
             (:sorts (place hall)) (:predicates ((near place) (hall)) (near place))))

(test malformed-declarations
  (malformed (":fluents" "(lit lamp)" "there is no sort lamp") (:fluents (lit lamp)))
  (malformed (":functions" "there is no sort place") (:functions ((home) place)))
  (malformed (":functions" "there is no sort place") (:functions ((home place) integer)))
  (malformed (":fluents" "integer" "range") (:fluents (level integer)))
  (malformed (":fluents" "lit is declared twice") (:sorts (lamp)) (:fluents (lit lamp) (lit)))
  (malformed (":events" "e is declared twice") (:events (e) (e)))
  (malformed (":fluents" "cannot be a name") (:fluents (nil)))
  (malformed (":fluents" "holds-at is a word of the language") (:fluents (holds-at)))
  (malformed (":events" "+ is a word of the language") (:events (+)))
  (malformed ("fluent" "event") (:fluents (go)) (:events (go)))
  (malformed ("fluent" "predicate") (:fluents (near)) (:predicates (near)))
  (malformed ("fluent" "numeric") (:fluents (level)) (:numeric-fluents (level)))
  (malformed ("function" "predicate") (:functions ((near) integer)) (:predicates (near)))
  (malformed ("lit") (:fluents (lit)) (:non-inertial-fluents (lit)))
  (malformed ("fluent" "event") (:fluents (f event)) (:events (e fluent))))

;;; Axioms

(defmacro malformed-axiom ((&rest parts) axiom)
  "Check that AXIOM, in the theory of a robot with a battery, is refused in a sentence that contains
PARTS."
  `(check-malformed
    '((:sorts (place hall kitchen) (room (:parent place) attic) (height (:range 0 3))
       (belief (:terms (b-at place))))
      (:predicates (near place place) (ab place time) (flag))
      (:functions ((distance place place) integer) ((home) place) ((above height) height))
      (:fluents (at place) (level height) (believes belief) (wet))
      (:numeric-fluents (warmth place) (charge))
      (:events (go place) (toss))
      (:axioms ,axiom))
    ',parts))

(test malformed-entries
  (malformed-axiom ("axiom 1" "5 was found" "formula") 5)
  (malformed-axiom ("axiom 1" "flag was found" "formula") flag)
  (malformed-axiom ("axiom 1" "\"flag\" was found" "formula") "flag")
  (malformed-axiom ("axiom" "()" "formula") ())
  (malformed-axiom ("axiom" "named") (named 5))
  (malformed-axiom ("axiom" "(name :label label formula)") (named :label theta))
  (malformed-axiom ("axiom" "(name :label label formula)") (named :label (flag) (flag)))
  (malformed-axiom ("axiom" "(name :label label formula)") (named :label theta (flag) (flag)))
  (malformed-axiom ("axiom" "named") (named (flag) (flag)))
  (malformed-axiom ("axiom 1" "()") (nil (flag)))
  (malformed-axiom ("axiom 1" "\"named\"") ("named" (flag)))
  (malformed-axiom ("axiom 1" "((flag))" "formula") ((flag)))
  (malformed-axiom ("axiom" "(near . hall)") (near . hall))
  (malformed-axiom ("axiom bad-tail" "dotted") (bad-tail (and (flag) . flag)))
  (malformed-axiom ("axiom" "#\\a") (holds-at (wet) #\a))
  (malformed ("axiom twice") (:predicates (p)) (:axioms (twice (p)) (twice (not (p))))))

(test malformed-connectives
  (malformed-axiom ("axiom a" "(not)" "1 argument, not 0") (a (not)))
  (malformed-axiom ("axiom a" "2 arguments, not 1") (a (implies (flag))))
  (malformed-axiom ("axiom a" "2 arguments, not 3") (a (iff (flag) (flag) (flag))))
  (malformed-axiom ("axiom a" "flag was found" "formula") (a (and (flag) flag)))
  (malformed-axiom ("axiom a" "5 was found" "formula") (a (or 5 (flag))))
  (malformed-axiom ("axiom a" "5 was found" "formula") (a (implies (flag) 5)))
  (malformed-axiom ("axiom a" "() was found" "formula") (a (not nil)))
  (malformed-axiom ("axiom a" "t was found" "formula") (a (iff (flag) t)))
  (malformed-axiom ("axiom a" "xor") (a (xor (flag) (flag))))
  (malformed-axiom ("axiom a" "list of variables") (a (forall ?place (flag))))
  (malformed-axiom ("axiom a" "list of variables") (a (exists (place) (flag))))
  (malformed-axiom ("axiom a" "list of variables") (a (exists () (flag))))
  (malformed-axiom ("axiom a" "x was found" "formula") (a (forall (?place) x)))
  (malformed-axiom ("axiom a" "?thing" "no sort thing") (a (exists (?thing) (flag))))
  (malformed-axiom ("axiom a" "?thing1" "no sort thing") (a (near ?thing1 ?thing1)))
  (malformed-axiom ("axiom a" "2 arguments, not 3") (a (exists (?place) (flag) (flag)))))

(test malformed-comparisons
  (malformed-axiom ("axiom a" "2 arguments, not 1") (a (= hall)))
  (malformed-axiom ("axiom a" "nowhere") (a (= ?place nowhere)))
  (malformed-axiom ("axiom a" "(< hall kitchen)" "hall") (a (< hall kitchen)))
  (malformed-axiom ("axiom a" "?place" "sort place") (a (< ?place 3)))
  (malformed-axiom ("axiom a" "place" "height") (a (implies (= ?place ?height) (flag))))
  (malformed-axiom ("axiom a" "3" "hall") (a (= 3 hall)))
  (malformed-axiom ("axiom a" "time" "place") (a (implies (= ?time ?place) (flag))))
  (malformed-axiom ("axiom a" "event" "fluent") (a (= (go hall) (at hall))))
  (malformed-axiom ("axiom a" "hall") (a (= (value-at (charge) 0) hall)))
  (malformed-axiom ("axiom a" "hall") (a (= (distance hall hall) hall)))
  (malformed-axiom ("axiom a" "height" "7") (a (= (above 2) 7)))
  (malformed-axiom ("axiom a" "height" "9") (a (= (above 9) 2)))
  (malformed-axiom ("axiom a" "flag") (a (= (flag) (flag)))))

(test malformed-arithmetic
  (malformed-axiom ("axiom a" "(+)" "at least 1 argument") (a (= 1 (+))))
  (malformed-axiom ("axiom a" "(-)" "argument") (a (= 1 (-))))
  (malformed-axiom ("axiom a" "(- 1 2 3)" "argument") (a (= 1 (- 1 2 3))))
  (malformed-axiom ("axiom a" "(/ 1)" "2 arguments, not 1") (a (= 1 (/ 1))))
  (malformed-axiom ("axiom a" "(mod 5)" "2 arguments, not 1") (a (= 1 (mod 5))))
  (malformed-axiom ("axiom a" "^") (a (= 1 (^ 1 2))))
  (malformed-axiom ("axiom a" "(+ hall 1)" "hall") (a (= 1 (+ hall 1))))
  (malformed-axiom ("axiom a" "(mod" "numeric fluent")
                   (a (assigns (toss) (charge) (mod (value-at (charge) ?time) 2) ?time)))
  (malformed-axiom ("axiom a" "(+ 1 1)") (a (+ 1 1))))

(test malformed-atoms
  (malformed-axiom ("axiom a" "(near hall)" "2 arguments, not 1") (a (near hall)))
  (malformed-axiom ("axiom a" "(near hall 3)" "3" "place") (a (near hall 3)))
  (malformed-axiom ("axiom a" "(near hall ?height)" "?height" "place") (a (near hall ?height)))
  (malformed-axiom ("axiom a" "()" "place") (a (near hall nil)))
  (malformed-axiom ("axiom a" "(near hall \"x\")" "\"x\"") (a (near hall "x")))
  (malformed-axiom ("axiom a" "2 arguments, not 1") (a (holds-at (wet))))
  (malformed-axiom ("axiom a" "wet" "fluent") (a (holds-at wet 0)))
  (malformed-axiom ("axiom a" "go" "fluent") (a (holds-at (go hall) 0)))
  (malformed-axiom ("axiom a" "wet" "event") (a (happens (wet) 0)))
  (malformed-axiom ("axiom a" "an event") (a (happens toss 0)))
  (malformed-axiom ("axiom a" "(at)" "1 argument, not 0") (a (holds-at (at) 0)))
  (malformed-axiom ("axiom a" "(at ?time)") (a (holds-at (at ?time) 0)))
  (malformed-axiom ("axiom a" "(level 9)" "9" "height") (a (holds-at (level 9) 0)))
  (malformed-axiom ("axiom a" "(level 3/2)" "height") (a (holds-at (level 1.5) 0)))
  (malformed-axiom ("axiom a" "?place" "fluent") (a (holds-at ?place 0)))
  (malformed-axiom ("axiom a" "?fluent" "event") (a (happens ?fluent 0)))
  (malformed-axiom ("axiom a" "now" "time") (a (holds-at (wet) now)))
  (malformed-axiom ("axiom a" "?place" "time") (a (holds-at (wet) ?place)))
  (malformed-axiom ("axiom a" "time") (a (holds-at (wet) 1.5)))
  (malformed-axiom ("axiom a" "(home)" "time") (a (holds-at (wet) (home))))
  (malformed-axiom ("axiom a" "(b-at nowhere)" "nowhere")
                   (a (holds-at (believes (b-at nowhere)) 0)))
  (malformed-axiom ("axiom a" "hall" "belief") (a (holds-at (believes hall) 0)))
  (malformed-axiom ("axiom a" "warmth" "numeric") (a (holds-at (warmth hall) 0)))
  (malformed-axiom ("axiom a" "wet" "numeric") (a (= 3 (value-at (wet) 0))))
  (malformed-axiom ("axiom a" "(value-at (charge))" "2 arguments, not 1")
                   (a (= (value-at (charge)) 3)))
  (malformed-axiom ("axiom a" "frobs") (a (frobs hall))))

(test fluents-and-events-are-no-formulas
  "The commonest slip, so the sentence says what to write."
  (malformed-axiom ("axiom a" "(wet)" "fluent" "(holds-at (wet) ") (a (implies (wet) (flag))))
  (malformed-axiom ("axiom a" "(toss)" "event" "(happens (toss) ") (a (implies (flag) (toss))))
  (malformed-axiom ("axiom a" "(charge)" "value-at") (a (> (charge) 3))))

(test misplaced-effects
  (malformed-axiom ("axiom a" "3 arguments, not 2") (a (initiates (toss) (wet))))
  (malformed-axiom ("axiom a" "4 arguments, not 3") (a (assigns (toss) (charge) ?time)))
  (malformed-axiom ("axiom a" "4 arguments, not 3") (a (trajectory (wet) ?time (at hall))))
  (malformed-axiom ("axiom a" "wet" "numeric") (a (assigns (toss) (wet) 3 ?time)))
  (malformed-axiom ("axiom a" "charge" "fluent") (a (initiates (toss) (charge) ?time)))
  (malformed-axiom ("axiom a" "wet" "event") (a (initiates (wet) (wet) ?time)))
  (malformed-axiom ("axiom a" "wet" "numeric") (a (trajectory (wet) ?time (= (wet) 3) ?offset)))
  (malformed-axiom ("axiom a" "(initiates (toss) (wet) ?time)" "head")
                   (a (or (flag) (initiates (toss) (wet) ?time))))
  (malformed-axiom ("axiom a" "initiates" "head") (a (iff (flag) (initiates (toss) (wet) ?time))))
  (malformed-axiom ("axiom a" "terminates" "head")
                   (a (implies (flag) (or (terminates (toss) (wet) ?time) (flag)))))
  (malformed-axiom ("axiom a" "trajectory" "head")
                   (a (implies (trajectory (wet) ?time (at hall) ?offset) (flag))))
  (malformed-axiom ("axiom a" "anti-trajectory" "head")
                   (a (not (anti-trajectory (wet) ?time (at hall) ?offset))))
  (malformed-axiom ("axiom a" "assigns" "head")
                   (a (implies (assigns (toss) (charge) 3 ?time) (flag))))
  (malformed-axiom ("axiom a" "initially") (a (initially)))
  (malformed-axiom ("axiom a" "initially") (a (not (initially (wet)))))
  (malformed-axiom ("axiom a" "initially") (a (implies (flag) (initially (wet)))))
  (malformed-axiom ("axiom a" "holds-at") (a (initially (holds-at (wet) 0))))
  (malformed-axiom ("axiom a" "?time") (a (initially (at ?time))))
  (malformed-axiom ("axiom a" "toss") (a (initially (toss)))))

;;; Values of functions

(test values-that-contradict-each-other
  (malformed ("(cost a)" "3" "4")
             (:sorts (place a b)) (:functions ((cost place) integer))
             (:facts (= (cost a) 3) (second-value (= (cost a) 4)))))

(test values-of-another-sort
  (malformed ("(next 2)" "3" "height (0 to 2)")
             (:sorts (height (:range 0 2))) (:functions ((next height) height))
             (:axioms (= (next ?height) (+ ?height 1)))))

;;; Files

(defmacro malformed-file ((line &rest parts) &rest lines)
  "Check that a file of LINES is refused in one sentence that begins with the file and LINE, or with
the file alone, and contains PARTS."
  `(with-file (file (format nil "~{~a~%~}" (list ,@lines)))
     (let* ((report (report-of 'error (lambda () (ec:load-theory file))))
            (beginning (format nil "~a:~@[~d:~] " file ,line))
            (flaw (flaw report (list ,@parts))))
       (is (null flaw) "~a: ~a" flaw report)
       (is (uiop:string-prefix-p beginning (or report "")) "not at ~a: ~a" ,line report))))

(test lines-of-entries
  "The line is that of the entry, or of what is wrong in it."
  (malformed-file (3 "(b ())" "cannot be a name")
                  "(define-theory x" "  (:sorts (a x)" "    (b nil)))")
  (malformed-file (4 "axiom second" "g") "(define-theory x (:fluents (f))" "  (:axioms"
                  "   (first (holds-at (f) 0))" "   (second (holds-at (g)" "  0))))")
  (malformed-file (4 "axiom a" "\"x\"")
                  "(define-theory x" " (:fluents (f))"
                  " (:axioms (a (and (holds-at (f) 0)" "     (holds-at (f) \"x\")))))"))

(test files-that-hold-no-theory
  (malformed-file (nil "no define-theory") "")
  (malformed-file (nil "no define-theory") ";; Only a comment.")
  (malformed-file (1 "name") "(define-theory)")
  (malformed-file (1 "name") "(define-theory nil (:fluents (f)))")
  (malformed-file (1 "name") "(define-theory \"lamp\" (:fluents (f)))")
  (malformed-file (1 "name") "(define-theory (lamp) (:fluents (f)))")
  (malformed-file (1 "dotted") "(define-theory . lamp)")
  (malformed-file (1) "(define-theory x . y)")
  (malformed-file (2 "second theory") "(define-theory x)" "(define-theory y)")
  (malformed-file (2 "defun" "define-theory" "define-state-constraint") "(define-theory x)"
                  "(defun f () 3)")
  (malformed-file (1 "not closed") "(define-theory x (:fluents (f))")
  (malformed-file (2 "parenthesis") "(define-theory x (:fluents (f)))" ")")
  (malformed-file (1 "#.") "(define-theory x (:fluents #.(quit)))")
  (malformed-file (1 "#=") "(define-theory x (:fluents . #1=((f) . #1#)))")
  (malformed-file (1 "FROBS") "(define-theory x (:fluents (frobs:f)))")
  (malformed-file (1 "deep") (format nil "(define-theory x ~{~a~}~{~a~})"
                                     (make-list 100000 :initial-element "(")
                                     (make-list 100000 :initial-element ")"))))

(test malformed-state-constraints
  (flet ((constraint (text) (format nil "(define-state-constraint ~a)" text)))
    (malformed-file (1 "before its theory") (constraint "c (?time) (f)"))
    (dolist (case '(("" "name") ("3 (?time) (holds-at (f) ?time)" "name")
                    ("\"c\" (?time) (holds-at (f) ?time)" "name")
                    ("c" "c (?time) formula") ("c ?time (holds-at (f) ?time)" "c (?time) formula")
                    ("c (?moment) (holds-at (f) ?moment)" "c (?time) formula")
                    ("c (?time) (holds-at (f) ?time) (holds-at (f) ?time)" "c (?time) formula")
                    ("c (?time) (f)" "state constraint c" "f")
                    ("c (?time) (holds-at (g) ?time)" "state constraint c" "no fluent g")
                    ("c (?time) (holds-at (f) 3)" "state constraint c" "(+ ?time n)")
                    ("c (?time) (holds-at (f) (- ?time 1))" "state constraint c" "(+ ?time n)")
                    ("c (?time) (released-at (f) ?time)" "state constraint c" "released-at")
                    ("c (?time) (initiates (e) (f) ?time)" "state constraint c" "initiates")
                    ("c (?time) 5" "state constraint c" "5")
                    ("c (?time) (and (holds-at (f) ?time) . 3)" "state constraint c" "dotted")))
      (destructuring-bind (text &rest parts) case
        (with-file (file (format nil "(define-theory x (:fluents (f)) (:events (e)))~%~%~a~%"
                                 (constraint text)))
          (let ((report (report-of 'error (lambda () (ec:load-theory file)))))
            (is (null (flaw report parts)) "~a: ~a" text report)
            (is (uiop:string-prefix-p (format nil "~a:3: " file) (or report ""))
                "~a: ~a" text report)))))))
