;;;; The plan of the paper's Figure 1: go somewhere, look at the table, and detect an object there.

(in-package #:discrepancy-finder-user)

(def-top-level-cram-function find-object (&optional (?object-type :cereal))
  "Look for an object of ?OBJECT-TYPE on the left side of the table and, where none is seen, on the
right side.  Return the designator of the one that is seen."
  (let ((?goal-pose (make-pose 0.4 0 0 :yaw (/ pi 2)))
        (?look-pose (make-pose 0.4 0.8 0.8)))
    (with-retry-counters ((other-sides 1))
      (with-failure-handling
          ((perception-object-not-found ()
             (do-retry other-sides
               (setf ?goal-pose (make-pose 1.6 0 0 :yaw (/ pi 2))
                     ?look-pose (make-pose 1.6 0.8 0.8))
               (retry))))
        (perform (a motion (type going) (pose ?goal-pose)))
        (perform (a motion (type looking) (pose ?look-pose)))
        (perform (a motion (type detecting) (object (an object (type ?object-type)))))))))
