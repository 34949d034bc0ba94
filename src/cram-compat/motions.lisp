;;;; The motions of CRAM's package cram-common-designators: what each means to a process module.
;;;;
;;;; (a motion (type going) (target ?location)) is resolved to (move-base pose), and so on; a
;;;; process module takes the list apart.  A file of plans can add facts of MOTION-GROUNDING for
;;;; motions of its own.

(in-package #:discrepancy-finder.cram-compat)

(def-fact-group common-motions (desig:motion-grounding)

  ;; Each place of the location is a solution.
  (<- (desig:motion-grounding ?motion (move-base ?pose))
    (desig:property ?motion (:type :going))
    (desig:property ?motion (:target ?location))
    (desig:current-designator ?location ?current)
    (desig:designator-groundings ?current ?poses)
    (member ?pose ?poses))

  (<- (desig:motion-grounding ?motion (move-base ?pose))
    (desig:property ?motion (:type :going))
    (desig:desig-prop ?motion (:pose ?pose)))

  (<- (desig:motion-grounding ?motion (move-torso ?angle))
    (desig:property ?motion (:type :moving-torso))
    (desig:property ?motion (:joint-angle ?angle)))

  (<- (desig:motion-grounding ?motion (move-head :pose ?pose))
    (desig:property ?motion (:type :looking))
    (desig:desig-prop ?motion (:pose ?pose)))

  (<- (desig:motion-grounding ?motion (move-head :pose ?pose))
    (desig:property ?motion (:type :looking))
    (desig:property ?motion (:target ?location))
    (desig:current-designator ?location ?current)
    (desig:designator-groundings ?current ?poses)
    (member ?pose ?poses))
  (<- (desig:motion-grounding ?motion (move-head :frame ?frame))
    (desig:property ?motion (:type :looking))
    (desig:property ?motion (:frame ?frame)))
  (<- (desig:motion-grounding ?motion (move-head :direction ?direction))
    (desig:property ?motion (:type :looking))
    (desig:property ?motion (:direction ?direction)))

  (<- (desig:motion-grounding ?motion (detect ?current))
    (desig:property ?motion (:type :detecting))
    (desig:property ?motion (:object ?object))
    (desig:current-designator ?object ?current))
  (<- (desig:motion-grounding ?motion (inspect ?current))
    (desig:property ?motion (:type :inspecting))
    (desig:property ?motion (:object ?object))
    (desig:current-designator ?object ?current))

  (<- (desig:motion-grounding ?motion (move-gripper-joint ?action ?gripper))
    (desig:property ?motion (:type ?type))
    (member (?type ?action) ((:opening :open) (:closing :close)))
    (desig:property ?motion (:gripper ?gripper)))
  (<- (desig:motion-grounding ?motion (move-gripper-joint :grip ?gripper ?effort))
    (desig:property ?motion (:type :gripping))
    (desig:property ?motion (:gripper ?gripper))
    (prolog:once (or (desig:property ?motion (:effort ?effort))
                     (equal ?effort nil))))
  (<- (desig:motion-grounding ?motion (move-gripper-joint ?angle ?gripper nil))
    (desig:property ?motion (:type :moving-gripper-joint))
    (desig:property ?motion (:gripper ?gripper))
    (desig:property ?motion (:joint-angle ?angle)))

  (<- (desig:motion-grounding ?motion (move-tcp ?left-pose ?right-pose ?mode))
    (desig:property ?motion (:type :moving-tcp))
    (target-pose ?motion :left-target ?left-pose)
    (target-pose ?motion :right-target ?right-pose)
    (value-or-nil ?motion :collision-mode ?mode))
  (<- (desig:motion-grounding ?motion (move-joints ?left ?right))
    (desig:property ?motion (:type :moving-arm-joints))
    (value-or-nil ?motion :left-configuration ?left)
    (value-or-nil ?motion :right-configuration ?right))
  (<- (desig:motion-grounding ?motion (move-with-constraints ?constraints))
    (desig:property ?motion (:type :moving-with-constraints))
    (desig:property ?motion (:constraints ?constraints)))

  (<- (value-or-nil ?motion ?key ?value)
    (prolog:-> (desig:property ?motion (?key ?found))
               (equal ?value ?found)
               (equal ?value nil)))
  (<- (target-pose ?motion ?key ?pose)
    (prolog:-> (desig:property ?motion (?key ?location))
               (prolog:lisp-fun current-place ?location ?pose)
               (equal ?pose nil))))

(defun current-place (location)
  "Return what the youngest designator in the chain of LOCATION is resolved to."
  (desig:reference (desig:current-desig location)))

;; Words, not variables, but DOCUMENTATION has no other place for them.
(macrolet ((document (&rest entries)
             `(progn
                ,@(loop for (name text) on entries by #'cddr
                        collect `(setf (documentation ',name 'variable) ,text)))))
  (document
   move-base "(move-base pose): drive to the pose."
   move-torso "(move-torso position): move the torso to the position (m)."
   move-head "(move-head kind goal): look at the goal, of which KIND, :pose, :frame or :direction,
says what it is."
   detect "(detect object): look for what fits the object designator."
   move-gripper-joint "(move-gripper-joint action gripper [effort]): :open, :close or :grip with an
effort (N), or move to a position (m)."
   move-tcp "(move-tcp left right mode): move the tools to the poses, NIL for none; MODE says which
collisions are permitted."
   move-joints "(move-joints left right): move the joints of the arms to the lists of positions."
   move-with-constraints "(move-with-constraints text): move as the text says."))
