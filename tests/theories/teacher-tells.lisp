;;;; A teacher tells a topic to all who are in the room.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, exercises (an existential condition of an
;;;; effect).
;;;; Expected: 1 model; Ann, who is in the classroom, knows the topic at 1; Ben, in the yard, does
;;;; not.

(define-theory teacher-tells
  "The effect has a condition that there is a room with both in it."
  (:sorts (agent) (teacher (:parent agent) miss-jones) (student (:parent agent) ann ben)
          (room classroom yard) (topic fractions))
  (:fluents (in-room agent room) (know agent topic))
  (:events (tell teacher topic))
  (:axioms
   (implies (exists (?room) (and (holds-at (in-room ?teacher ?room) ?time)
                                 (holds-at (in-room ?student ?room) ?time)))
            (initiates (tell ?teacher ?topic) (know ?student ?topic) ?time)))
  (:facts
   (iff (holds-at (in-room ?agent ?room) 0)
        (or (and (/= ?agent ben) (= ?room classroom)) (and (= ?agent ben) (= ?room yard))))
   (iff (holds-at (know ?agent ?topic) 0) (= ?agent miss-jones)))
  (:narrative (happens (tell miss-jones fractions) 0))
  (:completion happens)
  (:time 0 1))
