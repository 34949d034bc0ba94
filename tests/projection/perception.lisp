;;;; Tests of the projection's camera: detecting.

(in-package #:discrepancy-finder.tests)

(in-suite perception)

;;; Surfaces

(test points-are-spread-over-a-surface
  (loop for shape in `((:box 0.2d0 0.3d0 0.4d0) (:sphere 0.3d0) (:cylinder 0.1d0 0.5d0)
                       (:compound (,(geometry:make-pose 0 0 -0.1) (:box 0.2d0 0.2d0 0.2d0))
                                  (,(geometry:make-pose 0 0 0.05) (:cylinder 0.05d0 0.3d0))))
        for points = (projection::surface-points shape 240)
        do (is (< 200 (length points) 245))
           (is-true (every (lambda (point)
                             (destructuring-bind (x y z) (subseq (geometry:pose-components point)
                                                                 0 3)
                               (and (inside-shape-p shape x y z 1d-9)
                                    (not (inside-shape-p shape x y z -2d-6)))))
                           points)
                    "they are on the surface")
           (unless (eq (first shape) :compound)
             (loop for reader in (list #'geometry:pose-x #'geometry:pose-y #'geometry:pose-z)
                   do (is (nearly 0 (/ (reduce #'+ points :key reader) (length points)) 0.01)
                          "and even")))
           (is-true (every #'geometry:pose= points (projection::surface-points shape 240)))))

;;; Detecting

(defparameter *in-front* '(0.4 0.8 0.8)
  "A place on the table right before the robot.")

(test detecting-returns-what-is-there
  (with-table (projection)
    (projection:settle projection)
    (perform-in projection (apply #'looking-at *in-front*))
    (let* ((?color :yellow)
           (?sought (plan:an object (type cereal) (color ?color)))
           (found (perform-in projection (plan:a motion (type detecting) (object ?sought)))))
      (is (equal '(:type :name :color :pose) (mapcar #'first (plan:properties found))))
      (is (equal '(:cereal :cereal :yellow)
                 (loop for key in '(:type :name :color)
                       collect (plan:desig-prop-value found key))))
      (is (geometry:pose= (projection:observed-pose projection :cereal)
                          (plan:desig-prop-value found :pose)))
      (is (equal '((:type :cereal) (:color :yellow)) (plan:properties ?sought))
          "what was given stays as it is")
      (let ((?found found))
        (is (equal (mapcar #'first (plan:properties found))
                   (mapcar #'first (plan:properties
                                    (perform-in projection
                                                (plan:a motion (type detecting)
                                                        (object ?found)))))))
        (is (eq :cereal (perform-in projection
                                    (plan:an action (type picking-up) (object ?found)))))
        (is (eq :cereal (projection:held-item projection)))))))

(test detecting-leaves-the-world-alone
  (with-table (projection)
    (perform-in projection (apply #'looking-at *in-front*))
    (let ((hash (projection:state-hash projection))
          (time (projection:simulated-seconds projection)))
      (perform-in projection (detecting :cereal))
      (signals plan:perception-object-not-found (perform-in projection (detecting :teapot)))
      (is (= hash (projection:state-hash projection)))
      (is (= time (projection:simulated-seconds projection))))))

(test what-is-not-there-is-not-detected
  (with-table (projection)
    (perform-in projection (apply #'looking-at *in-front*))
    (signals-with (plan:perception-object-not-found "teapot" "no such item")
      (perform-in projection (detecting :teapot)))
    (signals-with (plan:perception-object-not-found "no such item")
      (perform-in projection
                  (plan:a motion (type detecting)
                          (object (plan:an object (type cup) (name cereal))))))
    (perform-in projection (plan:a motion (type detecting)
                                   (object (plan:an object (name cereal)))))
    (signals-with (plan:designator-not-understood "detecting" "type or a name")
      (perform-in projection (plan:a motion (type detecting) (object (plan:an object)))))
    (signals-with (plan:designator-not-understood "detecting" "type or a name")
      (perform-in projection (plan:a motion (type detecting))))
    (perform-in projection (looking-at -3 0 1))
    (signals-with (plan:perception-object-not-found "cereal" "0.0 % of cereal" "90.0 %")
      (perform-in projection (detecting :cereal)))))

(test the-field-of-view-has-edges
  "A cup whose middle is on the edge of the field of view is half seen."
  (flet ((seen (angle &rest parameters)
           (projection:with-projection
               (projection (projection:scene-with-parameters (table-top-scene) parameters)
                           :poses (list :robot (geometry:make-pose 0.4 0 0 :yaw (/ pi 2))
                                        :cereal (geometry:make-pose 2 1 0.862)))
             ;; The camera looks straight ahead, level, from 0.05 m before the axis at x = 0.4.
             (let ((camera (projection::camera-pose (robot-of projection))))
               (bullet:place-body (cdr (assoc :cup (projection::projection-items projection)))
                                  (geometry:make-pose
                                   (- (geometry:pose-x camera) (* 1.5 (sin angle)))
                                   (+ (geometry:pose-y camera) (* 1.5 (cos angle)))
                                   (geometry:pose-z camera)))
               (projection:visible-part projection :cup)))))
    (is (= 1 (seen 0)))
    (is (= 1 (seen 0.3)))
    (is (= 1 (seen 0.65)))
    (is (nearly 0.5 (seen 0.7) 0.03))
    (is (nearly 0.5 (seen -0.7) 0.03))
    (is (= 0 (seen 0.75)))
    (is (= 0 (seen -0.75)))
    (is (= 0 (seen pi)) "it has no eyes at its back")
    (is (nearly 0.5 (seen 0.5 :camera-field-of-view 1) 0.03))
    (is (= 1 (seen 0.5 :camera-field-of-view 1.1)))
    (is (< 0.2 (seen 0 :camera-vertical-field-of-view (* 2 (atan 0.02 1.5))) 0.6)
        "the upper and the lower third of it are cut off")
    (is (= 1 (seen 0 :camera-range 1.55)))
    (is (= 0 (seen 0 :camera-range 1.45)))
    (is (< 0.3 (seen 0 :camera-range 1.5) 0.7) "its near side is in range")))

(test items-hide-items
  (flet ((seen (cereal-y cup-y)
           (with-table (projection :poses (list :cereal (geometry:make-pose 0.4 cereal-y 0.862)
                                                :cup (geometry:make-pose 0.4 cup-y 0.8)))
             (perform-in projection (apply #'looking-at *in-front*))
             (list (projection:visible-part projection :cereal)
                   (projection:visible-part projection :cup)
                   (detected-p projection :cup)))))
    (is (equal '(1d0 1d0 t) (seen 1.1 0.6)))
    (destructuring-bind (cereal cup detected) (seen 0.65 0.8)
      (is (= 1 cereal))
      (is (< cup 0.5))
      (is (null detected)))
    (is (< 0.5 (first (seen 0.75 0.62)) 0.95) "a cup before it hides the foot of the box")))

(test fixtures-hide-items
  (with-table (projection :poses (list :cereal (geometry:make-pose 0.4 1.1 0.112)))
    (perform-in projection (looking-at 0.4 1.1 0.1))
    (is (< (projection:visible-part projection :cereal) 0.1) "it stands under the table")
    (is-false (detected-p projection :cereal))))

(test the-links-of-the-robot-hide-nothing
  (with-table (projection)
    (projection:settle projection)
    (perform-in projection (apply #'looking-at *in-front*))
    (perform-in projection (plan:an action (type picking-up)
                                    (object (plan:an object (type cereal)))))
    (let ((pose (projection:observed-pose projection :cereal)))
      (perform-in projection (looking-at (geometry:pose-x pose) (geometry:pose-y pose)
                                         (geometry:pose-z pose)))
      (is (= 1 (projection:visible-part projection :cereal))))))

(test the-visible-fraction-is-a-threshold
  (let* ((poses (list :cereal (geometry:make-pose 0.4 0.75 0.862)
                      :cup (geometry:make-pose 0.4 0.62 0.8)))
         (part (with-table (projection :poses poses)
                 (perform-in projection (apply #'looking-at *in-front*))
                 (projection:visible-part projection :cereal))))
    (is (< 0.1 part 0.99))
    (flet ((found-p (needed)
             (with-table (projection :poses poses :parameters (:visible-fraction needed))
               (perform-in projection (apply #'looking-at *in-front*))
               (detected-p projection :cereal))))
      (is-true (found-p part))
      (is-true (found-p (- part 1d-9)))
      (is-false (found-p (+ part 1d-9))))))

(test items-have-types
  (with-file (file (scene-text (root-file "models/table-top/robot.urdf")
                               :more (format nil "(:item box ~s (:at -2 0 0.112) (:type cereal))
                                                  (:item carton ~:*~s (:at 2 0 0.112)
                                                         (:type cereal))
                                                  (:item cup ~s (:at 2 0.5 0.05))"
                                             (root-file "models/table-top/cereal.urdf")
                                             (root-file "models/table-top/cup.urdf"))))
    (let ((scene (projection:load-scene file)))
      (is (equal '(:cereal :cereal :cup)
                 (loop for name in '(box carton cup)
                       collect (projection:scene-item-type scene name))))
      (signals projection:unknown-body (projection:scene-item-type scene 'teapot))
      (projection:with-projection (projection scene)
        (perform-in projection (looking-at 2 0 0.2))
        (is (eq :carton (plan:desig-prop-value (perform-in projection (detecting :cereal))
                                               :name)))
        (signals plan:perception-object-not-found (perform-in projection (detecting :carton)))
        (signals-with (plan:perception-object-not-found "0.0 % of box")
          (perform-in projection (plan:a motion (type detecting)
                                         (object (plan:an object (type cereal) (name box))))))))))

(test seeing-is-the-same-in-every-run
  (flet ((look ()
           (with-table (projection :poses (list :cup (geometry:make-pose 0.42 0.58 0.8)))
             (projection:settle projection)
             (perform-in projection (going-to 0.5 0.01 1.6))
             (perform-in projection (apply #'looking-at *in-front*))
             (list (projection:visible-part projection :cereal)
                   (projection:visible-part projection :cup)
                   (projection:state-hash projection)))))
    (let ((first (look)))
      (is (equal first (look)))
      (is (equal first (sb-thread:join-thread (sb-thread:make-thread #'look)))))))

(test seeing-leaves-no-memory-behind
  (with-table (projection)
    (perform-in projection (apply #'looking-at *in-front*))
    (flet ((see (count)
             (loop repeat count do (projection:visible-part projection :cereal))
             (sb-ext:gc :full t)))
      (see 100)
      (let ((before (resident-megabytes)))
        (see (if *long* 20000 1000))
        (is (< (- (resident-megabytes) before) 30))))))

;;; Scene files

(test what-is-wrong-with-a-head-is-named
  (let ((robot (root-file "models/table-top/robot.urdf")))
    (flet ((text (&rest options)
             (apply #'scene-text robot options)))
      (scene-problem-of (text :camera "") "(:camera link)")
      (scene-problem-of (text :head "(:head \"head_pan_joint\")") "(:head pan-joint tilt-joint)")
      (scene-problem-of (text :camera "(:camera \"eye\")") ":camera" "\"eye\"" "no such link")
      (scene-problem-of (text :camera "(:camera 7)") ":camera" "no such link")
      (scene-problem-of (text :head "(:head \"neck\" \"head_tilt_joint\")") ":pan" "no such joint")
      (scene-problem-of (text :head "(:head \"head_pan_joint\" \"lift_joint\")")
                        ":tilt" "not revolute")
      (scene-problem-of (text :head "(:head \"head_pan_joint\" \"shoulder_joint\")")
                        "\"shoulder_joint\"" "does not turn the camera")
      (scene-problem-of (text :parameters "(visible-fraction 1.5)") "at most 1.0")
      (scene-problem-of (text :more (format nil "(:item box ~s (:at 0 0 1) (:type 7))"
                                            (root-file "models/table-top/cereal.urdf")))
                        "(:type name)"))
    (signals-with (projection:impossible-parameter "visible-fraction" "at most 1.0")
      (table-top-scene :visible-fraction 1.01))
    (signals-with (projection:impossible-parameter "camera-field-of-view" "at most 3.1416")
      (table-top-scene :camera-field-of-view 4))))

(test a-camera-needs-no-head
  (with-file (file (scene-text (root-file "models/table-top/robot.urdf") :head ""
                               :more (format nil "(:item cup ~s (:at 2 0 1.1))"
                                             (root-file "models/table-top/cup.urdf"))))
    (projection:with-projection (projection (projection:load-scene file))
      (is-true (detected-p projection :cup))
      (signals-with (projection:missing-robot-part "head")
        (perform-in projection (looking-at 1 0 1))))))
