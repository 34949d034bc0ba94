;;;; Theories as wholes: those that extend others, their names, the readers of their parts.

(in-package #:discrepancy-finder.tests)

(def-suite whole-theories :in all)
(in-suite whole-theories)

(defun register (name &rest clauses)
  "Register the theory NAME with CLAUSES, and return it."
  (ec:register-theory (ec::parse-theory name clauses)))

(test theories-extend-others
  (register 'room-of-lamps
            '(:sorts (lamp a b))
            '(:predicates (ab lamp))
            '(:functions ((watts lamp) integer))
            '(:fluents (lit lamp))
            '(:non-inertial-fluents (bright))
            '(:numeric-fluents (charge))
            '(:events (switch lamp))
            '(:axioms
              (switching (implies (not (ab ?lamp)) (initiates (switch ?lamp) (lit ?lamp) ?time)))
              (broken :label theta (implies (> (watts ?lamp) 100) (ab ?lamp))))
            '(:facts (initially (not (lit ?lamp))) (= (watts a) 40) (= (watts b) 200)
              (= (value-at (charge) 0) 1))
            '(:completion (theta ab) happens)
            '(:mutex (switch))
            '(:time 0 2) '(:offset 1 1))
  (let ((theory (register 'bigger-room
                          '(:extends room-of-lamps)
                          '(:sorts (big-lamp (:parent lamp) c))
                          '(:fluents (dusty lamp))
                          '(:axioms
                            (brightness (iff (holds-at (bright) ?time)
                                             (exists (?lamp) (holds-at (lit ?lamp) ?time)))))
                          '(:facts (= (watts c) 60))
                          '(:narrative (happens (switch a) 0) (happens (switch b) 1)
                            (happens (switch c) 2))
                          '(:time 0 3))))
    (is (equal '(:a :b :c) (ec:sort-elements theory 'lamp)))
    (is (equal '(0 . 3) (ec:theory-time-range theory)))
    (is (equal '(1 . 1) (ec:theory-offset-range theory)))
    (is (equal '((:theta :ab) (nil :happens)) (ec:theory-completions theory)))
    (is (equal '((:mutex :switch)) (ec:theory-exclusions theory)))
    (is (equal '(:bright) (ec:theory-non-inertial theory)))
    (is (equal '(:switching :broken) (mapcar #'ec:axiom-name
                                             (subseq (ec:theory-axioms theory) 0 2)))
        "what is inherited comes first")
    (always theory
      (holds-at (lit a) 1) (not (holds-at (lit b) 3)) (holds-at (lit c) 3) (holds-at (bright) 1)
      (not (holds-at (bright) 0)) (= (value-at (charge) 3) 1))
    ;; The theory itself is as it was.
    (is (equal '(:a :b) (ec:sort-elements (ec:find-theory 'room-of-lamps) 'lamp)))))

(test theories-extend-several-that-extend-one
  (register 'base '(:sorts (s x)) '(:fluents (f s)) '(:axioms (ground-rule (holds-at (f x) 0))))
  (register 'left '(:extends base) '(:events (e s))
            '(:axioms (left-rule (terminates (e x) (f x) ?time))))
  (register 'right '(:extends base) '(:predicates (p)) '(:axioms (right-rule (p))))
  (let ((theory (register 'both '(:extends left) '(:extends right) '(:time 0 1)
                          '(:narrative (happens (e x) 0)))))
    (is (= 1 (length (ec:theory-sorts theory))))
    (is (equal '(:ground-rule :left-rule :right-rule)
               (subseq (mapcar #'ec:axiom-name (ec:theory-axioms theory)) 0 3)))
    (always theory (not (holds-at (f x) 1)) (p))))

;;; Leaving out what is extended

(test what-is-left-out-can-be-declared-anew
  (register 'lamps '(:sorts (lamp a b)) '(:fluents (lit lamp) (old)) '(:events (switch lamp))
            '(:axioms (switching (initiates (switch ?lamp) (lit ?lamp) ?time))
              (all-off (initially (not (lit ?lamp)))) (b-on (initially (lit b)))
              (aging (initially (old)))))
  (let ((theory (register 'one-lamp '(:extends lamps) '(:without lamp b-on all-off old aging)
                          '(:sorts (lamp a)) '(:axioms (all-off (initially (lit ?lamp))))
                          '(:time 0 0))))
    (is (equal '(:a) (ec:sort-elements theory 'lamp)))
    (is (equal '((:lit :lamp)) (ec:theory-fluents theory)))
    (is (equal '(:switching :all-off) (mapcar #'ec:axiom-name (ec:theory-axioms theory))))
    (always theory (holds-at (lit a) 0))))

(test only-what-is-there-can-be-left-out
  (register 'lamps '(:sorts (lamp a)))
  (signals-with (ec:theory-error "dark" ":without" "lump")
    (register 'dark '(:extends lamps) '(:without lump)))
  (signals-with (ec:theory-error "dark" ":without" "lamp")
    (register 'dark '(:without lamp))))

(test theories-extend-files-and-inherit-state-constraints
  (with-file (file "(define-theory base (:sorts (lamp a b)) (:fluents (lit lamp)))
(define-state-constraint some-light (?time) (exists (?lamp) (holds-at (lit ?lamp) ?time)))")
    (let ((theory (register 'heir (list :extends (namestring file)) '(:without lamp)
                            '(:sorts (lamp c)))))
      (is (equal (list (namestring file)) (ec:theory-files theory)))
      (let ((constraint (ec:find-state-constraint 'some-light theory)))
        (is (eq theory (ec:state-constraint-theory constraint)))
        (is (eq :some-light (ec:state-constraint-name constraint))))))
  (signals-with (ec:theory-error "heir" "there is no file \"no-such-file.lisp\"")
    (register 'heir '(:extends "no-such-file.lisp"))))

(test manual-release-and-non-inertia-are-inherited
  (register 'released '(:fluents (f) (g)) '(:manual-release f))
  (register 'all-released '(:fluents (h)) '(:manual-release t))
  (is (equal '(:f) (ec:theory-manual-release (register 'heir '(:extends released)))))
  (is (equal '(:f :g) (ec:theory-manual-release (register 'heir '(:extends released)
                                                          '(:manual-release g)))))
  (is (eq t (ec:theory-manual-release (register 'heir '(:extends released all-released))))))

(test tables-are-inherited-whole
  (register 'map '(:sorts (place a b)) '(:predicates ((near place place) (a b))))
  (always (register 'bigger-map '(:extends map) '(:sorts (hill (:parent place) c)) '(:time 0 0))
    (near a b) (not (near b a)) (not (near c a)))
  (signals-with (ec:theory-error "other-map" "near")
    (register 'other-map '(:extends map) '(:predicates ((near place place) (b a))))))

(test causal-constraints-are-built-in
  (always (inline-theory (:extends causal-constraints)
                         (:fluents (open) (lit))
                         (:events (push) (flash))
                         (:axioms (initiates (push) (open) ?time)
                                  (trigger :label delta (implies (initiated (open) ?time)
                                                                 (happens (flash) ?time)))
                                  (initiates (flash) (lit) ?time))
                         (:facts (not (holds-at (open) 0)) (not (holds-at (lit) 0)))
                         (:narrative (pushed :label delta (happens (push) 1)))
                         (:completion (delta happens))
                         (:time 0 2))
    (happens (flash) 1) (holds-at (lit) 2) (not (happens (flash) 0)) (started (open) 1)
    (not (stopped (lit) 2)) (terminated (lit) 0)))

(test unnamed-axioms-of-several-theories-stay-apart
  "Both theories have axioms that are named by their numbers."
  (register 'first-part '(:predicates (p) (q)) '(:axioms (p) (or (p) (q))))
  (let ((theory (register 'second-part '(:extends first-part) '(:axioms (not (q)) (iff (p) (p)))
                          '(:time 0 0))))
    (is (= 4 (length (remove-duplicates (mapcar #'ec:axiom-name (ec:theory-axioms theory))))))
    (always theory (p) (not (q)))))

(test clauses-in-any-order
  (flet ((models-of (&rest clauses)
           (mapcar #'ec:model-literals
                   (ec:models (ec::parse-theory 'inline clauses) :limit nil))))
    (is (equal (models-of '(:sorts (s a b)) '(:predicates (p s) (q)) '(:axioms (or (p a) (q)))
                          '(:completion p) '(:time 0 0))
               (models-of '(:time 0 0) '(:axioms (or (p a) (q))) '(:completion p)
                          '(:predicates (p s)) '(:predicates (q)) '(:sorts (s a)) '(:sorts)
                          '(:predicates) '(:axioms) '(:sorts (s2a (:parent s) b)))))))

;;; Names

(test names-are-compared-by-their-characters
  (let ((theory (ec::parse-theory '#:anywhere
                                  (list (list '#:sorts (list '#:lamp 'cl-user::a))
                                        '(:fluents (ec::lit df::lamp))
                                        (list :axioms (list 'initially (list '#:lit :a)))
                                        '(:time 0 0)))))
    (is (eq :anywhere (ec:theory-name theory)))
    (always theory (cl-user::holds-at (:lit a) 0))))

(test odd-names
  (let ((theory (inline-theory (:sorts (|Größe b| || |x y| |)| |a"b| t list))
                               (:fluents (|The light, (on)?| |Größe b|) (if))
                               (:events (quote))
                               (:axioms (|1st | (holds-at (|The light, (on)?| |x y|) 0))
                                        (holds-at (|The light, (on)?| ||) 0)
                                        (holds-at (|The light, (on)?| t) 0)
                                        (initiates (quote) (if) ?time)
                                        (implies (holds-at (|The light, (on)?| |?Größe b|) 0)
                                                 (or (= |?Größe b| |x y|) (= |?Größe b| ||)
                                                     (= |?Größe b| t))))
                               (:narrative (happens (quote) 0))
                               (:time 0 1))))
    (always theory
      (not (holds-at (|The light, (on)?| |)|) 0)) (holds-at (|The light, (on)?| ||) 1)
      (not (holds-at (|The light, (on)?| list) 0)))))

(test a-theory-may-have-any-name-but-nil
  (dolist (name '(t time ?time || |A theory with \| and "quotes"|))
    (let ((theory (register name '(:fluents (f)))))
      (is (eq theory (ec:find-theory name)))
      (is (search (ec:name-text name) (prin1-to-string theory)))))
  (signals-with (ec:theory-error "()" "name") (register nil '(:fluents (f)))))

(test the-fluents-can-be-called-like-sorts-and-elements
  (always (inline-theory (:sorts (door door) (place hall))
                         (:fluents (door) (place door) (hall place))
                         (:axioms (holds-at (door) 0) (holds-at (place door) 0)
                                  (not (holds-at (hall hall) 0)))
                         (:time 0 0))
    (holds-at (door) 0) (exists (?door) (holds-at (place ?door) 0))
    (forall (?place) (not (holds-at (hall ?place) 0)))))

;;; Definitions at the REPL

(ec:define-theory defined-by-the-macro
  "A lamp."
  (:sorts (lamp a))
  (:fluents (lit lamp))
  (:events (switch lamp))
  (:axioms (on (initiates (switch ?lamp) (lit ?lamp) ?time))))

(test define-theory-defines
  (let ((theory (ec:find-theory 'defined-by-the-macro)))
    (is (string= "A lamp." (ec:theory-documentation theory)))
    (is (eq :lisp (ec:theory-syntax theory)))
    (is (null (ec:theory-file theory)))
    (is (equal '((:lit :lamp)) (ec:theory-fluents theory)))
    (is (equal '((:switch :lamp)) (ec:theory-events theory)))
    (is (equal '(:initiates (:switch :?lamp) (:lit :?lamp) :?time)
               (ec:axiom-formula (first (ec:theory-axioms theory)))))
    (is (eq theory (ec:find-theory :defined-by-the-macro)))
    (is (eq theory (ec:find-theory '#:defined-by-the-macro)))
    (is (search "defined-by-the-macro: 1 sort, 1 fluent, 1 event, 1 axiom>"
                (prin1-to-string theory)))))

(test a-definition-replaces-the-one-before
  (let ((old (register 'redefined '(:fluents (f))))
        (new (register 'redefined '(:fluents (g)))))
    (is (eq new (ec:find-theory 'redefined)))
    (is (equal '((:f)) (ec:theory-fluents old)))
    ;; One that fails changes nothing.
    (signals ec:theory-error (register 'redefined '(:fluents (h nothing))))
    (is (eq new (ec:find-theory 'redefined)))))

(defparameter *theory-of-a-lamp*
  "(define-theory same-either-way
  \"A lamp.\" (:sorts (lamp a b)) (:fluents (lit lamp)) (:events (switch lamp))
  (:axioms (on (initiates (switch ?lamp) (lit ?lamp) ?time)) (happens (switch b) 1))
  (:completion happens) (:time 0 3))")

(test macros-and-files-are-the-same
  (flet ((parts (theory)
           (list (ec:theory-name theory) (ec:theory-documentation theory)
                 (ec:theory-fluents theory) (mapcar #'ec:axiom-formula (ec:theory-axioms theory))
                 (ec:theory-completions theory) (ec:theory-time-range theory))))
    (let ((evaluated (let ((*package* (find-package '#:discrepancy-finder.event-calculus)))
                       (eval (read-from-string *theory-of-a-lamp*)))))
      (with-file (file *theory-of-a-lamp*)
        (let ((theory (ec:load-theory file)))
          (is (equal (parts evaluated) (parts theory)))
          (is (string= file (ec:theory-file theory)))
          (is (= 3 (source:source-position-line
                    (ec:axiom-position (first (ec:theory-axioms theory)))))))))))
