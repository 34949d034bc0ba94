;;;; Picking up: actions of type picking-up.
;;;;
;;;; The grasps that fit the item's shape are tried at the pose where it was seen, those first that
;;;; come from the robot's side and hold it near its centre of mass.  The hand opens, comes, closes,
;;;; and lifts what it has.  An :effort is the force (N) of each finger.

(in-package #:discrepancy-finder.projection)

(defparameter *gravity* 9.81d0
  "m/s^2.")

(defun designated-item (projection designator)
  "Return the name of the item that the object designator DESIGNATOR means, by :name or :type."
  (or (first (designated-items projection designator))
      (plan:fail 'plan:perception-object-not-found
                 :object designator
                 :description (format nil "there is no ~(~a~)"
                                      (or (plan:desig-prop-value designator :name)
                                          (plan:desig-prop-value designator :type)
                                          "object")))))

(defun believed-pose (projection designator item)
  "Return the pose at which ITEM was seen according to the object DESIGNATOR, or where it is."
  (or (plan:designated-pose designator)
      (observed-pose projection item)))

(defun item-link (projection item)
  (first (urdf-model-links (scene-part-model (scene-part (projection-scene projection) item)))))

(defun mass-centre (projection item)
  "Return the position of the centre of mass of ITEM in its own frame."
  (let ((pose (urdf-link-inertial-pose (item-link projection item))))
    (if pose (pose-position pose) '(0d0 0d0 0d0))))

(defun expected-parameter (projection name)
  "Return the value of the parameter NAME as far as the robot knows: the middle of its tolerance."
  (let ((tolerance (assoc name (scene-tolerances (projection-scene projection)))))
    (if tolerance
        (/ (+ (second tolerance) (third tolerance)) 2)
        (projection-parameter projection name))))

(defun grip-need (projection item pose tool)
  "Return which part of what the fingers can bear they need to hold ITEM, at POSE, still with the
tool at the pose TOOL; 1 is all."
  (let* ((weight (* *gravity* (urdf-link-mass (item-link projection item))))
         (capacity (* 2 (expected-parameter projection :finger-friction)
                      (expected-parameter projection :grip-force)))
         (closing (turned tool '(0d0 1d0 0d0)))
         (lever (mapcar #'- (mapcar #'+ (pose-position pose)
                                    (turned pose (mass-centre projection item)))
                        (pose-position tool)))
         (down (list 0d0 0d0 (- weight)))
         (across (max 0d0 (- (dot down down) (expt (dot down closing) 2))))
         (torque (abs (dot (cross lever down) closing))))
    (sqrt (+ (/ across (expt capacity 2))
             (expt (/ torque (* capacity (projection-parameter projection :pad-radius))) 2)))))

(defparameter *grasps-tried* 24
  "So many grasps of an item are tried, the best ones.")

(defun grasp-cost (projection arm item pose tool)
  "Return a number that is less for better grasps: for one along the way from the shoulder, straight
from a side, that needs little force."
  (let* ((approach (turned tool '(1d0 0d0 0d0)))
         (way (mapcar #'- (pose-position tool)
                      (shoulder-position projection arm
                                         (joint-positions (projection-robot projection))))))
    (+ (- 1 (dot approach (unit way)))
       (* 2 (grip-need projection item pose tool))
       (- 1 (expt (reduce #'max (mapcar #'abs approach)) 2)))))

(defun grasp-candidates (projection arm item pose sides)
  "Return the grasps of ITEM, at POSE, for ARM: a list of (grasp tool before afterwards), the best
first.  SIDES is a list of the sides that are allowed, or NIL for all."
  (let* ((lift (projection-parameter projection :clearance))
         (shape (bullet:body-shape (item-body projection item)))
         (rated (loop for grasp in (fitting-grasps (hand-of projection arm) shape)
                      for tool = (compose pose (grasp-tool grasp))
                      when (and (wanted-grasp-p grasp sides)
                                (< (third (turned tool '(1d0 0d0 0d0))) 0.3d0))
                        collect (cons (grasp-cost projection arm item pose tool)
                                      (list grasp tool (advanced tool (- (grasp-depth grasp)))
                                            (moved tool (list 0d0 0d0 lift)))))))
    (let ((sorted (mapcar #'cdr (stable-sort rated #'< :key #'car))))
      (subseq sorted 0 (min *grasps-tried* (length sorted))))))

(defun free-arms (projection names pose)
  "Return the arms of PROJECTION's robot that hold nothing, the one nearest to POSE first; only
those with NAMES unless that is NIL."
  (flet ((distance (arm)
           (let ((way (mapcar #'- (pose-position pose)
                              (shoulder-position projection arm
                                                 (joint-positions
                                                  (projection-robot projection))))))
             (dot way way))))
    (stable-sort (remove-if (lambda (arm)
                              (or (held-item projection (arm-name arm))
                                  (and names (not (member (arm-name arm) names)))))
                            (robot-arms (projection-robot projection)))
                 #'< :key #'distance)))

(defun wanted-sides (projection designator item)
  "Return from where ITEM may be grasped, as DESIGNATOR or else the scene has it: a list of names of
sides and of lists (side x y z), with a point of the item; NIL for anywhere."
  (or (mapcar #'source:name-keyword
              (alexandria:ensure-list (plan:desig-prop-value designator :grasp)))
      (scene-item-grasps (projection-scene projection) item)))

(defparameter *point-tolerance* 0.03d0
  "A grasp is at a point if its tool is within this distance (m).")

(defun wanted-grasp-p (grasp sides)
  "Return true if GRASP is one of SIDES, as WANTED-SIDES returns them."
  (or (null sides)
      (loop for entry in sides
              thereis (destructuring-bind (side &optional (x nil x-p) y z)
                          (alexandria:ensure-list entry)
                        (and (eq side (grasp-side grasp))
                             (or (not x-p)
                                 (let ((way (mapcar #'- (pose-position (grasp-tool grasp))
                                                    (list x y z))))
                                   (<= (sqrt (dot way way)) *point-tolerance*))))))))

(defun find-grasp (projection arms item pose sides)
  "Return the REACH of the first of ARMS that can grasp ITEM at POSE from one of SIDES."
  (let ((reason :unreachable) (body (item-body projection item)))
    (dolist (arm arms (fail-to-reach reason arms (format nil "the ~(~a~)" item)))
      (multiple-value-bind (reach why)
          (find-reach projection arm (grasp-candidates projection arm item pose sides)
                      :target (list body))
        (when reach (return reach))
        (when (eq why :collision) (setf reason why))))))

(defun check-lifted (projection arm item)
  "Signal GRIPPER-CLOSED-COMPLETELY unless ARM holds ITEM still."
  (unless (eq item (held-item projection (arm-name arm)))
    (settle projection)
    (forget-lost-grasps projection)
    (plan:fail 'plan:gripper-closed-completely
               :action :lifting
               :description (format nil "the ~(~a~) has slipped out of the ~(~a~) hand" item
                                    (arm-name arm)))))

(defun designated-object (designator)
  "Return what is known best of the :object of DESIGNATOR, an object designator."
  (let ((object (plan:desig-prop-value designator :object)))
    (unless (typep object 'plan:object-designator)
      (misunderstood designator "it needs an object"))
    (plan:current-desig object)))

(defun pick-up (projection designator)
  "Pick up the object of DESIGNATOR, an action; return the item's name."
  (forget-lost-grasps projection)
  (let* ((object (designated-object designator))
         (item (designated-item projection object))
         (pose (believed-pose projection object item))
         (names (mapcar #'arm-name (designated-arms projection designator :arm)))
         (arms (free-arms projection names pose))
         (body (item-body projection item)))
    (unless arms
      (plan:fail 'plan:gripper-goal-not-reached
                 :action :picking-up
                 :description (format nil "no free arm is left for the ~(~a~): the robot holds ~
                                           ~{the ~(~a~)~^ and ~}" item
                                      (mapcar #'cdr (held-items projection)))))
    (let* ((reach (find-grasp projection arms item pose (wanted-sides projection designator item)))
           (arm (reach-arm reach)))
      (follow projection arm (reach-way reach) :opening t)
      (follow projection arm (reach-line reach) :ignore (list body) :smoothly t)
      (let ((gripped (grip projection arm (wanted-effort designator))))
        (unless (eq gripped item)
          (open-gripper projection arm)
          (plan:fail 'plan:gripper-closed-completely
                     :action :gripping
                     :description (format nil "the ~(~a~) is not between the fingers of the ~(~a~) ~
                                               arm" item (arm-name arm)))))
      (note-relation projection arm (compose (inverse pose) (reach-tool reach)))
      (follow projection arm (reach-leaving reach) :watch :allow-hand :smoothly t)
      (check-lifted projection arm item)
      item)))

(defun note-relation (projection arm relation)
  "Note that the tool of ARM has the pose RELATION in the frame of what it holds, as far as the
robot knows."
  (setf (getf (projection-memory projection) (arm-name arm)) relation))

(defun held-relation (projection arm)
  "Return the pose of the tool of ARM in the frame of what it holds, as far as the robot knows."
  (or (getf (projection-memory projection) (arm-name arm))
      (compose (inverse (observed-pose projection (held-item projection (arm-name arm))))
               (tool-pose projection arm))))
