;;;; Things are where they usually are, unless they are lent.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default reasoning about state.
;;;; Expected: 1 model.  The television is in the living room by default, where Nathan is, so that
;;;; he can turn it on; the radio is lent, hence abnormal, and was seen in the bedroom, so that his
;;;; turning it on has no effect.

(define-theory default-location
  "A default about the first timepoint."
  (:sorts (object) (agent (:parent object) nathan) (device (:parent object) television radio)
          (room living-room bedroom))
  (:functions ((usual-room device) room))
  (:predicates (ab1 device time) (lent device))
  (:fluents (in-room object room) (on device))
  (:events (turn-on agent device))
  (:axioms
   (usually
    (implies (not (ab1 ?device 0)) (holds-at (in-room ?device (usual-room ?device)) 0)))
   (lent-is-abnormal :label theta (implies (lent ?device) (ab1 ?device 0)))
   (implies (and (holds-at (in-room ?object ?room1) ?time)
                 (holds-at (in-room ?object ?room2) ?time))
            (= ?room1 ?room2))
   (implies (exists (?room) (and (holds-at (in-room ?agent ?room) ?time)
                                 (holds-at (in-room ?device ?room) ?time)))
            (initiates (turn-on ?agent ?device) (on ?device) ?time)))
  (:facts
   (= (usual-room television) living-room)
   (= (usual-room radio) living-room)
   (lent radio)
   (not (lent television))
   (holds-at (in-room radio bedroom) 0)
   (holds-at (in-room nathan living-room) 0)
   (not (holds-at (on ?device) 0)))
  (:narrative
   (first-switch :label delta (happens (turn-on nathan television) 0))
   (second-switch :label delta (happens (turn-on nathan radio) 0)))
  (:completion (delta happens) (theta ab1))
  (:time 0 1))
