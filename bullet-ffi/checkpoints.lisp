;;;; Checkpoints: the state of a world, to which it, or another one of the same structure, returns.
;;;;
;;;; A world that goes on after MAKE-CHECKPOINT and a world to which the checkpoint is restored have
;;;; the same bits ever after, if the same is done to them: both forget what Bullet remembers beyond
;;;; states, as the contacts of the last step.  That changes how a world goes on by what one step
;;;; without such memory changes: some hundredths of a millimetre where things lie on each other.
;;;;
;;;; A world of the same structure is one with equal bodies and joints, made in the same order.
;;;; Attachments, ignored collisions, motors and removed joints are state.  So an attachment that
;;;; was made after the checkpoint is undone, and one that was removed after it is there again, as
;;;; the same object; in another world ATTACHMENTS returns its own.

(in-package #:discrepancy-finder.bullet)

(define-raw %checkpoint-size "dfb_checkpoint_size" :int (world :pointer))
(define-raw %checkpoint-make "dfb_checkpoint_make" :int
  (world :pointer) (checkpoint :pointer) (length :int))
(define-raw %checkpoint-restore "dfb_checkpoint_restore" :int
  (world :pointer) (checkpoint :pointer) (length :int))

(defstruct (checkpoint (:constructor %make-checkpoint (steps numbers pairs)) (:copier nil))
  "The state of a world at some time."
  (steps 0 :type (and fixnum unsigned-byte) :read-only t)
  (numbers nil :type (simple-array double-float (*)) :read-only t)
  (pairs '() :type list :read-only t))    ; the ids of the two bodies of each attachment

(setf (documentation 'checkpoint-p 'function) "Return true if OBJECT is a checkpoint.")

(defmethod print-object ((checkpoint checkpoint) stream)
  (print-unreadable-object (checkpoint stream :type t)
    (format stream "after ~d step~:p" (checkpoint-steps checkpoint))))

(defun attachment-pair (attachment)
  (cons (body-id (attachment-parent attachment)) (body-id (attachment-child attachment))))

(defun make-checkpoint (world)
  "Return a checkpoint of WORLD as it is now, and let WORLD forget what a checkpoint does not hold.
Signals BULLET-ERROR if WORLD is closed."
  (let* ((length (invoke ('make-checkpoint pointer world) (%checkpoint-size pointer)))
         (numbers (make-array length :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (numbers-pointer numbers)
      (invoke ('make-checkpoint pointer world)
          (%checkpoint-make pointer numbers-pointer length)))
    (%make-checkpoint (world-steps world) numbers
                      (map 'list #'attachment-pair (world-attachment-vector world)))))

(defun match-attachments (world pairs)
  "Let WORLD have an attachment for each of PAIRS, those that it has wherever they fit."
  (let* ((attachments (world-attachment-vector world))
         (bodies (world-body-vector world))
         (fitting (loop for (parent . child) in pairs
                        for id from 0
                        for present = (and (< id (length attachments)) (aref attachments id))
                        collect (if (and present
                                         (equal (attachment-pair present) (cons parent child)))
                                    present
                                    (%make-attachment id (aref bodies parent)
                                                      (aref bodies child))))))
    (loop for attachment across attachments
          unless (eq attachment (nth (attachment-id attachment) fitting))
            do (setf (attachment-undone attachment) t))
    (setf (fill-pointer attachments) 0)
    (dolist (attachment fitting)
      (vector-push-extend attachment attachments))))

(defun restore-checkpoint (world checkpoint)
  "Return WORLD to the state of CHECKPOINT, which was made of it or of a world of the same
structure; return WORLD.  Signals BULLET-ERROR if the structure of WORLD is another one or it is
closed."
  (check-type checkpoint checkpoint)
  (let ((numbers (checkpoint-numbers checkpoint)))
    (cffi:with-pointer-to-vector-data (numbers-pointer numbers)
      (invoke ('restore-checkpoint pointer world)
          (let ((status (%checkpoint-restore pointer numbers-pointer (length numbers))))
            (when (>= status 0)
              (setf (world-steps world) (checkpoint-steps checkpoint))
              (match-attachments world (checkpoint-pairs checkpoint)))
            status)
        (:bad-checkpoint "the checkpoint is of a world with other bodies or joints"))))
  world)
