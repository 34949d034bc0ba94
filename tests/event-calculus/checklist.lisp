;;;; The features that a complete language for the Discrete Event Calculus has, a test each.
;;;;
;;;; The list is that of the examples of the Discrete Event Calculus Reasoner; each test would fail
;;;; if its feature were missing or meant something else.  INLINE-THEORY, ALWAYS and SOMETIMES are
;;;; in schemas.lisp, ALL-MODELS in scenario-checks.lisp.

(in-package #:discrepancy-finder.tests)

(def-suite checklist :in all)
(in-suite checklist)

(test 1-unconditional-and-conditional-effects
  "E. Mueller, A tool for satisfiability-based commonsense reasoning, 2004: two televisions."
  (let ((theory (inline-theory
                  (:sorts (set tv1 tv2))
                  (:fluents (switch-on set) (plugged-in set) (tv-on set))
                  (:events (turn-on set))
                  (:axioms (initiates (turn-on ?set) (switch-on ?set) ?time)
                           (implies (holds-at (plugged-in ?set) ?time)
                                    (initiates (turn-on ?set) (tv-on ?set) ?time)))
                  (:facts (not (holds-at (tv-on ?set) 0))
                          (iff (holds-at (plugged-in ?set) 0) (= ?set tv1)))
                  (:narrative (happens (turn-on ?set) 0))
                  (:completion happens)
                  (:time 0 1))))
    (always theory (holds-at (switch-on tv1) 1) (holds-at (switch-on tv2) 1)
      (holds-at (tv-on tv1) 1) (not (holds-at (tv-on tv2) 1)))))

(test 2-release
  (let ((theory (inline-theory
                  (:fluents (door-open))
                  (:events (wind) (shut))
                  (:axioms (releases (wind) (door-open) ?time)
                           (terminates (shut) (door-open) ?time))
                  (:facts (not (holds-at (door-open) 0)))
                  (:narrative (happens (wind) 1) (happens (shut) 3))
                  (:completion happens)
                  (:time 0 5))))
    (always theory (not (holds-at (door-open) 1)) (not (released-at (door-open) 1))
      (released-at (door-open) 2) (released-at (door-open) 3)
      (not (holds-at (door-open) 4)) (not (released-at (door-open) 4))
      (not (holds-at (door-open) 5)))
    (sometimes theory (holds-at (door-open) 2) (holds-at (door-open) 3)
      (iff (holds-at (door-open) 2) (holds-at (door-open) 3)))
    (is (= 4 (ec:count-models theory)))))

(test 3-non-inertial-fluents
  (let ((theory (inline-theory
                  (:fluents (steady))
                  (:non-inertial-fluents (flickering))
                  (:events (e))
                  (:axioms (not (and (holds-at (steady) ?time) (holds-at (flickering) ?time)
                                     (happens (e) ?time))))
                  (:completion happens)
                  (:time 0 2))))
    (always theory (forall (?time) (released-at (flickering) ?time))
      (forall (?time) (not (released-at (steady) ?time)))
      (iff (holds-at (steady) 0) (holds-at (steady) 2)))
    (sometimes theory (iff (holds-at (flickering) 0) (holds-at (flickering) 1)))))

(test 4-initially-released-fluents
  (flet ((theory (&rest clauses)
           (ec::parse-theory 'lamps (append clauses
                                            '((:sorts (lamp a b))
                                              (:fluents (lit lamp))
                                              (:facts (iff (released-at (lit ?lamp) 0)
                                                           (= ?lamp a)))
                                              (:time 0 1))))))
    (is-false (ec:consistent-p (theory)))
    (dolist (theory (list (theory '(:manual-release lit)) (theory '(:manual-release t))))
      (always theory (iff (holds-at (lit b) 0) (holds-at (lit b) 1)))
      (sometimes theory (iff (holds-at (lit a) 0) (holds-at (lit a) 1))))))

