;;;; Regions: sets of poses.
;;;;
;;;; A REGION has a description, which is one of
;;;;   (:box (axis min max)*)             bounds some of the coordinates x, y, z (m) and yaw (rad)
;;;;   (:polygon (x y)*)                  a convex polygon, its corners in m
;;;;   (:intersection description*) (:union description*)
;;;;   (:difference description without*) what is in the first and in none of the others
;;;;   (:where description name)          what the function NAME says yes to
;;;; A region is half-open, so that a border that two regions share belongs to one of them.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *axes* '((:x . pose-x) (:y . pose-y) (:z . pose-z) (:yaw . pose-yaw))
  "The coordinates that regions may bound, and their readers.")

(defun coordinate (pose axis)
  "Return the coordinate AXIS (:x, :y, :z in m, :yaw in rad) of POSE."
  (funcall (cdr (assoc axis *axes*)) pose))

;;; Inside

(defun inside-polygon-p (x y corners)
  "Return true if the point X, Y lies in the polygon with CORNERS, a list of (x y): a ray to the
right crosses its border an odd number of times.  Of two polygons with a common side a point on it
lies in one."
  (let ((inside nil))
    (loop for (a b) on (cons (first (last corners)) corners)
          while b
          do (unless (eq (> (second a) y) (> (second b) y))
               ;; From below, whichever way the border runs: so a common side has the same bits.
               (destructuring-bind ((low-x low-y) (high-x high-y))
                   (if (< (second a) (second b)) (list a b) (list b a))
                 (when (< x (+ low-x (/ (* (- high-x low-x) (- y low-y)) (- high-y low-y))))
                   (setf inside (not inside))))))
    inside))

(defun inside-description-p (pose description)
  (destructuring-bind (kind . parts) description
    (flet ((inside-p (part) (inside-description-p pose part)))
      (ecase kind
        (:box (loop for (axis min max) in parts
                    always (and (<= min (coordinate pose axis)) (< (coordinate pose axis) max))))
        (:polygon (inside-polygon-p (pose-x pose) (pose-y pose) parts))
        (:intersection (every #'inside-p parts))
        (:union (some #'inside-p parts))
        (:difference (and (inside-p (first parts)) (notany #'inside-p (rest parts))))
        (:where (and (inside-p (first parts)) (funcall (second parts) pose) t))))))

;;; The smallest box around

(defun common-bounds (all-bounds)
  "Return bounds that hold all boxes of ALL-BOUNDS."
  (loop for (axis) in (first all-bounds)
        for entries = (loop for bounds in all-bounds collect (assoc axis bounds))
        when (every #'identity entries)
          collect (list axis (reduce #'min entries :key #'second)
                        (reduce #'max entries :key #'third))))

(defun narrowest-bounds (all-bounds)
  "Return the bounds of what is in all boxes of ALL-BOUNDS."
  (let ((entries (reduce #'append all-bounds)))
    (loop for axis in (remove-duplicates (mapcar #'first entries) :from-end t)
          for ours = (remove axis entries :key #'first :test-not #'eq)
          collect (list axis (reduce #'max ours :key #'second) (reduce #'min ours :key #'third)))))

(defun description-bounds (description)
  "Return the bounds of a box, a list of (axis min max), around what DESCRIPTION describes."
  (destructuring-bind (kind . parts) description
    (ecase kind
      (:box parts)
      (:polygon (loop for axis in '(:x :y)
                      for reader in (list #'first #'second)
                      collect (list axis (reduce #'min parts :key reader)
                                    (reduce #'max parts :key reader))))
      (:intersection (narrowest-bounds (mapcar #'description-bounds parts)))
      (:union (common-bounds (mapcar #'description-bounds parts)))
      ((:difference :where) (description-bounds (first parts))))))

(defun bounds-overlap-p (one other)
  "Return true if the boxes with the bounds ONE and OTHER have a point in common."
  (loop for (axis min max) in one
        for (nil other-min other-max) = (assoc axis other)
        always (or (null other-min) (and (< min other-max) (< other-min max)))))

(defun box-inside-p (bounds description)
  "Return true if it is certain that the closed box with BOUNDS lies in what DESCRIPTION describes,
borders included."
  (destructuring-bind (kind . parts) description
    (flet ((inside-p (part) (box-inside-p bounds part)))
      (ecase kind
        (:box (loop for (axis min max) in parts
                    for (nil low high) = (assoc axis bounds)
                    always (and low (<= min low) (<= high max))))
        (:polygon (destructuring-bind (&optional x-low x-high) (rest (assoc :x bounds))
                    (destructuring-bind (&optional y-low y-high) (rest (assoc :y bounds))
                      (and x-low y-low
                           (loop for (x y) in (list (list x-low y-low) (list x-low y-high)
                                                    (list x-high y-low) (list x-high y-high))
                                 always (inside-polygon-p x y parts))))))
        (:intersection (every #'inside-p parts))
        (:union (some #'inside-p parts))
        (:difference (and (inside-p (first parts))
                          (notany (lambda (part)
                                    (bounds-overlap-p bounds (description-bounds part)))
                                  (rest parts))))
        (:where nil)))))

;;; Regions

(defstruct (region (:constructor make-region (name description
                                              &aux (bounds (description-bounds description))))
                   (:copier nil))
  "What DESCRIPTION describes, named NAME."
  (name nil :type keyword :read-only t)
  (description nil :type list :read-only t)
  (bounds '() :type list :read-only t))

(setf (documentation 'region-name 'function)
      "Return the name of a region, a keyword."
      (documentation 'region-description 'function)
      "Return the description of a region, such as (:box (:x 0d0 1d0))."
      (documentation 'region-bounds 'function)
      "Return the bounds of the box around a region: a list of (axis min max).")

(defun description-text (description)
  (destructuring-bind (kind . parts) description
    (ecase kind
      (:box (format nil "~:{~(~a~) in [~a, ~a[~:^, ~}" parts))
      (:polygon (format nil "a polygon of ~d corners" (length parts)))
      ((:intersection :union :difference)
       (format nil "(~(~a~)~{ ~a~})" kind (mapcar #'description-text parts)))
      (:where (format nil "(~a where ~(~a~))" (description-text (first parts)) (second parts))))))

(defmethod print-object ((region region) stream)
  (print-unreadable-object (region stream :type t)
    (format stream "~a ~a" (ec:name-text (region-name region))
            (description-text (region-description region)))))

(defun region-box-p (region)
  "Return true if REGION is the box that its bounds tell."
  (eq (first (region-description region)) :box))

(defun inside-region-p (pose region)
  "Return true if POSE lies in REGION."
  (inside-description-p pose (region-description region)))
