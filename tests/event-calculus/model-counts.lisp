;;;; What decides the number of models of a theory.
;;;;
;;;; The Discrete Event Calculus Reasoner works on ground instances: some are dropped, what no
;;;; instance mentions is no atom, and completion takes ground clauses.  INLINE-THEORY, ALWAYS and
;;;; SOMETIMES are in schemas.lisp, ALL-MODELS in scenario-checks.lisp.

(in-package #:discrepancy-finder.tests)

(def-suite model-counts :in all)
(in-suite model-counts)

(test instances-outside-of-ranges-are-dropped
  (let ((theory (inline-theory
                  (:sorts (floor (:range 1 3)))
                  (:non-inertial-fluents (lift-at floor) (alarm))
                  (:axioms (implies (holds-at (alarm) ?time)
                                    (holds-at (lift-at (- ?floor 1)) ?time))
                           (implies (holds-at (lift-at 3) ?time)
                                    (exists (?floor) (holds-at (lift-at (+ ?floor 2)) ?time))))
                  (:facts (holds-at (alarm) 0))
                  (:time 0 0))))
    (always theory (holds-at (lift-at 1) 0) (holds-at (lift-at 2) 0))
    (is (= 2 (ec:count-models theory)))
    (sometimes theory (holds-at (lift-at 3) 0))))

(test no-event-happens-at-the-last-timepoint
  (let ((theory (inline-theory
                  (:fluents (f))
                  (:events (e))
                  (:axioms (implies (holds-at (f) ?time) (happens (e) ?time)))
                  (:facts (holds-at (f) 0))
                  (:time 0 2))))
    (is (equal '("Happens(E,0) Happens(E,1) HoldsAt(F,0) HoldsAt(F,1) HoldsAt(F,2)")
               (all-models theory)))))

(test atoms-that-nothing-mentions-are-not-counted
  (let ((theory (inline-theory
                  (:predicates (idle) (busy))
                  (:non-inertial-fluents (unmentioned) (mentioned))
                  (:events (nothing))
                  (:axioms (or (busy) (holds-at (mentioned) ?time)))
                  (:time 0 1))))
    ;; busy, and mentioned at 0 and at 1: 4 models with busy, 1 without.
    (is (= 5 (ec:count-models theory)))))

(test completion-takes-all-sentences-with-its-label
  "A definition of a predicate by an event is a sentence that supports the event."
  (flet ((theory (completion)
           (ec::parse-theory
            'bell `((:predicates (noise))
                    (:events (ring) (knock))
                    (:axioms (iff (noise) (happens (ring) 1))
                             (knocking :label delta (happens (knock) 0)))
                    (:completion ,completion)
                    (:time 0 2)))))
    (is (= 1 (ec:count-models (theory '(delta happens)))))
    (always (theory '(delta happens)) (not (noise)))
    (is (= 2 (ec:count-models (theory 'happens))))
    (sometimes (theory 'happens) (noise))
    (always (theory 'happens) (happens (knock) 0) (not (happens (knock) 1)))))
