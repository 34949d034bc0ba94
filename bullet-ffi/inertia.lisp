;;;; Volume, centre of mass and inertia of shapes that are filled evenly.
;;;;
;;;; Everything comes from the moments of a shape, 13 double floats: its volume, the integrals over
;;;; it of x, y and z, and of their products, row by row.  Bullet's own moments of inertia are those
;;;; of the bounding box for cylinders, hulls and compounds, a third too much for a rolling cup.

(in-package #:discrepancy-finder.bullet)

(define-raw %hull-moments "dfb_hull_moments" :int
  (count :int) (points :pointer) (moments :pointer))

(deftype moments () '(simple-array double-float (13)))

(defun make-moments (volume &optional (xx 0) (yy 0) (zz 0))
  "Return the moments of a shape that is symmetric in x, y and z."
  (let ((moments (make-array 13 :element-type 'double-float)))
    (setf (aref moments 0) (float volume 1d0)
          (aref moments 4) (float xx 1d0)
          (aref moments 8) (float yy 1d0)
          (aref moments 12) (float zz 1d0))
    moments))

(defun hull-moments (points)
  (let ((numbers (point-numbers points 'shape-volume))
        (moments (make-moments 0)))
    (cffi:with-pointer-to-vector-data (points-pointer numbers)
      (cffi:with-pointer-to-vector-data (moments-pointer moments)
        (when (minusp (%hull-moments (floor (length numbers) 3) points-pointer moments-pointer))
          (fail 'shape-volume "the points of a hull must be 4 to 40 and not flat"))))
    moments))

(defun moved-moments (moments pose)
  "Return the MOMENTS of a shape that is moved to POSE."
  (let* ((volume (aref moments 0))
         (columns (loop for axis in '((1d0 0d0 0d0) (0d0 1d0 0d0) (0d0 0d0 1d0))
                        collect (multiple-value-list
                                 (apply #'geometry:rotate pose axis))))
         (offset (list (geometry:pose-x pose) (geometry:pose-y pose) (geometry:pose-z pose)))
         (moved (make-moments volume)))
    (flet ((turned (i)                  ; of the first moments
             (loop for column in columns for k from 1
                   sum (* (nth i column) (aref moments k))))
           (turned-product (i j)
             (loop for a in columns for k from 0
                   sum (loop for b in columns for l from 0
                             sum (* (nth i a) (nth j b) (aref moments (+ 4 (* 3 k) l)))))))
      (dotimes (i 3 moved)
        (let ((oi (nth i offset)))
          (setf (aref moved (1+ i)) (+ (turned i) (* volume oi)))
          (dotimes (j 3)
            (let ((oj (nth j offset)))
              (setf (aref moved (+ 4 (* 3 i) j))
                    (+ (turned-product i j) (* oi (turned j)) (* oj (turned i))
                       (* volume oi oj))))))))))

(declaim (ftype function shape-moments))

(defun compound-moments (parts)
  (let ((total (make-moments 0)))
    (loop for (pose part) in parts
          do (map-into total #'+ total (moved-moments (shape-moments part) pose)))
    total))

(defun shape-moments (shape)
  "Return the moments of the well-formed SHAPE, which is no plane; parts of a compound that overlap
count twice."
  (destructuring-bind (kind . numbers) shape
    (ecase kind
      (:box (destructuring-bind (x y z) numbers
              (let ((volume (* x y z)))
                (make-moments volume (/ (* volume x x) 12) (/ (* volume y y) 12)
                              (/ (* volume z z) 12)))))
      (:sphere (destructuring-bind (radius) numbers
                 (let* ((volume (* 4/3 pi (expt radius 3))) (moment (* 1/5 volume radius radius)))
                   (make-moments volume moment moment moment))))
      (:cylinder (destructuring-bind (radius height) numbers
                   (let* ((volume (* pi radius radius height))
                          (across (* 1/4 volume radius radius)))
                     (make-moments volume across across (/ (* volume height height) 12)))))
      (:hull (kept-moments shape (lambda () (hull-moments numbers))))
      (:compound (kept-moments shape (lambda () (compound-moments numbers)))))))

(defun checked-moments (shape operation)
  "Return the moments of SHAPE, or signal that OPERATION cannot have it."
  (with-shape (pointer shape '("the body"))
    (declare (ignore pointer)))
  (when (eq (first shape) :plane)
    (fail operation "a plane has no volume"))
  (shape-moments shape))

(defun shape-volume (shape)
  "Return the volume (m^3) of SHAPE; where parts of a compound overlap it counts twice.  Signals
BULLET-ERROR if SHAPE is malformed or a plane."
  (aref (checked-moments shape 'shape-volume) 0))

(defun shape-inertia (shape mass)
  "Return the list of the moments of inertia (kg m^2) about the axes of its frame of a body with
SHAPE and MASS (kg), evenly spread.  Products are left out.  Signals BULLET-ERROR if SHAPE is
malformed or a plane, or MASS not positive."
  (let* ((moments (checked-moments shape 'shape-inertia))
         (density (/ (number-of "the mass" mass 'shape-inertia :positive) (aref moments 0)))
         (xx (* density (aref moments 4)))
         (yy (* density (aref moments 8)))
         (zz (* density (aref moments 12))))
    (list (+ yy zz) (+ xx zz) (+ xx yy))))

;;; Principal axes

(defun turn-away (matrix axes p q)
  "Turn AXES, and the symmetric MATRIX into them, in the plane of P and Q so that its element there
becomes zero: a step of Jacobi's method."
  (let ((off (aref matrix p q)))
    (unless (<= (abs off) (* 1d-15 (+ (abs (aref matrix p p)) (abs (aref matrix q q)))))
      (let* ((theta (/ (- (aref matrix q q) (aref matrix p p)) (* 2 off)))
             (tangent (/ (if (minusp theta) -1 1) (+ (abs theta) (sqrt (1+ (* theta theta))))))
             (c (/ (sqrt (1+ (* tangent tangent)))))
             (s (* c tangent)))
        (flet ((turn (row-p column-p row-q column-q array)
                 (let ((x (aref array row-p column-p)) (y (aref array row-q column-q)))
                   (setf (aref array row-p column-p) (- (* c x) (* s y))
                         (aref array row-q column-q) (+ (* s x) (* c y))))))
          (dotimes (k 3)
            (turn k p k q matrix)
            (turn k p k q axes))
          (dotimes (k 3) (turn p k q k matrix)))))))

(defun axes-pose (axes)
  "Return the pose at the origin of the frame whose axes are the columns of the rotation AXES."
  (flet ((m (i j) (aref axes i j)))
    ;; Of the four ways to find the quaternion the one that divides by its largest number.
    (let* ((squares (list (+ 1 (m 0 0) (- (m 1 1)) (- (m 2 2)))
                          (+ 1 (m 1 1) (- (m 0 0)) (- (m 2 2)))
                          (+ 1 (m 2 2) (- (m 0 0)) (- (m 1 1)))
                          (+ 1 (m 0 0) (m 1 1) (m 2 2))))
           (largest (position (reduce #'max squares) squares))
           (numbers (list (- (m 2 1) (m 1 2)) (- (m 0 2) (m 2 0)) (- (m 1 0) (m 0 1))))
           (twice (* 2 (sqrt (nth largest squares))))
           (quaternion
             (if (= largest 3)
                 (append (mapcar (lambda (number) (/ number twice)) numbers) (list (/ twice 4)))
                 (append (loop for i below 3
                               collect (if (= i largest)
                                           (/ twice 4)
                                           (/ (+ (m i largest) (m largest i)) twice)))
                         (list (/ (nth largest numbers) twice))))))
      (apply #'geometry:quaternion-pose 0d0 0d0 0d0 quaternion))))

(defun principal-axes (ixx iyy izz ixy ixz iyz)
  "Return the list of the three principal moments of an inertia tensor (kg m^2) about the centre of
mass, and the pose, at the origin, of the frame of their axes.  A tensor that is diagonal keeps its
axes.  Signals BULLET-ERROR if a number is not finite."
  (let ((matrix (make-array '(3 3) :initial-contents
                            (loop for row in `((,ixx ,ixy ,ixz) (,ixy ,iyy ,iyz) (,ixz ,iyz ,izz))
                                  collect (loop for number in row
                                                collect (number-of "a moment of inertia" number
                                                                   'principal-axes)))))
        (axes (make-array '(3 3) :initial-contents '((1d0 0d0 0d0) (0d0 1d0 0d0)
                                                     (0d0 0d0 1d0)))))
    ;; Each sweep squares what is left beside the diagonal.
    (loop repeat 12
          do (turn-away matrix axes 0 1)
             (turn-away matrix axes 0 2)
             (turn-away matrix axes 1 2))
    (values (list (aref matrix 0 0) (aref matrix 1 1) (aref matrix 2 2))
            (axes-pose axes))))

(defun mass-properties (shape mass)
  "Return two values for ADD-BODY: the principal moments of inertia (kg m^2) about its centre of
mass of a body with SHAPE and MASS (kg), evenly spread, and the inertial pose, that of their axes in
the link frame.  Signals BULLET-ERROR if SHAPE is malformed or a plane, or MASS not positive."
  (let* ((moments (checked-moments shape 'mass-properties))
         (volume (aref moments 0))
         (density (/ (number-of "the mass" mass 'mass-properties :positive) volume))
         (centre (loop for i from 1 to 3 collect (/ (aref moments i) volume))))
    (flet ((product (i j)
             (* density (- (aref moments (+ 4 (* 3 i) j))
                           (* volume (nth i centre) (nth j centre))))))
      (let ((xx (product 0 0)) (yy (product 1 1)) (zz (product 2 2)))
        (multiple-value-bind (principal axes)
            (principal-axes (+ yy zz) (+ xx zz) (+ xx yy)
                            (- (product 0 1)) (- (product 0 2)) (- (product 1 2)))
          (values principal
                  (geometry:compose (apply #'geometry:make-pose centre) axes)))))))
