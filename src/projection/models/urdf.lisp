;;;; URDF: the model of a robot, a fixture or an item, as a tree of links.
;;;;
;;;; READ-URDF returns a model: links in the order of the file (links.lisp) and joints (joints.lisp)
;;;; so that each comes after the one above it.  Angles are fixed-axis roll, pitch, yaw; boxes have
;;;; full extents; cylinders are along z.  Elements that say nothing of links and joints, such as
;;;; <transmission> and <gazebo>, are passed over; xacro, which makes URDF, is not.

(in-package #:discrepancy-finder.projection)

(defstruct (urdf-model (:copier nil))
  "A tree of links; JOINTS come after the joint of their parent link.  MESHES are the names of the
mesh files that its links name."
  (name "" :type string :read-only t)
  (file "" :type string :read-only t)
  (meshes '() :type list :read-only t)
  (root "" :type string :read-only t)
  (links '() :type list :read-only t)
  (joints '() :type list :read-only t))

(setf (documentation 'urdf-model-name 'function)
      "Return the name of a URDF model, a string."
      (documentation 'urdf-model-root 'function)
      "Return the name of the link of a URDF model that has none above it."
      (documentation 'urdf-model-links 'function)
      "Return the list of the links of a URDF model, in the order of its file."
      (documentation 'urdf-model-joints 'function)
      "Return the list of the joints of a URDF model, each after the joint of its parent link.")

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

;;; The tree

(defun check-names (things name line what)
  "Signal URDF-ERROR if two of THINGS have the same NAME, at the LINE of the second, both readers."
  (let ((table (make-hash-table :test 'equal)))
    (dolist (thing things)
      (let ((earlier (gethash (funcall name thing) table)))
        (when earlier
          (urdf-problem (funcall line thing) "the ~a ~a is there already~@[, in line ~d~]" what
                        (funcall name thing) (funcall line earlier))))
      (setf (gethash (funcall name thing) table) thing))))

(defun joints-by-child (joints links)
  "Return a hash table of JOINTS by their child.  Signals URDF-ERROR if a joint is between links
that LINKS, a hash table by name, does not have, or two have the same child."
  (let ((table (make-hash-table :test 'equal)))
    (dolist (joint joints table)
      (let ((child (urdf-joint-child joint)))
        (dolist (name (list (urdf-joint-parent joint) child))
          (unless (gethash name links)
            (joint-problem joint "there is no link ~a" name)))
        (when (gethash child table)
          (joint-problem joint "the link ~a is the child of the joint ~a already" child
                         (urdf-joint-name (gethash child table))))
        (setf (gethash child table) joint)))))

(defun root-link (links above)
  "Return the name of the only one of LINKS that no joint in the table ABOVE has as its child."
  (let ((roots (remove-if (lambda (link) (gethash (urdf-link-name link) above)) links)))
    (when (rest roots)
      (urdf-problem (urdf-link-line (second roots))
                    "the links do not form one tree: no joint is above ~a and none above ~a"
                    (urdf-link-name (first roots)) (urdf-link-name (second roots))))
    (and roots (urdf-link-name (first roots)))))

(defun order-joints (joints root)
  "Return JOINTS so that each comes after the one above its parent, from the link ROOT on, depth
first."
  (let ((below (make-hash-table :test 'equal))
        (ordered '()))
    (dolist (joint (reverse joints))
      (push joint (gethash (urdf-joint-parent joint) below)))
    (loop with open = (gethash root below)
          while open
          do (let ((joint (pop open)))
               (push joint ordered)
               (setf open (append (gethash (urdf-joint-child joint) below) open))))
    (let ((left (set-difference joints ordered)))
      (when left
        (let ((first (find-if (lambda (joint) (member joint left)) joints)))
          (joint-problem first "the links do not form one tree: it is in a cycle of joints, or ~
                                below one"))))
    (nreverse ordered)))

;;; Reading

(defun xacro-p (text)
  (or (search "${" text) (search "$(" text)))

(defun check-xacro (element)
  "Signal URDF-ERROR if ELEMENT or one in it is of the macro language xacro."
  (flet ((refuse (what)
           (urdf-problem element "~a is xacro; the program xacro makes URDF of it" what)))
    (when (alexandria:starts-with-subseq "xacro:" (xml-element-name element))
      (refuse (format nil "<~a>" (xml-element-name element))))
    (when (member (xml-element-name element) '("robot" "link" "joint" "origin" "mesh" "box" "mass"
                                               "inertia" "limit")
                  :test #'string=)
      (loop for (nil . value) in (xml-element-attributes element)
            do (when (xacro-p value)
                 (refuse (format nil "~s" value)))))
    (mapc #'check-xacro (xml-element-children element))))

(defun parse-urdf (root)
  "Return the URDF-MODEL that ROOT, the root element of *MODEL-FILE*, describes."
  (unless (string= (xml-element-name root) "robot")
    (urdf-problem root "its root element is <~a>, not <robot>" (xml-element-name root)))
  (check-xacro root)
  (let* ((colors (color-table root))
         (links (loop for element in (children root "link")
                      collect (parse-link element colors)))
         (joints (mapcar #'parse-joint (children root "joint")))
         (table (make-hash-table :test 'equal)))
    (unless links
      (urdf-problem root "it has no link"))
    (check-names links #'urdf-link-name #'urdf-link-line "link")
    (check-names joints #'urdf-joint-name #'urdf-joint-line "joint")
    (dolist (link links)
      (setf (gethash (urdf-link-name link) table) link))
    (let* ((above (joints-by-child joints table))
           (root-name (root-link links above)))
      (make-urdf-model :name (name-attribute root "name") :file *model-file*
                       :meshes (reverse *mesh-files*) :root (or root-name "") :links links
                       :joints (order-joints (resolved-joints joints)
                                             (or root-name "no link"))))))

(defun read-urdf (file &key (package-path *package-path*))
  "Return the URDF-MODEL in FILE.  PACKAGE-PATH is a list of folders in which the packages of
package:// names are looked for before others.  Signals URDF-ERROR, which names the file, the line
and the link or joint, if the file is missing, malformed, or uses what is not supported."
  (let ((*model-file* (source:native-name file))
        (*model-part* nil)
        (*mesh-files* '())
        (*package-path* package-path))
    (parse-urdf (read-xml file))))
