;;;; The map: a top view of the scene with regions, samples and the paths driven.
;;;;
;;;; From the bottom to the top: fixtures, regions, the paths of passing samples, that of the
;;;; failing one with the steps along it, where robot and items began and ended, the samples.  A
;;;; sample is a dot for each body that it places: blue if it passed, a red cross if it failed.

(in-package #:discrepancy-finder.report)

(defparameter *map-width* 860
  "Maps are at most so many pixels wide.")

(defparameter *map-height* 580
  "Maps are at most so many pixels high.")

(defparameter *gutter* 34
  "The space in pixels for numbers to the left of a map; below there is less.")

(defparameter *map-margin* 0.35d0
  "The space (m) around what a map must show.")

;;; Samples as points

(defun sampled-bodies (sample)
  "Return the list of the bodies of which SAMPLE draws x or y."
  (remove-duplicates
   (loop for parameter in (discrepancy:sample-parameters sample)
         for body = (discrepancy:parameter-body parameter)
         when (and (keywordp body)
                   (member (discrepancy:parameter-axis parameter) '(:x :y))
                   (< (discrepancy:parameter-min parameter) (discrepancy:parameter-max parameter)))
           collect body)
   :from-end t))

(defun sample-points (scene sample)
  "Return the list of (x y) of the bodies that SAMPLE places in SCENE."
  (let ((poses (discrepancy:sample-poses scene sample)))
    (loop for body in (sampled-bodies sample)
          for pose = (getf poses body)
          collect (list (pose-x pose) (pose-y pose)))))

(defun sample-title (sample verdict)
  (format nil "sample ~d ~a: ~a" (discrepancy:sample-index sample)
          (ecase verdict (:passed "passed") (:failed "failed") (:left "left the trace"))
          (discrepancy:sample-text sample)))

(defun sample-nodes (sheet scene sample verdict)
  (loop for point in (sample-points scene sample)
        for title = (sample-title sample verdict)
        collect (ecase verdict
                  (:failed (cross-node sheet point title 6 :class "failed"))
                  (:passed (dot-node sheet point title :r 3.5 :class "passed"))
                  (:left (dot-node sheet point title :r 3.5 :class "left")))))

;;; The scene

(defun outline-nodes (sheet outlines roles class)
  "Return the polygons of those of OUTLINES that have one of ROLES."
  (loop for (role nil points) in outlines
        when (member role roles)
          collect (polygon-node sheet points :class class)))

(defun item-nodes (sheet outlines class)
  "Return the polygons of the items among OUTLINES; those that CLASS names as they began are filled
with their colours."
  (loop for (role name points color) in outlines
        when (eq role :item)
          collect (polygon-node sheet points
                                :class class
                                :style (if (string= class "after")
                                           (format nil "stroke:~a" color)
                                           (format nil "fill:~a;stroke:~:*~a" color)))))

(defun polygon-area (points)
  (/ (abs (loop for ((x0 y0) (x1 y1)) on (append points (list (first points)))
                while x1 sum (- (* x0 y1) (* x1 y0))))
     2))

(defun largest-outline-node (sheet outlines role class)
  "Return the polygon of the largest of OUTLINES that have ROLE, or NIL: of a robot, its base."
  (let ((ours (loop for (its-role nil points) in outlines
                    when (eq its-role role) collect points)))
    (and ours
         (polygon-node sheet (reduce (lambda (a b)
                                       (if (> (polygon-area b) (polygon-area a)) b a))
                                     ours)
                       :class class))))

(defun outlines-named (outlines role)
  "Return the list of (name low high) of the parts of the scene among OUTLINES that have ROLE."
  (loop for name in (remove-duplicates (loop for (its-role name) in outlines
                                             when (eq its-role role) collect name)
                                       :from-end t)
        collect (cons name
                      (multiple-value-list
                       (points-bounds (loop for (its-role its-name points) in outlines
                                            when (and (eq its-role role) (eq its-name name))
                                              append points))))))

(defun middle (low high)
  (mapcar (lambda (a b) (/ (+ a b) 2)) low high))

(defun visible-point-p (sheet point)
  (destructuring-bind ((x y) (x0 y0) (x1 y1)) (list point (sheet-low sheet) (sheet-high sheet))
    (and (< x0 x x1) (< y0 y y1))))

(defun fixture-labels (sheet outlines)
  (loop for (name low high) in (outlines-named outlines :fixture)
        for (x y) = (middle low high)
        when (and name (visible-point-p sheet (list x y)))
          collect (make-label (pixel-x sheet x) (pixel-y sheet y) (string-downcase name)
                              "fixture" "middle")))

(defun item-labels (sheet outlines)
  (loop for (name low high) in (outlines-named outlines :item)
        collect (make-label (pixel-x sheet (/ (+ (first low) (first high)) 2))
                            (- (pixel-y sheet (second high)) 6)
                            (string-downcase name) "item" "middle")))

(defun item-obstacles (sheet outlines)
  "Return the places of items where no label is to be, as LABEL-NODES takes them."
  (loop for (nil low high) in (outlines-named outlines :item)
        for (x y) = (middle low high)
        collect (list (- (pixel-x sheet x) 6) (+ (pixel-x sheet x) 6) (+ 5 (pixel-y sheet y)))))

(defun moved-fixtures (before after)
  "Return those of the outlines AFTER of fixtures that are none BEFORE: drawers that were opened."
  (flet ((same-p (one other)
           (and (eq (second one) (second other))
                (= (length (third one)) (length (third other)))
                (every (lambda (point other-point)
                         (every (lambda (a b) (< (abs (- a b)) 1d-3)) point other-point))
                       (third one) (third other)))))
    (loop for outline in after
          when (and (eq (first outline) :fixture)
                    (notany (lambda (other) (same-p outline other)) before))
            collect outline)))

;;; Regions

(defun regions-of-trace (domain trace)
  "Return the regions of DOMAIN that a state of TRACE names."
  (let ((named (loop for state in (symbolic:trace-states trace)
                     append (reduce #'append (ec:state-fluents state)))))
    (remove-if-not (lambda (region) (member (discrepancy:region-name region) named))
                   (discrepancy:domain-regions domain))))

(defun region-nodes (sheet regions)
  "Return the polygons of REGIONS."
  (loop for region in regions
        append (loop for (kind . points) in (region-polygons region (sheet-low sheet)
                                                             (sheet-high sheet))
                     collect (polygon-node sheet points
                                           :class (format nil "region ~(~a~)" kind)))))

(defun region-labels (sheet regions)
  "Return the names of REGIONS, each in the upper left corner of its polygon."
  (loop for region in regions
        for ((nil . points)) = (region-polygons region (sheet-low sheet) (sheet-high sheet))
        when points
          collect (multiple-value-bind (low high) (points-bounds points)
                    (make-label (+ 6 (pixel-x sheet (first low)))
                                (+ 14 (pixel-y sheet (second high)))
                                (string-downcase (discrepancy:region-name region))
                                "region-name" "start"))))

;;; Paths

(defun trail-points (trail)
  (loop for (x y) in trail collect (list x y)))

(defun trail-node (sheet trail class)
  (and (rest trail)
       (line-node sheet (trail-points trail) :class class)))

(defun grouped-stops (sheet stops)
  "Return a list of (place number...) of the STOPS, a list of places, that can be told apart."
  (let ((groups '()))
    (loop for (x y) in stops
          for number from 1
          for px = (pixel-x sheet x)
          for py = (pixel-y sheet y)
          for group = (find-if (lambda (group)
                                 (destructuring-bind (gx gy) (first group)
                                   (and (< (abs (- px gx)) 16) (< (abs (- py gy)) 16))))
                               groups)
          do (if group
                 (push number (rest group))
                 (setf groups (append groups (list (list (list px py) number))))))
    (loop for (place . numbers) in groups collect (cons place (reverse numbers)))))

(defun numbers-text (numbers)
  "Return NUMBERS, ascending integers, as a text in which ranges are written as such; of more than
four ranges some in the middle are left out."
  (let ((ranges '()))
    (dolist (number numbers)
      (if (and ranges (= number (1+ (cdr (first ranges)))))
          (setf (cdr (first ranges)) number)
          (push (cons number number) ranges)))
    (let ((texts (loop for (from . to) in (reverse ranges)
                       collect (if (= from to)
                                   (format nil "~d" from)
                                   (format nil "~d–~d" from to)))))
      (format nil "~{~a~^, ~}"
              (if (> (length texts) 4)
                  (append (subseq texts 0 2) '("…") (last texts))
                  texts)))))

(defun stop-nodes (sheet stops diverging)
  "Return marks at the places of the base in STOPS; that of step DIVERGING, if any, stands out."
  (loop for ((x y) . numbers) in (grouped-stops sheet stops)
        collect `(:circle (:cx ,x :cy ,y :r 4 :class ,(if (member diverging numbers)
                                                          "stop diverging"
                                                          "stop")))))

(defun stop-labels (sheet stops diverging)
  "Return the numbers of the steps at the places of the base in STOPS."
  (loop for ((x y) . numbers) in (grouped-stops sheet stops)
        collect (make-label x (+ y 18) (numbers-text numbers)
                            (if (member diverging numbers)
                                "stop-number diverging"
                                "stop-number")
                            "middle")))

;;; The whole

(defun map-bounds (outlines points)
  "Return the corners of what a map shows: POINTS, robot and items with a margin, but not more than
the scene."
  (multiple-value-bind (low high)
      (points-bounds (append points
                             (loop for (role nil points) in outlines
                                   when (member role '(:robot :item)) append points)))
    (multiple-value-bind (low high) (widened low high *map-margin*)
      (values low high))))

(defun grid-nodes (sheet)
  "Return lines at whole and half metres with numbers at the edge."
  (destructuring-bind ((x0 y0) (x1 y1)) (list (sheet-low sheet) (sheet-high sheet))
    (let ((step (cond ((> (sheet-scale sheet) 150) 1/2) ((> (sheet-scale sheet) 45) 1) (t 5)))
          (lines '()) (numbers '()))
      (flet ((positions (from to)
               (loop for i from (ceiling from step) to (floor to step) collect (* i step)))
             (number (position)
               (value-string (float position 1d0))))
        (dolist (x (positions x0 x1))
          (push (line-node sheet (list (list x y0) (list x y1)) :class "grid") lines)
          (push `(:text (:x ,(pixel-x sheet x) :y ,(+ (sheet-height sheet) 15)
                         "text-anchor" "middle" :class "tick")
                        ,(number x))
                numbers))
        (dolist (y (positions y0 y1))
          (push (line-node sheet (list (list x0 y) (list x1 y)) :class "grid") lines)
          (push `(:text (:x -6 :y ,(+ 4 (pixel-y sheet y)) "text-anchor" "end" :class "tick")
                        ,(number y))
                numbers)))
      (list lines numbers))))

(defun map-node (domain trace shots diverging)
  "Return the map, a node, of SHOTS of TRACE.  The first of SHOTS is drawn in full; DIVERGING is the
number of the step at which it parts from the theory, counted from 1, or NIL."
  (let* ((main (first shots))
         (scene (discrepancy:domain-scene domain))
         (outlines (shot-before main))
         (points (loop for shot in shots
                       append (sample-points scene (shot-sample shot))
                       append (trail-points (shot-trail shot)))))
    (multiple-value-bind (low high) (map-bounds (append outlines (shot-after main)) points)
      (let* ((sheet (fitting-sheet low high *map-width* *map-height*))
             (regions (regions-of-trace domain trace)))
        (framed-map sheet
                    (list
                     (first (grid-nodes sheet))
                     (outline-nodes sheet outlines '(:fixture) "fixture-outline")
                     (outline-nodes sheet outlines '(:wall) "wall-outline")
                     (region-nodes sheet regions)
                     (outline-nodes sheet outlines '(:robot) "robot-outline")
                     (item-nodes sheet outlines "before")
                     (loop for shot in (rest shots)
                           collect (trail-node sheet (shot-trail shot) "trail"))
                     (outline-nodes sheet (moved-fixtures outlines (shot-after main))
                                    '(:fixture) "robot-after")
                     (largest-outline-node sheet (shot-after main) :robot "robot-after")
                     (item-nodes sheet (shot-after main) "after")
                     (trail-node sheet (shot-trail main)
                                 (if diverging "trail failing" "trail main"))
                     (stop-nodes sheet (shot-stops main) diverging)
                     (loop for shot in (reverse shots)
                           collect (sample-nodes sheet scene (shot-sample shot)
                                                 (shot-verdict shot)))
                     (label-nodes (append (item-labels sheet outlines)
                                          (stop-labels sheet (shot-stops main) diverging)
                                          (region-labels sheet regions)
                                          (fixture-labels sheet outlines))
                                  (sheet-height sheet)
                                  (item-obstacles sheet outlines))))))))

(defun framed-map (sheet layers)
  "Return the map with LAYERS, the lowest first, on SHEET, with numbers at its left and lower edge."
  (let ((width (sheet-width sheet)) (height (sheet-height sheet)))
    `(:svg (:class "map" :role "img"
            :aria-label "Top view of the scene with regions, samples and paths"
            :width ,(round (+ width *gutter*)) :height ,(round (+ height 22))
            "viewBox" ,(format nil "~d 0 ~,1f ~,1f" (- *gutter*) (+ width *gutter*)
                               (+ height 22)))
       ,(second (grid-nodes sheet))
       (:svg (:width ,width :height ,height)
         (:rect (:width ,width :height ,height :class "ground"))
         ,(loop for layer in layers collect `(:g () ,layer)))
       (:rect (:x 0.5 :y 0.5 :width ,(- width 1) :height ,(- height 1) :class "frame")))))
