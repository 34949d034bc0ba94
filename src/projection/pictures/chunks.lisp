;;;; What is drawn: the bodies of a world as convex CHUNKS, with their colours.
;;;;
;;;; A picture shows the collision shapes, for they are what the physics knows.  A body with a
;;;; compound shape is several chunks.  A chunk belongs to an item, the robot, a fixture or the
;;;; ground: its ROLE.  Large thin boxes are WALLS (and ceilings): pictures from outside look
;;;; through those on the near side.

(in-package #:discrepancy-finder.projection)

(defstruct (chunk (:copier nil))
  "A convex part of BODY: SHAPE, in the notation of the bullet layer, at POSE in the world.  COLOR
is a list of three numbers from 0 to 1; NAME is that of the part of the scene, a keyword or NIL."
  (body nil :read-only t)
  (role :fixture :type keyword :read-only t)
  (name nil :type symbol :read-only t)
  (color '(0.5d0 0.5d0 0.5d0) :type list :read-only t)
  (pose nil :type pose :read-only t)
  (shape nil :type list :read-only t))

(defparameter *item-colors*
  '((0.85d0 0.30d0 0.25d0) (0.95d0 0.70d0 0.20d0) (0.20d0 0.55d0 0.80d0) (0.30d0 0.65d0 0.35d0)
    (0.60d0 0.40d0 0.70d0) (0.90d0 0.50d0 0.65d0) (0.45d0 0.35d0 0.25d0) (0.25d0 0.70d0 0.70d0))
  "The colours of items, in the order of the scene; after the last the first.")

(defparameter *role-colors*
  '((:robot 0.62d0 0.66d0 0.72d0) (:fixture 0.80d0 0.72d0 0.60d0) (:ground 0.88d0 0.89d0 0.90d0))
  "The colours of links that have none of their own.")

(defun body-owner (body)
  "Return the name of the part of the scene that BODY, whose name is part/link, belongs to."
  (let* ((text (princ-to-string (bullet:body-name body)))
         (slash (position #\/ text)))
    (and slash (find-symbol (string-upcase (subseq text 0 slash)) :keyword))))

(defun body-role (projection body)
  "Return what BODY is in PROJECTION: :ITEM, :ROBOT, :FIXTURE or :GROUND."
  (cond ((rassoc body (projection-items projection)) :item)
        ((and (projection-robot projection)
              (member body (link-bodies (projection-robot projection))))
         :robot)
        ((eq (first (bullet:body-shape body)) :plane) :ground)
        (t :fixture)))

(defun link-color (projection body)
  "Return the colour that the model of BODY gives to its link, or NIL."
  (let* ((text (princ-to-string (bullet:body-name body)))
         (slash (position #\/ text))
         (part (and slash (find (body-owner body) (scene-parts (projection-scene projection))
                                :key #'scene-part-name)))
         (link (and part (find-urdf-link (scene-part-model part) (subseq text (1+ slash))))))
    (and link (urdf-link-visual-color link)
         (loop for number in (urdf-link-visual-color link)
               repeat 3
               collect (float number 1d0)))))

(defun body-color (projection body role)
  (cond ((link-color projection body))
        ((eq role :item)
         (nth (mod (position body (projection-items projection) :key #'cdr)
                   (length *item-colors*))
              *item-colors*))
        (t (rest (assoc role *role-colors*)))))

(defun shape-chunks (body role name color pose shape)
  (if (eq (first shape) :compound)
      (loop for (part-pose part) in (rest shape)
            append (shape-chunks body role name color (compose pose part-pose) part))
      (list (make-chunk :body body :role role :name name :color color :pose pose :shape shape))))

(defun projection-chunks (projection)
  "Return the list of the chunks of PROJECTION, as it is now, in the order of its bodies."
  (loop for body in (bullet:world-bodies (projection-world projection))
        for role = (body-role projection body)
        append (shape-chunks body role
                             (if (eq role :item)
                                 (car (rassoc body (projection-items projection)))
                                 (body-owner body))
                             (body-color projection body role)
                             (bullet:body-pose body) (bullet:body-shape body))))

;;; Corners and extents

(defparameter *corners-of-a-circle* 24)

(defun rim-points (radius z)
  (loop for i below *corners-of-a-circle*
        for angle = (* 2 pi (/ i *corners-of-a-circle*))
        collect (point-pose (* radius (cos angle)) (* radius (sin angle)) z)))

(defun shape-corners (shape)
  "Return points, poses in the frame of SHAPE, whose convex hull is SHAPE, or nearly, if it is
round."
  (destructuring-bind (kind . numbers) shape
    (ecase kind
      (:box (destructuring-bind (x y z) numbers
              (loop for sx in '(-1/2 1/2)
                    append (loop for sy in '(-1/2 1/2)
                                 append (loop for sz in '(-1/2 1/2)
                                              collect (point-pose (* sx x) (* sy y) (* sz z)))))))
      (:cylinder (destructuring-bind (radius height) numbers
                   (append (rim-points radius (- (/ height 2)))
                           (rim-points radius (/ height 2)))))
      (:sphere (destructuring-bind (radius) numbers
                 (loop for latitude from -4 to 4
                       for angle = (* pi latitude 1/8)
                       append (rim-points (* radius (cos angle)) (* radius (sin angle))))))
      (:hull (loop for (x y z) in numbers collect (point-pose x y z))))))

(defun chunk-corners (chunk)
  "Return corners of CHUNK as a list of poses in the world; none if it has no end."
  (unless (eq (first (chunk-shape chunk)) :plane)
    (loop for corner in (shape-corners (chunk-shape chunk))
          collect (compose (chunk-pose chunk) corner))))

(defun corners-bounds (corners)
  "Return the lists of the least and of the largest coordinates of CORNERS, poses."
  (flet ((bound (extreme)
           (loop for reader in (list #'pose-x #'pose-y #'pose-z)
                 collect (reduce extreme corners :key reader))))
    (values (bound #'min) (bound #'max))))

;;; Walls

(defparameter *wall-thickness* 0.35d0
  "A box that is at most so thick (m) can be a wall.")

(defparameter *wall-length* 1.5d0
  "A wall is at least so long, and so high (m).")

(defun wall-p (chunk)
  "Return true if CHUNK is a large thin box that belongs to a fixture."
  (and (eq (chunk-role chunk) :fixture)
       (eq (first (chunk-shape chunk)) :box)
       (destructuring-bind (thin middle long) (sort (copy-list (rest (chunk-shape chunk))) #'<)
         (declare (ignore long))
         (and (<= thin *wall-thickness*) (>= middle *wall-length*)))))

(defun contents (chunks)
  "Return those of CHUNKS that stand around: not the ground and the walls, unless there is nothing
else."
  (let ((bounded (remove :ground chunks :key #'chunk-role)))
    (or (remove-if #'wall-p bounded) bounded)))

(defun along (normal point)
  "Return how far (m) the position of the pose POINT is along NORMAL, a list of three numbers."
  (destructuring-bind (x y z) normal
    (+ (* x (pose-x point)) (* y (pose-y point)) (* z (pose-z point)))))

(defun inner-faces (wall)
  "Return the two faces of WALL as lists (nx ny nz d): the points p with n.p >= d are on the outside
of the wall there."
  (let* ((sizes (rest (chunk-shape wall)))
         (axis (position (reduce #'min sizes) sizes))
         (pose (chunk-pose wall))
         (tip (compose pose (point-pose (if (= axis 0) 1 0) (if (= axis 1) 1 0)
                                        (if (= axis 2) 1 0))))
         (normal (list (- (pose-x tip) (pose-x pose)) (- (pose-y tip) (pose-y pose))
                       (- (pose-z tip) (pose-z pose)))))
    (loop for side in '(1 -1)
          for outwards = (mapcar (lambda (part) (* side part)) normal)
          collect (append outwards (list (+ (along outwards pose) (/ (nth axis sizes) 2)))))))

(defun enclosing-faces (chunks)
  "Return the inner faces, as INNER-FACES does, of those walls among CHUNKS that have all contents
on one side."
  (let ((contents (contents chunks)))
    (unless (some #'wall-p contents)
      (loop for wall in (remove-if-not #'wall-p chunks)
            append (loop for face in (inner-faces wall)
                         when (every (lambda (chunk)
                                       (> (along (subseq face 0 3) (chunk-pose chunk))
                                          (- (fourth face) 1d-3)))
                                     contents)
                           collect face)))))

(defun near-faces (faces camera)
  "Return those of FACES behind which the position of the pose CAMERA is."
  (remove-if-not (lambda (face) (< (along (subseq face 0 3) camera) (fourth face))) faces))
