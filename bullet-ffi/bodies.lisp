;;;; Bodies: adding, posing, waking.
;;;;
;;;; A :STATIC body stays where it is, a :DYNAMIC one obeys forces, a :KINEMATIC one is moved by the
;;;; program (MOVE-BODY) and pushes or drags dynamic ones.  Static and kinematic bodies pass through
;;;; each other.  A dynamic body that has been slower than 0.01 m/s and 0.05 rad/s for 0.2 s falls
;;;; asleep, and costs nothing until something touches it; so does a kinematic one that has not
;;;; been moved for 0.2 s.

(in-package #:discrepancy-finder.bullet)

(defstruct (body (:constructor %make-body (world id name shape kind mass)) (:copier nil))
  "A rigid body of a world."
  (world nil :type world :read-only t)
  (id 0 :type (signed-byte 32) :read-only t)
  (name nil :read-only t)
  (shape nil :type list :read-only t)
  (kind nil :type (member :static :dynamic :kinematic) :read-only t)
  (mass 0d0 :type double-float :read-only t))

(setf (documentation 'body-world 'function) "Return the world of BODY."
      (documentation 'body-name 'function) "Return the name of BODY, unique in its world."
      (documentation 'body-shape 'function) "Return the shape of BODY, as it was given to ADD-BODY."
      (documentation 'body-kind 'function) "Return :STATIC, :DYNAMIC or :KINEMATIC."
      (documentation 'body-mass 'function) "Return the mass of BODY as it was given (kg).")

(defmethod print-object ((body body) stream)
  (print-unreadable-object (body stream :type t)
    (format stream "~a ~(~a~)~@[ ~,3f kg~]" (body-name body) (body-kind body)
            (and (eq (body-kind body) :dynamic) (body-mass body)))))

(defmacro with-pose-numbers ((pose) call)
  "Return the value of CALL, in which X Y Z QX QY QZ QW are the numbers of POSE."
  `(let ((x (geometry:pose-x ,pose)) (y (geometry:pose-y ,pose)) (z (geometry:pose-z ,pose))
         (qx (geometry:pose-qx ,pose)) (qy (geometry:pose-qy ,pose))
         (qz (geometry:pose-qz ,pose)) (qw (geometry:pose-qw ,pose)))
     ,call))

(defun bad-pose (name)
  (format nil "the pose for body ~a is not a finite position with a unit quaternion" name))

(defun inertia-of (inertia shape mass owner)
  "Return the list of three moments for a dynamic body: INERTIA, or else those of SHAPE and MASS."
  (let ((moments (or inertia (shape-inertia shape mass))))
    (unless (eql (ignore-errors (list-length moments)) 3)
      (fail 'add-body "the inertia ~s of ~a is no list of three moments" moments
            (described owner)))
    (loop for moment in moments
          collect (number-of (list "a moment of inertia of ~?" (first owner) (rest owner))
                             moment 'add-body :positive))))

(defun register-body (body)
  (let ((world (body-world body)))
    (setf (gethash (body-name body) (world-body-names world)) body)
    (vector-push-extend body (world-body-vector world))))

(defun put-pose (pose numbers start)
  "Write the seven numbers of POSE into NUMBERS from START on."
  (declare (type (simple-array double-float (*)) numbers) (type fixnum start))
  (with-pose-numbers (pose)
    (loop for number of-type double-float in (list x y z qx qy qz qw)
          for index of-type fixnum from start
          do (setf (aref numbers index) number))))

(defun make-body (world name shape pose kind mass inertia inertial-pose material)
  "Return a new body, registered in WORLD.  Only the poses, SHAPE and INERTIA are still to be
checked; MATERIAL is a list of five numbers."
  (let ((numbers (make-array 23 :element-type 'double-float))
        (owner (list "body ~a" name))
        (body nil))
    (put-pose pose numbers 0)
    (setf (aref numbers 7) mass)
    (put-pose inertial-pose numbers 11)
    (replace numbers material :start1 18)
    (with-shape (shape-pointer shape owner)
      (when (eq kind :dynamic)
        (replace numbers (inertia-of inertia shape mass owner) :start1 8))
      (cffi:with-pointer-to-vector-data (pointer numbers)
        (let ((mass-numbers (cffi:inc-pointer pointer (* 8 7)))
              (material-numbers (cffi:inc-pointer pointer (* 8 18))))
          (invoke ('add-body world-pointer world)
              (let ((id (%body-new world-pointer shape-pointer
                                   (ecase kind (:static 0) (:dynamic 1) (:kinematic 2))
                                   pointer mass-numbers material-numbers)))
                (when (>= id 0)
                  (setf body (%make-body world id name shape kind mass))
                  (register-body body))
                id)
            (:bad-number (bad-pose name))))))
    body))

(defun add-body (world name shape pose
                 &key (mass 0d0) (kind (if (member mass '(0 0f0 0d0)) :static :dynamic)) inertia
                   (inertial-pose (geometry:identity-pose)) (friction 0.5d0)
                   (rolling-friction 0d0) (restitution 0d0) (linear-damping 0d0)
                   (angular-damping 0d0))
  "Add to WORLD a body with NAME, SHAPE (see shapes.lisp) and its link frame at POSE; return it.
KIND is :STATIC, :KINEMATIC or :DYNAMIC; the last needs a positive MASS (kg), and is the default if
MASS is given.  INERTIAL-POSE is the pose in the link frame of the body's principal axes of inertia,
with its centre of mass as origin; INERTIA is the list of the moments (kg m^2) about them, by
default those of SHAPE filled evenly about its origin.  The friction of two bodies in contact is the
product of their FRICTION, and so is their RESTITUTION; ROLLING-FRICTION (m) also acts against
spinning on a spot; LINEAR-DAMPING and ANGULAR-DAMPING, 0 to 1, are the parts of its velocities that
the body loses in a second.  Signals BULLET-ERROR, which names the body and the thing, if NAME is
taken, SHAPE malformed, a pose no finite position with a unit quaternion, or a number out of its
range."
  (live-pointer world 'add-body)
  (flet ((number (thing value sort)
           (number-of (list "the ~a of body ~a" thing name) value 'add-body sort)))
    (declare (inline number))
    (let ((mass (number "mass" mass (if (eq kind :dynamic) :positive :not-negative)))
          (material (list (number "friction" friction :not-negative)
                          (number "rolling friction" rolling-friction :not-negative)
                          (number "restitution" restitution :fraction)
                          (number "linear damping" linear-damping :fraction)
                          (number "angular damping" angular-damping :fraction))))
      (when (find-body world name)
        (fail 'add-body "the world has a body ~a already" name))
      (dolist (pose (list pose inertial-pose))
        (unless (geometry:pose-p pose)
          (fail 'add-body "~s is no pose for body ~a" pose name)))
      (unless (member kind '(:static :dynamic :kinematic))
        (fail 'add-body "the kind ~s of body ~a is none of :static, :dynamic and :kinematic"
              kind name))
      (when (and (not (eq kind :static)) (consp shape) (eq (first shape) :plane))
        (fail 'add-body "body ~a is ~(~a~), but only static bodies can be planes" name kind))
      (make-body world name shape pose kind mass inertia inertial-pose material))))

(defun body-state (body operation)
  "Return the thirteen numbers of the state of BODY in a new vector."
  (let ((state (make-array 13 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (state-pointer state)
      (invoke (operation pointer (body-world body))
          (%body-read pointer (body-id body) state-pointer)))
    state))

(defun body-pose (body)
  "Return the pose of the link frame of BODY.  Its quaternion comes from a rotation matrix: it
may differ in the last bits, and in sign, from the one that was put in.  Signals BULLET-ERROR if
the world is closed."
  (let ((state (body-state body 'body-pose)))
    (declare (type (simple-array double-float (13)) state))
    (geometry:quaternion-pose (aref state 0) (aref state 1) (aref state 2) (aref state 3)
                              (aref state 4) (aref state 5) (aref state 6))))

(defun body-velocity (body)
  "Return six values: the linear (m/s) velocity of the centre of mass of BODY and its angular one
(rad/s), along the axes of the world.  Signals BULLET-ERROR if the world is closed."
  (let ((state (body-state body 'body-velocity)))
    (declare (type (simple-array double-float (13)) state))
    (values (aref state 7) (aref state 8) (aref state 9)
            (aref state 10) (aref state 11) (aref state 12))))

(defun move-body (body pose)
  "Move the link frame of the kinematic BODY to POSE: in the next step it has the velocity that
takes it there, so that it pushes and drags what it touches.  Not moved in the step after that, it
stands still.  Return BODY.  Signals BULLET-ERROR if BODY is not kinematic or POSE no finite
position with a unit quaternion."
  (declare (optimize speed (safety 1)) (type body body) (type geometry:pose pose))
  (with-pose-numbers (pose)
    (invoke ('move-body pointer (body-world body))
        (%body-move pointer (body-id body) x y z qx qy qz qw)
      (:bad-number (bad-pose (body-name body)))
      (:bad-kind (format nil "body ~a is ~(~a~), not kinematic" (body-name body)
                         (body-kind body)))))
  body)

(defun place-body (body pose)
  "Put BODY, of any kind, to POSE, at rest there; return BODY.  A dynamic body wakes up, and so do
those that touched BODY.  An attachment would pull a body back that is placed alone.  Signals
BULLET-ERROR if POSE is no finite position with a unit quaternion."
  (check-type pose geometry:pose)
  (with-pose-numbers (pose)
    (invoke ('place-body pointer (body-world body))
        (%body-place pointer (body-id body) x y z qx qy qz qw)
      (:bad-number (bad-pose (body-name body)))))
  body)

(defun wake (body)
  "Wake BODY, if it is dynamic and sleeps; return BODY.  Signals BULLET-ERROR if the world is
closed."
  (invoke ('wake pointer (body-world body)) (%body-wake pointer (body-id body)))
  body)

(defun allow-sleep (body flag)
  "Let the dynamic BODY fall asleep when it rests, as at first, or keep it awake if FLAG is NIL;
return BODY.  Signals BULLET-ERROR if BODY is not dynamic."
  (invoke ('allow-sleep pointer (body-world body))
      (%body-allow-sleep pointer (body-id body) (if flag 1 0))
    (:bad-kind (format nil "body ~a is ~(~a~), not dynamic" (body-name body) (body-kind body))))
  body)

(defun asleep-p (body)
  "Return true if BODY sleeps; static bodies always do.  Signals BULLET-ERROR if the world is
closed."
  (= 1 (invoke ('asleep-p pointer (body-world body)) (%body-asleep pointer (body-id body)))))

(defun same-world (a b operation)
  "Return the world of the bodies A and B."
  (unless (eq (body-world a) (body-world b))
    (fail operation "body ~a and body ~a are in different worlds" (body-name a) (body-name b)))
  (body-world a))

(defun ignore-collision (a b flag)
  "Let the bodies A and B pass through each other, or collide again if FLAG is NIL.  Signals
BULLET-ERROR if they are not two bodies of one world."
  (let ((world (same-world a b 'ignore-collision)))
    (invoke ('ignore-collision pointer world)
        (%ignore-collision pointer (body-id a) (body-id b) (if flag 1 0))))
  (values))
