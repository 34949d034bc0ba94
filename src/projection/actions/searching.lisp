;;;; The action searching: find an object at a location.

(in-package #:discrepancy-finder.projection)

(def-cram-function search-at (?object ?location ?other-poses)
  "Look for the object ?OBJECT at the location ?LOCATION from where this can be seen, from
?OTHER-POSES further places if need be, and return its new designator."
  (let ((?robot-location (a location (visible-for robot) (location ?location))))
    (with-retry-counters ((other-poses ?other-poses))
      (with-failure-handling
          (((or perception-low-level-failure navigation-low-level-failure
                navigation-high-level-failure looking-high-level-failure)
               ()
             (do-retry other-poses
               (let ((next (next-location ?robot-location)))
                 (when next
                   (setf ?robot-location next)
                   (retry))))))
        (perform (an action (type navigating) (location ?robot-location)))
        (perform (an action (type turning-towards) (target ?location)))
        (perform (an action (type detecting) (object ?object)))))))

(def-cram-function search-for-object (?object ?location &optional (?retries 9))
  "Look for the object ?OBJECT at the solutions of the location ?LOCATION, at most at ?RETRIES after
the first, from three places each, and return its new designator."
  (with-retry-counters ((search-retries ?retries))
    (with-failure-handling
        (((or perception-low-level-failure navigation-low-level-failure
              navigation-high-level-failure looking-high-level-failure)
             (failure)
           (do-retry search-retries
             (let ((next (next-location ?location)))
               (when next
                 (setf ?location next)
                 (retry))))
           (fail 'object-nowhere-to-be-found
                 :object ?object :description (failure-description failure))))
      (search-at ?object ?location 2))))
