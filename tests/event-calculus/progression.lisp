;;;; Progression feature by feature: what follows from known events, in concrete states without Z3
;;;; where the theory determines everything, else as what Z3 finds possible.

(in-package #:discrepancy-finder.tests)

(def-suite progression-features :in all)
(in-suite progression-features)

(defun ground-clauses (&rest clauses)
  (ec:ground (ec::parse-theory 'p clauses)))

(defun progressed (ground true &rest groups)
  "Return the states of GROUND from the one in which just the fluents TRUE hold, along GROUPS, lists
of events, and true if the conditions are."
  (let* ((state (ec:concrete-state ground
                                   (lambda (atom) (and (member atom true :test #'equal) t))))
         (states (list state))
         (allowed (every #'cdr (ec:initial-conditions state))))
    (dolist (group groups (values (nreverse states) allowed))
      (multiple-value-bind (next conditions)
          (ec:progress (first states) (loop for event in group
                                            collect (ec:find-event ground event)))
        (setf allowed (and allowed (every #'cdr conditions)))
        (push next states)))))

(defun fluents-along (ground true &rest groups)
  "Return the true fluents at each timepoint of what PROGRESSED returns, or :FORBIDDEN."
  (multiple-value-bind (states allowed) (apply #'progressed ground true groups)
    (if allowed (mapcar #'ec:state-fluents states) :forbidden)))

(defun possible-finals (ground true &rest groups)
  "Return the lists of fluents that can be true in the end, from the state in which just TRUE hold."
  (z3:with-context (context)
    (z3:with-solver (solver context)
      (let* ((fluents (coerce (ec:ground-theory-fluents ground) 'list))
             (state (ec:concrete-state ground
                                       (lambda (atom) (and (member atom true :test #'equal) t))
                                       :context context)))
        (assume-all solver (ec:initial-conditions state))
        (dolist (group groups)
          (multiple-value-bind (next conditions)
              (ec:progress state (loop for event in group collect (ec:find-event ground event)))
            (assume-all solver conditions)
            (setf state next)))
        (loop for table in (allowed-tables solver (coerce (ec:state-values state) 'list) '())
              collect (loop for fluent in fluents
                            for bit downfrom (1- (length fluents))
                            when (logbitp bit table) collect fluent))))))

(defun as-atoms (lists)
  (loop for list in lists collect (loop for name in list collect (list name))))

;;; Events

(test triggered-events-happen
  (let ((ground (ground-clauses
                 '(:fluents (hot) (fan)) '(:events (heat) (switch-on))
                 '(:axioms (initiates (heat) (hot) ?time)
                   (initiates (switch-on) (fan) ?time)
                   (implies (and (holds-at (hot) ?time) (not (holds-at (fan) ?time)))
                            (happens (switch-on) ?time))))))
    (is (equal (as-atoms '(() (:hot) (:hot :fan) (:hot :fan)))
               (fluents-along ground '() '((heat)) '() '())))
    (is (equal '(((:switch-on) . t))
               (ec:state-happenings (third (progressed ground '() '((heat)) '())))))
    (z3:with-context (context)
      (z3:with-solver (solver context)
        (let* ((state (ec:symbolic-state ground context))
               (next (ec:progress state nil))
               (fan (ec:fluent-value next '(fan))))
          (is-true (z3:term-p fan) "what depends on the initial state is a guarded effect")
          (is (eq :unsat (z3:check solver (list (ec:fluent-value state '(hot)) (z3:negation fan)))))
          (is (eq :sat (z3:check solver (list (z3:negation fan)))))
          (is-true (ec:state-determined-p next)))))))

(test completion-by-label-makes-triggers
  "A sentence without the label only constrains."
  (flet ((after (label)
           (fluents-along
            (ground-clauses '(:fluents (f)) '(:events (e)) '(:completion (delta happens))
                            `(:axioms (initiates (e) (f) ?time)
                                      (always :label ,label (happens (e) ?time))))
            '() '())))
    (is (equal (as-atoms '(() (:f))) (after 'delta)))
    (is (eq :forbidden (after 'gamma)))))

(test one-of-several-triggered-events-happens
  "By completion (or (happens run) (happens drive)) means one of them."
  (let ((ground (ground-clauses
                 '(:fluents (tired) (moved)) '(:events (go) (run) (drive))
                 '(:axioms (initiates (run) (tired) ?time) (initiates (run) (moved) ?time)
                   (initiates (drive) (moved) ?time)
                   (implies (happens (go) ?time)
                            (or (happens (run) ?time) (happens (drive) ?time)))))))
    (is (equal (as-atoms '((:moved) (:tired :moved))) (possible-finals ground '() '((go)))))
    (is (equal (as-atoms '((:tired :moved))) (possible-finals ground '() '((go) (run)))))
    (is (equal (as-atoms '(())) (possible-finals ground '() '())) "without go neither happens")
    (signals-with (ec:undetermined "(run)" "Z3 context") (progressed ground '() '((go))))))

(test concurrent-events
  (let ((ground (ground-clauses
                 '(:fluents (raised) (spilled)) '(:events (lift-left) (lift-right) (wait))
                 '(:axioms
                   (implies (happens (lift-right) ?time) (initiates (lift-left) (raised) ?time))
                   (implies (not (happens (lift-right) ?time))
                            (initiates (lift-left) (spilled) ?time)))
                 '(:mutex (lift-left wait)) '(:xor (lift-right wait)))))
    (is (equal (as-atoms '(() (:raised)))
               (fluents-along ground '() '((lift-left) (lift-right)))))
    (is (eq :forbidden (fluents-along ground '() '((lift-left)))) "exactly one of right and wait")
    (is (eq :forbidden (fluents-along ground '() '((lift-left) (wait)))))
    (is (equal (as-atoms '(() ())) (fluents-along ground '() '((wait)))))))

(test at-most-one-event
  (let* ((one '(implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                (= ?event1 ?event2)))
         (ground (ground-clauses '(:fluents (f)) '(:events (a) (b)) `(:axioms (one ,one)))))
    (is (equal (as-atoms '(() ())) (fluents-along ground '() '((a)))))
    (is (eq :forbidden (fluents-along ground '() '((a) (b)))))))

(test narratives-and-facts-of-the-theory
  (let ((ground (ground-clauses
                 '(:fluents (loaded) (alive)) '(:events (load) (shoot))
                 '(:axioms (initiates (load) (loaded) ?time)
                   (implies (holds-at (loaded) ?time) (terminates (shoot) (alive) ?time)))
                 '(:narrative (happens (load) 1))
                 '(:facts (not (holds-at (loaded) 0)) (holds-at (alive) 2)))))
    (is (equal (as-atoms '((:alive) (:alive) (:loaded :alive) (:loaded)))
               (fluents-along ground '((:alive)) '((shoot)) '() '((shoot)))))
    (is (eq :forbidden (fluents-along ground '((:alive) (:loaded)))))
    (is (eq :forbidden (fluents-along ground '((:alive)) '((load)) '((shoot))))
        "the fact about 2 is judged at 2")))

;;; Release

(test released-fluents-are-open
  (let ((ground (ground-clauses
                 '(:fluents (heads) (in-hand)) '(:events (toss) (catch))
                 '(:axioms (releases (toss) (heads) ?time) (initiates (catch) (heads) ?time)))))
    (is (equal (as-atoms '(() (:heads))) (possible-finals ground '() '((toss)))))
    (is (equal (as-atoms '(() (:heads))) (possible-finals ground '() '((toss)) '() '()))
        "it stays released")
    (is (equal (as-atoms '((:heads))) (possible-finals ground '() '((toss)) '((catch)) '())))
    (is (equal '() (possible-finals ground '() '((toss) (catch)))) "release and effect conflict")
    (signals-with (ec:undetermined "Theory p" "whether (heads) holds at 1")
      (progressed ground '() '((toss))))
    (z3:with-context (context)
      (let ((state (ec:progress (ec:concrete-state ground (constantly nil) :context context)
                                (ec:find-event ground '(toss)))))
        (is (string= "(heads) at 1" (z3:term-name (ec:fluent-value state '(heads)))))
        (is-false (ec:state-determined-p state))
        (is-true (ec:state-exact-p state))))))

(test non-inertial-fluents-follow-the-constraints
  "What state constraints force on them is found without Z3."
  (let ((ground (ground-clauses
                 '(:fluents (hungry)) '(:non-inertial-fluents (happy) (sad)) '(:events (eat))
                 '(:axioms (terminates (eat) (hungry) ?time)
                   (iff (holds-at (happy) ?time) (not (holds-at (hungry) ?time)))
                   (or (holds-at (happy) ?time) (holds-at (sad) ?time))
                   (not (and (holds-at (happy) ?time) (holds-at (sad) ?time)))))))
    (is (equal (as-atoms '((:hungry :sad) (:happy) (:happy)))
               (fluents-along ground '((:hungry) (:sad)) '((eat)) '())))
    (is (eq :forbidden (fluents-along ground '((:hungry) (:happy)))))))

(test conflicts-are-forbidden
  (flet ((after (&rest axioms)
           (fluents-along (ground-clauses '(:fluents (f)) '(:non-inertial-fluents (n))
                                          '(:events (e)) (cons :axioms axioms))
                          '() '((e)))))
    (is (eq :forbidden (after '(initiates (e) (f) ?time) '(terminates (e) (f) ?time)
                              '(not (holds-at (n) ?time)))))
    (is (eq :forbidden (after '(initiates (e) (n) ?time) '(holds-at (n) ?time))))
    (is (eq :forbidden (after '(initiates (e) (f) ?time) '(releases (e) (f) ?time)
                              '(not (holds-at (n) ?time)) '(holds-at (f) ?time))))))

(test fluents-released-at-first
  (let ((ground (ground-clauses '(:fluents (f)) '(:events (e)) '(:manual-release f)
                                '(:axioms (initiates (e) (f) ?time)))))
    (is (equal (as-atoms '(() (:f))) (possible-finals ground '() '())))
    (is (equal (as-atoms '((:f))) (possible-finals ground '() '((e)) '())))
    (signals-with (ec:undetermined "whether (f) is released at 0") (progressed ground '()))))

;;; Trajectories

(defun sink-clauses (&rest more)
  (list* '(:sorts (height (:range 0 3))) '(:fluents (filling) (level height))
         '(:events (open) (close))
         `(:axioms (initiates (open) (filling) ?time) (terminates (close) (filling) ?time)
                   (releases (open) (level ?height) ?time)
                   (implies (holds-at (level ?height) ?time)
                            (initiates (close) (level ?height) ?time))
                   (implies (and (holds-at (level ?height1) ?time)
                                 (= ?height2 (+ ?height1 ?offset)))
                            (trajectory (filling) ?time (level ?height2) ?offset))
                   (implies (and (holds-at (level ?height1) ?time)
                                 (holds-at (level ?height2) ?time))
                            (= ?height1 ?height2)))
         more))

(test trajectories-are-followed
  "The level rises until the tap is closed; what is not reached is excluded by the constraint."
  (dolist (more '(() ((:offset 1 9)) ((:time 0 3))))
    (let ((ground (apply #'ground-clauses (apply #'sink-clauses more))))
      (is (equal '(((:level 0)) ((:filling) (:level 1)) ((:filling) (:level 2)) ((:level 2))
                   ((:level 2)))
                 (fluents-along ground '((:level 0)) '((open)) '() '((close)) '()))
          "with ~s" more))))

(test trajectories-end-with-their-offsets
  (let ((ground (apply #'ground-clauses (sink-clauses '(:offset 1 1)))))
    (is (= 5 (length (possible-finals ground '((:level 0)) '((open)) '())))
        "any level, or none")))

(test anti-trajectories-are-followed
  (let ((ground (ground-clauses
                 '(:fluents (lit) (cold)) '(:events (light) (quench))
                 '(:axioms (initiates (light) (lit) ?time) (terminates (quench) (lit) ?time)
                   (releases (quench) (cold) ?time) (terminates (light) (cold) ?time)
                   (implies (= ?offset 2) (anti-trajectory (lit) ?time (cold) ?offset))))))
    (is (equal (as-atoms '((:cold))) (possible-finals ground '((:lit)) '((quench)) '())))
    (is (equal (as-atoms '(() (:cold))) (possible-finals ground '((:lit)) '((quench)))))
    (is (equal (as-atoms '((:lit))) (possible-finals ground '((:lit)) '((quench)) '((light)))))))

;;; Sentences over several timepoints

(test sentences-wait-for-their-last-timepoint
  (let ((ground (ground-clauses
                 '(:fluents (wet) (rust)) '(:events (water) (dry) (corrode))
                 '(:axioms (initiates (water) (wet) ?time) (terminates (dry) (wet) ?time)
                   (initiates (corrode) (rust) ?time)
                   (implies (and (holds-at (wet) ?time) (holds-at (wet) (+ ?time 1)))
                            (holds-at (rust) (+ ?time 2)))
                   (implies (and (happens (corrode) ?time) (holds-at (wet) ?time))
                            (holds-at (wet) (- ?time 1)))))))
    (is (equal (as-atoms '(() (:wet) (:wet))) (fluents-along ground '() '((water)) '())))
    (is (eq :forbidden (fluents-along ground '() '((water)) '() '())))
    (is (equal (as-atoms '(() (:wet) (:wet) (:wet :rust)))
               (fluents-along ground '() '((water)) '() '((corrode)))))
    (is (eq :forbidden (fluents-along ground '() '((water)) '((corrode)) '())))))

(test two-timepoints-in-an-order
  (let ((ground (ground-clauses
                 '(:fluents (dead)) '(:events (kill) (revive))
                 '(:axioms (initiates (kill) (dead) ?time) (terminates (revive) (dead) ?time)
                   (for-ever (implies (and (holds-at (dead) ?time1) (< ?time1 ?time2))
                                      (holds-at (dead) ?time2)))))))
    (is (equal (as-atoms '(() (:dead) (:dead))) (fluents-along ground '() '((kill)) '())))
    (is (eq :forbidden (fluents-along ground '() '((kill)) '() '((revive)))))
    (is-true (ec:state-exact-p (first (last (progressed ground '() '((kill)) '())))))))

(test what-speaks-of-all-the-future-is-never-judged
  (let* ((ground (ground-clauses
                  '(:fluents (f)) '(:events (e))
                  '(:axioms (initiates (e) (f) ?time)
                    (some-day (implies (not (holds-at (f) ?time))
                                       (exists (?time1) (and (< ?time ?time1)
                                                             (holds-at (f) ?time1))))))
                  '(:facts
                    (before (implies (holds-at (f) ?time)
                                     (exists (?time1) (and (< ?time1 ?time)
                                                           (happens (e) ?time1))))))))
         (states (progressed ground '() '() '())))
    (is (equal (as-atoms '(() () ())) (mapcar #'ec:state-fluents states)))
    (is (eq :forbidden (fluents-along ground '((:f)) '())) "sentences about the past are judged")
    (let ((limits (ec:state-limits (third states))))
      (is (equal '(:some-day) (loop for (axiom) in limits collect (ec:axiom-name axiom))))
      (is (string= "it speaks of all timepoints to come" (cdr (first limits)))))
    (is-false (ec:state-exact-p (third states)))))

(test effects-and-triggers-that-look-ahead
  "What an event does depends on the state that it leads to."
  (let ((ground (ground-clauses
                 '(:fluents (f) (g)) '(:events (e) (d))
                 '(:axioms
                   (implies (holds-at (g) (+ ?time 1)) (initiates (e) (f) ?time))
                   (initiates (d) (g) ?time)
                   (implies (and (holds-at (f) (+ ?time 1)) (not (holds-at (f) ?time)))
                            (happens (d) ?time))))))
    (is (equal (as-atoms '(() (:f :g))) (possible-finals ground '() '((e)))))
    (is (equal (as-atoms '((:f :g))) (possible-finals ground '((:g)) '((e)))))
    (is (equal (as-atoms '(())) (possible-finals ground '() '())))))

;;; Predicates of the theory

(test predicates-that-are-completed
  (let ((ground (ground-clauses
                 '(:sorts (device radio tv)) '(:predicates (ab device time) (toy device))
                 '(:fluents (on device) (broken device)) '(:events (press device))
                 '(:completion (theta ab) (toys toy))
                 '(:axioms
                   (implies (not (ab ?device ?time)) (initiates (press ?device) (on ?device) ?time))
                   (broken :label theta (implies (holds-at (broken ?device) ?time)
                                                 (ab ?device ?time)))
                   (toys :label theta (implies (toy ?device) (ab ?device ?time)))
                   (the-toy :label toys (toy tv))))))
    (is (equal '(() ((:on :radio)) ((:on :radio)))
               (fluents-along ground '() '((press radio)) '((press tv)))))
    (is (equal '(((:broken :radio)) ((:broken :radio)))
               (fluents-along ground '((:broken :radio)) '((press radio)))))))

(test predicates-that-are-open
  (let ((ground (ground-clauses
                 '(:predicates (lucky time) (strong)) '(:fluents (won)) '(:events (play))
                 '(:axioms (implies (and (lucky ?time) (strong)) (initiates (play) (won) ?time))
                   (implies (not (holds-at (won) ?time)) (not (lucky (+ ?time 1))))))))
    (is (equal (as-atoms '(() (:won))) (possible-finals ground '() '((play)))))
    (is (equal (as-atoms '(())) (possible-finals ground '() '() '((play)))))
    (signals-with (ec:undetermined "whether (strong) is true,") (progressed ground '()))))

(test causal-constraints-are-followed
  "Predicates that are defined by events, which depend on the predicates."
  (let ((ground (ec:ground
                 (ec::parse-theory
                  'switches
                  '((:extends causal-constraints)
                    (:fluents (closed) (lit)) (:events (close) (light))
                    (:axioms (initiates (close) (closed) ?time) (initiates (light) (lit) ?time)
                     (lamp :label delta
                      (implies (and (stopped (lit) ?time) (initiated (closed) ?time))
                       (happens (light) ?time))))
                    (:completion (delta happens)))))))
    (is (equal (as-atoms '((:closed :lit))) (possible-finals ground '() '((close)))))
    (is (equal (as-atoms '(())) (possible-finals ground '() '())))))
