;;;; Scenes: which URDF models stand where, and the parameters of the robot.
;;;;
;;;; A scene file holds one DEFINE-SCENE form, read as data:
;;;;   (define-scene NAME [documentation]
;;;;     (:parameters (NAME value [documentation])*)
;;;;     (:fixture NAME "file.urdf" (:at x y z [yaw]))     what never moves
;;;;     (:item NAME "file.urdf" (:at x y z [yaw]) [(:type TYPE)])
;;;;                                      a rigid body; without :type its name is also its type
;;;;     (:robot NAME "file.urdf" (:at x y z [yaw]) (:lift JOINT) (:shoulder JOINT)
;;;;             (:extension JOINT) (:gripper LINK)
;;;;             [(:camera LINK)]           looks along the x axis of its link, with z upwards
;;;;             [(:head JOINT JOINT)]))    pan and tilt, which turn the camera
;;;; File names are relative to the scene's file.  LOAD-SCENE reads it.
;;;;
;;;; What a robot with a camera sees depends on four parameters: camera-range (m),
;;;; camera-field-of-view and camera-vertical-field-of-view (rad, from side to side), and
;;;; visible-fraction, the part of an item's surface that must be seen, 0 to 1.

(in-package #:discrepancy-finder.projection)

(defstruct (scene-part (:copier nil))
  "A model of a scene: KIND is :fixture, :item or :robot; TYPE is that of an item, ROLES names
joints and links of a robot."
  (name nil :type keyword :read-only t)
  (kind :item :type keyword :read-only t)
  (model nil :type urdf-model :read-only t)
  (pose nil :type pose :read-only t)
  (type nil :type (or null keyword) :read-only t)
  (roles '() :type list :read-only t))

(defstruct (scene (:copier nil))
  "What stands where.  PARAMETERS is a list of (name value documentation)."
  (name nil :type keyword :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (file "" :type string :read-only t)
  (parts '() :type list :read-only t)
  (parameters '() :type list :read-only t))

(setf (documentation 'scene-name 'function)
      "Return the name of a scene, a keyword."
      (documentation 'scene-file 'function)
      "Return the name of the file of a scene."
      (documentation 'scene-parameters 'function)
      "Return the parameters of a scene: a list of (name value [documentation]).")

(defmethod print-object ((scene scene) stream)
  (print-unreadable-object (scene stream :type t)
    (format stream "~(~a~):~{ ~(~a~)~}" (scene-name scene)
            (mapcar #'scene-part-name (scene-parts scene)))))

(defun scene-parameter (scene name)
  "Return the value, a double float, of the parameter NAME (a symbol) of SCENE.  Signals
UNKNOWN-PARAMETER."
  (let ((entry (find (symbol-name name) (scene-parameters scene)
                     :key (lambda (entry) (symbol-name (first entry))) :test #'string=)))
    (if entry
        (second entry)
        (error 'unknown-parameter :name name :scene (scene-name scene)
                                  :known (mapcar #'first (scene-parameters scene))))))

(defparameter *parameter-limits*
  `((:camera-field-of-view . ,pi) (:camera-vertical-field-of-view . ,pi) (:visible-fraction . 1))
  "The largest values of parameters that have one.")

(defun parameter-limit (name)
  (cdr (assoc (source:name-keyword name) *parameter-limits*)))

(defun possible-value-p (name value)
  "Return true if VALUE can be that of the parameter NAME, a symbol."
  (and (realp value) (< 0 value 1000000000) (<= value (or (parameter-limit name) value))))

(defun check-parameters (scene values)
  "Signal UNKNOWN-PARAMETER or IMPOSSIBLE-PARAMETER unless VALUES is a property list of SCENE's
parameters and positive reals."
  (unless (and (alexandria:proper-list-p values) (evenp (length values)))
    (error 'impossible-parameter :name "list" :value values))
  (loop for (name value) on values by #'cddr
        do (unless (symbolp name)
             (error 'unknown-parameter :name name :scene (scene-name scene)
                                       :known (mapcar #'first (scene-parameters scene))))
           (scene-parameter scene name)
           (unless (possible-value-p name value)
             (error 'impossible-parameter :name name :value value
                                          :limit (parameter-limit name)))))

(defun normalized-parameters (scene values)
  "Return VALUES, a property list of scene parameters and reals, with keywords and double floats.
Signals UNKNOWN-PARAMETER and IMPOSSIBLE-PARAMETER."
  (check-parameters scene values)
  (loop for (name value) on values by #'cddr
        append (list (source:name-keyword name) (decimal-double value))))

(defun scene-with-parameters (scene values)
  "Return SCENE with the parameters in VALUES, a property list of names and positive reals, changed.
Signals UNKNOWN-PARAMETER and IMPOSSIBLE-PARAMETER."
  (let ((values (normalized-parameters scene values)))
    (make-scene :name (scene-name scene) :documentation (scene-documentation scene)
                :file (scene-file scene) :parts (scene-parts scene)
                :parameters (loop for (name value . more) in (scene-parameters scene)
                                  collect (list* name (getf values name value) more)))))

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

(defun scene-robot (scene)
  (first (parts-of-kind scene :robot)))

(defun scene-robot-name (scene)
  "Return the name (a keyword) of SCENE's robot, or NIL if it has none."
  (and (scene-robot scene) (scene-part-name (scene-robot scene))))

(defun scene-files (scene)
  "Return the names of the files that SCENE was read from: its own and those of its models."
  (cons (scene-file scene)
        (remove-duplicates (mapcar (lambda (part) (urdf-model-file (scene-part-model part)))
                                   (scene-parts scene))
                           :test #'string= :from-end t)))

;;; Reading

(defun scene-problem (file form control &rest arguments)
  (let ((position (source:form-position form)))
    (error 'scene-error :file (source:native-name file)
                        :line (and position (source:source-position-line position))
                        :reason (apply #'format nil control arguments))))

(defun find-option (clause name)
  (find name (cdddr clause) :key (lambda (option) (and (consp option) (first option)))))

(defun option-value (clause name file)
  "Return the arguments of the option NAME of CLAUSE."
  (let ((option (find-option clause name)))
    (unless option
      (scene-problem file clause "~(~s~) ~(~a~) needs an option (~(~s~) ...)"
                     (first clause) (second clause) name))
    (rest option)))

(defun clause-pose (clause file)
  (let ((numbers (option-value clause :at file)))
    (unless (and (<= 3 (length numbers) 4) (every #'realp numbers))
      (scene-problem file clause "(:at x y z [yaw]) was expected in ~(~s~) ~(~a~)"
                     (first clause) (second clause)))
    (destructuring-bind (x y z &optional (yaw 0)) numbers
      (make-pose x y z :yaw yaw))))

(defun role-problem (role name model)
  "Return what is wrong with NAME in the ROLE of a robot with MODEL, or NIL."
  (let ((joint (find name (urdf-model-joints model) :key #'urdf-joint-name :test #'equal))
        (link (find name (urdf-model-links model) :key #'urdf-link-name :test #'equal)))
    (ecase role
      (:camera (unless link "no such link"))
      (:gripper (cond ((null link) "no such link")
                      ((null (urdf-link-shape link)) "a link without a shape")))
      ((:lift :extension :shoulder :pan :tilt)
       (let ((types (if (member role '(:lift :extension)) '(:prismatic) '(:revolute :continuous))))
         (cond ((null joint) "no such joint")
               ((not (member (urdf-joint-type joint) types))
                (format nil "a joint that is not ~(~a~)" (first types)))))))))

(defun joint-turns-p (model joint-name link-name)
  "Return true if the joint JOINT-NAME of MODEL is on the way from the root to the link LINK-NAME."
  (let ((joint (find link-name (urdf-model-joints model)
                     :key #'urdf-joint-child :test #'string=)))
    (and joint
         (or (string= (urdf-joint-name joint) joint-name)
             (joint-turns-p model joint-name (urdf-joint-parent joint))))))

(defun head-roles (clause model file)
  "Return the roles of the head and the camera that the robot's CLAUSE names, a property list."
  (let ((head (find-option clause :head)) (camera (find-option clause :camera)))
    (when (and head (not (and camera (= (length head) 3))))
      (scene-problem file clause "(:head pan-joint tilt-joint) with a (:camera link) was expected"))
    (append (and camera (list :camera (second camera)))
            (loop for role in '(:pan :tilt)
                  for name in (rest head)
                  do (when (and (null (role-problem role name model))
                                (null (role-problem :camera (second camera) model))
                                (not (joint-turns-p model name (second camera))))
                       (scene-problem file clause "the joint ~s of the head does not turn the ~
                                                   camera ~s" name (second camera)))
                  collect role collect name))))

(defun robot-roles (clause model file)
  (let ((roles (append (loop for role in '(:lift :shoulder :extension :gripper)
                             collect role collect (first (option-value clause role file)))
                       (head-roles clause model file))))
    (loop for (role name) on roles by #'cddr
          for problem = (role-problem role name model)
          do (when problem
               (scene-problem file clause "~(~s~) ~s: ~a has ~a" role name (urdf-model-file model)
                              problem)))
    roles))

(defun item-type (clause file)
  "Return the type that the item's CLAUSE gives, or else its name."
  (let ((option (find-option clause :type)))
    (unless (or (null option) (and (= (length option) 2) (second option)
                                   (symbolp (second option))))
      (scene-problem file clause "(:type name) was expected in :item ~(~a~)" (second clause)))
    (source:name-keyword (second (or option clause)))))

(defun parse-part (clause file)
  (destructuring-bind (kind &optional name model-file &rest options) clause
    (unless (and (symbolp name) name (stringp model-file) (every #'consp options))
      (scene-problem file clause "(~(~s~) name \"file.urdf\" option*) was expected" kind))
    (let ((model (read-urdf (merge-pathnames (source:native-path model-file)
                                               (source:native-path file)))))
      (when (and (eq kind :item)
                 (not (and (= (length (urdf-model-links model)) 1)
                           (urdf-link-shape (first (urdf-model-links model)))
                           (plusp (urdf-link-mass (first (urdf-model-links model)))))))
        (scene-problem file clause "the item ~(~a~) must have one link, with a mass and a shape"
                       name))
      (make-scene-part :name (source:name-keyword name) :kind kind :model model
                       :pose (clause-pose clause file)
                       :type (and (eq kind :item) (item-type clause file))
                       :roles (and (eq kind :robot) (robot-roles clause model file))))))

(defun parse-parameter (entry file)
  (unless (and (consp entry) (null (cdr (last entry))) (symbolp (first entry))
               (possible-value-p (first entry) (second entry)))
    (scene-problem file entry "(name positive-number [documentation]) was expected in ~
                               :parameters~@[, and a number of at most ~,4f~]"
                   (and (consp entry) (symbolp (first entry)) (parameter-limit (first entry)))))
  (list* (source:name-keyword (first entry)) (decimal-double (second entry)) (cddr entry)))

(defun parse-scene (form file)
  (destructuring-bind (name &rest clauses) (rest form)
    (let ((documentation (and (stringp (first clauses)) (pop clauses)))
          (parts '())
          (parameters '()))
      (dolist (clause clauses)
        (case (and (consp clause) (first clause))
          ((:fixture :item :robot) (push (parse-part clause file) parts))
          (:parameters (setf parameters
                             (append parameters (mapcar (lambda (entry)
                                                          (parse-parameter entry file))
                                                        (rest clause)))))
          (t (scene-problem file (if (consp clause) clause form)
                            "~(~s~) was found where :parameters, :fixture, :item or :robot was ~
                             expected"
                            (if (consp clause) (first clause) clause)))))
      (flet ((distinct-p (names)
               (= (length names) (length (remove-duplicates names)))))
        (unless (distinct-p (mapcar #'scene-part-name parts))
          (scene-problem file form "two parts have the same name"))
        (unless (distinct-p (mapcar #'first parameters))
          (scene-problem file form "two parameters have the same name")))
      (unless (<= (count :robot parts :key #'scene-part-kind) 1)
        (scene-problem file form "there can be one robot only"))
      (when (some (lambda (part) (getf (scene-part-roles part) :camera)) parts)
        (dolist (name '(:camera-range :camera-field-of-view :camera-vertical-field-of-view
                        :visible-fraction))
          (unless (assoc name parameters)
            (scene-problem file form "a robot with a camera needs the parameter ~(~a~)" name))))
      (make-scene :name (source:name-keyword name) :documentation documentation
                  :file (source:native-name file)
                  :parts (nreverse parts) :parameters parameters))))

(defun load-scene (file)
  "Return the SCENE in FILE.  Nothing in it is evaluated.  Signals SOURCE-ERROR, SCENE-ERROR or
URDF-ERROR, which name the file."
  (let ((forms (source:read-source file :package '#:discrepancy-finder.projection)))
    (unless (and (= (length forms) 1) (consp (first forms))
                 (symbolp (first (first forms)))
                 (string= (first (first forms)) "DEFINE-SCENE")
                 (second (first forms)) (symbolp (second (first forms))))
      (error 'scene-error :file (source:native-name file)
                          :reason "one form (define-scene name clause*) was expected"))
    (parse-scene (first forms) file)))