(test 5-state-constraints
  (let ((theory (inline-theory
                  (:sorts (book red blue) (place shelf table))
                  (:non-inertial-fluents (on book place) (tidy))
                  (:axioms (exists (?place) (holds-at (on ?book ?place) ?time))
                           (implies (and (holds-at (on ?book ?place1) ?time)
                                         (holds-at (on ?book ?place2) ?time))
                                    (= ?place1 ?place2))
                           (iff (holds-at (tidy) ?time)
                                (forall (?book) (holds-at (on ?book shelf) ?time))))
                  (:time 0 0))))
    (is (= 4 (ec:count-models theory)))
    (is (= 1 (ec:count-models theory :where '(holds-at (tidy) 0))))
    (always theory (iff (holds-at (on red table) 0) (not (holds-at (on red shelf) 0)))
      (implies (not (holds-at (tidy) 0)) (exists (?book) (holds-at (on ?book table) 0))))))

(test 6-preconditions
  (let ((theory (inline-theory
                  (:sorts (door front back))
                  (:fluents (have-key door) (locked door))
                  (:events (unlock door))
                  (:axioms (terminates (unlock ?door) (locked ?door) ?time)
                           (implies (happens (unlock ?door) ?time)
                                    (and (holds-at (have-key ?door) ?time)
                                         (holds-at (locked ?door) ?time))))
                  (:facts (holds-at (locked ?door) 0)
                          (iff (holds-at (have-key ?door) 0) (= ?door front)))
                  (:time 0 2))))
    (always theory (not (happens (unlock back) 0)) (holds-at (locked back) 2)
      (implies (happens (unlock front) 0) (not (happens (unlock front) 1))))
    (sometimes theory (happens (unlock front) 0) (happens (unlock front) 1))
    (is (= 3 (ec:count-models theory)))))

(test 7-triggers
  (let ((theory (inline-theory
                  (:fluents (hot) (fan-on))
                  (:events (start-fan) (beep) (heat))
                  (:axioms (initiates (heat) (hot) ?time)
                           (initiates (start-fan) (fan-on) ?time)
                           (implies (and (holds-at (hot) ?time) (not (holds-at (fan-on) ?time)))
                                    (happens (start-fan) ?time))
                           (implies (holds-at (hot) ?time) (happens (beep) ?time)))
                  (:facts (not (holds-at (hot) 0)) (not (holds-at (fan-on) 0)))
                  (:narrative (happens (heat) 1))
                  (:completion happens)
                  (:time 0 5))))
    (always theory
      (forall (?time) (iff (happens (start-fan) ?time) (= ?time 2)))
      (forall (?time) (iff (happens (beep) ?time) (and (>= ?time 2) (< ?time 5))))
      (holds-at (fan-on) 5))
    (is (= 1 (ec:count-models theory)))))

(test 8-disjunctive-events-and-exclusions
  (flet ((theory (&rest clauses)
           (ec::parse-theory 'journeys (append clauses
                                               '((:sorts (agent ann ben))
                                                 (:events (walk agent) (ride agent))
                                                 (:time 0 1))))))
    (let ((hierarchy (ec::parse-theory
                      'go '((:events (go) (walk) (ride) (wait))
                            (:axioms (implies (happens (go) ?time)
                                              (or (happens (walk) ?time) (happens (ride) ?time))))
                            (:narrative (happens (go) 1))
                            (:completion happens)
                            (:time 0 2)))))
      (always hierarchy (not (happens (walk) 0))
        (iff (happens (walk) 1) (not (happens (ride) 1))))
      (is (= 2 (ec:count-models hierarchy))))
    ;; Of the 4 events of walking or riding, at most one; exactly one; none of these said.
    (is (= 5 (ec:count-models (theory '(:mutex (walk ride))))))
    (is (= 4 (ec:count-models (theory '(:xor (walk ride))))))
    (is (= 9 (ec:count-models (theory '(:mutex (walk) (ride))))))))

(test 9-determining-fluents
  (let ((theory (inline-theory
                  (:fluents (six))
                  (:non-inertial-fluents (falls-on-six))
                  (:events (throw))
                  (:axioms (implies (holds-at (falls-on-six) ?time)
                                    (initiates (throw) (six) ?time))
                           (implies (not (holds-at (falls-on-six) ?time))
                                    (terminates (throw) (six) ?time)))
                  (:facts (holds-at (six) 0))
                  (:narrative (happens (throw) 0) (happens (throw) 1))
                  (:completion happens)
                  (:time 0 2))))
    (is (= 4 (ec:count-models theory)))
    (always theory (iff (holds-at (falls-on-six) 0) (holds-at (six) 1)))
    (sometimes theory (holds-at (six) 1) (holds-at (six) 2)
      (iff (holds-at (six) 1) (holds-at (six) 2)))))

(test 10-concurrent-events
  (flet ((theory (&rest events)
           (ec::parse-theory
            'table `((:fluents (lifted) (tilted))
                     (:events (lift-left) (lift-right))
                     (:axioms (implies (happens (lift-right) ?time)
                                       (initiates (lift-left) (lifted) ?time))
                              (implies (not (happens (lift-right) ?time))
                                       (initiates (lift-left) (tilted) ?time)))
                     (:facts (not (holds-at (lifted) 0)) (not (holds-at (tilted) 0)))
                     (:narrative ,@(loop for event in events collect `(happens ,event 0)))
                     (:completion happens)
                     (:time 0 1)))))
    (always (theory '(lift-left) '(lift-right))
      (holds-at (lifted) 1) (not (holds-at (tilted) 1)))
    (always (theory '(lift-left)) (not (holds-at (lifted) 1)) (holds-at (tilted) 1))
    (always (theory '(lift-right)) (not (holds-at (lifted) 1)) (not (holds-at (tilted) 1)))))

(test 11-gradual-change
  "Heights rise by a trajectory and sink by an antitrajectory of the same fluent."
  (let ((theory (lift '(:axioms
                        (implies (holds-at (height ?height) ?time)
                         (trajectory (rising) ?time (height (+ ?height (* 2 ?offset))) ?offset))
                        (implies (and (holds-at (height ?height1) ?time)
                                  (= ?height2 (- ?height1 ?offset)))
                         (anti-trajectory (rising) ?time (height ?height2) ?offset)))
                      '(:facts (holds-at (height 1) 0) (not (holds-at (rising) 0)))
                      '(:narrative (happens (start) 0) (happens (stop) 2)))))
    (always theory (holds-at (height 3) 1) (holds-at (height 5) 2) (holds-at (height 4) 3)
      (holds-at (height 3) 4) (holds-at (height 2) 5))
    (is (= 1 (ec:count-models theory)))))

(test 12-causal-constraints
  "The indirect effect is at the same timepoint as its cause, not later."
  (let ((theory (inline-theory
                  (:extends causal-constraints)
                  (:fluents (dial) (lock) (alarm))
                  (:events (turn) (release-lock) (jam))
                  (:axioms (initiates (turn) (dial) ?time)
                           (terminates (release-lock) (lock) ?time)
                           (initiates (jam) (alarm) ?time)
                           (linked :label delta
                            (implies (and (started (lock) ?time) (initiated (dial) ?time))
                                     (happens (release-lock) ?time)))
                           (stuck :label delta
                            (implies (and (initiated (lock) ?time) (initiated (dial) ?time))
                                     (happens (jam) ?time))))
                  (:facts (initially (and (not (dial)) (lock) (not (alarm)))))
                  (:narrative (turning :label delta (happens (turn) 1)))
                  (:completion (delta happens))
                  (:time 0 3))))
    (is (= 1 (ec:count-models theory)))
    (always theory (holds-at (lock) 1) (happens (release-lock) 1) (not (holds-at (lock) 2))
      (not (holds-at (alarm) 2)) (stopped (lock) 1) (not (initiated (lock) 1))
      (terminated (lock) 1) (initiated (lock) 0) (not (started (dial) 0)) (started (dial) 1)
      (initiated (dial) 2) (terminated (dial) 0))))

(defun door-theory ()
  (inline-theory
    (:fluents (at-door) (door-open) (inside))
    (:events (walk) (open-door) (enter))
    (:axioms (initiates (walk) (at-door) ?time)
             (initiates (open-door) (door-open) ?time)
             (initiates (enter) (inside) ?time)
             (implies (happens (walk) ?time) (not (holds-at (at-door) ?time)))
             (implies (happens (open-door) ?time)
                      (and (holds-at (at-door) ?time) (not (holds-at (door-open) ?time))))
             (implies (happens (enter) ?time)
                      (and (holds-at (door-open) ?time) (not (holds-at (inside) ?time)))))
    (:facts (initially (and (not (at-door)) (not (inside)))))
    (:time 0 4)))

(test 13-abduction-planning-postdiction
  (let ((theory (door-theory)))
    (multiple-value-bind (plans length)
        (ec:abduce theory '(inside) :limit 10 :where '(not (holds-at (door-open) 0)))
      (is (= 3 length))
      (is (equal '((((:walk)) ((:open-door)) ((:enter)))) plans)))
    ;; What happened, and what was the case?
    (is-true (ec:entailed-p theory '(implies (and (holds-at (inside) 1) (not (happens (walk) 0)))
                                     (holds-at (door-open) 0))))
    (let ((consequences (ec:consequences theory :where '(and (holds-at (inside) 3)
                                                         (not (holds-at (door-open) 0))))))
      (dolist (atom '((:happens (:walk) 0) (:happens (:open-door) 1) (:happens (:enter) 2)
                      (:holds-at (:inside) 4)))
        (is (member atom consequences :test #'equal))))
    (is (null (ec:abduce theory '(inside) :horizon 2 :where '(not (holds-at (door-open) 0)))))))

(test 14-abnormality
  (flet ((theory (completion)
           (ec::parse-theory
            'birds `((:sorts (bird robin penguin))
                     (:predicates (ab1 bird) (flies bird))
                     (:axioms (implies (not (ab1 ?bird)) (flies ?bird))
                              (cancelled :label theta (implies (= ?bird penguin) (ab1 ?bird)))
                              (implies (= ?bird penguin) (not (flies ?bird))))
                     (:completion ,@completion)
                     (:time 0 0)))))
    (let ((birds (theory '((theta ab1)))))
      (is (= 1 (ec:count-models birds)))
      (always birds (flies robin) (not (flies penguin)) (ab1 penguin) (not (ab1 robin))))
    ;; Without completion robins may be abnormal; then they may fly all the same.
    (is (= 3 (ec:count-models (theory '()))))
    ;; Without a label the default itself supports the abnormality of a bird that does not fly.
    (is (= 2 (ec:count-models (theory '(ab1)))))
    (sometimes (theory '(ab1)) (ab1 robin))))

(test 15-predicates-functions-arithmetic
  (let ((theory (inline-theory
                  (:sorts (coin penny dime quarter) (cents (:range 0 50)))
                  (:predicates (change cents cents) (half cents cents) (odd cents)
                               (dearer coin coin))
                  (:functions ((worth coin) cents))
                  (:axioms (iff (change ?cents1 ?cents2)
                                (and (= (+ ?cents1 ?cents2) (* 2 (worth quarter)))
                                     (>= ?cents1 (- (worth quarter) (worth dime)))
                                     (<= ?cents1 16)))
                           (iff (half ?cents1 ?cents2) (and (= ?cents2 (/ ?cents1 2))
                                                            (< ?cents1 4)))
                           (iff (odd ?cents) (and (= (mod ?cents 2) 1) (> 5 ?cents)))
                           (iff (dearer ?coin1 ?coin2)
                                (and (/= ?coin1 ?coin2) (> (worth ?coin1) (worth ?coin2)))))
                  (:facts (= (worth penny) 1) (= (worth dime) 10) (= (worth quarter) 25))
                  (:time 0 0))))
    (is (equal '("Change(15,35)" "Change(16,34)" "Dearer(Dime,Penny)" "Dearer(Quarter,Dime)"
                 "Dearer(Quarter,Penny)" "Half(0,0)" "Half(1,0)" "Half(2,1)" "Half(3,1)"
                 "Odd(1)" "Odd(3)")
               (model-texts (first (ec:models theory)))))
    (is (= 1 (ec:count-models theory)))))

(test 16-reified-arguments
  (let ((theory (inline-theory
                  (:sorts (thing lamp cup) (belief (:terms (b-broken thing) (b-clean thing))))
                  (:fluents (broken thing) (clean thing) (believed belief))
                  (:events (drop thing) (tell belief) (make-true fluent))
                  (:axioms (initiates (drop ?thing) (broken ?thing) ?time)
                           (initiates (drop ?thing) (believed (b-broken ?thing)) ?time)
                           (initiates (tell ?belief) (believed ?belief) ?time)
                           (initiates (make-true ?fluent) ?fluent ?time)
                           (one-at-a-time
                            (implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                                     (= ?event1 ?event2))))
                  (:facts (forall (?fluent) (not (holds-at ?fluent 0)))
                          (happens (drop cup) 0)
                          (happens (tell (b-clean lamp)) 1)
                          (happens (make-true (believed (b-broken lamp))) 2))
                  (:time 0 3))))
    (is (= 1 (ec:count-models theory)))
    (always theory (holds-at (believed (b-broken cup)) 1) (not (holds-at (broken lamp) 3))
      (not (holds-at (believed (b-broken lamp)) 2)) (holds-at (believed (b-broken lamp)) 3)
      (holds-at (believed (b-clean lamp)) 2) (not (holds-at (believed (b-clean cup)) 3)))))

(test 17-exists-within-effects
  (let ((theory (inline-theory
                  (:sorts (room hall attic) (cat tom) (mouse jerry nibbles))
                  (:fluents (in-room cat room) (mouse-in mouse room) (afraid mouse))
                  (:events (meow cat))
                  (:axioms (implies (exists (?room) (and (holds-at (in-room ?cat ?room) ?time)
                                                         (holds-at (mouse-in ?mouse ?room) ?time)))
                                    (initiates (meow ?cat) (afraid ?mouse) ?time)))
                  (:facts (iff (holds-at (in-room ?cat ?room) 0) (= ?room hall))
                          (iff (holds-at (mouse-in ?mouse ?room) 0)
                               (or (and (= ?mouse jerry) (= ?room hall))
                                   (and (= ?mouse nibbles) (= ?room attic))))
                          (not (holds-at (afraid ?mouse) 0)))
                  (:narrative (happens (meow tom) 0))
                  (:completion happens)
                  (:time 0 1))))
    (always theory (holds-at (afraid jerry) 1) (not (holds-at (afraid nibbles) 1)))))

(test 18-other-timepoints
  (let ((theory (inline-theory
                  (:non-inertial-fluents (green) (amber) (red))
                  (:events (press) (ring))
                  (:axioms (implies (holds-at (green) ?time)
                                    (or (holds-at (green) (+ ?time 1))
                                        (holds-at (amber) (+ ?time 1))))
                           (implies (holds-at (red) ?time) (or (holds-at (red) (- ?time 1))
                                                               (holds-at (amber) (- ?time 1))))
                           (or (holds-at (green) ?time) (holds-at (amber) ?time)
                               (holds-at (red) ?time))
                           (later :label delta
                            (implies (and (happens (press) ?time1) (< ?time1 ?time2)
                                          (= ?time2 (+ ?time1 2)))
                                     (happens (ring) ?time2))))
                  (:mutex (green amber red))
                  (:facts (holds-at (green) 0) (holds-at (red) 2))
                  (:narrative (pressed :label delta (happens (press) 1)))
                  (:completion (delta happens))
                  (:time 0 4))))
    (always theory (holds-at (amber) 1) (forall (?time) (iff (happens (ring) ?time) (= ?time 3))))
    ;; At 3 any colour but green from red without amber is possible, at 4 what follows it.
    (sometimes theory (holds-at (red) 3) (holds-at (amber) 3) (holds-at (green) 3))))

(test 19-compound-events
  "A pot of tea is made by an event with a beginning and an end that nothing interrupts."
  (let ((theory (inline-theory
                  (:predicates (make-tea time time))
                  (:fluents (brewing))
                  (:events (pour) (knock-over) (serve))
                  (:axioms (initiates (pour) (brewing) ?time)
                           (terminates (knock-over) (brewing) ?time)
                           (terminates (serve) (brewing) ?time)
                           (iff (make-tea ?time1 ?time2)
                                (and (happens (pour) ?time1) (happens (serve) ?time2)
                                     (> ?time2 ?time1)
                                     (not (stopped-in ?time1 (brewing) ?time2))
                                     (not (clipped ?time1 (brewing) ?time2))
                                     (declipped ?time1 (brewing) ?time2))))
                  (:narrative (first-pot :label delta (happens (pour) 0))
                              (accident :label delta (happens (knock-over) 2))
                              (second-pot :label delta (happens (pour) 3))
                              (tea :label delta (happens (serve) 5)))
                  (:completion (delta happens))
                  (:time 0 6))))
    ;; Nothing happens at 6, so the definition says nothing of what would end there.
    (always theory (make-tea 3 5)
      (forall (?time1 ?time2) (implies (and (make-tea ?time1 ?time2) (< ?time1 6) (< ?time2 6))
                                       (and (= ?time1 3) (= ?time2 5)))))))

(test 20-inconsistency
  (let ((theory (inline-theory
                  (:fluents (f))
                  (:events (e))
                  (:axioms (initiates (e) (f) ?time) (not (holds-at (f) ?time)))
                  (:narrative (happens (e) 0))
                  (:time 0 1))))
    (is (= 0 (ec:count-models theory)))
    (is (null (ec:models theory)))
    (is-false (ec:consistent-p theory))
    (is (equal '(t nil) (multiple-value-list (ec:entailed-p theory '(holds-at (f) 1)))))
    (is-false (ec:possible-p theory '(holds-at (f) 1)))))
