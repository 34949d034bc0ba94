;;;; Progressed states: numbers, models, the same future.

(in-package #:discrepancy-finder.tests)

(in-suite progression-features)

;;; Numbers

(test numeric-fluents-are-progressed
  (let* ((ground (ground-clauses
                  '(:fluents (falling)) '(:numeric-fluents (height) (bounces))
                  '(:events (drop) (hit))
                  '(:axioms (initiates (drop) (falling) ?time) (terminates (hit) (falling) ?time)
                    (releases (drop) (height) ?time)
                    (assigns (hit) (height) 0 ?time)
                    (assigns (hit) (bounces) (+ (value-at (bounces) ?time) 1/2) ?time)
                    (trajectory (falling) ?time
                     (= (height) (- (value-at (height) ?time) (* ?offset ?offset))) ?offset)
                    (implies (and (holds-at (falling) ?time) (<= (value-at (height) ?time) 0))
                     (happens (hit) ?time))
                    (never-far-below (<= -5 (value-at (height) ?time))))))
         (state (ec:concrete-state ground (constantly nil)
                                   :number-of (lambda (atom) (if (equal atom '(:height)) 7 1))))
         (heights '()) (allowed t))
    (dolist (event '((drop) nil nil nil nil))
      (multiple-value-bind (next conditions)
          (ec:progress state (ec:event-number ground event))
        (push (ec:number-value next '(height)) heights)
        (setf state next
              allowed (and allowed (every #'cdr conditions)))))
    (is (equal '(6 3 -2 0 0) (reverse heights)))
    (is-true allowed)
    (is (= 3/2 (ec:number-value state '(bounces))))
    (signals-with (ec:undetermined "the number of (height) at 0")
      (ec:concrete-state ground (constantly nil)))))

(test unknown-numbers-are-terms
  (let ((ground (ground-clauses
                 '(:fluents (full)) '(:numeric-fluents (level)) '(:events (pour) (double))
                 '(:axioms (assigns (pour) (level) (+ (value-at (level) ?time) 3) ?time)
                   (assigns (double) (level) (* 2 (value-at (level) ?time)) ?time)
                   (implies (>= (value-at (level) ?time) 10) (initiates (pour) (full) ?time))
                   (<= (value-at (level) ?time) 20)))))
    (z3:with-context (context)
      (z3:with-solver (solver context :logic nil)
        (let ((state (ec:concrete-state ground (constantly nil) :context context)))
          (assume-all solver (ec:initial-conditions state))
          (flet ((check (&rest propositions) (z3:check solver propositions)))
            (let ((level (ec:number-value state '(level))))
              (multiple-value-bind (next conditions)
                  (ec:progress state (list (ec:find-event ground '(pour))
                                           (ec:find-event ground '(double))))
                (assume-all solver conditions)
                (is (eq :sat (check)))
                (is (eq :unsat (check (z3:negation (z3:equals 3 level))))
                    "both events assign the same number at 3 only")
                (is (eq :unsat (check (ec:fluent-value next '(full)))))
                (is (eq :unsat (check (z3:negation
                                       (z3:equals 6 (ec:number-value next '(level)))))))))))))))

;;; States

(test states-in-a-model
  (let ((ground (ground-clauses
                 '(:fluents (heads) (tossed)) '(:events (toss))
                 '(:axioms (releases (toss) (heads) ?time) (initiates (toss) (tossed) ?time)
                   (implies (and (holds-at (heads) ?time) (holds-at (tossed) ?time))
                            (holds-at (heads) (+ ?time 1)))))))
    (z3:with-context (context)
      (let* ((first (ec:concrete-state ground (constantly nil) :context context))
             (second (ec:progress first (ec:find-event ground '(toss))))
             (states (list (ec:state-in-model first #'identity) )))
        (push (ec:state-in-model second (constantly t) (first states)) states)
        (is (equal '((:heads) (:tossed)) (ec:state-fluents (first states))))
        (is (eq (second states) (ec:state-predecessor (first states))))
        (is (equal '(((:toss) . t)) (ec:state-happenings (first states))))
        (is-false (ec:state-context (first states)))
        (signals ec:undetermined (ec:progress (first states) nil))))))

(test states-with-the-same-future
  (flet ((futures (&rest axioms)
           (let* ((ground (ground-clauses '(:fluents (f) (g)) '(:events (a) (b))
                                          (cons :axioms (append '((initiates (a) (f) ?time)
                                                                  (initiates (b) (f) ?time))
                                                                axioms))))
                  (state (ec:concrete-state ground (constantly nil))))
             (flet ((after (&rest events)
                      (let ((state state))
                        (dolist (event events state)
                          (setf state (ec:progress state (ec:event-number ground event)))))))
               (list (ec:same-future-p (after '(a)) (after '(a)))
                     (ec:same-future-p (after '(a)) (after '(b)))
                     (ec:same-future-p (after '(a)) (after nil))
                     (ec:same-future-p (after '(a)) (after '(a) nil)))))))
    (is (equal '(t t nil nil) (futures)))
    (is (equal '(t nil nil nil)
               (futures '(implies (happens (a) ?time) (not (holds-at (g) (+ ?time 2)))))))))

(test preconditions-are-looked-at-where-their-event-happens
  "The outline of the household: one fluent is read by few demands, one event by its own."
  (let* ((ground (lamp-ground)) (outline (ec::ground-outline ground)))
    (is (eq outline (ec::ground-outline ground)) "it is computed once")
    (is (= 1 (length (svref (ec::outline-event-demands-of outline)
                            (ec:find-event ground '(smash a))))))
    (is (null (svref (ec::outline-event-demands-of outline) (ec:find-event ground '(toggle a)))))
    (is (= 1 (length (svref (ec::outline-state-demands-of outline)
                            (ec:find-fluent ground '(lit a))))))
    (is (null (svref (ec::outline-state-demands-of outline) (ec:find-fluent ground '(dark)))))
    (is (null (ec::outline-other-demands outline)))))
