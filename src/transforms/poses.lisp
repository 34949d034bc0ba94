;;;; Poses and transforms, read-only.
;;;;
;;;; A pose is where something is; a transform leads from coordinates in one frame to those in
;;;; another.  They have the same parts under two pairs of names, and (reference-transform pose)
;;;; leads from coordinates in the frame of the pose to those in the frame in which it is given.

(in-package #:discrepancy-finder.transforms)

(define-component origin "a pose" "Return the position of a pose, a 3D-VECTOR (m).")
(define-component orientation "a pose" "Return the orientation of a pose, a QUATERNION.")
(define-component translation "a transform"
  "Return the translation of a transform, a 3D-VECTOR (m).")
(define-component rotation "a transform" "Return the rotation of a transform, a QUATERNION.")

(defclass pose ()
  ((origin :initarg :origin :initform (make-identity-vector) :reader origin
           :documentation "The position, a 3D-VECTOR (m).")
   (orientation :initarg :orientation :initform (make-identity-rotation) :reader orientation
                :documentation "The orientation, a QUATERNION."))
  (:documentation "A position and an orientation; MAKE-POSE makes one."))

(defclass transform ()
  ((translation :initarg :translation :initform (make-identity-vector) :reader translation
                :documentation "The translation, a 3D-VECTOR (m).")
   (rotation :initarg :rotation :initform (make-identity-rotation) :reader rotation
             :documentation "The rotation, a QUATERNION."))
  (:documentation "A rotation followed by a translation; MAKE-TRANSFORM makes one."))

(defmethod initialize-instance :after ((pose pose) &key)
  (ensure-kind (origin pose) '3d-vector "the origin of a pose")
  (ensure-kind (orientation pose) 'quaternion "the orientation of a pose"))

(defmethod initialize-instance :after ((transform transform) &key)
  (ensure-kind (translation transform) '3d-vector "the translation of a transform")
  (ensure-kind (rotation transform) 'quaternion "the rotation of a transform"))

(defmethod print-object ((pose pose) stream)
  (print-value pose stream (origin pose) (orientation pose)))

(defmethod print-object ((transform transform) stream)
  (print-value transform stream (translation transform) (rotation transform)))

(defmethod make-load-form ((pose pose) &optional environment)
  (make-load-form-saving-slots pose :environment environment))

(defmethod make-load-form ((transform transform) &optional environment)
  (make-load-form-saving-slots transform :environment environment))

(defun make-pose (origin orientation)
  "Return the POSE with the 3d-vector ORIGIN and the quaternion ORIENTATION.  Signals
UNSUITABLE-VALUE if they are something else."
  (make-instance 'pose :origin origin :orientation orientation))

(defun make-identity-pose ()
  "Return the POSE of a frame in itself."
  (make-pose (make-identity-vector) (make-identity-rotation)))

(defun copy-pose (pose &key origin orientation)
  "Return a POSE like POSE, but with the ORIGIN and the ORIENTATION that are given."
  (make-pose (or origin (origin pose)) (or orientation (orientation pose))))

(defun make-transform (translation rotation)
  "Return the TRANSFORM with the 3d-vector TRANSLATION and the quaternion ROTATION.  Signals
UNSUITABLE-VALUE if they are something else."
  (make-instance 'transform :translation translation :rotation rotation))

(defun make-identity-transform ()
  "Return the TRANSFORM that moves nothing."
  (make-transform (make-identity-vector) (make-identity-rotation)))

(defun copy-transform (transform &key translation rotation)
  "Return a TRANSFORM like TRANSFORM, but with the TRANSLATION and the ROTATION that are given."
  (make-transform (or translation (translation transform)) (or rotation (rotation transform))))

(defun pose->transform (pose)
  "Return the TRANSFORM with the parts of POSE."
  (make-transform (origin pose) (orientation pose)))

(defun transform->pose (transform)
  "Return the POSE with the parts of TRANSFORM."
  (make-pose (translation transform) (rotation transform)))

(defun reference-transform (pose)
  "Return the TRANSFORM from coordinates in the frame of POSE to those in which POSE is given."
  (pose->transform pose))

;;; Algebra

(defun transform-point (transform point)
  "Return the 3d-vector POINT turned and moved by TRANSFORM."
  (v+ (rotate (rotation transform) point) (translation transform)))

(defun transform-pose (transform pose)
  "Return the pose of POSE, which is given in the frame that TRANSFORM leads from, in the one that
it leads to: a plain POSE, also if POSE is stamped."
  (make-pose (transform-point transform (origin pose))
             (q* (rotation transform) (orientation pose))))

(defgeneric transform (transform thing)
  (:documentation "Return THING, a 3d-vector, a pose or a transform, moved by TRANSFORM: a plain
3d-vector, pose or transform.  Signals UNSUITABLE-VALUE for anything else.")
  (:method ((transform transform) (thing 3d-vector))
    (transform-point transform thing))
  (:method ((transform transform) (thing pose))
    (transform-pose transform thing))
  (:method ((transform transform) (thing transform))
    (make-transform (transform-point transform (translation thing))
                    (q* (rotation transform) (rotation thing))))
  (:method ((transform transform) thing)
    (unsuitable thing "what is transformed" "a 3d-vector, a pose or a transform"))
  (:method (transform thing)
    (declare (ignore thing))
    (unsuitable transform "what transforms" "a transform")))

(defun transform* (&rest transforms)
  "Return the product of TRANSFORMS: what moves by the last one first.  The last one may be a pose
or a 3d-vector, which is moved then.  Without any it is the identity."
  (if transforms
      (reduce #'transform transforms :from-end t)
      (make-identity-transform)))

(defun transform-inv (transform)
  "Return the inverse of TRANSFORM: what leads back.  Signals ZERO-LENGTH if its rotation is zero."
  (let ((back (q-inv (rotation transform))))
    (make-transform (rotate back (v-inv (translation transform))) back)))

(defun matrix->transform (matrix)
  "Return the TRANSFORM of the homogeneous 4 x 4 array MATRIX, rows first.  Signals UNSUITABLE-VALUE
if it is none or turns nothing rigidly."
  (unless (and (typep matrix '(array * (4 4)))
               (equalp '(0 0 0 1) (loop for column below 4 collect (aref matrix 3 column))))
    (unsuitable matrix "a homogeneous matrix" "a 4 x 4 array whose last row is 0 0 0 1"))
  (make-transform (make-3d-vector (aref matrix 0 3) (aref matrix 1 3) (aref matrix 2 3))
                  (matrix->quaternion matrix)))

(defun transform->matrix (transform)
  "Return the homogeneous 4 x 4 array, rows first, of double floats of TRANSFORM.  Signals
ZERO-LENGTH if its rotation is zero."
  (let ((turn (quaternion->matrix (rotation transform)))
        (matrix (make-array '(4 4) :element-type 'double-float :initial-element 0d0)))
    (dotimes (row 3)
      (dotimes (column 3)
        (setf (aref matrix row column) (aref turn row column))))
    (with-accessors ((translation translation)) transform
      (setf (aref matrix 0 3) (x translation)
            (aref matrix 1 3) (y translation)
            (aref matrix 2 3) (z translation)
            (aref matrix 3 3) 1d0))
    matrix))
