;;;; The top view as SVG: outlines of everything, seen from above, with names.
;;;;
;;;; Chunks are drawn from the lowest to the highest.  Items are drawn once more on top of all as
;;;; dashed outlines, so that one sees those that are under or in something.  The lines of the grid
;;;; are one metre apart.  The robot has an arrow to where its base points.

(in-package #:discrepancy-finder.projection)

(defparameter *margin* 0.25d0
  "The space (m) around what a top view shows.")

(defun chunk-outline (chunk)
  "Return the corners of the outline of CHUNK as seen from above, lists of x and y (m)."
  (loop for (x y) on (coerce (planar-hull (loop for corner in (chunk-corners chunk)
                                                collect (cons (pose-x corner) (pose-y corner))))
                             'list)
        by #'cddr
        collect (list x y)))

(defun chunk-top (chunk)
  "Return the height (m) of the highest corner of CHUNK."
  (third (nth-value 1 (corners-bounds (chunk-corners chunk)))))

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

(defun draw-chunk (sheet chunk)
  (draw-polygon sheet (chunk-outline chunk)
                (format nil "fill=\"~a\" fill-opacity=\"~a\" stroke=\"~a\" stroke-width=\"1\""
                        (color-text (chunk-color chunk))
                        (if (eq (chunk-role chunk) :item) "1" "0.85")
                        (color-text (chunk-color chunk) 0.6d0))))

(defun outlines-middle (chunks)
  "Return the middle of the rectangle around CHUNKS as seen from above, a list of x and y (m)."
  (multiple-value-bind (low high) (corners-bounds (mapcan #'chunk-corners chunks))
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

(defun named-groups (chunks role)
  "Return the list of (name chunk...) of those of CHUNKS that have ROLE, in their order."
  (let ((groups '()))
    (dolist (chunk chunks (mapcar (lambda (group) (cons (first group) (reverse (rest group))))
                                  (reverse groups)))
      (when (and (eq (chunk-role chunk) role) (chunk-name chunk) (not (wall-p chunk)))
        (let ((group (assoc (chunk-name chunk) groups)))
          (if group
              (push chunk (rest group))
              (push (list (chunk-name chunk) chunk) groups)))))))

(defun draw-names (sheet projection chunks)
  (flet ((name-text (name) (string-downcase name)))
    (loop for (name . group) in (named-groups chunks :fixture)
          do (draw-text sheet (outlines-middle group) (name-text name) :size 12))
    (when (projection-robot projection)
      (draw-robot-arrow sheet projection))
    (loop for (name . group) in (named-groups chunks :item)
          do (dolist (chunk group)
               (draw-polygon sheet (chunk-outline chunk)
                             (format nil "fill=\"none\" stroke=\"~a\" stroke-width=\"1\" ~
                                          stroke-dasharray=\"3 2\""
                                     (color-text (chunk-color chunk) 0.7d0))))
             (destructuring-bind (x y) (outlines-middle group)
               (draw-text sheet (list x (+ y (/ 14 (sheet-scale sheet)))) (name-text name))))))

(defun top-view-bounds (chunks)
  "Return the corners of what a top view of CHUNKS shows: lists of x and y (m)."
  (multiple-value-bind (low high)
      (corners-bounds (or (mapcan #'chunk-corners chunks) (list (point-pose 0 0 0))))
    (values (list (- (first low) *margin*) (- (second low) *margin*))
            (list (+ (first high) *margin*) (+ (second high) *margin*)))))

(defun below-ceilings (chunks)
  "Return CHUNKS without the walls that lie above everything else."
  (let ((top (make-pose 0 0 1000)))
    (remove-if (lambda (chunk)
                 (and (wall-p chunk)
                      (loop for face in (near-faces (enclosing-faces
                                                     (cons chunk (contents chunks)))
                                                    top)
                            thereis (< (third face) -0.7d0))))
               chunks)))

(defun outlines-from-above (projection)
  "Return the outlines of what is in PROJECTION, as it is now, as seen from above, the lowest first:
a list of (role name points color), where the role is :ITEM, :ROBOT or :FIXTURE, the name that of
the part of the scene, points a list of (x y) in m, and the color a text such as #d0b090.  Walls
have the role :WALL; ground and ceilings are left out."
  (loop for chunk in (stable-sort (below-ceilings (remove :ground (projection-chunks projection)
                                                          :key #'chunk-role))
                                  #'< :key #'chunk-top)
        collect (list (if (wall-p chunk) :wall (chunk-role chunk)) (chunk-name chunk)
                      (chunk-outline chunk) (color-text (chunk-color chunk)))))

(defun draw-top-view (projection chunks width stream)
  "Write the top view of PROJECTION, with CHUNKS, as an SVG file WIDTH pixels wide to STREAM."
  (multiple-value-bind (low high) (top-view-bounds chunks)
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
      (dolist (chunk (stable-sort (below-ceilings chunks) #'< :key #'chunk-top))
        (draw-chunk sheet chunk))
      (draw-names sheet projection chunks)
      (draw-grid-numbers sheet low high)
      (format stream "</svg>~%"))))
