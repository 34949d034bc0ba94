;;;; The actions fetching and delivering: get hold of an object, bring it to a location.

(in-package #:discrepancy-finder.projection)

(def-cram-function pick-up-perceived (?object ?arm ?pick-up-action)
  "Turn to the object ?OBJECT, perceive it once more and pick it up, with ?ARM if that is not NIL,
or as the designator ?PICK-UP-ACTION says.  If the fingers close on nothing try that once more.
Return the object's new designator."
  (with-retry-counters ((regrasps 1))
    (with-failure-handling
        ((gripper-low-level-failure (failure)
           (do-retry regrasps
             (retry))
           (fail 'object-unreachable
                 :object ?object :description (failure-description failure))))
      (perform (an action (type turning-towards) (target ?object)))
      (let ((?perceived (perform (an action (type detecting) (object ?object)))))
        (if ?pick-up-action
            (perform ?pick-up-action)
            (perform (an action (type picking-up) (object ?perceived)
                         (when ?arm (arm ?arm)))))
        ?perceived))))

(def-cram-function fetch (?object ?arm ?robot-location ?pick-up-action)
  "Go where the object ?OBJECT, which was perceived, can be reached, at first to ?ROBOT-LOCATION if
that is not NIL, and pick it up.  Go to another place, up to ten times, where this does not succeed.
Return the object's new designator."
  (let ((?robot-location (or ?robot-location
                             (a location (reachable-for robot) (object ?object)
                                (when ?arm (arm ?arm))))))
    (with-retry-counters ((relocations 10))
      (with-failure-handling
          (((or navigation-low-level-failure navigation-high-level-failure
                looking-high-level-failure perception-low-level-failure object-unreachable
                manipulation-low-level-failure)
               (failure)
             (do-retry relocations
               (let ((next (next-location ?robot-location)))
                 (when next
                   (setf ?robot-location next)
                   (retry))))
             (fail 'object-unfetchable
                   :object ?object :description (failure-description failure))))
        (perform (an action (type navigating) (location ?robot-location)))
        (pick-up-perceived ?object ?arm ?pick-up-action)))))

;;; Delivering

(def-cram-function deliver-to (?object ?target ?robot-location ?place-action)
  "Bring the object ?OBJECT, which the robot holds, to the location ?TARGET, by ?PLACE-ACTION if
that is not NIL, from ?ROBOT-LOCATION or another place where this can be reached, up to five more."
  (let ((?robot-location (or ?robot-location
                             (a location (reachable-for robot) (location ?target)))))
    (with-retry-counters ((relocations 5))
      (with-failure-handling
          (((or navigation-low-level-failure navigation-high-level-failure
                looking-high-level-failure manipulation-goal-not-reached
                manipulation-pose-unreachable)
               (failure)
             (do-retry relocations
               (let ((next (next-location ?robot-location)))
                 (when next
                   (setf ?robot-location next)
                   (retry))))
             (fail 'object-undeliverable
                   :object ?object :description (failure-description failure))))
        (perform (an action (type navigating) (location ?robot-location)))
        (perform (an action (type turning-towards) (target ?target)))
        (if ?place-action
            (perform ?place-action)
            (perform (an action (type placing) (object ?object) (target ?target))))))))

(def-cram-function deliver (?object ?target ?robot-location ?place-action)
  "Bring the object ?OBJECT, which the robot holds, to the location ?TARGET; where this does not
succeed, to the next two solutions of ?TARGET.  What was lost on the way is not looked for."
  (with-retry-counters ((other-targets 2))
    (with-failure-handling
        ((object-undeliverable ()
           (do-retry other-targets
             (let ((next (next-location ?target)))
               (when next
                 (setf ?target next
                       ?robot-location nil)
                 (retry)))))
         (gripper-low-level-failure (failure)
           (fail 'object-undeliverable
                 :object ?object :description (failure-description failure))))
      (deliver-to ?object ?target ?robot-location ?place-action))))
