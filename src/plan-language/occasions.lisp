;;;; Events and occasions: what plans tell of the world, and ask of it.
;;;;
;;;; A plan announces what it has done by (on-event (make-instance 'object-attached ...)); whoever
;;;; keeps beliefs has methods on ON-EVENT.  An occasion, such as (object-in-hand ?object), is a
;;;; predicate of prolog; HOLDS asks for its solutions.

(in-package #:discrepancy-finder.plan-language)

(defclass event ()
  ()
  (:documentation "Something that has happened."))

(define-hook on-event (event)
  "Tell of EVENT.  Each method has a name of its own as its qualifier, and all are called.")

(defmacro define-events (&rest clauses)
  "Define classes of events; a clause is (name parent documentation (initarg documentation)*)."
  `(progn
     ,@(loop for (name parent documentation . slots) in clauses
             collect `(defclass ,name (,parent)
                        ,(loop for (initarg slot-documentation) in slots
                               for reader = (alexandria:symbolicate 'event- initarg)
                               collect `(,(alexandria:symbolicate '% reader)
                                         :initarg ,initarg :initform nil :reader ,reader
                                         :documentation ,slot-documentation))
                        (:documentation ,documentation)))))

(define-events
  (robot-state-changed event "The robot has moved.")
  (object-perceived-event event "An object was seen."
    (:object-designator "The designator of the object.")
    (:perception-source "Where this is known from."))
  (object-gripper-event event "Something between an object and a gripper has changed."
    (:object-name "The name of the object.")
    (:arm "The arm: :left or :right.")
    (:link "The link of the robot.")
    (:other-object-name "The name of another object.")
    (:grasp "The kind of grasp.")
    (:not-loose "True if other attachments stay."))
  (object-attached object-gripper-event "The robot has got hold of an object.")
  (object-detached object-gripper-event "The robot has let go of an object.")
  (container-handling-event event "A container was moved."
    (:joint-name "The name of its joint.")
    (:side "The arm: :left or :right.")
    (:environment "The name of the environment.")
    (:distance "By how much (m or rad)."))
  (container-opening-event container-handling-event "A container was opened.")
  (container-closing-event container-handling-event "A container was closed.")
  (object-location-changed event "An object is somewhere else now."
    (:object-name "The name of the object."))
  (object-updated event "What is known of an object has changed."
    (:object-name "The name of the object."))
  (object-removed event "An object is gone."
    (:object-name "The name of the object.")))

(defun event-documentation (reader)
  (format nil "Return the ~(~a~) of an event, or NIL."
          (substitute #\space #\- (subseq (symbol-name reader) (length "EVENT-")))))

(dolist (reader '(event-object-designator event-perception-source event-object-name event-arm
                  event-link event-other-object-name event-grasp event-not-loose
                  event-joint-name event-side event-environment event-distance))
  (setf (documentation reader 'function) (event-documentation reader)))

;;; Occasions

(prolog:def-fact-group occasions (object-in-hand object-picked object-put object-placed-at loc
                                  looking-at arms-parked gripper-opened gripper-closed
                                  torso-at tool-frames-at container-state robot-loc))

(loop for (name text) in
      '((object-in-hand "(object-in-hand ?object [?arm]): the robot holds the object.")
        (object-picked "(object-picked ?object): the object was picked up.")
        (object-put "(object-put ?object ?location): the object was put there.")
        (object-placed-at "(object-placed-at ?object ?location): the object is there.")
        (loc "(loc ?what ?location): a robot or an object is there.")
        (looking-at "(looking-at ?location): the robot looks there.")
        (arms-parked "(arms-parked): the arms are out of the way.")
        (gripper-opened "(gripper-opened ?gripper): the gripper is open.")
        (gripper-closed "(gripper-closed ?gripper): the gripper is closed.")
        (torso-at "(torso-at ?angle): the torso is at this position.")
        (tool-frames-at "(tool-frames-at ?left ?right): the tools are at these poses.")
        (container-state "(container-state ?container ?distance): it is opened so far.")
        (robot-loc "(robot-loc ?location): the robot is there."))
      do (setf (documentation name 'prolog:predicate) text))

(defun holds (occasion)
  "Return the lazy list of the binding sets for which OCCASION, a goal of prolog, holds now; NIL if
it does not."
  (prolog:prolog occasion))
