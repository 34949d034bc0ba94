;;;; A broken device is turned on: a default effect that is qualified.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default reasoning (abnormality
;;;; predicates after J. McCarthy 1986).
;;;; Expected: 1 model.  The television is broken, so turning it on has no effect; the radio is on
;;;; at 1.  By completion a device is abnormal exactly where a sentence labelled theta says so.

(define-theory broken-device
  "By default, what is turned on is on."
  (:sorts (agent nathan) (device television radio))
  (:predicates (ab1 device time))
  (:fluents (on device) (broken device) (plugged-in device))
  (:events (turn-on agent device))
  (:axioms
   (implies (not (ab1 ?device ?time))
            (initiates (turn-on ?agent ?device) (on ?device) ?time))
   (broken-is-abnormal :label theta
    (implies (holds-at (broken ?device) ?time) (ab1 ?device ?time)))
   (unplugged-is-abnormal :label theta
    (implies (not (holds-at (plugged-in ?device) ?time)) (ab1 ?device ?time))))
  (:facts
   (not (holds-at (on ?device) 0))
   (holds-at (plugged-in ?device) 0)
   (holds-at (broken television) 0)
   (not (holds-at (broken radio) 0)))
  (:narrative
   (first-switch :label delta (happens (turn-on nathan television) 0))
   (second-switch :label delta (happens (turn-on nathan radio) 0)))
  (:completion (delta happens) (theta ab1))
  (:time 0 1))
