;;;; Faces of convex hulls.
;;;;
;;;; A hull is given by its vertices (at most 40).  A FACE is a plane, the unit normal outwards and
;;;; its distance from the origin, with the vertices on it in order around it.  Three vertices span
;;;; a face if no other vertex is beyond their plane; where more than three are on the plane it is
;;;; found once.

(in-package #:discrepancy-finder.projection)

(defstruct (hull-face (:constructor make-hull-face (normal distance corners)) (:copier nil))
  "NORMAL and CORNERS are lists of three coordinates (m) each; a point p of the plane has
p * NORMAL = DISTANCE."
  (normal '() :type list :read-only t)
  (distance 0d0 :type double-float :read-only t)
  (corners '() :type list :read-only t))

(defun dot-product (a b)
  (destructuring-bind (ax ay az) a
    (destructuring-bind (bx by bz) b
      (+ (* ax bx) (* ay by) (* az bz)))))

(defun cross-product (a b)
  (destructuring-bind (ax ay az) a
    (destructuring-bind (bx by bz) b
      (list (- (* ay bz) (* az by)) (- (* az bx) (* ax bz)) (- (* ax by) (* ay bx))))))

(defun vector-between (from to)
  (mapcar #'- to from))

(defun unit-vector (vector)
  "Return the list VECTOR with length 1, or NIL if it has almost none."
  (let ((length (sqrt (dot-product vector vector))))
    (and (> length 1d-12)
         (mapcar (lambda (number) (/ number length)) vector))))

(defun sorted-around (points normal)
  "Return POINTS of a plane with NORMAL in the order in which they stand around their middle."
  (let* ((count (length points))
         (middle (mapcar (lambda (sum) (/ sum count)) (reduce (lambda (a b) (mapcar #'+ a b))
                                                              points)))
         (across (unit-vector (vector-between middle (first points))))
         (upwards (cross-product normal across)))
    (sort (copy-list points) #'<
          :key (lambda (point)
                 (let ((offset (vector-between middle point)))
                   (atan (dot-product offset upwards) (dot-product offset across)))))))

(defun face-through (a b c points gap)
  "Return the face of the hull of POINTS that A, B and C span, or NIL if they span none.  What is
no further than GAP from the plane is on it."
  (let ((normal (unit-vector (cross-product (vector-between a b) (vector-between a c)))))
    (when normal
      (let* ((distance (dot-product normal a))
             (heights (loop for point in points
                            collect (- (dot-product normal point) distance)))
             (sign (cond ((every (lambda (height) (<= height gap)) heights) 1)
                         ((every (lambda (height) (>= height (- gap))) heights) -1))))
        (when sign
          (let ((outwards (mapcar (lambda (number) (* sign number)) normal)))
            (make-hull-face outwards (* sign distance)
                            (sorted-around (loop for point in points for height in heights
                                                 when (<= (abs height) gap) collect point)
                                           outwards))))))))

(defun hull-faces (points)
  "Return the list of the faces of the convex hull of POINTS, lists of three coordinates (m)."
  (let* ((points (loop for point in points
                       collect (mapcar (lambda (number) (float number 1d0)) point)))
         (size (reduce #'max (mapcar (lambda (point) (reduce #'max (mapcar #'abs point)))
                                     points)))
         (gap (* 1d-6 size))
         (faces '()))
    (flet ((known-p (a b c)
             (some (lambda (face)
                     (let ((corners (hull-face-corners face)))
                       (and (member a corners) (member b corners) (member c corners))))
                   faces)))
      (loop for (a . after) on points
            do (loop for (b . rest) on after
                     do (dolist (c rest)
                          (unless (known-p a b c)
                            (let ((face (face-through a b c points gap)))
                              (when face (push face faces))))))))
    (nreverse faces)))

(defun beneath-faces-p (faces x y z gap)
  "Return true if the point X, Y, Z is inside of all FACES by more than GAP."
  (let ((point (list x y z)))
    (every (lambda (face)
             (< (dot-product (hull-face-normal face) point) (- (hull-face-distance face) gap)))
           faces)))

(defun triangle-patch (a b c)
  "Return the patch, as SHAPE-PATCHES has them, of the triangle A, B, C."
  (let* ((ab (vector-between a b)) (bc (vector-between b c)) (normal (cross-product ab bc)))
    (cons (/ (sqrt (dot-product normal normal)) 2)
          (lambda (u v)
            (let* ((s (sqrt u)) (along (* s v)))
              (apply #'point-pose (mapcar (lambda (start to-b on-to-c)
                                            (+ start (* s to-b) (* along on-to-c)))
                                          a ab bc)))))))

(defun hull-patches (&rest points)
  "Return the patches of the convex hull of POINTS, the triangles of its faces."
  (loop for face in (hull-faces points)
        append (destructuring-bind (first . others) (hull-face-corners face)
                 (loop for (second third) on others
                       while third
                       collect (triangle-patch first second third)))))
