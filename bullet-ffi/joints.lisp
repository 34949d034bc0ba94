;;;; Joints: what one body can do relative to another one, or to the world.
;;;;
;;;; A :SLIDER moves along the x axis of its frame and a :HINGE turns about it, a :FIXED joint does
;;;; neither, a :SIX-DOF one whatever its limits leave.  The position of a slider (m) or hinge (rad)
;;;; is 0 where its bodies were when it was made.  Such a joint has a motor, which strives for a
;;;; velocity with at most some force; a motor with velocity 0 is friction.  Joined bodies do not
;;;; collide with each other.

(in-package #:discrepancy-finder.bullet)

(define-raw %joint-new "dfb_joint_new" :int
  (world :pointer) (type :int) (parent :int) (child :int) (frame :pointer) (limits :pointer))
(define-raw %joint-delete "dfb_joint_delete" :int (world :pointer) (joint :int))
(define-raw %joint-live "dfb_joint_live" :int (world :pointer) (joint :int))
(define-raw %joint-position "dfb_joint_position" :int
  (world :pointer) (joint :int) (position :pointer))
(define-raw %joint-place "dfb_joint_place" :int
  (world :pointer) (joint :int) (position :double))
(define-raw %joint-motor "dfb_joint_motor" :int
  (world :pointer) (joint :int) (velocity :double) (force :double))
(define-raw %joint-load "dfb_joint_load" :int (world :pointer) (joint :int) (load :pointer))

(defstruct (joint (:constructor %make-joint (id world name type parent child lower upper))
                  (:copier nil) (:predicate nil))
  "A joint between two bodies, or a body and the world."
  (id 0 :type (signed-byte 32) :read-only t)
  (world nil :type world :read-only t)
  (name nil :read-only t)
  (type nil :type (member :slider :hinge :fixed :six-dof) :read-only t)
  (parent nil :type (or null body) :read-only t)
  (child nil :type body :read-only t)
  (lower nil :type (or null double-float) :read-only t)
  (upper nil :type (or null double-float) :read-only t))

(setf (documentation 'joint-world 'function) "Return the world of JOINT."
      (documentation 'joint-name 'function) "Return the name of JOINT as it was given, or NIL."
      (documentation 'joint-type 'function) "Return :SLIDER, :HINGE, :FIXED or :SIX-DOF."
      (documentation 'joint-parent 'function)
      "Return the body that JOINT joins its child to, or NIL for the world."
      (documentation 'joint-child 'function) "Return the body that JOINT lets move."
      (documentation 'joint-lower 'function)
      "Return the lowest position of a slider (m) or hinge (rad), or NIL if it has no limits."
      (documentation 'joint-upper 'function)
      "Return the highest position of a slider (m) or hinge (rad), or NIL if it has no limits.")

(defmethod print-object ((joint joint) stream)
  (print-unreadable-object (joint stream :type t)
    (format stream "~@[~a ~]~(~a~) of ~a on ~:[the world~;~:*~a~]" (joint-name joint)
            (joint-type joint) (body-name (joint-child joint))
            (and (joint-parent joint) (body-name (joint-parent joint))))))

(defun limit-numbers (limits)
  "Return the twelve numbers for the six LIMITS, each a list (low high), or NIL for no limit."
  (let ((numbers (make-array 12 :element-type 'double-float)))
    (loop for limit in limits
          for i from 0 by 2
          do (unless (and (listp limit) (member (ignore-errors (list-length limit)) '(0 2)))
               (fail 'add-joint "~s is no limit; it should be a list of two numbers or nil" limit))
             (destructuring-bind (low high) (or limit '(1 -1))
               (let ((low (number-of "a limit" low 'add-joint))
                     (high (number-of "a limit" high 'add-joint)))
                 (when (and limit (> low high))
                   (fail 'add-joint "the limit ~s has its higher number first" limit))
                 (setf (aref numbers i) low
                       (aref numbers (1+ i)) high))))
    numbers))

(defun six-limits (linear angular)
  (dolist (limits (list linear angular))
    (unless (eql (ignore-errors (list-length limits)) 3)
      (fail 'add-joint "~s are no limits; they should be a list of three lists" limits)))
  (limit-numbers (append linear angular)))

(defun add-joint (world type parent child frame
                  &key lower upper name (linear '((0 0) (0 0) (0 0)))
                    (angular '((0 0) (0 0) (0 0))))
  "Join the body CHILD of WORLD, which is not static, to the body PARENT, or to the world if that is
NIL; return the joint.  FRAME is where it is, a pose in the world with the bodies as they are now: a
:SLIDER moves along its x axis and a :HINGE turns about it, both within LOWER and UPPER (m, rad;
both or neither), a :FIXED joint holds, and a :SIX-DOF one keeps the moves along x, y and z of FRAME
within the three limits LINEAR and the turns about them within ANGULAR; such a limit is a list (low
high), or NIL for none, and the turn about y must stay below a quarter.  NAME is for
FIND-JOINT.  Signals BULLET-ERROR if a body is of another world or the child static, NAME taken, or
a number wrong."
  (live-pointer world 'add-joint)
  (dolist (body (if parent (list parent child) (list child)))
    (unless (and (body-p body) (eq (body-world body) world))
      (fail 'add-joint "~:[~a~;body ~a~] is no body of this world" (body-p body)
            (if (body-p body) (body-name body) body))))
  (unless (geometry:pose-p frame)
    (fail 'add-joint "~s is no pose for a joint" frame))
  (when (and name (find-joint world name))
    (fail 'add-joint "the world has a joint ~a already" name))
  (unless (eq (null lower) (null upper))
    (fail 'add-joint "a joint has both limits or neither, not only ~s" (or lower upper)))
  (let ((code (or (position type '(:slider :hinge :fixed :six-dof))
                  (fail 'add-joint "~s is none of :slider, :hinge, :fixed and :six-dof" type)))
        (numbers (map '(simple-array double-float (7)) #'identity
                      (geometry:pose-components frame)))
        (limits (if (eq type :six-dof)
                    (six-limits linear angular)
                    (limit-numbers (list (and lower (list lower upper)))))))
    (cffi:with-pointer-to-vector-data (numbers-pointer numbers)
      (cffi:with-pointer-to-vector-data (limits-pointer limits)
        (invoke ('add-joint pointer world)
            (let ((id (%joint-new pointer code (if parent (body-id parent) -1) (body-id child)
                                  numbers-pointer limits-pointer)))
              (when (>= id 0)
                (vector-push-extend
                 (%make-joint id world name type parent child
                              (and lower (aref limits 0)) (and upper (aref limits 1)))
                 (world-joint-vector world)))
              id)
          (:bad-kind (format nil "body ~a is static and cannot move" (body-name child)))
          (:bad-number "the frame is not a finite position with a unit quaternion"))))
    (aref (world-joint-vector world) (1- (length (world-joint-vector world))))))

(defun joint-live-p (joint)
  "Return true until JOINT is removed or its world closed."
  (let ((world (joint-world joint)))
    (and (handle-usable-p (world-handle world))
         (= 1 (invoke ('joint-live-p pointer world) (%joint-live pointer (joint-id joint)))))))

(defun world-joints (world)
  "Return the list of the live joints of WORLD, in the order of their making."
  (remove-if-not #'joint-live-p (coerce (world-joint-vector world) 'list)))

(defun find-joint (world name)
  "Return the live joint of WORLD whose name is EQUAL to NAME, or NIL."
  (find-if (lambda (joint) (and (equal (joint-name joint) name) (joint-live-p joint)))
           (world-joint-vector world)))

(defun remove-joint (joint)
  "Let the bodies of JOINT go their ways.  To remove a joint twice is harmless.  Signals
BULLET-ERROR if the world was closed before."
  (let ((world (joint-world joint)))
    (live-pointer world 'remove-joint)
    (when (joint-live-p joint)
      (invoke ('remove-joint pointer world) (%joint-delete pointer (joint-id joint)))))
  (values))

(defun no-position (joint)
  (format nil "~a has no single position" joint))

(defun joint-position (joint)
  "Return the position of the slider (m) or hinge (rad) JOINT.  Signals BULLET-ERROR if it is
neither or was removed."
  (let ((position (make-array 1 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (position-pointer position)
      (invoke ('joint-position pointer (joint-world joint))
          (%joint-position pointer (joint-id joint) position-pointer)
        (:bad-kind (no-position joint))))
    (aref position 0)))

(defun set-joint-position (joint position)
  "Put the child of the slider or hinge JOINT to where JOINT has POSITION (m, rad), at rest there,
as PLACE-BODY does; return JOINT.  Signals BULLET-ERROR if POSITION is beyond its limits, JOINT
neither a slider nor a hinge, or removed."
  (let ((number (number-of "the position" position 'set-joint-position)))
    (invoke ('set-joint-position pointer (joint-world joint))
        (%joint-place pointer (joint-id joint) number)
      (:bad-number (format nil "~a is beyond the limits ~a and ~a of ~a" position
                           (joint-lower joint) (joint-upper joint) joint))
      (:bad-kind (no-position joint))))
  joint)

(defun set-motor (joint velocity force)
  "Let the motor of the slider or hinge JOINT strive for VELOCITY (m/s, rad/s) with at most FORCE
(N, Nm); return JOINT.  FORCE 0 lets it move freely, as at first; VELOCITY 0 with a FORCE is
friction.  Signals BULLET-ERROR if a number is out of range, JOINT neither a slider nor a hinge, or
removed."
  (let ((velocity (number-of "the velocity of a motor" velocity 'set-motor))
        (force (number-of "the force of a motor" force 'set-motor :not-negative)))
    (invoke ('set-motor pointer (joint-world joint))
        (%joint-motor pointer (joint-id joint) velocity force)
      (:bad-kind (no-position joint))))
  joint)

(defun joint-load (joint)
  "Return two lists of three numbers along the axes of the world: the force (N) and the torque about
the child's centre of mass (Nm) that JOINT put on its child in the last step.  Signals BULLET-ERROR
if JOINT was removed or the world is closed."
  (let ((load (make-array 6 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (load-pointer load)
      (invoke ('joint-load pointer (joint-world joint))
          (%joint-load pointer (joint-id joint) load-pointer)))
    (values (coerce (subseq load 0 3) 'list) (coerce (subseq load 3) 'list))))
