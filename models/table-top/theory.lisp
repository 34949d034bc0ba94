;;;; A search on a table as a theory of the Discrete Event Calculus: a robot, two items, two sides.
;;;;
;;;; This file is data: reading it evaluates nothing.

(define-theory table-top
  "A robot that looks for an item on a table.  The model knows the left and the right side of the
table and nothing of angles, of distances, and of what hides what: an item is seen if it is on the
side that the robot looks at, wherever on it, and from nowhere else."
  (:sorts (side left right) (item cereal cup))
  (:fluents (robot-at side) (looking-at side) (cereal-on side) (cup-on side) (seen item))
  (:events (go side) (look side) (detect item))
  (:axioms
   ;; At the beginning the cereal can be on either side.
   (robot-starts-at-the-left (initially (robot-at left)))
   (cup-starts-on-the-left (initially (cup-on left)))
   (camera-starts-elsewhere (initially (not (looking-at ?side))))
   (nothing-seen-yet (initially (not (seen ?item))))

   ;; Everything is in one place.
   (robot-somewhere (exists (?side) (holds-at (robot-at ?side) ?time)))
   (robot-at-one-side
    (implies (and (holds-at (robot-at ?side1) ?time) (holds-at (robot-at ?side2) ?time))
             (= ?side1 ?side2)))
   (cereal-somewhere (exists (?side) (holds-at (cereal-on ?side) ?time)))
   (cereal-on-one-side
    (implies (and (holds-at (cereal-on ?side1) ?time) (holds-at (cereal-on ?side2) ?time))
             (= ?side1 ?side2)))
   (cup-somewhere (exists (?side) (holds-at (cup-on ?side) ?time)))
   (cup-on-one-side
    (implies (and (holds-at (cup-on ?side1) ?time) (holds-at (cup-on ?side2) ?time))
             (= ?side1 ?side2)))
   (camera-looks-at-one-side
    (implies (and (holds-at (looking-at ?side1) ?time) (holds-at (looking-at ?side2) ?time))
             (= ?side1 ?side2)))

   ;; Going.  The camera goes along, and looks at something else then.
   (go-arrives (initiates (go ?side) (robot-at ?side) ?time))
   (go-leaves
    (implies (/= ?side1 ?side2)
             (terminates (go ?side1) (robot-at ?side2) ?time)))
   (go-looks-away (terminates (go ?side1) (looking-at ?side2) ?time))

   ;; Looking.
   (look-points (initiates (look ?side) (looking-at ?side) ?time))
   (look-turns-away
    (implies (/= ?side1 ?side2)
             (terminates (look ?side1) (looking-at ?side2) ?time)))

   ;; Detecting.
   (detect-sees (initiates (detect ?item) (seen ?item) ?time))
   (cereal-seen-where-it-is
    (implies (happens (detect cereal) ?time)
             (exists (?side) (and (holds-at (looking-at ?side) ?time)
                                  (holds-at (cereal-on ?side) ?time)))))
   (cup-seen-where-it-is
    (implies (happens (detect cup) ?time)
             (exists (?side) (and (holds-at (looking-at ?side) ?time)
                                  (holds-at (cup-on ?side) ?time)))))))

(define-state-constraint object-found (?time)
  "An item is seen after a detecting motion."
  (exists (?item) (and (happens (detect ?item) ?time)
                       (holds-at (seen ?item) (+ ?time 1)))))
