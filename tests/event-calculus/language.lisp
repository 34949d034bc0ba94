;;;; The language of define-theory: what each clause and each construct of it means.
;;;;
;;;; What is wrong with a theory is in language-errors.lisp.

(in-package #:discrepancy-finder.tests)

(def-suite theory-language :in all)
(in-suite theory-language)

(defmacro elements-of (sort &body clauses)
  "Return the elements of SORT in the theory with CLAUSES."
  `(ec:sort-elements (inline-theory ,@clauses) ',sort))

;;; Sorts

(test sorts-list-their-elements
  (is (equal '(:r1 :r2) (elements-of region (:sorts (region r1 r2)))))
  (is (equal '(0 1 2) (elements-of height (:sorts (height (:range 0 2))))))
  (is (equal '(-2 -1) (elements-of depth (:sorts (depth (:range -2 -1))))))
  (is (equal '(7) (elements-of lucky (:sorts (lucky (:range 7 7))))))
  (is (equal '() (elements-of nobody (:sorts (nobody)))))
  (is (equal '(:r1 :r2) (elements-of region (:sorts (region r1)) (:sorts (other o))
                          (:extends) (:sorts (more (:parent region) r2))))
      "clauses may occur several times, and subsorts come after what a sort has itself")
  (is (equal '((:b-on :cat :shelf) (:b-on :dog :shelf) (:b-satiated :cat) (:b-satiated :dog))
             (elements-of belief
               (:sorts (pet cat dog) (place shelf)
                       (belief (:terms (b-on pet place) (b-satiated pet)))))))
  (is (equal '((:lit :a) (:lit :b) (:dark))
             (elements-of fluent (:sorts (lamp a b)) (:fluents (lit lamp) (dark)))))
  (is (equal '((:toggle :a)) (elements-of event (:sorts (lamp a)) (:events (toggle lamp)))))
  (is (equal '(3 4 5) (elements-of time (:time 3 5))))
  (is (equal '(1 2) (elements-of offset (:time 3 5))))
  (is (equal '(1 2 3 4) (elements-of offset (:time 3 5) (:offset 1 4))))
  (is (equal '(nil nil) (multiple-value-list (elements-of nothing (:sorts (region r1)))))))

(test subsorts
  (let ((theory (inline-theory
                  (:sorts (thing stone) (agent (:parent thing)) (human (:parent agent) ann)
                          (robot (:parent agent) (:parent machine) pr2)
                          (machine (:parent thing) lift))
                  (:non-inertial-fluents (works thing) (tired agent) (on machine))
                  (:axioms (implies (holds-at (tired ?agent) 0) (holds-at (works ?agent) 0))
                           (holds-at (tired ?human) 0)
                           (holds-at (on ?robot) 0))
                  (:time 0 0))))
    (is (equal '(:stone :ann :pr2 :lift) (ec:sort-elements theory 'thing)))
    (is (equal '(:ann :pr2) (ec:sort-elements theory 'agent)))
    (is (equal '(:lift :pr2) (ec:sort-elements theory 'machine)))
    (always theory (holds-at (works ann) 0) (holds-at (on pr2) 0))
    (sometimes theory (holds-at (tired pr2) 0) (holds-at (on lift) 0) (holds-at (works lift) 0))
    (is (equalp #((:works :stone) (:works :ann) (:works :pr2) (:works :lift) (:tired :ann)
                  (:tired :pr2) (:on :lift) (:on :pr2))
                (ec:ground-theory-fluents (ec:ground theory))))))

(test variables-are-named-by-their-sorts
  "The digits at the end do not count, and ?time is a timepoint."
  (let ((theory (inline-theory
                  (:sorts (work-place desk bench) (part2a p q))
                  (:non-inertial-fluents (at work-place) (used part2a))
                  (:axioms (holds-at (at ?work-place) 0)
                           (implies (/= ?work-place1 ?work-place22)
                                    (holds-at (at ?work-place22) ?time3))
                           (not (holds-at (used ?part2a17) ?time)))
                  (:time 0 1))))
    (always theory
      (forall (?work-place ?time) (holds-at (at ?work-place) ?time))
      (not (exists (?part2a9) (holds-at (used ?part2a9) 1))))))

(test quantifiers
  (let ((theory (inline-theory
                  (:sorts (person ann ben) (place home work) (nobody))
                  (:predicates (likes person place) (odd person) (empty) (full))
                  (:axioms (iff (odd ?person) (exists (?place) (not (likes ?person ?place))))
                           (forall (?person1 ?place)
                                   (implies (= ?person1 ann) (likes ?person1 ?place)))
                           (exists (?person) (forall (?place) (not (likes ?person ?place))))
                           (iff (empty) (exists (?nobody) (odd ann)))
                           (iff (full) (forall (?nobody) (odd ann))))
                  (:time 0 0))))
    (always theory (likes ann home) (not (likes ben work)) (odd ben) (not (odd ann))
      (not (empty)) (full)
      ;; The inner variable is another one.
      (exists (?person) (and (odd ?person) (exists (?person) (not (odd ?person))))))))

;;; Terms

(defmacro computes (&rest comparisons)
  "Check that each of COMPARISONS is true, and its negation false, when it is made ground."
  `(dolist (form ',comparisons)
     (flet ((models-of (form)
              (ec:count-models (ec::parse-theory 'inline
                                                 `((:predicates (p)) (:axioms (iff (p) ,form))
                                                   (:time 0 0)))
                               :where '(p))))
       (is (= 1 (models-of form)) "~a is not true" form)
       (is (= 0 (models-of (list 'not form))) "~a is false" form))))

(test arithmetic
  (computes (= 5 (+ 2 3)) (= 6 (+ 1 2 3)) (= 2 (+ 2)) (= -1 (- 2 3)) (= -3 (- 3)) (= 6 (* 2 3))
            (= 24 (* 2 3 4)) (= 3 (/ 7 2)) (= -3 (/ -7 2)) (= 1 (mod 7 2)) (= -1 (mod -7 2))
            (= 7 (+ (* 2 (- 5 2)) 1))
            (< 1 2) (not (< 2 2)) (<= 2 2) (not (<= 3 2)) (> 3 2) (not (> 2 2)) (>= 2 2)
            (not (>= 1 2)) (/= 1 2) (not (/= 2 2)) (not (= 1 2)) (= 100000000000000000000
                                                                   (* 10000000000 10000000000))))

(test a-division-by-zero-drops-the-instance
  (is (= 0 (ec:count-models (inline-theory (:sorts (n (:range 0 2))) (:predicates (p n))
                                           (:axioms (implies (= 2 (/ 2 ?n)) (p ?n))
                                                    (implies (= 1 (mod 3 ?n)) (not (p 1))))
                                           (:time 0 0))
                            :where '(not (p 1))))))

(test functions-have-tabulated-values
  (let ((theory (inline-theory
                  (:sorts (place a b c) (height (:range 0 5)))
                  (:functions ((distance place place) integer) ((next place) place)
                              ((home) place) ((above height) height))
                  (:predicates (near place place) (reached place) (flag) (high height))
                  (:facts (= (distance a b) 3) (= (distance b c) 7) (= (next a) b) (= (next b) c)
                          (= (home) a) (= (above 1) 2) (= (above 2) 4))
                  (:axioms (iff (near ?place1 ?place2) (< (distance ?place1 ?place2) 5))
                           (reached (next (next (home))))
                           (not (reached (home)))
                           (high (+ 1 (above (above 1))))
                           ;; There is no value of (next c), so nothing is said of it.
                           (implies (reached (next ?place)) (flag)))
                  (:time 0 0))))
    (always theory (near a b) (not (near b c)) (reached c) (high 5) (flag)
      (= (distance a b) 3) (exists (?place) (= (next ?place) c))
      (= (+ (distance a b) (distance b c)) 10))
    (sometimes theory (high 4) (reached b))))

(test values-for-all-arguments
  (always (inline-theory (:sorts (place a b)) (:functions ((cost place) integer))
                         (:predicates (cheap place))
                         (:axioms (= (cost ?place) 4)
                                  (iff (cheap ?place) (<= (cost ?place) 4)))
                         (:time 0 0))
    (forall (?place) (cheap ?place))))

(test the-order-of-values-does-not-matter
  "A value may be given by another one, before or after it."
  (dolist (facts '(((= (cost a) 4) (= (cost b) (+ 1 (cost a))))
                   ((= (cost b) (+ 1 (cost a))) (= (cost a) 4))))
    (always (ec::parse-theory 'inline `((:sorts (place a b)) (:functions ((cost place) integer))
                                        (:predicates (dear place))
                                        (:axioms (iff (dear ?place) (> (cost ?place) 4)))
                                        (:facts ,@facts)
                                        (:time 0 0)))
      (dear b) (not (dear a)))))

(test reified-terms
  (let ((theory (inline-theory
                  (:sorts (pet cat) (belief (:terms (b-hungry pet) (b-not-hungry pet))))
                  (:predicates (opposite belief belief))
                  (:fluents (hungry pet) (believes pet belief))
                  (:events (look pet) (imagine fluent))
                  (:axioms (implies (holds-at (hungry ?pet) ?time)
                                    (initiates (look ?pet) (believes ?pet (b-hungry ?pet)) ?time))
                           (iff (opposite ?belief1 ?belief2)
                                (exists (?pet) (and (= ?belief1 (b-hungry ?pet))
                                                    (= ?belief2 (b-not-hungry ?pet)))))
                           (implies (and (opposite ?belief1 ?belief2)
                                         (holds-at (believes ?pet ?belief1) ?time))
                                    (not (holds-at (believes ?pet ?belief2) ?time)))
                           (not (happens (imagine (hungry cat)) ?time)))
                  (:facts (initially (hungry cat)) (initially (not (believes cat ?belief))))
                  (:narrative (happens (look cat) 0))
                  (:time 0 1))))
    (always theory
      (holds-at (believes cat (b-hungry cat)) 1)
      (not (holds-at (believes cat (b-not-hungry cat)) 1))
      (opposite (b-hungry cat) (b-not-hungry cat))
      (not (opposite (b-not-hungry cat) (b-hungry cat)))
      (not (happens (imagine (hungry cat)) 0)))
    (sometimes theory (happens (imagine (believes cat (b-hungry cat))) 0))))

(test predicates-with-one-term-as-their-argument
  "Such an axiom looks like one with a name."
  (let ((theory (inline-theory (:sorts (place a)) (:functions ((home) place))
                               (:fluents (open place))
                               (:predicates (cosy place) (interesting fluent))
                               (:facts (= (home) a))
                               (:axioms (cosy (home)) (interesting (open a)))
                               (:time 0 0))))
    (always theory (cosy a) (interesting (open a)))
    (is (equal '(:|1| :|2| :|3|) (mapcar #'ec:axiom-name (ec:theory-axioms theory))))))

(test predicates-as-tables
  (let ((theory (inline-theory
                  (:sorts (place a b c) (step (:range 0 3)))
                  (:predicates ((near place place) (a b) (b c)) ((next step step) (0 1) (1 2))
                               ((never place)) (reachable place place))
                  (:axioms (iff (reachable ?place1 ?place2)
                                (or (near ?place1 ?place2)
                                    (exists (?place) (and (near ?place1 ?place)
                                                          (near ?place ?place2))))))
                  (:time 0 0))))
    (always theory
      (near a b) (not (near b a)) (reachable a c) (not (reachable c a))
      (exists (?step) (next ?step (+ ?step 1))) (not (next 2 3))
      (not (exists (?place) (never ?place))))
    (is (= 1 (ec:count-models theory)))
    (is (equal '((:near (:a :b) (:b :c)) (:next (0 1) (1 2)) (:never))
               (ec:theory-extensions theory))))
  (is-false (ec:consistent-p (inline-theory (:sorts (place a b))
                                            (:predicates ((near place place) (a b)))
                                            (:axioms (near b a)) (:time 0 0)))))

(test tables-of-timepoints
  (always (inline-theory (:sorts (shop bakery bank))
                         (:predicates ((opens shop time) (bakery 1) (bank 2)))
                         (:non-inertial-fluents (open shop))
                         (:axioms (iff (holds-at (open ?shop) ?time)
                                       (or (opens ?shop ?time) (opens ?shop (- ?time 1)))))
                         (:time 0 3))
    (holds-at (open bakery) 1) (not (holds-at (open bank) 1)) (holds-at (open bakery) 2)
    (holds-at (open bank) 3) (not (holds-at (open bakery) 3))))

(test variables-over-fluents-and-events
  (let ((theory (inline-theory
                  (:sorts (lamp a b))
                  (:fluents (lit lamp) (broken))
                  (:events (switch lamp) (repair))
                  (:axioms (implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                                    (= ?event1 ?event2))
                           (implies (holds-at ?fluent 0) (= ?fluent (broken)))
                           (initiates (switch ?lamp) (lit ?lamp) ?time)
                           (implies (exists (?lamp) (= ?fluent (lit ?lamp)))
                                    (terminates (repair) ?fluent ?time)))
                  (:facts (holds-at (broken) 0))
                  (:time 0 2))))
    (always theory
      (not (and (happens (switch a) 0) (happens (switch b) 0)))
      (forall (?fluent) (iff (holds-at ?fluent 0) (= ?fluent (broken))))
      (implies (and (happens (switch a) 0) (happens (repair) 1))
               (and (not (holds-at (lit a) 2)) (holds-at (broken) 2))))
    (sometimes theory (exists (?event) (happens ?event 0)))))

;;; Times

(test times
  "A formula may speak of several timepoints; instances that leave the horizon are dropped."
  (let ((theory (inline-theory
                  (:non-inertial-fluents (even))
                  (:events (tick))
                  (:axioms (iff (holds-at (even) ?time) (not (holds-at (even) (+ ?time 1))))
                           (iff (happens (tick) ?time) (holds-at (even) (- ?time 1))))
                  (:facts (holds-at (even) 2))
                  (:time 1 4))))
    (always theory
      (not (holds-at (even) 1)) (holds-at (even) 4) (happens (tick) 3) (not (happens (tick) 2))
      (forall (?time1 ?time2) (implies (= ?time2 (+ ?time1 2))
                                       (iff (holds-at (even) ?time1) (holds-at (even) ?time2)))))
    (sometimes theory (happens (tick) 1))))

(test the-range-of-timepoints
  (let ((theory (inline-theory (:fluents (f)) (:time 2 4))))
    (is (equal '(2 . 4) (ec:theory-time-range theory)))
    (is (equal '(2 . 4) (ec:model-horizon (first (ec:models theory)))))
    (is (equal '(2 . 3) (ec:model-horizon (first (ec:models theory :horizon 3)))))
    (is (equal '(0 . 1) (ec:model-horizon (first (ec:models theory :horizon '(0 1))))))
    (is (equal '(0 . 1) (ec:model-horizon (first (ec:models theory :horizon '(0 . 1))))))))

(test offsets-bound-trajectories
  (flet ((theory (&rest clauses)
           (ec::parse-theory
            'inline (append clauses
                            '((:sorts (height (:range 0 9)))
                              (:fluents (rising) (above height))
                              (:events (start))
                              (:axioms
                               (initiates (start) (rising) ?time)
                               (releases (start) (above ?height) ?time)
                               (implies (= ?height ?offset)
                                        (trajectory (rising) ?time (above ?height) ?offset)))
                              (:facts (initially (not (above ?height))) (initially (not (rising))))
                              (:narrative (happens (start) 0))
                              (:time 0 4))))))
    (always (theory) (holds-at (above 1) 1) (holds-at (above 4) 4))
    (always (theory '(:offset 1 2)) (holds-at (above 2) 2))
    (sometimes (theory '(:offset 1 2)) (holds-at (above 3) 3))))

(test timepoints-as-arguments
  "A fluent can be about a timepoint, and a function can give one."
  (let ((theory (inline-theory
                  (:fluents (alarm-at time)) (:events (ring))
                  (:functions ((breakfast) time))
                  (:axioms (implies (holds-at (alarm-at ?time) ?time) (happens (ring) ?time))
                           (iff (holds-at (alarm-at ?time1) 0) (= ?time1 (breakfast))))
                  (:facts (= (breakfast) 2))
                  (:completion happens) (:time 0 4))))
    (always theory
      (happens (ring) 2) (not (happens (ring) 1)) (holds-at (alarm-at 2) 4)
      (forall (?time) (implies (happens (ring) ?time) (= ?time (breakfast)))))
    (is (equal '((:alarm-at 0) (:alarm-at 1)) (coerce (ec:ground-theory-fluents
                                                      (ec:ground (inline-theory
                                                                   (:fluents (alarm-at time))
                                                                   (:time 0 1))))
                                                     'list)))))

;;; Axioms

(test names-and-labels-of-axioms
  (let ((theory (inline-theory
                  (:fluents (f))
                  (:predicates (p))
                  (:axioms (p) (named (p)) (labelled :label theta (p)) (and (p) (p)))
                  (:facts (holds-at (f) 0) (fact (holds-at (f) 0)))
                  (:axioms (not (not (p))))
                  (:narrative (p))
                  (:time 0 0))))
    (is (equal '(:|1| :named :labelled :|4| :|5| :|6| :fact :|8|)
               (mapcar #'ec:axiom-name (ec:theory-axioms theory)))
        "unnamed axioms are named by their places: axioms, facts, narrative")
    (is (equal '(nil nil :theta nil nil) (mapcar #'ec:axiom-label
                                                 (subseq (ec:theory-axioms theory) 0 5))))
    (is (equal '(:and (:p) (:p)) (ec:axiom-formula (fourth (ec:theory-axioms theory)))))))

(test completion-by-labels
  (flet ((theory (&rest clauses)
           (ec::parse-theory
            'inline (append clauses
                            '((:sorts (bird tweety opus))
                              (:predicates (penguin bird) (ab bird) (flies bird) (sings bird))
                              (:axioms (exception :label theta (implies (penguin ?bird) (ab ?bird)))
                                       (default (implies (not (ab ?bird)) (flies ?bird)))
                                       (song :label theta2 (implies (sings ?bird) (ab ?bird))))
                              (:facts (iff (penguin ?bird) (= ?bird opus))
                                      (implies (sings opus) (ab tweety)))
                              (:time 0 0))))))
    (sometimes (theory) (ab tweety) (flies tweety))
    (always (theory '(:completion (theta ab)) '(:facts (not (sings ?bird))))
      (not (ab tweety)) (flies tweety) (ab opus))
    ;; Sentences with another label support nothing.
    (always (theory '(:completion (theta ab))) (not (sings tweety)))
    ;; Without a label all sentences do, the default included, but no facts.
    (sometimes (theory '(:completion ab)) (ab tweety) (flies tweety))
    (always (theory '(:completion ab))
      (implies (ab tweety) (or (sings tweety) (not (flies tweety)))))
    (is-false (ec:consistent-p (inline-theory (:predicates (ab)) (:facts (ab)) (:completion ab)
                                              (:time 0 0))))
    ;; Nothing has the label, so nobody is abnormal.
    (is-false (ec:consistent-p (theory '(:completion (nothing ab)))))
    (always (inline-theory (:predicates (ab)) (:axioms (or (ab) (not (ab)))) (:time 0 0)
                           (:completion (nothing ab)))
      (not (ab)))))

(test completion-of-events
  (flet ((theory (&rest clauses)
           (ec::parse-theory
            'inline (append clauses '((:events (ring) (wake) (sleep))
                                      (:axioms
                                       (trigger :label delta (implies (happens (ring) ?time)
                                                                      (happens (wake) ?time))))
                                      (:narrative (once :label delta (happens (ring) 1))
                                                  (other :label epsilon (happens (sleep) 0)))
                                      (:time 0 3))))))
    (sometimes (theory) (happens (ring) 0) (happens (wake) 2))
    (always (theory '(:completion happens))
      (happens (wake) 1) (not (happens (wake) 0)) (happens (sleep) 0) (not (happens (sleep) 1)))
    (is-false (ec:consistent-p (theory '(:completion (delta happens))))
              "nothing with the label makes (sleep) happen")))

(test mutex-and-xor
  (flet ((theory (&rest clauses)
           (ec::parse-theory 'inline (append '((:sorts (hand left right))
                                               (:non-inertial-fluents (holding hand) (free))
                                               (:events (grasp hand) (wait))
                                               (:time 0 1))
                                             clauses))))
    (is (= 3 (ec:count-models (theory '(:mutex (grasp)) '(:axioms (not (happens (wait) ?time)))))))
    (is (= 4 (ec:count-models (theory '(:mutex (grasp wait))))))
    (is (= 3 (ec:count-models (theory '(:xor (grasp wait))))))
    (is (= 2 (ec:count-models (theory '(:xor (grasp)) '(:axioms (not (happens (wait) ?time)))))))
    (is (= 6 (ec:count-models (theory '(:mutex (grasp)) '(:xor (holding))
                                      '(:axioms (not (happens (wait) ?time)))
                                      '(:facts (holds-at (holding left) 0)))
                              :where '(holds-at (holding left) 0)))
        "mutex for events at 0, xor for fluents at 0 and at 1")
    (always (theory '(:xor (holding free)))
      (iff (holds-at (free) 1) (not (exists (?hand) (holds-at (holding ?hand) 1)))))))

(test several-exclusions
  (is (= 9 (ec:count-models (inline-theory (:events (a) (b) (c) (d)) (:mutex (a b) (c d))
                                           (:time 0 1))
                            :limit 99)))
  (is (= 4 (ec:count-models (inline-theory (:events (a) (b) (c) (d)) (:xor (a b) (c d))
                                           (:time 0 1))))))
