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

(def-cram-function find-on-the-workspace (?type)
  "Look at the middle of the workspace for an object of ?TYPE, then to both sides.  Return it."
  (let ((?place (make-pose -2.1 0 0.9))
        (?other-places (list (make-pose -2.1 0.4 0.9) (make-pose -2.1 -0.4 0.9))))
    (with-failure-handling
        ((perception-object-not-found ()
           (when ?other-places
             (setf ?place (pop ?other-places))
             (retry))))
      (perform (a motion (type looking) (pose ?place)))
      (perform (a motion (type detecting) (object (an object (type ?type))))))))

(def-cram-function fetch-from-the-workspace (?type ?arm)
  "Stand at the workspace, find an object of ?TYPE on it, pick it up with ?ARM, step back from the
workspace and return the object."
  (stand-at (make-pose -1.4 0.2 0 :yaw pi))
  (let ((?object (find-on-the-workspace ?type)))
    (perform (an action (type picking-up) (object ?object) (arm ?arm)))
    (stand-at (make-pose -1.0 0.2 0 :yaw pi))
    ?object))

(def-top-level-cram-function carry-to-the-table (&optional (?type :milk) (?arm :left))
  "Pick up an object of ?TYPE from the workspace, carry it to the table and place it there."
  (perform (an action (type parking-arms)))
  (let ((?object (fetch-from-the-workspace ?type ?arm))
        (?target (make-pose 0.35 0 (height-on-the-table ?type) :yaw pi)))
    (stand-at (make-pose -0.3 -0.2 0))
    (perform (an action
                 (type placing) (object ?object) (arm ?arm)
                 (target (a location (pose ?target)))))
    (perform (an action (type parking-arms)))))
