(in-package :ts-plans)

(defun first-pose (poses)
  (list (first poses)))

(defun grasp-phases (poses)
  "Return the poses before the grasp, at it and after it."
  (list (subseq poses 0 2) (subseq poses 2 3) (subseq poses 3)))

(def-fact-group ts-actions (desig:action-grounding)

  (<- (desig:action-grounding ?action-designator (go-to-target ?location))
    (or (and (spec:property ?action-designator (:type :navigating))
             (spec:property ?action-designator (:location ?any-location)))
        (and (spec:property ?action-designator (:type :going))
             (spec:property ?action-designator (:target ?any-location))))
    (desig:current-designator ?any-location ?location))

  (<- (desig:action-grounding ?action-designator (perceive ?object-designator))
    (spec:property ?action-designator (:type :detecting))
    (spec:property ?action-designator (:object ?object-designator)))

  (<- (desig:action-grounding ?action-designator (look-at :target ?target))
    (spec:property ?action-designator (:type :turning-towards))
    (spec:property ?action-designator (:target ?target)))

  (<- (desig:action-grounding ?action-designator (search-for-object ?object ?location))
    (spec:property ?action-designator (:type :searching))
    (spec:property ?action-designator (:object ?object))
    (spec:property ?action-designator (:location ?some-location))
    (desig:current-designator ?some-location ?location))

  (<- (desig:action-grounding ?action-designator (transport ?object ?location ?target ?arm))
    (spec:property ?action-designator (:type :transporting))
    (spec:property ?action-designator (:object ?some-object))
    (desig:current-designator ?some-object ?object)
    (spec:property ?action-designator (:location ?location))
    (spec:property ?action-designator (:target ?target))
    (once (or (spec:property ?action-designator (:arm ?arm))
              (equal ?arm nil))))

  (<- (desig:action-grounding ?action-designator (move-arms-in-sequence
                                                  ?left-poses ?right-poses ?mode))
    (spec:property ?action-designator (:type ?type))
    (member (?type ?mode) ((:reaching :avoid-all) (:lifting :allow-hand)
                           (:grasping :allow-all) (:putting :allow-all)))
    (once (or (spec:property ?action-designator (:left-poses ?left-poses))
              (equal ?left-poses nil)))
    (once (or (spec:property ?action-designator (:right-poses ?right-poses))
              (equal ?right-poses nil))))

  (<- (desig:action-grounding ?action-designator (grip ?gripper ?effort))
    (spec:property ?action-designator (:type :gripping))
    (spec:property ?action-designator (:gripper ?gripper))
    (once (or (spec:property ?action-designator (:effort ?effort))
              (equal ?effort nil))))

  (<- (desig:action-grounding ?action-designator (release ?gripper))
    (or (spec:property ?action-designator (:type :releasing))
        (spec:property ?action-designator (:type :setting-gripper)))
    (spec:property ?action-designator (:gripper ?gripper)))

  (<- (desig:action-grounding ?action-designator
                              (pick-up ?current-object ?arm ?opening ?effort ?grasp
                                       ?left-reach ?right-reach ?left-grasp ?right-grasp
                                       ?left-lift ?right-lift))
    (spec:property ?action-designator (:type :picking-up))
    (spec:property ?action-designator (:object ?object-designator))
    (desig:current-designator ?object-designator ?current-object)
    (spec:property ?current-object (:type ?object-type))
    (spec:property ?current-object (:name ?object-name))
    (-> (spec:property ?action-designator (:arm ?arm))
        (true)
        (and (cram-robot-interfaces:robot ?robot)
             (cram-robot-interfaces:arm ?robot ?arm)))
    (lisp-fun obj-int:get-object-transform ?current-object ?object-transform)
    (lisp-fun obj-int:get-object-type-grasps ?object-type ?arm ?object-transform ?grasps)
    (-> (spec:property ?action-designator (:grasp ?grasp))
        (true)
        (member ?grasp ?grasps))
    (lisp-fun obj-int:get-object-type-gripping-effort ?object-type ?effort)
    (lisp-fun obj-int:get-object-type-gripper-opening ?object-type ?opening)
    (lisp-fun obj-int:get-object-grasping-poses
              ?object-name ?object-type ?arm ?grasp ?object-transform ?poses)
    (lisp-fun grasp-phases ?poses (?reach ?at ?lift))
    (-> (lisp-pred eq ?arm :left)
        (and (equal ?left-reach ?reach) (equal ?right-reach nil)
             (equal ?left-grasp ?at) (equal ?right-grasp nil)
             (equal ?left-lift ?lift) (equal ?right-lift nil))
        (and (equal ?left-reach nil) (equal ?right-reach ?reach)
             (equal ?left-grasp nil) (equal ?right-grasp ?at)
             (equal ?left-lift nil) (equal ?right-lift ?lift)))
    (format "~%Arm ~a, grasp ~a~%" ?arm ?grasp))

  (<- (desig:action-grounding ?action-designator (place ?current-object ?arm ?location))
    (spec:property ?action-designator (:type :placing))
    (spec:property ?action-designator (:object ?object))
    (desig:current-designator ?object ?current-object)
    (cpoe:object-in-hand ?current-object ?arm)
    (spec:property ?action-designator (:target ?some-location))
    (desig:current-designator ?some-location ?location)))

(def-fact-group ts-occasions (cpoe:object-in-hand)
  (<- (cpoe:object-in-hand ?object ?arm)
    (spec:property ?object (:name ?name))
    (symbol-value *held* ?held)
    (member (?arm . ?name) ?held)))

;;; Places beside the known tables.

(defun table-places (location-designator)
  "Return the places from which `location-designator', of a table, can be worked at."
  (when (desig:desig-prop-value location-designator :table)
    (list (at 12.0 0.5) (at 5.0 0.5) (at 1.0 0.5) (at 2.0 0.5))))

(desig:register-location-generator 5 table-places "Places at a table.")

(desig:register-location-validation-function
 10 not-underground "Places above the floor.")

(defun not-underground (location-designator pose)
  (if (and (desig:desig-prop-value location-designator :table)
           (minusp (cl-transforms:z (cl-transforms:origin pose))))
      :reject
      :unknown))
