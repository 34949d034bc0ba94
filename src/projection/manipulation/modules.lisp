;;;; The process modules of arms and grippers: which designator is executed by what.
;;;;
;;;; Motions: moving-tcp, moving-arm-joints, opening and closing of grippers, which are also called
;;;; opening-gripper and closing-gripper, gripping, moving-gripper-joint.
;;;; Actions: picking-up, placing, parking-arms, opening and closing of containers; and the atomic
;;;; ones of CRAM's pick-and-place plans: reaching, grasping, lifting, putting, retracting, pulling,
;;;; pushing, gripping, releasing, setting-gripper, opening and closing of grippers.

(in-package #:discrepancy-finder.projection)

(defmacro define-module (class type (projection designator) &body body)
  "Define how designators of CLASS and TYPE, keywords, are executed."
  `(defmethod execute-designator ((,projection projection) (class (eql ,class))
                                  (type (eql ,type)) ,designator)
     ,@body))

;;; Arms

(defun watch-of (designator)
  "Return what is watched in CRAM's :collision-mode of DESIGNATOR."
  (let ((mode (plan:desig-prop-value designator :collision-mode)))
    (case mode
      ((nil :avoid-all) :all)
      ((:allow-hand :allow-fingers :allow-arm :allow-attached) :allow-hand)
      (:allow-all :allow-all)
      (t (misunderstood designator "a collision-mode is avoid-all, allow-hand, allow-fingers, ~
                                    allow-arm, allow-attached or allow-all")))))

(defun tool-goals (projection designator keys)
  "Return a list of (arm . pose) for what KEYS, of the left and of the right arm, have in
DESIGNATOR."
  (loop for key in keys
        for name in '(:left :right)
        for value = (plan:desig-prop-value designator key)
        for pose = (and value (pose-meant value))
        when value
          collect (cons (or (find-arm projection name)
                            (misunderstood designator
                                           (format nil "the robot has no ~(~a~) arm" name)))
                        (or pose
                            (misunderstood designator
                                           (format nil "~(~s~) is no pose" key))))))

(defun tools-configuration (projection goals)
  "Return positions with the tools of the arms in GOALS, a list of (arm . pose), at their poses, as
near as possible to the present ones.  Signals MANIPULATION-POSE-UNREACHABLE."
  (dolist (height (or (torso-heights projection (car (first goals))) '(nil))
                  (fail-to-reach :unreachable (mapcar #'car goals) "the pose"))
    (let* ((arm (car (first goals)))
           (positions (copy-seq (joint-positions (projection-robot projection)))))
      (when height (setf (aref positions (arm-torso arm)) height))
      (when (loop for (arm . pose) in goals
                  for next = (first (solve projection arm pose positions :restarts 8))
                  always next do (setf positions next))
        (return positions)))))

(defun move-tools (projection goals &key (watch :all))
  "Move the tools of the arms in GOALS, a list of (arm . pose), to their poses, at once."
  (when goals
    (follow projection (car (first goals)) (list (tools-configuration projection goals))
            :watch watch)))

(define-module :motion :moving-tcp (projection designator)
  (let ((goals (tool-goals projection designator '(:left-target :right-target))))
    (unless goals
      (misunderstood designator "a motion of type moving-tcp needs a left-target or right-target"))
    (move-tools projection goals
                :watch (watch-of designator))))

(define-module :motion :moving-arm-joints (projection designator)
  (let* ((present (joint-positions (projection-robot projection)))
         (positions (copy-seq present))
         (arms (loop for key in '(:left-configuration :right-configuration)
                     for name in '(:left :right)
                     for values = (plan:desig-prop-value designator key)
                     for arm = (and values (find-arm projection name))
                     when values
                       collect (progn (set-arm-joints projection designator arm values positions)
                                      arm))))
    (unless arms
      (misunderstood designator "a motion of type moving-arm-joints needs a configuration"))
    (follow projection (first arms) (list positions))))

(defun set-arm-joints (projection designator arm values positions)
  "Set the joints of ARM in POSITIONS to VALUES, a list of numbers or of (name number), of
DESIGNATOR."
  (let ((numbers (loop for value in (alexandria:ensure-list values)
                       collect (if (consp value) (first (last value)) value))))
    (unless (and arm (= (length numbers) (length (arm-joints arm))) (every #'realp numbers))
      (misunderstood designator "a configuration is a number for each joint of an arm"))
    (loop for joint in (arm-joints arm)
          for number in numbers
          for urdf-joint = (link-frame-joint (svref (robot-frames (projection-robot projection))
                                                    joint))
          do (unless (within-limits-p urdf-joint (decimal-double number))
               (plan:fail 'plan:manipulation-pose-unreachable
                          :description (format nil "~a cannot be at ~,3f"
                                               (urdf-joint-name urdf-joint) number)))
             (setf (aref positions joint) (decimal-double number)))))

;;; Grippers

(define-module :motion :opening (projection designator)
  (open-grippers projection designator))

(define-module :motion :closing (projection designator)
  (close-grippers projection designator))

(define-module :motion :opening-gripper (projection designator)
  (open-grippers projection designator))

(define-module :motion :closing-gripper (projection designator)
  (close-grippers projection designator))

(define-module :motion :gripping (projection designator)
  (grip-with-effort projection designator))

(define-module :motion :moving-gripper-joint (projection designator)
  (set-gripper projection designator :joint-angle))

(define-module :action :gripping (projection designator)
  (grip-with-effort projection designator))

(define-module :action :releasing (projection designator)
  (open-grippers projection designator))

(define-module :action :opening-gripper (projection designator)
  (open-grippers projection designator))

(define-module :action :closing-gripper (projection designator)
  (close-grippers projection designator))

(define-module :action :setting-gripper (projection designator)
  (set-gripper projection designator :position))

(define-module :action :opening (projection designator)
  (if (plan:desig-prop-value designator :object)
      (move-container projection designator 1)
      (open-grippers projection designator)))

(define-module :action :closing (projection designator)
  (if (plan:desig-prop-value designator :object)
      (move-container projection designator -1)
      (close-grippers projection designator)))

;;; Sequences of poses

(defun pose-list (value)
  (if (listp value)
      (if (plan:designated-pose value) (list value) value)
      (list value)))

(defun move-through-poses (projection designator watch)
  "Move the tools through the poses that DESIGNATOR has for the left and for the right arm."
  (forget-lost-grasps projection)
  (let ((left (pose-list (plan:desig-prop-value designator :left-poses)))
        (right (pose-list (plan:desig-prop-value designator :right-poses))))
    (unless (or left right)
      (misunderstood designator "left-poses or right-poses are missing"))
    (loop while (or left right)
          do (move-tools projection
                         (loop for (name . value) in (list (cons :left (pop left))
                                                           (cons :right (pop right)))
                               when value
                                 collect (cons (or (find-arm projection name)
                                                   (misunderstood designator
                                                                  "the robot has no such arm"))
                                               (or (pose-meant value)
                                                   (misunderstood designator
                                                                  "that is no pose"))))
                         :watch watch))))

(define-module :action :reaching (projection designator)
  (move-through-poses projection designator :all))

(define-module :action :retracting (projection designator)
  (move-through-poses projection designator :allow-hand))

(define-module :action :lifting (projection designator)
  (move-through-poses projection designator :allow-hand))

(define-module :action :grasping (projection designator)
  (move-through-poses projection designator :allow-all))

(define-module :action :putting (projection designator)
  (move-through-poses projection designator :allow-all))

(define-module :action :pulling (projection designator)
  (move-through-poses projection designator :allow-all))

(define-module :action :pushing (projection designator)
  (move-through-poses projection designator :allow-all))

;;; Whole tasks

(defun column-arm-p (projection)
  (role-name (projection-robot projection) :lift))

(define-module :action :picking-up (projection designator)
  (if (column-arm-p projection)
      (pick-up-by-column projection designator)
      (pick-up projection designator)))

(define-module :action :placing (projection designator)
  (if (column-arm-p projection)
      (place-by-column projection designator)
      (place projection designator)))

(define-module :action :parking-arms (projection designator)
  (park-arms projection designator))
