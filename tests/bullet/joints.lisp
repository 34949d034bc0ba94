;;;; Tests of the Bullet layer: joints, motors and frames of inertia against closed forms.

(in-package #:discrepancy-finder.tests)

(in-suite bullet)

(defun add-block (world name pose &rest options)
  "Add a block of 2 kg, 0.4 x 0.2 x 0.1 m."
  (apply #'bullet:add-body world name '(:box 0.4d0 0.2d0 0.1d0) pose
         (append options '(:mass 2))))

(defmacro with-slider ((world joint block &rest options) &body body)
  "Evaluate BODY with a BLOCK on a slider along x, 1 m above the origin, without gravity."
  `(bullet:with-world (,world :gravity 0)
     (let* ((,block (add-block ,world :block (at 0 0 1)))
            (,joint (bullet:add-joint ,world :slider nil ,block (at 0 0 1) ,@options)))
       ,@body)))

(test slider-travels-as-its-motor-says
  (with-slider (world joint block :lower 0 :upper 0.4d0 :name "drawer")
    (is (string= "#<JOINT drawer slider of BLOCK on the world>" (princ-to-string joint)))
    (is (= 0 (bullet:joint-position joint)))
    (bullet:set-motor joint 0.2d0 100)
    (bullet:step-world world 240)
    (is (near 0.2d0 1d-3 (bullet:joint-position joint)))
    (is (near 0.2d0 1d-3 (distance block)))
    (is (near 0.2d0 1d-6 (bullet:body-velocity block)))
    (bullet:step-world world 480)
    (is (near 0.4d0 1d-4 (bullet:joint-position joint)))
    (bullet:set-motor joint -1 100)
    (bullet:step-world world 240)
    (is (near 0 1d-4 (bullet:joint-position joint)))
    (is (near 1 1d-6 (height block)))))

(test motor-of-a-slider-accelerates-by-its-force
  (with-slider (world joint block)
    (bullet:set-motor joint 10 5)
    (bullet:step-world world 120)
    (is (near 1.25d0 1d-3 (bullet:body-velocity block)))
    (bullet:set-motor joint 0 3)
    (let ((start (bullet:joint-position joint)))
      (bullet:step-world world 480)
      (is (= 0 (bullet:body-velocity block)) "friction brings it to rest")
      (is (near (/ (expt 1.25d0 2) (* 2 3/2)) 5d-3 (- (bullet:joint-position joint) start))))
    (bullet:set-motor joint 1 100)
    (bullet:step-world world 24)
    (bullet:set-motor joint 0 0)
    (bullet:step-world world 240)
    (is (near 1 1d-9 (bullet:body-velocity block)) "without motor it is free")))

(test joint-between-two-bodies-pushes-both
  (bullet:with-world (world :gravity 0)
    (let* ((a (add-block world :a (at 0 0 0)))
           (b (add-block world :b (at 0.3d0 0 0)))
           (joint (bullet:add-joint world :slider a b (at 0 0 0))))
      (bullet:set-motor joint 10 4)
      (bullet:step-world world 120)
      (is (near 1 1d-3 (bullet:body-velocity b)))
      (is (near -1 1d-3 (bullet:body-velocity a)))
      (is (near (- (distance b) (distance a) 0.3d0) 1d-9 (bullet:joint-position joint))))))

(test hinge-turns-as-its-motor-says
  (bullet:with-world (world :gravity 0)
    (let* ((block (add-block world :block (at 0.2d0 0 0)))
           (joint (bullet:add-joint world :hinge nil block
                                    (geometry:make-pose 0 0 0 :pitch (/ pi -2))
                                    :lower -1/2 :upper 2))
           (inertia (+ (* 2 (/ (+ 0.16d0 0.04d0) 12)) (* 2 0.04d0))))
      (bullet:set-motor joint 100 0.3d0)
      (bullet:step-world world 48)
      (is (near (* 0.3d0 (/ inertia) 0.2d0) 5d-3 (nth-value 5 (bullet:body-velocity block))))
      (bullet:set-motor joint 1 100)
      (bullet:step-world world 12)
      (let ((start (bullet:joint-position joint)))
        (bullet:step-world world 240)
        (is (near 1 2d-3 (- (bullet:joint-position joint) start))))
      (is (near (bullet:joint-position joint) 1d-6
                (geometry:pose-yaw (bullet:body-pose block))))
      (bullet:step-world world 480)
      (is (near 2 1d-3 (bullet:joint-position joint)))
      (bullet:set-motor joint -2 100)
      (bullet:step-world world 480)
      (is (near -1/2 1d-3 (bullet:joint-position joint))))))

(defun half-swing (&rest options)
  "Return how long (s) a pendulum that hangs on a hinge along y takes from one side to the other."
  (bullet:with-world (world)
    (let* ((block (apply #'add-block world :block (at 0 0 0) options))
           (joint (bullet:add-joint world :hinge nil block
                                    (geometry:make-pose 0 0 0 :yaw (/ pi 2)))))
      (bullet:set-joint-position joint 0.1d0)
      (loop for steps from 0
            until (minusp (progn (bullet:step-world world) (bullet:joint-position joint)))
            finally (return (* 2 steps 1/240))))))

(test centre-of-mass-and-inertia-are-those-given
  (loop for (length inertia) in '((0.2d0 0.01d0) (0.2d0 0.1d0) (0.05d0 0.01d0))
        for frequency = (sqrt (/ (* 2 9.81d0 length) (+ inertia (* 2 length length))))
        for below = (at 0 0 (- length))
        do (is (near (/ pi frequency) (* 0.02d0 (/ pi frequency))
                     (half-swing :inertial-pose below :inertia (list 1 inertia 2))))
           ;; The same body by other principal axes, turned by a quarter about z.
           (is (near (/ pi frequency) (* 0.02d0 (/ pi frequency))
                     (half-swing :inertial-pose (geometry:compose
                                                 below (geometry:make-pose 0 0 0 :yaw (/ pi 2)))
                                 :inertia (list inertia 1 2))))))

(defun same-place-p (a b)
  (let ((gap (geometry:compose (geometry:inverse a) b)))
    (and (all-near-p '(0 0 0) 1d-12 (subseq (geometry:pose-components gap) 0 3))
         (near 1 1d-12 (abs (geometry:pose-qw gap))))))

(test poses-are-those-of-the-link-frame
  (bullet:with-world (world)
    (let ((block (add-block world :block (geometry:make-pose 1 2 3 :roll 0.3d0)
                            :inertial-pose (geometry:make-pose 0.1d0 0 0.05d0 :yaw 1))))
      (is (same-place-p (geometry:make-pose 1 2 3 :roll 0.3d0) (bullet:body-pose block)))
      (hits '(:block (1.2d0 2 3) (1 0 0) 0.8d0) world '(2 2 3) '(1 2 3))
      (bullet:step-world world 120)
      (is (near (* 9.81d0 1/240 1/240 120 121 1/2) 1d-9 (- 3 (height block))))
      (bullet:place-body block (geometry:make-pose 5 6 7 :pitch 1))
      (is (same-place-p (geometry:make-pose 5 6 7 :pitch 1) (bullet:body-pose block))))))

(test damping-limits-the-speed-of-falling
  (bullet:with-world (world)
    (let ((block (add-block world :block (at 0 0 0) :linear-damping 0.9d0)))
      (bullet:step-world world 1200)
      (is (near (/ -9.81d0 (log 10)) 0.05d0 (nth-value 2 (bullet:body-velocity block)))))))

(test six-dof-joint-keeps-its-limits
  (bullet:with-world (world)
    (let* ((block (add-block world :block (at 0 0 1)))
           (joint (bullet:add-joint world :six-dof nil block (at 0 0 1)
                                    :linear '((0 0) (0 0) (-0.1d0 0.2d0)))))
      (bullet:step-world world 240)
      (is (near 0.9d0 1d-3 (height block)))
      (multiple-value-bind (force torque) (bullet:joint-load joint)
        (is (every (lambda (x y) (near x 0.01d0 y)) '(0 0 19.62d0) force))
        (is (every (lambda (x) (near 0 0.01d0 x)) torque)))))
  (bullet:with-world (world)
    (let ((block (add-block world :block (at 0 0.3d0 1))))
      (bullet:add-joint world :six-dof nil block (at 0 0 1) :angular '((-1/2 0.3d0) (0 0) (0 0)))
      (bullet:step-world world 960)
      (is (near (- 1 (* 0.3d0 (sin 1/2))) 2d-3 (height block)))))
  (bullet:with-world (world)
    (let ((block (add-block world :block (at 0 0 1))))
      (bullet:add-joint world :six-dof nil block (at 0 0 1)
                        :linear '(nil nil nil) :angular '(nil nil nil))
      (bullet:step-world world 120)
      (is (near (* 9.81d0 1/240 1/240 120 121 1/2) 1d-3 (- 1 (height block)))
          "without limits it falls"))))

(test fixed-joint-bears-the-weight
  (bullet:with-world (world)
    (let* ((post (bullet:add-body world :post '(:box 0.1d0 0.1d0 0.1d0) (at 0 0 1)))
           (block (add-block world :block (at 0.25d0 0 1)))
           (joint (bullet:add-joint world :fixed post block (at 0.05d0 0 1))))
      (bullet:step-world world 240)
      (is (near 0.25d0 1d-4 (distance block)))
      (is (near 1 1d-3 (height block)))
      (multiple-value-bind (force torque) (bullet:joint-load joint)
        (is (every (lambda (x y) (near x 0.02d0 y)) '(0 0 19.62d0) force))
        (is (every (lambda (x) (near 0 0.02d0 x)) torque)))
      (bullet:remove-joint joint)
      (bullet:remove-joint joint)
      (is-false (bullet:joint-live-p joint))
      (is (null (bullet:world-joints world)))
      (bullet:step-world world 60)
      (is (< (height block) 0.9d0)))))

(test set-joint-position-puts-the-child
  (with-slider (world joint block :lower -1/10 :upper 0.4d0 :name :drawer)
    (is (eq joint (bullet:find-joint world :drawer)))
    (bullet:set-motor joint 0.2d0 100)
    (bullet:step-world world 24)
    (bullet:set-motor joint 0 0)
    (is (eq joint (bullet:set-joint-position joint 0.3d0)))
    (is (near 0.3d0 1d-12 (bullet:joint-position joint)))
    (is (near 0.3d0 1d-12 (distance block)))
    (is (= 0 (bullet:body-velocity block)))
    (bullet:step-world world 24)
    (is (near 0.3d0 1d-9 (bullet:joint-position joint)))
    (refuses "set-joint-position failed: 0.5 is beyond the limits -0.1d0 and 0.4d0 of #<JOINT ~
DRAWER slider of BLOCK on the world>." (bullet:set-joint-position joint 0.5)))
  (bullet:with-world (world :gravity 0)
    (let* ((door (bullet:add-body world :door '(:box 1 0.02d0 1) (at 0.5d0 0 0) :kind :kinematic))
           (joint (bullet:add-joint world :hinge nil door
                                    (geometry:make-pose 0 0 0 :pitch (/ pi -2)))))
      (bullet:set-joint-position joint (/ pi 2))
      (is (near 0 1d-9 (distance door)))
      (is (near (/ pi 2) 1d-9 (bullet:joint-position joint)) "a kinematic child, too"))))

(test joined-bodies-do-not-collide
  (bullet:with-world (world :gravity 0)
    (let* ((a (add-block world :a (at 0 0 0)))
           (b (add-block world :b (at 0.1d0 0 0)))
           (joint (bullet:add-joint world :fixed a b (at 0 0 0))))
      (bullet:step-world world 60)
      (is (near 0.1d0 1d-6 (- (distance b) (distance a))))
      (bullet:remove-joint joint)
      (bullet:step-world world 240)
      (is (> (- (distance b) (distance a)) 0.103d0)))))

(test wrong-joints-are-refused
  (bullet:with-world (world)
    (bullet:with-world (other)
      (let* ((floor (add-floor world)) (block (add-block world :block (at 0 0 1)))
             (stranger (add-block other :stranger (at 0 0 1)))
             (fixed (bullet:add-joint world :fixed nil block (at 0 0 1) :name "f"))
             (slider (bullet:add-joint world :slider nil block (at 0 0 1))))
        (flet ((add (&rest arguments)
                 (apply #'bullet:add-joint world arguments)))
          (refuses "add-joint failed: body FLOOR is static and cannot move."
                   (add :slider nil floor (at 0 0 0)))
          (refuses "add-joint failed: body STRANGER is no body of this world."
                   (add :slider nil stranger (at 0 0 0)))
          (refuses "add-joint failed: :BALL is none of :slider, :hinge, :fixed and :six-dof."
                   (add :ball nil block (at 0 0 0)))
          (refuses "add-joint failed: the world has a joint f already."
                   (add :slider nil block (at 0 0 0) :name "f"))
          (loop for arguments in `((:slider ,block ,block ,(at 0 0 0))
                                   (:slider ,stranger ,block ,(at 0 0 0))
                                   (:slider nil nil ,(at 0 0 0)) (:slider nil ,block 7)
                                   (:slider nil ,block ,(at 0 0 0) :lower 0)
                                   (:slider nil ,block ,(at 0 0 0) :lower 1 :upper 0)
                                   (:slider nil ,block ,(at 0 0 0) :lower 1 :upper ,(nan))
                                   (:six-dof nil ,block ,(at 0 0 0) :linear ((0 0)))
                                   (:six-dof nil ,block ,(at 0 0 0) :angular ((0 0) (1 0) (0 0)))
                                   (:slider nil ,block ,(geometry:quaternion-pose
                                                         0d0 0d0 0d0 1d0 1d0 0d0 0d0)))
                do (signals bullet:bullet-error (apply #'add arguments))))
        (is (equal (list fixed slider) (bullet:world-joints world)))
        (refuses "joint-position failed: #<JOINT f fixed of BLOCK on the world> has no single ~
position." (bullet:joint-position fixed))
        (signals bullet:bullet-error (bullet:set-motor fixed 1 1))
        (signals bullet:bullet-error (bullet:set-joint-position fixed 0))
        (signals bullet:bullet-error (bullet:set-motor slider (nan) 1))
        (signals bullet:bullet-error (bullet:set-motor slider 1 -1))
        (signals bullet:bullet-error (bullet:set-joint-position slider (nan)))
        (bullet:remove-joint slider)
        (dolist (function (list #'bullet:joint-position #'bullet:joint-load))
          (signals bullet:bullet-error (funcall function slider)))
        (signals bullet:bullet-error (bullet:set-motor slider 1 1))))))
