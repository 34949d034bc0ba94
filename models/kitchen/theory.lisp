;;;; A household kitchen as a theory of the Discrete Event Calculus: a robot with two arms carries
;;;; items from a workspace with three drawers to a table.
;;;;
;;;; This file is data: reading it evaluates nothing.

(define-theory kitchen
  "What a modeller would write who trusts the robot: standing before a surface or a drawer it sees
and reaches what is there; what it holds it keeps; nothing is in its way."
  (:sorts (item bowl cereal milk spoon)
          (surface workspace table)
          (drawer drawer-1 drawer-2 drawer-3)
          (place start before-workspace before-table
                 before-drawer-1 before-drawer-2 before-drawer-3)
          (arm left right)
          (view ahead surface-view drawer-view)
          (height low high))
  (:predicates (serves place surface) (fronts place drawer))
  (:fluents
   ;; the robot
   (robot-at place) (facing view) (torso-at height) (parked arm) (gripper-open arm)
   (holding arm item)
   ;; the items, and what the robot knows of them
   (on item surface) (in item drawer) (detected item) (delivered item)
   ;; the furniture
   (open drawer))
  (:non-inertial-fluents
   ;; what follows from the others
   (near item) (visible item) (reachable item) (held item) (free arm))
  (:events (navigate place) (look view) (detect item) (move-torso height)
           (open-gripper arm) (park arm) (pick-up arm item) (put-down arm item)
           (open-drawer arm drawer) (close-drawer arm drawer))
  (:axioms
   ;; Where the robot stands for what.
   (surfaces-have-places
    (iff (serves ?place ?surface)
         (or (and (= ?place before-workspace) (= ?surface workspace))
             (and (= ?place before-table) (= ?surface table)))))
   (drawers-have-places
    (iff (fronts ?place ?drawer)
         (or (and (= ?place before-drawer-1) (= ?drawer drawer-1))
             (and (= ?place before-drawer-2) (= ?drawer drawer-2))
             (and (= ?place before-drawer-3) (= ?drawer drawer-3)))))

   ;; What follows from the rest of a state.
   (near-is-before-its-surface-or-drawer
    (iff (holds-at (near ?item) ?time)
         (exists (?place)
           (and (holds-at (robot-at ?place) ?time)
                (or (exists (?surface)
                      (and (serves ?place ?surface) (holds-at (on ?item ?surface) ?time)))
                    (exists (?drawer)
                      (and (fronts ?place ?drawer) (holds-at (in ?item ?drawer) ?time))))))))
   (visible-is-near-in-view-and-not-shut-in
    (iff (holds-at (visible ?item) ?time)
         (and (holds-at (near ?item) ?time)
              (or (and (exists (?surface) (holds-at (on ?item ?surface) ?time))
                       (holds-at (facing surface-view) ?time))
                  (and (exists (?drawer) (and (holds-at (in ?item ?drawer) ?time)
                                              (holds-at (open ?drawer) ?time)))
                       (holds-at (facing drawer-view) ?time))))))
   (reachable-is-near-at-the-right-height-and-not-shut-in
    (iff (holds-at (reachable ?item) ?time)
         (and (holds-at (near ?item) ?time)
              (or (and (exists (?surface) (holds-at (on ?item ?surface) ?time))
                       (holds-at (torso-at high) ?time))
                  (and (exists (?drawer) (and (holds-at (in ?item ?drawer) ?time)
                                              (holds-at (open ?drawer) ?time)))
                       (holds-at (torso-at low) ?time))))))
   (held-is-in-some-hand
    (iff (holds-at (held ?item) ?time)
         (exists (?arm) (holds-at (holding ?arm ?item) ?time))))
   (free-is-without-an-item
    (iff (holds-at (free ?arm) ?time)
         (forall (?item) (not (holds-at (holding ?arm ?item) ?time)))))

   ;; Everything is in one place.
   (robot-at-one-place
    (implies (and (holds-at (robot-at ?place1) ?time) (holds-at (robot-at ?place2) ?time))
             (= ?place1 ?place2)))
   (camera-faces-one-view
    (implies (and (holds-at (facing ?view1) ?time) (holds-at (facing ?view2) ?time))
             (= ?view1 ?view2)))
   (torso-at-one-height
    (implies (and (holds-at (torso-at ?height1) ?time) (holds-at (torso-at ?height2) ?time))
             (= ?height1 ?height2)))
   (item-on-one-surface
    (implies (and (holds-at (on ?item ?surface1) ?time) (holds-at (on ?item ?surface2) ?time))
             (= ?surface1 ?surface2)))
   (item-in-one-drawer
    (implies (and (holds-at (in ?item ?drawer1) ?time) (holds-at (in ?item ?drawer2) ?time))
             (= ?drawer1 ?drawer2)))
   (item-on-a-surface-or-in-a-drawer
    (implies (holds-at (on ?item ?surface) ?time)
             (not (holds-at (in ?item ?drawer) ?time))))

   ;; At the beginning the spoon can be in any of the drawers.
   (robot-starts-at-its-start (initially (robot-at start)))
   (camera-starts-ahead (initially (facing ahead)))
   (torso-starts-low (initially (torso-at low)))
   (arms-start-parked (initially (parked ?arm)))
   (grippers-start-closed (initially (not (gripper-open ?arm))))
   (hands-start-empty (initially (not (holding ?arm ?item))))
   (drawers-start-closed (initially (not (open ?drawer))))
   (spoon-starts-in-a-drawer (initially (exists (?drawer) (in spoon ?drawer))))
   (others-start-on-the-workspace
    (initially (implies (/= ?item spoon) (on ?item workspace))))
   (nothing-detected-yet (initially (not (detected ?item))))
   (nothing-delivered-yet (initially (not (delivered ?item))))

   ;; Navigating.  What was detected and left behind has to be detected again.
   (navigate-arrives (initiates (navigate ?place) (robot-at ?place) ?time))
   (navigate-leaves
    (implies (/= ?place1 ?place2)
             (terminates (navigate ?place1) (robot-at ?place2) ?time)))
   (navigate-forgets
    (implies (not (holds-at (held ?item) ?time))
             (terminates (navigate ?place) (detected ?item) ?time)))
   (navigate-needs-parked-arms
    (implies (happens (navigate ?place) ?time) (holds-at (parked ?arm) ?time)))

   ;; Looking.
   (look-faces (initiates (look ?view) (facing ?view) ?time))
   (look-turns-away
    (implies (/= ?view1 ?view2)
             (terminates (look ?view1) (facing ?view2) ?time)))
   (look-at-a-surface-before-it
    (implies (and (happens (look surface-view) ?time) (holds-at (robot-at ?place) ?time))
             (exists (?surface) (serves ?place ?surface))))
   (look-into-a-drawer-before-it
    (implies (and (happens (look drawer-view) ?time) (holds-at (robot-at ?place) ?time))
             (exists (?drawer) (fronts ?place ?drawer))))

   ;; Detecting.
   (detect-finds (initiates (detect ?item) (detected ?item) ?time))
   (detect-needs-sight
    (implies (happens (detect ?item) ?time) (holds-at (visible ?item) ?time)))

   ;; The torso.
   (torso-moves (initiates (move-torso ?height) (torso-at ?height) ?time))
   (torso-leaves
    (implies (/= ?height1 ?height2)
             (terminates (move-torso ?height1) (torso-at ?height2) ?time)))

   ;; Arms and grippers.
   (gripper-opens (initiates (open-gripper ?arm) (gripper-open ?arm) ?time))
   (open-gripper-needs-a-free-hand
    (implies (happens (open-gripper ?arm) ?time) (holds-at (free ?arm) ?time)))
   (park-parks (initiates (park ?arm) (parked ?arm) ?time))
   (park-closes-the-gripper (terminates (park ?arm) (gripper-open ?arm) ?time))

   ;; Picking up.
   (pick-up-holds (initiates (pick-up ?arm ?item) (holding ?arm ?item) ?time))
   (pick-up-lifts-off (terminates (pick-up ?arm ?item) (on ?item ?surface) ?time))
   (pick-up-takes-out (terminates (pick-up ?arm ?item) (in ?item ?drawer) ?time))
   (pick-up-closes-the-gripper (terminates (pick-up ?arm ?item) (gripper-open ?arm) ?time))
   (pick-up-stretches-the-arm (terminates (pick-up ?arm ?item) (parked ?arm) ?time))
   (pick-up-needs-reach
    (implies (happens (pick-up ?arm ?item) ?time) (holds-at (reachable ?item) ?time)))
   (pick-up-needs-detection
    (implies (happens (pick-up ?arm ?item) ?time) (holds-at (detected ?item) ?time)))
   (pick-up-needs-an-open-gripper
    (implies (happens (pick-up ?arm ?item) ?time) (holds-at (gripper-open ?arm) ?time)))

   ;; Putting down.
   (put-down-releases (terminates (put-down ?arm ?item) (holding ?arm ?item) ?time))
   (put-down-onto-the-surface-here
    (implies (and (holds-at (robot-at ?place) ?time) (serves ?place ?surface))
             (initiates (put-down ?arm ?item) (on ?item ?surface) ?time)))
   (put-down-on-the-table-delivers
    (implies (holds-at (robot-at before-table) ?time)
             (initiates (put-down ?arm ?item) (delivered ?item) ?time)))
   (put-down-opens-the-gripper (initiates (put-down ?arm ?item) (gripper-open ?arm) ?time))
   (put-down-needs-the-item
    (implies (happens (put-down ?arm ?item) ?time) (holds-at (holding ?arm ?item) ?time)))
   (put-down-needs-a-surface
    (implies (and (happens (put-down ?arm ?item) ?time) (holds-at (robot-at ?place) ?time))
             (exists (?surface) (serves ?place ?surface))))

   ;; Drawers.
   (drawer-opens (initiates (open-drawer ?arm ?drawer) (open ?drawer) ?time))
   (open-drawer-from-before-it
    (implies (and (happens (open-drawer ?arm ?drawer) ?time) (holds-at (robot-at ?place) ?time))
             (fronts ?place ?drawer)))
   (open-drawer-needs-a-free-hand
    (implies (happens (open-drawer ?arm ?drawer) ?time) (holds-at (free ?arm) ?time)))
   (drawer-closes (terminates (close-drawer ?arm ?drawer) (open ?drawer) ?time))
   (close-drawer-from-before-it
    (implies (and (happens (close-drawer ?arm ?drawer) ?time) (holds-at (robot-at ?place) ?time))
             (fronts ?place ?drawer)))))

(define-state-constraint successful-navigation (?time)
  "The robot navigates to a place and is there at the next timepoint."
  (exists (?place) (and (happens (navigate ?place) ?time)
                        (holds-at (robot-at ?place) (+ ?time 1)))))

(define-state-constraint successful-grasping (?time)
  "The robot picks up an item and holds it at the next timepoint."
  (exists (?arm ?item) (and (happens (pick-up ?arm ?item) ?time)
                            (holds-at (holding ?arm ?item) (+ ?time 1)))))

(define-state-constraint successful-delivery (?time)
  "The robot puts down an item where it is wanted."
  (exists (?arm ?item) (and (happens (put-down ?arm ?item) ?time)
                            (holds-at (delivered ?item) (+ ?time 1)))))
