;;;; Tests of the projection layer: where hands can take hold of things.

(in-package #:discrepancy-finder.tests)

(def-suite manipulation :in all)
(in-suite manipulation)

(defparameter *test-hand*
  (projection::make-hand
   :palm (list (list (geometry:make-pose -0.11 0 0) '(:box 0.08d0 0.13d0 0.05d0)))
   :fingers (list (list (geometry:make-pose -0.03 0.051 0) '(:box 0.08d0 0.012d0 0.024d0))
                  (list (geometry:make-pose -0.03 -0.051 0) '(:box 0.08d0 0.012d0 0.024d0)))
   :opening 0.09d0 :reach 0.067d0 :tip 0.01d0)
  "An open hand of two fingers 8 cm long and 9 cm apart.")

(defun grasps-of (shape)
  (projection::find-grasps *test-hand* shape))

(defun sides-of (shape)
  (remove-duplicates (mapcar #'projection::grasp-side (grasps-of shape))))

(defun closing-axis (grasp)
  (projection::turned (projection::grasp-tool grasp) '(0d0 1d0 0d0)))

(test a-box-is-grasped-across-its-thin-side-only
  "Cereal is 14.7 x 5.8 x 22.4 cm: two fingers 9 cm apart fit over y alone."
  (let ((grasps (grasps-of '(:box 0.147d0 0.058d0 0.224d0))))
    (is (null (set-difference '(:top :front :back)
                              (mapcar #'projection::grasp-side grasps))))
    (dolist (grasp grasps)
      (is (nearly 1 (abs (second (closing-axis grasp))) 1d-9)))
    (is (not (member :left-side (mapcar #'projection::grasp-side grasps))))))

(test what-is-too-wide-is-not-grasped
  (is (null (grasps-of '(:box 0.09d0 0.09d0 0.09d0))) "no finger has its clearance")
  (is (null (grasps-of '(:sphere 0.05d0))))
  (is-true (grasps-of '(:sphere 0.04d0)))
  (is (null (set-exclusive-or '(:top :bottom :front :back :left-side :right-side)
                              (sides-of '(:box 0.06d0 0.06d0 0.06d0))))))

(defun bowl-shape (radius)
  "Return a bottom and ten walls 6 mm thick around it."
  (list* :compound
         (list (geometry:make-pose 0 0 -0.03) (list :cylinder (- radius 0.01d0) 0.006d0))
         (loop for step below 10
               collect (list (geometry:compose (geometry:make-pose 0 0 0 :yaw (* step pi 0.2))
                                               (geometry:make-pose radius 0 0))
                             '(:box 0.006d0 0.045d0 0.06d0)))))

(test a-bowl-is-grasped-at-its-rim
  (let ((top (remove :top (grasps-of (bowl-shape 0.068d0))
                     :key #'projection::grasp-side :test-not #'eq)))
    (is (>= (length top) 10))
    (dolist (grasp top)
      (destructuring-bind (x y z) (projection::pose-position (projection::grasp-tool grasp))
        (declare (ignore z))
        (is (nearly 0.068 (sqrt (+ (* x x) (* y y))) 0.02) "it is over the wall")))))

(test hands-stay-off-what-is-behind
  "The tips of the fingers do not reach beyond the far side, where a table may be."
  (dolist (shape '((:box 0.2d0 0.02d0 0.01d0) (:cylinder 0.03d0 0.02d0)
                   (:box 0.147d0 0.058d0 0.224d0)))
    (dolist (grasp (grasps-of shape))
      (let* ((tool (projection::grasp-tool grasp))
             (approach (projection::turned tool '(1d0 0d0 0d0)))
             (tip (projection::pose-position (projection::advanced tool 0.01d0))))
        (is (< (projection::dot tip approach) (projection::support shape approach)))))))

(test extents-of-shapes
  (flet ((support (shape &rest direction)
           (projection::support shape (projection::unit direction))))
    (is (nearly 1/2 (support '(:box 1 2 3) 1 0 0) 1d-12))
    (is (nearly (/ 3 (sqrt 2)) (support '(:box 3 3 3) 1 1 0) 1d-6))
    (is (nearly 2 (support '(:sphere 2) 1 2 3) 1d-6))
    (is (nearly 1 (support '(:cylinder 1 4) 1 0 0) 1d-12))
    (is (nearly 2 (support '(:cylinder 1 4) 0 0 1) 1d-12))
    (is (nearly 3 (support '(:hull (1 0 0) (0 3 0) (0 0 1) (-1 -1 -1)) 0 1 0) 1d-12))
    (is (nearly 6 (support (list :compound (list (geometry:make-pose 5 0 0 :yaw (/ pi 2))
                                                 '(:box 4 2 1)))
                           1 0 0)
                1d-9))))

(test a-frame-has-the-axes-that-it-was-made-of
  (loop for (x y) in '(((1 0 0) (0 1 0)) ((-1 0 0) (0 1 0)) ((0 0 -1) (0 1 0)) ((0 1 0) (-1 0 0))
                       ((0 0 1) (0 -1 0)) ((-1 0 0) (0 0 1)) ((0.6 0.8 0) (0.8 -0.6 0))
                       ((0 -0.6 0.8) (1 0 0)))
        for pose = (projection::axes-pose '(1 2 3) x y)
        do (is (every (lambda (a b) (nearly a b 1d-6)) x (projection::turned pose '(1 0 0))))
           (is (every (lambda (a b) (nearly a b 1d-6)) y (projection::turned pose '(0 1 0))))
           (is (equal '(1d0 2d0 3d0) (projection::pose-position pose)))))
