;;;; The top view as SVG: outlines of everything, seen from above, with names.
;;;;
;;;; Solids are drawn from the lowest to the highest.  Items are drawn once more on top of all as
;;;; dashed outlines, so that one sees those that are under or in something.  The lines of the grid
;;;; are one metre apart.  The robot has an arrow to where its base points.

(in-package #:discrepancy-finder.projection)

(defparameter *margin* 0.25d0
  "The space (m) around what a top view shows.")

(defun left-turn (a b c)
  "Return twice the area of the triangle of the points A, B, C, negative if it turns right."
  (- (* (- (first b) (first a)) (- (second c) (second a)))
     (* (- (second b) (second a)) (- (first c) (first a)))))

(defun convex-outline (points)
  "Return the corners of the convex hull of POINTS, lists of x and y, counter-clockwise."
  (flet ((before-p (a b)
           (or (< (first a) (first b))
               (and (= (first a) (first b)) (< (second a) (second b)))))
         (chain (points)
           (let ((chain '()))
             (dolist (point points (reverse (rest chain)))
               (loop while (and (rest chain)
                                (<= (left-turn (second chain) (first chain) point) 1d-12))
                     do (pop chain))
               (push point chain)))))
    (let ((sorted (sort (copy-list points) #'before-p)))
      (append (chain sorted) (chain (reverse sorted))))))

(defun solid-outline (solid)
  "Return the corners of the outline of SOLID as seen from above, lists of x and y (m)."
  (convex-outline (loop for corner in (solid-corners solid)
                        collect (list (pose-x corner) (pose-y corner)))))

(defun solid-top (solid)
  "Return the height (m) of the highest corner of SOLID."
  (third (nth-value 1 (corners-bounds (solid-corners solid)))))

(defun color-text (color &optional (factor 1))
  (format nil "#~(~{~2,'0x~}~)"
          (loop for part in color collect (floor (* 255.99d0 (min 1d0 (* factor part)))))))

(defstruct (sheet (:copier nil))
  "A drawing on STREAM in pixels: SCALE (pixels a metre), the least x and the largest y (m)."
  (stream nil :read-only t)
  (scale 1d0 :type double-float :read-only t)
  (left 0d0 :type double-float :read-only t)
  (top 0d0 :type double-float :read-only t))

(defun place-on-sheet (sheet point)
  "Return the text of the place, in pixels, of POINT, a list of x and y (m)."
  (format nil "~,1f,~,1f"
          (* (sheet-scale sheet) (- (first point) (sheet-left sheet)))
          (* (sheet-scale sheet) (- (sheet-top sheet) (second point)))))

(defun draw-polygon (sheet points style)
  (format (sheet-stream sheet) "<polygon points=\"~{~a~^ ~}\" ~a/>~%"
          (loop for point in points collect (place-on-sheet sheet point)) style))

(defun draw-path (sheet points style)
  (format (sheet-stream sheet) "<polyline points=\"~{~a~^ ~}\" fill=\"none\" ~a/>~%"
          (loop for point in points collect (place-on-sheet sheet point)) style))

(defun draw-text (sheet point text &key (size 13) (anchor "middle"))
  (let* ((place (place-on-sheet sheet point)) (comma (position #\, place)))
    (format (sheet-stream sheet)
            "<text x=\"~a\" y=\"~a\" font-size=\"~d\" text-anchor=\"~a\" dy=\"0.35em\" ~
             stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\">~a</text>~%"
            (subseq place 0 comma) (subseq place (1+ comma)) size anchor (escaped-text text))))

(defun escaped-text (text)
  "Return TEXT with what has a meaning in XML written as references."
  (with-output-to-string (stream)
    (loop for character across text
          do (case character
               (#\& (write-string "&amp;" stream))
               (#\< (write-string "&lt;" stream))
               (#\> (write-string "&gt;" stream))
               (t (write-char (if (graphic-char-p character) character #\?) stream))))))

(defun draw-grid (sheet low high)
  "Draw lines at whole metres between LOW and HIGH, lists of x and y, with their numbers."
  (destructuring-bind ((x0 y0) (x1 y1)) (list low high)
    (let ((style "stroke=\"#c8ccd0\" stroke-width=\"1\""))
      (loop for x from (ceiling x0) to (floor x1)
            do (draw-path sheet (list (list x y0) (list x y1)) style))
      (loop for y from (ceiling y0) to (floor y1)
            do (draw-path sheet (list (list x0 y) (list x1 y)) style)))))

(defun draw-grid-numbers (sheet low high)
  (destructuring-bind ((x0 y0) (x1 y1)) (list low high)
    (let ((inside (/ 10 (sheet-scale sheet))))
      (loop for x from (ceiling x0) to (floor x1)
            do (draw-text sheet (list x (+ y0 inside)) (format nil "~d" x) :size 11))
      (loop for y from (ceiling y0) to (floor y1)
            do (draw-text sheet (list (+ x0 inside) y) (format nil "~d" y) :size 11)))))

(defun draw-solid (sheet solid)
  (draw-polygon sheet (solid-outline solid)
                (format nil "fill=\"~a\" fill-opacity=\"~a\" stroke=\"~a\" stroke-width=\"1\""
                        (color-text (solid-color solid))
                        (if (eq (solid-role solid) :item) "1" "0.85")
                        (color-text (solid-color solid) 0.6d0))))

(defun outlines-middle (solids)
  "Return the middle of the rectangle around SOLIDS as seen from above, a list of x and y (m)."
  (multiple-value-bind (low high) (corners-bounds (mapcan #'solid-corners solids))
    (list (/ (+ (first low) (first high)) 2) (/ (+ (second low) (second high)) 2))))

(defun draw-robot-arrow (sheet projection)
  "Draw an arrow from the middle of the robot's base forwards."
  (let ((base (base-pose (projection-robot projection))))
    (flet ((at (x y)
             (let ((point (compose base (point-pose x y 0))))
               (list (pose-x point) (pose-y point)))))
      (draw-path sheet (list (at 0 0) (at 0.3d0 0) (at 0.22d0 0.06d0) (at 0.3d0 0)
                             (at 0.22d0 -0.06d0))
                 "stroke=\"#223\" stroke-width=\"2\""))))

(defun named-groups (solids role)
  "Return the list of (name solid...) of those of SOLIDS that have ROLE, in their order."
  (let ((groups '()))
    (dolist (solid solids (mapcar (lambda (group) (cons (first group) (reverse (rest group))))
                                  (reverse groups)))
      (when (and (eq (solid-role solid) role) (solid-name solid) (not (wall-p solid)))
        (let ((group (assoc (solid-name solid) groups)))
          (if group
              (push solid (rest group))
              (push (list (solid-name solid) solid) groups)))))))

(defun draw-names (sheet projection solids)
  (flet ((name-text (name) (string-downcase name)))
    (loop for (name . group) in (named-groups solids :fixture)
          do (draw-text sheet (outlines-middle group) (name-text name) :size 12))
    (when (projection-robot projection)
      (draw-robot-arrow sheet projection))
    (loop for (name . group) in (named-groups solids :item)
          do (dolist (solid group)
               (draw-polygon sheet (solid-outline solid)
                             (format nil "fill=\"none\" stroke=\"~a\" stroke-width=\"1\" ~
                                          stroke-dasharray=\"3 2\""
                                     (color-text (solid-color solid) 0.7d0))))
             (destructuring-bind (x y) (outlines-middle group)
               (draw-text sheet (list x (+ y (/ 14 (sheet-scale sheet)))) (name-text name))))))

(defun top-view-bounds (solids)
  "Return the corners of what a top view of SOLIDS shows: lists of x and y (m)."
  (multiple-value-bind (low high)
      (corners-bounds (or (mapcan #'solid-corners solids) (list (point-pose 0 0 0))))
    (values (list (- (first low) *margin*) (- (second low) *margin*))
            (list (+ (first high) *margin*) (+ (second high) *margin*)))))

(defun below-ceilings (solids)
  "Return SOLIDS without the walls that lie above everything else."
  (let ((top (make-pose 0 0 1000)))
    (remove-if (lambda (solid)
                 (and (wall-p solid)
                      (loop for face in (near-faces (enclosing-faces
                                                     (cons solid (contents solids)))
                                                    top)
                            thereis (< (third face) -0.7d0))))
               solids)))

(defun draw-top-view (projection solids width stream)
  "Write the top view of PROJECTION, with SOLIDS, as an SVG file WIDTH pixels wide to STREAM."
  (multiple-value-bind (low high) (top-view-bounds solids)
    (let* ((scale (/ width (- (first high) (first low))))
           (height (ceiling (* scale (- (second high) (second low)))))
           (sheet (make-sheet :stream stream :scale (float scale 1d0)
                              :left (float (first low) 1d0) :top (float (second high) 1d0))))
      (format stream "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"~d\" height=\"~d\" ~
                      viewBox=\"0 0 ~:*~:*~d ~d\" font-family=\"sans-serif\">~%~
                      <title>~a, ~,2f s</title>~%~
                      <rect width=\"100%\" height=\"100%\" fill=\"#f4f5f6\"/>~%"
              width height
              (escaped-text (string-downcase (scene-name (projection-scene projection))))
              (simulated-seconds projection))
      (draw-grid sheet low high)
      (dolist (solid (stable-sort (below-ceilings solids) #'< :key #'solid-top))
        (draw-solid sheet solid))
      (draw-names sheet projection solids)
      (draw-grid-numbers sheet low high)
      (format stream "</svg>~%"))))
