;;;; What plan files of CRAM use and no other layer has: predicates about robots, generic functions
;;;; about objects, lists of equal length.
;;;;
;;;; CRAM declares them in packages of their own, and each robot and each kitchen adds facts and
;;;; methods.  It is the same here: nothing is known of any robot until a file says so.

(in-package #:discrepancy-finder.cram-compat)

;;; Predicates about robots

(def-fact-group robot-interfaces
    (robot arm required-arms available-arms camera-frame tool-frame torso-frame base-frame
     arm-joints arm-links hand-links hand-link gripper-joint gripper-link end-effector-link
     robot-torso-link-joint robot-tool-frame robot-joint-states robot-pan-tilt-links
     robot-pan-tilt-joints reachability-designator designator-reach-pose visibility-designator))

(macrolet ((document (&rest entries)
             `(progn
                ,@(loop for (name text) on entries by #'cddr
                        collect `(setf (documentation ',name 'prolog:predicate)
                                       ,(format nil "~a  Fact groups add to it." text))))))
  (document
   robot "(robot name): NAME is the robot that plans are for."
   arm "(arm robot arm): ROBOT has ARM, :left or :right."
   required-arms "(required-arms robot object arms): ROBOT needs the list ARMS to grasp OBJECT."
   available-arms "(available-arms robot arms): ROBOT can use the list ARMS now."
   camera-frame "(camera-frame robot frame): FRAME, a string, is that of a camera of ROBOT."
   tool-frame "(tool-frame robot arm frame): FRAME is that of the tool of ARM."
   torso-frame "(torso-frame robot frame): FRAME is that of the torso of ROBOT."
   base-frame "(base-frame robot frame): FRAME is that of the base of ROBOT."
   arm-joints "(arm-joints robot arm names): NAMES is the list of the joints of ARM."
   arm-links "(arm-links robot arm names): NAMES is the list of the links of ARM."
   hand-links "(hand-links robot arm names): NAMES is the list of the links of the hand of ARM."
   hand-link "(hand-link robot arm name): NAME is a link of the hand of ARM."
   gripper-joint "(gripper-joint robot arm name): NAME is a joint of the gripper of ARM."
   gripper-link "(gripper-link robot arm name): NAME is a link of the gripper of ARM."
   end-effector-link "(end-effector-link robot arm name): NAME is the last link of ARM."
   robot-torso-link-joint "(robot-torso-link-joint robot link joint): those of ROBOT's torso."
   robot-tool-frame "(robot-tool-frame robot arm frame): FRAME is that of the tool of ARM."
   robot-joint-states "(robot-joint-states robot part arm name states): STATES is a list of joints
and their positions, of which NAME is the name."
   robot-pan-tilt-links "(robot-pan-tilt-links robot pan tilt): the links of ROBOT's neck."
   robot-pan-tilt-joints "(robot-pan-tilt-joints robot pan tilt): the joints of ROBOT's neck."
   reachability-designator "(reachability-designator location): LOCATION is one from which
something can be reached."
   designator-reach-pose "(designator-reach-pose location robot-pose pose side): from ROBOT-POSE,
which LOCATION means, POSE is reached with the arm SIDE."
   visibility-designator "(visibility-designator location): LOCATION is one from which something
can be seen."))

;;; Functions about objects

(defgeneric get-object-type-gripping-effort (object-type)
  (:documentation "Return the effort (N) with which objects of OBJECT-TYPE, a keyword, are gripped.
Methods are defined where objects are."))

(defgeneric get-object-type-gripper-opening (object-type)
  (:documentation "Return how far (m) the gripper opens for objects of OBJECT-TYPE, a keyword.
Methods are defined where objects are."))

(defgeneric get-object-type-grasps (object-type arm object-transform-in-base)
  (:documentation "Return the list of the grasps, keywords, for objects of OBJECT-TYPE with ARM, the
best first.  Methods are defined where objects are."))

(defgeneric get-object-grasping-poses (object-name object-type arm grasp object-transform)
  (:documentation "Return the list of the poses, stamped, through which the tool of ARM goes to
grasp the object with OBJECT-NAME, of OBJECT-TYPE, at OBJECT-TRANSFORM with GRASP.  Methods are
defined where objects are."))

(defun pose-entry (key object-designator)
  (let ((entry (find key (plan:desig-prop-value (plan:current-desig object-designator) :pose)
                     :key #'first)))
    (second entry)))

(defun get-object-pose (object-designator)
  "Return the pose in the frame of the robot's base that perception has given OBJECT-DESIGNATOR: the
:pose in its property (:pose ((:pose pose) (:transform transform))), or NIL."
  (pose-entry :pose object-designator))

(defun get-object-transform (object-designator)
  "Return the transform from the object's frame to that of the robot's base that perception has
given OBJECT-DESIGNATOR, or NIL."
  (pose-entry :transform object-designator))

;;; Functions about lists

(defun equalize-two-list-lengths (first second)
  "Return, as two values, the lists FIRST and SECOND, the shorter one with NILs at its end."
  (let ((length (max (length first) (length second))))
    (flet ((fill-up (list)
             (append list (make-list (- length (length list))))))
      (values (fill-up first) (fill-up second)))))

(defun equalize-lists-of-lists-lengths (first second)
  "Return, as two values, the lists of lists FIRST and SECOND, the shorter one with NILs at its end
and each of their lists as long as its counterpart, by NILs at its end."
  (multiple-value-bind (firsts seconds) (equalize-two-list-lengths first second)
    (loop for one in firsts for other in seconds
          for (long-one long-other) = (multiple-value-list (equalize-two-list-lengths one other))
          collect long-one into ones
          collect long-other into others
          finally (return (values ones others)))))
