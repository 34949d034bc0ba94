;;;; Sheets: from metres to pixels.
;;;;
;;;; A SHEET shows a rectangle of the ground, y upwards.  The functions here return nodes of SVG for
;;;; points in metres.

(in-package #:discrepancy-finder.report)

(defstruct (sheet (:copier nil))
  "SCALE is in pixels a metre; LOW and HIGH are the corners, lists of x and y (m)."
  (scale 1d0 :type double-float :read-only t)
  (low '(0d0 0d0) :type list :read-only t)
  (high '(1d0 1d0) :type list :read-only t))

(defun fitting-sheet (low high width height)
  "Return the sheet that shows what is between LOW and HIGH within WIDTH and HEIGHT pixels."
  (make-sheet :scale (float (min (/ width (- (first high) (first low)))
                                 (/ height (- (second high) (second low))))
                            1d0)
              :low low :high high))

(defun sheet-width (sheet)
  (* (sheet-scale sheet) (- (first (sheet-high sheet)) (first (sheet-low sheet)))))

(defun sheet-height (sheet)
  (* (sheet-scale sheet) (- (second (sheet-high sheet)) (second (sheet-low sheet)))))

(defun pixel-x (sheet x)
  (* (sheet-scale sheet) (- x (first (sheet-low sheet)))))

(defun pixel-y (sheet y)
  (* (sheet-scale sheet) (- (second (sheet-high sheet)) y)))

(defun points-text (sheet points)
  (format nil "~{~,1f,~,1f~^ ~}"
          (loop for (x y) in points collect (pixel-x sheet x) collect (pixel-y sheet y))))

(defun polygon-node (sheet points &rest attributes)
  `(:polygon (:points ,(points-text sheet points) ,@attributes)))

(defun line-node (sheet points &rest attributes)
  `(:polyline (:points ,(points-text sheet points) ,@attributes)))

(defun text-node (sheet x y text &rest attributes)
  "Return a text at X, Y, with a white rim to keep it legible on lines."
  `(:text (:x ,(pixel-x sheet x) :y ,(pixel-y sheet y) ,@attributes) ,text))

(defun dot-node (sheet point title &rest attributes)
  `(:circle (:cx ,(pixel-x sheet (first point)) :cy ,(pixel-y sheet (second point)) ,@attributes)
            (:title () ,title)))

(defun cross-node (sheet point title size &rest attributes)
  "Return a cross at POINT, SIZE pixels from the middle to the end of an arm."
  (let ((x (pixel-x sheet (first point))) (y (pixel-y sheet (second point))))
    (flet ((cross (size &rest attributes)
             `(:path (:d ,(format nil "M~,1f,~,1fL~,1f,~,1fM~,1f,~,1fL~,1f,~,1f"
                                  (- x size) (- y size) (+ x size) (+ y size)
                                  (- x size) (+ y size) (+ x size) (- y size))
                      ,@attributes)
                     (:title () ,title))))
      (list (cross size :class "halo") (apply #'cross size attributes)))))

;;; Rectangles of the ground

(defun points-bounds (points)
  "Return the corners of the smallest rectangle that holds POINTS, which must not be empty."
  (values (list (reduce #'min points :key #'first) (reduce #'min points :key #'second))
          (list (reduce #'max points :key #'first) (reduce #'max points :key #'second))))

(defun widened (low high margin)
  (values (mapcar (lambda (number) (- number margin)) low)
          (mapcar (lambda (number) (+ number margin)) high)))

(defun clipped (points low high)
  "Return the polygon POINTS as far as it lies between LOW and HIGH, or NIL: each side of the
rectangle cuts it in turn."
  (loop for (axis bound sign) in `((0 ,(first low) 1) (0 ,(first high) -1)
                                   (1 ,(second low) 1) (1 ,(second high) -1))
        do (setf points (half-polygon points axis bound sign)))
  points)

(defun half-polygon (points axis bound sign)
  "Return the part of the polygon POINTS where SIGN times the coordinate AXIS (0 or 1) is at least
SIGN times BOUND."
  (flet ((depth (point) (* sign (- (nth axis point) bound))))
    (loop for (one next) on (append points (list (first points)))
          while next
          for from = (depth one)
          for to = (depth next)
          when (>= from 0) collect one
          when (minusp (* from to))
            collect (let ((part (/ from (- from to))))
                      (mapcar (lambda (a b) (+ a (* part (- b a)))) one next)))))
