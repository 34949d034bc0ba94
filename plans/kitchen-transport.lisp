;;;; Pick and place in the kitchen: an object is carried from the workspace to the dining table.

(in-package #:discrepancy-finder-user)

(defun height-on-the-table (type)
  "Return the height (m) at which the centre of an object of TYPE is when it stands on the table."
  (+ 0.755 (ecase type
             (:milk 0.097)
             (:cereal 0.112)
             (:bowl 0.0335)
             (:spoon 0.0095))))

(def-cram-function stand-at (?pose)
  "Drive to ?POSE; try once more if something stopped the base on its way."
  (with-retry-counters ((retries 1))
    (with-failure-handling
        ((navigation-low-level-failure ()
           (do-retry retries
             (retry))))
      (perform (a motion (type going) (pose ?pose))))))

(def-cram-function take-from-the-workspace (?type ?arm)
  "Stand at the workspace, look for an object of ?TYPE on it, pick it up with ?ARM and return it."
  (stand-at (make-pose -1.4 0.2 0 :yaw pi))
  (let ((?place (make-pose -2.1 0 0.9)))
    (perform (a motion (type looking) (pose ?place)))
    (let ((?object (perform (a motion (type detecting) (object (an object (type ?type)))))))
      (perform (an action (type picking-up) (object ?object) (arm ?arm)))
      ?object)))

(def-top-level-cram-function carry-to-the-table (&optional (?type :milk) (?arm :left))
  "Pick up an object of ?TYPE from the workspace, carry it to the table and place it there."
  (perform (an action (type parking-arms)))
  (let ((?object (take-from-the-workspace ?type ?arm))
        (?target (make-pose 0.35 0 (height-on-the-table ?type) :yaw pi)))
    (stand-at (make-pose -0.3 -0.2 0))
    (perform (an action
                 (type placing) (object ?object) (arm ?arm)
                 (target (a location (pose ?target)))))
    (perform (an action (type parking-arms)))))
