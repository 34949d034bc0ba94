;;;; Pictures by ray casting: what Bullet's own rays meet, pixel by pixel.
;;;;
;;;; A ray goes through the middle of each pixel.  What it meets gets the colour of its body, bright
;;;; where its surface faces the light and the light gets there, which a second ray asks.  Pixels
;;;; that differ much from a neighbour are on an edge: they get the mean of four more rays.  The
;;;; walls on the near side are cut away: rays begin behind them.  The light is within the walls.

(in-package #:discrepancy-finder.projection)

(defparameter *light* '(0.36d0 -0.48d0 0.80d0)
  "The unit vector towards the light.")

(defconstant +sight+ 100d0
  "How far (m) rays go.")

(defparameter *sky* '(0.93d0 0.95d0 0.98d0)
  "The colour where there is nothing.")

(defparameter *edge-contrast* 0.06d0
  "Pixels whose colours differ by so much are on an edge.")

(defstruct (canvas (:copier nil))
  "What rays need to know.  FRAME has the position of the camera and its axes forward, left and up,
these as long as half the picture is wide and high; COLORS has the colour of each body, three
numbers; WALLS are the faces around everything, four numbers each, CUTS those of them on which rays
begin."
  (world nil :read-only t)
  (frame nil :type doubles :read-only t)
  (flat nil :read-only t)
  (width 0 :type fixnum :read-only t)
  (height 0 :type fixnum :read-only t)
  (colors nil :type hash-table :read-only t)
  (walls nil :type doubles :read-only t)
  (cuts nil :type doubles :read-only t)
  (passed '() :type list :read-only t))

(defun number-vector (numbers)
  (coerce numbers 'doubles))

(defun viewpoint-frame (viewpoint)
  "Return the FRAME of a canvas for VIEWPOINT."
  (let ((pose (viewpoint-pose viewpoint)))
    (flet ((axis (x y z)
             (let ((tip (compose pose (point-pose x y z))))
               (list (- (pose-x tip) (pose-x pose)) (- (pose-y tip) (pose-y pose))
                     (- (pose-z tip) (pose-z pose))))))
      (number-vector (append (list (pose-x pose) (pose-y pose) (pose-z pose))
                             (axis 1 0 0)
                             (axis 0 (viewpoint-across viewpoint) 0)
                             (axis 0 0 (viewpoint-upwards viewpoint)))))))

(declaim (inline ray-beginning))
(defun ray-beginning (x y z dx dy dz cuts)
  "Return how far (m) along the ray from X Y Z in the direction DX DY DZ all the faces CUTS are
passed; beyond sight if that is nowhere."
  (declare (double-float x y z dx dy dz) (type doubles cuts))
  (let ((start 0d0))
    (declare (double-float start))
    (loop for i of-type fixnum from 0 below (length cuts) by 4
          for nx = (aref cuts i) for ny = (aref cuts (+ i 1)) for nz = (aref cuts (+ i 2))
          for outside = (- (aref cuts (+ i 3)) (+ (* nx x) (* ny y) (* nz z)))
          for speed = (+ (* nx dx) (* ny dy) (* nz dz))
          do (when (plusp outside)
               (setf start (max start (if (> (* speed +sight+) outside)
                                          (/ outside speed)
                                          (* 2 +sight+))))))
    start))

(defun write-ray (canvas column row rays index)
  "Write the ray through the point COLUMN, ROW (in pixels from the upper left) of CANVAS into RAYS
as the one with number INDEX.  Return true if it can meet anything; else it is a short one in the
sky."
  (declare (double-float column row) (type doubles rays) (fixnum index)
           (optimize speed (safety 1)))
  (let* ((frame (canvas-frame canvas))
         (left (- 1 (/ (* 2 column) (canvas-width canvas))))
         (up (- 1 (/ (* 2 row) (canvas-height canvas))))
         (flat (canvas-flat canvas)))
    (declare (type doubles frame) (double-float left up))
    (flet ((aside (axis)
             (+ (* left (aref frame (+ 6 axis))) (* up (aref frame (+ 9 axis)))))
           (forward (axis) (aref frame (+ 3 axis)))
           (origin (axis) (aref frame axis)))
      (declare (inline aside forward origin))
      (let* ((x (if flat (+ (origin 0) (aside 0)) (origin 0)))
             (y (if flat (+ (origin 1) (aside 1)) (origin 1)))
             (z (if flat (+ (origin 2) (aside 2)) (origin 2)))
             (dx (if flat (forward 0) (+ (forward 0) (aside 0))))
             (dy (if flat (forward 1) (+ (forward 1) (aside 1))))
             (dz (if flat (forward 2) (+ (forward 2) (aside 2))))
             (norm (sqrt (the (double-float 0d0) (+ (* dx dx) (* dy dy) (* dz dz)))))
             (start (ray-beginning x y z (/ dx norm) (/ dy norm) (/ dz norm)
                                   (canvas-cuts canvas)))
             (live (< start (- +sight+ 1)))
             (from (if live (/ (+ start 1d-6) norm) 0d0))
             (to (/ (if live +sight+ 1d-3) norm))
             (z (if live z 1000d0))
             (place (* 6 index)))
        (declare (double-float start from to z) (fixnum place))
        (setf (aref rays place) (+ x (* from dx))
              (aref rays (+ place 1)) (+ y (* from dy))
              (aref rays (+ place 2)) (+ z (* from dz))
              (aref rays (+ place 3)) (+ x (* to dx))
              (aref rays (+ place 4)) (+ y (* to dy))
              (aref rays (+ place 5)) (+ z (* to dz)))
        live))))

(defun cast-canvas-rays (canvas rays)
  "Return the bodies and the hits of RAYS.  One that begins in the ground meets nothing."
  (multiple-value-bind (bodies hits)
      (bullet:cast-rays (canvas-world canvas) rays :passed (canvas-passed canvas))
    (declare (simple-vector bodies) (type doubles hits))
    (loop for body across bodies
          for index of-type fixnum from 0
          do (when (and body
                        (< (aref hits (+ (* 7 index) 6)) 1d-9)
                        (eq (first (bullet:body-shape body)) :plane))
               (setf (svref bodies index) nil)))
    (values bodies hits)))

(defun light-distance (x y z light walls)
  "Return how far (m) the light at the point X Y Z is, in the direction LIGHT, within WALLS."
  (declare (double-float x y z) (type doubles light walls) (optimize speed (safety 1)))
  (let ((distance 10d0))
    (declare (double-float distance))
    (loop for i of-type fixnum from 0 below (length walls) by 4
          for nx = (aref walls i) for ny = (aref walls (+ i 1)) for nz = (aref walls (+ i 2))
          for inside = (- (+ (* nx x) (* ny y) (* nz z)) (aref walls (+ i 3)))
          for speed = (+ (* nx (aref light 0)) (* ny (aref light 1)) (* nz (aref light 2)))
          do (when (< speed -1d-6)
               (setf distance (min distance (- (/ inside (- speed)) 1d-6)))))
    (max distance 1d-6)))

(defun write-light-ray (hits index light walls rays)
  "Write the ray from the point that ray INDEX met to the light into RAYS."
  (declare (type doubles hits light walls rays) (fixnum index) (optimize speed (safety 1)))
  (let ((hit (* 7 index)) (ray (* 6 index)))
    (declare (fixnum hit ray))
    (dotimes (axis 3)
      ;; Begin just outside of the surface.
      (setf (aref rays (+ ray axis))
            (+ (aref hits (+ hit axis)) (* 1d-4 (aref hits (+ hit 3 axis))))))
    (let ((distance (light-distance (aref rays ray) (aref rays (+ ray 1)) (aref rays (+ ray 2))
                                    light walls)))
      (declare (double-float distance))
      (dotimes (axis 3)
        (setf (aref rays (+ ray 3 axis))
              (+ (aref rays (+ ray axis)) (* distance (aref light axis))))))))

(defun shadows (canvas bodies hits)
  "Return a vector that says for each of the HITS on BODIES what keeps the light away, or NIL."
  (let* ((count (length bodies))
         (rays (make-array (* 6 count) :element-type 'double-float :initial-element 1000d0))
         (light (number-vector *light*)))
    (dotimes (index count)
      (if (svref bodies index)
          (write-light-ray hits index light (canvas-walls canvas) rays)
          (incf (aref rays (* 6 index)) 1d-3)))
    (values (cast-canvas-rays canvas rays))))

(defun write-color (canvas body hits index lit colors)
  "Write red, green and blue, 0 to 1, of the point on BODY that ray INDEX met into COLORS; LIT says
whether the light gets there."
  (declare (type doubles hits colors) (fixnum index) (optimize speed (safety 1)))
  (let* ((start (* 7 index))
         (light (number-vector *light*))
         (x (aref hits start)) (y (aref hits (+ start 1))) (z (aref hits (+ start 2)))
         (nx (aref hits (+ start 3))) (ny (aref hits (+ start 4))) (nz (aref hits (+ start 5)))
         (facing (max 0d0 (+ (* nx (aref light 0)) (* ny (aref light 1)) (* nz (aref light 2)))))
         ;; Sides that the light does not reach would all look the same without the normal's part.
         (ambient (+ 0.50d0 (* 0.08d0 nz) (* 0.05d0 nx) (* -0.03d0 ny)))
         ;; One square metre of the floor in two is darker, for the scale.
         (tile (if (and (> nz 0.99d0) (< (abs z) 0.03d0) (< (abs x) 1d3) (< (abs y) 1d3)
                        (oddp (+ (the fixnum (floor x)) (the fixnum (floor y)))))
                   0.95d0
                   1d0))
         (brightness (* tile (+ ambient (if lit (* 0.48d0 facing) 0d0))))
         (own (gethash body (canvas-colors canvas))))
    (declare (type doubles light own) (fixnum start))
    (dotimes (part 3)
      (setf (aref colors (+ (* 3 index) part))
            (min 1d0 (* brightness (aref own part)))))))

(defun cast-colors (canvas count point-function)
  "Return a vector of the colours, three numbers each, at COUNT points.  POINT-FUNCTION returns
column and row (pixels, double floats) of the point with a number."
  (let* ((rays (make-array (* 6 count) :element-type 'double-float))
         (colors (make-array (* 3 count) :element-type 'double-float)))
    (dotimes (index count)
      (multiple-value-bind (column row) (funcall point-function index)
        (write-ray canvas column row rays index)))
    (multiple-value-bind (bodies hits) (cast-canvas-rays canvas rays)
      (let ((shadows (shadows canvas bodies hits)))
        (dotimes (index count colors)
          (if (svref bodies index)
              (write-color canvas (svref bodies index) hits index (null (svref shadows index))
                           colors)
              (replace colors *sky* :start1 (* 3 index))))))))

(defun edge-pixels (canvas colors)
  "Return the list of the numbers of those pixels of CANVAS whose COLORS differ much from those of a
neighbour."
  (declare (type doubles colors) (optimize speed (safety 1)))
  (let ((width (canvas-width canvas)) (height (canvas-height canvas))
        (contrast *edge-contrast*))
    (declare (type (unsigned-byte 16) width height) (double-float contrast))
    (flet ((differ-p (one other)
             (declare (type (unsigned-byte 32) one other))
             (loop for part of-type fixnum below 3
                   thereis (> (abs (- (aref colors (+ (* 3 one) part))
                                      (aref colors (+ (* 3 other) part))))
                              contrast))))
      (loop for row of-type fixnum below height
            append (loop for column of-type fixnum below width
                         for index of-type (unsigned-byte 32) = (+ (* row width) column)
                         when (or (and (plusp column) (differ-p index (1- index)))
                                  (and (< column (1- width)) (differ-p index (1+ index)))
                                  (and (plusp row) (differ-p index (- index width)))
                                  (and (< row (1- height)) (differ-p index (+ index width))))
                           collect index)))))

(defparameter *finer-points*
  #((0.375d0 0.125d0) (0.875d0 0.375d0) (0.125d0 0.625d0) (0.625d0 0.875d0))
  "Where in a pixel on an edge the four rays go.")

(defun refine-edges (canvas colors)
  "Replace those of COLORS, one a pixel of CANVAS, that are on an edge by the mean of four rays."
  (declare (type doubles colors))
  (let* ((edges (coerce (edge-pixels canvas colors) 'simple-vector))
         (finer (cast-colors canvas (* 4 (length edges))
                             (lambda (number)
                               (multiple-value-bind (edge point) (floor number 4)
                                 (multiple-value-bind (row column)
                                     (floor (svref edges edge) (canvas-width canvas))
                                   (destructuring-bind (x y) (svref *finer-points* point)
                                     (values (+ column x) (+ row y)))))))))
    (declare (type doubles finer))
    (loop for index across edges
          for start from 0 by 12
          do (dotimes (part 3)
               (setf (aref colors (+ (* 3 index) part))
                     (/ (loop for ray below 4 sum (aref finer (+ start (* 3 ray) part))) 4))))
    colors))

(defun canvas-pixels (canvas)
  "Return the octets of the picture on CANVAS: three for each pixel, row by row from the top."
  (let* ((width (canvas-width canvas))
         (colors (cast-colors canvas (* width (canvas-height canvas))
                              (lambda (number)
                                (multiple-value-bind (row column) (floor number width)
                                  (values (+ column 0.5d0) (+ row 0.5d0)))))))
    (map 'octets (lambda (part) (floor (* 255.99d0 (the double-float part))))
         (refine-edges canvas colors))))

(defun body-colors (chunks)
  "Return a table of the colours of the bodies to which CHUNKS belong."
  (let ((colors (make-hash-table :test #'eq)))
    (dolist (chunk chunks colors)
      (setf (gethash (chunk-body chunk) colors) (number-vector (chunk-color chunk))))))

(defun picture-octets (projection chunks viewpoint width height &key passed)
  "Return the octets of the PNG file with what is seen of PROJECTION, with CHUNKS, from VIEWPOINT.
PASSED is a list of bodies that are not shown."
  (let ((walls (enclosing-faces chunks)))
    (png-octets (canvas-pixels
                 (make-canvas :world (projection-world projection)
                              :frame (viewpoint-frame viewpoint)
                              :flat (viewpoint-flat viewpoint) :width width :height height
                              :colors (body-colors chunks)
                              :walls (number-vector (apply #'append walls))
                              :cuts (number-vector
                                     (apply #'append
                                            (near-faces walls (viewpoint-pose viewpoint))))
                              :passed passed))
                width height)))
