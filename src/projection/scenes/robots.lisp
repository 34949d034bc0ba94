;;;; What the joints and links of a robot are for.
;;;;
;;;; A robot's clause in a scene file names them, in one of two ways.  An arm that a carriage lifts,
;;;; a shoulder turns and a telescope extends:
;;;;   (:lift JOINT) (:shoulder JOINT) (:extension JOINT) (:gripper LINK)
;;;; or a torso and any number of arms, each a chain of joints that ends in the link TOOL:
;;;;   [(:torso JOINT)]
;;;;   (:arm NAME (:joints JOINT*) (:tool LINK) (:gripper JOINT) (:fingers LINK LINK)
;;;;         [(:parked position*)])         without :parked, the positions nearest to 0
;;;; and with both:
;;;;   [(:camera LINK)]           looks along the x axis of its link, with z upwards
;;;;   [(:head JOINT JOINT)]      pan and tilt, which turn the camera
;;;; The tool link's x axis is the direction of approach, its y axis that in which the fingers
;;;; close, its origin is between their pads.

(in-package #:discrepancy-finder.projection)

(defstruct (arm-roles (:copier nil))
  "An arm: the names of its JOINTS from the body outwards, of the link TOOL, of the joint GRIPPER
and of the links FINGERS; PARKED are the joints' positions (m or rad) when the arm is out of the way."
  (name nil :type keyword :read-only t)
  (joints '() :type list :read-only t)
  (tool "" :type string :read-only t)
  (gripper "" :type string :read-only t)
  (fingers '() :type list :read-only t)
  (parked '() :type list :read-only t))

(defmethod print-object ((arm arm-roles) stream)
  (print-unreadable-object (arm stream :type t)
    (format stream "~(~a~), ~d joint~:p" (arm-roles-name arm) (length (arm-roles-joints arm)))))

(defparameter *column-roles* '(:lift :shoulder :extension :gripper)
  "The roles of a robot with a telescopic arm on a column.")

(defun part-arm (part name)
  "Return the ARM-ROLES of the arm NAME, a symbol, of PART, a robot, or NIL."
  (find (source:name-keyword name) (scene-part-arms part) :key #'arm-roles-name))

(defun scene-arm-names (scene)
  "Return the list of the names (keywords) of the arms of SCENE's robot."
  (and (scene-robot scene) (mapcar #'arm-roles-name (scene-part-arms (scene-robot scene)))))

(defun role-problem (role name model)
  "Return what is wrong with NAME in the ROLE of a robot with MODEL, or NIL."
  (let ((joint (find-urdf-joint model name))
        (link (find-urdf-link model name)))
    (flet ((joint-problem (&rest types)
             (cond ((null joint) "no such joint")
                   ((not (member (urdf-joint-type joint) types))
                    (format nil "a joint that is not ~{~(~a~)~^ or ~}"
                            (remove :continuous types)))
                   ((urdf-joint-mimic joint) "a joint that only follows another"))))
      (ecase role
        ((:camera :tool) (unless link "no such link"))
        ((:gripper :fingers) (cond ((null link) "no such link")
                                   ((null (urdf-link-shape link)) "a link without a shape")))
        ((:lift :extension :torso) (joint-problem :prismatic))
        ((:shoulder :pan :tilt) (joint-problem :revolute :continuous))
        ((:joints :gripper-joint) (joint-problem :prismatic :revolute :continuous))))))

(defun check-role (role name model form file &optional (label role))
  (let ((problem (role-problem role name model)))
    (when problem
      (scene-problem file form "~(~s~) ~s: ~a has ~a" label name (urdf-model-file model)
                     problem))))

(defun joint-turns-p (model joint-name link-name)
  "Return true if the joint JOINT-NAME of MODEL is on the way from the root to the link LINK-NAME."
  (and (find joint-name (joints-to model link-name) :key #'urdf-joint-name :test #'equal) t))

;;; Head

(defun head-roles (clause model file)
  "Return the roles of the head and the camera that the robot's CLAUSE names, a property list."
  (let ((head (find-option (clause-options clause) :head))
        (camera (find-option (clause-options clause) :camera)))
    (when (and head (not (and camera (= (length head) 3))))
      (scene-problem file clause "(:head pan-joint tilt-joint) with a (:camera link) was expected"))
    (when camera
      (check-role :camera (second camera) model clause file))
    (append (and camera (list :camera (second camera)))
            (loop for role in '(:pan :tilt)
                  for name in (rest head)
                  do (check-role role name model clause file)
                     (unless (joint-turns-p model name (second camera))
                       (scene-problem file clause "the joint ~s of the head does not turn the ~
                                                   camera ~s" name (second camera)))
                  collect role collect name))))

;;; Arms

(defun nearest-to-zero (joint)
  "Return the position of JOINT that is nearest to 0 within its limits."
  (max (or (urdf-joint-lower joint) 0d0) (min 0d0 (or (urdf-joint-upper joint) 0d0))))

(defun parked-positions (option joints form file)
  "Return the positions of JOINTS that OPTION, a list (:parked position*) or NIL, gives."
  (cond ((null option) (mapcar #'nearest-to-zero joints))
        ((not (and (= (length (rest option)) (length joints)) (every #'realp (rest option))))
         (scene-problem file option "~d numbers were expected in :parked, one for each joint"
                        (length joints)))
        (t (loop for joint in joints
                 for position in (rest option)
                 do (unless (and (< -1000 position 1000)
                                 (within-limits-p joint (decimal-double position)))
                      (scene-problem file form "the joint ~a cannot be parked at ~a, which is ~
                                                beyond its limits" (urdf-joint-name joint)
                                     position))
                 collect (decimal-double position)))))

(defun check-chain (joints tool model form file)
  "Signal SCENE-ERROR unless the names JOINTS are those of joints of MODEL on the way to the link
TOOL, in this order."
  (let ((way (mapcar #'urdf-joint-name (joints-to model tool))))
    (dolist (name joints)
      (check-role :joints name model form file)
      (unless (member name way :test #'string=)
        (scene-problem file form "the joint ~s does not move the tool ~s" name tool)))
    (unless (equal joints (remove-if-not (lambda (name) (member name joints :test #'string=))
                                         way))
      (scene-problem file form "the joints of the arm are not named from the body outwards, each ~
                                once"))))

(defun parse-arm (option model file)
  "Return the ARM-ROLES that OPTION of a robot's clause describes."
  (destructuring-bind (&optional name &rest options) (rest option)
    (unless (parameter-name-p name)
      (scene-problem file option "(:arm name option*) was expected"))
    (check-options option options '(:joints :tool :gripper :fingers :parked) file)
    (flet ((strings (key &optional count)
             (let ((values (rest (find-option options key))))
               (unless (and values (every #'stringp values)
                            (or (null count) (= count (length values))))
                 (scene-problem file option ":arm ~(~a~) needs (~(~s~) ~:[name ...~;~
                                             ~:*~{~a~^ ~}~])" name key
                                (and count (loop repeat count collect "name"))))
               values)))
      (let ((joints (strings :joints))
            (tool (first (strings :tool 1)))
            (gripper (first (strings :gripper 1)))
            (fingers (strings :fingers 2)))
        (check-role :tool tool model option file)
        (check-chain joints tool model option file)
        (check-role :gripper-joint gripper model option file :gripper)
        (dolist (finger fingers)
          (check-role :fingers finger model option file))
        (make-arm-roles
         :name (source:name-keyword name) :joints joints :tool tool :gripper gripper
         :fingers fingers
         :parked (parked-positions (find-option options :parked)
                                   (loop for name in joints collect (find-urdf-joint model name))
                                   option file))))))

;;; The whole

(defparameter *robot-options*
  (append '(:at :torso :arm :head :camera :material) *column-roles*)
  "The options that a robot's clause can have.")

(defun robot-roles (clause model file)
  "Return the roles that the robot's CLAUSE gives, a property list, and the list of its ARM-ROLES."
  (let* ((options (clause-options clause))
         (column (some (lambda (role) (find-option options role)) *column-roles*))
         (torso (find-option options :torso))
         (arms (remove :arm options :key #'first :test-not #'eq)))
    (when (and column (or torso arms))
      (scene-problem file clause "a robot has either~{ ~(~s~)~^,~} or :torso and :arm"
                     *column-roles*))
    (when torso
      (check-role :torso (second torso) model torso file))
    (values (append (and column
                         (loop for role in *column-roles*
                               for name = (first (option-value clause role file))
                               do (check-role role name model clause file)
                               collect role collect name))
                    (and torso (list :torso (second torso)))
                    (head-roles clause model file))
            (prog1 (mapcar (lambda (option) (parse-arm option model file)) arms)
              (check-distinct arms "arms" file :key #'second)))))
