;;;; Joints: what a <joint> element says.
;;;;
;;;; Joints are fixed, prismatic, revolute or continuous; planar and floating ones are refused.
;;;; Axes are normalized; without one, a joint moves along or about x.  Prismatic and revolute
;;;; joints need limits; a missing lower or upper one is 0, as URDF has it.  A joint that follows
;;;; another which itself follows a third is made to follow the third.

(in-package #:discrepancy-finder.projection)

(defstruct (urdf-joint (:copier %copy-joint))
  "A joint between the links PARENT and CHILD; TYPE is :fixed, :prismatic, :revolute or
:continuous, LOWER and UPPER are in m or rad, NIL where unlimited.  EFFORT (N or N m) and VELOCITY
are limits, too, NIL where not given.  DAMPING is in N s/m or N m s/rad, FRICTION in N or N m.  A
joint that follows another has a MIMIC (name multiplier offset)."
  (name "" :type string :read-only t)
  (type :fixed :type keyword :read-only t)
  (parent "" :type string :read-only t)
  (child "" :type string :read-only t)
  (origin nil :type pose :read-only t)
  (axis '(1d0 0d0 0d0) :type list :read-only t)
  (lower nil :type (or null double-float) :read-only t)
  (upper nil :type (or null double-float) :read-only t)
  (effort nil :type (or null double-float) :read-only t)
  (velocity nil :type (or null double-float) :read-only t)
  (damping 0d0 :type double-float :read-only t)
  (friction 0d0 :type double-float :read-only t)
  (mimic nil :type list)
  (line nil :type (or null integer) :read-only t))

(defmethod print-object ((joint urdf-joint) stream)
  (print-unreadable-object (joint stream :type t)
    (format stream "~a, ~(~a~), ~a -> ~a" (urdf-joint-name joint) (urdf-joint-type joint)
            (urdf-joint-parent joint) (urdf-joint-child joint))))

(defun within-limits-p (joint position)
  "Return true if POSITION (m or rad) is within the limits of JOINT."
  (<= (or (urdf-joint-lower joint) position) position (or (urdf-joint-upper joint) position)))

(defparameter *joint-types*
  '(("fixed" . :fixed) ("prismatic" . :prismatic) ("revolute" . :revolute)
    ("continuous" . :continuous)))

(defun joint-type (element)
  (let ((name (name-attribute element "type")))
    (or (cdr (assoc name *joint-types* :test #'string=))
        (urdf-problem element "the type ~a is not supported; ~{~a~^, ~} are" name
                      (mapcar #'car *joint-types*)))))

(defun joint-link (element role)
  "Return the name of the link that is the ROLE, parent or child, of the joint ELEMENT."
  (let ((node (or (child element role) (urdf-problem element "it has no ~a" role))))
    (name-attribute node "link")))

(defun joint-axis (element)
  "Return the unit vector of the <axis> of the joint ELEMENT."
  (let* ((node (child element "axis"))
         (numbers (if node
                      (numbers-in (attribute node "xyz" "1 0 0") 3 node)
                      '(1d0 0d0 0d0)))
         (largest (reduce #'max (mapcar #'abs numbers))))
    (when (zerop largest)
      (urdf-problem node "its axis has no direction"))
    (unless (< 1d-9 largest 1d9)
      (urdf-problem node "its axis is ~{~a~^ ~}; it should have the length 1" numbers))
    (let ((norm (sqrt (reduce #'+ (mapcar #'* numbers numbers)))))
      (mapcar (lambda (number) (/ number norm)) numbers))))

(defun joint-limits (element type)
  "Return lower and upper limit, effort and velocity of the joint ELEMENT of TYPE, each or NIL."
  (let ((limit (child element "limit")))
    (when (and (member type '(:prismatic :revolute)) (null limit))
      (urdf-problem element "a ~(~a~) joint needs a limit" type))
    (flet ((bound (name)
             (and limit (member type '(:prismatic :revolute))
                  (number-attribute limit name 0d0)))
           (greatest (name)
             (and limit (attribute limit name) (natural-attribute limit name))))
      (let ((lower (bound "lower")) (upper (bound "upper")))
        (dolist (bound (list lower upper))
          (when (and bound (> (abs bound) 1d6))
            (urdf-problem limit "the limit ~a is too far" bound)))
        (when (and lower (> lower upper))
          (urdf-problem limit "its lower limit is above the upper one"))
        (values lower upper (greatest "effort") (greatest "velocity"))))))

(defun joint-mimic (element)
  "Return (name multiplier offset) if the joint ELEMENT follows another, or NIL."
  (let ((mimic (child element "mimic")))
    (and mimic
         (list (name-attribute mimic "joint") (number-attribute mimic "multiplier" 1d0)
               (number-attribute mimic "offset" 0d0)))))

(defun parse-joint (element)
  "Return the URDF-JOINT that ELEMENT describes."
  (let* ((*model-part* "a joint")
         (name (name-attribute element "name"))
         (*model-part* (format nil "joint ~a" name))
         (type (joint-type element))
         (dynamics (child element "dynamics")))
    (multiple-value-bind (lower upper effort velocity) (joint-limits element type)
      (make-urdf-joint
       :name name :type type :line (xml-element-line element)
       :parent (joint-link element "parent") :child (joint-link element "child")
       :origin (origin-of element)
       :axis (if (eq type :fixed) '(1d0 0d0 0d0) (joint-axis element))
       :lower lower :upper upper :effort effort :velocity velocity
       :damping (if dynamics (natural-attribute dynamics "damping") 0d0)
       :friction (if dynamics (natural-attribute dynamics "friction") 0d0)
       ;; A fixed joint has nothing to follow with, whatever TALOS's file says.
       :mimic (unless (eq type :fixed) (joint-mimic element))))))

;;; Joints that follow others

(defun joint-problem (joint control &rest arguments)
  (let ((*model-part* (format nil "joint ~a" (urdf-joint-name joint))))
    (apply #'urdf-problem (urdf-joint-line joint) control arguments)))

(defun resolve-mimic (joint table)
  "Make JOINT follow a joint that follows none; TABLE has the joints by name."
  (let ((seen (list joint)) (multiplier 1d0) (offset 0d0) (leader joint))
    (loop for (name factor shift) = (urdf-joint-mimic leader)
          while name
          do (setf offset (+ offset (* multiplier shift))
                   multiplier (* multiplier factor)
                   leader (or (gethash name table)
                              (joint-problem joint "it follows the joint ~a, which does not exist"
                                             name)))
             (when (member leader seen)
               (joint-problem joint (if (eq leader joint)
                                        "it follows itself"
                                        "it follows joints that follow each other")))
             (push leader seen))
    (unless (eq leader joint)
      (when (eq (urdf-joint-type leader) :fixed)
        (joint-problem joint "it follows the joint ~a, which is fixed" (urdf-joint-name leader)))
      (list (urdf-joint-name leader) multiplier offset))))

(defun resolved-joints (joints)
  "Return JOINTS with each mimic naming a joint that follows none."
  (let ((table (make-hash-table :test 'equal)))
    (dolist (joint joints)
      (setf (gethash (urdf-joint-name joint) table) joint))
    (loop for joint in joints
          for mimic = (resolve-mimic joint table)
          collect (if mimic
                      (let ((copy (%copy-joint joint)))
                        (setf (urdf-joint-mimic copy) mimic)
                        copy)
                      joint))))
