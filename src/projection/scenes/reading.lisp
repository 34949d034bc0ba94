;;;; Reading a scene file.  LOAD-SCENE is the entry; the grammar is in scene.lisp.

(in-package #:discrepancy-finder.projection)

(defparameter *part-options*
  `((:fixture :at :material)
    (:item :at :type :material :grasps)
    (:robot ,@*robot-options*))
  "The kinds of parts and their options.")

(defun read-part-model (name clause file)
  "Return the URDF model in the file that CLAUSE of the scene in FILE names NAME."
  (let ((path (merge-pathnames (source:native-path name)
                               (uiop:pathname-directory-pathname (source:native-path file)))))
    (unless (uiop:file-exists-p path)
      (scene-problem file clause "~a: no such file" (source:native-name path)))
    (read-urdf path)))

(defun check-item (model clause file)
  (let ((link (first (urdf-model-links model))))
    (unless (and (null (rest (urdf-model-links model)))
                 (urdf-link-shape link) (plusp (urdf-link-mass link)))
      (scene-problem file clause "the item ~(~a~) must have one link, with a mass and a shape"
                     (second clause)))))

(defparameter *grasp-sides* '(:top :bottom :front :back :left-side :right-side)
  "The sides from which an item can be grasped, by CRAM's names.")

(defun clause-grasps (clause file)
  "Return the grasps that the :grasps option of CLAUSE lists: keywords and (keyword x y z)."
  (let ((option (find-option (clause-options clause) :grasps)))
    (flet ((side (name)
             (or (find (source:name-keyword name) *grasp-sides*)
                 (scene-problem file option "there is no grasp ~(~a~); ~{~(~a~)~^, ~} are" name
                                *grasp-sides*))))
      (loop for grasp in (rest option)
            collect (cond ((parameter-name-p grasp) (side grasp))
                          ((and (consp grasp) (parameter-name-p (first grasp))
                                (= (length grasp) 4) (every #'coordinate-p (rest grasp)))
                           (cons (side (first grasp)) (mapcar #'decimal-double (rest grasp))))
                          (t (scene-problem file (if (consp grasp) grasp option)
                                            "a grasp is a name or (name x y z), not ~(~s~)"
                                            grasp)))))))

(defun parse-part (clause file)
  "Return the SCENE-PART that CLAUSE of the scene in FILE describes."
  (destructuring-bind (kind &optional name model-file &rest options) clause
    (unless (and (parameter-name-p name) (stringp model-file))
      (scene-problem file clause "(~(~s~) name \"file.urdf\" option*) was expected" kind))
    (check-options clause options (rest (assoc kind *part-options*)) file)
    (let ((model (read-part-model model-file clause file)))
      (unless (eq kind :robot)
        (check-dynamic (urdf-model-links model)))
      (when (eq kind :item)
        (check-item model clause file))
      (multiple-value-bind (roles arms) (and (eq kind :robot) (robot-roles clause model file))
        (make-scene-part :name (source:name-keyword name) :kind kind :model model
                         :pose (clause-pose clause file)
                         :type (and (eq kind :item)
                                    (or (option-name clause :type file)
                                        (source:name-keyword name)))
                         :material (option-name clause :material file)
                         :grasps (clause-grasps clause file)
                         :roles roles :arms arms :form clause)))))

(defun check-clause (clause form file)
  "Signal SCENE-ERROR unless CLAUSE of FORM has a known kind."
  (let ((known '(:parameters :tolerances :materials :fixture :item :robot)))
    (unless (and (consp clause) (member (first clause) known))
      (scene-problem file (if (consp clause) clause form)
                     "~(~s~) was found where ~{~(~s~)~^, ~} was expected"
                     (if (consp clause) (first clause) clause) known))))

(defun check-parts (clauses file)
  "Signal SCENE-ERROR if two of CLAUSES, each a part's, have the same name, or two are robots'."
  (check-distinct clauses "parts" file :key #'second)
  (let ((robots (remove :robot clauses :key #'first :test-not #'eq)))
    (when (rest robots)
      (scene-problem file (second robots) "there can be one robot only"))))

(defun parse-scene (form file)
  "Return the SCENE that FORM, of FILE, defines."
  (check-proper form file)
  (destructuring-bind (name &rest clauses) (rest form)
    (let ((documentation (and (stringp (first clauses)) (pop clauses))))
      (dolist (clause clauses)
        (check-clause clause form file))
      (flet ((clauses (&rest kinds)
               (remove-if-not (lambda (clause) (member (first clause) kinds)) clauses))
             (parse (function entries)
               (mapcar (lambda (entry) (funcall function entry file)) entries)))
        (flet ((entries (kind) (mapcan (lambda (clause) (copy-list (rest clause)))
                                       (clauses kind))))
          (let* ((part-clauses (clauses :fixture :item :robot))
                 (parts (parse #'parse-part part-clauses))
                 (parameters (parse #'parse-parameter (entries :parameters)))
                 (tolerances (parse #'parse-tolerance (entries :tolerances)))
                 (materials (parse #'parse-material (entries :materials)))
                 (scene (make-scene :name (source:name-keyword name) :documentation documentation
                                    :file (source:native-name file) :parts parts
                                    :materials materials :parameters parameters
                                    :tolerances tolerances)))
            (check-parts part-clauses file)
            (check-distinct (entries :parameters) "parameters" file)
            (check-distinct (entries :tolerances) "tolerances" file)
            (check-distinct (entries :materials) "materials" file)
            (check-tolerances tolerances parameters materials (entries :tolerances) file)
            (check-materials scene)
            scene))))))

(defun load-scene (file &key (package-path *package-path*))
  "Return the SCENE in FILE.  Nothing in it is evaluated.  PACKAGE-PATH is a list of folders in
which the packages of package:// names in URDF files are looked for before others.  Signals
SOURCE-ERROR, SCENE-ERROR or URDF-ERROR, which name the file."
  (let ((forms (source:read-source file :package '#:discrepancy-finder.projection))
        (*package-path* package-path))
    (unless (and (= (length forms) 1) (consp (first forms))
                 (symbolp (first (first forms)))
                 (string= (first (first forms)) "DEFINE-SCENE")
                 (consp (rest (first forms)))
                 (parameter-name-p (second (first forms))))
      (error 'scene-error :file (source:native-name file)
                          :reason "one form (define-scene name clause*) was expected"))
    (parse-scene (first forms) file)))
