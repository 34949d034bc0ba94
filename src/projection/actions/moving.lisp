;;;; The actions going, navigating, looking, turning-towards and detecting.
;;;;
;;;; The files of this folder are plans, in CPL, as a user would write them; groundings.lisp says
;;;; which designator means which plan.  They are executed in a projection and symbolically alike:
;;;; what they know of the world they know from what they perform, and what is a matter of geometry
;;;; is left to location designators.  How often something is tried again is as in CRAM.

(in-package #:discrepancy-finder.projection)

(def-cram-function next-location (?location)
  "Return the next solution of the location designator ?LOCATION, or NIL if there is none."
  (with-failure-handling ((designator-error () (return nil)))
    (next-solution ?location)))

(def-cram-function go-to-target (?target)
  "Drive to the location ?TARGET."
  (perform (a motion (type going) (target ?target))))

(defun arms-in-the-way-p ()
  "Return true if the robot of the projection in which a plan runs has an arm that is not parked."
  (let* ((projection (plan:current-executive))
         (robot (and (typep projection 'projection) (projection-robot projection))))
    (and robot
         (notevery (lambda (arm) (parked-p projection arm)) (robot-arms robot)))))

(def-cram-function go-without-collisions (?location)
  "Drive to the location ?LOCATION with the arms parked; to its next solution where the robot does
not get, up to 30 times."
  (when (arms-in-the-way-p)
    (perform (an action (type parking-arms))))
  (with-retry-counters ((other-poses 30))
    (with-failure-handling
        ((navigation-pose-unreachable (failure)
           (do-retry other-poses
             (let ((next (next-location ?location)))
               (when next
                 (setf ?location next)
                 (retry))))
           (fail 'navigation-goal-in-collision
                 :description (failure-description failure)))
         (designator-error (failure)
           (fail 'navigation-goal-in-collision
                 :description (format nil "there is no free place: ~a" failure))))
      (perform (an action (type going) (target ?location))))))

(def-cram-function look (?key ?value)
  "Point the camera: at ?VALUE by the ?KEY :target, :pose, :object, :frame, :direction or
:joint-angles of a looking motion.  Try once more if it does not get there."
  (with-retry-counters ((looking-retries 1))
    (with-failure-handling
        ((ptu-low-level-failure ()
           (do-retry looking-retries
             (retry))))
      (case ?key
        (:frame (perform (a motion (type looking) (frame ?value))))
        (:direction (perform (a motion (type looking) (direction ?value))))
        (:joint-angles (perform (a motion (type looking) (joint-angles ?value))))
        (t (perform (a motion (type looking) (target ?value))))))))

(def-cram-function turn-towards (?target)
  "Point the camera at ?TARGET; where the head does not get there, turn the base towards it and try
once more."
  (with-retry-counters ((turning-retries 1))
    (with-failure-handling
        ((ptu-low-level-failure (failure)
           (do-retry turning-retries
             (perform (an action (type navigating)
                          (location (a location (facing ?target)))))
             (retry))
           (fail 'looking-high-level-failure :description (failure-description failure))))
      (perform (an action (type looking) (target ?target))))))

(def-cram-function perceive (?object)
  "Detect the object ?OBJECT and return its new designator; look again up to four times."
  (with-retry-counters ((perception-retries 4))
    (with-failure-handling
        ((perception-low-level-failure ()
           (do-retry perception-retries
             (retry))))
      (or (perform (a motion (type detecting) (object ?object)))
          ?object))))
