;;;; Where the robot can stand: the poses of (a location (reachable-for robot) ...), (visible-for
;;;; robot) and (facing place).
;;;;
;;;; The base poses around a target are those of a fixed lattice: so many directions, some distances
;;;; in each, the robot turned to the target.  They are taken near the robot first; one close to
;;;; what was taken before has its turn later.  A pose at which the robot would touch something is
;;;; none, nor one from which the target is hidden that is to be seen.  What is meant is said by
;;;;   :object     an item, where it was perceived or else is, or a part of a fixture: its handle
;;;;   :location   a location with a pose
;;;;   :arm        :left or :right, before which the target shall be.

(in-package #:discrepancy-finder.projection)

(defparameter *reaching-distances* '(0.65d0 0.75d0 0.55d0 0.85d0 0.45d0)
  "Distances (m) of the base from what it is to reach, the best first.")

(defparameter *opening-distances* '(0.8d0 0.7d0 0.9d0 0.6d0)
  "Distances (m) of the base from where the handle of what it is to open is when that is closed, the
best first.")

(defparameter *opening-offsets* '(0.2d0 0.3d0 0.1d0 0d0)
  "How far (m) aside of the base's middle a handle is, the best first; to which side depends on the
arm.")

(defparameter *seeing-distances* '(0.9d0 0.7d0 1.1d0 1.4d0)
  "Distances (m) of the base from what it is to see, the best first.")

(defconstant +directions-around+ 16
  "From so many sides the robot comes.")

(defparameter *arm-offset* 0.15d0
  "How far (m) to the side of the base's middle a target is that one arm is to reach.")

(defun facing-pose (target direction distance aside)
  "Return the base pose at DISTANCE (m) from TARGET, which is in DIRECTION (rad) from there and
ASIDE (m) to the left."
  (let ((x (cos direction)) (y (sin direction)))
    (make-pose (+ (pose-x target) (- (* distance x)) (* aside y))
               (- (pose-y target) (* distance y) (* aside x))
               0 :yaw direction)))

(defun arm-side (arm)
  "Return how far (m) to the left of the base's middle what ARM is to reach is best."
  (case arm (:left *arm-offset*) (:right (- *arm-offset*)) (t 0d0)))

(defun poses-around (target distances aside)
  "Return a list of (pose . detour) for the base poses around TARGET at DISTANCES; DETOUR (m) is
what a pose is worse than the best."
  (loop for distance in distances
        for rank from 0
        append (loop for step below +directions-around+
                     collect (cons (facing-pose target (/ (* 2 pi step) +directions-around+)
                                                distance aside)
                                   (* 0.3d0 rank)))))

(defun poses-before (handle arm)
  "Return a list of (pose . detour) for the base poses from which what has its handle at the pose
HANDLE, of which x is the way in which it opens, can be opened and closed with ARM, or any arm if
that is NIL."
  (loop for distance in *opening-distances*
        for rank from 0
        append (loop for offset in *opening-offsets*
                     for further from 0
                     append (loop for sign in (case arm (:left '(1)) (:right '(-1)) (t '(1 -1)))
                                  collect (cons (facing-pose handle (+ (pose-yaw handle) pi)
                                                             distance (* sign offset))
                                                (+ (* 0.3d0 rank) (* 0.2d0 further)))))))

(defun best-first (robot candidates)
  "Return the poses of CANDIDATES, (pose . detour), the cheapest way from where ROBOT is first."
  (mapcar #'car
          (stable-sort (copy-list candidates) #'<
                       :key (lambda (candidate)
                              (+ (planar-distance (base-pose robot) (car candidate))
                                 (cdr candidate))))))

(defun spread-poses (poses test apart)
  "Return the lazy list of those of POSES that pass TEST; one within APART (m) of one before comes
after all that are not."
  (prolog:lazy-list ((rest poses) (later '()) (taken '()))
    (let ((pose (first rest)))
      (cond ((and (null rest) (null later)) (prolog:fin))
            ;; An empty list of those taken: now nothing is put off.
            ((null rest) (prolog:next (reverse later) '() '()))
            ((some (lambda (other) (< (planar-distance pose other) apart)) taken)
             (prolog:next (rest rest) (cons pose later) taken))
            ((funcall test pose)
             (prolog:cont pose (rest rest) later (cons pose taken)))
            (t (prolog:next (rest rest) later taken))))))

;;; What is to be reached or seen

(defun handle-place (projection thing)
  "Return the pose of the middle of the handle of the container that THING, a designator, means, as
it is while that is closed, x being the way in which it opens; NIL if THING means none."
  (let ((container (and (typep thing 'plan:object-designator)
                        (first (find-containers projection thing)))))
    (when container
      (let* ((pose (handle-pose projection container))
             (outward (outward projection container pose)))
        (multiple-value-bind (low high)
            (shape-bounds (urdf-link-shape (container-handle container)) pose)
          (carried-along projection container
                         (apply #'make-pose
                                (append (mapcar (lambda (low high) (/ (+ low high) 2)) low high)
                                        (list :yaw (atan (second outward) (first outward)))))
                         (- (bullet:joint-position (container-joint container)))))))))

(defun object-place (projection object)
  "Return the pose of what the designator OBJECT means: as it was perceived, or else as it is."
  (let ((name (item-meant projection object)))
    (or (plan:designated-pose object)
        (and name (observed-pose projection name)))))

(defun location-target (projection location)
  "Return the pose that LOCATION, a location designator for a base pose, is about, or NIL; and true
as second value if it is that of a handle."
  (let ((object (or (plan:desig-prop-value location :object)
                    (plan:desig-prop-value location :obj)))
        (place (plan:desig-prop-value location :location)))
    (cond ((and object (object-place projection object)))
          (object (values (handle-place projection object) t))
          (place (plan:designated-pose place)))))

;;; Tests

(defun camera-at (robot base)
  "Return the pose of ROBOT's camera if its base were at BASE and its joints as they are."
  (compose base (compose (inverse (base-pose robot)) (camera-pose robot))))

(defun in-sight-p (projection base target)
  "Return true if the camera of PROJECTION's robot, with the base at the pose BASE, has a free line
of sight to the position of TARGET.  Items do not count as in the way: one of them may be sought."
  (let* ((robot (projection-robot projection))
         (camera (camera-at robot base))
         (way (sqrt (+ (expt (planar-distance camera target) 2)
                       (expt (- (pose-z camera) (pose-z target)) 2)))))
    (multiple-value-bind (body point normal part)
        (bullet:cast-ray (projection-world projection) camera target
                         :passed (append (link-bodies robot)
                                         (mapcar #'cdr (projection-items projection))))
      (declare (ignore point normal))
      (and (<= way (projection-parameter projection :camera-range))
           (or (null body) (<= (* way (- 1 part)) 0.05d0))))))

(defun base-pose-test (projection test)
  "Return a function that returns true for a base pose that is free and passes TEST."
  (lambda (pose)
    (and (funcall test pose) (base-pose-free-p projection pose))))

(defun reaching-poses (projection location)
  "Return the lazy list of the base poses from which the target of LOCATION can be reached."
  (multiple-value-bind (target handle) (location-target projection location)
    (when target
      (let ((arm (plan:desig-prop-value location :arm)))
        (spread-poses (best-first (projection-robot projection)
                                  (if handle
                                      (poses-before target arm)
                                      (poses-around target *reaching-distances*
                                                    (arm-side arm))))
                      (base-pose-test projection (constantly t))
                      0.08d0)))))

(defun seeing-poses (projection location)
  "Return the lazy list of the base poses from which the target of LOCATION can be seen."
  (let ((target (location-target projection location)))
    (when target
      (spread-poses (best-first (projection-robot projection)
                                (poses-around target *seeing-distances* 0d0))
                    (base-pose-test projection
                                    (lambda (pose) (in-sight-p projection pose target)))
                    0.3d0))))

(defun turned-poses (projection location)
  "Return the base pose, in a list, where the robot is but turned to the place of :facing."
  (let ((target (plan:designated-pose (plan:desig-prop-value location :facing)))
        (base (base-pose (projection-robot projection))))
    (and target
         (list (make-pose (pose-x base) (pose-y base) (pose-z base)
                          :yaw (atan (- (pose-y target) (pose-y base))
                                     (- (pose-x target) (pose-x base))))))))

;;; The generator

(defun projected-poses (designator)
  "Return the poses, a lazy list, that the location DESIGNATOR means in the projection in which a
plan runs: none outside of one, and none for what these files are not about."
  (let ((projection (plan:current-executive)))
    (flet ((asks-p (&rest keys)
             (some (lambda (key) (plan:desig-prop-value designator key)) keys)))
      (when (and (typep projection 'projection) (projection-robot projection)
                 (not (asks-p :pose :poses)))
        (cond ((asks-p :facing) (turned-poses projection designator))
              ((asks-p :reachable-for) (reaching-poses projection designator))
              ((asks-p :visible-for) (seeing-poses projection designator))
              ((asks-p :on :in) (part-poses projection designator)))))))

(desig:register-location-generator 10 projected-poses
  "Places on and in parts of the scene, and where the robot can stand to reach or see something.")
