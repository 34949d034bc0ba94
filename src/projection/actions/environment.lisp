;;;; The actions accessing and sealing: open and close what a location is in.

(in-package #:discrepancy-finder.projection)

(def-cram-function manipulate-environment (?type ?container ?arm ?distance)
  "Go where ?CONTAINER, an object designator, can be reached and open or close it by ?DISTANCE (m),
as the action ?TYPE, opening or closing, says.  Go to another place, up to ten times, where this
does not succeed."
  (let ((?robot-location (a location (reachable-for robot) (object ?container)
                            (when ?arm (arm ?arm)))))
    (with-retry-counters ((relocations 10))
      (with-failure-handling
          (((or navigation-low-level-failure navigation-high-level-failure
                environment-unreachable manipulation-low-level-failure)
               (failure)
             (do-retry relocations
               (let ((next (next-location ?robot-location)))
                 (when next
                   (setf ?robot-location next)
                   (retry))))
             (fail 'environment-manipulation-impossible
                   :description (failure-description failure))))
        (perform (an action (type navigating) (location ?robot-location)))
        (perform (an action (type ?type) (object ?container)
                     (when ?arm (arm ?arm))
                     (when ?distance (distance ?distance))))))))
