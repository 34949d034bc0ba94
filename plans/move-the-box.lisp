;;;; Example 1 of the paper: fetch the box from region r2 and bring it to region r1.

(in-package #:discrepancy-finder-user)

(def-cram-function drive-to (?goal-pose)
  "Drive to ?GOAL-POSE; try once more if the base does not get there."
  (with-retry-counters ((retries 1))
    (with-failure-handling
        ((navigation-low-level-failure ()
           (do-retry retries
             (retry))))
      (perform (a motion (type going) (pose ?goal-pose))))))

(def-top-level-cram-function move-the-box ()
  "Drive to the middle of r2, pick up the box, drive back to the middle of r1, place the box there."
  (let ((?box (an object (type box)))
        (?target-pose (make-pose 0.5 0.4 0.46)))
    (drive-to (make-pose 1.5 0 0))
    (perform (an action (type picking-up) (object ?box)))
    (drive-to (make-pose 0.5 0 0))
    (perform (an action (type placing)
                 (object ?box)
                 (target (a location (pose ?target-pose)))))))
