;;;; Links: what a <link> element says.
;;;;
;;;; A link has the shapes of its <collision> elements, merged into one in the link's frame, in the
;;;; notation of the bullet layer; a mass and the principal axes of its inertia; and a colour, that
;;;; of its first <visual> that has one.  Missing mass or inertia stays missing: the mass is 0, the
;;;; inertia NIL, as it also is when all of its six numbers are 0.  Published robots have links
;;;; whose inertia no body can have; as the links of a robot are moved and not pushed, that is an
;;;; error only where CHECK-DYNAMIC is called, for items and fixtures.

(in-package #:discrepancy-finder.projection)

(defstruct (urdf-link (:copier nil))
  "A link: its name, the SHAPE of its collision elements in the link's frame (NIL if it has none),
its MASS (kg, 0 if not given), its INERTIA, three principal moments (kg m^2, NIL if not given) about
the axes of the frame at INERTIAL-POSE, the VISUAL-COLOR (r g b a), each 0 to 1, or NIL, and the
FAULT of its inertia, a URDF-ERROR, or NIL."
  (name "" :type string :read-only t)
  (shape nil :type list :read-only t)
  (mass 0d0 :type double-float :read-only t)
  (inertia nil :type list :read-only t)
  (inertial-pose (identity-pose) :type pose :read-only t)
  (visual-color nil :type list :read-only t)
  (fault nil :type (or null urdf-error) :read-only t)
  (line nil :type (or null integer) :read-only t))

(defmethod print-object ((link urdf-link) stream)
  (print-unreadable-object (link stream :type t)
    (format stream "~a~@[, ~(~a~)~]~:[~;, ~:*~,3f kg~]" (urdf-link-name link)
            (first (urdf-link-shape link))
            (and (plusp (urdf-link-mass link)) (urdf-link-mass link)))))

;;; Shapes

(defun geometry-shape (collision)
  "Return the shape that the <geometry> of COLLISION gives."
  (let* ((geometry (or (child collision "geometry")
                       (urdf-problem collision "a collision without geometry")))
         (node (or (first (xml-element-children geometry))
                   (urdf-problem geometry "a collision without geometry"))))
    (when (rest (xml-element-children geometry))
      (urdf-problem geometry "a geometry of several shapes"))
    (alexandria:switch ((xml-element-name node) :test #'string=)
      ("box" (cons :box (loop for number in (numbers-in (required-attribute node "size") 3 node)
                              collect (positive number node))))
      ("cylinder" (list :cylinder (positive-attribute node "radius")
                        (positive-attribute node "length")))
      ("sphere" (list :sphere (positive-attribute node "radius")))
      ("mesh" (mesh-shape node))
      (t (urdf-problem node "the geometry <~a> is not supported; box, cylinder, sphere and mesh ~
                             are" (xml-element-name node))))))

(defun moved-shape (pose shape)
  "Return SHAPE as it is in the frame in which POSE is that of its own."
  (cond ((pose= pose (identity-pose)) shape)
        ((eq (first shape) :hull)
         (cons :hull (loop for (x y z) in (rest shape)
                           for corner = (compose pose (make-pose x y z))
                           collect (list (pose-x corner) (pose-y corner) (pose-z corner)))))
        (t nil)))

(defun merged-shape (parts)
  "Return the union of PARTS, a list of (pose shape), as one shape; NIL if there are none."
  (let ((moved (loop for (pose shape) in parts
                     append (if (eq (first shape) :compound)
                                (loop for (inner part) in (rest shape)
                                      collect (list (compose pose inner) part))
                                (list (list pose shape))))))
    (cond ((null moved) nil)
          ((and (null (rest moved)) (moved-shape (first (first moved)) (second (first moved)))))
          (t (cons :compound moved)))))

(defun link-shape (element)
  "Return the shape of the collision elements of the link ELEMENT, or NIL if there are none."
  (merged-shape (loop for collision in (children element "collision")
                      collect (list (origin-of collision) (geometry-shape collision)))))

;;; Inertia

(defun inertia-tensor (element)
  "Return the tensor that the <inertia> ELEMENT gives, NIL if all of its numbers are 0."
  (let ((tensor (loop for name in '("ixx" "iyy" "izz" "ixy" "ixz" "iyz")
                      collect (if (char= (char name 1) (char name 2))
                                  (number-attribute element name)
                                  (number-attribute element name 0d0)))))
    (dolist (number tensor)
      (when (> (abs number) 1d9)
        (urdf-problem element "a moment of inertia of ~a kg m^2" number)))
    (if (every #'zerop tensor) nil tensor)))

(defun link-mass-in (element)
  "Return the mass that the <mass> ELEMENT gives, 0 if ELEMENT is NIL."
  (let ((mass (if element (number-attribute element "value") 0d0)))
    (when (minusp mass)
      (urdf-problem element "its mass is ~a kg" mass))
    (when (> mass 1d9)
      (urdf-problem element "its mass is ~a kg, more than can be" mass))
    mass))

(defun inertia-fault (moments element)
  "Return a URDF-ERROR about the <inertia> ELEMENT unless its principal MOMENTS are positive."
  (unless (every #'plusp moments)
    (urdf-complaint element "its inertia is not positive definite, the principal moments are~
                             ~{ ~a~^,~}" moments)))

(defun inertial (element)
  "Return what the <inertial> of the link ELEMENT gives: mass, principal moments, the pose of their
axes, and a fault."
  (let* ((inertial (child element "inertial"))
         (inertia (and inertial (child inertial "inertia")))
         (mass (link-mass-in (and inertial (child inertial "mass"))))
         (pose (if inertial (origin-of inertial) (identity-pose)))
         (tensor (and inertia (inertia-tensor inertia))))
    (if tensor
        (multiple-value-bind (moments axes) (principal-axes tensor)
          (let ((fault (inertia-fault moments inertia)))
            (if fault
                (values mass nil pose fault)
                (values mass moments (compose pose axes) nil))))
        (values mass nil pose nil))))

(defun check-dynamic (links)
  "Signal URDF-ERROR if the inertia of one of LINKS is one that no body can have."
  (dolist (link links)
    (when (urdf-link-fault link)
      (error (urdf-link-fault link)))))

;;; Colours

(defun color-of (material)
  "Return the colour (r g b a) of a <material> element, or NIL."
  (let ((color (and material (child material "color"))))
    (and color
         (loop for number in (numbers-in (required-attribute color "rgba") 4 color)
               collect (max 0d0 (min 1d0 number))))))

(defun color-table (root)
  "Return a hash table from the names of the materials in the model ROOT to their colours."
  (let ((table (make-hash-table :test 'equal)))
    (labels ((enter (materials)
               (dolist (material materials)
                 (let ((color (color-of material)) (name (attribute material "name")))
                   (when (and color name)
                     (setf (gethash name table) color))))))
      (dolist (link (children root "link"))
        (dolist (visual (children link "visual"))
          (enter (children visual "material"))))
      (enter (children root "material")))
    table))

(defun link-color-in (element colors)
  "Return the colour of the link ELEMENT; COLORS is the COLOR-TABLE of its model."
  (dolist (visual (children element "visual"))
    (let* ((material (first (children visual "material")))
           (color (and material
                       (or (color-of material)
                           (gethash (attribute material "name" "") colors)))))
      (when color
        (return color)))))

(defun parse-link (element colors)
  "Return the URDF-LINK that ELEMENT describes."
  (let* ((*model-part* "a link")
         (name (name-attribute element "name"))
         (*model-part* (format nil "link ~a" name)))
    (multiple-value-bind (mass moments pose fault) (inertial element)
      (make-urdf-link :name name :line (xml-element-line element) :shape (link-shape element)
                      :mass mass :inertia moments :inertial-pose pose
                      :visual-color (link-color-in element colors) :fault fault))))
