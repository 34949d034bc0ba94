(in-package #:discrepancy-finder.tests)

(def-suite event-calculus :in all)
(in-suite event-calculus)

(defparameter *theory-text* "
(define-theory lamp
  (:sorts (lamp a b) (switch s))
  (:fluents (lit lamp) (broken lamp) (dark))
  (:events (toggle lamp) (smash lamp) (press switch lamp))
  (:axioms
   (starts-dark (initially (forall (?lamp) (not (lit ?lamp)))))
   (toggle-on (implies (and (not (holds-at (lit ?lamp) ?time))
                            (not (holds-at (broken ?lamp) ?time)))
                       (initiates (toggle ?lamp) (lit ?lamp) ?time)))
   (toggle-off (implies (holds-at (lit ?lamp) ?time)
                        (terminates (toggle ?lamp) (lit ?lamp) ?time)))
   (initiates (smash ?lamp) (broken ?lamp) ?time)
   (terminates (smash ?lamp) (lit ?lamp) ?time)
   (no-smashing-twice (implies (happens (smash ?lamp) ?time)
                               (not (holds-at (broken ?lamp) ?time))))
   (not-both (not (and (holds-at (lit a) ?time) (holds-at (lit b) ?time))))))
(define-state-constraint lamp-lit (?time)
  (and (happens (toggle a) ?time) (holds-at (lit a) (+ ?time 1))))
")

(defun lamp-ground ()
  (with-file (file *theory-text*) (ec:ground (ec:load-theory file))))

(defun lamp-state (ground &rest true)
  (ec:concrete-state ground (lambda (atom) (and (member atom true :test #'equal) t))))

(defun after (ground state event)
  "Return the fluents true after EVENT in STATE, and true if the theory allows it."
  (multiple-value-bind (next conditions)
      (ec:progress state (and event (ec:find-event ground event)))
    (values (ec:state-fluents next) (every #'cdr conditions))))

(test progression
  (let* ((ground (lamp-ground))
         (dark (lamp-state ground)))
    (is (equal '((:lit :a)) (after ground dark '(:toggle :a))))
    (is (equal '() (after ground (lamp-state ground '(:lit :a)) '(:toggle :a))))
    (is (equal '((:broken :a)) (after ground (lamp-state ground '(:lit :a)) '(:smash :a))))
    (is (equal '((:broken :a)) (after ground (lamp-state ground '(:broken :a)) '(:toggle :a)))
        "a conditional effect whose condition is false has no effect")
    (is (equal '((:lit :b)) (after ground (lamp-state ground '(:lit :b)) nil))
        "without an event everything persists")
    (is (equal '((:lit :b) (:dark)) (after ground (lamp-state ground '(:lit :b) '(:dark))
                                           '(:press :s :a)))
        "an event without effects leaves everything as it is")))

(test what-a-theory-forbids
  (let ((ground (lamp-ground)))
    (flet ((allowed (state event) (nth-value 1 (after ground state event))))
      (is-true (allowed (lamp-state ground) '(:toggle :a)))
      (is-false (allowed (lamp-state ground '(:lit :b)) '(:toggle :a)) "a state sentence")
      (is-false (allowed (lamp-state ground '(:broken :a)) '(:smash :a)) "a precondition")
      (is-true (every #'cdr (ec:initial-conditions (lamp-state ground))))
      (is-false (every #'cdr (ec:initial-conditions (lamp-state ground '(:lit :a))))))))

(test opposite-effects-are-inconsistent
  "DEC9 and DEC10: what initiates and terminates the same fluent at once cannot happen."
  (let* ((ground (ec:ground (ec::parse-theory 'clash
                                              '((:fluents (f)) (:events (e))
                                                (:axioms (initiates (e) (f) ?time)
                                                         (terminates (e) (f) ?time))))))
         (state (ec:concrete-state ground (constantly t))))
    (is-false (nth-value 1 (after ground state '(:e))))))

(test progression-of-unknown-states-by-z3
  "Each fluent of the successor is the proposition that Z3 agrees with on all initial states."
  (let ((ground (lamp-ground)))
    (z3:with-context (context)
      (z3:with-solver (solver context)
        (let* ((state (ec:symbolic-state ground context))
               (event (ec:find-event ground '(:toggle :a)))
               (next (ec:progress state event)))
          (dotimes (bits (expt 2 (length (ec:ground-theory-fluents ground))))
            (let* ((truths (loop for index below (length (ec:ground-theory-fluents ground))
                                 collect (logbitp index bits)))
                   (concrete (let ((rest truths))
                               (ec:concrete-state ground (lambda (atom)
                                                           (declare (ignore atom)) (pop rest)))))
                   (expected (ec:state-values (ec:progress concrete event))))
              (z3:push-scope solver)
              (loop for variable across (ec:state-values state) for truth in truths
                    do (z3:solver-assert solver (if truth variable (z3:negation variable))))
              (is (eq :sat (z3:check solver)))
              (let ((different (loop for proposition across (ec:state-values next)
                                     for truth across expected
                                     collect (if truth (z3:negation proposition) proposition))))
                (is (eq :unsat (z3:check solver (list (z3:disjunction different))))))
              (z3:pop-scope solver))))))))

(test odd-names-stay-apart
  "Atoms are structured keys: (p |a b|) is not (p a b), and |Foo| is not foo."
  (is (string/= (ec:atom-text '(:p :|a b|)) (ec:atom-text '(:p :a :b))))
  (is (string/= (ec:atom-text '(:p :|Foo|)) (ec:atom-text '(:p :foo))))
  (is (string= "(p |a)(b|)" (ec:atom-text '(:p :|a)(b|))))
  (is (equal '(:p :|schön|)
             (ec:text-atom (ec:atom-text '(:p :|schön|)) '((:p :schön) (:p :|schön|))))))

(test theories-can-be-used-from-any-package
  (let ((ground (lamp-ground)))
    (is (eql (ec:find-fluent ground '(lit a)) (ec:find-fluent ground '(:lit :a))))
    (signals-with (ec:unknown-atom "(lit c)" "fluent" "lamp") (ec:find-fluent ground '(lit c)))
    (signals-with (ec:unknown-atom "(lit a)" "event" "lamp") (ec:find-event ground '(lit a)))))

(defmacro theory-problem-of (axiom &rest parts)
  "Check the report for the theory of the lamp with AXIOM, named bad, as its only one."
  `(signals-with (ec:theory-error "theory lamp, axiom bad" ,@parts)
     (ec::parse-theory 'lamp '((:sorts (lamp a b) (other o)) (:fluents (lit lamp) (dark))
                               (:events (toggle lamp) (press other lamp))
                               (:axioms (bad ,axiom))))))

(test malformed-axioms-are-named
  (theory-problem-of (initiates (toggle ?lamp) (lit ?lamb) ?time) "(lit ?lamb)" "?lamb" "lamb")
  (theory-problem-of (initiates (toggle ?lamp) (lit ?other) ?time) "sort other" "sort lamp")
  (theory-problem-of (initiates (toggle ?lamp) (lit) ?time) "lit takes 1 argument, not 0")
  (theory-problem-of (initiates (toggle ?lamp) (lit ?lamp ?lamp) ?time) "1 argument, not 2")
  (theory-problem-of (initiates (toggel ?lamp) (lit ?lamp) ?time) "no event toggel")
  (theory-problem-of (initiates (toggle ?lamp) (lid ?lamp) ?time) "no fluent lid")
  (theory-problem-of (initiates (toggle c) (lit a) ?time) "c is no element of sort lamp")
  (theory-problem-of (initiates (toggle a) (lit a)) "initiates takes 3 arguments, not 2")
  (theory-problem-of (holds-at (lit a) b) "b is no element of sort time")
  (theory-problem-of (holds-at (lit ?time) ?time) "time")
  (theory-problem-of (holds-on (lit a) ?time) "holds-on is no operator")
  (theory-problem-of (implies (dark) (holds-at (dark) ?time)) "dark is no operator")
  (theory-problem-of (or (holds-at (dark) ?time) (initiates (toggle a) (lit a) ?time))
                     "only as the head")
  (theory-problem-of (forall ?lamp (holds-at (lit ?lamp) ?time)) "list of variables")
  (theory-problem-of (implies (holds-at (dark) ?time) (happens (dark) ?time)) "no event dark")
  (theory-problem-of (not 5) "5")
  (theory-problem-of (holds-at (lit . a) ?time) "dotted"))

(test malformed-theories-are-named
  (flet ((parse (&rest clauses) (ec::parse-theory 'lamp clauses)))
    (signals-with (ec:theory-error ":fluents" "no sort lamp") (parse '(:fluents (lit lamp))))
    (signals-with (ec:theory-error "twice") (parse '(:sorts (s a) (s b))))
    (signals-with (ec:theory-error "axiom same" "same name")
      (parse '(:fluents (f)) '(:axioms (same (holds-at (f) ?time))
                                      (same (not (holds-at (f) ?time))))))
    (signals-with (ec:theory-error "axiom 1" "(bad . worse)")
      (parse '(:fluents (f)) '(:axioms (bad . worse))))
    (signals-with (ec:theory-error "(s a b a)" "stands twice") (parse '(:sorts (s a b a))))
    (signals-with (ec:theory-error "digit") (parse '(:sorts (s1 a))))
    (signals-with (ec:theory-error "cannot be a name") (parse '(:sorts (s nil))))
    (signals-with (ec:theory-error "word of the language") (parse '(:fluents (and))))
    (signals-with (ec:theory-error "(name ...)") (parse '(:sorts (s a . b))))
    (signals-with (ec:theory-error ":sorts") (parse '(:sorts (s a) . 3)))
    (signals-with (ec:theory-error "flunts was found" ":sorts") (parse '(:flunts (lit))))
    (signals-with (ec:theory-error "axiom 2" "no fluent")
      (parse '(:fluents (f)) '(:axioms (holds-at (f) ?time) (holds-at (g) ?time))))))

(test theory-files
  (with-file (file (format nil "(define-theory t~%  (:fluents (f))~%  (:axioms~%   (bad (holds-at ~
                                (g) ?time))))"))
    (signals-with (ec:theory-error ":4: " "axiom bad" "no fluent g") (ec:load-theory file)))
  (with-file (file "(define-theory t (:sorts (s #.(error \"evaluated\"))))")
    (signals-with (source:source-error ":1: " "#.") (ec:load-theory file)))
  (with-file (file "(defun f () 1)")
    (signals-with (source:source-error ":1: " "define-theory") (ec:load-theory file)))
  (with-file (file "")
    (signals-with (source:source-error "no define-theory") (ec:load-theory file)))
  (with-file (file *theory-text*)
    (let ((theory (ec:load-theory file)))
      (is (search "THEORY lamp: 2 sorts, 3 fluents, 3 events, 7 axioms>"
                  (prin1-to-string theory)))
      (is (eq theory (ec:find-theory 'lamp)))
      (is (= 1 (ec:state-constraint-span (ec:find-state-constraint nil theory))))
      (signals-with (ec:state-constraint-not-found
                     "Theory lamp has no state constraint named lamp-out: lamp-lit.")
        (ec:find-state-constraint 'lamp-out theory))
      (ec:define-state-constraint second (lamp) (?time) (holds-at (dark) ?time))
      (signals-with (ec:state-constraint-not-found
                     "Theory lamp has several state constraints, so name one: lamp-lit, second.")
        (ec:find-state-constraint nil theory))))
  (signals-with (ec:theory-not-found "no-such-theory") (ec:find-theory 'no-such-theory)))

(test state-constraints
  (let ((theory (with-file (file *theory-text*) (ec:load-theory file))))
    (flet ((parse (&rest definition) (ec::parse-state-constraint theory definition)))
      (signals-with (ec:theory-error "state constraint c" "?lamp is unbound")
        (parse 'c '(?time) '(holds-at (lit ?lamp) ?time)))
      (signals-with (ec:theory-error "state constraint c" "(+ ?time n)")
        (parse 'c '(?time) '(holds-at (lit a) (- ?time 1))))
      (is (= 3 (ec:state-constraint-span
                (parse 'c '(?time)
                       '(or (happens (toggle a) (+ ?time 2)) (holds-at (dark) ?time))))))
      (is (= 0 (ec:state-constraint-span (parse 'c '(?time) '(holds-at (dark) ?time))))))))
