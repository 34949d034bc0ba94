;;;; A theory for each of the axiom schemas DEC1 to DEC12, whose answer changes without the schema.
;;;;
;;;; Source of the numbering: E. Mueller, Event calculus reasoning through satisfiability, 2004.
;;;; The docstring of a test says what would be open, or no longer excluded, without the schema.

(in-package #:discrepancy-finder.tests)

(def-suite schemas :in all)
(in-suite schemas)

(defmacro inline-theory (&body clauses)
  "Return the theory with CLAUSES, those of DEFINE-THEORY."
  `(ec::parse-theory 'inline ',clauses))

(defmacro always (theory &rest formulas)
  "Check that THEORY has a model and that each of FORMULAS holds in all of its models."
  `(check-always ,theory ',formulas))

(defmacro sometimes (theory &rest formulas)
  "Check that each of FORMULAS holds in a model of THEORY, and its negation in another."
  `(check-sometimes ,theory ',formulas))

(defun check-always (theory formulas)
  (is-true (ec:consistent-p theory) "no model")
  (dolist (form formulas)
    (is-true (ec:entailed-p theory form) "~a does not hold in all models" form)))

(defun check-sometimes (theory formulas)
  (dolist (form formulas)
    (is-true (ec:possible-p theory form) "~a is impossible" form)
    (is-true (ec:possible-p theory (list 'not form)) "~a holds in all models" form)))

(test dec1-stopped-in
  "StoppedIn would be open: the definition of interrupted would say nothing."
  (flet ((theory (time)
           (ec::parse-theory
            'inline `((:predicates (interrupted))
                      (:fluents (filling))
                      (:events (tap-off))
                      (:axioms (terminates (tap-off) (filling) ?time)
                               (iff (interrupted) (stopped-in 1 (filling) 3)))
                      (:narrative (at-some-time :label delta (happens (tap-off) ,time)))
                      (:completion (delta happens))
                      (:time 0 5)))))
    (always (theory 2) (interrupted))
    ;; Neither the first nor the last timepoint is between them.
    (always (theory 1) (not (interrupted)))
    (always (theory 3) (not (interrupted)))
    (always (theory 4) (not (interrupted)))))

(test dec2-started-in
  "StartedIn would be open."
  (flet ((theory (time)
           (ec::parse-theory
            'inline `((:predicates (interrupted))
                      (:fluents (filling))
                      (:events (tap-on) (tap-off))
                      (:axioms (initiates (tap-on) (filling) ?time)
                               (terminates (tap-off) (filling) ?time)
                               (iff (interrupted) (started-in 1 (filling) 3)))
                      (:narrative (at-some-time :label delta (happens (tap-on) ,time))
                                  (at-the-end :label delta (happens (tap-off) 4)))
                      (:completion (delta happens))
                      (:time 0 5)))))
    (always (theory 2) (interrupted))
    (always (theory 0) (not (interrupted)))
    (always (theory 1) (not (interrupted)))
    (always (theory 3) (not (interrupted)))))

(defparameter *lift*
  '((:sorts (height (:range 0 9)))
    (:fluents (rising))
    (:non-inertial-fluents (height height))
    (:events (start) (stop))
    (:axioms
     (implies (and (holds-at (height ?height1) ?time) (holds-at (height ?height2) ?time))
              (= ?height1 ?height2)))
    (:completion happens)
    (:time 0 5))
  "A lift whose height only trajectories determine.")

(defun lift (&rest clauses)
  (ec::parse-theory 'lift `(,@*lift* (:axioms (initiates (start) (rising) ?time)
                                              (terminates (stop) (rising) ?time))
                                     ,@clauses)))

