;;;; Tests of mechanisms: forward kinematics against composition in Lisp, inverse against forward
;;;; kinematics.

(in-package #:discrepancy-finder.tests)

(def-suite mechanisms :in all)
(in-suite mechanisms)

(defun pose-gap (a b)
  "Return how far apart the positions of the poses A and B are (m), and the angle between them."
  (let ((gap (geometry:compose (geometry:inverse a) b)))
    (values (sqrt (+ (expt (geometry:pose-x gap) 2) (expt (geometry:pose-y gap) 2)
                     (expt (geometry:pose-z gap) 2)))
            (* 2 (asin (min 1 (sqrt (+ (expt (geometry:pose-qx gap) 2)
                                       (expt (geometry:pose-qy gap) 2)
                                       (expt (geometry:pose-qz gap) 2)))))))))

(defun random-pose (state)
  (geometry:make-pose (random 2d0 state) (random 2d0 state) (random 2d0 state)
                      :roll (random 3d0 state) :pitch (random 1d0 state)
                      :yaw (random 6d0 state)))

(defun joint-motion (link position)
  "Return the pose by which the joint of LINK turns or shifts it."
  (let ((axis (bullet:link-spec-axis link)))
    (ecase (bullet:link-spec-type link)
      (:fixed (geometry:identity-pose))
      (:prismatic (apply #'geometry:make-pose (mapcar (lambda (a) (* a position)) axis)))
      ((:revolute :continuous)
       (destructuring-bind (x y z) (mapcar (lambda (a) (* a (sin (/ position 2)))) axis)
         (geometry:quaternion-pose 0d0 0d0 0d0 x y z (cos (/ position 2))))))))

(defun composed-pose (links base positions index)
  "Return the pose of the link INDEX by composition."
  (let* ((link (aref links index))
         (parent (bullet:link-spec-parent link))
         (mimic (bullet:link-spec-mimic link))
         (position (cond ((null mimic) (aref positions index))
                         ((eq :fixed (bullet:link-spec-type (aref links (first mimic))))
                          (third mimic))
                         (t (+ (* (second mimic) (aref positions (first mimic)))
                               (third mimic))))))
    (geometry:compose (if parent (composed-pose links base positions parent) base)
                      (geometry:compose (bullet:link-spec-origin link)
                                        (joint-motion link position)))))

(defun random-links (state count)
  "Return COUNT links of all types in a random tree; joint 3 mimics joint 1."
  (coerce (loop for i below count
                collect (bullet:link-spec
                         (list :link i) (and (plusp i) (random i state))
                         (aref #(:revolute :prismatic :continuous :fixed) (random 4 state))
                         (random-pose state)
                         (nth (random 4 state) '((0d0 0d0 1d0) (0d0 1d0 0d0) (1d0 0d0 0d0)
                                                 (0.6d0 0d0 -0.8d0)))
                         nil nil (and (= i 3) '(1 -0.5d0 0.2d0))))
          'vector))

(defun random-positions (mechanism state)
  (map-into (bullet:make-positions mechanism) (lambda () (- (random 4d0 state) 2))))

(test forward-kinematics-is-composition
  (let ((state (sb-ext:seed-random-state 1)))
    (bullet:with-world (world)
      (loop repeat 10
            for links = (random-links state 12)
            for mechanism = (bullet:make-mechanism world links)
            do (loop repeat 3
                     for base = (random-pose state)
                     for positions = (random-positions mechanism state)
                     do (bullet:pose-mechanism mechanism base positions)
                        (loop for i below 12
                              for expected = (composed-pose links base positions i)
                              do (is (> 1d-9 (pose-gap expected
                                                       (bullet:link-pose mechanism i))))
                                 (is (> 1d-7 (nth-value 1 (pose-gap
                                                           expected
                                                           (bullet:forward-kinematics
                                                            mechanism base positions
                                                            i)))))))))))

(defun add-link-body (world name x)
  (bullet:add-body world name '(:box 0.1d0 0.1d0 0.1d0) (geometry:make-pose x 0 0)
                   :kind :kinematic))

(test posing-moves-the-links-bodies
  (bullet:with-world (world :gravity 0)
    (let* ((slider (add-link-body world :slider 0))
           (hand (add-link-body world :hand 0.2d0))
           (mechanism (bullet:make-mechanism
                       world
                       (list (bullet:link-spec :slider nil :prismatic (geometry:identity-pose)
                                               '(2 0 0) 0 1 nil slider)
                             (bullet:link-spec :frame 0 :fixed (geometry:make-pose 0.2d0 0 0))
                             (bullet:link-spec :hand 1 :revolute (geometry:identity-pose)
                                               '(0 0 1) nil nil nil hand))))
           (positions (bullet:make-positions mechanism))
           (cube (add-cube world :cube 0.31d0 0)))
      (is (string= "#<LINK-SPEC FRAME fixed>"
                   (princ-to-string (aref (bullet:mechanism-links mechanism) 1))))
      (is (eql 2 (bullet:link-index mechanism :hand)))
      (is (null (bullet:link-index mechanism :foot)))
      (setf (aref positions 0) 0.5d0)
      (bullet:attach hand cube)
      (bullet:pose-mechanism mechanism (geometry:make-pose 0 1 0) positions :teleport t)
      (is (near 0.5d0 1d-12 (distance slider)))
      (is (near 0.7d0 1d-12 (distance hand)))
      (is (near 0.81d0 1d-12 (distance cube)))
      (bullet:step-world world)
      (is (every #'zerop (multiple-value-list (bullet:body-velocity hand))))
      (setf (aref positions 0) 0.51d0)
      (bullet:pose-mechanism mechanism (geometry:make-pose 0 1 0) positions)
      (bullet:step-world world)
      (is (near 2.4d0 1d-9 (bullet:body-velocity hand)))
      (is (< 2.4d0 (bullet:body-velocity cube) 3)))))

(test senseless-mechanisms-are-refused
  (bullet:with-world (world)
    (bullet:with-world (other)
      (flet ((refused (text &rest links)
               (handler-case (progn (bullet:make-mechanism world links) nil)
                 (bullet:bullet-error (condition)
                   (search text (princ-to-string condition)))))
             (link (&rest arguments)
               (apply #'bullet:link-spec :arm nil :revolute (geometry:identity-pose) arguments)))
        (is-true (refused "at least one link"))
        (is-true (refused "no link-spec" 7))
        (is-true (refused "link ARM has no direction" (link '(0 0 0))))
        (is-true (refused "no list of three" (link '(0 0))))
        (is-true (refused "above" (link '(1 0 0) 1 0)))
        (is-true (refused "lower limit of link ARM"
                          (link '(1 0 0) sb-ext:double-float-positive-infinity)))
        (is-true (refused "mimics" (link '(1 0 0) nil nil '(5 1 0))))
        (is-true (refused "mimics" (link '(1 0 0) nil nil '(1 1 0))
                          (link '(1 0 0) nil nil '(0 1 0))))
        (is-true (refused "not kinematic"
                          (link '(1 0 0) nil nil nil (add-cube world :cube 0 0))))
        (is-true (refused "another world"
                          (link '(1 0 0) nil nil nil (add-link-body other :arm 0))))
        (is-true (refused "before its parent"
                          (bullet:link-spec :arm 0 :fixed (geometry:identity-pose)))))
      (let ((mechanism (bullet:make-mechanism
                        world (list (bullet:link-spec :arm nil :revolute
                                                      (geometry:identity-pose)))))
            (nan (vector sb-ext:double-float-positive-infinity)))
        (signals bullet:bullet-error (bullet:link-pose mechanism 1))
        (signals bullet:bullet-error
          (bullet:pose-mechanism mechanism (geometry:identity-pose) (make-array 2)))
        (signals bullet:bullet-error
          (bullet:pose-mechanism mechanism (geometry:identity-pose)
                                 (coerce nan '(simple-array double-float (*)))))
        (bullet:close-world world)
        (signals bullet:bullet-error (bullet:link-pose mechanism 0))))))

;;; Inverse kinematics

(defun arm-links ()
  "Return the links of an arm of seven joints, with the proportions and limits of a PR2's, on a
torso."
  (flet ((joint (name parent axis x lower upper)
           (bullet:link-spec name parent (if lower :revolute :continuous)
                             (geometry:make-pose x 0 0) axis lower upper)))
    (list (bullet:link-spec :torso nil :prismatic (geometry:make-pose 0 0 0.8d0) '(0 0 1)
                            0 0.3d0)
          (joint :pan 0 '(0 0 1) 0 -0.56d0 2.13d0)
          (joint :lift 1 '(0 1 0) 0.1d0 -0.35d0 1.3d0)
          (joint :roll 2 '(1 0 0) 0 -0.65d0 3.75d0)
          (joint :elbow 3 '(0 1 0) 0.4d0 -2.12d0 -0.15d0)
          (joint :forearm 4 '(1 0 0) 0 nil nil)
          (joint :flex 5 '(0 1 0) 0.321d0 -2.0d0 0)
          (joint :wrist 6 '(1 0 0) 0 nil nil))))

(defparameter *arm-joints* '(1 2 3 4 5 6 7))

(defun random-arm-positions (mechanism state)
  (let ((positions (bullet:make-positions mechanism)))
    (loop for joint in *arm-joints*
          for link = (aref (bullet:mechanism-links mechanism) joint)
          for lower = (or (bullet:link-spec-lower link) (- pi))
          for upper = (or (bullet:link-spec-upper link) pi)
          do (setf (aref positions joint) (+ lower (random (- upper lower) state))))
    positions))

(defun within-limits-p (mechanism positions)
  (loop for link across (bullet:mechanism-links mechanism)
        for position across positions
        always (<= (or (bullet:link-spec-lower link) most-negative-double-float)
                   position
                   (or (bullet:link-spec-upper link) most-positive-double-float))))

(test inverse-kinematics-finds-reachable-poses
  (bullet:with-world (world)
    (let* ((mechanism (bullet:make-mechanism world (arm-links)))
           (state (sb-ext:seed-random-state 2))
           (base (geometry:make-pose 1 2 0 :yaw 0.3d0))
           (tool (geometry:make-pose 0.18d0 0 0))
           (start (bullet:make-positions mechanism))
           (solved 0))
      (loop repeat 1000
            for goal = (random-arm-positions mechanism state)
            for target = (geometry:compose
                          (bullet:forward-kinematics mechanism base goal 7) tool)
            for solution = (bullet:inverse-kinematics mechanism :base base :link 7 :tool tool
                                                                :target target
                                                                :joints *arm-joints*
                                                                :start start)
            when solution
              do (multiple-value-bind (distance angle)
                     (pose-gap target (geometry:compose (bullet:forward-kinematics
                                                         mechanism base solution 7)
                                                        tool))
                   (when (and (< distance 1d-3) (< angle 1d-3)
                              (within-limits-p mechanism solution))
                     (incf solved))))
      (is (>= solved 990))
      (is (every #'zerop start)))))

(test inverse-kinematics-answers-for-what-it-finds
  (bullet:with-world (world)
    (let* ((mechanism (bullet:make-mechanism world (arm-links)))
           (start (bullet:make-positions mechanism))
           (target (geometry:make-pose 0.5d0 0.1d0 0.8d0)))
      (flet ((solve (&rest options)
               (apply #'bullet:inverse-kinematics mechanism
                      (append options (list :link 7 :target target :joints *arm-joints*
                                            :start start)))))
        (is (equalp (solve) (solve)))
        (multiple-value-bind (nothing distance angle)
            (solve :target (geometry:make-pose 3 0 1))
          (is (null nothing))
          (is (> distance 1))
          (is (>= angle 0)))
        (let ((solutions (solve :count 5)))
          (is (= 5 (length solutions)))
          (is (= 5 (length (remove-duplicates solutions :test #'equalp))))
          (is (equalp (first solutions) (solve)))
          (dolist (solution solutions)
            (is-true (within-limits-p mechanism solution))
            (is (> 1d-4 (pose-gap target (bullet:forward-kinematics
                                          mechanism (geometry:identity-pose) solution 7))))))
        (is-false (equalp (solve) (solve :attempt 3)))
        (is (null (solve :target (geometry:make-pose 0.8d0 0.1d0 0.8d0 :yaw pi))))
        (is-true (solve :target (geometry:make-pose 0.8d0 0.1d0 0.8d0 :yaw pi)
                        :position-only t))
        (let ((high (geometry:make-pose 0.4d0 0.1d0 1.4d0)))
          (is (null (solve :target high :position-only t)))
          (is-true (solve :target high :position-only t :joints '(0 1 2 3 4 5 6 7))))
        (signals bullet:bullet-error (solve :joints '(8)))
        (signals bullet:bullet-error (solve :link 8))
        (signals bullet:bullet-error (solve :tolerance 0))
        (signals bullet:bullet-error (solve :start (make-array 8)))))))

(test inverse-kinematics-moves-what-is-mimicked
  (bullet:with-world (world)
    (let* ((links (list (bullet:link-spec :a nil :prismatic (geometry:identity-pose) '(1 0 0) 0 1)
                        (bullet:link-spec :b 0 :prismatic (geometry:identity-pose) '(1 0 0)
                                          nil nil '(0 2 0.1d0))))
           (mechanism (bullet:make-mechanism world links))
           (solution (bullet:inverse-kinematics
                      mechanism :link 1 :target (geometry:make-pose 1 0 0) :joints '(0)
                                :start (bullet:make-positions mechanism))))
      (is (near 0.3d0 1d-4 (aref solution 0))))))
