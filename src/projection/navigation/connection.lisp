;;;; Connection: is it conceivable at all that the base gets from one place to another?
;;;;
;;;; A search in which directions count visits every place that can be reached before it gives up:
;;;; seconds, for a goal behind a wall.  CONNECTED-P asks less.  The robot's middle, in whatever
;;;; direction it stands, always fills a disk, its CORE; where a core meets something the robot
;;;; cannot be, so that a goal to which not even the cores get needs no search.

(in-package #:discrepancy-finder.projection)

(defconstant +connection-step+ 0.05d0
  "The distance (m) of the places that are looked at, in x and in y.")

(defun inner-radius (piece)
  "Return the radius (m) of the largest circle about the origin inside of PIECE; not positive if the
origin is outside."
  (let ((edges (piece-edges piece)))
    (loop for index from 2 below (length edges) by 3 minimize (aref edges index))))

(defun core-piece (piece)
  "Return a piece with eight corners inside of PIECE wherever that is turned about the origin, and
wherever it is moved by no more than to the next place; NIL if there is none."
  (let ((radius (- (inner-radius piece) (* +connection-step+ (sqrt 0.5d0)))))
    (when (plusp radius)
      (make-piece (coerce (loop for corner below 8
                                for angle = (* corner (/ pi 4))
                                collect (* radius (cos angle)) collect (* radius (sin angle)))
                          'doubles)
                  (piece-low piece) (piece-high piece)))))

(defun footing-cores (footing)
  "Return a list of (core . obstacles) for the pieces of FOOTING that have a core."
  (loop for (piece . obstacles) across (footing-parts footing)
        for core = (core-piece piece)
        when core collect (cons core obstacles)))

(defun core-free-p (cores x y)
  "Return true if none of CORES meets an obstacle at X, Y."
  (loop for (core . obstacles) in cores
        never (loop for obstacle in obstacles
                    thereis (minusp (separation core obstacle x y)))))

(defun connected-p (footing start goal bounds)
  "Return false if the robot of FOOTING certainly cannot get from the place START to GOAL within
BOUNDS, a list of the least x and y and the greatest."
  (destructuring-bind (x0 y0 x1 y1) bounds
    (let* ((columns (1+ (ceiling (- x1 x0) +connection-step+)))
           (rows (1+ (ceiling (- y1 y0) +connection-step+)))
           (seen (make-array (* columns rows) :element-type 'bit :initial-element 0))
           (cores (footing-cores footing)))
      (labels ((cell (place)
                 (+ (round (- (first place) x0) +connection-step+)
                    (* columns (round (- (second place) y0) +connection-step+))))
               (free-p (column row)
                 (core-free-p cores (+ x0 (* column +connection-step+))
                              (+ y0 (* row +connection-step+)))))
        (let ((end (cell goal)) (open (list (cell start))))
          (setf (aref seen (first open)) 1)
          (loop while open
                do (let ((here (pop open)))
                     (when (= here end) (return t))
                     (multiple-value-bind (row column) (floor here columns)
                       (loop for r from (max 0 (1- row)) to (min (1- rows) (1+ row))
                             do (loop for c from (max 0 (1- column))
                                        to (min (1- columns) (1+ column))
                                      for next = (+ c (* columns r))
                                      do (when (zerop (aref seen next))
                                           (setf (aref seen next) 1)
                                           (when (or (= next end) (free-p c r))
                                             (push next open)))))))))))))
