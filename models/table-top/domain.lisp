;;;; The domain of a search on a table: how the theory's words map to the scene, and what the
;;;; motions of a plan mean in the theory.

(in-package #:discrepancy-finder-user)

(define-abstraction table-top
  "The sides of the table bound x only, for what is on it and for the robot before it.  The robot
faces the table give or take 0.1 rad.  The cereal is in front, turned anyhow, the cup behind."
  (:theory "theory.lisp")
  (:scene "scene.lisp")
  (:region left (interval :x 0 0.8))
  (:region right (interval :x 1.2 2))
  (:placement (robot-at ?side) :body robot
              :coordinates (x (y -0.05 0.05) (yaw 1.47 1.67)))
  (:placement (cereal-on ?side) :body cereal
              :coordinates (x (y 0.6 0.7) (yaw -3.14159 3.14159)))
  (:placement (cup-on ?side) :body cup
              :coordinates (x (y 0.95 1.05))))

(define-action (motion going) (pose target)
  (:domain table-top)
  (:event (go (region-of (or pose target)))))

(define-action (motion looking) (pose target)
  (:domain table-top)
  (:event (look (region-of (or pose target)))))

(define-action (motion detecting) (object)
  (:domain table-top)
  (:event (detect (desig-prop-value object :type)))
  (:requires (exists (?side)
               (and (looking-at ?side)
                    (or (and (= (desig-prop-value object :type) cereal) (cereal-on ?side))
                        (and (= (desig-prop-value object :type) cup) (cup-on ?side))))))
  (:failure perception-object-not-found)
  (:returns object))
