;;;; Attachments: a dynamic body fixed to another one, as a grasped item to a gripper.
;;;;
;;;; ATTACH fixes the child where it is relative to the parent; until DETACH the two do not collide
;;;; with each other, and the child stays awake.  ATTACHMENT-LOAD tells what the attachment had to
;;;; bear in the last step.
;;;;
;;;; With a CAPACITY the attachment is a grip of two fingers that hold by friction.  Let F be the
;;;; force on the child in the plane across the closing axis, T the torque about that axis at the
;;;; point of the grasp: the child is lost at the end of the step in which
;;;;
;;;;   (F / capacity)^2 + (T / (capacity torsion-radius))^2 > 1
;;;;
;;;; the limit surface of soft fingers.  The capacity is 2 mu N, for two pads with the coefficient
;;;; of friction mu that press with N; a pad of 4 x 2.5 cm has a torsion radius of about 12 mm.

(in-package #:discrepancy-finder.bullet)

(defstruct (attachment (:constructor %make-attachment (id parent child)) (:copier nil)
                       (:predicate nil))
  "A dynamic body, the child, fixed to another body, the parent."
  (id 0 :type (signed-byte 32) :read-only t)
  (parent nil :type body :read-only t)
  (child nil :type body :read-only t)
  (undone nil :type (member t nil)))      ; by a checkpoint of an earlier time

(setf (documentation 'attachment-parent 'function) "Return the body that holds."
      (documentation 'attachment-child 'function) "Return the body that is held.")

(defmethod print-object ((attachment attachment) stream)
  (print-unreadable-object (attachment stream :type t)
    (format stream "~a ~:[held~;holds~] ~a" (body-name (attachment-parent attachment))
            (attachment-live-p attachment) (body-name (attachment-child attachment)))))

(defun attachment-world (attachment)
  (body-world (attachment-parent attachment)))

(defun attachment-state (attachment operation)
  "Return 1 if ATTACHMENT holds, 0 if it was removed, 2 if the child was lost, and as second value
its utilization in the last step."
  (if (attachment-undone attachment)
      (values 0 0d0)
      (let ((utilization (make-array 1 :element-type 'double-float)))
        (cffi:with-pointer-to-vector-data (utilization-pointer utilization)
          (values (invoke (operation pointer (attachment-world attachment))
                      (%attachment-state pointer (attachment-id attachment) utilization-pointer))
                  (aref utilization 0))))))

(defun attachment-live-p (attachment)
  "Return true until ATTACHMENT is detached, its child lost, or its world closed."
  (and (handle-usable-p (world-handle (attachment-world attachment)))
       (= 1 (attachment-state attachment 'attachment-live-p))))

(defun attachment-lost-p (attachment)
  "Return true if ATTACHMENT was a grip whose child was lost because the load was more than its
capacity.  Signals BULLET-ERROR if the world is closed."
  (= 2 (attachment-state attachment 'attachment-lost-p)))

(defun attachment-utilization (attachment)
  "Return which part of what it can hold the grip ATTACHMENT bore in the last step: 1 at its limit,
more in the step in which the child was lost; 0 for an attachment without a capacity.  Signals
BULLET-ERROR if the world is closed."
  (nth-value 1 (attachment-state attachment 'attachment-utilization)))

(defun attachments (world)
  "Return the list of the live attachments of WORLD, in the order of their making."
  (when (handle-usable-p (world-handle world))
    (remove-if-not #'attachment-live-p (coerce (world-attachment-vector world) 'list))))

(defun three-numbers (thing numbers operation)
  "Return a new vector of the three NUMBERS of the list of THING."
  (unless (and (eql (ignore-errors (list-length numbers)) 3) (every #'realp numbers))
    (fail operation "~a is ~s, but must be a list of three numbers" thing numbers))
  (map '(simple-array double-float (3)) (lambda (number) (number-of thing number operation))
       numbers))

(defun attach-grip (pointer parent child point axis capacity torsion-radius)
  "Return what the shim says."
  (cffi:with-pointer-to-vector-data (point-pointer point)
    (cffi:with-pointer-to-vector-data (axis-pointer axis)
      (%grip pointer (body-id parent) (body-id child) point-pointer axis-pointer
             capacity torsion-radius))))

(defun attach (parent child &key (point (geometry:identity-pose)) (axis '(0 1 0)) capacity
                              (torsion-radius 0.012d0))
  "Fix the dynamic body CHILD to the body PARENT, of any kind, where the two are now; return the
attachment.  With a CAPACITY (N) it is a grip that the child can be pulled out of: POINT is a pose
in the child's link frame whose position is where the fingers hold, AXIS a unit vector, as a list,
in the parent's link frame, on which they close, TORSION-RADIUS in m.  Signals BULLET-ERROR if
CHILD is not dynamic, they are not two bodies of one world, or a number is out of its range."
  (let ((world (same-world parent child 'attach)))
    (macrolet ((make (call)
                 `(invoke ('attach pointer world)
                      (let ((id ,call))
                        (when (>= id 0)
                          (vector-push-extend (%make-attachment id parent child)
                                              (world-attachment-vector world)))
                        id)
                    (:bad-number "the axis of a grip must have length 1")
                    (:bad-kind (format nil "body ~a is ~(~a~), and only dynamic bodies can be ~
                                            attached"
                                       (body-name child) (body-kind child))))))
      (if capacity
          (let ((capacity (number-of "the capacity of a grip" capacity 'attach :positive))
                (radius (number-of "the torsion radius of a grip" torsion-radius 'attach :positive))
                (axis (three-numbers "the axis of a grip" axis 'attach))
                (point (subseq (geometry:pose-components point) 0 3)))
            (make (attach-grip pointer parent child
                               (three-numbers "the point of a grip" point 'attach)
                               axis capacity radius)))
          (make (%attach pointer (body-id parent) (body-id child)))))
    (aref (world-attachment-vector world) (1- (length (world-attachment-vector world))))))

(defun detach (attachment)
  "Free the child of ATTACHMENT; it is awake and keeps its velocity.  To detach what does not hold
any more is harmless.  Signals BULLET-ERROR if the world was closed before."
  (when (= 1 (attachment-state attachment 'detach))
    (invoke ('detach pointer (attachment-world attachment))
        (%detach pointer (attachment-id attachment))))
  (values))

(defun attachment-load (attachment)
  "Return two lists of three numbers along the axes of the world: the force (N) and the torque about
the child's centre of mass (Nm) that ATTACHMENT put on the child in the last step.  Signals
BULLET-ERROR if ATTACHMENT does not hold or the world is closed."
  (when (attachment-undone attachment)
    (fail 'attachment-load "the attachment is not there any more"))
  (let ((load (make-array 6 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (load-pointer load)
      (invoke ('attachment-load pointer (body-world (attachment-parent attachment)))
          (%attachment-load pointer (attachment-id attachment) load-pointer)))
    (values (coerce (subseq load 0 3) 'list) (coerce (subseq load 3) 'list))))
