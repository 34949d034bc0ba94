;;;; Observers: how fluents are seen in a projection.
;;;;
;;;; A PLACEMENT says that a body's pose lies in a region, a JOINT that a joint's position lies in a
;;;; range, an ATTACHMENT that the robot holds an item, a COORDINATE that one coordinate of a body
;;;; lies in a range, and a COMPUTED observer asks a function.  The first two can also be sampled:
;;;; they say where a body or a joint is if the fluent holds.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (placement (:copier nil))
  "The fluent PATTERN, whose argument with the number PLACE stands for a region, holds of the region
that the pose of BODY lies in.  COORDINATES is a list of (axis min max), what is sampled; without
min and max the region bounds the axis, and with :MIDDLE for MIN the axis has the width MAX in the
middle of these bounds.  REGIONS are the candidates."
  (pattern '() :type list :read-only t)
  (place 0 :type (integer 0) :read-only t)
  (body nil :type keyword :read-only t)
  (coordinates '() :type list :read-only t)
  (regions '() :type list :read-only t))

(defstruct (joint-range (:copier nil))
  "The ground fluent ATOM holds if the position of the joint named JOINT is in [MIN, MAX].
OTHERWISE is the range (min max) from which the position is drawn where no fluent of the joint
holds, or NIL."
  (atom '() :type list :read-only t)
  (joint "" :type string :read-only t)
  (min 0d0 :type double-float :read-only t)
  (max 0d0 :type double-float :read-only t)
  (otherwise nil :type list :read-only t))

(defstruct (attachment (:copier nil))
  "The ground fluent ATOM holds if the robot holds ITEM, with ARM or, if that is NIL, with any arm."
  (atom '() :type list :read-only t)
  (item nil :type keyword :read-only t)
  (arm nil :type (or null keyword) :read-only t))

(defstruct (coordinate-range (:copier nil))
  "The ground fluent ATOM holds if the coordinate AXIS of BODY is in [MIN, MAX[."
  (atom '() :type list :read-only t)
  (body nil :type keyword :read-only t)
  (axis nil :type keyword :read-only t)
  (min 0d0 :type double-float :read-only t)
  (max 0d0 :type double-float :read-only t))

(defstruct (computed (:copier nil))
  "The ground fluent ATOM holds if FUNCTION returns true of the projection and ARGUMENTS."
  (atom '() :type list :read-only t)
  (function nil :type symbol :read-only t)
  (arguments '() :type list :read-only t))

(defun placement-atom (placement region)
  "Return the ground fluent that holds if the body of PLACEMENT is in REGION."
  (let ((atom (copy-list (placement-pattern placement))))
    (setf (nth (placement-place placement) atom) (region-name region))
    atom))

(defun in-coordinate-range-p (range value)
  "Return true if VALUE (m or rad) is one for which the fluent of RANGE holds."
  (and (<= (coordinate-range-min range) value) (< value (coordinate-range-max range))))

(defgeneric observe (observer projection)
  (:documentation "Return the list of (atom . truth) that OBSERVER sees in PROJECTION.")
  (:method ((placement placement) projection)
    (let ((pose (projection:observed-pose projection (placement-body placement))))
      (loop for region in (placement-regions placement)
            collect (cons (placement-atom placement region) (inside-region-p pose region)))))
  (:method ((range joint-range) projection)
    (let ((position (projection:observed-joint projection (joint-range-joint range))))
      (list (cons (joint-range-atom range)
                  (<= (joint-range-min range) position (joint-range-max range))))))
  (:method ((range coordinate-range) projection)
    (let ((value (coordinate (projection:observed-pose projection (coordinate-range-body range))
                             (coordinate-range-axis range))))
      (list (cons (coordinate-range-atom range) (in-coordinate-range-p range value)))))
  (:method ((attachment attachment) projection)
    (list (cons (attachment-atom attachment)
                (loop for (arm . item) in (projection:held-items projection)
                        thereis (and (eq item (attachment-item attachment))
                                     (or (null (attachment-arm attachment))
                                         (eq arm (attachment-arm attachment))))))))
  (:method ((computed computed) projection)
    (list (cons (computed-atom computed)
                (and (apply (computed-function computed) projection
                            (computed-arguments computed))
                     t)))))
