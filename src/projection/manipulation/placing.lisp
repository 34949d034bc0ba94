;;;; Placing and parking: actions of type placing and parking-arms.
;;;;
;;;; What an arm holds is brought over its target, put down to a little above it, and let go: how it
;;;; comes to rest is Bullet's business.  It is turned as the target's pose is, or, if the arm
;;;; cannot do that, about the vertical as little as possible.

(in-package #:discrepancy-finder.projection)

(defconstant +turns+ 12
  "Something is put down, or carried, in so many orientations about the vertical.")

(defun turns ()
  "Return the angles (rad) by which things are turned about the vertical, the least first."
  (loop for step from 0 to (/ +turns+ 2)
        for angle = (/ (* 2 pi step) +turns+)
        append (if (or (zerop step) (= step (/ +turns+ 2))) (list angle) (list angle (- angle)))))

(defun turned-about-vertical (pose angle)
  "Return POSE turned by ANGLE (rad) about the vertical through its position."
  (compose (make-pose (pose-x pose) (pose-y pose) (pose-z pose) :yaw angle)
           (moved pose (stretched (pose-position pose) -1))))

(defun placing-arm (projection designator)
  "Return the arm that holds what the placing action DESIGNATOR means."
  (let* ((object (plan:desig-prop-value designator :object))
         (names (mapcar #'arm-name (designated-arms projection designator :arm)))
         (items (and object (designated-items projection object)))
         (entry (find-if (lambda (entry)
                           (and (member (car entry) names)
                                (or (null object) (member (cdr entry) items))))
                         (held-items projection))))
    (if entry
        (find-arm projection (car entry))
        (plan:fail 'plan:gripper-closed-completely
                   :action :placing
                   :description (format nil "the gripper holds nothing to place~@[: no ~(~a~)~]"
                                        (first items))))))

(defun placing-candidates (projection arm target)
  "Return poses of the tool of ARM that put what it holds at TARGET: a list of (pose of the item,
tool, before, before)."
  (let ((lift (projection-parameter projection :clearance))
        (relation (held-relation projection arm)))
    (loop for angle in (turns)
          for goal = (moved (turned-about-vertical target angle) (list 0d0 0d0 *release-gap*))
          for tool = (compose goal relation)
          for above = (moved tool (list 0d0 0d0 lift))
          collect (list goal tool above above))))

(defun find-placing (projection arm target)
  "Return the REACH of ARM that puts what it holds at TARGET, turned as little as possible.  Signals
MANIPULATION-POSE-UNREACHABLE and MANIPULATION-GOAL-NOT-REACHED."
  (let ((reason :unreachable))
    (dolist (candidate (placing-candidates projection arm target)
                       (fail-to-reach reason (list arm) "the target"))
      (multiple-value-bind (reach why) (find-reach projection arm (list candidate))
        (when reach (return reach))
        (when (eq why :collision) (setf reason why))))))

(defun way-clear-p (projection arm start way)
  "Return true if neither ARM nor its hand touches anything on WAY, which begins at START."
  (loop for from = start then to
        for to in way
        always (way-free-p projection arm from to)))

(defun retreat (projection arm)
  "Take the open hand of ARM straight back from where it is, or else upwards, as far as that is
possible.  What the hand was around is not to be pushed away: a way on which it touches nothing
comes before one that is free only where it ends."
  (let* ((tool (tool-pose projection arm))
         (start (joint-positions (projection-robot projection)))
         (ways (loop for end in (list (advanced tool -0.12d0) (advanced tool -0.08d0)
                                      (moved tool '(0d0 0d0 0.1d0)) (advanced tool -0.04d0)
                                      (moved tool '(0d0 0.1d0 0d0)) (moved tool '(0d0 -0.1d0 0d0)))
                     for way = (with-present-grippers
                                projection (straight-way projection arm start tool end))
                     when (and way (free-p projection arm (first (last way)))) collect way)))
    ;; Touching something ends it: what was to be done is done.
    (run-smoothly projection
                  (or (find-if (lambda (way) (way-clear-p projection arm start way)) ways)
                      (first ways))
                  :watch :allow-hand)))

(defparameter *standing-tolerance* 0.02d0
  "What touches something within this distance (m) of where it is to be put stands there.")

(defun put-down (projection arm item reach)
  "Lower ITEM, which ARM holds, along the line of REACH until it touches something or is there.
Signals MANIPULATION-GOAL-NOT-REACHED if it touches something before, GRIPPER-CLOSED-COMPLETELY if
it is lost."
  (let ((body (item-body projection item)))
    (multiple-value-bind (reason bodies)
        (run-smoothly projection (with-present-grippers projection (reach-line reach))
                      :watch (cons body (watched-bodies projection :allow-hand)))
      (check-lifted projection arm item)
      (when reason
        (let ((left (mapcar #'- (pose-position (reach-tool reach))
                            (pose-position (tool-pose projection arm)))))
          (unless (and (member body bodies)
                       (<= (sqrt (dot left left)) *standing-tolerance*))
            (fail-to-move arm bodies)))))))

(defun place (projection designator)
  "Place what the robot holds as DESIGNATOR, an action, says; return the item's name."
  (forget-lost-grasps projection)
  (let ((target (pose-meant (plan:desig-prop-value designator :target))))
    (unless target
      (misunderstood designator "an action of type placing needs a target with a pose"))
    (let* ((arm (placing-arm projection designator))
           (item (held-item projection (arm-name arm))))
      (let ((reach (find-placing projection arm target)))
        (follow projection arm (reach-way reach))
        (check-lifted projection arm item)
        (put-down projection arm item reach)
        (open-gripper projection arm)
        (settle projection)
        (retreat projection arm)
        item))))

;;; Parking

(defun parked-positions-of (projection arm)
  "Return the present positions with ARM parked."
  (let ((positions (copy-seq (joint-positions (projection-robot projection)))))
    (loop for joint in (arm-joints arm)
          for position in (arm-parked arm)
          do (setf (aref positions joint) position))
    (nearest-turns (projection-robot projection) (arm-joints arm) positions
                   (joint-positions (projection-robot projection)))))

(defparameter *carrying-height* 0.95d0
  "The height (m) of a hand that carries something, at least, if that is possible: above tables.")

(defun carrying-poses (projection arm)
  "Return poses of the tool of ARM in front of the robot in which it holds what it holds as upright
as now."
  (let* ((tool (tool-pose projection arm))
         (base (base-pose (projection-robot projection)))
         (parked (compose (inverse base)
                          (tool-pose projection arm (parked-positions-of projection arm))))
         (side (if (plusp (pose-y parked)) 1 -1)))
    (loop for height in (remove-duplicates (list (max (pose-z tool) *carrying-height*)
                                                 (pose-z tool)))
          append (loop for angle in (turns)
                       append (loop for (x y) in '((0.45 0.2) (0.5 0.1) (0.5 0.3) (0.55 0.2)
                                                   (0.6 0.2))
                                    for place = (compose base (make-pose x (* side y) 0))
                                    collect (moved (turned-about-vertical tool angle)
                                                   (list (- (pose-x place) (pose-x tool))
                                                         (- (pose-y place) (pose-y tool))
                                                         (- height (pose-z tool)))))))))

(defun carrying-positions (projection arm)
  "Return positions of ARM in one of its CARRYING-POSES, or NIL if none is possible."
  (let ((present (joint-positions (projection-robot projection))))
    (dolist (pose (carrying-poses projection arm) nil)
      (let ((positions (first (solve projection arm pose present :restarts 1))))
        (when (and positions (free-p projection arm positions))
          (return positions))))))

(defun joints-of-arm (projection arm)
  "Return the list of the positions (m or rad) of the joints of ARM."
  (loop for joint in (arm-joints arm)
        collect (aref (joint-positions (projection-robot projection)) joint)))

(defun parked-p (projection arm)
  "Return true if ARM is where PARK-ARM has left it, or would leave it with an empty hand."
  (let ((positions (joints-of-arm projection arm)))
    (or (equal positions (getf (projection-memory projection) arm))
        (and (null (held-item projection (arm-name arm)))
             (every (lambda (position parked) (< (abs (- position parked)) 1d-3))
                    positions (arm-parked arm))))))

(defun park-arm (projection arm)
  "Take ARM out of the way."
  (let ((goal (or (and (held-item projection (arm-name arm))
                       (carrying-positions projection arm))
                  (parked-positions-of projection arm))))
    (flet ((way ()
             (plan-way projection arm (joint-positions (projection-robot projection)) goal)))
      (follow projection arm
              (or (way)
                  ;; What an empty hand is close to may leave it no way at all.
                  (and (null (held-item projection (arm-name arm)))
                       (loop repeat 3
                             do (retreat projection arm)
                               thereis (way)))
                  (list goal))))
    (setf (getf (projection-memory projection) arm) (joints-of-arm projection arm))))

(defun park-arms (projection designator)
  "Take the arms that DESIGNATOR, an action, names out of the way, or all arms."
  (forget-lost-grasps projection)
  (dolist (arm (designated-arms projection designator
                                (if (plan:desig-prop-value designator :arm) :arm :arms)))
    (park-arm projection arm)))
