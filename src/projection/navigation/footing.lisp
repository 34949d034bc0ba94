;;;; Footing: where the robot, as it is now, can stand.
;;;;
;;;; A FOOTING holds the outlines of the robot's links and of what it carries, in the frame of the
;;;; base, and those of everything else that reaches above the ground.  FOOTING-CLEARANCE tells how
;;;; far the robot would be from its surroundings somewhere, STRAIGHT-WAY-P if it can go straight
;;;; from one place to another.  A PLACE is a list x, y, yaw (m, rad).

(in-package #:discrepancy-finder.projection)

(defconstant +yaws+ 16
  "The outlines of the robot are kept for so many directions.")

(defparameter *path-margin* 0.03d0
  "The distance (m) that a planned path keeps from everything.")

(defparameter *tight-radius* 0.2d0
  "Within this distance (m) of its start and its goal a path may come nearer to things.")

(defstruct (footing (:constructor %make-footing (parts reach)) (:copier nil))
  "PARTS is a vector of (piece . obstacles): a piece of the robot in the frame of the base, and the
list of the pieces that it could meet; REACH is the radius (m) of the robot about its base.  ENDS
are the places where the path may be tight."
  (parts #() :type simple-vector)
  (reach 0d0 :type double-float :read-only t)
  (turned (make-array +yaws+ :initial-element nil) :type simple-vector :read-only t)
  (ends '() :type list))

(defun needed-pairs (pairs)
  "Return PAIRS, a list of (piece . obstacles), without the obstacles that another piece meets first
in any case, as it covers the piece."
  (loop for ((piece . obstacles) . later) on pairs
        for covering = (remove-if-not (lambda (other) (covers-p (car other) piece))
                                      (append earlier later))
        for needed = (remove-if (lambda (obstacle)
                                  (some (lambda (other) (member obstacle (cdr other) :test #'eq))
                                        covering))
                                obstacles)
        when needed
          collect (cons piece needed) into earlier
        finally (return earlier)))

(defun make-footing (parts obstacles)
  "Return the footing of a robot with the pieces PARTS, in the frame of its base, among the pieces
OBSTACLES."
  (%make-footing (coerce (needed-pairs
                          (loop for part in parts
                                collect (cons part
                                              (remove-if-not (lambda (obstacle)
                                                               (heights-meet-p part obstacle))
                                                             obstacles))))
                         'simple-vector)
                 (loop for part in parts
                       maximize (+ (piece-radius part)
                                   (sqrt (+ (expt (piece-x part) 2) (expt (piece-y part) 2)))))))

(defun make-turned-parts (footing)
  "Return a vector for the pieces of the robot of FOOTING in one direction, none of them made."
  (make-array (length (footing-parts footing)) :initial-element nil))

(defun parts-at (footing number)
  "Return the vector for the pieces of the robot in the direction NUMBER of +YAWS+."
  (or (svref (footing-turned footing) number)
      (setf (svref (footing-turned footing) number) (make-turned-parts footing))))

(defun clearance-at (footing x y yaw turned limit)
  "Return a lower bound of the distance (m) between the robot of FOOTING at X, Y, YAW and its
surroundings; any number at most LIMIT once it is known to be that near.  TURNED is a vector that
keeps the pieces turned by YAW that were needed."
  (declare (type double-float x y yaw limit) (type simple-vector turned)
           (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let ((nearest 1d9) (sine (sin yaw)) (cosine (cos yaw)) (parts (footing-parts footing)))
    (declare (type double-float nearest sine cosine))
    (loop for (piece . obstacles) across parts
          for index of-type fixnum from 0
          for px = (- (* cosine (piece-x piece)) (* sine (piece-y piece)))
          for py = (+ (* sine (piece-x piece)) (* cosine (piece-y piece)))
          do (dolist (obstacle (the list obstacles))
               (declare (type piece obstacle))
               (let ((distance (box-gap obstacle (+ x px) (+ y py) (piece-radius piece))))
                 (declare (type double-float distance))
                 (when (and (< distance nearest) (< distance 0.2d0))
                   (setf distance
                         (separation (or (svref turned index)
                                         (setf (svref turned index) (turned-piece piece yaw)))
                                     obstacle x y)))
                 (when (< distance nearest)
                   (setf nearest distance)
                   (when (<= nearest limit)
                     (return-from clearance-at nearest))))))
    nearest))

(defun turning-room (footing x y)
  "Return a lower bound of the distance (m) between all that the robot of FOOTING sweeps when it
turns at X, Y and its surroundings."
  (declare (double-float x y))
  (let ((nearest 1d9) (reach (footing-reach footing)))
    (declare (double-float nearest))
    (loop for (nil . obstacles) across (footing-parts footing)
          do (dolist (obstacle obstacles)
               (setf nearest (min nearest (box-gap obstacle x y reach)))))
    nearest))

(defun footing-clearance (footing place &optional (limit -1d9))
  "Return a lower bound of the distance (m) between the robot of FOOTING at PLACE and its
surroundings; any number at most LIMIT once it is known to be that near."
  (destructuring-bind (x y yaw) place
    (clearance-at footing x y yaw (make-turned-parts footing) limit)))

(defun tight-p (footing x y)
  "Return true if a path of FOOTING may come near to things at X, Y."
  (loop for (end-x end-y) in (footing-ends footing)
        thereis (< (+ (expt (- x end-x) 2) (expt (- y end-y) 2)) (expt *tight-radius* 2))))

(defun short-turn (angle)
  "Return the angle (rad) in [-pi, pi] that is equivalent to ANGLE."
  (- angle (* 2 pi (fround angle (* 2 pi)))))

(defun straight-way-p (footing from to)
  "Return true if the robot of FOOTING can go from the place FROM straight to TO, turning
meanwhile."
  (destructuring-bind ((x y yaw) (to-x to-y to-yaw)) (list from to)
    (let* ((dx (- to-x x)) (dy (- to-y y)) (turn (short-turn (- to-yaw yaw)))
           ;; No point of the robot goes farther than that.
           (length (+ (sqrt (+ (* dx dx) (* dy dy))) (* (footing-reach footing) (abs turn))))
           (fraction 0d0)
           (turned (make-turned-parts footing)))
      (loop
        (let* ((px (+ x (* fraction dx))) (py (+ y (* fraction dy)))
               (limit (if (tight-p footing px py) 0d0 *path-margin*))
               (clearance (clearance-at footing px py (+ yaw (* fraction turn)) turned limit)))
          (cond ((<= clearance limit) (return nil))
                ((>= fraction 1d0) (return t)))
          (unless (zerop turn) (fill turned nil))
          (setf fraction (min 1d0 (+ fraction (/ (max 0.02d0 (- clearance *path-margin*))
                                                 (max length 1d-9))))))))))
