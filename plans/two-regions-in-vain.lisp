;;;; What cannot be done in the two regions: a plan that tries, and goes on all the same.

(in-package #:discrepancy-finder-user)

(def-cram-function pick-up-if-possible (?box)
  "Try to pick up ?BOX."
  (with-failure-handling
      ((manipulation-low-level-failure () (return)))
    (perform (an action (type picking-up) (object ?box)))))

(def-cram-function place-if-possible (?box ?x)
  "Try to place ?BOX on the bench, at ?X."
  (let ((?target-pose (make-pose ?x 0.4 0.46)))
    (with-failure-handling
        ((manipulation-low-level-failure () (return)))
      (perform (an action (type placing) (object ?box)
                   (target (a location (pose ?target-pose))))))))

(def-cram-function try-everything (?far-left ?far-right)
  "Reach for the box from ?FAR-LEFT, place what is not held, pick up what is held already, place the
box from afar, and reach for it from ?FAR-RIGHT."
  (let ((?box (an object (type box)))
        (?left (make-pose 0.5 0 0))
        (?right (make-pose 1.5 0 0)))
    (perform (a motion (type going) (pose ?far-left)))
    (pick-up-if-possible ?box)
    (place-if-possible ?box 0.5)
    (perform (a motion (type going) (pose ?right)))
    (place-if-possible ?box 1.5)
    (pick-up-if-possible ?box)
    (pick-up-if-possible ?box)
    (place-if-possible ?box 0.5)
    (perform (a motion (type going) (pose ?left)))
    (pick-up-if-possible ?box)
    (place-if-possible ?box 1.5)
    (place-if-possible ?box 0.5)
    (perform (a motion (type going) (pose ?far-right)))
    (pick-up-if-possible ?box)
    (place-if-possible ?box 1.5)))

(def-top-level-cram-function two-regions-in-vain ()
  "Try everything; reach for the box from so far away that nobody could."
  (try-everything (make-pose 0.2 0 0) (make-pose 1.8 0 0)))

(def-top-level-cram-function two-regions-from-the-middle ()
  "Try everything from the middle of the regions."
  (try-everything (make-pose 0.5 0 0) (make-pose 1.5 0 0)))
