;;;; Stamped values: poses, transforms, points and vectors that say in which frame they are given
;;;; and from when they are.
;;;;
;;;; A frame is named by a string; what a frame is, frames.lisp knows.  A stamp is a time (s); 0
;;;; stands for the latest, as in ROS.

(in-package #:discrepancy-finder.transforms)

(define-component frame-id "a stamped value"
  "Return the name of the frame in which a stamped value is given, a string.")
(define-component stamp "a stamped value"
  "Return the time (s) of a stamped value, a double float.")
(define-component child-frame-id "a transform-stamped"
  "Return the name of the frame from which a stamped transform leads, a string.")

(defclass stamped ()
  ((frame-id :initarg :frame-id :initform "" :reader frame-id
             :documentation "The name of the frame, a string.")
   (stamp :initarg :stamp :initform 0d0 :reader stamp :documentation "The time (s)."))
  (:documentation "What is given in a frame and has a time."))

(defclass pose-stamped (pose stamped)
  ()
  (:documentation "A pose in a frame; MAKE-POSE-STAMPED makes one."))

(defclass transform-stamped (transform stamped)
  ((child-frame-id :initarg :child-frame-id :initform "" :reader child-frame-id
                   :documentation "The name of the frame from which it leads, a string."))
  (:documentation "The transform from the coordinates in a child frame to those in a frame;
MAKE-TRANSFORM-STAMPED makes one."))

(defclass point-stamped (3d-vector stamped)
  ()
  (:documentation "A position in a frame; MAKE-POINT-STAMPED makes one."))

(defclass vector-stamped (3d-vector stamped)
  ()
  (:documentation "A direction in a frame; MAKE-VECTOR-STAMPED makes one."))

(defmethod initialize-instance :after ((thing stamped) &key)
  (ensure-kind (frame-id thing) 'string "the frame-id of a stamped value")
  (with-slots (stamp) thing
    (setf stamp (finite-double stamp "the stamp of a stamped value"))))

(defmethod initialize-instance :after ((transform transform-stamped) &key)
  (ensure-kind (child-frame-id transform) 'string "the child-frame-id of a transform-stamped"))

(defun stamp-text (thing)
  (format nil "FRAME-ID: ~s,~@[ CHILD-FRAME-ID: ~s,~] STAMP: ~a"
          (frame-id thing)
          (and (typep thing 'transform-stamped) (child-frame-id thing))
          (stamp thing)))

(defmethod print-object ((pose pose-stamped) stream)
  (print-value pose stream (stamp-text pose) (origin pose) (orientation pose)))

(defmethod print-object ((transform transform-stamped) stream)
  (print-value transform stream
               (stamp-text transform) (translation transform) (rotation transform)))

(defmethod print-object ((point point-stamped) stream)
  (print-value point stream (stamp-text point) (copy-3d-vector point)))

(defmethod print-object ((vector vector-stamped) stream)
  (print-value vector stream (stamp-text vector) (copy-3d-vector vector)))

;;; Making and copying

(defun make-pose-stamped (frame-id stamp origin orientation)
  "Return the POSE-STAMPED at the 3d-vector ORIGIN with the quaternion ORIENTATION in the frame
named FRAME-ID at the time STAMP (s).  Signals UNSUITABLE-VALUE if one of them is something else."
  (make-instance 'pose-stamped :frame-id frame-id :stamp stamp
                               :origin origin :orientation orientation))

(defun copy-pose-stamped (pose &key frame-id stamp origin orientation)
  "Return a POSE-STAMPED like the pose-stamped POSE, but with the FRAME-ID, STAMP, ORIGIN and
ORIENTATION that are given."
  (make-pose-stamped (or frame-id (frame-id pose)) (or stamp (stamp pose))
                     (or origin (origin pose)) (or orientation (orientation pose))))

(defun make-transform-stamped (frame-id child-frame-id stamp translation rotation)
  "Return the TRANSFORM-STAMPED from the frame named CHILD-FRAME-ID to the one named FRAME-ID at the
time STAMP (s), with the 3d-vector TRANSLATION and the quaternion ROTATION.  Signals
UNSUITABLE-VALUE if one of them is something else."
  (make-instance 'transform-stamped
                 :frame-id frame-id :child-frame-id child-frame-id :stamp stamp
                 :translation translation :rotation rotation))

(defun copy-transform-stamped (transform &key frame-id child-frame-id stamp translation rotation)
  "Return a TRANSFORM-STAMPED like TRANSFORM, but with the FRAME-ID, CHILD-FRAME-ID, STAMP,
TRANSLATION and ROTATION that are given."
  (make-transform-stamped (or frame-id (frame-id transform))
                          (or child-frame-id (child-frame-id transform))
                          (or stamp (stamp transform))
                          (or translation (translation transform))
                          (or rotation (rotation transform))))

(defun make-point-stamped (frame-id stamp 3d-vector)
  "Return the POINT-STAMPED at the position 3D-VECTOR (m) in the frame named FRAME-ID at the time
STAMP (s)."
  (make-instance 'point-stamped :frame-id frame-id :stamp stamp
                                :x (x 3d-vector) :y (y 3d-vector) :z (z 3d-vector)))

(defun copy-point-stamped (point &key frame-id stamp origin)
  "Return a POINT-STAMPED like POINT, but with the FRAME-ID, the STAMP and the coordinates of the
3d-vector ORIGIN that are given."
  (make-point-stamped (or frame-id (frame-id point)) (or stamp (stamp point)) (or origin point)))

(defun make-vector-stamped (frame-id stamp 3d-vector)
  "Return the VECTOR-STAMPED with the coordinates of 3D-VECTOR (m) in the frame named FRAME-ID at
the time STAMP (s)."
  (make-instance 'vector-stamped :frame-id frame-id :stamp stamp
                                 :x (x 3d-vector) :y (y 3d-vector) :z (z 3d-vector)))

(defun copy-vector-stamped (vector &key frame-id stamp origin)
  "Return a VECTOR-STAMPED like VECTOR, but with the FRAME-ID, the STAMP and the coordinates of the
3d-vector ORIGIN that are given."
  (make-vector-stamped (or frame-id (frame-id vector)) (or stamp (stamp vector))
                       (or origin vector)))

;;; From one kind to another

(defun pose->pose-stamped (frame-id stamp pose)
  "Return POSE as a POSE-STAMPED in the frame named FRAME-ID at the time STAMP (s)."
  (make-pose-stamped frame-id stamp (origin pose) (orientation pose)))

(defun point->point-stamped (frame-id stamp point)
  "Return the 3d-vector POINT as a POINT-STAMPED in the frame named FRAME-ID at the time STAMP (s)."
  (make-point-stamped frame-id stamp point))

(defun transform->transform-stamped (frame-id child-frame-id stamp transform)
  "Return TRANSFORM as a TRANSFORM-STAMPED from the frame named CHILD-FRAME-ID to the one named
FRAME-ID at the time STAMP (s)."
  (make-transform-stamped frame-id child-frame-id stamp
                          (translation transform) (rotation transform)))

(defun pose->transform-stamped (frame-id child-frame-id stamp pose)
  "Return the TRANSFORM-STAMPED, at the time STAMP (s), from a frame named CHILD-FRAME-ID that lies
at POSE in the frame named FRAME-ID to the latter."
  (make-transform-stamped frame-id child-frame-id stamp (origin pose) (orientation pose)))

(defun transform->pose-stamped (frame-id stamp transform)
  "Return the parts of TRANSFORM as a POSE-STAMPED in the frame named FRAME-ID at the time STAMP
(s)."
  (make-pose-stamped frame-id stamp (translation transform) (rotation transform)))

(defun pose-stamped->transform-stamped (pose child-frame-id)
  "Return the TRANSFORM-STAMPED from a frame named CHILD-FRAME-ID that lies at the pose-stamped POSE
to the frame in which POSE is given."
  (pose->transform-stamped (frame-id pose) child-frame-id (stamp pose) pose))

(defun transform-stamped->pose-stamped (transform)
  "Return the POSE-STAMPED of the child frame of the transform-stamped TRANSFORM."
  (transform->pose-stamped (frame-id transform) (stamp transform) transform))
