;;;; The DEFINE-ABSTRACTION form, and files of domains.

(in-package #:discrepancy-finder.discrepancy)

(defun relative-file (file directory)
  (source:native-name (if directory
                          (merge-pathnames (source:native-path file) directory)
                          file)))

(defun clauses-of (key clauses)
  (remove key clauses :key #'first :test-not #'eq))

(defun check-clauses (name clauses)
  (dolist (clause clauses)
    (unless (and (consp clause)
                 (member (first clause) '(:extends :items :theory :scene :region :placement :joint
                                          :attachment :coordinate :computed)))
      (abstraction-problem name nil "~a was found where one of :extends, :items, :theory, :scene, ~
                                     :region, :placement, :joint, :attachment, :coordinate, ~
                                     :computed was expected"
                           (ec:formula-text (if (consp clause) (first clause) clause)))))
  (dolist (key '(:extends :items))
    (when (rest (clauses-of key clauses))
      (abstraction-problem name nil "there are two clauses (~(~s~) ...)" key)))
  (loop for (key type expected) in '((:theory (or symbol string) "a name or a file name")
                                     (:scene string "a file name"))
        for found = (clauses-of key clauses)
        do (unless (or (= (length found) 1)
                       (and (null found) (clauses-of :extends clauses)))
             (abstraction-problem name nil "exactly one clause (~(~s~) ...) is needed" key))
           (dolist (clause found)
             (unless (and (second clause) (typep (second clause) type))
               (abstraction-problem name clause "~a was expected" expected))))
  (let ((names (loop for (key subject) in clauses
                     when (and (eq key :region) (symbolp subject))
                       collect (ec:name-keyword subject))))
    (check-once name names (lambda (region) (ec:name-text region)))))

(defun check-once (name things text)
  "Signal ABSTRACTION-ERROR if one of THINGS stands there twice; TEXT tells its name."
  (let ((twice (find-if (lambda (thing) (< 1 (count thing things :test #'equal))) things)))
    (when twice
      (abstraction-problem name nil "~a is defined twice" (funcall text twice)))))

(defun observed-atoms (observers)
  (loop for observer in observers
        append (etypecase observer
                 (placement (loop for region in (placement-regions observer)
                                  collect (placement-atom observer region)))
                 (joint-range (list (joint-range-atom observer)))
                 (attachment (list (attachment-atom observer)))
                 (coordinate-range (list (coordinate-range-atom observer)))
                 (computed (list (computed-atom observer))))))

(defun parse-observers (name clauses theory scene regions)
  "Return the observers that CLAUSES describe, placements first."
  (let ((observers (loop for (key . parser)
                           in (list (cons :placement
                                          (lambda (clause)
                                            (list (parse-placement name clause theory scene
                                                                   regions))))
                                    (cons :joint
                                          (lambda (clause)
                                            (list (parse-joint-range name clause theory scene))))
                                    (cons :attachment
                                          (lambda (clause)
                                            (parse-attachments name clause theory scene)))
                                    (cons :coordinate
                                          (lambda (clause)
                                            (list (parse-coordinate-range name clause theory
                                                                          scene))))
                                    (cons :computed
                                          (lambda (clause)
                                            (parse-computed name clause theory))))
                         append (loop for clause in clauses
                                      when (eq (first clause) key)
                                        append (funcall parser clause)))))
    (check-once name (observed-atoms observers) #'ec:atom-text)
    observers))

(defun clause-theory (clause file extended)
  "Return the theory that CLAUSE, (:theory NAME-or-\"file\"), means; NIL means that of EXTENDED."
  (let ((theory (second clause)))
    (cond ((null clause) (symbolic:action-theory-theory extended))
          ((stringp theory) (ec:load-theory (relative-file theory file)))
          (t (ec:find-theory theory)))))

(defun clause-scene (clause file extended)
  "Return the scene that CLAUSE, (:scene \"file\"), means; NIL means that of EXTENDED."
  (if clause
      (projection:load-scene (relative-file (second clause) file))
      (domain-scene extended)))

(defun parse-abstraction (name clauses &key file)
  "Return the domain NAME that CLAUSES describe; file names in them are relative to FILE."
  (let ((documentation (and (stringp (first clauses)) (pop clauses))))
    (check-clauses name clauses)
    (let* ((extended (extended-domain name (first (clauses-of :extends clauses)) file))
           (theory (clause-theory (first (clauses-of :theory clauses)) file extended))
           (scene (scene-of-items
                   name (first (clauses-of :items clauses))
                   (clause-scene (first (clauses-of :scene clauses)) file extended)))
           (clauses (remove-if (lambda (clause)
                                 (member (first clause) '(:extends :items :theory :scene)))
                               clauses))
           (clauses (if extended
                        (append (inherited-clauses extended clauses theory scene) clauses)
                        clauses))
           (regions (mapcar (lambda (clause) (parse-region name clause))
                            (clauses-of :region clauses))))
      (make-instance
       'domain
       :name (ec:name-keyword name) :documentation documentation :theory theory :scene scene
       :regions regions :file (and file (source:native-name file)) :clauses clauses
       :extended-files (and extended (remove nil (cons (domain-file extended)
                                                       (domain-extended-files extended))))
       :actions (and extended (copy-list (symbolic:action-theory-actions extended)))
       :observers (parse-observers name clauses theory scene regions)))))

(defmacro define-abstraction (name &body clauses)
  "Define the domain NAME.  CLAUSES are an optional documentation string and
  (:extends NAME-or-\"file\")  another domain, whose theory, scene, regions, observers and action
                              bindings this one has where it gives no others
  (:theory NAME-or-\"file\")   the theory
  (:scene \"file\")            the scene
  (:items NAME*)              the scene's items that are there; without it all are
  (:region NAME region)       where a region is one of (interval axis min max),
                              (box (axis min max)*), (polygon (x y)*) if convex, (union region*),
                              (intersection region*), (difference region region*),
                              (where region function-of-a-pose)
  (:placement (FLUENT ?sort) :body NAME :coordinates (coordinate*))
                              the fluent holds of the region, named as an element of the sort, in
                              which the body is; other arguments are elements.  A coordinate is an
                              axis that regions bound, (axis min max), (axis (middle width)),
                              which is as wide in the middle of the region, or (axis value); all but
                              the last are sampled
  (:joint (FLUENT element*) :joint \"name\" :range (min max) [:otherwise (min max)])
                              the fluent holds if the joint's position is in the range; where no
                              fluent of the joint holds it is drawn from the other one
  (:attachment (FLUENT term*) :item NAME [:arm NAME])
                              the fluent holds if the robot holds the item (with this arm); terms
                              and names may be variables ?sort: then for each element
  (:coordinate (FLUENT element*) :body NAME :axis axis :range (min max))
                              the fluent holds if the coordinate of the body is in [min, max[; it
                              is observed, and samples are drawn until it is as it has to be
  (:computed (FLUENT term*) FUNCTION)
                              the fluent holds if FUNCTION returns true of the projection and the
                              fluent's arguments; it is observed and not sampled
Axes are x, y, z (m) and yaw (rad).  Files are relative to the file that is loaded.  Action bindings
are added by DEFINE-ACTION.  Signals ABSTRACTION-ERROR, THEORY-ERROR, SCENE-ERROR, URDF-ERROR."
  `(symbolic:register-action-theory
    (parse-abstraction ',name ',clauses :file *load-pathname*)))

(defun domain-truename (domain)
  "Return the true name of the file that defines DOMAIN, or NIL."
  (and (typep domain 'domain) (domain-file domain)
       (ignore-errors (truename (source:native-path (domain-file domain))))))

(defun load-domain (file)
  "Load FILE, which defines a domain with DEFINE-ABSTRACTION and DEFINE-ACTION in the package
DISCREPANCY-FINDER-USER, and return the domain; a symbol means the file of the catalog that defines
the domain of this name.  Signals SOURCE-ERROR, which names file and line, DOMAIN-NOT-FOUND, and
what DEFINE-ABSTRACTION signals."
  (let ((file (if (symbolp file) (domain-file-named file) file))
        (before (symbolic:all-action-theories)))
    (source:load-source file :package '#:discrepancy-finder-user)
    (let ((new (set-difference (symbolic:all-action-theories) before)))
      ;; What the file extends may be new, too.
      (or (find (truename (source:native-path file)) new :test #'equal :key #'domain-truename)
          (first new)
          (error 'source:source-error :file (source:native-name file)
                                      :reason "it defines no domain (define-abstraction ...)")))))
