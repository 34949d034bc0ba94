;;;; The layer prolog: unification, facts, the proof of queries, handlers.

(in-package #:discrepancy-finder.tests)

(def-suite prolog :in all)
(in-suite prolog)

;;; Queries stand in functions, since FiveAM takes symbols that begin with ? for its own.

(defun answers (form query &optional bindings)
  "Return the list of what FORM is in the solutions of QUERY."
  (prolog:force-ll (prolog:lazy-mapcar (lambda (solution) (prolog:var-value form solution))
                                       (prolog:prolog query bindings))))

(defun yields (query form &rest expected)
  "Check that FORM is each of EXPECTED in turn in the solutions of QUERY."
  (let ((actual (answers form query)))
    (is (equalp expected actual) "~s gives ~s" query actual)))

(defun holds (query)
  (is-true (prolog:prolog query) "~s fails" query))

(defun fails (query)
  (let ((solutions (prolog:prolog query)))
    (is (null solutions) "~s has the solution ~s" query (first solutions))))

(defun warnings-of (class function)
  "Return the reports of the warnings of CLASS that FUNCTION signals; others are not muffled."
  (let ((reports '()))
    (handler-bind ((warning (lambda (condition)
                              (when (typep condition class)
                                (push (princ-to-string condition) reports)
                                (muffle-warning condition)))))
      (funcall function))
    (nreverse reports)))

(defmacro warns-with ((class &rest parts) &body body)
  "Check that BODY signals one warning of CLASS, of one line that contains each of PARTS."
  `(let ((reports (warnings-of ',class (lambda () ,@body))))
     (is (= 1 (length reports)) "~d warnings" (length reports))
     (dolist (report reports)
       (is (null (find #\Newline report)) "more than one line: ~a" report)
       (dolist (part (list ,@parts))
         (is (search part report) "~s is not in: ~a" part report)))))

(defvar *side-effects* '()
  "What goals have pushed.")

(defun note (value)
  (push value *side-effects*)
  value)

;;; Bindings and unification

(test variables
  (flet ((check (function true false)
           (dolist (form true) (is-true (funcall function form) "~s of ~s" function form))
           (dolist (form false) (is-false (funcall function form) "~s of ~s" function form))))
    (check #'prolog:is-var '(?x ? ?_ ?long-name) '(x nil "?x" 3 (?x) || !?x))
    (check #'prolog:is-unnamed-var '(?_) '(?x ? ?_x nil))
    (check #'prolog:is-segvar '(!?x) '(?x ! nil "!?x"))
    (check #'prolog:is-genvar (list (prolog:gen-var) (prolog:gen-var '?x)) '(?x nil)))
  (let ((found (prolog:vars-in '(f ?b (g ?a . ?b) ?_ "?c"))))
    (is (equal '(?b ?a) found)))
  (multiple-value-bind (form renaming) (prolog:rename-vars '(f ?a ?b ?a ?_))
    (is (eq (second form) (fourth form)))
    (is-false (eq (second form) (third form)))
    (is-true (prolog:is-genvar (second form)))
    (is (eq (second form) (cdr (first renaming))))
    (is-true (prolog:is-unnamed-var (fifth form)))))

(test values-of-variables
  (let ((bindings '((?x . (f ?y)) (?y . ?z) (?z . 3) (?u . ?v))))
    (flet ((value (form) (prolog:var-value form bindings)))
      (is (equal '((f 3) 3 3 7 (a (f 3) . 3))
                 (mapcar #'value '(?x ?y ?z 7 (a ?x . ?y)))))
      (is (eq '?v (value '?u)))
      (is (eq '?w (value '?w))))
    (is (equal '(t t nil nil t) (mapcar (lambda (form) (prolog:is-bound form bindings))
                                        '(?x ?y ?u ?w 5))))
    (let ((list (list 1 2)))
      (is (eq list (prolog:substitute-vars list bindings))))
    (let ((more (prolog:add-bds '?w 4 bindings)))
      (is (eql 4 (prolog:var-value '?w more))))
    (prolog:with-vars-bound (?x ?w) bindings
      (let ((x ?x) (w ?w))
        (is (equal '(f 3) x))
        (is (eq '?w w))))
    (prolog:with-vars-strictly-bound (?z) bindings
      (let ((z ?z)) (is (eql 3 z))))
    (signals-with (prolog:variable-not-bound "?w")
      (prolog:with-vars-strictly-bound (?z ?w) bindings (list ?z ?w)))))

(defclass twin ()
  ((name :initarg :name :reader twin-name))
  (:documentation "Objects of the same name unify."))

(defmethod prolog:unify-p ((left twin) (right twin))
  (eq (twin-name left) (twin-name right)))

(defun unified (left right &optional bindings)
  "Return what LEFT and RIGHT are after unification, or :NO."
  (multiple-value-bind (result matched) (prolog:unify left right bindings)
    (if matched
        (list (prolog:var-value left result) (prolog:var-value right result))
        :no)))

(test unification
  (flet ((yes (left right expected &optional bindings)
           (let ((both (unified left right bindings)))
             (is (equalp (list expected expected) both) "~s and ~s: ~s" left right both)))
         (no (left right &optional bindings)
           (is (eq :no (unified left right bindings)) "~s and ~s unify" left right)))
    (yes 'a 'a 'a)
    (yes '?x 'a 'a)
    (yes '(f ?x b) '(f a ?y) '(f a b))
    (yes '(?x ?x) '(?y 3) '(3 3))
    (yes '(a . ?rest) '(a b c) '(a b c))
    (yes '(?x) '(()) '(()))
    (yes 1 1d0 1)
    (yes "abc" (copy-seq "abc") "abc")
    (yes '(f ?x) '(f ?x) '(f 5) '((?x . 5)))
    (yes '?x '?y 5 '((?y . 5)))
    (yes '(?x (g ?x)) '((h ?y) (g (h 2))) '((h 2) (g (h 2))))
    (no 'a 'b)
    (no 'a "a")
    (no "a" "A")
    (no 1 2)
    (no '(a) 'a)
    (no '(a b) '(a))
    (no '(?x ?x) '(1 2))
    (no '?x 4 '((?x . 5)))
    (no 'nil 'false)
    (no sb-kernel::(make-double-float -524288 0) 1)
    (no '?x '(f ?x))
    (no '(?x ?y) '((f ?y) (f ?x)))
    (no '(?x ?y ?x) '((f ?y) (f ?x) ?y)))
  (let ((anything (unified '(?_ ?_) '(1 2))))
    (is (equal '((?_ ?_) (1 2)) anything)))
  (is (equal '(nil t) (multiple-value-list (prolog:unify 'a 'a))))
  (let ((a (make-instance 'twin :name :a)) (b (make-instance 'twin :name :b))
        (other-a (make-instance 'twin :name :a)) (table (make-hash-table)))
    (is (equal '(nil t) (multiple-value-list (prolog:unify (list a) (list other-a)))))
    (is (eq :no (unified a b)))
    (is (eq :no (unified a :a)))
    (is (equal '(nil t) (multiple-value-list (prolog:unify table table))))
    (is (eq :no (unified table (make-hash-table))))))

(test long-and-deep-terms-unify
  (flet ((nest (end) (let ((term end)) (dotimes (i 200000 term) (setf term (list 's term)))))
         (long (end) (append (loop for i below 200000 collect i) end)))
    (let ((bindings (prolog:unify (nest '?x) (nest 'zero))))
      (is (eq 'zero (prolog:var-value '?x bindings))))
    (let ((bindings (prolog:unify (long '?x) (long '(end)))))
      (is (equal '(end) (prolog:var-value '?x bindings))))
    (is-false (nth-value 1 (prolog:unify '?x (nest '?x))))))

;;; Facts and queries

(prolog:def-fact-group tests-family (likes tests-without-facts)
  (prolog:<- (parent tom bob))
  (prolog:<- (parent bob ann))
  (prolog:<- (parent bob pat))
  (prolog:<- (parent pat jim))
  (prolog:<- (ancestor ?a ?d) (parent ?a ?d))
  (prolog:<- (ancestor ?a ?d) (parent ?a ?c) (ancestor ?c ?d))
  (prolog:<- (likes ann bob))
  (prolog:<- (same ?x ?x))
  (prolog:<- (anyone ?_ ?_))
  (prolog:<- (list-of-any . ?elements) (prolog:== ?elements (?_ . ?_)))
  (prolog:<- (naturals 0))
  (prolog:<- (naturals ?n) (naturals ?m) (prolog:lisp-fun 1+ ?m ?n))
  (prolog:<- (count-elements () 0))
  (prolog:<- (count-elements (?_ . ?rest) ?n)
    (count-elements ?rest ?m) (prolog:lisp-fun 1+ ?m ?n))
  (prolog:<- (even-length ()))
  (prolog:<- (even-length (?_ . ?rest)) (not (even-length ?rest))))

(test facts-and-rules
  (yields '(parent bob ?c) '?c 'ann 'pat)
  (yields '(ancestor tom ?d) '?d 'bob 'ann 'pat 'jim)
  (yields '(ancestor ?a jim) '?a 'pat 'tom 'bob)
  (holds '(parent tom bob))
  (fails '(parent tom ann))
  (is (equal '(()) (prolog:prolog '(parent tom bob))) "one solution without bindings")
  (yields '(and (parent ?x ?y) (parent ?y ?z)) '(?x ?y ?z) '(tom bob ann) '(tom bob pat)
          '(bob pat jim)))

(test variables-in-heads-and-queries
  (yields '(same (f ?x 2) (f 1 ?y)) '(?x ?y) '(1 2))
  (fails '(same 1 2))
  (fails '(same ?x (f ?x)))
  (holds '(anyone 1 2))
  (yields '(and (anyone ?x ?y) (prolog:== ?x 1)) '?x 1)
  (yields '(and (same ?_ 1) (same ?_ 2)) 'yes 'yes)
  (yields '(and (same ?x ?y) (same ?y ?z) (prolog:== ?z 7)) '(?x ?y ?z) '(7 7 7))
  (holds '(list-of-any 1 2 3))
  (holds '(list-of-any 1))
  (fails '(list-of-any))
  (let ((solution (first (prolog:prolog '(same ?x ?y)))))
    (is (eq (prolog:var-value '?x solution) (prolog:var-value '?y solution)))
    (is-true (prolog:is-var (prolog:var-value '?x solution))))
  (let ((solution (first (prolog:prolog '(prolog:== ?x (f ?_))))))
    (is-true (prolog:is-genvar (second (prolog:var-value '?x solution))))))

(test bindings-of-a-query
  (flet ((check (expected form query bindings)
           (let ((actual (answers form query bindings)))
             (is (equal expected actual) "~s gives ~s" query actual))))
    (check '(ann pat) '?c '(parent ?p ?c) '((?p . bob)))
    (check '((ann bob) (pat bob)) '(?c ?p) '(parent ?p ?c) '((?p . ?q) (?q . bob)))
    (check '((f ann)) '?z '(likes ?w bob) '((?z . (f ?w))))
    (check '() '?p '(parent ?p ann) '((?p . tom)))))

(test solutions-are-lazy
  (is (equal '(0 1 2 3 4)
             (prolog:force-ll
              (prolog:lazy-take 5 (prolog:lazy-mapcar
                                   (lambda (solution) (prolog:var-value '?n solution))
                                   (prolog:prolog '(naturals ?n)))))))
  (let* ((calls '())
         (solutions (prolog:prolog `(and (member ?x (1 2 3))
                                         (prolog:lisp-fun ,(lambda (x) (push x calls) (* x x))
                                                          ?x ?y)))))
    (is (equal '(1) calls))
    (is (eql 4 (prolog:var-value '?y (prolog:lazy-elt solutions 1))))
    (is (equal '(2 1) calls))
    (is (eql 1 (prolog:var-value '?y (prolog:lazy-elt solutions 0))))
    (prolog:force-ll solutions)
    (is (equal '(3 2 1) calls))))

(test depth-is-not-bounded-by-the-control-stack
  (let ((list (loop for i below 100000 collect i)))
    (yields `(count-elements ,list ?n) '?n 100000)
    (yields `(and (append ,list (end) ?l) (length ?l ?n)) '?n 100001)
    (yields `(member 99999 ,list) 'yes 'yes)
    (holds `(even-length ,list))
    (fails `(even-length ,(rest list))))
  (is (= 500 (prolog:var-value '?n (prolog:lazy-elt (prolog:prolog '(naturals ?n)) 500)))))

(test unknown-predicates
  (warns-with (prolog:unknown-predicate "no-such-predicate" "2 arguments" "(and (parent")
    (fails '(and (parent tom ?x) (no-such-predicate ?x 1))))
  (warns-with (prolog:unknown-predicate "parent with 3 arguments" "only with 2")
    (fails '(parent tom bob ann)))
  (is (null (warnings-of 'warning (lambda ()
                                    (fails '(likes bob ?x))
                                    (fails '(tests-without-facts ?x)))))))

(test malformed-goals
  (signals-with (prolog:malformed-goal "42" "no list") (prolog:prolog '(and 42)))
  (signals-with (prolog:malformed-goal "?x" "unbound variable") (prolog:prolog '?x))
  (signals-with (prolog:malformed-goal "(\"f\" 1)" "no name") (prolog:prolog '("f" 1)))
  (signals-with (prolog:malformed-goal "no list") (prolog:prolog '(parent tom . bob)))
  (signals-with (prolog:malformed-goal "findall" "it takes 3 arguments")
    (prolog:prolog '(prolog:findall ?x (parent ?x ?y))))
  (signals-with (prolog:malformed-goal "2 to 3 arguments") (prolog:prolog '(prolog:-> (likes))))
  (signals-with (prolog:malformed-goal "1 or more") (prolog:prolog '(<)))
  (yields '(and (prolog:== ?arguments (tom ?c)) (parent . ?arguments)) '?c 'bob)
  (yields '(and (prolog:== ?p parent) (?p tom ?c)) '?c 'bob))

(defmacro expansion-of (form)
  `(macroexpand-1 ',form))

(test malformed-facts
  (signals-with (prolog:malformed-fact "group tests-broken" "(parent a b)" "(<- (predicate")
    (expansion-of (prolog:def-fact-group tests-broken () (parent a b))))
  (signals-with (prolog:malformed-fact "tests-broken" "parent" "not (predicate argument*)")
    (expansion-of (prolog:def-fact-group tests-broken () (prolog:<- parent (other)))))
  (signals-with (prolog:malformed-fact "tests-broken" "no name")
    (expansion-of (prolog:def-fact-group tests-broken () (prolog:<- (?p 1)))))
  (signals-with (prolog:malformed-fact "tests-broken" "\"Goal\" is no goal")
    (expansion-of (prolog:def-fact-group tests-broken () (prolog:<- (p 1) "Goal"))))
  (signals-with (prolog:malformed-fact "tests-broken" "no head")
    (expansion-of (prolog:def-fact-group tests-broken () (prolog:<-))))
  (signals-with (prolog:malformed-fact "tests-broken" "dotted")
    (expansion-of (prolog:def-fact-group tests-broken () (prolog:<- (p 1) . q))))
  (signals-with (prolog:malformed-fact "tests-broken" "no name of an extendable")
    (expansion-of (prolog:def-fact-group tests-broken ((p)))))
  (signals-with (prolog:malformed-fact "outside of any fact group")
    (expansion-of (prolog:<- (p 1) (q)))))

;;; Fact groups

(test a-group-defined-again-replaces-its-facts
  (prolog:def-fact-group tests-first (tests-ordered)
    (prolog:<- (tests-ordered 1)) (prolog:<- (tests-ordered 2)) (prolog:<- (tests-dropped)))
  (prolog:def-fact-group tests-second (tests-ordered)
    (prolog:<- (tests-ordered 3)))
  (yields '(tests-ordered ?x) '?x 1 2 3)
  (holds '(tests-dropped))
  (prolog:def-fact-group tests-first (tests-ordered)
    (prolog:<- (tests-ordered 5)))
  (yields '(tests-ordered ?x) '?x 5 3)
  (warns-with (prolog:unknown-predicate "tests-dropped") (fails '(tests-dropped)))
  (prolog:def-fact-group tests-first (tests-ordered))
  (prolog:def-fact-group tests-second (tests-ordered))
  (is (null (warnings-of 'warning (lambda () (fails '(tests-ordered ?x)))))))

(test a-proof-does-not-see-what-is-defined-meanwhile
  (prolog:def-fact-group tests-changing ()
    (prolog:<- (changing ?x) (changed ?x))
    (prolog:<- (changed 1)) (prolog:<- (changed 2)) (prolog:<- (changed 3)))
  (let ((solutions (prolog:prolog '(changing ?x))))
    (prolog:def-fact-group tests-changing ()
      (prolog:<- (changing ?x) (changed ?x))
      (prolog:<- (changed 10)))
    (is (equal '(1 2 3) (mapcar (lambda (solution) (prolog:var-value '?x solution))
                                (prolog:force-ll solutions))))
    (yields '(changing ?x) '?x 10)))

(test predicates-that-are-not-extendable
  (prolog:def-fact-group tests-closed () (prolog:<- (closed 1)))
  (is (null (warnings-of 'warning (lambda ()
                                    (prolog:def-fact-group tests-closed ()
                                      (prolog:<- (closed 2)))))))
  (warns-with (prolog:predicate-not-extendable "tests-other" "closed" "tests-closed")
    (prolog:def-fact-group tests-other () (prolog:<- (closed 3))))
  (yields '(closed ?x) '?x 2 3)
  (warns-with (prolog:predicate-not-extendable "tests-other" "once" "built in")
    (prolog:def-fact-group tests-other () (prolog:<- (prolog:once 3))))
  (prolog:def-fact-group tests-closed ())
  (prolog:def-fact-group tests-other ()))

(test many-facts-of-one-predicate
  (prolog::define-fact-group
   'tests-many '()
   (append (loop for i below 1000 collect `((numbered ,i ,(* i i))))
           '(((numbered ?x any)))
           (loop for i below 1000 collect `((numbered ,(format nil "~d" i) string)))
           '(((numbered (f ?x) list)) ((numbered 5 again)))))
  (yields '(numbered 5 ?x) '?x 25 'any 'again)
  (yields '(numbered 5d0 ?x) '?x 25 'any 'again)
  (yields '(numbered "5" ?x) '?x 'any 'string)
  (yields '(numbered (f 1) ?x) '?x 'any 'list)
  (yields '(numbered none ?x) '?x 'any)
  (yields '(and (prolog:lisp-fun identity 7 ?n) (numbered ?n ?x)) '?x 49 'any)
  (is (= 2003 (length (answers '?x '(numbered ?n ?x)))))
  (prolog:def-fact-group tests-many ()))

(test objects-unify-in-facts
  (let ((a (make-instance 'twin :name :a)) (b (make-instance 'twin :name :b)))
    (prolog::define-fact-group
     'tests-twins '() (append (loop for i below 20 collect `((twin ,i)))
                              `(((twin ,(make-instance 'twin :name :a))))))
    (holds `(twin ,a))
    (fails `(twin ,b))
    (prolog:def-fact-group tests-twins ())))

;;; Handlers

(prolog:def-prolog-handler tests-twice (bindings number result)
  "The result is twice the number, or the number half of the result."
  (cond ((not (prolog:is-var number))
         (multiple-value-bind (more matched) (prolog:unify result (* 2 number) bindings)
           (and matched (list more))))
        ((not (prolog:is-var result))
         (list (prolog:add-bds number (/ result 2) bindings)))))

(prolog:def-prolog-handler tests-between (bindings low high value)
  (prolog:lazy-list ((n low))
    (if (> n high)
        (prolog:fin)
        (prolog:cont (prolog:add-bds value (note n) bindings) (1+ n)))))

(prolog:def-prolog-handler tests-subquery (bindings goal)
  (prolog:prolog goal bindings))

(prolog:def-prolog-handler tests-pair (bindings term)
  (list (prolog:add-bds term '(pair ?left ?right) bindings)))

(test handlers
  (yields '(tests-twice 4 ?x) '?x 8)
  (yields '(tests-twice ?x 4) '?x 2)
  (holds '(tests-twice 2 4))
  (fails '(tests-twice 2 5))
  (fails '(tests-twice ?x ?y))
  (yields '(and (tests-twice 1 ?x) (tests-twice ?x ?y)) '(?x ?y) '(2 4))
  (yields '(tests-subquery (parent bob ?x)) '?x 'ann 'pat)
  (yields '(and (tests-pair ?p) (prolog:== ?p (pair 1 ?b)) (prolog:== ?b 2)) '?p '(pair 1 2))
  (setf *side-effects* '())
  (let ((solutions (prolog:prolog '(tests-between 1 1000000000 ?x))))
    (is (= 1 (prolog:var-value '?x (first solutions))))
    (is (= 3 (prolog:var-value '?x (prolog:lazy-elt solutions 2))))
    (is (equal '(3 2 1) *side-effects*)))
  (yields '(and (tests-between 1 5 ?x) (tests-between ?x 2 ?y)) '(?x ?y) '(1 1) '(1 2) '(2 2))
  (signals-with (prolog:malformed-goal "tests-twice" "2 arguments")
    (prolog:prolog '(tests-twice 1))))

(test other-names-of-predicates
  (prolog:alias-predicate 'tests-negation 'not)
  (holds '(tests-negation (one 9)))
  (fails '(tests-negation (one 1)))
  (signals error (prolog:alias-predicate 'tests-negation 'parent)))
