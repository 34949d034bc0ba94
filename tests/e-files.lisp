;;;; .e files: formulas and declarations.
;;;;
;;;; The table of formulas is checked by one test; another writes each formula and reads it back.

(in-package #:discrepancy-finder.tests)

(def-suite e-files :in all)
(in-suite e-files)

(defparameter *e-vocabulary* "
sort thing
sort tool: thing
sort n: integer
range n 0 9
range time 0 3
thing C, D
tool Hammer
predicate P(), Q(), R(), S(), T(thing), U(n,n)
function F(n): n
function Size(thing): n
reified sort belief
belief On(thing,thing), Off()
fluent Lit(thing), Up(), Height(thing,n), Believes(belief), Option()
event Push(thing), Go(), Toggle(thing)
"
  "Declarations for the formulas below.")

(defun e-theory (text)
  (ec:parse-e-text (concatenate 'string *e-vocabulary* text)))

(defun e-axioms (text)
  "Return the axioms of TEXT after the declarations of *E-VOCABULARY*."
  (ec:theory-axioms (e-theory text)))

(defun e-formulas (text)
  (mapcar #'ec:axiom-formula (e-axioms text)))

(defun e-text (theory)
  (with-output-to-string (stream)
    (ec:write-e-theory theory stream)))

(defun written-sentences (text)
  "Return the lines that are written for the sentences in TEXT."
  (let* ((lines (uiop:split-string (e-text (e-theory text)) :separator '(#\Newline)))
         (start (position "event Toggle(thing)" lines :test #'string=)))
    (subseq lines (+ start 2) (position "" lines :start (+ start 2) :test #'string=))))

;;; Formulas

(defparameter *e-formulas*
  '(;; connectives
    ("P()." (:p))
    ("P." (:p))
    ("!P()." (:not (:p)))
    ("!!P()." (:not (:not (:p))))
    ("P() & Q()." (:and (:p) (:q)))
    ("P() & Q() & R()." (:and (:p) (:q) (:r)))
    ("P() & (Q() & R())." (:and (:p) (:and (:q) (:r))))
    ("P() | Q() | R()." (:or (:p) (:q) (:r)))
    ("P() & Q() | R()." (:or (:and (:p) (:q)) (:r)))
    ("P() | Q() & R()." (:or (:p) (:and (:q) (:r))))
    ("(P() | Q()) & R()." (:and (:or (:p) (:q)) (:r)))
    ("!P() & Q()." (:and (:not (:p)) (:q)))
    ("!(P() & Q())." (:not (:and (:p) (:q))))
    ("P() & !Q() | R()." (:or (:and (:p) (:not (:q))) (:r)))
    ("P() -> Q()." (:implies (:p) (:q)))
    ("P() -> Q() -> R()." (:implies (:p) (:implies (:q) (:r))))
    ("(P() -> Q()) -> R()." (:implies (:implies (:p) (:q)) (:r)))
    ("P() & Q() -> R() | S()." (:implies (:and (:p) (:q)) (:or (:r) (:s))))
    ("!P() -> !Q()." (:implies (:not (:p)) (:not (:q))))
    ("P() <-> Q() & R()." (:iff (:p) (:and (:q) (:r))))
    ("P() <-> Q() -> R()." (:iff (:p) (:implies (:q) (:r))))
    ("P() -> (Q() <-> R())." (:implies (:p) (:iff (:q) (:r))))
    ("P() <-> Q() <-> R()." (:iff (:p) (:iff (:q) (:r))))
    ("(P() <-> Q()) <-> R()." (:iff (:iff (:p) (:q)) (:r)))
    ("(((P())))." (:p))
    ("P()&Q()->R()." (:implies (:and (:p) (:q)) (:r)))
    ("P()<->!Q()." (:iff (:p) (:not (:q))))
    ;; quantifiers
    ("[thing] T(thing)." (:t :?thing))
    ("[thing1,thing2] T(thing1) -> T(thing2)." (:implies (:t :?thing1) (:t :?thing2)))
    ("{thing} T(thing)." (:exists (:?thing) (:t :?thing)))
    ("{thing} T(thing) & P() | Q()."
     (:exists (:?thing) (:or (:and (:t :?thing) (:p)) (:q))))
    ("({thing} T(thing)) & P()." (:and (:exists (:?thing) (:t :?thing)) (:p)))
    ("P() & {thing} T(thing) | Q()."
     (:and (:p) (:exists (:?thing) (:or (:t :?thing) (:q)))))
    ("P() -> {thing} T(thing) | Q()."
     (:implies (:p) (:exists (:?thing) (:or (:t :?thing) (:q)))))
    ("({thing} T(thing)) -> P()." (:implies (:exists (:?thing) (:t :?thing)) (:p)))
    ("!{thing} T(thing) -> P()." (:not (:exists (:?thing) (:implies (:t :?thing) (:p)))))
    ("!({thing} T(thing)) -> P()." (:implies (:not (:exists (:?thing) (:t :?thing))) (:p)))
    ("P() -> [thing] T(thing)." (:implies (:p) (:forall (:?thing) (:t :?thing))))
    ("[thing] {tool} T(thing) & T(tool)."
     (:exists (:?tool) (:and (:t :?thing) (:t :?tool))))
    ("[thing1] [thing2] T(thing1) | T(thing2)." (:or (:t :?thing1) (:t :?thing2)))
    ("{n1,n2} U(n1,n2)." (:exists (:?n1 :?n2) (:u :?n1 :?n2)))
    ;; comparisons and arithmetic
    ("C!=D." (:/= :c :d))
    ("!C=D." (:not (:= :c :d)))
    ("[n1,n2] n1=n2 & P()." (:and (:= :?n1 :?n2) (:p)))
    ("[n1,n2] n1<n2 | n1>=n2." (:or (:< :?n1 :?n2) (:>= :?n1 :?n2)))
    ("[n1,n2] n1<=n2 <-> !n1>n2." (:iff (:<= :?n1 :?n2) (:not (:> :?n1 :?n2))))
    ("1+2*3=7." (:= (:+ 1 (:* 2 3)) 7))
    ("(1+2)*3=9." (:= (:* (:+ 1 2) 3) 9))
    ("7-2-1=4." (:= (:- (:- 7 2) 1) 4))
    ("7-(2-1)=6." (:= (:- 7 (:- 2 1)) 6))
    ("8/2/2=2." (:= (:/ (:/ 8 2) 2) 2))
    ("7%4*2=6." (:= (:* (:mod 7 4) 2) 6))
    ("1-(-1)=2." (:= (:- 1 -1) 2))
    ("1--1=2." (:= (:- 1 -1) 2))
    ("[n] -1<n." (:< -1 :?n))
    ("[n] n<-1." (:< :?n -1))
    ("[n] -n<1." (:< (:- 0 :?n) 1))
    ("[n] (n+1)=(1+n)." (:= (:+ :?n 1) (:+ 1 :?n)))
    ("[n] ((n+1))*2>3 & (P())." (:and (:> (:* (:+ :?n 1) 2) 3) (:p)))
    ("F(1)=0." (:= (:f 1) 0))
    ("F(3)=4.P()." (:= (:f 3) 4))
    ("[n] F(F(n)+1)=n%2." (:= (:f (:+ (:f :?n) 1)) (:mod :?n 2)))
    ("Size(Hammer)=3." (:= (:|Size| :|Hammer|) 3))
    ;; the event calculus
    ("Happens(Go(),0)." (:happens (:|Go|) 0))
    ("Happens(Go,0)." (:happens (:|Go|) 0))
    ("!HoldsAt(Lit(C),0)." (:not (:holds-at (:|Lit| :c) 0)))
    ("[time] !ReleasedAt(Up(),time)." (:not (:released-at (:|Up|) :?time)))
    ("HoldsAt(Option(),1)." (:holds-at (:|Option|) 1))
    ("[thing,time] Initiates(Push(thing),Lit(thing),time)."
     (:initiates (:|Push| :?thing) (:|Lit| :?thing) :?time))
    ("[tool,time]
  HoldsAt(Up(),time) &	; on several lines
  !HoldsAt(Lit(tool),time)
->
Terminates(Toggle(tool),Up(),time)
."
     (:implies (:and (:holds-at (:|Up|) :?time) (:not (:holds-at (:|Lit| :?tool) :?time)))
      (:terminates (:|Toggle| :?tool) (:|Up|) :?time)))
    ("[thing,time] Releases(Push(thing),Lit(thing),time)."
     (:releases (:|Push| :?thing) (:|Lit| :?thing) :?time))
    ("[thing,offset,n1,n2,time]
HoldsAt(Height(thing,n1),time) & n2=n1-(offset*offset) ->
Trajectory(Lit(thing),time,Height(thing,n2),offset)."
     (:implies (:and (:holds-at (:|Height| :?thing :?n1) :?time)
                     (:= :?n2 (:- :?n1 (:* :?offset :?offset))))
      (:trajectory (:|Lit| :?thing) :?time (:|Height| :?thing :?n2) :?offset)))
    ("[thing,offset,time] AntiTrajectory(Lit(thing),time,Up(),offset)."
     (:anti-trajectory (:|Lit| :?thing) :?time (:|Up|) :?offset))
    ("[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2."
     (:implies (:and (:happens :?event1 :?time) (:happens :?event2 :?time))
      (:= :?event1 :?event2)))
    ("[event,time] Happens(event,time) -> event!=Push(C)."
     (:implies (:happens :?event :?time) (:/= :?event (:|Push| :c))))
    ("[fluent,time1,time2] Clipped(time1,fluent,time2) -> StoppedIn(time1,fluent,time2) | P()."
     (:implies (:clipped :?time1 :?fluent :?time2)
      (:or (:stopped-in :?time1 :?fluent :?time2) (:p))))
    ("[fluent,time] Declipped(0,fluent,time) <-> StartedIn(0,fluent,time)."
     (:iff (:declipped 0 :?fluent :?time) (:started-in 0 :?fluent :?time)))
    ("[time] !({event} Happens(event,time) & P()) -> HoldsAt(Up(),time+1)."
     (:implies (:not (:exists (:?event) (:and (:happens :?event :?time) (:p))))
      (:holds-at (:|Up|) (:+ :?time 1))))
    ("[time] Happens(Go(),time) -> {thing} Happens(Push(thing),time) | Happens(Toggle(C),time)."
     (:implies (:happens (:|Go|) :?time)
      (:exists (:?thing)
               (:or (:happens (:|Push| :?thing) :?time) (:happens (:|Toggle| :c) :?time)))))
    ("[thing1,thing2,time] HoldsAt(Believes(On(thing1,thing2)),time)."
     (:holds-at (:|Believes| (:|On| :?thing1 :?thing2)) :?time))
    ("[belief,time] HoldsAt(Believes(belief),time) -> belief=Off()."
     (:implies (:holds-at (:|Believes| :?belief) :?time) (:= :?belief (:|Off|)))))
  "Texts and the formulas that they stand for.")

(test formulas-of-the-language
  (loop for (text expected) in *e-formulas*
        for formula = (first (e-formulas text))
        do (is (equal expected formula) "~a~%was read as ~s" text formula)))

(test formulas-are-written-as-they-are-read
  (loop for (text) in *e-formulas*
        for written = (format nil "~{~a~%~}" (written-sentences text))
        do (is (equal (e-formulas text) (e-formulas written))
               "~a~%was written as ~a" text written)))

(test parentheses-are-written-only-where-needed
  (loop for (text expected)
          in '(("((P())&(Q()))|R()." "P() & Q() | R().")
               ("(P() | Q()) & R()." "(P() | Q()) & R().")
               ("P() & (Q() & R())." "P() & (Q() & R()).")
               ("P() -> (Q() -> R())." "P() -> Q() -> R().")
               ("(P() -> Q()) -> R()." "(P() -> Q()) -> R().")
               ("!((P()))." "!P().")
               ("!(P() & Q()) <-> R()." "!(P() & Q()) <-> R().")
               ("{thing} (T(thing) & P())." "{thing} T(thing) & P().")
               ("({thing} T(thing)) & P()." "({thing} T(thing)) & P().")
               ("P() & ({thing} T(thing))." "P() & {thing} T(thing).")
               ("(P() & {thing} T(thing)) -> Q()." "P() & ({thing} T(thing)) -> Q().")
               ("!({thing} T(thing))." "!{thing} T(thing).")
               ("!({thing} T(thing)) & P()." "!({thing} T(thing)) & P().")
               ("(1+(2*3)) - (4 - 5) = 8." "1+2*3-(4-5)=8.")
               ("1 - -1 > -2." "1-(-1)>-2.")
               ("[n2] [n1] U(n1, n2)." "[n1,n2] U(n1,n2).")
               ("Theta: P." "Theta: P()."))
        do (is (equal (list expected) (written-sentences text)))))

(test long-formulas-are-broken-at-connectives
  (is (equal '("[time]" "HoldsAt(Height(Hammer,1),time) &"
               "(HoldsAt(Height(Hammer,2),time) & HoldsAt(Believes(On(C,D)),time) |" " {tool}"
               " HoldsAt(Lit(tool),time) &" " HoldsAt(Lit(C),time) &" " HoldsAt(Lit(D),time) &"
               " HoldsAt(Up(),time) &" " HoldsAt(Option(),time)) ->" "!HoldsAt(Up(),time+1).")
             (written-sentences "[time] HoldsAt(Height(Hammer,1),time) &
(HoldsAt(Height(Hammer,2),time) & HoldsAt(Believes(On(C,D)),time) |
{tool} HoldsAt(Lit(tool),time) & HoldsAt(Lit(C),time) & HoldsAt(Lit(D),time) & HoldsAt(Up(),time) &
HoldsAt(Option(),time)) -> !HoldsAt(Up(),time+1)."))))

;;; Declarations

(defun sort-parts (sort)
  (list (ec:sort-name sort) (ec:sort-parents sort) (ec:sort-range sort) (ec:sort-constants sort)
        (ec:sort-terms sort)))

(defun theory-parts (theory)
  "Return all of THEORY that its models depend on."
  (list (mapcar #'sort-parts (ec:theory-sorts theory))
        (ec:theory-predicates theory) (ec:theory-functions theory) (ec:theory-fluents theory)
        (ec:theory-non-inertial theory) (ec:theory-manual-release theory) (ec:theory-events theory)
        (loop for axiom in (ec:theory-axioms theory)
              collect (list (ec:axiom-label axiom) (ec:axiom-formula axiom)))
        (ec:theory-completions theory) (ec:theory-exclusions theory)
        (ec:theory-time-range theory) (ec:theory-offset-range theory) (ec:theory-options theory)))

(defun e-sorts (text)
  (mapcar #'sort-parts (ec:theory-sorts (ec:parse-e-text text))))

(test sorts
  (is (equal '((:agent () nil (:|Nathan| :r2) ())) (e-sorts "sort agent
agent Nathan
agent R2, Nathan")))
  (is (equal '((:a (:integer) (0 . 1) () ()) (:b (:integer) (-3 . 4) () ()))
             (e-sorts "sort a, b: integer
range a 0 1
range b -3 4")))
  (is (equal '((:a () nil () ()) (:b (:a) nil () ()) (:c (:a :b) nil () ()))
             (e-sorts "sort a
sort b: a, c: a
sort c: b
sort a")))
  (is (equal '((:|itemType| () nil (:a) ())
               (:belief () nil (:|None|) ((:|BOn| :|itemType| :belief))))
             (e-sorts "sort itemType
itemType A
reified sort belief
belief BOn(itemType,belief), None"))
      "a name with a capital is kept")
  (is (equal '((:a () nil (:c) ()) (:b () nil (:c) ()))
             (e-sorts "sort a, b
a C
b! C")))
  (is (equal '((:place (:integer) (1 . 3) () ())) (e-sorts "sort place: integer
place 1, 2
place 3")))
  (is (null (e-sorts "sort integer, time: integer, offset: integer
reified sort predicate, function, fluent, event")) "the foundations' sorts are there already"))

(test symbols
  (let ((theory (ec:parse-e-text "fluent A(x,
  y), B() ; a comment
fluent C
event Go(x), Go2
predicate Ab(x,time)
function F(x): y, G(x,y): integer
predicate HoldsAt(fluent,time)
fluent B()
sort x, y")))
    (is (equal '((:a :x :y) (:b) (:c)) (ec:theory-fluents theory)))
    (is (equal '((:|Go| :x) (:|Go2|)) (ec:theory-events theory)))
    (is (equal '((:|Ab| :x :time)) (ec:theory-predicates theory)))
    (is (equal '(((:f :x) :y) ((:g :x :y) :integer)) (ec:theory-functions theory)))))

(test directives
  (let ((theory (e-theory "
noninertial Up, Height
manualrelease Lit,
  Up
completion Happens
completion Theta T, Delta Happens
mutex Push, Go
xor Up, Option
range time 1 7
range offset 1 2
option encoding 3
option modeldiff on
option renaming off
option solver relsat -x")))
    (is (equal '(:|Up| :|Height|) (ec:theory-non-inertial theory)))
    (is (equal '(:|Lit| :|Up|) (ec:theory-manual-release theory)))
    (is (equal '((nil :happens) (:|Theta| :t) (:|Delta| :happens)) (ec:theory-completions theory)))
    (is (equal '((:mutex :|Push| :|Go|) (:xor :|Up| :|Option|)) (ec:theory-exclusions theory)))
    (is (equal '(1 . 7) (ec:theory-time-range theory)))
    (is (equal '(1 . 2) (ec:theory-offset-range theory)))
    (is (equal '(:encoding 3 :modeldiff t :renaming nil :solver "relsat -x")
               (ec:theory-options theory))))
  (is (eq t (ec:theory-manual-release (ec:parse-e-text "option manualrelease on"))))
  (is (eq '() (ec:theory-manual-release (ec:parse-e-text "option manualrelease off")))))

(test labels-names-and-positions
  (let ((axioms (ec:theory-axioms (ec:parse-e-text "predicate P()
; a comment
Delta: P(). P().

!P()." :name "dir/Some.e"))))
    (is (equal '(:|Delta| nil nil) (mapcar #'ec:axiom-label axioms)))
    (is (equal '(:|Some.e:3| :|Some.e:3.2| :|Some.e:5|) (mapcar #'ec:axiom-name axioms)))
    (is (equal '("dir/Some.e:3" "dir/Some.e:3" "dir/Some.e:5")
               (mapcar (lambda (axiom) (princ-to-string (ec:axiom-position axiom))) axioms)))))

(test ignored-symbols
  (is (equal '((:p) (:t :c)) (e-formulas "P(). Q(). !(T(D) -> Q()).
T(C).
ignore Q, Hammer, D
P() | Q(). T(Hammer). HoldsAt(Undeclared(Q),0).")))
  (is (equal '((:p)) (e-formulas "ignore Lit
P().
[time] Happens(Go(),time) -> HoldsAt(Lit(C),time)."))))

(test keywords-are-words-elsewhere
  "A keyword is one only before its object, and the reference's predicates can be names of fluents."
  (is (equal '((:holds-at (:|load| :?sort) 0))
             (mapcar #'ec:axiom-formula
                     (ec:theory-axioms (ec:parse-e-text "sort sort
fluent load(sort)
[sort] HoldsAt(load(sort),0).")))))
  (is (equal '((:|Started|) (:initiates (:go) (:|Started|) :?time))
             (let ((theory (ec:parse-e-text "fluent Started()
event GO()
[time] Initiates(GO(),Started(),time).")))
               (list (first (ec:theory-fluents theory))
                     (ec:axiom-formula (first (ec:theory-axioms theory)))))))
  (is (equal '((:|Clipped| :?x :?y))
             (mapcar #'ec:axiom-formula
                     (ec:theory-axioms (ec:parse-e-text "sort x, y
predicate Clipped(x,y)
[x,y] Clipped(x,y).")))))
  (is (equal '((:= :?x1 :?x))
             (mapcar #'ec:axiom-formula
                     (ec:theory-axioms (ec:parse-e-text "sort x1, x
[x1,x] x1=x."))))
      "a sort may end in a digit"))
