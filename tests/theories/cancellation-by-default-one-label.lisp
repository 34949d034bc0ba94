;;;; Two abnormality predicates that are completed over the same sentences.
;;;;
;;;; Source: as cancellation-by-default; a test of completion.
;;;; Expected: 4 models, not the 1 of circumscription.  Completion is done on ground clauses, which
;;;; have no heads: old battery -> ab1 or ab2 is a clause that supports either atom, if both
;;;; predicates are completed over its label.  So at each of the 2 timepoints the old device is
;;;; abnormal in one respect or in the other; at 0 that decides whether it is on at 1.

(define-theory cancellation-by-default-one-label
  "The theory cancellation-by-default with one label."
  (:sorts (device new-one old-one mended-one))
  (:predicates (ab1 device time) (ab2 device time))
  (:fluents (on device) (old-battery device) (mended device))
  (:events (turn-on device))
  (:axioms
   (implies (not (ab1 ?device ?time)) (initiates (turn-on ?device) (on ?device) ?time))
   (cancellation :label theta
    (implies (and (holds-at (old-battery ?device) ?time) (not (ab2 ?device ?time)))
             (ab1 ?device ?time)))
   (cancellation-of-the-cancellation :label theta
    (implies (holds-at (mended ?device) ?time) (ab2 ?device ?time))))
  (:facts
   (not (holds-at (on ?device) 0))
   (iff (holds-at (old-battery ?device) 0) (/= ?device new-one))
   (iff (holds-at (mended ?device) 0) (= ?device mended-one)))
  (:narrative (switching :label delta (happens (turn-on ?device) 0)))
  (:completion (delta happens) (theta ab1) (theta ab2))
  (:time 0 1))
