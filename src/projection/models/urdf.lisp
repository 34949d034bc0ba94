;;;; URDF: links, joints and collision shapes of a robot, a fixture or an item.
;;;;
;;;; READ-URDF returns a model: links in order, each with the shape of its collision elements in the
;;;; notation of the bullet layer and its mass; joints with origin, axis and limits.  Supported are
;;;; boxes, cylinders and spheres, and fixed, prismatic, revolute and continuous joints; anything
;;;; else is refused by name.  Angles are fixed-axis roll, pitch, yaw; boxes have full extents.

(in-package #:discrepancy-finder.projection)

(defstruct (urdf-link (:copier nil))
  "A link: its name, the SHAPE of its collision elements in the link's frame (NIL if it has none),
its MASS (kg, 0 if not given), its INERTIA, three principal moments (kg m^2, NIL if not given) about
the axes of the frame at INERTIAL-POSE, the VISUAL-COLOR (r g b a), each 0 to 1, or NIL."
  (name "" :type string :read-only t)
  (shape nil :type list :read-only t)
  (mass 0d0 :type double-float :read-only t)
  (inertia nil :type list :read-only t)
  (inertial-pose nil :type (or null pose) :read-only t)
  (visual-color nil :type list :read-only t)
  (line nil :type (or null integer) :read-only t))

(defstruct (urdf-joint (:copier nil))
  "A joint between the links PARENT and CHILD; TYPE is :fixed, :prismatic, :revolute or
:continuous, LOWER and UPPER are in m or rad, NIL where unlimited.  EFFORT (N or N m) and VELOCITY
are limits, too.  DAMPING is in N s/m or N m s/rad, FRICTION in N or N m.  A joint that follows
another has a MIMIC (name multiplier offset)."
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
  (mimic nil :type list :read-only t)
  (line nil :type (or null integer) :read-only t))

(defstruct (urdf-model (:copier nil))
  "A tree of links; JOINTS come after the joint of their parent link."
  (name "" :type string :read-only t)
  (file "" :type string :read-only t)
  (root "" :type string :read-only t)
  (links '() :type list :read-only t)
  (joints '() :type list :read-only t))

(setf (documentation 'urdf-model-name 'function)
      "Return the name of a URDF model, a string.")

(defmethod print-object ((model urdf-model) stream)
  (print-unreadable-object (model stream :type t)
    (format stream "~a: ~d link~:p, ~d joint~:p" (urdf-model-name model)
            (length (urdf-model-links model)) (length (urdf-model-joints model)))))

(defun find-urdf-link (model name)
  "Return the link of MODEL that has NAME, or NIL."
  (find name (urdf-model-links model) :key #'urdf-link-name :test #'equal))

(defun find-urdf-joint (model name)
  "Return the joint of MODEL that has NAME, or NIL."
  (find name (urdf-model-joints model) :key #'urdf-joint-name :test #'equal))

(defun joint-above (model link-name)
  "Return the joint of MODEL whose child is the link LINK-NAME, or NIL if that is the root."
  (find link-name (urdf-model-joints model) :key #'urdf-joint-child :test #'equal))

(defun joints-to (model link-name)
  "Return the joints of MODEL on the way from the root to the link LINK-NAME, in this order."
  (let ((way '()))
    (loop for joint = (joint-above model link-name)
          while joint
          do (push joint way)
             (setf link-name (urdf-joint-parent joint)))
    way))

(defun within-limits-p (joint position)
  "Return true if POSITION (m or rad) is within the limits of JOINT."
  (<= (or (urdf-joint-lower joint) position) position (or (urdf-joint-upper joint) position)))

(define-condition urdf-fault (error)
  ((element :initarg :element :reader urdf-fault-element)
   (reason :initarg :reason :reader urdf-fault-reason))
  (:documentation "Signaled within a file; READ-URDF, which knows its name, makes it URDF-ERROR."))

(defun urdf-problem (element control &rest arguments)
  (error 'urdf-fault :element element :reason (apply #'format nil control arguments)))

(defun attribute (node name &optional default)
  (let ((entry (find name (xmls:node-attrs node) :key #'first :test #'string=)))
    (if entry (second entry) default)))

(defun required-attribute (node name element)
  (or (attribute node name)
      (urdf-problem element "<~a> has no attribute ~a" (xmls:node-name node) name)))

(defun children (node name)
  (remove-if-not (lambda (child) (and (xmls:node-p child) (string= (xmls:node-name child) name)))
                 (xmls:node-children node)))

(defun child (node name)
  (first (children node name)))

(defun number-in (text element)
  "Return the decimal number written in TEXT as a double float."
  (let ((*read-eval* nil) (*read-default-float-format* 'double-float))
    (let ((value (and (plusp (length text))
                      (every (lambda (character) (find character "+-.0123456789eE")) text)
                      (ignore-errors (read-from-string text)))))
      (if (realp value)
          (float value 1d0)
          (urdf-problem element "~s is no number" text)))))

(defun numbers-in (text count element)
  (let ((numbers (loop for word in (uiop:split-string text :separator '(#\Space #\Newline #\Tab))
                       unless (string= word "") collect (number-in word element))))
    (unless (= (length numbers) count)
      (urdf-problem element "~s does not hold ~d numbers" text count))
    numbers))

(defun origin-of (node element)
  (let ((origin (child node "origin")))
    (if origin
        (destructuring-bind ((x y z) (roll pitch yaw))
            (list (numbers-in (attribute origin "xyz" "0 0 0") 3 element)
                  (numbers-in (attribute origin "rpy" "0 0 0") 3 element))
          (make-pose x y z :roll roll :pitch pitch :yaw yaw))
        (identity-pose))))

(defun positive (number element)
  (if (plusp number)
      number
      (urdf-problem element "a size of ~a" number)))

(defun geometry-shape (geometry element)
  (let* ((nodes (and geometry (remove-if-not #'xmls:node-p (xmls:node-children geometry))))
         (node (first nodes)))
    (when (rest nodes)
      (urdf-problem element "a geometry of several shapes"))
    (flet ((size (name)
             (positive (number-in (required-attribute node name element) element) element)))
      (cond ((null node) (urdf-problem element "a collision without geometry"))
            ((string= (xmls:node-name node) "box")
             (cons :box (loop for number in (numbers-in (required-attribute node "size" element)
                                                        3 element)
                              collect (positive number element))))
            ((string= (xmls:node-name node) "cylinder")
             (list :cylinder (size "radius") (size "length")))
            ((string= (xmls:node-name node) "sphere") (list :sphere (size "radius")))
            (t (urdf-problem element "the geometry <~a> is not supported; box, cylinder and sphere ~
                                      are" (xmls:node-name node)))))))

(defun link-shape (node element)
  "Return the shape of the collision elements of the link NODE, or NIL if there are none."
  (let ((parts (loop for collision in (children node "collision")
                     collect (list (origin-of collision element)
                                   (geometry-shape (child collision "geometry") element)))))
    (cond ((null parts) nil)
          ((and (null (rest parts)) (pose= (first (first parts)) (identity-pose)))
           (second (first parts)))
          (t (cons :compound parts)))))

(defun parse-link (node)
  (let* ((name (required-attribute node "name" "a link"))
         (element (format nil "link ~a" name))
         (inertial (child node "inertial"))
         (mass (and inertial (child inertial "mass"))))
    (when (and inertial (not (pose= (origin-of inertial element) (identity-pose))))
      (urdf-problem element "an inertial frame other than the link's is not supported"))
    (make-urdf-link :name name :shape (link-shape node element)
                    :mass (if mass
                              (number-in (required-attribute mass "value" element) element)
                              0d0))))

(defun parse-joint (node)
  (let* ((name (required-attribute node "name" "a joint"))
         (element (format nil "joint ~a" name))
         (type-name (required-attribute node "type" element))
         (type (cdr (assoc type-name '(("fixed" . :fixed) ("prismatic" . :prismatic)
                                       ("revolute" . :revolute) ("continuous" . :continuous))
                           :test #'string=)))
         (axis (child node "axis"))
         (limit (child node "limit")))
    (unless type
      (urdf-problem element "the type ~a is not supported; fixed, prismatic, revolute and ~
                             continuous are" type-name))
    (when (and (member type '(:prismatic :revolute)) (null limit))
      (urdf-problem element "a ~a joint needs a limit" type-name))
    (flet ((link (role)
             (required-attribute (or (child node role) (urdf-problem element "it has no ~a" role))
                                 "link" element))
           (bound (name)
             (and limit (not (eq type :continuous))
                  (number-in (attribute limit name "0") element))))
      (when (and (bound "lower") (> (bound "lower") (bound "upper")))
        (urdf-problem element "its lower limit is above the upper one"))
      (make-urdf-joint
       :name name :type type :parent (link "parent") :child (link "child")
       :origin (origin-of node element)
       :axis (let* ((numbers (if axis
                                 (numbers-in (attribute axis "xyz" "1 0 0") 3 element)
                                 '(1d0 0d0 0d0)))
                    (norm (sqrt (reduce #'+ (mapcar #'* numbers numbers)))))
               (when (zerop norm) (urdf-problem element "its axis has no direction"))
               (mapcar (lambda (number) (/ number norm)) numbers))
       :lower (bound "lower") :upper (bound "upper")))))

(defun order-joints (joints links)
  "Return the name of the root of LINKS, and JOINTS so that each comes after its parent link's."
  (let ((names (mapcar #'urdf-link-name links))
        (ordered '()))
    (dolist (joint joints)
      (dolist (name (list (urdf-joint-parent joint) (urdf-joint-child joint)))
        (unless (member name names :test #'string=)
          (urdf-problem (format nil "joint ~a" (urdf-joint-name joint))
                        "there is no link ~a" name))))
    (let ((roots (remove-if (lambda (name)
                              (find name joints :key #'urdf-joint-child :test #'string=))
                            names)))
      (unless (= (length roots) 1)
        (urdf-problem nil "the links do not form one tree"))
      (labels ((visit (link)
                 (dolist (joint joints)
                   (when (string= (urdf-joint-parent joint) link)
                     (push joint ordered)
                     (visit (urdf-joint-child joint))))))
        (visit (first roots)))
      (unless (= (length ordered) (1- (length links)) (length joints))
        (urdf-problem nil "the links do not form one tree"))
      (values (first roots) (nreverse ordered)))))

(defun parse-xml (text)
  (handler-case (xmls:parse text :quash-errors nil)
    (serious-condition () (urdf-problem nil "it is not well-formed XML"))))

(defun parse-urdf (text file)
  "Return the URDF-MODEL that TEXT, the content of FILE, describes."
  (let ((root (parse-xml text)))
    (unless (and (xmls:node-p root) (string= (xmls:node-name root) "robot"))
      (urdf-problem nil "its root element is not <robot>"))
    (let ((links (mapcar #'parse-link (children root "link")))
          (joints (mapcar #'parse-joint (children root "joint"))))
      (multiple-value-bind (root-link ordered) (order-joints joints links)
        (make-urdf-model :name (required-attribute root "name" "robot") :file file
                         :root root-link :links links :joints ordered)))))

(defun read-urdf (file)
  "Return the URDF-MODEL in FILE.  Signals URDF-ERROR, which names the file and the element, if the
file is missing, malformed, or uses what is not supported."
  (let ((name (source:native-name file)))
    (handler-case (parse-urdf (handler-case (uiop:read-file-string (source:native-path file)
                                                     :external-format :utf-8)
                                (file-error () (urdf-problem nil "no such file"))
                                (stream-error () (urdf-problem nil "it is not a UTF-8 text")))
                              name)
      (urdf-fault (fault)
        (error 'urdf-error :file name :element (urdf-fault-element fault)
                           :reason (urdf-fault-reason fault))))))
