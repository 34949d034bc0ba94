;;;; Surroundings: the footing of a projection's robot, as everything is now.
;;;;
;;;; What the polygons of FOOTING take for a collision may be none, since slanted links have large
;;;; outlines: where the robot starts and where it wants to go the distance of the bodies decides,
;;;; and then the pairs of pieces that only seem to meet are left to the watch over the motion.

(in-package #:discrepancy-finder.projection)

(defun body-pieces (body)
  "Return the pieces of BODY, where it is now."
  (shape-pieces (bullet:body-shape body) (bullet:body-pose body)))

(defun robot-pieces (projection)
  "Return the pieces of PROJECTION's robot and of what it holds, in the level frame of its base."
  (let* ((robot (projection-robot projection))
         (mechanism (robot-mechanism robot))
         (base (base-pose robot))
         (standing (make-pose 0 0 (standing-height robot)))
         (level (make-pose (pose-x base) (pose-y base)
                           (- (pose-z base) (standing-height robot))
                           :yaw (pose-yaw base)))
         (outside (inverse level)))
    (append
     (loop for body across (robot-bodies robot)
           for number from 0
           when body
             ;; As if it stood on level ground, so that the same posture has the same pieces.
             append (shape-pieces (bullet:body-shape body)
                                  (bullet:forward-kinematics mechanism standing
                                                             (joint-positions robot) number)))
     (loop for body in (held-bodies projection)
           append (shape-pieces (bullet:body-shape body)
                                (compose outside (bullet:body-pose body)))))))

(defun obstacle-pieces (projection)
  "Return the pieces of all that the robot of PROJECTION must not touch."
  (let ((held (held-bodies projection)))
    (append
     (loop for solid in (projection-solids projection)
           unless (driven-over-p projection solid)
             append (or (solid-pieces solid) (body-pieces (solid-body solid))))
     (loop for (nil . body) in (projection-items projection)
           unless (member body held)
             append (body-pieces body)))))

(defun base-place (robot)
  "Return the place, a list x, y, yaw, of the base of ROBOT."
  (let ((base (base-pose robot)))
    (list (pose-x base) (pose-y base) (pose-yaw base))))

(defun touches-at-p (projection place &optional (bodies (solid-bodies projection)))
  "Return true if PROJECTION's robot, as it is now, would touch one of BODIES at PLACE."
  (let ((robot (projection-robot projection)))
    (destructuring-bind (x y yaw) place
      (<= (bullet:mechanism-clearance (robot-mechanism robot)
                                      (make-pose x y (standing-height robot) :yaw yaw)
                                      (joint-positions robot)
                                      (watched-bodies projection :all)
                                      bodies 1d-3)
          0))))

(defun touched-at (projection place)
  "Return the list of the names of the bodies that PROJECTION's robot, as it is now, would touch at
PLACE."
  (loop for body in (solid-bodies projection)
        when (touches-at-p projection place (list body))
          collect (bullet:body-name body)))

(defun without-pairs-at (footing place)
  "Return FOOTING without the pairs of pieces that overlap at PLACE."
  (destructuring-bind (x y yaw) place
    (%make-footing (map 'simple-vector
                        (lambda (part)
                          (let ((piece (turned-piece (car part) yaw)))
                            (cons (car part)
                                  (remove-if (lambda (obstacle)
                                               (<= (separation piece obstacle x y) 0))
                                             (cdr part)))))
                        (footing-parts footing))
                   (footing-reach footing))))

(defun projection-footing (projection)
  "Return the footing of PROJECTION's robot, which may leave the place where it is."
  (without-pairs-at (make-footing (robot-pieces projection) (obstacle-pieces projection))
                    (base-place (projection-robot projection))))

(defun footing-for (projection footing place)
  "Return a footing like FOOTING in which the robot of PROJECTION can stand at PLACE, or NIL if it
cannot."
  (cond ((> (footing-clearance footing place 0d0) 0) footing)
        ((touches-at-p projection place) nil)
        (t (without-pairs-at footing place))))

(defun lattice-bounds (footing start goal)
  "Return the bounds of the lattice for FOOTING between the places START and GOAL."
  (let ((room (+ (footing-reach footing) 0.5d0))
        (x0 (min (first start) (first goal))) (x1 (max (first start) (first goal)))
        (y0 (min (second start) (second goal))) (y1 (max (second start) (second goal))))
    (loop for (nil . obstacles) across (footing-parts footing)
          do (dolist (piece obstacles)
               (setf x0 (min x0 (- (piece-x piece) (piece-radius piece)))
                     x1 (max x1 (+ (piece-x piece) (piece-radius piece)))
                     y0 (min y0 (- (piece-y piece) (piece-radius piece)))
                     y1 (max y1 (+ (piece-y piece) (piece-radius piece))))))
    (list (- x0 room) (- y0 room) (+ x1 room) (+ y1 room))))

(defun pose-place (pose)
  (list (pose-x pose) (pose-y pose) (pose-yaw pose)))

(defun base-pose-free-p (projection pose)
  "Return true if PROJECTION's robot, as it is now, could stand at POSE, of which x, y and yaw
count, and touch nothing."
  (and (footing-for projection (projection-footing projection) (pose-place pose)) t))

(defun plan-base-path (projection goal)
  "Return a list of places, from where the base of PROJECTION's robot is now to the pose GOAL, on
which it touches nothing; or NIL, and :GOAL if it cannot stand at GOAL, :PATH if it cannot get
there.  The third value is the footing."
  (let* ((start (base-place (projection-robot projection)))
         (goal (pose-place goal))
         (footing (footing-for projection (projection-footing projection) goal)))
    (if footing
        (values (plan-path footing start goal (lattice-bounds footing start goal)) :path footing)
        (values nil :goal))))

(defun projection-terrain (projection)
  "Return the terrain on which the robot of PROJECTION stands."
  (let ((sills (loop for solid in (projection-solids projection)
                     when (driven-over-p projection solid)
                       append (solid-pieces solid))))
    (make-terrain sills
                  (and sills (wheel-places (base-outline (projection-robot projection))))
                  (projection-parameter projection :suspension))))

(defun base-outline (robot)
  "Return the piece of ROBOT that is nearest to the ground, in the frame of its base."
  (let ((pieces (loop for frame across (robot-frames robot)
                      for shape = (urdf-link-shape (link-frame-link frame))
                      when shape append (shape-pieces shape (link-frame-rest frame)))))
    (reduce (lambda (a b) (if (< (piece-low b) (piece-low a)) b a)) pieces)))
