;;;; Attachments: a dynamic body fixed to another one, as a grasped item to a gripper.
;;;;
;;;; ATTACH fixes the child where it is relative to the parent; until DETACH the two do not collide
;;;; with each other, and the child stays awake.  ATTACHMENT-LOAD tells what the attachment had to
;;;; bear in the last step: from it follows whether a real grip would have held.

(in-package #:discrepancy-finder.bullet)

(defstruct (attachment (:constructor %make-attachment (id parent child)) (:copier nil)
                       (:predicate nil))
  "A dynamic body, the child, fixed to another body, the parent."
  (id 0 :type (signed-byte 32) :read-only t)
  (parent nil :type body :read-only t)
  (child nil :type body :read-only t)
  (attached t :type (member t nil)))

(setf (documentation 'attachment-parent 'function) "Return the body that holds."
      (documentation 'attachment-child 'function) "Return the body that is held.")

(defmethod print-object ((attachment attachment) stream)
  (print-unreadable-object (attachment stream :type t)
    (format stream "~a ~:[held~;holds~] ~a" (body-name (attachment-parent attachment))
            (attachment-live-p attachment) (body-name (attachment-child attachment)))))

(defun attachment-live-p (attachment)
  "Return true until ATTACHMENT is detached or its world closed."
  (and (attachment-attached attachment)
       (handle-usable-p (world-handle (body-world (attachment-parent attachment))))))

(defun attachments (world)
  "Return the list of the live attachments of WORLD, in the order of their making."
  (when (handle-usable-p (world-handle world))
    (reverse (world-attachment-list world))))

(defun attach (parent child)
  "Fix the dynamic body CHILD to the body PARENT, of any kind, where the two are now; return the
attachment.  Signals BULLET-ERROR if CHILD is not dynamic or they are not two bodies of one world."
  (let ((world (same-world parent child 'attach)))
    (invoke ('attach pointer world)
        (let ((id (%attach pointer (body-id parent) (body-id child))))
          (when (>= id 0)
            (push (%make-attachment id parent child) (world-attachment-list world)))
          id)
      (:bad-kind (format nil "body ~a is ~(~a~), and only dynamic bodies can be attached"
                         (body-name child) (body-kind child))))
    (first (world-attachment-list world))))

(defun detach (attachment)
  "Free the child of ATTACHMENT; it is awake and keeps its velocity.  Detaching twice is harmless.
Signals BULLET-ERROR if the world was closed before."
  (when (attachment-attached attachment)
    (let ((world (body-world (attachment-parent attachment))))
      (invoke ('detach pointer world)
          (prog1 (%detach pointer (attachment-id attachment))
            (setf (attachment-attached attachment) nil
                  (world-attachment-list world)
                  (remove attachment (world-attachment-list world)))))))
  (values))

(defun attachment-load (attachment)
  "Return two lists of three numbers along the axes of the world: the force (N) and the torque about
the child's centre of mass (Nm) that ATTACHMENT put on the child in the last step.  Signals
BULLET-ERROR if ATTACHMENT is detached or the world closed."
  (let ((load (make-array 6 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (load-pointer load)
      (invoke ('attachment-load pointer (body-world (attachment-parent attachment)))
          (%attachment-load pointer (attachment-id attachment) load-pointer)))
    (values (coerce (subseq load 0 3) 'list) (coerce (subseq load 3) 'list))))
