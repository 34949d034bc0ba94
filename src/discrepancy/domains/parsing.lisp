;;;; Reading regions and observers as they are written in DEFINE-ABSTRACTION.

(in-package #:discrepancy-finder.discrepancy)

(defun abstraction-problem (name clause control &rest arguments)
  (error 'abstraction-error :name name :clause clause
                            :reason (apply #'format nil control arguments)))

(defun kind-name (form)
  "Return the keyword of the symbol that FORM, a list, begins with, or NIL."
  (and (consp form) (first form) (symbolp (first form)) (ec:name-keyword (first form))))

;;; Regions

(defun bounds-problem (name clause entry)
  (abstraction-problem name clause "~a was found where (axis min max) was expected, with an axis ~
                                    :x, :y, :z or :yaw"
                       (ec:formula-text entry)))

(defun parse-bounds (name clause entries)
  "Return the list of (axis min max) written as ENTRIES, lists of an axis and two numbers."
  (loop for entry in entries
        collect
        (source:destructuring-or (axis min max) entry (bounds-problem name clause entry)
          (let ((axis (and axis (symbolp axis) (ec:name-keyword axis))))
            (unless (and (assoc axis *axes*) (realp min) (realp max))
              (bounds-problem name clause entry))
            (unless (< min max)
              (abstraction-problem name clause "a region of no volume: ~(~s~) from ~a to ~a"
                                   axis min max))
            (list axis (decimal-double min) (decimal-double max))))))

(defun convex-p (corners)
  "Return true if the polygon with CORNERS turns one way only, and once around."
  (let* ((edges (loop for ((ax ay) (bx by)) on (append corners (list (first corners)))
                      while bx collect (list (- bx ax) (- by ay))))
         (turns (loop for ((ax ay) (bx by)) on (append edges (list (first edges)))
                      while bx
                      collect (atan (- (* ax by) (* ay bx)) (+ (* ax bx) (* ay by))))))
    (and (or (every #'plusp turns) (every #'minusp turns))
         (< (abs (- (abs (reduce #'+ turns)) (* 2 pi))) 1d-6))))

(defun parse-corners (name clause entries)
  (let ((corners (loop for entry in entries
                       collect (if (and (alexandria:proper-list-p entry) (= (length entry) 2)
                                        (every #'realp entry))
                                   (mapcar #'decimal-double entry)
                                   (abstraction-problem name clause "~a was found where a corner ~
                                                                     (x y) was expected"
                                                        (ec:formula-text entry))))))
    (unless (and (<= 3 (length corners)) (convex-p corners))
      (abstraction-problem name clause "a polygon needs three corners or more in order, and must ~
                                        be convex; a union takes several"))
    corners))

(defun parse-description (name clause form)
  "Return the description of a region that is written as FORM."
  (let ((kind (kind-name form)) (parts (and (consp form) (rest form))))
    (flet ((descriptions (forms)
             (or (mapcar (lambda (part) (parse-description name clause part)) forms)
                 (abstraction-problem name clause "~(~a~) of no regions" kind))))
      (unless (alexandria:proper-list-p parts)
        (region-problem name clause))
      (case kind
        (:interval (cons :box (parse-bounds name clause (list parts))))
        (:box (unless parts (region-problem name clause))
         (cons :box (parse-bounds name clause parts)))
        (:polygon (cons :polygon (parse-corners name clause parts)))
        ((:union :intersection :difference) (cons kind (descriptions parts)))
        (:where (unless (and (= (length parts) 2) (second parts) (symbolp (second parts)))
                  (abstraction-problem name clause "(where region function-name) was expected"))
         (list :where (parse-description name clause (first parts)) (second parts)))
        (t (abstraction-problem name clause "~a is no kind of region; interval, box, polygon, ~
                                             union, intersection, difference and where are"
                                (ec:formula-text (if (consp form) (first form) form))))))))

(defun region-problem (name clause)
  (abstraction-problem name clause "(:region name (interval axis min max)), (:region name (box ~
                                    (axis min max)*)) or another region was expected"))

(defun parse-region (name clause)
  (source:destructuring-or (region-name form) (rest clause) (region-problem name clause)
    (unless (and (symbolp region-name) region-name (consp form))
      (region-problem name clause))
    (let* ((region (make-region (ec:name-keyword region-name)
                                (parse-description name clause form)))
           (empty (find-if (lambda (entry) (>= (second entry) (third entry)))
                           (region-bounds region))))
      (when empty
        (abstraction-problem name clause "nothing is in it: ~(~a~) would be from ~a to ~a"
                             (first empty) (second empty) (third empty)))
      region)))

(defconstant +lattice+ 20
  "Regions that are no boxes are compared at so many values of x, and of y.")

(defun common-pose (one other)
  "Return a pose that is in both regions, or NIL if none was found: of two boxes it is certain,
otherwise a lattice is tried."
  (let ((bounds (narrowest-bounds (list (region-bounds one) (region-bounds other)))))
    (when (every (lambda (entry) (< (second entry) (third entry))) bounds)
      (flet ((value (axis part)
               (destructuring-bind (&optional (min 0d0) (max 0d0)) (rest (assoc axis bounds))
                 (+ min (* part (- max min))))))
        (if (and (region-box-p one) (region-box-p other))
            (make-pose (value :x 0.5d0) (value :y 0.5d0) (value :z 0.5d0) :yaw (value :yaw 0.5d0))
            (loop for i below +lattice+
                  do (loop for j below +lattice+
                           for pose = (make-pose (value :x (/ (+ i 0.5d0) +lattice+))
                                                 (value :y (/ (+ j 0.5d0) +lattice+))
                                                 (value :z 0.5d0) :yaw (value :yaw 0.5d0))
                           do (when (and (inside-region-p pose one) (inside-region-p pose other))
                                (return-from common-pose pose)))))))))

(defun check-disjoint (name regions)
  (loop for (one . others) on regions
        do (dolist (other others)
             (when (common-pose one other)
               (abstraction-problem name nil "the regions ~a and ~a overlap"
                                    (ec:name-text (region-name one))
                                    (ec:name-text (region-name other)))))))

;;; Fluents

(defun variable-name-p (term)
  (and term (symbolp term) (char= #\? (char (symbol-name term) 0))))

(defun parse-pattern (name clause pattern theory)
  "Return the fluent written as PATTERN with keywords, and the sorts of its arguments: constants are
elements of their sorts, variables are ?sort."
  (let* ((text (ec:formula-text pattern))
         (declaration (and (kind-name pattern) (alexandria:proper-list-p pattern)
                           (assoc (kind-name pattern) (ec:theory-fluents theory)))))
    (unless (and declaration (= (length pattern) (length declaration)))
      (abstraction-problem name clause "~a is no fluent of theory ~a" text
                           (ec:name-text (ec:theory-name theory))))
    (loop for term in (rest pattern)
          for sort in (rest declaration)
          do (cond ((variable-name-p term)
                    (unless (string= (symbol-name term) (format nil "?~a" (symbol-name sort)))
                      (abstraction-problem name clause "~a was found where ?~a was expected"
                                           (ec:formula-text term) (ec:name-text sort))))
                   ((not (and term (symbolp term)
                              (member (ec:name-keyword term) (ec:sort-elements theory sort))))
                    (abstraction-problem name clause "~a in ~a is no element of the sort ~a"
                                         (ec:formula-text term) text (ec:name-text sort)))))
    (values (mapcar #'ec:name-keyword pattern) (rest declaration))))

(defun ground-patterns (pattern sorts theory)
  "Return the instances of PATTERN, whose arguments are of SORTS: a list of (atom . bindings)."
  (let ((instances (list (list (list (first pattern))))))
    (loop for term in (rest pattern)
          for sort in sorts
          do (setf instances
                   (loop for (atom . bindings) in instances
                         append (if (variable-name-p term)
                                    (loop for element in (ec:sort-elements theory sort)
                                          collect (cons (append atom (list element))
                                                        (acons term element bindings)))
                                    (list (cons (append atom (list term)) bindings))))))
    instances))

(defun parse-ground (name clause pattern theory)
  "Return the ground fluent written as PATTERN."
  (let ((atom (parse-pattern name clause pattern theory)))
    (when (some #'variable-name-p (rest atom))
      (abstraction-problem name clause "~a is not ground" (ec:formula-text pattern)))
    atom))
