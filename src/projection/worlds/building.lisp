;;;; Building: the bodies and joints of a scene in a Bullet world.

(in-package #:discrepancy-finder.projection)

(defun part-pose (part poses)
  "Return the pose of PART: that in the property list POSES, if it can be moved, or the scene's."
  (or (and (not (eq (scene-part-kind part) :fixture)) (getf poses (scene-part-name part)))
      (scene-part-pose part)))

(defun add-planned-body (world plan pose kind surface)
  "Add the body of PLAN, of a part at POSE, to WORLD."
  (if (eq kind :static)
      (apply #'bullet:add-body world (body-plan-name plan) (body-plan-shape plan)
             (compose pose (body-plan-pose plan)) :kind :static surface)
      (apply #'bullet:add-body world (body-plan-name plan) (body-plan-shape plan)
             (compose pose (body-plan-pose plan))
             :kind :dynamic :mass (body-plan-mass plan) :inertia (body-plan-inertia plan)
             :inertial-pose (body-plan-inertial-pose plan)
             :linear-damping (joint-damping plan) surface)))

(defun joint-damping (plan)
  "Return the part of its velocity that the body of PLAN loses in a second by its joint's damping."
  (let ((joint (body-plan-joint plan)))
    (if (and joint (eq (urdf-joint-type joint) :prismatic) (plusp (body-plan-mass plan)))
        (- 1 (exp (- (/ (urdf-joint-damping joint) (body-plan-mass plan)))))
        0d0)))

(defun add-item (scene part world poses)
  "Add the item PART to WORLD; return (name . body)."
  (cons (scene-part-name part)
        (add-planned-body world (first (blueprint-plans (part-blueprint part)))
                          (part-pose part poses) :dynamic (part-surface scene part))))

(defun add-fixture-joint (part plan body world pose)
  "Connect BODY, made by PLAN, to what it moves on; return (fixture name . joint)."
  (let* ((joint (body-plan-joint plan))
         (bases (loop for base in (body-plan-bases plan)
                      collect (bullet:find-body world (body-plan-name base))))
         (made (bullet:add-joint world
                                 (if (eq (urdf-joint-type joint) :prismatic) :slider :hinge)
                                 (first bases) body (compose pose (body-plan-frame plan))
                                 :lower (urdf-joint-lower joint) :upper (urdf-joint-upper joint)
                                 :name (body-plan-name plan))))
    (dolist (base (rest bases))
      (bullet:ignore-collision base body t))
    (when (plusp (urdf-joint-friction joint))
      (bullet:set-motor made 0d0 (urdf-joint-friction joint)))
    (list* (scene-part-name part) (urdf-joint-name joint) made)))

(defun planned-solid (plan body)
  "Return the SOLID for BODY, made by PLAN."
  (make-solid body
              (reduce #'max (body-plan-pieces plan) :key #'piece-high :initial-value 0d0)
              (body-plan-pieces plan)))

(defun add-fixture (scene part world poses)
  "Add the fixture PART to WORLD; return the list of its SOLIDs, and that of its joints."
  (let ((pose (part-pose part poses)) (surface (part-surface scene part))
        (solids '()) (joints '()))
    (dolist (plan (blueprint-plans (part-blueprint part)))
      (let ((body (add-planned-body world plan pose
                                    (if (body-plan-joint plan) :dynamic :static) surface)))
        (push (planned-solid plan body) solids)
        (when (body-plan-joint plan)
          (push (add-fixture-joint part plan body world pose) joints))))
    (values (nreverse solids) (nreverse joints))))

;;; Positions of joints at first

(defun within-body-p (body pose point)
  "Return true if the position of the pose POINT is inside of the box along the axes of POSE that
the shape of BODY would just fit into there."
  (let ((local (compose (inverse pose) point)))
    (flet ((between-p (value low high) (<= low value high)))
      (loop for piece in (shape-pieces (bullet:body-shape body) (identity-pose))
            for polygon = (piece-polygon piece)
            minimize (loop for i below (length polygon) by 2 minimize (aref polygon i)) into x0
            maximize (loop for i below (length polygon) by 2 maximize (aref polygon i)) into x1
            minimize (loop for i from 1 below (length polygon) by 2
                           minimize (aref polygon i)) into y0
            maximize (loop for i from 1 below (length polygon) by 2
                           maximize (aref polygon i)) into y1
            minimize (piece-low piece) into low
            maximize (piece-high piece) into high
            finally (return (and (between-p (pose-x local) x0 x1)
                                 (between-p (pose-y local) y0 y1)
                                 (between-p (pose-z local) low high)))))))

(defun check-joint-position (joint position)
  "Signal IMPOSSIBLE-JOINT-POSITION unless POSITION is within the limits of JOINT, a URDF-JOINT."
  (unless (and (realp position) (within-limits-p joint (decimal-double position)))
    (error 'impossible-joint-position :name (urdf-joint-name joint) :value position
                                      :lower (urdf-joint-lower joint)
                                      :upper (urdf-joint-upper joint))))

(defun move-fixture-joint (projection joint position poses)
  "Put the body of JOINT of a fixture of PROJECTION to where it has POSITION, and with it the items
in it, but for those that have a pose in POSES."
  (let* ((body (bullet:joint-child joint))
         (before (bullet:body-pose body))
         (along (loop for (name . item) in (projection-items projection)
                      when (and (null (getf poses name))
                                (within-body-p body before (bullet:body-pose item)))
                        collect item)))
    (bullet:set-joint-position joint position)
    (let ((move (compose (bullet:body-pose body) (inverse before))))
      (dolist (item along)
        (bullet:place-body item (compose move (bullet:body-pose item)))))))

(defun joint-of-part (scene name)
  "Return the movable URDF-JOINT that has NAME in the robot or a fixture of SCENE, and the part.
Signals UNKNOWN-JOINT."
  (dolist (part (scene-parts scene) (error 'unknown-joint :name name :scene (scene-name scene)))
    (let ((joint (and (stringp name) (find-urdf-joint (scene-part-model part) name))))
      (when (and joint (not (eq (urdf-joint-type joint) :fixed))
                 (not (eq (scene-part-kind part) :item)))
        (return (values joint part))))))

(defun move-joints-at-first (projection joints poses)
  "Put the joints of PROJECTION to the positions in the association list JOINTS."
  (loop for (name . position) in joints
        do (multiple-value-bind (joint part) (joint-of-part (projection-scene projection) name)
             (check-joint-position joint position)
             (if (eq (scene-part-kind part) :robot)
                 (let ((robot (projection-robot projection)))
                   (setf (aref (joint-positions robot) (frame-number robot name))
                         (decimal-double position)))
                 (move-fixture-joint projection (fixture-joint projection name)
                                     (decimal-double position) poses)))))

;;; The whole

(defun build-world (scene world fidelity poses joints)
  "Add all parts of SCENE to WORLD and return the projection."
  (loop for (name) on poses by #'cddr do (check-movable scene name))
  (bullet:add-body world "ground" '(:plane 0d0 0d0 1d0 0d0) (identity-pose) :kind :static)
  (let ((solids '()) (fixture-joints '()))
    (dolist (part (scene-parts scene))
      (when (eq (scene-part-kind part) :fixture)
        (multiple-value-bind (part-solids part-joints) (add-fixture scene part world poses)
          (setf solids (append solids part-solids)
                fixture-joints (append fixture-joints part-joints)))))
    (let* ((part (scene-robot scene))
           (robot (and part (add-robot scene part world (part-pose part poses))))
           (projection (make-instance
                        'projection
                        :scene scene :world world :robot robot :solids solids
                        :fidelity fidelity :joints fixture-joints
                        :items (loop for part in (scene-parts scene)
                                     when (eq (scene-part-kind part) :item)
                                       collect (add-item scene part world poses)))))
      (when joints (move-joints-at-first projection joints poses))
      (when robot (teleport-robot robot))
      projection)))

;;; Links of fixtures

(defun fixture-link (projection name &optional fixture)
  "Return the body of PROJECTION that the link NAME (a string) of a fixture is part of, of FIXTURE
(a symbol) if it is given, and the link's pose in the frame of the body; NIL if there is none."
  (dolist (part (scene-parts (projection-scene projection)))
    (when (and (eq (scene-part-kind part) :fixture)
               (or (null fixture) (eq (scene-part-name part) (source:name-keyword fixture))))
      (dolist (plan (blueprint-plans (part-blueprint part)))
        (let ((member (assoc name (body-plan-members plan) :test #'string=)))
          (when member
            (return-from fixture-link
              (values (bullet:find-body (projection-world projection) (body-plan-name plan))
                      (cdr member)))))))))

(defun fixture-link-body (projection name &optional fixture)
  "Return the first value of FIXTURE-LINK."
  (values (fixture-link projection name fixture)))

(defun fixture-link-pose (projection name &optional fixture)
  "Return the pose in the world of the link NAME (a string) of a fixture of PROJECTION, of FIXTURE
(a symbol) if it is given, or NIL if there is no such link."
  (multiple-value-bind (body offset) (fixture-link projection name fixture)
    (and body (compose (bullet:body-pose body) offset))))
