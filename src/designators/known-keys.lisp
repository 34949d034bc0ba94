;;;; The keys of CRAM's own plans and groundings, class by class.

(in-package #:discrepancy-finder.designators)

(declare-designator-keys motion
  type goal target left-target right-target pose joint-angle joint-angles frame direction
  object objects gripper effort arm left-configuration right-configuration
  collision-mode collision-object-a collision-object-b collision-object-a-link
  collision-object-b-link constraints speed angle r g b width off camera head)

(declare-designator-keys action
  type goal object objects on-object with-object arm grasp gripper gripper-opening effort
  position distance target location robot-location pick-up-action place-action
  left-poses right-poses left-reach-poses right-reach-poses left-grasp-poses right-grasp-poses
  left-lift-poses right-lift-poses left-put-poses right-put-poses
  left-retract-poses right-retract-poses
  frame direction camera head pose joint-angle left-configuration right-configuration
  collision-mode shape for speed angle context)

(declare-designator-keys object
  type name pose location color cad-model urdf-name owl-name part-of at in size)

(declare-designator-keys location
  type pose poses of of-item-object on in at side range range-invert context object-count for
  left-of right-of in-front-of behind near far-from facing location object obj arm arms
  reachable-for visible-for reachable-from height depth)

(declare-designator-keys human
  type name pose location)
