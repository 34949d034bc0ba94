;;;; Base motion: a path of the base as a motion in time.
;;;;
;;;; A path is a list of places.  From one to the next the base moves and turns at once: straight in
;;;; a space of x, y and yaw, in which a turn counts as the length that is driven in the same time.
;;;; At a corner the base leaves the straight way for an arc, where that is free, and drives so
;;;; slowly there that its acceleration stays within bounds; else it stops.  So a path is a list of
;;;; STRETCHes, straight ones and arcs.  PATH-BASES is the entry point.

(in-package #:discrepancy-finder.projection)

(defparameter *blend* 0.15d0
  "The largest distance (m) from a corner of a path at which the base leaves the straight way.")

(defstruct (gait (:constructor make-gait (speed acceleration deceleration turn-weight))
                 (:copier nil))
  "How fast the base may be: SPEED (m/s), ACCELERATION and DECELERATION (m/s^2); a turn by a radian
counts as a way of TURN-WEIGHT (m)."
  (speed 1d0 :type double-float :read-only t)
  (acceleration 1d0 :type double-float :read-only t)
  (deceleration 1d0 :type double-float :read-only t)
  (turn-weight 1d0 :type double-float :read-only t))

(defstruct (stretch (:constructor make-stretch (start direction length cap stop
                                                &optional (side '(0d0 0d0 0d0)) (radius 0d0)))
                    (:copier nil))
  "A part of a path: it begins at START, a list of x, y and the weighted yaw, in the DIRECTION of a
unit vector, and has LENGTH (m); an arc has its middle at RADIUS (m) in the direction SIDE.  On it
the speed is CAP (m/s) at most, at its end 0 if STOP is true."
  (start '() :type list :read-only t)
  (direction '() :type list :read-only t)
  (length 0d0 :type double-float :read-only t)
  (cap 0d0 :type double-float :read-only t)
  (stop nil :read-only t)
  (side '() :type list :read-only t)
  (radius 0d0 :type double-float :read-only t))

;;; Vectors are lists of three numbers.

(defun points-apart (a b) (mapcar #'- a b))
(defun dot (a b) (reduce #'+ (mapcar #'* a b)))
(defun times (factor a) (mapcar (lambda (number) (* factor number)) a))
(defun points-sum (a b) (mapcar #'+ a b))
(defun point-length (a) (sqrt (dot a a)))

(defun stretch-point (stretch distance)
  "Return the point, three values, of STRETCH at DISTANCE (m) from its start."
  (declare (double-float distance))
  (destructuring-bind ((x y w) (dx dy dw) (sx sy sw))
      (list (stretch-start stretch) (stretch-direction stretch) (stretch-side stretch))
    (declare (double-float x y w dx dy dw sx sy sw))
    (let ((radius (stretch-radius stretch)))
      (if (zerop radius)
          (values (+ x (* distance dx)) (+ y (* distance dy)) (+ w (* distance dw)))
          (let* ((angle (/ distance radius))
                 (along (* radius (sin angle))) (aside (* radius (- 1 (cos angle)))))
            (values (+ x (* along dx) (* aside sx)) (+ y (* along dy) (* aside sy))
                    (+ w (* along dw) (* aside sw))))))))

;;; Stretches

(defun weighted-points (gait path)
  "Return the points x, y, weighted yaw of the places of PATH, with yaws that differ by less than
half a turn from each place to the next."
  (loop with yaw = (third (first path))
        for (x y next) in path
        do (incf yaw (short-turn (- next yaw)))
        collect (list x y (* (gait-turn-weight gait) yaw))))

(defun corner-arc (gait from corner to free-p)
  "Return the arc, a STRETCH, that leads around CORNER on the way from FROM to TO, and the distance
from CORNER at which it begins; NIL if there is none that is free."
  (let* ((in (points-apart corner from)) (out (points-apart to corner))
         (before (point-length in)) (after (point-length out))
         (in (times (/ before) in)) (out (times (/ after) out))
         (angle (acos (max -1d0 (min 1d0 (dot in out)))))
         (distance (min *blend* (/ before 2) (/ after 2)))
         (radius (if (< 1d-6 angle (- pi 1d-3)) (/ distance (tan (/ angle 2))) 0d0)))
    (when (> radius 0.01d0)
      (let* ((across (points-apart out (times (dot in out) in)))
             (arc (make-stretch (points-apart corner (times distance in)) in (* radius angle)
                                (min (gait-speed gait)
                                     (sqrt (* radius (min (gait-acceleration gait)
                                                          (gait-deceleration gait)))))
                                nil (times (/ (point-length across)) across) radius)))
        (and (loop for i from 1 below 8
                   always (multiple-value-bind (x y w)
                              (stretch-point arc (* (/ i 8) (stretch-length arc)))
                            (funcall free-p (list x y (/ w (gait-turn-weight gait))))))
             (values arc distance))))))

(defun path-stretches (gait path free-p)
  "Return the list of the STRETCHes that lead along PATH."
  (let ((points (remove-duplicates (weighted-points gait path) :test #'equal)) (stretches '())
        (begin 0d0))
    (loop for (from to after) on points
          while to
          do (multiple-value-bind (arc distance)
                 (and after (corner-arc gait from to after free-p))
               (let* ((way (points-apart to from)) (length (point-length way))
                      (distance (or distance 0d0))
                      (direction (times (/ length) way)))
                 (when (> (- length begin distance) 1d-9)
                   (push (make-stretch (points-sum from (times begin direction)) direction
                                       (- length begin distance) (gait-speed gait) (null arc))
                         stretches))
                 (when arc (push arc stretches))
                 (setf begin distance))))
    (nreverse stretches)))

;;; Time

(defstruct (leg (:constructor make-leg (stretch entry peak exit rise cruise fall)) (:copier nil))
  "The motion along STRETCH: from the speed ENTRY (m/s) to PEAK in RISE (s), on for CRUISE, and to
the speed EXIT in FALL."
  (stretch nil :type stretch :read-only t)
  (entry 0d0 :type double-float :read-only t)
  (peak 0d0 :type double-float :read-only t)
  (exit 0d0 :type double-float :read-only t)
  (rise 0d0 :type double-float :read-only t)
  (cruise 0d0 :type double-float :read-only t)
  (fall 0d0 :type double-float :read-only t))

(defun leg-duration (leg)
  (+ (leg-rise leg) (leg-cruise leg) (leg-fall leg)))

(defun leg-distance (gait leg time)
  "Return how far (m) the base has got on LEG at TIME (s) after its beginning."
  (declare (double-float time))
  (let ((rise (leg-rise leg)) (left (- (leg-duration leg) time))
        (length (stretch-length (leg-stretch leg))))
    (cond ((<= left 0) length)
          ((< time rise)
           (* time (+ (leg-entry leg) (* 0.5d0 (gait-acceleration gait) time))))
          ((< left (leg-fall leg))
           (- length (* left (+ (leg-exit leg) (* 0.5d0 (gait-deceleration gait) left)))))
          (t (+ (* rise (/ (+ (leg-entry leg) (leg-peak leg)) 2))
                (* (leg-peak leg) (- time rise)))))))

(defun junction-speeds (gait stretches)
  "Return the list of the speeds (m/s) before, between and after STRETCHES."
  (let ((speeds (append (list 0d0)
                        (loop for (one next) on stretches
                              collect (if (or (stretch-stop one) (null next))
                                          0d0
                                          (min (stretch-cap one) (stretch-cap next)))))))
    (flet ((bounded (speeds lengths rate)
             (loop for length in (cons 0d0 lengths)
                   for limit in speeds
                   for speed = limit then (min limit (sqrt (+ (* speed speed)
                                                              (* 2 rate length))))
                   collect speed)))
      (let ((lengths (mapcar #'stretch-length stretches)))
        (reverse (bounded (reverse (bounded speeds lengths (gait-acceleration gait)))
                          (reverse lengths) (gait-deceleration gait)))))))

(defun path-legs (gait stretches)
  "Return the list of the LEGs of the motion along STRETCHES."
  (let ((a (gait-acceleration gait)) (d (gait-deceleration gait)))
    (loop for stretch in stretches
          for (entry exit) on (junction-speeds gait stretches)
          for length = (stretch-length stretch)
          for peak = (max entry exit
                          (min (stretch-cap stretch)
                               (sqrt (/ (+ (* 2 a d length) (* d entry entry) (* a exit exit))
                                        (+ a d)))))
          for rise = (/ (- peak entry) a)
          for fall = (/ (- peak exit) d)
          collect (make-leg stretch entry peak exit rise
                            (max 0d0 (/ (- length (* rise (/ (+ entry peak) 2))
                                           (* fall (/ (+ peak exit) 2)))
                                        peak))
                            fall))))

(defun put-pose (bases step pose)
  "Put the numbers of POSE to the place of STEP in the vector BASES."
  (declare (type doubles bases) (fixnum step))
  (let ((i (* 7 step)))
    (setf (aref bases i) (pose-x pose) (aref bases (+ i 1)) (pose-y pose)
          (aref bases (+ i 2)) (pose-z pose) (aref bases (+ i 3)) (pose-qx pose)
          (aref bases (+ i 4)) (pose-qy pose) (aref bases (+ i 5)) (pose-qz pose)
          (aref bases (+ i 6)) (pose-qw pose))))

(defun put-level-pose (bases step x y z yaw)
  "Put the numbers of the upright pose at X, Y, Z to the place of STEP in the vector BASES."
  (declare (type doubles bases) (fixnum step) (double-float x y z yaw))
  (let ((i (* 7 step)) (half (/ yaw 2)))
    (setf (aref bases i) x (aref bases (+ i 1)) y (aref bases (+ i 2)) z
          (aref bases (+ i 3)) 0d0 (aref bases (+ i 4)) 0d0
          (aref bases (+ i 5)) (sin half) (aref bases (+ i 6)) (cos half))))

(defun path-bases (gait path terrain height free-p last)
  "Return the vector of the poses of the base, seven numbers each, after each step of the motion
along PATH, a list of places, at HEIGHT (m) above the ground of TERRAIN; the last pose is LAST.
FREE-P is a function that tells whether the base can be at a place.  The vector is empty if PATH has
no length."
  (let* ((legs (path-legs gait (path-stretches gait path free-p)))
         (duration (reduce #'+ legs :key #'leg-duration))
         (steps (values (ceiling (- (/ duration +time-step+) 1d-9))))
         (bases (make-array (* 7 steps) :element-type 'double-float))
         (weight (gait-turn-weight gait))
         (begin 0d0))
    (declare (double-float begin weight) (type doubles bases))
    (loop for step of-type fixnum from 0 below (1- steps)
          for time double-float = (* (1+ step) (float +time-step+ 1d0))
          do (loop while (and (rest legs) (>= time (+ begin (leg-duration (first legs)))))
                   do (incf begin (leg-duration (pop legs))))
             (multiple-value-bind (x y w)
                 (stretch-point (leg-stretch (first legs))
                                (leg-distance gait (first legs) (- time begin)))
               (let ((yaw (/ w weight)))
                 (if (nth-value 4 (wheel-heights terrain x y yaw))
                     (put-level-pose bases step x y height yaw)
                     (put-pose bases step (ground-pose terrain x y height yaw))))))
    (when (plusp steps)
      (put-pose bases (1- steps) last))
    bases))
