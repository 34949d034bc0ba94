;;;; Explanations of claims of every form, of contradictions, and from every kind of asker.

(in-package #:discrepancy-finder.tests)

(def-suite why-questions :in all)
(in-suite why-questions)

;;; Claims of every form

(test compound-claims
  (let ((clauses (box '(picked (pick-up) 0))))
    (says (explains clauses (and (holds-at (holding-box) 2) (holds-at (dusty) 2))
            picked pick-up-holds dust)
          "(holding-box) is true at" "(dusty) is true at")
    (explains clauses (or (holds-at (holding-box) 2) (holds-at (robot-in r2) 1))
      picked pick-up-holds)
    (explains clauses (exists (?time) (and (holds-at (holding-box) ?time) (holds-at (dusty) ?time)))
      picked pick-up-holds dust)
    (explains clauses (forall (?time) (implies (> ?time 0) (holds-at (holding-box) ?time)))
      picked pick-up-holds)
    ;; Tautologies rest on nothing.
    (explains clauses (or (holds-at (dusty) 1) (not (holds-at (dusty) 1))))
    (explains clauses (and))))

(test case-distinctions
  "Whether the box is in the left or in the right hand, it is in a hand."
  (let ((explanation
          (explains '((:sorts (hand left right)) (:non-inertial-fluents (in hand) (held))
                      (:axioms (one-of-them (exists (?hand) (holds-at (in ?hand) ?time)))
                               (by-left (implies (holds-at (in left) ?time)
                                                 (holds-at (held) ?time)))
                               (by-right (implies (holds-at (in right) ?time)
                                                  (holds-at (held) ?time))))
                      (:time 0 1))
              (holds-at (held) 1)
            one-of-them by-left by-right)))
    (is-true (search "(held) is true at 1"
                     (with-output-to-string (stream) (describe explanation stream))))))

(test what-does-not-hold-is-not-explained
  (let ((theory (ec::parse-theory 'inline *box*)))
    (is (null (ec:why theory '(happens (pick-up) 0))))
    (is (null (ec:why theory '(not (happens (pick-up) 0)))))
    (is (null (ec:why-impossible theory '(holds-at (holding-box) 3))))
    (is (null (ec:why theory '(holds-at (holding-box) 0))))
    (is (null (ec:why-inconsistent theory)))))

(test why-impossible
  (let* ((theory (ec::parse-theory 'inline (box '(picked (pick-up) 0))))
         (explanation (ec:why-impossible theory '(not (holds-at (holding-box) 2)))))
    (is (equal '(:picked :pick-up-holds) (ec:explanation-axioms explanation)))
    (says explanation "(holding-box) is true at 2 because (pick-up) initiates")
    (is (search "impossible" (prin1-to-string explanation)))
    (is (equal (ec:explanation-sentences explanation)
               (ec:explanation-sentences (ec:why theory '(holds-at (holding-box) 2)))))
    (let ((explanation (ec:why-impossible theory '(and (holds-at (dusty) 1)
                                                   (happens (sweep) 0)))))
      (is (null (ec:explanation-axioms explanation))
          "no axiom is blamed where completion alone does")
      (says explanation "(sweep) happens at 0" "contradicts" "axiom makes it"))))

(test why-inconsistent
  (let ((effects '((:fluents (f)) (:events (e)) (:narrative (happening (happens (e) 0)))
                   (:time 0 1))))
    (flet ((with (&rest axioms) (append effects (list (cons :axioms axioms)))))
      (let ((explanation (explains (with '(on (initiates (e) (f) ?time))
                                     '(off (terminates (e) (f) ?time)))
                             nil
                           happening on off)))
        (says explanation "axiom on" "axiom off" "contradicts")
        (does-not-say explanation "nothing terminates"))
      (says (explains (with '(on (initiates (e) (f) ?time)) '(free (releases (e) (f) ?time))) nil
              happening on free)
            "axiom on" "axiom free" "contradicts")
      (says (explains (with '(off (terminates (e) (f) ?time)) '(free (releases (e) (f) ?time))) nil
              happening off free)
            "axiom off" "axiom free" "contradicts")))
  (says (explains '((:fluents (f) (g)) (:events (e))
                    (:axioms (on (initiates (e) (f) ?time))
                             (same (iff (holds-at (f) ?time) (holds-at (g) ?time))))
                    (:facts (off (not (holds-at (f) 0)))) (:narrative (happening (happens (e) 0)))
                    (:time 0 1))
            nil
          off happening on same)
        "contradicts inertia" "(g) persists from 0 to 1")
  (explains '((:predicates (p)) (:axioms (yes (p)) (no (not (p)))) (:time 0 0)) nil yes no)
  (explains '((:predicates (p)) (:axioms (never (or))) (:time 0 0)) nil never))

;;; Questions of every kind of asker

(test explanations-from-reasoners
  (ec:with-reasoner (reasoner (ec::parse-theory 'inline (box '(picked (pick-up) 0))) :horizon 2)
    (is (equal '(:picked :pick-up-holds)
               (ec:explanation-axioms (ec:why reasoner '(holds-at (holding-box) 2)))))
    (signals-with (ec:event-calculus-error "5" "0 to 2") (ec:why reasoner '(holds-at (dusty) 5)))
    (is-true (ec:why reasoner '(holds-at (dusty) 5) :horizon 6))))

(test malformed-questions
  (let ((theory (ec::parse-theory 'inline *box*)))
    (signals-with (ec:theory-error "the question" "(holding-box)")
      (ec:why theory '(holding-box)))
    (signals-with (ec:theory-error "the question" "no element")
      (ec:why theory '(happens (move r9) 0)))
    (signals-with (ec:theory-error "the question" "?region" "unbound")
      (ec:why-impossible theory '(happens (move ?region) 0)))
    (signals-with (ec:theory-error "the question" "initiates")
      (ec:why theory '(initiates (sweep) (dusty) 0)))
    (signals-with (ec:event-calculus-error "9") (ec:why theory '(holds-at (dusty) 9)))
    (signals-with (ec:event-calculus-error "6" "last timepoint")
      (ec:why theory '(happens (sweep) 6)))
    (signals-with (ec:theory-not-found "nowhere") (ec:why 'nowhere '(holds-at (dusty) 9)))))

(test explanations-in-print
  (let* ((explanation (explanation-of (box '(picked (pick-up) 2)) '(holds-at (holding-box) 3)))
         (text (with-output-to-string (stream) (describe explanation stream))))
    (is (search "(holding-box) is true at 3" (prin1-to-string explanation)))
    (is (null (find #\Newline (prin1-to-string explanation))))
    (dolist (part (append (ec:explanation-sentences explanation)
                          '("(holding-box) is true at 3" "picked" "pick-up-holds")))
      (is (search part text) "~s is not in~%~a" part text))))

(test unnamed-axioms-are-told-by-file-and-line
  (with-file (file "(define-theory lamp (:fluents (lit)) (:events (switch)) (:time 0 1)
  (:axioms
   (initiates (switch) (lit) ?time)
   (happens (switch) 0)))")
    (says (ec:why (ec:load-theory file) '(holds-at (lit) 1))
          (format nil "~a:3" file) (format nil "~a:4" file))))

(test axioms-named-like-schemas
  "What an author calls inertia is an axiom all the same."
  (explains '((:fluents (f) (g)) (:events (e))
              (:axioms (inertia (initiates (e) (f) ?time))
                       (assumption (implies (holds-at (f) ?time) (holds-at (g) (+ ?time 1)))))
              (:narrative (completion (happens (e) 0)))
              (:completion happens) (:time 0 3))
      (holds-at (g) 3)
    inertia assumption completion)
  (explains '((:predicates (p)) (:axioms (assumption (p))) (:time 0 0)) (p) assumption))