(test dec3-trajectory
  "Without it no height after the start would follow."
  (let ((theory (lift '(:axioms (implies (holds-at (height ?height) ?time)
                                 (trajectory (rising) ?time (height (+ ?height ?offset))
                                  ?offset)))
                      '(:facts (holds-at (height 2) 1) (not (holds-at (rising) 0)))
                      '(:narrative (happens (start) 1) (happens (stop) 3)))))
    (always theory (holds-at (height 3) 2) (holds-at (height 4) 3))
    ;; Stopping at 3 does not stop what the trajectory says of 3, but of 4.
    (sometimes theory (holds-at (height 5) 4) (holds-at (height 2) 0))))

(test dec4-anti-trajectory
  "Without it no height after stopping would follow."
  (let ((theory (lift '(:axioms (implies (holds-at (height ?height) ?time)
                                 (anti-trajectory (rising) ?time (height (- ?height ?offset))
                                  ?offset)))
                      '(:facts (holds-at (height 9) 1) (holds-at (rising) 0))
                      '(:narrative (happens (stop) 1) (happens (start) 3)))))
    (always theory (holds-at (height 8) 2) (holds-at (height 7) 3) (not (holds-at (height 9) 2)))
    (sometimes theory (holds-at (height 6) 4) (holds-at (height 9) 0)))
  ;; A fluent that is false without having been terminated has no antitrajectory.
  (sometimes (lift '(:axioms (anti-trajectory (rising) ?time (height 1) ?offset))
                   '(:facts (not (holds-at (rising) 0))))
    (holds-at (height 1) 1)))

;; Effects at certain timepoints only take part in trajectories, too.
(test trajectories-of-dated-effects
  (flet ((theory (start stop)
           (ec::parse-theory
            'lift `(,@*lift*
                    (:axioms (implies ,start (initiates (start) (rising) ?time))
                             (implies ,stop (terminates (stop) (rising) ?time))
                             (implies (holds-at (height ?height) ?time)
                                      (trajectory (rising) ?time (height (+ ?height ?offset))
                                                  ?offset)))
                    (:facts (holds-at (height 0) 1) (not (holds-at (rising) 0)))
                    (:narrative (happens (start) 1) (happens (stop) 3))))))
    (always (theory '(= ?time 1) '(< ?time 2)) (holds-at (height 3) 4) (holds-at (height 4) 5))
    (always (theory '(= ?time 1) '(= ?time 3)) (holds-at (height 2) 3))
    (sometimes (theory '(= ?time 1) '(= ?time 3)) (holds-at (height 3) 4))
    (sometimes (theory '(/= ?time 1) '(= ?time 3)) (holds-at (height 1) 2))))

(defparameter *lamp-on*
  '((:fluents (lit))
    (:events (switch-on) (switch-off) (shake))
    (:axioms
     (initiates (switch-on) (lit) ?time)
     (terminates (switch-off) (lit) ?time)
     (releases (shake) (lit) ?time))
    (:completion happens)
    (:time 0 4))
  "A lamp with one fluent and an event for each kind of effect.")

(defun lamp-on (&rest clauses)
  (ec::parse-theory 'lamp-on (append *lamp-on* clauses)))

(test dec5-truth-persists
  "What holds could end without a reason."
  (always (lamp-on '(:facts (holds-at (lit) 0)))
    (holds-at (lit) 1) (holds-at (lit) 4))
  (is (= 1 (ec:count-models (lamp-on '(:facts (holds-at (lit) 0)))))))

(test dec6-falsity-persists
  "What does not hold could begin without a reason."
  (always (lamp-on '(:facts (not (holds-at (lit) 0))))
    (not (holds-at (lit) 1)) (not (holds-at (lit) 4)))
  (is (= 1 (ec:count-models (lamp-on '(:facts (not (holds-at (lit) 0))))))))

(test dec7-release-persists
  "A released fluent could become inertial by itself, and there would be more models."
  (let ((theory (lamp-on '(:facts (holds-at (lit) 0)) '(:narrative (happens (shake) 1)))))
    (always theory (released-at (lit) 2) (released-at (lit) 3) (released-at (lit) 4))
    (sometimes theory (holds-at (lit) 2) (holds-at (lit) 3)
      (and (holds-at (lit) 2) (not (holds-at (lit) 3)) (holds-at (lit) 4)))
    (is (= 8 (ec:count-models theory)))))

(test dec8-not-being-released-persists
  "An inertial fluent could become released by itself, and then change."
  (always (lamp-on '(:facts (holds-at (lit) 0)) '(:narrative (happens (shake) 2)))
    (not (released-at (lit) 1)) (not (released-at (lit) 2)) (holds-at (lit) 2)))

(test dec9-initiation
  "The lamp could stay dark, by DEC6 only what is initiated can begin."
  (always (lamp-on '(:facts (not (holds-at (lit) 0))) '(:narrative (happens (switch-on) 1)))
    (not (holds-at (lit) 1)) (holds-at (lit) 2) (holds-at (lit) 4)))

(test dec10-termination
  "The lamp could stay lit."
  (always (lamp-on '(:facts (holds-at (lit) 0)) '(:narrative (happens (switch-off) 1)))
    (holds-at (lit) 1) (not (holds-at (lit) 2)) (not (holds-at (lit) 4))))

(test dec11-release
  "The lamp would stay inertial, by DEC8 only what an event releases can be released."
  (let ((theory (lamp-on '(:facts (holds-at (lit) 0)) '(:narrative (happens (shake) 0)))))
    (always theory (not (released-at (lit) 0)) (released-at (lit) 1))
    (sometimes theory (holds-at (lit) 1))))

(test dec12-capture
  "A released fluent that is initiated or terminated would stay released, and be open afterwards."
  (dolist (event '((switch-on) (switch-off)))
    (let ((theory (lamp-on '(:facts (holds-at (lit) 0))
                           `(:narrative (happens (shake) 0) (happens ,event 1)))))
      (always theory (released-at (lit) 1) (not (released-at (lit) 2)) (not (released-at (lit) 4))
        (iff (holds-at (lit) 2) (holds-at (lit) 3)) (iff (holds-at (lit) 3) (holds-at (lit) 4)))
      (sometimes theory (holds-at (lit) 1))
      (is (= 2 (ec:count-models theory))))))

(test an-effect-is-its-completed-definition
  "Effects are circumscribed: an event has those that follow from the axioms and no others."
  (let ((theory (inline-theory
                  (:fluents (lit) (noisy))
                  (:events (switch-on))
                  (:axioms (implies (holds-at (noisy) ?time)
                                    (initiates (switch-on) (lit) ?time)))
                  (:narrative (happens (switch-on) 0))
                  (:completion happens)
                  (:time 0 1))))
    (always theory
      (implies (not (holds-at (lit) 0)) (iff (holds-at (lit) 1) (holds-at (noisy) 0)))
      (iff (holds-at (noisy) 0) (holds-at (noisy) 1)))))
