;;;; Surfaces: points spread evenly over a shape.
;;;;
;;;; The surface of a primitive is made of PATCHES: images of the unit square on which equal areas
;;;; have equal images.  A patch gets its share of the points by area, at the places of a Fibonacci
;;;; lattice, which is even for every number of points and has none on an edge.

(in-package #:discrepancy-finder.projection)

(defparameter *golden-ratio* (/ (1+ (sqrt 5d0)) 2))

(defun point-pose (x y z)
  "Return the upright pose at X, Y, Z (m): MAKE-POSE without its angles, which cost time."
  (quaternion-pose (float x 1d0) (float y 1d0) (float z 1d0) 0d0 0d0 0d0 1d0))

(defun box-patches (x y z)
  (flet ((faces (width height depth point)
           (loop for side in '(1 -1)
                 collect (let ((outwards (* side depth 1/2)))
                           (cons (* width height)
                                 (lambda (u v)
                                   (funcall point (* width (- u 1/2)) (* height (- v 1/2))
                                            outwards)))))))
    (append (faces x y z (lambda (a b c) (point-pose a b c)))
            (faces y z x (lambda (a b c) (point-pose c a b)))
            (faces z x y (lambda (a b c) (point-pose b c a))))))

(defun cylinder-patches (radius height)
  (flet ((cap (side)
           (cons (* pi radius radius)
                 (lambda (u v)
                   (let ((r (* radius (sqrt u))) (angle (* 2 pi v)))
                     (point-pose (* r (cos angle)) (* r (sin angle)) (* side height 1/2)))))))
    (list (cons (* 2 pi radius height)
                (lambda (u v)
                  (let ((angle (* 2 pi v)))
                    (point-pose (* radius (cos angle)) (* radius (sin angle))
                               (* height (- u 1/2))))))
          (cap 1) (cap -1))))

(defun sphere-patches (radius)
  (list (cons (* 4 pi radius radius)
              (lambda (u v)
                (let* ((z (- (* 2 u) 1)) (r (sqrt (- 1 (* z z)))) (angle (* 2 pi v)))
                  (point-pose (* radius r (cos angle)) (* radius r (sin angle)) (* radius z)))))))

(defun compound-patches (parts)
  (loop for (pose part) in parts
        append (loop for (area . point) in (shape-patches part)
                     collect (let ((pose pose) (point point))
                               (cons area
                                     (lambda (u v) (compose pose (funcall point u v))))))))

(defun shape-patches (shape)
  "Return the patches of SHAPE, in the notation of the bullet layer: a list of (area . function),
the area in m^2, the function one of two numbers from 0 to 1 that returns a pose at the point."
  (ecase (first shape)
    (:box (apply #'box-patches (rest shape)))
    (:cylinder (apply #'cylinder-patches (rest shape)))
    (:sphere (apply #'sphere-patches (rest shape)))
    (:hull (apply #'hull-patches (rest shape)))
    (:compound (compound-patches (rest shape)))))

;;; What is inside of another part of a compound

(defun inside-test (shape)
  "Return a function that returns true for a pose if its position is inside of SHAPE by more than a
micrometre."
  (let ((gap 1d-6))
    (ecase (first shape)
      (:box (lambda (point)
              (every (lambda (coordinate size) (< (abs coordinate) (- (/ size 2) gap)))
                     (list (pose-x point) (pose-y point) (pose-z point)) (rest shape))))
      (:sphere (lambda (point)
                 (let ((x (pose-x point)) (y (pose-y point)) (z (pose-z point)))
                   (< (sqrt (+ (* x x) (* y y) (* z z))) (- (second shape) gap)))))
      (:cylinder (lambda (point)
                   (let ((x (pose-x point)) (y (pose-y point)))
                     (and (< (sqrt (+ (* x x) (* y y))) (- (second shape) gap))
                          (< (abs (pose-z point)) (- (/ (third shape) 2) gap))))))
      (:hull (let ((faces (hull-faces (rest shape))))
               (lambda (point)
                 (beneath-faces-p faces (pose-x point) (pose-y point) (pose-z point) gap))))
      (:compound (let ((tests (loop for (pose part) in (rest shape)
                                    collect (cons (inverse pose) (inside-test part)))))
                   (lambda (point)
                     (loop for (outside . test) in tests
                             thereis (funcall test (compose outside point)))))))))

(defun surface-points (shape count)
  "Return about COUNT points, poses in the frame of SHAPE, spread evenly over its surface; always
the same ones.  Where parts of a compound overlap what is inside of another part is left out."
  (let* ((patches (shape-patches shape))
         (area (reduce #'+ patches :key #'car)))
    (remove-if (inside-test shape)
               (loop for (patch-area . point) in patches
                     for number = (max 1 (round (* count (/ patch-area area))))
                     append (loop for i below number
                                  for u = (/ (+ i 1/2) number 1d0)
                                  for v = (nth-value 1 (floor (* (+ i 1/2) *golden-ratio*)))
                                  collect (funcall point u v))))))

;;; The points of a shape are computed once.  A shape is the same list in all worlds of a scene.

(defparameter *points-on-a-surface* 240
  "An item is looked at in about so many points.")

(defvar *surfaces* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The vector of the surface points of each shape that was looked at.")

(defun interleaved (points)
  "Return the list POINTS in another order, in which those of any stretch are spread over the whole
surface: every 16th, and the rest in turn."
  (loop for start below 16
        append (loop for rest = (nthcdr start points) then (nthcdr 16 rest)
                     while rest collect (first rest))))

(defun surface-vector (shape)
  "Return the points of SHAPE's surface, in its frame, as a vector of coordinates (m): x, y, z of
the first, and so on."
  (or (gethash shape *surfaces*)
      (setf (gethash shape *surfaces*)
            (coerce (loop for point in (interleaved (surface-points shape *points-on-a-surface*))
                          append (list (pose-x point) (pose-y point) (pose-z point)))
                    '(simple-array double-float (*))))))
