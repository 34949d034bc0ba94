;;;; The household: the yardstick of the benchmarks of the event calculus.
;;;;
;;;; Eight regions in a ring with a chord, three drawers, four objects, one gripper: 74 ground
;;;; fluents, 49 ground events, 482 ground effects, at most one event a step.  HOUSEHOLD leaves the
;;;; beginning open, HOUSEHOLD-AT-HOME fixes it, in HOUSEHOLD-UNKNOWN the places of the objects are
;;;; unknown.

(in-package #:discrepancy-finder.bench)

(ec:define-theory household
  "A robot that goes from region to region, opens drawers, looks, detects, grasps and puts down."
  (:sorts (place gripper)
          (spot (:parent place))
          (region (:parent spot) r0 r1 r2 r3 r4 r5 r6 r7)
          (drawer (:parent spot) d0 d1 d2)
          (object o0 o1 o2 o3))
  (:predicates ((adjacent region region)
                (r0 r1) (r1 r2) (r2 r3) (r3 r4) (r4 r5) (r5 r6) (r6 r7) (r7 r0) (r0 r4)
                (r1 r0) (r2 r1) (r3 r2) (r4 r3) (r5 r4) (r6 r5) (r7 r6) (r0 r7) (r4 r0)))
  (:functions ((region-of drawer) region))
  (:fluents (robot-in region) (position object place) (gaze spot) (open drawer) (detected object))
  (:events (navigate region) (look spot) (detect object) (grasp object) (put-down object)
           (put-in object drawer) (open-drawer drawer) (close-drawer drawer))
  (:axioms
   (= (region-of d0) r2) (= (region-of d1) r5) (= (region-of d2) r7)

   (one-event-at-a-time
    (implies (and (happens ?event1 ?time) (happens ?event2 ?time)) (= ?event1 ?event2)))

   (initiates (navigate ?region) (robot-in ?region) ?time)
   (implies (/= ?region1 ?region2) (terminates (navigate ?region1) (robot-in ?region2) ?time))
   (terminates (navigate ?region) (gaze ?spot) ?time)
   (terminates (navigate ?region) (detected ?object) ?time)
   (navigate-to-neighbours
    (implies (happens (navigate ?region1) ?time)
             (exists (?region2) (and (adjacent ?region2 ?region1)
                                     (holds-at (robot-in ?region2) ?time)))))

   (initiates (look ?spot) (gaze ?spot) ?time)
   (implies (/= ?spot1 ?spot2) (terminates (look ?spot1) (gaze ?spot2) ?time))
   (look-here (implies (happens (look ?region) ?time) (holds-at (robot-in ?region) ?time)))
   (look-into-open-drawers
    (implies (happens (look ?drawer) ?time)
             (and (holds-at (robot-in (region-of ?drawer)) ?time)
                  (holds-at (open ?drawer) ?time))))

   (implies (and (holds-at (gaze ?spot) ?time) (holds-at (position ?object ?spot) ?time))
            (initiates (detect ?object) (detected ?object) ?time))

   (initiates (grasp ?object) (position ?object gripper) ?time)
   (terminates (grasp ?object) (position ?object ?spot) ?time)
   (grasp-what-is-detected
    (implies (happens (grasp ?object) ?time) (holds-at (detected ?object) ?time)))
   (grasp-with-an-empty-gripper
    (implies (happens (grasp ?object1) ?time)
             (not (holds-at (position ?object2 gripper) ?time))))

   (implies (holds-at (robot-in ?region) ?time)
            (initiates (put-down ?object) (position ?object ?region) ?time))
   (terminates (put-down ?object) (position ?object gripper) ?time)
   (terminates (put-down ?object) (detected ?object) ?time)
   (put-down-what-is-held
    (implies (happens (put-down ?object) ?time) (holds-at (position ?object gripper) ?time)))

   (initiates (put-in ?object ?drawer) (position ?object ?drawer) ?time)
   (terminates (put-in ?object ?drawer) (position ?object gripper) ?time)
   (terminates (put-in ?object ?drawer) (detected ?object) ?time)
   (put-into-open-drawers
    (implies (happens (put-in ?object ?drawer) ?time)
             (and (holds-at (position ?object gripper) ?time)
                  (holds-at (robot-in (region-of ?drawer)) ?time)
                  (holds-at (open ?drawer) ?time))))

   (initiates (open-drawer ?drawer) (open ?drawer) ?time)
   (open-closed-drawers
    (implies (happens (open-drawer ?drawer) ?time)
             (and (holds-at (robot-in (region-of ?drawer)) ?time)
                  (not (holds-at (open ?drawer) ?time))
                  (forall (?object) (not (holds-at (position ?object gripper) ?time))))))
   (terminates (close-drawer ?drawer) (open ?drawer) ?time)
   (terminates (close-drawer ?drawer) (gaze ?drawer) ?time)
   (close-open-drawers
    (implies (happens (close-drawer ?drawer) ?time)
             (and (holds-at (robot-in (region-of ?drawer)) ?time)
                  (holds-at (open ?drawer) ?time)
                  (forall (?object) (not (holds-at (position ?object gripper) ?time))))))))

(ec:define-theory household-robot
  "The robot in r0, looking nowhere, all drawers closed, nothing detected."
  (:extends household)
  (:axioms
   (robot-at-first (initially (and (robot-in r0)
                                   (forall (?region) (implies (/= ?region r0)
                                                              (not (robot-in ?region)))))))
   (nothing-seen-at-first (initially (and (not (gaze ?spot)) (not (detected ?object)))))
   (drawers-closed-at-first (initially (not (open ?drawer))))))

(ec:define-theory household-at-home
  "Two objects in regions, two in drawers."
  (:extends household-robot)
  (:axioms
   (objects-at-first
    (initially (iff (position ?object ?place)
                    (or (and (= ?object o0) (= ?place r1)) (and (= ?object o1) (= ?place d0))
                        (and (= ?object o2) (= ?place r6)) (and (= ?object o3) (= ?place d2))))))))

(ec:define-theory household-unknown
  "Each object in one place, but not in the gripper."
  (:extends household-robot)
  (:axioms
   (somewhere-at-first (initially (exists (?spot) (position ?object ?spot))))
   (not-in-the-gripper-at-first (initially (not (position ?object gripper))))
   (in-one-place-at-first
    (initially (implies (and (position ?object ?spot1) (position ?object ?spot2))
                        (= ?spot1 ?spot2))))))
