;;;; A default whose exception is itself a default, with an exception of its own.
;;;;
;;;; Source: J. McCarthy, Applications of circumscription to formalizing common-sense knowledge,
;;;; 1986 (birds, ostriches); E. Mueller, Commonsense Reasoning, 2006, chapter 12, on cancellation.
;;;; Expected: 1 model.  A device works when it is turned on, unless abnormal; one with an old
;;;; battery is abnormal, unless that is abnormal, which a mended one is.  So of three devices the
;;;; new one and the mended one are on at 1, the old one is not.  Each abnormality is completed over
;;;; sentences with a label of its own; cancellation-by-default-one-label shows what happens
;;;; otherwise.

(define-theory cancellation-by-default
  "Abnormality of the second degree."
  (:sorts (device new-one old-one mended-one))
  (:predicates (ab1 device time) (ab2 device time))
  (:fluents (on device) (old-battery device) (mended device))
  (:events (turn-on device))
  (:axioms
   (implies (not (ab1 ?device ?time)) (initiates (turn-on ?device) (on ?device) ?time))
   (cancellation :label theta
    (implies (and (holds-at (old-battery ?device) ?time) (not (ab2 ?device ?time)))
             (ab1 ?device ?time)))
   (cancellation-of-the-cancellation :label theta2
    (implies (holds-at (mended ?device) ?time) (ab2 ?device ?time))))
  (:facts
   (not (holds-at (on ?device) 0))
   (iff (holds-at (old-battery ?device) 0) (/= ?device new-one))
   (iff (holds-at (mended ?device) 0) (= ?device mended-one)))
  (:narrative (switching :label delta (happens (turn-on ?device) 0)))
  (:completion (delta happens) (theta ab1) (theta2 ab2))
  (:time 0 1))
