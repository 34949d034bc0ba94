;;;; Regions as polygons.
;;;;
;;;; REGION-POLYGONS returns what of a region can be seen from above: a list of (kind . points),
;;;; where the kind is :INSIDE, :WITHOUT for what a difference cuts out, or :AROUND where only the
;;;; rectangle around it is known.  What a region does not bound reaches to the edge of the picture.

(in-package #:discrepancy-finder.report)

(defun rectangle (bounds low high)
  "Return the corners of the rectangle with BOUNDS, a list of (axis min max), between LOW and HIGH."
  (flet ((range (axis place)
           (or (rest (assoc axis bounds)) (list (nth place low) (nth place high)))))
    (destructuring-bind ((x0 x1) (y0 y1)) (list (range :x 0) (range :y 1))
      (list (list x0 y0) (list x1 y0) (list x1 y1) (list x0 y1)))))

(defun description-polygons (description low high)
  (destructuring-bind (kind . parts) description
    (flet ((polygons (part) (description-polygons part low high)))
      (ecase kind
        (:box (list (cons :inside (rectangle parts low high))))
        (:polygon (list (cons :inside parts)))
        (:union (mapcan #'polygons parts))
        (:intersection (intersection-polygons (mapcar #'polygons parts)))
        (:difference (append (polygons (first parts))
                             (loop for part in (rest parts)
                                   append (loop for (nil . points) in (polygons part)
                                                collect (cons :without points)))))
        (:where (loop for (nil . points) in (polygons (first parts))
                      collect (cons :around points)))))))

(defun intersection-polygons (parts)
  "Return the polygons of the intersection of PARTS, lists of polygons.  Where two of them are no
rectangles, the rectangle around both is shown."
  (if (every (lambda (polygons) (null (rest polygons))) parts)
      (let ((points (rest (first (first parts)))) (exact t))
        (loop for ((nil . other)) in (rest parts)
              do (unless (rectangle-p other)
                   (if (rectangle-p points)
                       (rotatef points other)
                       (setf exact nil)))
                 (multiple-value-bind (low high) (points-bounds other)
                   (setf points (clipped points low high))))
        (and points (list (cons (if exact :inside :around) points))))
      (mapcan #'copy-list parts)))

(defun rectangle-p (points)
  (and (= (length points) 4)
       (= 2 (length (remove-duplicates (mapcar #'first points))))
       (= 2 (length (remove-duplicates (mapcar #'second points))))))

(defun region-polygons (region low high)
  "Return the polygons of REGION between LOW and HIGH, as above."
  (loop for (kind . points) in (description-polygons (discrepancy:region-description region)
                                                     low high)
        for visible = (clipped points low high)
        when visible collect (cons kind visible)))
