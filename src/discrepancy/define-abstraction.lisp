;;;; The DEFINE-ABSTRACTION form, and files of domains.

(in-package #:discrepancy-finder.discrepancy)

(defun relative-file (file directory)
  (source:native-name (if directory
                          (merge-pathnames (source:native-path file) directory)
                          file)))

(defun check-clauses (name clauses)
  (dolist (clause clauses)
    (unless (and (consp clause)
                 (member (first clause) '(:theory :scene :region :placement :joint :attachment
                                          :computed)))
      (abstraction-problem name nil "~a was found where one of :theory, :scene, :region, ~
                                     :placement, :joint, :attachment, :computed was expected"
                           (ec:formula-text (if (consp clause) (first clause) clause)))))
  (dolist (key '(:theory :scene))
    (unless (= (count key clauses :key #'first) 1)
      (abstraction-problem name nil "exactly one clause (~(~s~) ...) is needed" key)))
  (let ((theory (second (assoc :theory clauses))))
    (unless (or (stringp theory) (and theory (symbolp theory)))
      (abstraction-problem name (assoc :theory clauses) "a name or a file name was expected")))
  (unless (stringp (second (assoc :scene clauses)))
    (abstraction-problem name (assoc :scene clauses) "a file name was expected"))
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
                                    (cons :computed
                                          (lambda (clause)
                                            (parse-computed name clause theory))))
                         append (loop for clause in clauses
                                      when (eq (first clause) key)
                                        append (funcall parser clause)))))
    (check-once name (observed-atoms observers) #'ec:atom-text)
    observers))

(defun parse-abstraction (name clauses &key file)
  "Return the domain NAME that CLAUSES describe; file names in them are relative to FILE."
  (let ((documentation (and (stringp (first clauses)) (pop clauses))))
    (check-clauses name clauses)
    (flet ((clauses (key) (remove key clauses :key #'first :test-not #'eq)))
      (let* ((theory-name (second (first (clauses :theory))))
             (theory (if (stringp theory-name)
                         (ec:load-theory (relative-file theory-name file))
                         (ec:find-theory theory-name)))
             (scene (projection:load-scene
                     (relative-file (second (first (clauses :scene))) file)))
             (regions (mapcar (lambda (clause) (parse-region name clause)) (clauses :region))))
        (make-instance
         'domain
         :name (ec:name-keyword name) :documentation documentation :theory theory :scene scene
         :regions regions :file (and file (source:native-name file))
         :observers (parse-observers name clauses theory scene regions))))))

(defmacro define-abstraction (name &body clauses)
  "Define the domain NAME.  CLAUSES are an optional documentation string and
  (:theory NAME-or-\"file\")   the theory
  (:scene \"file\")            the scene
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
  (:computed (FLUENT term*) FUNCTION)
                              the fluent holds if FUNCTION returns true of the projection and the
                              fluent's arguments; it is observed and not sampled
Axes are x, y, z (m) and yaw (rad).  Files are relative to the file that is loaded.  Action bindings
are added by DEFINE-ACTION.  Signals ABSTRACTION-ERROR, THEORY-ERROR, SCENE-ERROR, URDF-ERROR."
  `(symbolic:register-action-theory
    (parse-abstraction ',name ',clauses :file *load-pathname*)))

(defun load-domain (file)
  "Load FILE, which defines a domain with DEFINE-ABSTRACTION and DEFINE-ACTION in the package
DISCREPANCY-FINDER-USER, and return the domain.  Signals SOURCE-ERROR, which names file and line,
and what DEFINE-ABSTRACTION signals."
  (let ((before (symbolic:all-action-theories)))
    (source:load-source file :package '#:discrepancy-finder-user)
    (let ((new (set-difference (symbolic:all-action-theories) before)))
      (or (first new)
          (error 'source:source-error :file (source:native-name file)
                                      :reason "it defines no domain (define-abstraction ...)")))))
