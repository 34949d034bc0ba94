;;;; Inertia of several bodies that are joined.
;;;;
;;;; A TENSOR is a list (ixx iyy izz ixy ixz iyz) in kg m^2, the products of inertia with the sign
;;;; that they have in the matrix.  BULLET:PRINCIPAL-AXES makes principal moments and axes of one;
;;;; TURNED-TENSOR goes the other way, SHIFTED-TENSOR to another point, so that COMBINED-INERTIA can
;;;; add up.

(in-package #:discrepancy-finder.projection)

(defun principal-axes (tensor)
  "Return the list of the three principal moments of TENSOR and the pose, at the origin, of their
axes.  A tensor without products of inertia gives its own moments and the identity."
  (destructuring-bind (xx yy zz xy xz yz) tensor
    (bullet:principal-axes xx yy zz xy xz yz)))

(defun pose-rotation (pose)
  "Return the matrix whose columns are the axes of POSE."
  (let ((matrix (make-array '(3 3) :element-type 'double-float)))
    (loop for tip in (list (make-pose 1 0 0) (make-pose 0 1 0) (make-pose 0 0 1))
          for moved = (compose pose tip)
          for column from 0
          do (setf (aref matrix 0 column) (- (pose-x moved) (pose-x pose))
                   (aref matrix 1 column) (- (pose-y moved) (pose-y pose))
                   (aref matrix 2 column) (- (pose-z moved) (pose-z pose))))
    matrix))

(defun turned-tensor (moments pose)
  "Return the tensor, in the frame in which POSE is given, of a body with principal MOMENTS about
the axes of POSE."
  (let ((axes (pose-rotation pose)))
    (flet ((entry (i j)
             (loop for moment in moments
                   for k from 0
                   sum (* moment (aref axes i k) (aref axes j k)))))
      (list (entry 0 0) (entry 1 1) (entry 2 2) (entry 0 1) (entry 0 2) (entry 1 2)))))

(defun shifted-tensor (tensor mass x y z)
  "Return TENSOR, about the centre of a MASS, about a point from which that centre is at X, Y, Z."
  (mapcar #'+ tensor
          (list (* mass (+ (* y y) (* z z))) (* mass (+ (* x x) (* z z)))
                (* mass (+ (* x x) (* y y)))
                (- (* mass x y)) (- (* mass x z)) (- (* mass y z)))))

(defun combined-inertia (bodies)
  "Return mass, principal moments and the pose of their axes of BODIES, rigidly joined: a list of
(mass moments pose), POSE being that of the body's principal axes in the common frame."
  (let* ((mass (reduce #'+ bodies :key #'first))
         (centre (flet ((mean (reader)
                          (/ (loop for (part nil pose) in bodies
                                   sum (* part (funcall reader pose)))
                             mass)))
                   (make-pose (mean #'pose-x) (mean #'pose-y) (mean #'pose-z)))))
    (multiple-value-bind (moments axes)
        (principal-axes
         (reduce (lambda (one other) (mapcar #'+ one other))
                 (loop for (part moments pose) in bodies
                       collect (shifted-tensor (turned-tensor moments pose) part
                                               (- (pose-x pose) (pose-x centre))
                                               (- (pose-y pose) (pose-y centre))
                                               (- (pose-z pose) (pose-z centre))))))
      (values mass moments (compose centre axes)))))
