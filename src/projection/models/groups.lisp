;;;; Groups of links: what fixed joints hold together moves as one body.
;;;;
;;;; RIGID-GROUPS returns the groups of a model, the one of the root first, each after the one to
;;;; which its joint connects it.  A group's frame is that of its first link, the child of the
;;;; movable joint above.  Its mass and inertia are the sums of its links'; a link with a shape and
;;;; without a mass counts as wood of *DENSITY*, one without inertia as evenly filled.

(in-package #:discrepancy-finder.projection)

(defparameter *density* 500d0
  "The density (kg/m^3) of links that have a shape and no mass.")

(defstruct (rigid-group (:copier nil))
  "Links that are fixed together: MEMBERS is a list of (link . pose in the frame of the first one),
JOINT the movable joint above the first, NIL for the root, PARENT the group to which it connects.
SHAPE is NIL if no link has one; MASS (kg) and INERTIA (kg m^2, about the axes of INERTIAL-POSE) are
0 and NIL if no link has mass or shape."
  (members '() :type list :read-only t)
  (joint nil :type (or null urdf-joint) :read-only t)
  (parent nil :read-only t)
  (shape nil :type list :read-only t)
  (mass 0d0 :type double-float :read-only t)
  (inertia nil :type list :read-only t)
  (inertial-pose (identity-pose) :type pose :read-only t))

(defun rigid-group-link (group)
  "Return the first link of GROUP, in whose frame the others are."
  (car (first (rigid-group-members group))))

(defmethod print-object ((group rigid-group) stream)
  (print-unreadable-object (group stream :type t)
    (format stream "~{~a~^, ~}" (loop for (link) in (rigid-group-members group)
                                      collect (urdf-link-name link)))))

(defun link-mass (link)
  "Return the mass (kg) of LINK, by *DENSITY* if it has a shape and its file gives none."
  (let ((shape (urdf-link-shape link)))
    (cond ((plusp (urdf-link-mass link)) (urdf-link-mass link))
          (shape (* *density* (bullet:shape-volume shape)))
          (t 0d0))))

(defun at-position (pose axes)
  "Return the frame at the position of POSE with the orientation of AXES."
  (quaternion-pose (pose-x pose) (pose-y pose) (pose-z pose)
                   (pose-qx axes) (pose-qy axes) (pose-qz axes) (pose-qw axes)))

(defun link-inertia (link)
  "Return mass, principal moments and the pose of their axes for LINK.  What the file does not give
is that of the evenly filled shape; the moments are 0 without one."
  (let ((mass (link-mass link))
        (shape (urdf-link-shape link))
        (pose (urdf-link-inertial-pose link)))
    (cond ((urdf-link-inertia link) (values mass (urdf-link-inertia link) pose))
          ((and shape (plusp mass))
           (multiple-value-bind (moments axes) (bullet:mass-properties shape mass)
             (values mass moments
                     (if (plusp (urdf-link-mass link)) (at-position pose axes) axes))))
          (t (values mass (list 0d0 0d0 0d0) pose)))))

(defun group-inertia (members)
  "Return mass, principal moments and the pose of their axes of MEMBERS, a list of (link . pose)."
  (let ((bodies (loop for (link . pose) in members
                      collect (multiple-value-bind (mass moments axes) (link-inertia link)
                                (list mass moments (compose pose axes))))))
    (setf bodies (remove-if-not #'plusp bodies :key #'first))
    (cond ((null bodies) (values 0d0 nil (identity-pose)))
          ((rest bodies) (combined-inertia bodies))
          (t (values-list (first bodies))))))

(defun fixed-members (model link-name)
  "Return the list of (link . pose) of LINK-NAME and what fixed joints hold to it, and the list of
the movable joints below these, with the pose of their parent link."
  (let ((members '()) (joints '()))
    (labels ((visit (name pose)
               (push (cons (find-urdf-link model name) pose) members)
               (dolist (joint (urdf-model-joints model))
                 (when (string= (urdf-joint-parent joint) name)
                   (if (eq (urdf-joint-type joint) :fixed)
                       (visit (urdf-joint-child joint)
                              (compose pose (urdf-joint-origin joint)))
                       (push joint joints))))))
      (visit link-name (identity-pose)))
    (values (nreverse members) (nreverse joints))))

(defun rigid-groups (model)
  "Return the list of the RIGID-GROUPs of MODEL, each after its parent."
  (let ((groups '()))
    (labels ((visit (link-name joint parent)
               (multiple-value-bind (members below) (fixed-members model link-name)
                 (multiple-value-bind (mass moments axes) (group-inertia members)
                   (let ((group (make-rigid-group
                                 :members members :joint joint :parent parent
                                 :shape (merged-shape
                                         (loop for (link . pose) in members
                                               when (urdf-link-shape link)
                                                 collect (list pose (urdf-link-shape link))))
                                 :mass mass :inertia moments :inertial-pose axes)))
                     (push group groups)
                     (dolist (joint below)
                       (visit (urdf-joint-child joint) joint group)))))))
      (visit (urdf-model-root model) nil nil))
    (nreverse groups)))
