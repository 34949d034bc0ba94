;;;; What the plans in the kitchen have in common: where the robot stands for what, and how it takes
;;;; an object from the workspace or out of a drawer and brings it to the table.
;;;;
;;;; The poses are fixed, as in the paper's plans.  The right arm opens and closes the drawers,
;;;; whose handles are 0.1 m to the right of the middle of the robot; the left arm carries.
;;;;
;;;; A plan's file loads this one by
;;;;   (load-plan (merge-pathnames "kitchen-functions.lisp" *load-truename*))

(in-package #:discrepancy-finder-user)

(defun place-before (where)
  "Return the base pose before the workspace, the table, or drawer 1, 2 or 3."
  (ecase where
    (:workspace (make-pose -1.37 0.14 0 :yaw pi))
    (:table (make-pose -0.3 0 0))
    (:drawer-1 (make-pose -1.12 -0.7 0 :yaw pi))
    (:drawer-2 (make-pose -1.12 -0.1 0 :yaw pi))
    (:drawer-3 (make-pose -1.12 0.5 0 :yaw pi))))

(defun inside-drawer (drawer)
  "Return a point in the middle of an open drawer."
  (make-pose -1.7 (ecase drawer (:drawer-1 -0.6) (:drawer-2 0) (:drawer-3 0.6)) 0.62))

(defun target-on-the-table (type)
  "Return where an object of TYPE is wanted."
  (ecase type
    (:bowl (make-pose 0.3 0.1 0.7885))
    (:cereal (make-pose 0.4 0.5 0.867))
    (:milk (make-pose 0.3 -0.15 0.852))
    (:spoon (make-pose 0.2 -0.3 0.7645))))

(def-cram-function stand-before (where)
  "Drive to the fixed place before WHERE: :WORKSPACE, :TABLE, :DRAWER-1, :DRAWER-2 or :DRAWER-3."
  (let ((?pose (place-before where)))
    (perform (a motion (type going) (pose ?pose)))))

(def-cram-function lift-torso (?height)
  (perform (a motion (type moving-torso) (joint-angle ?height))))

(def-cram-function park-the-arm (?arm)
  (perform (an action (type parking-arms) (arms (?arm)))))

(def-cram-function grasp-with (?arm ?object)
  "Pick up ?OBJECT, which was detected, with ?ARM, draw it to the robot, and return it."
  (perform (a motion (type opening) (gripper ?arm)))
  (perform (an action (type picking-up) (object ?object) (arm ?arm)))
  (lift-torso 0.25)
  (park-the-arm ?arm)
  ?object)

(def-cram-function detect-at (?place ?type)
  "Look at ?PLACE and return the object of ?TYPE that is detected there."
  (perform (a motion (type looking) (pose ?place)))
  (perform (a motion (type detecting) (object (an object (type ?type))))))

(def-cram-function take-from-the-workspace (type)
  "Take an object of TYPE, which stands on the workspace, and return it."
  (stand-before :workspace)
  (lift-torso 0.25)
  (grasp-with :left (detect-at (make-pose -2.1 0 0.9) type)))

(def-cram-function open-the-drawer (?drawer &optional (?arm :right))
  (perform (an action (type opening) (object (an object (type drawer) (name ?drawer))) (arm ?arm)))
  (park-the-arm ?arm))

(def-cram-function close-the-drawer (?drawer &optional (?arm :right))
  (perform (an action (type closing) (object (an object (type drawer) (name ?drawer))) (arm ?arm)))
  (park-the-arm ?arm))

(def-cram-function detect-in-drawer (drawer type)
  "Look into the open DRAWER and return the object of TYPE that is detected in it, or NIL."
  (with-failure-handling
      ((perception-object-not-found ()
         (return nil)))
    (detect-at (inside-drawer drawer) type)))

(def-cram-function put-on-the-table (?object &optional (?arm :left))
  "Carry ?OBJECT, which the hand of ?ARM holds, to the table and place it where it is wanted."
  (stand-before :table)
  (let ((?target (target-on-the-table (desig-prop-value ?object :type))))
    (perform (an action (type placing) (object ?object) (arm ?arm)
                        (target (a location (pose ?target)))))
    (park-the-arm ?arm)))
