;;;; Tests of what a robot sees and where it looks: hulls, frames, directions, joint positions,
;;;; several items, places and errors.

(in-package #:discrepancy-finder.tests)

(in-suite perception)

;;; Hulls

(defparameter *wedge*
  '((0 0 0) (0.2 0 0) (0.2 0.1 0) (0 0.1 0) (0 0 0.3) (0 0.1 0.3))
  "Half of a box.")

(test hulls-have-faces
  (let ((faces (projection::hull-faces *wedge*)))
    (is (= 5 (length faces)) "two of them triangles")
    (is (equal '(3 3 4 4 4)
               (sort (loop for face in faces
                           collect (length (projection::hull-face-corners face)))
                     #'<)))
    (is-true (every (lambda (face)
                      (every (lambda (point)
                               (<= (projection::dot-product (projection::hull-face-normal face)
                                                            point)
                                   (+ (projection::hull-face-distance face) 1d-9)))
                             *wedge*))
                    faces)))
  (is (nearly (+ (* 0.2 0.3) (* 0.2 0.1) (* 0.3 0.1) (* 0.1 (sqrt 0.13d0)))
              (reduce #'+ (projection::shape-patches (cons :hull *wedge*)) :key #'car)
              1d-9)
      "the area of its surface"))

(test points-are-spread-over-hulls
  (let* ((shape (cons :hull *wedge*))
         (points (projection::surface-points shape 240))
         (faces (projection::hull-faces *wedge*)))
    (is (< 230 (length points) 250))
    (dolist (point points)
      (let ((heights (loop for face in faces
                           collect (- (projection::dot-product
                                       (projection::hull-face-normal face)
                                       (subseq (geometry:pose-components point) 0 3))
                                      (projection::hull-face-distance face)))))
        (unless (< (abs (reduce #'max heights)) 1d-9)
          (fail "~a is not on the surface" point))))
    (is (= 240 (length (projection::interleaved (alexandria:iota 240)))))
    (is (= 0 (reduce #'min (projection::interleaved (alexandria:iota 240)))))
    (is (equalp (projection::surface-vector shape) (projection::surface-vector (copy-seq shape))))
    (is (eq (projection::surface-vector shape) (projection::surface-vector shape)))))

;;; Looking

(defun axis-of (projection)
  "Return the direction of the camera's axis in the frame of the robot's base, a list."
  (let* ((robot (robot-of projection))
         (camera (geometry:compose (geometry:inverse (projection::base-pose robot))
                                   (projection::camera-pose robot)))
         (tip (geometry:compose camera (geometry:make-pose 1 0 0))))
    (loop for reader in (list #'geometry:pose-x #'geometry:pose-y #'geometry:pose-z)
          collect (- (funcall reader tip) (funcall reader camera)))))

(test looking-in-directions
  (with-table (projection)
    (loop for (?direction x y z) in '((:left 0 1 0) (:right 0 -1 0) (:forward 1 0 0)
                                      (:down 0.707 0 -0.707) (:left-down 0.577 0.577 -0.577))
          do (perform-in projection (plan:a motion (type looking) (direction ?direction)))
             (is (every (lambda (one other) (nearly one other 0.02))
                        (list x y z) (axis-of projection))
                 "~a" ?direction))
    (signals-with (plan:designator-not-understood "direction")
      (perform-in projection (plan:a motion (type looking) (direction nowhere))))))

(test looking-at-frames
  (with-table (projection)
    (perform-in projection (plan:a motion (type looking) (frame "cereal")))
    (is (< (pointing-error projection 0.4 0.65 0.862) 1d-5) "an item")
    (perform-in projection (plan:a motion (type looking) (frame "table_link")))
    (is (< (pointing-error projection 1 0.85 0) 1d-5) "a link of a fixture")
    (signals-with (plan:designator-not-understood "frame")
      (perform-in projection (plan:a motion (type looking) (frame "teapot"))))))

(test looking-by-joint-positions
  (with-table (projection)
    (perform-in projection (plan:a motion (type looking) (joint-angles (0.3 -0.2))))
    (is (equal '(0.3d0 -0.2d0) (head-position projection)))
    (signals-with (plan:ptu-goal-not-reached "head_tilt_joint" "stops at")
      (perform-in projection (plan:a motion (type looking) (joint-angles (0.3 3)))))
    (signals plan:designator-not-understood
      (perform-in projection (plan:a motion (type looking) (joint-angles (0.3)))))))

;;; Detecting

(defun scene-with-boxes (&optional (more ""))
  "Return a scene with two boxes of cereal before the robot, one on a table."
  (with-file (file (scene-text (root-file "models/table-top/robot.urdf")
                               :more (format nil "(:fixture table ~s (:at 2 0.5 0 1.5708))
                                                  (:item box ~s (:at 2 0.5 0.862) (:type cereal))
                                                  (:item carton ~:*~s (:at 2 -1 0.112)
                                                         (:type cereal)) ~a"
                                             (root-file "models/table-top/table.urdf")
                                             (root-file "models/table-top/cereal.urdf")
                                             more)))
    (projection:load-scene file)))

(test all-items-are-detected
  (projection:with-projection (projection (scene-with-boxes))
    (flet ((detected (designator)
             (loop for object in (alexandria:ensure-list
                                  (perform-in projection
                                              (let ((?object designator))
                                                (plan:a motion (type detecting)
                                                        (object ?object)))))
                   collect (plan:desig-prop-value object :name))))
      (perform-in projection (looking-at 2 -0.2 0.5))
      (is (equal '(:box :carton) (detected (desig:all object (type cereal)))))
      (is (equal '(:box) (detected (plan:an object (type cereal)))))
      (perform-in projection (looking-at 2 -1.2 0.1))
      (is (equal '(:carton) (detected (desig:all object (type cereal)))))
      (perform-in projection (looking-at -1 3 1))
      (signals plan:perception-object-not-found (detected (desig:all object (type cereal)))))))

(test items-are-detected-where-they-are-sought
  (projection:with-projection (projection (scene-with-boxes))
    (flet ((detected (?location)
             (plan:desig-prop-value
              (perform-in projection
                          (plan:a motion (type detecting)
                                  (object (plan:an object (type cereal) (location ?location)))))
              :name)))
      (perform-in projection (looking-at 2 -0.2 0.5))
      (is (eq :box (detected (plan:a location (on table)))))
      (is (eq :box (detected (plan:a location (on (plan:an object (urdf-name table-link)))))))
      (signals-with (plan:perception-object-not-found "no such item there")
        (perform-in projection
                    (plan:a motion (type detecting)
                            (object (plan:an object (name carton)
                                             (location (plan:a location (on table)))))))))))

(test perception-errs
  (let ((scene (scene-with-boxes "(:tolerances (perception-error-x -0.02 0.02)
                                               (perception-error-z 0 0.01))")))
    (flet ((errors (&rest parameters)
             (projection:with-projection (projection scene :parameters parameters)
               (perform-in projection (looking-at 2 0.5 0.8))
               (let ((seen (plan:desig-prop-value (perform-in projection (detecting :cereal))
                                                  :pose))
                     (pose (projection:observed-pose projection :box)))
                 (loop for reader in (list #'geometry:pose-x #'geometry:pose-y #'geometry:pose-z
                                           #'geometry:pose-yaw)
                       collect (- (funcall reader seen) (funcall reader pose)))))))
      (is (every (lambda (one other) (nearly one other 1d-9))
                 '(0 0 0.005d0 0) (errors)))
      (is (every (lambda (one other) (nearly one other 1d-9))
                 '(-0.02 0 0.01 0)
                 (errors :perception-error-x -0.02 :perception-error-z 0.01))))))
