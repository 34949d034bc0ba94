;;;; Outlines: what bodies look like from above.
;;;;
;;;; For planning where the base can stand, a convex part of a shape is a PIECE: a convex polygon in
;;;; the horizontal plane and the range of heights that it takes.  Two pieces can touch only if
;;;; their heights overlap and their polygons do; pieces of slanted parts are larger than these.
;;;; SHAPE-PIECES makes pieces, SEPARATION tells how far apart two are.

(in-package #:discrepancy-finder.projection)

(deftype doubles () '(simple-array double-float (*)))

(defstruct (piece (:constructor %make-piece (polygon edges low high x y radius x0 y0 x1 y1))
                  (:copier nil))
  "POLYGON holds the corners x0 y0 x1 y1 ..., counterclockwise, EDGES for each edge the two numbers
of its outward unit normal, and its distance (m) from the origin along that; the piece reaches from
the height LOW to HIGH (m).  All its corners are within RADIUS of X, Y, and between X0 and X1, Y0
and Y1."
  (polygon nil :type doubles :read-only t)
  (edges nil :type doubles :read-only t)
  (low 0d0 :type double-float :read-only t)
  (high 0d0 :type double-float :read-only t)
  (x 0d0 :type double-float :read-only t)
  (y 0d0 :type double-float :read-only t)
  (radius 0d0 :type double-float :read-only t)
  (x0 0d0 :type double-float :read-only t)
  (y0 0d0 :type double-float :read-only t)
  (x1 0d0 :type double-float :read-only t)
  (y1 0d0 :type double-float :read-only t))

(defun polygon-edges (polygon)
  "Return the EDGES of a piece with POLYGON; an edge without length has none."
  (declare (type doubles polygon))
  (let ((edges '()) (size (length polygon)))
    (loop for i below size by 2
          for next = (if (= (+ i 2) size) 0 (+ i 2))
          for nx = (- (aref polygon (1+ next)) (aref polygon (1+ i)))
          for ny = (- (aref polygon i) (aref polygon next))
          for norm = (sqrt (+ (* nx nx) (* ny ny)))
          do (when (> norm 1d-12)
               (let ((nx (/ nx norm)) (ny (/ ny norm)))
                 (push nx edges)
                 (push ny edges)
                 (push (+ (* nx (aref polygon i)) (* ny (aref polygon (1+ i)))) edges))))
    (coerce (nreverse edges) 'doubles)))

(defun make-piece (polygon low high &optional (edges (polygon-edges polygon)))
  "Return the piece with the corners POLYGON between the heights LOW and HIGH."
  (declare (type doubles polygon))
  (flet ((extent (offset)
           (loop for i from offset below (length polygon) by 2
                 minimize (aref polygon i) into low
                 maximize (aref polygon i) into high
                 finally (return (values low high)))))
    (multiple-value-bind (x0 x1) (extent 0)
      (multiple-value-bind (y0 y1) (extent 1)
        (let ((x (/ (+ x0 x1) 2)) (y (/ (+ y0 y1) 2)))
          (%make-piece polygon edges low high x y
                       (loop for i below (length polygon) by 2
                             maximize (sqrt (+ (expt (- (aref polygon i) x) 2)
                                               (expt (- (aref polygon (1+ i)) y) 2))))
                       x0 y0 x1 y1))))))

(defun planar-hull (points)
  "Return the corners of the convex hull of POINTS, a list of (x . y) of double floats,
counterclockwise."
  (declare (optimize speed (safety 1)) (sb-ext:muffle-conditions sb-ext:compiler-note))
  (labels ((before-p (a b)
             (let ((ax (car a)) (bx (car b)))
               (declare (double-float ax bx))
               (or (< ax bx)
                   (and (= ax bx) (< (the double-float (cdr a)) (the double-float (cdr b)))))))
           (right-turn-p (a b c)
             (let ((ax (car a)) (ay (cdr a)) (bx (car b)) (by (cdr b)) (cx (car c)) (cy (cdr c)))
               (declare (double-float ax ay bx by cx cy))
               (<= (- (* (- bx ax) (- cy ay)) (* (- by ay) (- cx ax))) 1d-15)))
           (chain (points)
             (let ((stack '()))
               (dolist (point points (rest stack))
                 (loop while (and (rest stack)
                                  (right-turn-p (second stack) (first stack) point))
                       do (pop stack))
                 (push point stack)))))
    (let* ((points (sort (copy-list points) #'before-p))
           (corners (append (reverse (chain points)) (reverse (chain (reverse points)))))
           (corners (or corners (list (first points))))
           (polygon (make-array (* 2 (length corners)) :element-type 'double-float)))
      (loop for (x . y) in corners
            for i of-type fixnum from 0 by 2
            do (setf (aref polygon i) (the double-float x)
                     (aref polygon (1+ i)) (the double-float y)))
      polygon)))

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

(defun computed-pieces (shape pose)
  (let ((pieces '()))
    (pieces-of shape pose (lambda (part pose) (push (convex-piece part pose) pieces)))
    (nreverse pieces)))

(defvar *known-pieces* (make-hash-table :test #'eq :weakness :key :synchronized t)
  "For each shape a list of (pose . pieces), the latest first.")

(defconstant +known-pieces+ 16
  "The pieces of a shape are kept for so many of its latest poses.")

(defun same-pose-p (a b)
  (declare (optimize speed (safety 1)) (type pose a b))
  (and (= (pose-x a) (pose-x b)) (= (pose-y a) (pose-y b)) (= (pose-z a) (pose-z b))
       (= (pose-qx a) (pose-qx b)) (= (pose-qy a) (pose-qy b)) (= (pose-qz a) (pose-qz b))
       (= (pose-qw a) (pose-qw b))))

(defun shape-pieces (shape pose)
  "Return the list of the pieces of SHAPE at POSE.  Most shapes are asked for where they have been
before, so that the pieces are kept; nothing depends on that."
  (let* ((known (gethash shape *known-pieces*))
         (entry (find pose known :key #'car :test #'same-pose-p)))
    (if entry
        (cdr entry)
        (let ((pieces (computed-pieces shape pose)))
          (setf (gethash shape *known-pieces*)
                (cons (cons pose pieces)
                      (if (< (length known) +known-pieces+) known (butlast known))))
          pieces))))

(defun turned-piece (piece yaw)
  "Return PIECE, turned by YAW (rad) about the origin."
  (declare (type double-float yaw))
  (let* ((sine (sin yaw)) (cosine (cos yaw))
         (polygon (copy-seq (piece-polygon piece)))
         (edges (copy-seq (piece-edges piece))))
    (flet ((turn (vector i)
             (declare (type doubles vector) (fixnum i))
             (let ((a (aref vector i)) (b (aref vector (1+ i))))
               (setf (aref vector i) (- (* cosine a) (* sine b))
                     (aref vector (1+ i)) (+ (* sine a) (* cosine b))))))
      (declare (inline turn))
      (loop for i of-type fixnum below (length polygon) by 2 do (turn polygon i))
      (loop for i of-type fixnum below (length edges) by 3 do (turn edges i)))
    (make-piece polygon (piece-low piece) (piece-high piece) edges)))

(defun heights-meet-p (a b)
  "Return true if the pieces A and B take a common height, by more than a millimetre."
  (and (< (+ (piece-low a) 1d-3) (piece-high b))
       (< (+ (piece-low b) 1d-3) (piece-high a))))

(defun gap-along-edges (piece corners x y)
  "Return the largest distance by which an edge of PIECE separates it from the polygon CORNERS,
moved by X, Y; negative if none does."
  (declare (type doubles corners) (type double-float x y) (type piece piece)
           (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let* ((edges (piece-edges piece)) (gap -1d9) (size (length corners)))
    (declare (type double-float gap) (fixnum size))
    (loop for i of-type fixnum below (length edges) by 3
          do (let* ((nx (aref edges i)) (ny (aref edges (1+ i)))
                    (shift (- (+ (* nx x) (* ny y)) (aref edges (+ i 2))))
                    (nearest 1d9))
               (declare (type double-float nearest))
               (loop for j of-type fixnum below size by 2
                     do (let ((distance (+ (* nx (aref corners j)) (* ny (aref corners (1+ j))))))
                          (when (< distance nearest) (setf nearest distance))))
               (setf gap (max gap (+ nearest shift)))))
    gap))

(declaim (inline box-gap))
(defun box-gap (piece x y radius)
  "Return a lower bound of the distance of PIECE from the circle with RADIUS about X, Y."
  (declare (type piece piece) (type double-float x y radius))
  (let ((dx (max 0d0 (- (piece-x0 piece) x) (- x (piece-x1 piece))))
        (dy (max 0d0 (- (piece-y0 piece) y) (- y (piece-y1 piece)))))
    (- (sqrt (the (double-float 0d0) (+ (* dx dx) (* dy dy)))) radius)))

(defun separation (a b &optional (x 0d0) (y 0d0))
  "Return a lower bound of the horizontal distance (m) of the pieces A, moved by X, Y, and B; it is
negative just if their polygons overlap."
  (declare (type double-float x y) (type piece a b))
  (let ((far (box-gap b (+ x (piece-x a)) (+ y (piece-y a)) (piece-radius a))))
    (if (> far 0.2d0)
        far
        (max far
             (gap-along-edges a (piece-polygon b) (- x) (- y))
             (gap-along-edges b (piece-polygon a) x y)))))

(defun covers-p (a b)
  "Return true if the polygon of the piece A has that of B in it."
  (let ((edges (piece-edges a)) (corners (piece-polygon b)))
    (loop for i below (length edges) by 3
          always (loop for j below (length corners) by 2
                       always (<= (+ (* (aref edges i) (aref corners j))
                                     (* (aref edges (1+ i)) (aref corners (1+ j))))
                                  (+ (aref edges (+ i 2)) 1d-9))))))
