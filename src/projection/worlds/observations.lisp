;;;; Observations: what can be seen of a projection's state.

(in-package #:discrepancy-finder.projection)

(defun find-item (projection name)
  "Return the body of the item NAME, a symbol, of PROJECTION, or NIL."
  (cdr (assoc (source:name-keyword name) (projection-items projection))))

(defun item-body (projection name)
  "Return the body of the item NAME, a symbol, of PROJECTION.  Signals UNKNOWN-BODY."
  (or (find-item projection name)
      (error 'unknown-body :name name :scene (scene-name (projection-scene projection)))))

(defun observed-pose (projection name)
  "Return the pose of the robot's base or of the item NAME, a symbol, in PROJECTION.  Signals
UNKNOWN-BODY."
  (let ((name (source:name-keyword name)))
    (if (and (projection-robot projection)
             (eq name (scene-robot-name (projection-scene projection))))
        (base-pose (projection-robot projection))
        (bullet:body-pose (item-body projection name)))))

(defun designated-items (projection designator)
  "Return the names of the items that fit the :type and the :name of the object designator
DESIGNATOR, in the order of the scene; none if it has neither."
  (let ((type (plan:desig-prop-value designator :type))
        (name (plan:desig-prop-value designator :name)))
    (and (or type name)
         (loop for (item) in (projection-items projection)
               when (and (or (null name) (eq name item))
                         (or (null type)
                             (eq type (scene-item-type (projection-scene projection) item))))
                 collect item))))

(defun simulated-seconds (projection)
  "Return the time (s) that has passed in PROJECTION."
  (bullet:world-time (projection-world projection)))

(defun state-hash (projection)
  "Return a 64-bit number that depends on every bit of the state of PROJECTION's bodies."
  (bullet:state-hash (projection-world projection)))

(defun projection-parameter (projection name)
  "Return the value of the parameter or tolerance NAME, a symbol, in PROJECTION: as drawn, or else
the scene's.  Signals UNKNOWN-PARAMETER."
  (scene-parameter (projection-scene projection) name))

;;; Grasps

(defun held-items (projection)
  "Return what the arms of PROJECTION's robot hold: a list of (arm . item), both keywords."
  (loop for (arm item . attachment) in (projection-grasps projection)
        when (bullet:attachment-live-p attachment)
          collect (cons arm item)))

(defun held-item (projection &optional (arm nil arm-p))
  "Return the name (a keyword) of the item that the robot holds in PROJECTION, with ARM if one is
given, or NIL."
  (cdr (if arm-p (assoc arm (held-items projection)) (first (held-items projection)))))

(defun grasp-attachment (projection arm)
  "Return the live attachment by which ARM (a keyword) holds something in PROJECTION, or NIL."
  (let ((attachment (cddr (assoc arm (projection-grasps projection)))))
    (and attachment (bullet:attachment-live-p attachment) attachment)))

(defun note-grasp (projection arm item attachment)
  "Note that ARM (a keyword) holds the item named ITEM by ATTACHMENT in PROJECTION from now on."
  (setf (projection-grasps projection)
        (append (remove arm (projection-grasps projection) :key #'first)
                (list (list* arm item attachment))))
  item)

(defun release-grasp (projection arm)
  "Let go of what ARM holds in PROJECTION.  Return the item's name, or NIL if it held nothing."
  (let ((item (held-item projection arm))
        (attachment (grasp-attachment projection arm)))
    (when attachment (bullet:detach attachment))
    (setf (projection-grasps projection)
          (remove arm (projection-grasps projection) :key #'first))
    item))

;;; Contact

(defun fixture-contact (projection)
  "Return the depth (m) by which the robot's links penetrate the fixtures of PROJECTION at the worst
place, 0 if nowhere, and the names of link and fixture."
  (let ((worst 0d0) (names '()))
    (when (projection-robot projection)
      (dolist (fixture (projection-fixtures projection))
        (dolist (link (link-bodies (projection-robot projection)))
          (let ((depth (bullet:penetration link fixture)))
            (when (> depth worst)
              (setf worst depth
                    names (list (bullet:body-name link) (bullet:body-name fixture))))))))
    (values worst names)))

(defun interpenetration (projection)
  "Return the depth (m) by which bodies of PROJECTION penetrate each other at the worst place, and
the names of the two bodies.  The robot's links and the fixtures count, too."
  (multiple-value-bind (depth one other) (bullet:deepest-penetration (projection-world projection))
    (multiple-value-bind (fixture-depth names) (fixture-contact projection)
      (if (> fixture-depth depth)
          (values fixture-depth names)
          (values depth (and one (list (bullet:body-name one) (bullet:body-name other))))))))

;;; Joints and rest

(defun fixture-joint (projection name &optional fixture)
  "Return the joint NAME (a string) of a fixture of PROJECTION, of FIXTURE (a symbol) if it is
given, or NIL."
  (cddr (find-if (lambda (entry)
                   (and (string= name (second entry))
                        (or (null fixture) (eq (source:name-keyword fixture) (first entry)))))
                 (projection-joints projection))))

(defun observed-joint (projection name)
  "Return the position (m or rad) of the joint NAME (a string) of a fixture or of the robot in
PROJECTION.  Signals UNKNOWN-JOINT."
  (let* ((joint (fixture-joint projection name))
         (robot (projection-robot projection))
         (number (and (null joint) robot (frame-number robot name))))
    (cond (joint (bullet:joint-position joint))
          ((and number (not (eq (urdf-joint-type (link-frame-joint
                                                  (svref (robot-frames robot) number)))
                                :fixed)))
           (aref (joint-positions robot) number))
          (t (error 'unknown-joint :name name :scene (scene-name (projection-scene projection)))))))

(defun item-at-rest-p (projection name)
  "Return true if the item NAME, a symbol, of PROJECTION sleeps, or is slower than 1 mm/s and 0.01
rad/s, and nothing holds it.  Signals UNKNOWN-BODY."
  (let ((body (item-body projection name)))
    (and (not (rassoc (source:name-keyword name) (held-items projection)))
         (or (bullet:asleep-p body)
             (multiple-value-bind (vx vy vz wx wy wz) (bullet:body-velocity body)
               (and (< (+ (* vx vx) (* vy vy) (* vz vz)) 1d-6)
                    (< (+ (* wx wx) (* wy wy) (* wz wz)) 1d-4)))))))
