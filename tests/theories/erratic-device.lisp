;;;; An erratic device is turned on: it works or it does not.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default reasoning.
;;;; Expected: 2 models, by the determining fluent at 0.  It also decides the abnormality at 1,
;;;; where the completed sentence has an instance, too, so it is fixed there.

(define-theory erratic-device
  "An erratic device is abnormal where a free fluent says so."
  (:sorts (agent nathan) (device device1))
  (:predicates (ab1 device time))
  (:fluents (on device) (erratic device))
  (:non-inertial-fluents (fails device))
  (:events (turn-on agent device))
  (:axioms
   (implies (not (ab1 ?device ?time))
            (initiates (turn-on ?agent ?device) (on ?device) ?time))
   (erratic-may-be-abnormal :label theta
    (implies (and (holds-at (erratic ?device) ?time) (holds-at (fails ?device) ?time))
             (ab1 ?device ?time))))
  (:facts
   (not (holds-at (on ?device) 0))
   (holds-at (erratic ?device) 0)
   (holds-at (fails ?device) 1))
  (:narrative
   (switching :label delta (happens (turn-on nathan device1) 0)))
  (:completion (delta happens) (theta ab1))
  (:time 0 1))
