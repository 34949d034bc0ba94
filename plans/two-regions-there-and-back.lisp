;;;; The box of the two regions is fetched, set down, left alone, and taken back to where it was.

(in-package #:discrepancy-finder-user)

(def-cram-function set-down-in-the-middle (?box ?x)
  "Place ?BOX on the bench, at ?X."
  (let ((?target-pose (make-pose ?x 0.4 0.46)))
    (perform (an action (type placing) (object ?box) (target (a location (pose ?target-pose)))))))

(def-top-level-cram-function two-regions-there-and-back ()
  "Bring the box from r2 to r1, drive to r2 without it, come back for it, and return it to r2."
  (let ((?box (an object (type box)))
        (?left (make-pose 0.5 0 0))
        (?right (make-pose 1.5 0 0)))
    (perform (a motion (type going) (pose ?right)))
    (perform (an action (type picking-up) (object ?box)))
    (perform (a motion (type going) (pose ?left)))
    (set-down-in-the-middle ?box 0.5)
    (perform (a motion (type going) (pose ?right)))
    (perform (a motion (type going) (pose ?left)))
    (perform (an action (type picking-up) (object ?box)))
    (perform (a motion (type going) (pose ?right)))
    (set-down-in-the-middle ?box 1.5)
    (perform (a motion (type going) (pose ?left)))))
