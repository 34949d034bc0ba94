;;;; Labels of a map, placed so that none covers another.
;;;;
;;;; Labels are placed one after the other, the important ones first; one that would lie on another
;;;; goes down, line by line, and is left out if there is no place nearby.

(in-package #:discrepancy-finder.report)

(defstruct (label (:constructor make-label (x y text class anchor)) (:copier nil))
  "TEXT at the pixels X and Y of its base line, of the style CLASS; ANCHOR is \"start\" or
\"middle\"."
  (x 0d0 :type real :read-only t)
  (y 0d0 :type real :read-only t)
  (text "" :type string :read-only t)
  (class "" :type string :read-only t)
  (anchor "middle" :type string :read-only t))

(defparameter *label-line* 15
  "The height of a label in pixels.")

(defun label-extent (label y)
  "Return the least and the largest x, in pixels, of LABEL, and its Y."
  (let ((width (* 6.8d0 (length (label-text label)))))
    (if (string= (label-anchor label) "middle")
        (list (- (label-x label) (/ width 2)) (+ (label-x label) (/ width 2)) y)
        (list (label-x label) (+ (label-x label) width) y))))

(defun extents-overlap-p (one other)
  (destructuring-bind ((x0 x1 y) (u0 u1 v)) (list one other)
    (and (< x0 u1) (< u0 x1) (< (abs (- y v)) (- *label-line* 2)))))

(defun label-nodes (labels height obstacles)
  "Return the texts of LABELS on a map of HEIGHT pixels, none of them on one of the OBSTACLES, a
list of (least-x largest-x y) in pixels."
  (let ((taken obstacles))
    (loop for label in labels
          for place = (loop for line from 0 to 4
                            for y = (+ (label-y label) (* line *label-line*))
                            for extent = (label-extent label y)
                            when (and (< 8 y (- height 3))
                                      (notany (lambda (other) (extents-overlap-p extent other))
                                              taken))
                              return extent)
          when place
            do (push place taken)
            and collect `(:text (:x ,(label-x label) :y ,(third place)
                                 :class ,(label-class label)
                                 "text-anchor" ,(label-anchor label))
                                ,(label-text label)))))
