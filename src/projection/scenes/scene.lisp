;;;; Scenes: which URDF models stand where, of which materials, and the parameters of it all.
;;;;
;;;; A scene file (reading.lisp) holds one DEFINE-SCENE form, read as data:
;;;;   (define-scene NAME [documentation]
;;;;     (:parameters (NAME value [documentation])*)          parameters.lisp
;;;;     (:tolerances (NAME low high [documentation])*)
;;;;     (:materials (NAME (:friction X) (:restitution Y) [(:rolling-friction Z)])*)  materials.lisp
;;;;     (:fixture NAME "file.urdf" (:at x y z [yaw]) [(:material M)])
;;;;                                      what stands fast; its joints, if any, can move
;;;;     (:item NAME "file.urdf" (:at x y z [yaw]) [(:type TYPE)] [(:material M)]
;;;;            [(:grasps GRASP*)])       a rigid body; without :type its name is also its type;
;;;;                                      a GRASP is a NAME or (NAME x y z)
;;;;     (:robot NAME "file.urdf" (:at x y z [yaw]) role*))                             robots.lisp
;;;; File names are relative to the scene's file.  LOAD-SCENE reads it.

(in-package #:discrepancy-finder.projection)

(defstruct (scene-part (:copier nil))
  "A model of a scene: KIND is :fixture, :item or :robot.  TYPE and GRASPS are those of an item;
ROLES, a property list of names of joints and links, and ARMS, a list of ARM-ROLES, those of a
robot; MATERIAL is a name.  FORM is what it was read from.  PREPARED is for what is made of the part
once and used in every projection."
  (name nil :type keyword :read-only t)
  (kind :item :type keyword :read-only t)
  (model nil :type urdf-model :read-only t)
  (pose nil :type pose :read-only t)
  (type nil :type (or null keyword) :read-only t)
  (material nil :type (or null keyword) :read-only t)
  (grasps '() :type list :read-only t)
  (roles '() :type list :read-only t)
  (arms '() :type list :read-only t)
  (form nil :type list :read-only t)
  (prepared nil))

(defmethod print-object ((part scene-part) stream)
  (print-unreadable-object (part stream :type t)
    (format stream "~(~a ~a~), ~a" (scene-part-kind part) (scene-part-name part)
            (urdf-model-name (scene-part-model part)))))

(defstruct (scene (:copier %copy-scene))
  "What stands where.  PARAMETERS is a list of (name value documentation), TOLERANCES one of (name
low high documentation), DRAWN a property list of those tolerances' values that are set."
  (name nil :type keyword :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (file "" :type string :read-only t)
  (parts '() :type list)
  (materials '() :type list :read-only t)
  (parameters '() :type list)
  (tolerances '() :type list :read-only t)
  (drawn '() :type list))

(setf (documentation 'scene-name 'function)
      "Return the name of a scene, a keyword."
      (documentation 'scene-file 'function)
      "Return the name of the file of a scene."
      (documentation 'scene-parameters 'function)
      "Return the parameters of a scene: a list of (name value [documentation])."
      (documentation 'scene-tolerances 'function)
      "Return the tolerances of a scene: a list of (name low high documentation), where the
documentation can be NIL.")

(defmethod print-object ((scene scene) stream)
  (print-unreadable-object (scene stream :type t)
    (format stream "~(~a~):~{ ~(~a~)~}" (scene-name scene)
            (mapcar #'scene-part-name (scene-parts scene)))))

;;; Parameters

(defun scene-knows-p (scene name)
  "Return true if the keyword NAME is a parameter of SCENE, given, with a tolerance or by default."
  (and (or (assoc name (scene-parameters scene))
           (assoc name (scene-tolerances scene))
           (known-parameter name))
       t))

(defun scene-parameter (scene name)
  "Return the value, a double float, of the parameter or tolerance NAME (a symbol) in SCENE.
Signals UNKNOWN-PARAMETER."
  (let* ((name (source:name-keyword name))
         (given (assoc name (scene-parameters scene)))
         (tolerance (assoc name (scene-tolerances scene)))
         (default (second (known-parameter name))))
    (cond ((getf (scene-drawn scene) name))
          (given (second given))
          (tolerance (/ (+ (second tolerance) (third tolerance)) 2))
          ((keywordp default) (scene-parameter scene default))
          (default (decimal-double default))
          (t (error 'unknown-parameter :name name :scene (scene-name scene)
                                       :known (mapcar #'first
                                                      (append (scene-parameters scene)
                                                              (scene-tolerances scene))))))))

(defun scene-open-tolerances (scene)
  "Return the tolerances of SCENE that have no set value: a list like that of SCENE-TOLERANCES."
  (remove-if (lambda (entry) (getf (scene-drawn scene) (first entry))) (scene-tolerances scene)))

(defun check-value (scene name value)
  "Signal IMPOSSIBLE-PARAMETER unless VALUE can be that of the parameter NAME of SCENE."
  (let ((tolerance (assoc (source:name-keyword name) (scene-tolerances scene))))
    (if tolerance
        (destructuring-bind (low high &rest more) (rest tolerance)
          (declare (ignore more))
          (unless (and (realp value) (<= low (decimal-double value) high))
            (error 'impossible-parameter :name name :value value :range (list low high))))
        (unless (possible-value-p name value)
          (multiple-value-bind (bound largest) (parameter-limits name)
            (error 'impossible-parameter :name name :value value :limit largest
                                         :positive (and bound t)))))))

(defun check-parameters (scene values)
  "Signal UNKNOWN-PARAMETER or IMPOSSIBLE-PARAMETER unless VALUES is a property list of SCENE's
parameters and possible values."
  (unless (and (alexandria:proper-list-p values) (evenp (length values)))
    (error 'impossible-parameter :name "list" :value values))
  (loop for (name value) on values by #'cddr
        do (unless (symbolp name)
             (error 'unknown-parameter :name name :scene (scene-name scene)
                                       :known (mapcar #'first (scene-parameters scene))))
           (scene-parameter scene name)
           (check-value scene name value)))

(defun normalized-parameters (scene values)
  "Return VALUES, a property list of scene parameters and reals, with keywords and double floats.
Signals UNKNOWN-PARAMETER and IMPOSSIBLE-PARAMETER."
  (check-parameters scene values)
  (loop for (name value) on values by #'cddr
        append (list (source:name-keyword name) (decimal-double value))))

(defun scene-with-parameters (scene values)
  "Return SCENE with the parameters and tolerances in VALUES, a property list of names and reals,
changed.  A parameter must be positive unless *KNOWN-PARAMETERS* says otherwise, a tolerance within
its range.  Signals UNKNOWN-PARAMETER and IMPOSSIBLE-PARAMETER."
  (let* ((values (normalized-parameters scene values))
         (copy (%copy-scene scene))
         (drawn (copy-list (scene-drawn scene)))
         (parameters (scene-parameters scene)))
    (loop for (name value) on values by #'cddr
          for given = (assoc name parameters)
          do (cond ((assoc name (scene-tolerances scene)) (setf (getf drawn name) value))
                   (given (setf parameters
                                (substitute (list* name value (cddr given)) given parameters)))
                   (t (setf parameters
                            (append parameters
                                    (list (list name value
                                                (third (known-parameter name)))))))))
    (setf (scene-parameters copy) parameters
          (scene-drawn copy) drawn)
    copy))

;;; Parts

(defun scene-with-items (scene items)
  "Return SCENE without the items that are not in the list ITEMS of their names, keywords."
  (let ((copy (%copy-scene scene)))
    (setf (scene-parts copy)
          (remove-if (lambda (part)
                       (and (eq (scene-part-kind part) :item)
                            (not (member (scene-part-name part) items))))
                     (scene-parts scene)))
    copy))

(defun scene-part (scene name)
  "Return the part NAME, a symbol, of SCENE.  Signals UNKNOWN-BODY."
  (or (find (source:name-keyword name) (scene-parts scene) :key #'scene-part-name)
      (error 'unknown-body :name name :scene (scene-name scene))))

(defun check-movable (scene name)
  "Signal UNKNOWN-BODY unless NAME, a symbol, names the robot or an item of SCENE."
  (when (eq (scene-part-kind (scene-part scene name)) :fixture)
    (error 'unknown-body :name name :scene (scene-name scene))))

(defun scene-body-pose (scene name)
  "Return the pose at which SCENE has the robot or item NAME, a symbol.  Signals UNKNOWN-BODY."
  (check-movable scene name)
  (scene-part-pose (scene-part scene name)))

(defun parts-of-kind (scene kind)
  (remove kind (scene-parts scene) :key #'scene-part-kind :test-not #'eq))

(defun scene-item-names (scene)
  "Return the list of the names (keywords) of SCENE's items."
  (mapcar #'scene-part-name (parts-of-kind scene :item)))

(defun scene-item-type (scene name)
  "Return the type (a keyword) of the item NAME, a symbol, of SCENE.  Signals UNKNOWN-BODY."
  (check-movable scene name)
  (scene-part-type (scene-part scene name)))

(defun scene-item-grasps (scene name)
  "Return the list of the grasps that the item NAME, a symbol, of SCENE allows, best first; NIL if
SCENE says nothing.  A grasp is a keyword or (keyword x y z) with the point to be grasped (m) in the
item's frame.  Signals UNKNOWN-BODY."
  (check-movable scene name)
  (scene-part-grasps (scene-part scene name)))

(defun scene-robot (scene)
  (first (parts-of-kind scene :robot)))

(defun scene-robot-name (scene)
  "Return the name (a keyword) of SCENE's robot, or NIL if it has none."
  (and (scene-robot scene) (scene-part-name (scene-robot scene))))

(defun scene-joint (scene name)
  "Return the joint NAME, a string, of a part of SCENE, a URDF-JOINT; NIL if there is none that
moves."
  (loop for part in (scene-parts scene)
        thereis (find-if (lambda (joint)
                           (and (string= name (urdf-joint-name joint))
                                (not (eq (urdf-joint-type joint) :fixed))))
                         (urdf-model-joints (scene-part-model part)))))

(defun scene-joint-limits (scene name)
  "Return the least and the greatest position (m or rad) of the joint NAME, a string, of SCENE, NIL
for none."
  (let ((joint (scene-joint scene name)))
    (values (and joint (urdf-joint-lower joint)) (and joint (urdf-joint-upper joint)))))

(defun scene-files (scene)
  "Return the names of the files that SCENE was read from: its own, those of its models and of their
meshes."
  (cons (scene-file scene)
        (remove-duplicates (loop for part in (scene-parts scene)
                                 for model = (scene-part-model part)
                                 collect (urdf-model-file model)
                                 append (urdf-model-meshes model))
                           :test #'string= :from-end t)))
