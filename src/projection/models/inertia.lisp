;;;; Inertia: from the six numbers of a tensor to principal moments and axes, and sums of bodies.
;;;;
;;;; A TENSOR is a list (ixx iyy izz ixy ixz iyz) in kg m^2, about the centre of mass, the products
;;;; of inertia with the sign that they have in the matrix.  PRINCIPAL-AXES turns it by Jacobi's
;;;; rotations into three moments and the pose of their axes; TURNED-TENSOR and SHIFTED-TENSOR go
;;;; the other way, so that bodies can be added up.

(in-package #:discrepancy-finder.projection)

(defun tensor-matrix (tensor)
  (destructuring-bind (xx yy zz xy xz yz) tensor
    (make-array '(3 3) :element-type 'double-float
                       :initial-contents (list (list xx xy xz) (list xy yy yz)
                                               (list xz yz zz)))))

(defun rotation-pose (axes)
  "Return the pose at the origin whose axes are the columns of the matrix AXES, a rotation."
  (flet ((r (i j) (aref axes i j)))
    (let* ((trace (+ (r 0 0) (r 1 1) (r 2 2)))
           (largest (if (plusp trace)
                        nil
                        (let ((i (if (> (r 1 1) (r 0 0)) 1 0)))
                          (if (> (r 2 2) (r i i)) 2 i)))))
      (if (null largest)
          (let* ((s (sqrt (+ trace 1))) (f (/ 0.5d0 s)))
            (quaternion-pose 0d0 0d0 0d0 (* f (- (r 2 1) (r 1 2))) (* f (- (r 0 2) (r 2 0)))
                             (* f (- (r 1 0) (r 0 1))) (/ s 2)))
          (let* ((i largest) (j (mod (+ i 1) 3)) (k (mod (+ i 2) 3))
                 (s (sqrt (+ 1 (r i i) (- (r j j)) (- (r k k)))))
                 (f (/ 0.5d0 s))
                 (parts (make-array 3)))
            (setf (aref parts i) (/ s 2)
                  (aref parts j) (* f (+ (r j i) (r i j)))
                  (aref parts k) (* f (+ (r k i) (r i k))))
            (quaternion-pose 0d0 0d0 0d0 (aref parts 0) (aref parts 1) (aref parts 2)
                             (* f (- (r k j) (r j k)))))))))

(defun rotate-away (matrix axes p q)
  "Rotate MATRIX in the plane of P and Q so that its element there is 0, and AXES with it."
  (let ((off (aref matrix p q)))
    (unless (zerop off)
      (let* ((theta (/ (- (aref matrix q q) (aref matrix p p)) (* 2 off)))
             (tangent (/ (if (minusp theta) -1d0 1d0)
                         (+ (abs theta) (sqrt (+ (* theta theta) 1)))))
             (cosine (/ (sqrt (+ (* tangent tangent) 1))))
             (sine (* tangent cosine)))
        (flet ((turn (array i j k l)
                 (let ((a (aref array i j)) (b (aref array k l)))
                   (setf (aref array i j) (- (* cosine a) (* sine b))
                         (aref array k l) (+ (* sine a) (* cosine b))))))
          (dotimes (k 3) (turn matrix k p k q))
          (dotimes (k 3) (turn matrix p k q k))
          (dotimes (k 3) (turn axes k p k q)))
        (setf (aref matrix p q) 0d0
              (aref matrix q p) 0d0)))))

(defun principal-axes (tensor)
  "Return the list of the three principal moments of TENSOR and the pose, at the origin, of their
axes.  A tensor without products of inertia gives its own moments and the identity."
  ;; Scaled to 1, products far below the rounding of the moments count as none.
  (let* ((scale (reduce #'max (mapcar #'abs tensor)))
         (matrix (tensor-matrix (if (zerop scale)
                                    tensor
                                    (mapcar (lambda (number) (/ number scale)) tensor))))
         (axes (tensor-matrix '(1d0 1d0 1d0 0d0 0d0 0d0))))
    (loop repeat 30
          while (> (+ (abs (aref matrix 0 1)) (abs (aref matrix 0 2)) (abs (aref matrix 1 2)))
                   1d-15)
          do (loop for (p q) in '((0 1) (0 2) (1 2))
                   do (rotate-away matrix axes p q)))
    (values (loop for i below 3 collect (* scale (aref matrix i i)))
            (rotation-pose axes))))

;;; Sums

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
