;;;; Ways: how an arm gets from one configuration to another, and along a straight line.
;;;;
;;;; A way is a list of vectors of positions, without the one where it begins.  PLAN-WAY goes
;;;; straight in joint space if that is free; otherwise it grows two trees of free configurations,
;;;; from the start and from the goal, until they meet.  STRAIGHT-WAY moves the tool along a line.
;;;; What is random here comes from a generator of its own, so that equal questions have equal
;;;; answers.

(in-package #:discrepancy-finder.projection)

(defparameter *tree-size* 120
  "So many configurations at the most are tried to find a way around obstacles.")

(defparameter *line-step* 0.05d0
  "The length (m) of the pieces of a straight line on which the tool moves.")

(defun moving-joints (arm start goal)
  "Return the numbers of the joints of ARM, its torso included, that differ in START and GOAL."
  (remove-if (lambda (joint) (= (aref start joint) (aref goal joint)))
             (append (and (arm-torso arm) (list (arm-torso arm))) (arm-joints arm))))

(defun joint-distance (joints one other)
  (loop for joint in joints maximize (abs (- (aref one joint) (aref other joint)))))

(defun make-generator ()
  "Return a function that returns numbers from 0 to 1, the same in each run."
  (let ((state 88172645463325252))
    (lambda ()
      (setf state (ldb (byte 64 0) (+ (* state 6364136223846793005) 1442695040888963407)))
      (/ (ldb (byte 32 32) state) (float (expt 2 32) 1d0)))))

(defun random-positions (projection joints start generator)
  "Return a copy of START with JOINTS anywhere within their limits; continuous ones within pi."
  (let ((positions (copy-seq start))
        (frames (robot-frames (projection-robot projection))))
    (dolist (number joints positions)
      (let* ((joint (link-frame-joint (svref frames number)))
             (lower (or (urdf-joint-lower joint) (- (aref start number) pi)))
             (upper (or (urdf-joint-upper joint) (+ (aref start number) pi))))
        (setf (aref positions number) (+ lower (* (funcall generator) (- upper lower))))))))

(defun toward (from to step)
  "Return the positions at most STEP (rad or m in each joint) from FROM on the way to TO, and true
if that is TO."
  (let ((length (loop for a across from for b across to maximize (abs (- a b)))))
    (if (<= length step)
        (values to t)
        (values (map '(simple-array double-float (*))
                     (lambda (a b) (+ a (* (/ step length) (- b a)))) from to)
                nil))))

(defun way-to-root (node)
  "Return the configurations of NODE, a list (positions . parent node), up to the root."
  (loop for (positions . parent) = node then parent
        collect positions while parent))

(defun trees-way (projection arm start goal)
  "Return a way from START to GOAL around obstacles, or NIL if none was found."
  (let* ((joints (moving-joints arm start goal))
         (generator (make-generator))
         (here (list (list start))) (there (list (list goal)))
         (swapped nil))
    (flet ((nearest (tree positions)
             (let ((best nil) (least most-positive-double-float))
               (dolist (node tree best)
                 (let ((distance (joint-distance joints (first node) positions)))
                   (when (< distance least) (setf best node least distance))))))
           (free-way-p (from to) (way-free-p projection arm from to)))
      (loop repeat *tree-size*
            do (let* ((sample (random-positions projection joints start generator))
                      (node (nearest here sample))
                      (new (toward (first node) sample 0.7d0)))
                 (when (free-way-p (first node) new)
                   (let ((grown (cons new node)))
                     (push grown here)
                     (let ((other (nearest there new)))
                       (when (free-way-p new (first other))
                         (let ((way (append (reverse (way-to-root grown)) (way-to-root other))))
                           (return (rest (if swapped (reverse way) way)))))))))
               (rotatef here there)
               (setf swapped (not swapped))))))

(defun shortened (projection arm start way)
  "Return WAY, which begins at START, without detours that are not needed."
  (loop with here = start
        while way
        for next = (or (position-if (lambda (positions)
                                      (way-free-p projection arm here positions))
                                    way :from-end t)
                       0)
        collect (setf here (nth next way))
        do (setf way (nthcdr (1+ next) way))))

(defun plan-way (projection arm start goal)
  "Return a way of ARM from START to GOAL on which it touches nothing, or NIL if none is found."
  (cond ((null (moving-joints arm start goal)) (list goal))
        ((way-free-p projection arm start goal) (list goal))
        (t (let ((way (trees-way projection arm start goal)))
             (and way (shortened projection arm start way))))))

;;; Straight lines of the tool

(defun between-poses (from to fraction)
  "Return the pose at FRACTION of the way from FROM to TO, which must be turned alike."
  (moved from (stretched (mapcar #'- (pose-position to) (pose-position from)) fraction)))

(defun way-through (projection arm start poses)
  "Return a way of ARM from START with its tool at each of POSES, which are near each other; NIL if
the arm cannot."
  (let ((positions start))
    (loop for pose in poses
          for next = (first (solve projection arm pose positions :restarts 0))
          do (when (or (null next) (> (joint-distance (arm-joints arm) positions next) 0.6d0))
               (return nil))
             (setf positions next)
          collect next)))

(defun straight-way (projection arm start from to)
  "Return a way of ARM from START, where its tool is at the pose FROM, with the tool on a straight
line to TO; NIL if the arm cannot."
  (let* ((line (mapcar #'- (pose-position to) (pose-position from)))
         (pieces (max 1 (ceiling (sqrt (dot line line)) *line-step*))))
    (way-through projection arm start
                 (loop for piece from 1 to pieces
                       collect (between-poses from to (/ piece pieces))))))
