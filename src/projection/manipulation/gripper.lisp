;;;; Grippers: motions of type opening, closing, gripping and moving-gripper-joint.
;;;;
;;;; Closing fingers stop where they touch something.  What rays from pad to pad meet is gripped: an
;;;; item is then held as two soft fingers hold it, by a force of 2 mu N and a torque of 2 mu N r
;;;; about the closing axis (BULLET:ATTACH), and is lost as soon as it bears more; a fixture is just
;;;; held on to.  The hand and what it holds do not push each other meanwhile.

(in-package #:discrepancy-finder.projection)

(defun gripper-limits (projection arm)
  "Return the closed and the open position (m or rad) of the gripper of ARM."
  (let ((joint (link-frame-joint (svref (robot-frames (projection-robot projection))
                                        (arm-gripper arm)))))
    (values (urdf-joint-lower joint) (urdf-joint-upper joint))))

(defun gripper-position (projection arm)
  (aref (joint-positions (projection-robot projection)) (arm-gripper arm)))

(defun gripper-joint-name (projection arm)
  (urdf-joint-name (link-frame-joint (svref (robot-frames (projection-robot projection))
                                            (arm-gripper arm)))))

(defun move-gripper (projection arm position)
  "Move the gripper of ARM to POSITION (m or rad), whatever is in the way.  Return POSITION."
  (unless (< (abs (- position (gripper-position projection arm))) 1d-9)
    (run-joints projection (list (cons (gripper-joint-name projection arm) position))
                :speed (projection-parameter projection :gripper-speed) :watch :none))
  position)

;;; Holding

(defun hand-bodies-of (projection arm)
  (arm-bodies projection (arm-hand-links arm)))

(defun let-pass (projection arm item flag)
  "Let the hand of ARM and the body ITEM pass through each other, or not if FLAG is NIL."
  (dolist (body (hand-bodies-of projection arm))
    (bullet:ignore-collision body item flag)))

(defun forget-lost-grasps (projection)
  "Let go of what has slipped out of the hands of PROJECTION's robot."
  (loop for (name item . attachment) in (copy-list (projection-grasps projection))
        do (unless (bullet:attachment-live-p attachment)
             (let-pass projection (find-arm projection name) (item-body projection item) nil)
             (release-grasp projection name))))

(defun palm-body (projection arm)
  "Return the body of the link that the tool of ARM is part of."
  (let ((robot (projection-robot projection)))
    (loop for number = (arm-tool arm)
            then (link-frame-parent (svref (robot-frames robot) number))
          thereis (svref (robot-bodies robot) number))))

(defun hold (projection arm item effort)
  "Attach the item named ITEM to the hand of ARM by the force EFFORT (N) of each finger."
  (let* ((palm (palm-body projection arm))
         (body (item-body projection item))
         (tool (tool-pose projection arm))
         (capacity (* 2 (projection-parameter projection :finger-friction) effort)))
    (let-pass projection arm body t)
    ;; Where the tool is in the item's frame is not known from an earlier grasp.
    (setf (getf (projection-memory projection) (arm-name arm)) nil)
    (note-grasp projection (arm-name arm) item
                (bullet:attach palm body
                               :point (compose (inverse (bullet:body-pose body)) tool)
                               :axis (turned (compose (inverse (bullet:body-pose palm)) tool)
                                             '(0d0 1d0 0d0))
                               :capacity capacity
                               :torsion-radius (projection-parameter projection :pad-radius)))
    (plan:on-event (make-instance 'plan:object-attached :object-name item
                                                        :arm (arm-name arm)))
    item))

(defun let-go (projection arm)
  "Let go of what ARM holds; return its name, or NIL if it holds nothing."
  (let* ((held (held-item projection (arm-name arm))))
    (release-grasp projection (arm-name arm))
    (when held
      (plan:on-event (make-instance 'plan:object-detached :object-name held
                                                          :arm (arm-name arm))))
    held))

;;; Closing

(defun closing-position (projection arm)
  "Return the position at which the closing fingers of ARM touch something, or where they are
closed."
  (let* ((robot (projection-robot projection))
         (fingers (arm-bodies projection (arm-fingers arm)))
         (others (append (mapcar #'cdr (projection-items projection))
                         (projection-fixtures projection)))
         (positions (copy-seq (joint-positions robot))))
    (flet ((touch-p (position)
             (setf (aref positions (arm-gripper arm)) position)
             (<= (bullet:mechanism-clearance (robot-mechanism robot) (base-pose robot) positions
                                             fingers others 1d-2)
                 0)))
      (multiple-value-bind (closed) (gripper-limits projection arm)
        (if (not (touch-p closed))
            closed
            (loop with touching = closed and free = (gripper-position projection arm)
                  repeat 16
                  do (let ((middle (/ (+ touching free) 2)))
                       (if (touch-p middle)
                           (setf touching middle)
                           (setf free middle)))
                  finally (return free)))))))

(defun between-pads (projection arm)
  "Return the body that most of the rays between the pads of ARM's hand meet, or NIL."
  (let* ((robot (projection-robot projection))
         (hits (bullet:cast-rays (projection-world projection)
                                 (pad-rays (hand-of projection arm) (tool-pose projection arm))
                                 :passed (link-bodies robot)))
         (best nil) (most 0))
    (loop for body in (remove-duplicates (remove nil (coerce hits 'list)) :from-end t)
          for count = (count body hits)
          do (when (> count most) (setf best body most count)))
    best))

(defun grip (projection arm &optional effort)
  "Close the gripper of ARM with EFFORT (N of each finger).  Return the name of the item that it
holds then, or the body of the fixture.  Signals GRIPPER-CLOSED-COMPLETELY if there is nothing
between the pads, GRIPPER-GOAL-NOT-REACHED if it holds something already."
  (forget-lost-grasps projection)
  (when (held-item projection (arm-name arm))
    (plan:fail 'plan:gripper-goal-not-reached
               :action :gripping
               :description (format nil "the ~(~a~) gripper holds the ~(~a~)" (arm-name arm)
                                    (held-item projection (arm-name arm)))))
  (let* ((body (between-pads projection arm))
         (item (car (rassoc body (projection-items projection)))))
    (move-gripper projection arm (if body
                                     (closing-position projection arm)
                                     (gripper-limits projection arm)))
    (cond ((null body)
           (plan:fail 'plan:gripper-closed-completely
                      :action :gripping
                      :description (format nil "there is nothing between the fingers of the ~(~a~) ~
                                                arm" (arm-name arm))))
          (item (hold projection arm item
                      (or effort (projection-parameter projection :grip-force))))
          (t body))))

(defun open-gripper (projection arm)
  "Let go of what ARM holds, and open its gripper.  Return the name of what was let go, or NIL."
  (forget-lost-grasps projection)
  (let ((held (let-go projection arm)))
    (move-gripper projection arm (nth-value 1 (gripper-limits projection arm)))
    (when held (let-pass projection arm (item-body projection held) nil))
    held))

;;; The process modules

(defun designated-arms (projection designator key)
  "Return the arms that the value of KEY in DESIGNATOR, a name or a list of names, means; all of
them if it is NIL."
  (let ((names (alexandria:ensure-list (plan:desig-prop-value designator key))))
    (if names
        (loop for name in names
              collect (or (and (symbolp name) (find-arm projection (source:name-keyword name)))
                          (misunderstood designator
                                         (format nil "the robot has no arm ~(~a~)" name))))
        (robot-arms (projection-robot projection)))))

(defun set-gripper (projection designator key)
  "Move the grippers of DESIGNATOR to the position that KEY gives."
  (let ((position (plan:desig-prop-value designator key)))
    (unless (realp position)
      (misunderstood designator (format nil "the position of a gripper, a number ~(~s~), is missing"
                                        key)))
    (dolist (arm (designated-arms projection designator :gripper))
      (multiple-value-bind (closed open) (gripper-limits projection arm)
        (let ((position (decimal-double position)))
          (unless (<= closed position open)
            (plan:fail 'plan:gripper-goal-not-reached
                       :action :moving-gripper-joint
                       :description (format nil "the gripper opens from ~,3f to ~,3f, not to ~,3f"
                                            closed open position)))
          (if (> position (gripper-position projection arm))
              (let ((held (let-go projection arm)))
                (move-gripper projection arm position)
                (when held (let-pass projection arm (item-body projection held) nil)))
              (let ((reached (if (held-item projection (arm-name arm))
                                 (gripper-position projection arm)
                                 (max position (closing-position projection arm)))))
                (move-gripper projection arm reached)
                (when (> reached (+ position 1d-3))
                  (plan:fail 'plan:gripper-goal-not-reached
                             :action :moving-gripper-joint
                             :description "there is something between the fingers")))))))))

(defun open-grippers (projection designator)
  (let ((held (loop for arm in (designated-arms projection designator :gripper)
                    for item = (open-gripper projection arm)
                    when item collect item)))
    (when held (settle projection))
    held))

(defun close-grippers (projection designator)
  (dolist (arm (designated-arms projection designator :gripper))
    (unless (held-item projection (arm-name arm))
      (move-gripper projection arm (closing-position projection arm)))))

(defun wanted-effort (designator)
  "Return the :effort (N) of DESIGNATOR, or NIL if it has none."
  (let ((effort (plan:desig-prop-value designator :effort)))
    (unless (or (null effort) (and (realp effort) (plusp effort)))
      (misunderstood designator "the effort of a gripper is a force in N"))
    (and effort (decimal-double effort))))

(defun grip-with-effort (projection designator)
  "Close the grippers of DESIGNATOR; return what the first of them holds."
  (let ((effort (wanted-effort designator)))
    (first (loop for arm in (designated-arms projection designator :gripper)
                 collect (grip projection arm effort)))))
