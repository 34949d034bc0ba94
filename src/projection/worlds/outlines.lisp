;;;; Outlines: what bodies look like from above.
;;;;
;;;; For planning where the base can stand, a convex part of a shape is a PIECE: a convex polygon in
;;;; the horizontal plane and the range of heights that it takes.  Two pieces can touch only if
;;;; their heights overlap and their polygons do; pieces of slanted parts are larger than these.
;;;; SHAPE-PIECES makes pieces, SEPARATION tells how far apart two are.

(in-package #:discrepancy-finder.projection)

(deftype doubles () '(simple-array double-float (*)))

(defstruct (piece (:constructor %make-piece (polygon low high x y radius)) (:copier nil))
  "POLYGON holds the corners x0 y0 x1 y1 ..., counterclockwise; the piece reaches from the height
LOW to HIGH (m); all its corners are within RADIUS of X, Y."
  (polygon nil :type doubles :read-only t)
  (low 0d0 :type double-float :read-only t)
  (high 0d0 :type double-float :read-only t)
  (x 0d0 :type double-float :read-only t)
  (y 0d0 :type double-float :read-only t)
  (radius 0d0 :type double-float :read-only t))

(defun make-piece (polygon low high)
  "Return the piece with the corners POLYGON between the heights LOW and HIGH."
  (declare (type doubles polygon))
  (flet ((middle (offset)
           (/ (+ (loop for i from offset below (length polygon) by 2 minimize (aref polygon i))
                 (loop for i from offset below (length polygon) by 2 maximize (aref polygon i)))
              2)))
    (let ((x (middle 0)) (y (middle 1)))
      (%make-piece polygon low high x y
                   (loop for i below (length polygon) by 2
                         maximize (sqrt (+ (expt (- (aref polygon i) x) 2)
                                           (expt (- (aref polygon (1+ i)) y) 2))))))))

(defun planar-hull (points)
  "Return the corners of the convex hull of POINTS, a list of (x . y), counterclockwise."
  (let ((points (sort (copy-list points)
                      (lambda (a b) (or (< (car a) (car b))
                                        (and (= (car a) (car b)) (< (cdr a) (cdr b))))))))
    (labels ((right-turn-p (a b c)
               (<= (- (* (- (car b) (car a)) (- (cdr c) (cdr a)))
                      (* (- (cdr b) (cdr a)) (- (car c) (car a))))
                   1d-15))
             (chain (points)
               (let ((stack '()))
                 (dolist (point points (rest stack))
                   (loop while (and (rest stack)
                                    (right-turn-p (second stack) (first stack) point))
                         do (pop stack))
                   (push point stack)))))
      (let ((corners (append (reverse (chain points)) (reverse (chain (reverse points))))))
        (coerce (loop for (x . y) in (or corners (list (first points)))
                      collect x collect y)
                'doubles)))))

(defconstant +sides+ 16
  "Circles count as polygons of so many sides around them.")

(defun circle-points (radius z)
  (let ((outer (/ radius (cos (/ pi +sides+)))))
    (loop for i below +sides+
          for angle = (/ (* 2 pi (+ i 1/2)) +sides+)
          collect (list (* outer (cos angle)) (* outer (sin angle)) z))))

(defun convex-points (shape)
  "Return points, lists of x, y, z, whose convex hull encloses the convex SHAPE."
  (ecase (first shape)
    (:box (destructuring-bind (x y z) (mapcar (lambda (size) (/ size 2)) (rest shape))
            (loop for sx in '(-1 1)
                  append (loop for sy in '(-1 1)
                               append (loop for sz in '(-1 1)
                                            collect (list (* sx x) (* sy y) (* sz z)))))))
    (:cylinder (destructuring-bind (radius length) (rest shape)
                 (append (circle-points radius (/ length 2))
                         (circle-points radius (- (/ length 2))))))
    (:sphere (let ((radius (second shape)))
               (list* (list 0d0 0d0 radius) (list 0d0 0d0 (- radius))
                      (circle-points radius 0d0))))
    (:hull (rest shape))))

(defun pieces-of (shape pose function)
  "Call FUNCTION with each convex part of SHAPE at POSE, and with its pose."
  (case (first shape)
    (:plane)
    (:compound (loop for (offset part) in (rest shape)
                     do (pieces-of part (compose pose offset) function)))
    (t (funcall function shape pose))))

(defun convex-piece (shape pose)
  "Return the piece of the convex SHAPE at POSE.  A sphere is one, however it is turned."
  (let ((points (loop for (x y z) in (convex-points shape)
                      collect (if (eq (first shape) :sphere)
                                  (list (+ x (pose-x pose)) (+ y (pose-y pose))
                                        (+ z (pose-z pose)))
                                  (point-at pose x y z)))))
    (make-piece (planar-hull (loop for (x y) in points collect (cons x y)))
                (reduce #'min points :key #'third)
                (reduce #'max points :key #'third))))

(defun point-at (pose x y z)
  "Return the point X, Y, Z of the frame of POSE as a list of three coordinates."
  (let ((point (compose pose (quaternion-pose (float x 1d0) (float y 1d0) (float z 1d0)
                                              0d0 0d0 0d0 1d0))))
    (list (pose-x point) (pose-y point) (pose-z point))))

(defun shape-pieces (shape pose)
  "Return the list of the pieces of SHAPE at POSE."
  (let ((pieces '()))
    (pieces-of shape pose (lambda (part pose) (push (convex-piece part pose) pieces)))
    (nreverse pieces)))

(defun placed-piece (piece x y yaw)
  "Return PIECE, which is given in a frame, as seen from the one in which that is at X, Y, turned by
YAW."
  (declare (type double-float x y yaw))
  (let* ((sine (sin yaw)) (cosine (cos yaw))
         (polygon (piece-polygon piece))
         (placed (make-array (length polygon) :element-type 'double-float)))
    (flet ((px (a b) (+ x (- (* cosine a) (* sine b))))
           (py (a b) (+ y (+ (* sine a) (* cosine b)))))
      (loop for i below (length polygon) by 2
            for a = (aref polygon i) for b = (aref polygon (1+ i))
            do (setf (aref placed i) (px a b)
                     (aref placed (1+ i)) (py a b)))
      (%make-piece placed (piece-low piece) (piece-high piece)
                   (px (piece-x piece) (piece-y piece)) (py (piece-x piece) (piece-y piece))
                   (piece-radius piece)))))

(defun heights-meet-p (a b)
  "Return true if the pieces A and B take a common height, by more than a millimetre."
  (and (< (+ (piece-low a) 1d-3) (piece-high b))
       (< (+ (piece-low b) 1d-3) (piece-high a))))

(defun gap-along-edges (one other x y)
  "Return the largest distance by which an edge of the polygon ONE, moved by X, Y, separates it from
the polygon OTHER; negative if none does."
  (declare (type doubles one other) (type double-float x y) (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let ((size (length one)) (gap -1d9))
    (declare (type double-float gap) (fixnum size))
    (loop for i of-type fixnum below size by 2
          for next of-type fixnum = (if (= (+ i 2) size) 0 (+ i 2))
          do (let* ((ax (aref one i)) (ay (aref one (1+ i)))
                    (nx (- (aref one (1+ next)) ay)) ; the outward normal
                    (ny (- ax (aref one next)))
                    (norm (sqrt (the (double-float 0d0) (+ (* nx nx) (* ny ny)))))
                    (nearest 1d9))
               (declare (type double-float nearest))
               (when (> norm 1d-12)
                 (loop for j of-type fixnum below (length other) by 2
                       do (let ((distance (+ (* nx (- (aref other j) x ax))
                                             (* ny (- (aref other (1+ j)) y ay)))))
                            (when (< distance nearest) (setf nearest distance))))
                 (setf gap (max gap (/ nearest norm))))))
    gap))

(defun separation (a b &optional (x 0d0) (y 0d0))
  "Return a lower bound of the horizontal distance (m) of the pieces A, moved by X, Y, and B; it is
negative just if their polygons overlap."
  (declare (type double-float x y) (type piece a b) (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let* ((dx (- (piece-x b) (piece-x a) x)) (dy (- (piece-y b) (piece-y a) y))
         (far (- (sqrt (the (double-float 0d0) (+ (* dx dx) (* dy dy))))
                 (piece-radius a) (piece-radius b))))
    (if (> far 0.2d0)
        far
        (max far
             (gap-along-edges (piece-polygon a) (piece-polygon b) x y)
             (gap-along-edges (piece-polygon b) (piece-polygon a) (- x) (- y))))))
