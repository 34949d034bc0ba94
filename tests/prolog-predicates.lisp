;;;; The built-in predicates of the layer prolog, and random programs.

(in-package #:discrepancy-finder.tests)

(in-suite prolog)

;;; Control

(prolog:def-fact-group tests-cut ()
  (prolog:<- (one 1)) (prolog:<- (one 2)) (prolog:<- (one 3))
  (prolog:<- (first-one ?x) (one ?x) (prolog:cut))
  (prolog:<- (first-one 100))
  (prolog:<- (cut-then ?x ?y) (one ?x) (prolog:cut) (one ?y))
  (prolog:<- (cut-in-or ?x) (or (and (one ?x) (prolog:cut)) (prolog:== ?x 50)))
  (prolog:<- (cut-in-or 60))
  (prolog:<- (cut-in-then ?x) (prolog:-> (one ?_) (and (one ?x) (prolog:cut)) (prolog:fail)))
  (prolog:<- (cut-in-then 60))
  (prolog:<- (cut-in-condition ?x)
    (prolog:-> (and (one ?_) (prolog:cut)) (one ?x) (prolog:fail)))
  (prolog:<- (cut-in-condition 60))
  (prolog:<- (cut-in-not ?x) (not (and (one ?_) (prolog:cut) (prolog:fail))) (one ?x))
  (prolog:<- (cut-in-not 60))
  (prolog:<- (cut-in-findall ?l) (prolog:findall ?x (and (one ?x) (prolog:cut)) ?l))
  (prolog:<- (cut-in-findall 60))
  (prolog:<- (cut-in-call ?x) (prolog:call (and (one ?x) (prolog:cut))))
  (prolog:<- (cut-in-call 60))
  (prolog:<- (cut-in-once ?x ?y) (one ?x) (prolog:once (one ?y) (prolog:cut)))
  (prolog:<- (calls-a-cut ?x ?y) (first-one ?x) (one ?y))
  (prolog:<- (fails-after-cut) (prolog:cut) (prolog:fail))
  (prolog:<- (fails-after-cut)))

(test the-cut
  (yields '(first-one ?x) '?x 1)
  (yields '(cut-then ?x ?y) '(?x ?y) '(1 1) '(1 2) '(1 3))
  (yields '(cut-in-or ?x) '?x 1)
  (yields '(cut-in-then ?x) '?x 1)
  (fails '(fails-after-cut))
  (yields '(calls-a-cut ?x ?y) '(?x ?y) '(1 1) '(1 2) '(1 3))
  (yields '(and (one ?x) (prolog:cut)) '?x 1)
  (yields '(and (one ?x) (first-one ?y)) '(?x ?y) '(1 1) '(2 1) '(3 1)))

(test cuts-that-are-local
  (yields '(cut-in-condition ?x) '?x 1 2 3 60)
  (yields '(cut-in-not ?x) '?x 1 2 3 60)
  (yields '(cut-in-findall ?l) '?l '(1) 60)
  (yields '(cut-in-call ?x) '?x 1 60)
  (yields '(cut-in-once ?x ?y) '(?x ?y) '(1 1) '(2 1) '(3 1)))

(test conjunction-and-disjunction
  (holds '(and))
  (fails '(or))
  (holds '(prolog:true))
  (fails '(prolog:fail))
  (yields '(or (prolog:== ?x 1) (prolog:== ?x 2) (prolog:fail) (prolog:== ?x 3)) '?x 1 2 3)
  (yields '(and (or (prolog:== ?x 1) (prolog:== ?y 2)) (prolog:== ?z (?x ?y))
            (prolog:bound ?y)) '?y 2)
  (yields '(or (and (prolog:== ?x 1) (prolog:fail)) (not (prolog:bound ?x))) 'yes 'yes))

(test negation
  (holds '(not (one 4)))
  (fails '(not (one ?x)))
  (holds '(not (one 1) (one 7)))
  (yields '(and (one ?x) (not (prolog:== ?x 2))) '?x 1 3)
  (yields '(and (not (not (prolog:== ?x 1))) (prolog:== ?x 5)) '?x 5)
  (fails '(not (not (not (one 1))))))

(test conditionals
  (yields '(prolog:-> (one ?x) (prolog:== ?y ?x) (prolog:== ?y none)) '?y 1)
  (yields '(prolog:-> (one 9) (prolog:== ?y yes) (prolog:== ?y no)) '?y 'no)
  (fails '(prolog:-> (one 9) (prolog:true)))
  (fails '(prolog:-> (one 1) (prolog:fail) (prolog:true)))
  (yields '(prolog:-> (one 1) (one ?x)) '?x 1 2 3)
  (yields '(prolog:*-> (one ?x) (prolog:== ?y ?x) (prolog:== ?y none)) '?y 1 2 3)
  (yields '(prolog:*-> (one 9) (prolog:true) (one ?y)) '?y 1 2 3)
  (fails '(prolog:*-> (one ?x) (prolog:fail) (prolog:true)))
  (yields '(and (one ?x) (prolog:*-> (prolog:== ?x 2) (prolog:== ?y two) (prolog:== ?y other)))
          '(?x ?y) '(1 other) '(2 two) '(3 other)))

(test once-call-take-forall-every
  (yields '(prolog:once (one ?x) (< 1 ?x)) '?x 2)
  (fails '(prolog:once (one 9)))
  (yields '(and (one ?x) (prolog:once (one ?y))) '(?x ?y) '(1 1) '(2 1) '(3 1))
  (yields '(prolog:call one ?x) '?x 1 2 3)
  (yields '(prolog:call (parent tom) ?x) '?x 'bob)
  (yields '(and (prolog:== ?g (one ?x)) (prolog:call ?g)) '?x 1 2 3)
  (yields '(prolog:take 2 (one ?x)) '?x 1 2)
  (fails '(prolog:take 0 (one ?x)))
  (yields '(and (member ?y (a b)) (prolog:take 1 (one ?x))) '(?y ?x) '(a 1) '(b 1))
  (yields '(prolog:take 3 (naturals ?x)) '?x 0 1 2)
  (signals-with (prolog:malformed-goal "no integer") (prolog:prolog '(prolog:take ?n (one 1))))
  (holds '(prolog:forall (one ?x) (< 0 ?x)))
  (fails '(prolog:forall (one ?x) (< 1 ?x)))
  (holds '(prolog:forall (one 9) (prolog:fail)))
  (yields '(and (prolog:forall (one ?x) (prolog:true)) (prolog:== ?x 77)) '?x 77)
  (holds '(every ((one 1) (one 2))))
  (fails '(every ((one 1) (one 9))))
  (holds '(every one (1 2 3)))
  (fails '(every one (1 9)))
  (holds '(every (parent bob) (ann pat)))
  (holds '(every one ())))

(test collecting
  (yields '(prolog:findall ?x (one ?x) ?l) '?l '(1 2 3))
  (yields '(prolog:findall ?x (one 9) ?l) '?l '())
  (yields '(prolog:findall (?x ?y) (and (one ?x) (< ?x 3) (prolog:== ?y k)) ?l) '?l
          '((1 k) (2 k)))
  (yields '(and (prolog:findall ?x (one ?x) ?l) (prolog:== ?x 5)) '(?x ?l) '(5 (1 2 3)))
  (fails '(prolog:findall ?x (one ?x) (1 2)))
  (yields '(prolog:findall ?l (and (one ?x) (prolog:findall ?y (one ?y) ?l)) ?ls) '?ls
          '((1 2 3) (1 2 3) (1 2 3)))
  (yields '(and (prolog:findall ?y (one ?x) (?a ?b ?c)) (prolog:== ?a 1)) '(?a ?b) '(1 ?b))
  (fails '(prolog:bagof ?x (one 9) ?l))
  (yields '(prolog:bagof ?x (member ?x (b a b)) ?l) '?l '(b a b))
  (yields '(prolog:setof ?x (member ?x (b a b (c) (c))) ?l) '?l '(b a (c)))
  (yields '(prolog:set-of ?x (member ?x (1 1)) ?l) '?l '(1))
  (fails '(prolog:setof ?x (one 9) ?l)))

(test filtering-bindings
  (yields '(prolog:filter-bindings (?c) (parent ?p ?c) (likes ?c ?_)) '(?c (prolog:bound ?p))
          '(ann (prolog:bound ?p)))
  (yields '(and (prolog:== ?p bob) (prolog:filter-bindings (?c) (parent ?p ?c))) '(?p ?c)
          '(bob ann) '(bob pat))
  (fails '(prolog:filter-bindings (?c) (parent nobody ?c))))

;;; Random programs, against a proof procedure that is as plain as can be

(defun plain-solutions (goals facts bindings)
  "Return the list of the binding sets that make GOALS true by FACTS, lists (head goal*)."
  (if (null goals)
      (list bindings)
      (destructuring-bind ((functor . arguments) . others) goals
        (flet ((solutions (goals) (plain-solutions goals facts bindings)))
          (case functor
            (and (solutions (append arguments others)))
            (or (mapcan (lambda (goal) (solutions (cons goal others))) arguments))
            (not (if (solutions arguments) '() (solutions others)))
            (prolog:-> (let ((found (solutions (list (first arguments)))))
                         (if found
                             (plain-solutions (cons (second arguments) others) facts (first found))
                             (solutions (cons (third arguments) others)))))
            (t (mapcan (lambda (fact)
                         (destructuring-bind (head . body) (prolog:rename-vars fact)
                           (multiple-value-bind (more matched)
                               (prolog:unify head (cons functor arguments) bindings)
                             (and matched
                                  (plain-solutions (append body others) facts more)))))
                       facts)))))))

(defun random-program (state)
  "Return random facts for the predicates (random-0 x y), ..., each with goals of smaller number."
  (labels ((pick (&rest choices) (nth (random (length choices) state) choices))
           (argument () (case (random 6 state)
                          (0 (pick 1 2))
                          (1 (list 'f (pick '?x 'a)))
                          (2 (pick 'a 'b))
                          (t (pick '?x '?y '?z))))
           (goal (level)
             (if (zerop (random 4 state))
                 (ecase (random 4 state)
                   (0 (list 'or (goal level) (goal level)))
                   (1 (list 'not (goal level)))
                   (2 (list 'and (goal level) (goal level)))
                   (3 (list 'prolog:-> (goal level) (goal level) (goal level))))
                 (list (elt #(random-0 random-1 random-2) (random level state))
                       (argument) (argument)))))
    (loop for level below 4
          append (loop repeat (1+ (random 3 state))
                       collect (list* (list (elt #(random-0 random-1 random-2 random-3) level)
                                            (argument) (argument))
                                      (loop repeat (if (zerop level) 0 (random 3 state))
                                            collect (goal level)))))))

(defun canonical (form)
  "Return FORM with its variables numbered."
  (sublis (loop for variable in (prolog:vars-in form) for i from 0 collect (cons variable i))
          form))

(test random-programs-have-the-solutions-of-a-plain-proof-procedure
  (let ((state (sb-ext:seed-random-state 3))
        (differing 0) (solutions 0))
    (loop repeat 2000
          do (let ((facts (random-program state)))
               (prolog::define-fact-group 'tests-random '() facts)
               (let ((plain (loop for bindings in (plain-solutions '((random-3 ?p ?q)) facts '())
                                  collect (prolog:var-value '(?p ?q) bindings)))
                     (found (answers '(?p ?q) '(random-3 ?p ?q))))
                 (incf solutions (length plain))
                 (unless (equal (mapcar #'canonical plain) (mapcar #'canonical found))
                   (when (= 1 (incf differing))
                     (fail "~s~%has ~s, found are ~s" facts plain found))))))
    (is (= 0 differing))
    (is (< 1000 solutions) "only ~d solutions" solutions)
    (prolog:def-fact-group tests-random ())))

;;; Lisp in goals

(defvar *set-by-a-goal* 1
  "Set by a goal.")

(test calling-lisp
  (yields '(prolog:lisp-fun + 1 2 ?x) '?x 3)
  (yields '(prolog:lisp-fun + ?x) '?x 0)
  (holds '(prolog:lisp-fun + 1 2 3))
  (fails '(prolog:lisp-fun + 1 2 4))
  (yields '(prolog:lisp-fun car ((nil)) (?x)) '?x 'nil)
  (yields '(prolog:lisp-fun cdr (1) ?x) '?x 'nil)
  (yields '(prolog:lisp-fun #'list 1 "A" ?x) '?x '(1 "A"))
  (yields `(prolog:lisp-fun ,#'list 1 ?_) 'yes 'yes)
  (fails '(prolog:lisp-fun + 1 ?y ?x))
  (yields '(and (prolog:== ?f list) (prolog:lisp-fun ?f a ?x)) '?x '(a))
  (yields '(and (prolog:lisp-fun list (a ?y) b ?x) (prolog:== ?y 5)) '?x '((a 5) b))
  (holds '(prolog:lisp-pred < 1 2))
  (fails '(prolog:lisp-pred < 2 1))
  (fails '(prolog:lisp-pred null ?x))
  (holds '(prolog:lisp-type 3 (or string number)))
  (fails '(prolog:lisp-type a number))
  (holds '(prolog:instance-of number 3))
  (fails '(prolog:instance-of string 3)))

(test backtracking-into-lisp
  (setf *side-effects* '())
  (yields '(and (member ?x (1 2 3)) (prolog:lisp-fun note ?x ?y) (< 1 ?y)) '?y 2 3)
  (is (equal '(3 2 1) *side-effects*)))

(test errors-in-lisp
  (warns-with (prolog:lisp-error-in-goal "(lisp-fun error \"The Cup" "The Cup is gone")
    (let ((*package* (find-package '#:discrepancy-finder.prolog)))
      (fails '(prolog:lisp-fun error "The Cup is gone" ?x))))
  (warns-with (prolog:lisp-error-in-goal "lisp-pred")
    (yields '(or (prolog:lisp-pred car 5) (prolog:== ?x 2)) '?x 2))
  (warns-with (prolog:lisp-error-in-goal "no-such-function-of-the-tests")
    (fails '(prolog:lisp-pred no-such-function-of-the-tests)))
  (warns-with (prolog:lisp-error-in-goal "<") (fails '(< a 1)))
  (let ((prolog:*break-on-lisp-errors* t))
    (signals type-error (prolog:prolog '(prolog:lisp-fun car 5 ?x))))
  (signals plan:plan-failure (prolog:prolog '(prolog:lisp-fun plan:fail "Failure" ?x))))

(test a-proof-left-by-lisp-goes-on
  (let* ((broken t)
         (solutions (prolog:prolog
                     `(and (member ?x (1 2 3))
                           (prolog:lisp-pred ,(lambda (x)
                                                (when (and broken (= x 2))
                                                  (throw 'left :left))
                                                t)
                                             ?x)))))
    (is (eq :left (catch 'left (prolog:force-ll solutions) :not-left)))
    (setf broken nil)
    (is (equal '(1 2 3) (mapcar (lambda (solution) (prolog:var-value '?x solution))
                                (prolog:force-ll solutions))))))

(test types-slots-and-symbols
  (holds '(prolog:assert-type 3 string "HERE"))
  (let ((prolog:*break-on-lisp-errors* t))
    (holds '(prolog:assert-type 3 number "HERE"))
    (signals-with (type-error "HERE" "number") (prolog:prolog '(prolog:assert-type a number
                                                                "HERE"))))
  (setf *set-by-a-goal* 1)
  (yields '(symbol-value *set-by-a-goal* ?x) '?x 1)
  (holds '(prolog:set-symbol-value *set-by-a-goal* nil))
  (is (null *set-by-a-goal*))
  (holds '(symbol-value *set-by-a-goal* nil))
  (fails '(prolog:set-symbol-value *set-by-a-goal* ?x))
  (let ((object (make-instance 'twin :name :a)))
    (yields `(slot-value ,object name ?x) '?x :a)
    (yields `(prolog:get-slot-value ,object name ?x) '?x :a)
    (fails `(slot-value ,object name :b))
    (warns-with (prolog:lisp-error-in-goal "colour") (fails `(slot-value ,object colour ?x)))))

(test looking-at-terms
  (holds '(prolog:bound a))
  (holds '(prolog:bound (?x)))
  (fails '(prolog:bound ?x))
  (holds '(and (prolog:== ?x 1) (prolog:bound ?x)))
  (fails '(and (prolog:== ?x ?y) (prolog:bound ?x)))
  (holds '(prolog:ground (a (b))))
  (fails '(prolog:ground (a (?x))))
  (holds '(and (prolog:== ?x 1) (prolog:ground (a ?x))))
  (yields '(prolog:== (a ?x) (?y b)) '(?x ?y) '(b a))
  (yields '(equal ?x (1 2)) '?x '(1 2))
  (holds '(equal "a" "a"))
  (fails '(equal (1) (2))))

(test numbers-in-goals
  (holds '(and (< 1 2) (> 2 1) (<= 1 1 2) (>= 2 2 1) (= 1 1d0) (/= 1 2)))
  (fails '(< 2 1))
  (fails '(> 1 2))
  (fails '(<= 2 1))
  (fails '(>= 1 2))
  (fails '(= 1 2))
  (fails '(/= 1 1))
  (fails '(< ?x 1))
  (yields '(max 3 7 ?x) '?x 7)
  (yields '(max (3 9 7) ?x) '?x 9)
  (yields '(min 3 7 ?x) '?x 3)
  (yields '(min (3 9 7) ?x) '?x 3)
  (fails '(max 3 7 3)))

(test output-of-goals
  (let ((text (with-output-to-string (*standard-output*)
                (prolog:prolog '(and (prolog:== ?x (1)) (format "ab ~a" ?x))))))
    (is (string= "ab (1)" text)))
  (is (string= "to" (with-output-to-string (stream) (prolog:prolog `(format ,stream "to")))))
  (holds '(format nil "written nowhere"))
  (warns-with (simple-warning "careful 3") (holds '(warn "careful ~a" 3)))
  (signals-with (simple-error "stop 3") (prolog:prolog '(error "stop ~a" 3)))
  (yields '(prolog:string-concat "a" "b" "C" ?x) '?x "abC")
  (fails '(prolog:string-concat "a" "b")))

(test lists-in-goals
  (yields '(member ?x (a b a)) '?x 'a 'b 'a)
  (yields '(member (k ?x) ((j 1) (k 2) (k 3))) '?x 2 3)
  (fails '(member a ()))
  (fails '(member a b))
  (yields '(prolog:take 2 (and (member a ?l) (prolog:lisp-fun identity 0 ?_))) 'yes 'yes 'yes)
  (yields '(append (1) (2 3) ?x) '?x '(1 2 3))
  (yields '(append ?x ?y (1 2)) '(?x ?y) '(() (1 2)) '((1) (2)) '((1 2) ()))
  (yields '(append ?x (3) (1 2 3)) '?x '(1 2))
  (fails '(append (1) ?x (2 3)))
  (yields '(length (a b) ?n) '?n 2)
  (fails '(length (a b) 3))
  (yields '(and (length ?l 2) (prolog:== ?l (1 ?x)) (prolog:== ?x 2)) '?l '(1 2))
  (fails '(length ?l ?n))
  (fails '(length 5 ?n))
  (yields '(reduce + (1 2 3) ?x) '?x 6)
  (yields '(sort (3 1 2) < ?x) '?x '(1 2 3))
  (yields '(and (prolog:== ?l (3 1 2)) (sort ?l > ?x)) '(?l ?x) '((3 1 2) (3 2 1))))

(test lazy-lists-in-goals
  (multiple-value-bind (numbers count) (counted-naturals)
    (let ((solutions (prolog:prolog `(and (member ?x ,numbers) (< 2 ?x)))))
      (is (= 3 (prolog:var-value '?x (first solutions))))
      (is (= 4 (funcall count)))
      (is (= 5 (prolog:var-value '?x (prolog:lazy-elt solutions 2))))))
  (yields `(count-elements ,(prolog:lazy-take 5 (counted-naturals)) ?n) '?n 5)
  (yields `(prolog:== ,(prolog:lazy-take 3 (counted-naturals)) (0 ?x 2)) '?x 1)
  (yields `(prolog:take 2 (prolog:generate-values ,(counted-naturals) ?x)) '?x 0 1)
  (let ((n 0))
    (yields `(prolog:generate-values ,(lambda () (when (< n 3) (incf n))) ?x) '?x 1 2 3)))

(test predicates-are-described
  (is (search "twice the number" (documentation 'tests-twice 'prolog:predicate)))
  (let ((text (with-output-to-string (stream) (prolog:describe-predicates stream))))
    (is (search "(lisp-pred function &rest arguments)" text))
    (is (search "tests-family" text)))
  (dolist (name '(and or not every member append length max min reduce sort equal < > <= >= = /=
                  symbol-value slot-value format warn error
                  prolog:-> prolog:*-> prolog:cut prolog:true prolog:fail prolog:call prolog:once
                  prolog:forall prolog:findall prolog:bagof prolog:setof prolog:set-of prolog:take
                  prolog:filter-bindings prolog:generate-values prolog:lisp-fun prolog:lisp-pred
                  prolog:lisp-type prolog:instance-of prolog:assert-type prolog:set-symbol-value
                  prolog:get-slot-value prolog:bound prolog:ground prolog:==
                  prolog:string-concat))
    (is-true (documentation name 'prolog:predicate) "~s has no documentation" name)))
