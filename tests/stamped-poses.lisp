;;;; Stamped poses: conversions, frames, what plans use of cram-tf.

(in-package #:discrepancy-finder.tests)

(in-suite transforms)

;;; Frames

(defmacro with-frames ((&rest names-and-poses) &body body)
  `(let ((transforms:*transformer* (transforms:make-frame-store ,@names-and-poses)))
     ,@body))

(defun pose-in (frame x y z &optional (yaw 0))
  (transforms:make-pose-stamped frame 0 (vector-of x y z) (transforms:euler->quaternion :az yaw)))

(defun pose-text (pose)
  "Return all that POSE prints, in one line."
  (let ((*print-pretty* nil) (*read-default-float-format* 'double-float))
    (prin1-to-string pose)))

(test conversions-between-kinds
  (let* ((pose (transforms:make-pose (vector-of 1 2 3) (transforms:make-identity-rotation)))
         (parts "#<3D-VECTOR (1.0 2.0 3.0)> #<QUATERNION (0.0 0.0 0.0 1.0)>>")
         (in-map (format nil "#<POSE-STAMPED FRAME-ID: \"map\", STAMP: 4.0 ~a" parts))
         (from-cup (format nil "#<TRANSFORM-STAMPED FRAME-ID: \"map\", CHILD-FRAME-ID: \"cup\", ~
                                STAMP: 4.0 ~a"
                           parts))
         (stamped (transforms:pose->pose-stamped "map" 4 pose))
         (transform (transforms:pose->transform pose))
         (transform-stamped (transforms:pose->transform-stamped "map" "cup" 4 pose)))
    (is (equal (format nil "#<TRANSFORM ~a" parts) (pose-text transform)))
    (is (equal (pose-text transform) (pose-text (transforms:reference-transform stamped))))
    (is (equal (pose-text pose) (pose-text (transforms:transform->pose transform))))
    (is (equal (pose-text pose) (pose-text (transforms:copy-pose stamped))))
    (dolist (same (list stamped
                        (transforms:transform->pose-stamped "map" 4 transform)
                        (transforms:transform-stamped->pose-stamped transform-stamped)
                        (transforms:copy-pose-stamped
                         (transforms:make-pose-stamped "odom" 1 (vector-of 1 2 3)
                                                       (transforms:make-identity-rotation))
                         :frame-id "map" :stamp 4)))
      (is (equal in-map (pose-text same))))
    (dolist (same (list transform-stamped
                        (transforms:transform->transform-stamped "map" "cup" 4 transform)
                        (transforms:pose-stamped->transform-stamped stamped "cup")
                        (transforms:copy-transform-stamped
                         (transforms:make-transform-stamped
                          "map" "bowl" 4 (vector-of 0 0 0) (transforms:make-identity-rotation))
                         :child-frame-id "cup" :translation (vector-of 1 2 3))))
      (is (equal from-cup (pose-text same))))
    (is (equal "#<POINT-STAMPED FRAME-ID: \"odom\", STAMP: 4.0 #<3D-VECTOR (1.0 2.0 3.0)>>"
               (pose-text (transforms:copy-point-stamped
                           (transforms:point->point-stamped "map" 4 (vector-of 1 2 3))
                           :frame-id "odom"))))
    (is (equal "#<VECTOR-STAMPED FRAME-ID: \"map\", STAMP: 5.0 #<3D-VECTOR (0.0 1.0 0.0)>>"
               (pose-text (transforms:copy-vector-stamped
                           (transforms:make-vector-stamped "map" 4 (vector-of 1 2 3))
                           :stamp 5 :origin (vector-of 0 1 0)))))
    (signals-with (transforms:unsuitable-value "The frame-id of a stamped value must be a string")
      (transforms:pose->pose-stamped :map 0 pose))
    (signals-with (transforms:unsuitable-value "The stamp of a stamped value" "NIL")
      (transforms:pose->pose-stamped "map" nil pose))
    (signals-with (transforms:unsuitable-value "What frame-id is asked of must be a stamped value")
      (transforms:frame-id pose))))

(test a-stamped-pose-means-a-pose-in-the-world
  (with-frames ("base_footprint" (geometry:make-pose 1 1 0 :yaw (/ pi 2)))
    (is (poses-nearly-equal-p (geometry:make-pose 2 0 0)
                              (transforms:geometry-pose (pose-in "map" 2 0 0))))
    (dolist (name '("base_footprint" "/base_footprint"))
      (is (poses-nearly-equal-p (geometry:make-pose 1 3 0 :yaw (/ pi 2))
                                (transforms:geometry-pose (pose-in name 2 0 0)))))
    (is (poses-nearly-equal-p
         (geometry:make-pose 1 3 0 :yaw (/ pi 2))
         (transforms:geometry-pose
          (transforms:pose-stamped->transform-stamped (pose-in "base_footprint" 2 0 0) "cup"))))
    (let ((transforms:*fixed-frame* "odom"))
      (is (poses-nearly-equal-p (geometry:make-pose 2 0 0)
                                (transforms:geometry-pose (pose-in "odom" 2 0 0)))))
    (signals-with (transforms:unknown-frame
                   "The frame \"gripper\" is unknown; known are \"base_footprint\", \"map\".")
      (transforms:geometry-pose (pose-in "gripper" 1 2 3))))
  (signals-with (transforms:unknown-frame "The frame \"a\" is unknown; known is \"map\".")
    (with-frames () (transforms:lookup-frame "a"))))

(defclass turning-robot ()
  ((yaw :initform 0 :accessor turning-robot-yaw)))

(defmethod transforms:frame-pose ((robot turning-robot) name)
  (when (string= name "base_footprint")
    (geometry:make-pose 0 0 0 :yaw (turning-robot-yaw robot))))

(test whoever-knows-frames-answers
  (let* ((robot (make-instance 'turning-robot))
         (transforms:*transformer* robot))
    (is (nearly 0 (transforms:get-yaw (transforms:orientation (transforms:robot-current-pose)))))
    (setf (turning-robot-yaw robot) 1)
    (is (nearly 1 (transforms:get-yaw (transforms:orientation (transforms:robot-current-pose)))))
    (signals-with (transforms:unknown-frame "known is \"map\"")
      (transforms:lookup-frame "torso_lift_link"))))

(test poses-and-points-in-other-frames
  (with-frames ("base_footprint" (geometry:make-pose 1 1 0 :yaw (/ pi 2))
                "tool" (pose-in "map" 0 0 1))
    (let ((pose (transforms:ensure-pose-in-frame (pose-in "map" 1 3 0 (/ pi 2)) "base_footprint")))
      (is (equal "base_footprint" (transforms:frame-id pose)))
      (is (vector-near-p (vector-of 2 0 0) (transforms:origin pose)))
      (is (same-rotation-p (transforms:make-identity-rotation) (transforms:orientation pose)))
      (is (transforms:poses-equal-p pose (pose-in "map" 1 3 0 (/ pi 2))))
      (is (not (transforms:poses-equal-p pose (pose-in "map" 1 3.1 0 (/ pi 2))))))
    (is (null (transforms:ensure-pose-in-frame nil "map")))
    (let ((point (transforms:ensure-point-in-frame
                  (transforms:make-point-stamped "tool" 3 (vector-of 0 2 0)) "base_footprint")))
      (is (vector-near-p (vector-of 1 1 1) point))
      (is (= 3 (transforms:stamp point))))
    (is (zerop (transforms:stamp
                (transforms:ensure-point-in-frame
                 (transforms:make-point-stamped "map" 3 (vector-of 0 2 0)) "map"
                 :use-zero-time t))))
    (let ((there (transforms:lookup-transform transforms:*transformer* "tool" "base_footprint"))
          (back (transforms:lookup-transform transforms:*transformer* "base_footprint" "tool")))
      (is (equal '("tool" "base_footprint")
                 (list (transforms:frame-id there) (transforms:child-frame-id there))))
      (is (poses-nearly-equal-p (geometry:identity-pose)
                                (transforms:geometry-pose
                                 (transforms:transform* (transforms:copy-transform there)
                                                        (transforms:copy-transform back))))))))

;;; cram-tf

(test moved-and-turned-poses-stay-in-their-frame
  (let* ((pose (pose-in "base" 1 2 3 (/ pi 2)))
         (moved (transforms:translate-pose pose :x-offset 1 :z 0.5)))
    (is (typep moved 'transforms:pose-stamped))
    (is (equal "base" (transforms:frame-id moved)))
    (is (equal '(2d0 2d0 3.5d0) (transforms:3d-vector->list (transforms:origin moved))))
    (flet ((z-axis (pose) (transforms:rotate (transforms:orientation pose) (vector-of 0 0 1))))
      (is (vector-near-p (vector-of 0 -1 0) (z-axis (transforms:rotate-pose pose :x (/ pi 2)))))
      (is (vector-near-p (vector-of 1 0 0)
                         (z-axis (transforms:rotate-pose-in-own-frame pose :x (/ pi 2))))))
    (is (eq (class-of (transforms:make-identity-pose))
            (class-of (transforms:rotate-pose (transforms:make-identity-pose) :z 1))))
    (signals-with (transforms:unsuitable-value "The axis of a rotation must be :x, :y or :z")
      (transforms:rotate-pose pose :w 1))))

(test poses-as-lists
  (let ((pose (pose-in "map" 1 2 3)))
    (is (equal '((1d0 2d0 3d0) (0d0 0d0 0d0 1d0)) (transforms:pose->list pose)))
    (is (equal '(1d0 2d0 3d0 0d0 0d0 0d0 1d0) (transforms:pose->flat-list pose)))
    (is (equal (transforms:pose->list pose)
               (transforms:pose->list (transforms:list->pose (transforms:pose->list pose)))))
    (is (equal (transforms:pose->list pose)
               (transforms:pose->list
                (transforms:flat-list->pose (transforms:pose->flat-list pose)))))
    (dolist (bad '(5 (1 2 3) ((1 2 3)) ((1 2 3) (0 0 1))))
      (signals-with (transforms:unsuitable-value "A pose as a list")
        (transforms:list->pose bad)))))

(test converged-values
  (is (transforms:values-converged 1.0 1.05 0.1))
  (is (not (transforms:values-converged 1.0 1.2 0.1)))
  (is (transforms:values-converged '(1 2) '(1.5 2) '(0.5 0)))
  (is (not (transforms:values-converged '(1 2) '(1.5 2.25) 0.125)))
  (signals-with (transforms:unsuitable-value "The list of goal values must be two values long")
    (transforms:values-converged '(1 2) '(1) 0.1)))

(test products-of-stamped-transforms
  (let ((a (transforms:make-transform-stamped "map" "base" 2 (vector-of 1 1 0)
                                              (transforms:euler->quaternion :az (/ pi 2))))
        (b (transforms:make-transform-stamped "base" "cup" 1 (vector-of 2 0 0)
                                              (transforms:make-identity-rotation))))
    (let ((product (transforms:apply-transform a b)))
      (is (equal '("map" "cup" 1d0)
                 (list (transforms:frame-id product) (transforms:child-frame-id product)
                       (transforms:stamp product))))
      (is (vector-near-p (vector-of 1 3 0) (transforms:translation product))))
    (let ((pose (transforms:multiply-transform-stampeds "map" "cup" a b
                                                        :result-as-pose-or-transform :pose)))
      (is (typep pose 'transforms:pose-stamped))
      (is (vector-near-p (vector-of 1 3 0) (transforms:origin pose))))
    (let ((back (transforms:transform-stamped-inv a)))
      (is (equal '("base" "map")
                 (list (transforms:frame-id back) (transforms:child-frame-id back))))
      (is (vector-near-p (vector-of -1 1 0) (transforms:translation back))))
    (is (equal '(1d0 1d0 0d0) (transforms:3d-vector->list
                               (transforms:origin (transforms:strip-transform-stamped a)))))
    (let ((warnings '()))
      (handler-bind ((transforms:frame-mismatch
                       (lambda (warning)
                         (push (princ-to-string warning) warnings)
                         (muffle-warning warning))))
        (is (typep (transforms:apply-transform b a) 'transforms:transform-stamped)))
      (is (equal (list (format nil "apply-transform multiplies transforms whose frames do not ~
                                    fit: \"cup\" was expected where \"map\" is."))
                 warnings)))))
