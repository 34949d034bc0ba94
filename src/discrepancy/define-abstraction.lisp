;;;; Reading DEFINE-ABSTRACTION forms.

(in-package #:discrepancy-finder.discrepancy)

(defun abstraction-problem (name clause control &rest arguments)
  (error 'abstraction-error :name name :clause clause
                            :reason (apply #'format nil control arguments)))

(defun bounds-problem (name clause entry)
  (abstraction-problem name clause "~a was found where (axis min max) was expected, with an axis ~
                                    :x, :y, :z or :yaw"
                       (ec:formula-text entry)))

(defun parse-bounds (name clause entries)
  "Return the list of (axis min max) written as ENTRIES, lists of an axis and two numbers."
  (loop for entry in entries
        collect
        (source:destructuring-or (axis min max) entry (bounds-problem name clause entry)
          (unless (and (assoc axis *axes*) (realp min) (realp max))
            (bounds-problem name clause entry))
          (unless (< min max)
            (abstraction-problem name clause "a region of no volume: ~(~s~) from ~a to ~a"
                                 axis min max))
          (list axis (decimal-double min) (decimal-double max)))))

(defun region-problem (name clause)
  (abstraction-problem name clause "(:region name (interval axis min max)) or ~
                                    (:region name (box (axis min max)*)) was expected"))

(defun parse-region (name clause)
  (source:destructuring-or (region-name description) (rest clause) (region-problem name clause)
    (unless (and (symbolp region-name) region-name (consp description))
      (region-problem name clause))
    (let ((kind (first description)))
      (make-region (ec:name-keyword region-name)
                   (cond ((and (symbolp kind) (string= kind "INTERVAL"))
                          (parse-bounds name clause (list (rest description))))
                         ((and (symbolp kind) (string= kind "BOX") (rest description))
                          (parse-bounds name clause (rest description)))
                         (t (abstraction-problem name clause "~a is no kind of region; interval ~
                                                              and box are"
                                                 (ec:formula-text kind))))))))

(defun regions-overlap-p (one other)
  (loop for (axis min max) in (region-bounds one)
        for (nil other-min other-max) = (assoc axis (region-bounds other))
        always (or (null other-min) (and (< min other-max) (< other-min max)))))

(defun check-disjoint (name regions)
  (loop for (one . others) on regions
        do (dolist (other others)
             (when (regions-overlap-p one other)
               (abstraction-problem name nil "the regions ~a and ~a overlap"
                                    (ec:name-text (region-name one))
                                    (ec:name-text (region-name other)))))))

(defun parse-coordinate (name clause entry regions)
  "Return (axis min max) for ENTRY: an axis that every region of REGIONS bounds, or (axis min max)."
  (let* ((axis (first (alexandria:ensure-list entry)))
         (axis (and (symbolp axis) (ec:name-keyword axis))))
    (cond ((and (consp entry) (rest entry))
           (first (parse-bounds name clause (list (cons axis (rest entry))))))
          ((not (assoc axis *axes*))
           (abstraction-problem name clause "~a is no coordinate; x, y, z and yaw are"
                                (ec:formula-text entry)))
          ((every (lambda (region) (assoc axis (region-bounds region))) regions)
           (list axis nil nil))
          (t (abstraction-problem name clause "the coordinate ~(~a~) is bounded by no region and ~
                                               needs a range, (~:*~(~a~) min max)" axis)))))

(defun parse-coordinates (name clause entries regions)
  (let ((coordinates (loop for entry in entries
                           collect (parse-coordinate name clause entry regions))))
    (unless (= (length coordinates)
               (length (remove-duplicates (mapcar #'first coordinates))))
      (abstraction-problem name clause "a coordinate stands twice"))
    coordinates))

(defun placement-declaration (name clause pattern theory)
  "Return the declaration of the fluent in PATTERN, which must be (fluent ?sort)."
  (let ((declaration (and (consp pattern) (symbolp (first pattern))
                          (assoc (ec:name-keyword (first pattern)) (ec:theory-fluents theory)))))
    (unless (and declaration (= (length pattern) 2 (length declaration)))
      (abstraction-problem name clause "~a is no fluent of a region in theory ~a"
                           (ec:formula-text pattern) (ec:name-text (ec:theory-name theory))))
    (unless (and (symbolp (second pattern))
                 (string= (symbol-name (second pattern))
                          (format nil "?~a" (symbol-name (second declaration)))))
      (abstraction-problem name clause "~a was found where ?~a was expected"
                           (ec:formula-text (second pattern))
                           (ec:name-text (second declaration))))
    declaration))

(defun parse-placement (name clause theory scene regions)
  (source:destructuring-or (pattern &key body coordinates) (rest clause)
      (abstraction-problem name clause "(:placement (fluent ?region) :body name :coordinates ~
                                        (coordinate*)) was expected")
    (let ((declaration (placement-declaration name clause pattern theory)))
      (unless (and (symbolp body) body (consp coordinates))
        (abstraction-problem name clause ":body and :coordinates are needed"))
      (handler-case (projection:check-movable scene body)
        (projection:unknown-body ()
          (abstraction-problem name clause "the scene has no robot and no item ~a"
                               (ec:name-text body))))
      (let ((candidates (loop for element in (ec:sort-elements theory (second declaration))
                              collect (or (find element regions :key #'region-name)
                                          (abstraction-problem
                                           name clause "there is no (:region ~a ...)"
                                           (ec:name-text element))))))
        (check-disjoint name candidates)
        (make-placement :fluent (first declaration) :body (ec:name-keyword body)
                        :regions candidates
                        :coordinates (parse-coordinates name clause coordinates candidates))))))

(defun parse-attachment (name clause theory scene)
  (source:destructuring-or (atom &key item) (rest clause)
      (abstraction-problem name clause "(:attachment (fluent) :item name) was expected")
    (let ((atom (and (consp atom) (mapcar #'ec:name-keyword atom))))
      (unless (and atom (assoc (first atom) (ec:theory-fluents theory))
                   (= (length atom) (length (assoc (first atom) (ec:theory-fluents theory)))))
        (abstraction-problem name clause "~a is no ground fluent of theory ~a"
                             (ec:formula-text atom) (ec:name-text (ec:theory-name theory))))
      (when (some (lambda (term) (char= #\? (char (symbol-name term) 0))) (rest atom))
        (abstraction-problem name clause "~a is not ground" (ec:formula-text atom)))
      (unless (and (symbolp item) (member (ec:name-keyword item)
                                          (projection:scene-item-names scene)))
        (abstraction-problem name clause "the scene has no item ~a" (ec:formula-text item)))
      (make-attachment :atom atom :item (ec:name-keyword item)))))

(defun relative-file (file directory)
  (source:native-name (if directory
                          (merge-pathnames (source:native-path file) directory)
                          file)))

(defun check-clauses (name clauses)
  (dolist (clause clauses)
    (unless (and (consp clause)
                 (member (first clause) '(:theory :scene :region :placement :attachment)))
      (abstraction-problem name nil "~a was found where one of :theory, :scene, :region, ~
                                     :placement, :attachment was expected"
                           (ec:formula-text (if (consp clause) (first clause) clause)))))
  (dolist (key '(:theory :scene))
    (unless (= (count key clauses :key #'first) 1)
      (abstraction-problem name nil "exactly one clause (~(~s~) ...) is needed" key)))
  (let ((theory (second (assoc :theory clauses))))
    (unless (or (stringp theory) (and theory (symbolp theory)))
      (abstraction-problem name (assoc :theory clauses) "a name or a file name was expected")))
  (unless (stringp (second (assoc :scene clauses)))
    (abstraction-problem name (assoc :scene clauses) "a file name was expected"))
  ;; Each region, and each fluent that is observed, is defined once.
  (let ((seen '()))
    (loop for (key subject) in clauses
          for name-of = (if (consp subject) (first subject) subject)
          do (when (and (member key '(:region :placement :attachment)) (symbolp name-of))
               (let ((entry (list (if (eq key :region) :region :observer)
                                  (symbol-name name-of)
                                  (and (eq key :attachment) (rest subject)))))
                 (when (member entry seen :test #'equal)
                   (abstraction-problem name nil "~a is defined twice" (ec:name-text name-of)))
                 (push entry seen))))))

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
         :observers (append (loop for clause in (clauses :placement)
                                  collect (parse-placement name clause theory scene regions))
                            (loop for clause in (clauses :attachment)
                                  collect (parse-attachment name clause theory scene))))))))

(defmacro define-abstraction (name &body clauses)
  "Define the domain NAME.  CLAUSES are an optional documentation string and
  (:theory NAME-or-\"file\")   the theory
  (:scene \"file\")            the scene
  (:region NAME (interval axis min max)) or (:region NAME (box (axis min max)*))
  (:placement (FLUENT ?region) :body NAME :coordinates (coordinate*))
                              the fluent holds of the region in which the body is; a coordinate is
                              an axis that regions bound, or (axis min max); these are sampled
  (:attachment (FLUENT element*) :item NAME)
                              the fluent holds if the robot holds the item
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
