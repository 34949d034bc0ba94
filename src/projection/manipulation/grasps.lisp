;;;; Grasps: where a gripper can take hold of a thing.
;;;;
;;;; A gripper's frame, its tool, has the direction of approach as its x axis and the direction in
;;;; which the fingers close as its y axis; its origin is between the pads of the fingers.  A GRASP
;;;; is a pose of the tool in the frame of the thing.  FIND-GRASPS makes them from the thing's
;;;; shape, as a whole and in its parts: wherever it is thin enough for the open gripper it is
;;;; approached from all sides at right angles to that.  Each is tried out: the open hand must get
;;;; there without touching the thing, and have it between its pads then.  So a bowl is grasped at
;;;; its rim, a box at its sides and its top, a handle from the front.
;;;; The names of the sides are those of CRAM, in the thing's own frame: x is the front, y the left
;;;; side, z the top.

(in-package #:discrepancy-finder.projection)

(defstruct (hand (:copier nil))
  "An open gripper: PALM and FINGERS are lists of (pose shape) in the frame of the tool, OPENING the
distance (m) of the pads, REACH how far from the tool the palm begins, TIP how far the fingers go
beyond the tool."
  (palm '() :type list :read-only t)
  (fingers '() :type list :read-only t)
  (opening 0d0 :type double-float :read-only t)
  (reach 0d0 :type double-float :read-only t)
  (tip 0d0 :type double-float :read-only t))

(defstruct (grasp (:copier nil))
  "SIDE is :top, :bottom, :front, :back, :left-side or :right-side; TOOL is the pose of the tool in
the frame of the thing, DEPTH how far (m) the tool comes along its x axis until it is there."
  (side :top :type keyword :read-only t)
  (tool nil :type pose :read-only t)
  (depth 0.1d0 :type double-float :read-only t))

(defmethod print-object ((grasp grasp) stream)
  (print-unreadable-object (grasp stream :type t)
    (format stream "~(~a~) ~a" (grasp-side grasp) (grasp-tool grasp))))

(defparameter *finger-clearance* 2d-3
  "How far (m) each finger of the open gripper is from what it is to grasp, at the least.")

(defparameter *tip-clearance* 5d-3
  "How far (m) the tips of the fingers stay before the far side of what they grasp: behind it may be
what it lies on.")

(defparameter *approach-distance* 0.1d0
  "The length (m) of the straight way on which the hand comes to a grasp.")

(defconstant +approach-angles+ 12
  "From so many sides around the closing axis a thing is approached.")

(defun approach-side (approach)
  "Return the name of the side of a thing that is met first in the direction APPROACH."
  (loop with best = nil and most = -2
        for (side . normal) in '((:top 0 0 1) (:front 1 0 0) (:back -1 0 0) (:left-side 0 1 0)
                                 (:right-side 0 -1 0) (:bottom 0 0 -1))
        for alignment = (- (dot normal approach))
        when (> alignment (+ most 1d-9)) do (setf best side most alignment)
        finally (return best)))

(defun closing-axes (shape)
  "Return the directions in which SHAPE is squeezed."
  (flet ((around (steps)
           (loop for step below steps
                 for angle = (/ (* step pi) steps)
                 collect (list (cos angle) (sin angle) 0d0))))
    (case (first shape)
      ((:cylinder :sphere) (append (around 6) '((0d0 0d0 1d0))))
      (t '((1d0 0d0 0d0) (0d0 1d0 0d0) (0d0 0d0 1d0))))))

(defun approaches (closing)
  "Return directions at right angles to the unit vector CLOSING, from above first."
  (let* ((down (if (> (abs (third closing)) 0.9) '(-1d0 0d0 0d0) '(0d0 0d0 -1d0)))
         (first (unit (mapcar #'- down (stretched closing (dot down closing)))))
         (second (cross closing first)))
    (loop for step below +approach-angles+
          for angle = (/ (* 2 pi step) +approach-angles+)
          collect (unit (mapcar #'+ (stretched first (cos angle))
                                (stretched second (sin angle)))))))

(defun middle (shape pose direction)
  "Return the middle of the extent of SHAPE, at POSE, along DIRECTION, and half of its length."
  (let ((far (placed-support shape pose direction))
        (near (- (placed-support shape pose (stretched direction -1)))))
    (values (/ (+ far near) 2) (/ (- far near) 2))))

(defun candidate-grasp (hand shape pose closing approach)
  "Return the grasp in which HAND squeezes SHAPE, at POSE in the frame of the thing, along CLOSING
and comes along APPROACH; NIL if it is too wide."
  (let ((aside (cross closing approach)))
    (multiple-value-bind (across half-width) (middle shape pose closing)
      (multiple-value-bind (along half-depth) (middle shape pose approach)
        (when (<= (+ half-width *finger-clearance*) (/ (hand-opening hand) 2))
          (let ((ahead (min 0 (- (hand-reach hand) half-depth)
                            (- half-depth (hand-tip hand) *tip-clearance*))))
            (make-grasp :side (approach-side approach)
                        :tool (axes-pose (mapcar #'+ (stretched closing across)
                                                 (stretched aside (middle shape pose aside))
                                                 (stretched approach (+ along ahead)))
                                         approach closing)
                        :depth (max *approach-distance*
                                    (+ half-depth ahead (hand-tip hand) 0.02d0)))))))))

(defun thinnest-axes (part)
  "Return those of the CLOSING-AXES of PART along which it is thinnest: as a part of a thing it may
have neighbours at its other sides."
  (flet ((thickness (axis) (+ (support part axis) (support part (stretched axis -1)))))
    (let* ((axes (closing-axes part)) (least (reduce #'min (mapcar #'thickness axes))))
      (remove-if (lambda (axis) (> (thickness axis) (+ least 1d-6))) axes))))

(defun candidate-grasps (hand shape)
  "Return the grasps of SHAPE, and of its parts if it is a compound, that are narrow enough."
  (loop for (pose part . axes) in (cons (list* (identity-pose) shape (closing-axes shape))
                                        (and (eq (first shape) :compound)
                                             (loop for (pose part) in (rest shape)
                                                   collect (list* pose part
                                                                  (thinnest-axes part)))))
        append (loop for axis in axes
                     for closing = (unit (turned pose axis))
                     append (loop for approach in (approaches closing)
                                  for grasp = (candidate-grasp hand part pose closing approach)
                                  when grasp collect grasp))))

(defun pad-rays (hand tool)
  "Return the rays between the pads of HAND with its tool at the pose TOOL, for BULLET:CAST-RAYS."
  (let ((half (/ (hand-opening hand) 2)) (tip (hand-tip hand)))
    (coerce (loop for along in '(-0.9d0 -0.45d0 0d0 0.45d0 0.9d0)
                  append (loop for aside in '(-8d-3 0d0 8d-3)
                               append (loop for across in (list half (- half))
                                            append (pose-position
                                                    (compose tool (make-pose (* along tip) across
                                                                             aside))))))
            '(simple-array double-float (*)))))
