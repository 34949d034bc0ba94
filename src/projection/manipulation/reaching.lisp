;;;; Reaching: which grasp, with which arm, in which configurations.
;;;;
;;;; A REACH is a plan of an arm: the WAY to where the straight line begins on which the hand comes,
;;;; the LINE itself, and the line on which the hand LEAVES, with what it holds.  FIND-REACH tries
;;;; poses of the tool one after the other, for each height of the torso, the present one first.

(in-package #:discrepancy-finder.projection)

(defstruct (reach (:copier nil))
  "The ways of ARM to the pose TOOL of its tool: WAY, LINE and LEAVING are lists of positions.  GOAL
is what the plan is for, as it was given to FIND-REACH."
  (arm nil :type arm :read-only t)
  (goal nil :read-only t)
  (tool nil :type pose :read-only t)
  (way '() :type list :read-only t)
  (line '() :type list :read-only t)
  (leaving '() :type list :read-only t))

(defparameter *efforts* '((:count 1 :restarts 2) (:count 4 :restarts 6))
  "How hard configurations are looked for, at first and if there are none then.")

(defun upward-joints (projection arm)
  "Return the joints from the tool of ARM up to its first one."
  (let ((frames (robot-frames (projection-robot projection))))
    (loop for number = (arm-tool arm) then (link-frame-parent (svref frames number))
          collect (link-frame-joint (svref frames number))
          until (= number (first (arm-joints arm))))))

(defun origin-distance (pose)
  "Return how far (m) the position of POSE is from the origin."
  (let ((position (pose-position pose)))
    (sqrt (dot position position))))

(defun joint-travel (joint)
  "Return how far (m) JOINT shifts its link from its origin, at the most."
  (if (eq (urdf-joint-type joint) :prismatic)
      (max (abs (or (urdf-joint-lower joint) 1d3)) (abs (or (urdf-joint-upper joint) 1d3)))
      0d0))

(defun arm-wrist (projection arm)
  "Return where the wrist of ARM is: the origin of the highest joint whose place depends on nothing
but the pose of the tool, a pose in the frame of that; and how far (m) it gets from the arm's first
joint, at the most."
  (let ((joints (upward-joints projection arm)) (place (identity-pose)))
    (loop while (and (rest joints) (eq (urdf-joint-type (first joints)) :fixed))
          do (setf place (compose place (inverse (urdf-joint-origin (pop joints))))))
    ;; Turning about axes through one point does not move that point.
    (loop while (and (rest joints)
                     (not (eq (urdf-joint-type (first joints)) :prismatic))
                     (< (origin-distance (urdf-joint-origin (first joints))) 1d-9))
          do (pop joints))
    (values place
            (loop for (joint above) on joints
                  while above
                  sum (+ (origin-distance (urdf-joint-origin joint)) (joint-travel joint))))))

(defun shoulder-position (projection arm positions)
  (let ((robot (projection-robot projection)))
    (pose-position (bullet:forward-kinematics (robot-mechanism robot) (base-pose robot) positions
                                              (first (arm-joints arm))))))

(defun conceivable-p (projection arm positions pose)
  "Return true if the wrist of ARM, with its tool at POSE, is not too far from its shoulder, and the
hand would not point back to the shoulder; what else is possible is up to inverse kinematics."
  (multiple-value-bind (place length) (arm-wrist projection arm)
    (let* ((shoulder (shoulder-position projection arm positions))
           (way (mapcar #'- (pose-position (compose pose place)) shoulder)))
      (and (<= (sqrt (dot way way)) length)
           (>= (dot (mapcar #'- (pose-position pose) shoulder) (turned pose '(1d0 0d0 0d0)))
               0)))))

(defparameter *support-distance* 0.015d0
  "What is to be put down must be free this much (m) higher; below is what it is put on.")

(defun carried-free-p (projection arm positions tool)
  "Return true if what ARM holds would touch nothing a little above where it is at POSITIONS, with
the tool at the pose TOOL; or if it holds nothing."
  (or (null (carried-bodies projection arm))
      (let ((above (first (solve projection arm (moved tool (list 0d0 0d0 *support-distance*))
                                 positions :restarts 0))))
        (and above (free-p projection arm above)))))

(defun lines-from (projection arm there candidate)
  "Return the ways of ARM from the configuration THERE back to where CANDIDATE comes from and on to
where it leaves to; or NIL if there are none."
  (destructuring-bind (goal tool begin end) candidate
    (declare (ignore goal))
    (let ((back (straight-way projection arm there tool begin))
          (leaving (if (listp end)
                       (way-through projection arm there end)
                       (straight-way projection arm there tool end))))
      (and back leaving
           ;; From a handle the hand has to get away where it has come to.
           (or (not (listp end))
               (let ((last (first (last end))))
                 (straight-way projection arm (first (last leaving)) last
                               (advanced last (- *approach-distance*)))))
           (values back leaving)))))

(defun lines-free-p (projection arm there candidate target back leaving)
  "Return true if ARM touches nothing but the bodies TARGET on the ways that LINES-FROM returns, and
nothing at all where these begin."
  (destructuring-bind (goal tool begin end) candidate
    (declare (ignore goal begin))
    (flet ((free-all-p (ways &rest ignored)
             (loop for positions in ways
                   always (free-p projection arm positions :ignored (append target ignored)))))
      (and (free-p projection arm (first (last back)))
           (free-p projection arm there :ignored target :carried nil)
           (carried-free-p projection arm there tool)
           (free-all-p (butlast back))
           ;; What is in a container moves with it.
           (apply #'free-all-p leaving
                  (and (listp end) (mapcar #'cdr (projection-items projection))))))))

(defun reach-from (projection arm candidate start target effort)
  "Return the REACH of ARM for CANDIDATE, by a configuration near START; or NIL and why there is
none. EFFORT is a list of keyword arguments of SOLVE."
  (let ((reason :unreachable))
    (dolist (there (apply #'solve projection arm (second candidate) start effort)
                   (values nil reason))
      (multiple-value-bind (back leaving) (lines-from projection arm there candidate)
        (when back
          (setf reason :collision)
          (let ((way (and (lines-free-p projection arm there candidate target back leaving)
                          (plan-way projection arm (reaching-positions projection arm)
                                    (first (last back))))))
            (when way
              (return (make-reach :arm arm :goal (first candidate) :tool (second candidate)
                                  :way way :line (append (rest (reverse back)) (list there))
                                  :leaving leaving)))))))))

(defun find-reach (projection arm candidates &key target)
  "Return the first REACH of ARM that there is for CANDIDATES, lists of a goal, the pose of the tool
there, the pose from where the hand comes, and the pose to where it leaves or a list of poses on the
way there; or NIL and why there is none, :UNREACHABLE or :COLLISION.  The bodies TARGET may be
touched from where the hand comes on."
  (let ((reason :unreachable) (heights (or (torso-heights projection arm) '(nil))))
    (dolist (effort *efforts* (values nil reason))
      (dolist (height heights)
        (let ((start (reaching-positions projection arm height)))
          (dolist (candidate candidates)
            (when (conceivable-p projection arm start (second candidate))
              (multiple-value-bind (reach why)
                  (reach-from projection arm candidate start target effort)
                (when reach (return-from find-reach reach))
                (when (eq why :collision) (setf reason why))))))))))

(defun reach-problem (reason arms what)
  "Return a sentence that says for which REASON, as FIND-REACH returns it, ARMS do not get to WHAT."
  (format nil (if (eq reason :collision)
                  "the ~{~(~a~)~^ and the ~} arm~p cannot get to ~a without touching something"
                  "the ~{~(~a~)~^ and the ~} arm~p cannot reach ~a")
          (mapcar #'arm-name arms) (length arms) what))

(defun fail-to-reach (reason arms what)
  "Signal the failure for REASON, as FIND-REACH returns it."
  (plan:fail (if (eq reason :collision)
                 'plan:manipulation-goal-not-reached
                 'plan:manipulation-pose-unreachable)
             :description (reach-problem reason arms what)))

(defun with-present-grippers (projection way &key opening)
  "Return WAY with the grippers as they are now, but for that of the arm OPENING."
  (let ((present (joint-positions (projection-robot projection)))
        (grippers (mapcar #'arm-gripper (remove opening
                                                (robot-arms (projection-robot projection))))))
    (loop for positions in way
          collect (let ((positions (copy-seq positions)))
                    (dolist (gripper grippers positions)
                      (setf (aref positions gripper) (aref present gripper)))))))

(defun fail-to-move (arm bodies)
  "Signal that ARM has stopped because the two BODIES would have touched."
  (plan:fail 'plan:manipulation-goal-not-reached
             :description (format nil "the ~(~a~) arm stopped where ~a" (arm-name arm)
                                  (contact-text bodies))))

(defun follow (projection arm way &key (watch :all) ignore smoothly opening)
  "Move ARM along WAY, without stopping at its configurations if SMOOTHLY is true, and OPENING its
gripper meanwhile or not.  Signals MANIPULATION-GOAL-NOT-REACHED where something is touched."
  (when way
    (multiple-value-bind (reason bodies)
        (funcall (if smoothly #'run-smoothly #'run-path)
                 projection (with-present-grippers projection way :opening (and opening arm))
                 :watch watch :ignore ignore)
      (when reason (fail-to-move arm bodies)))))
