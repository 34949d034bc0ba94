;;;; Tests of the Bullet layer: motion, contacts and attachments against closed forms.

(in-package #:discrepancy-finder.tests)

(def-suite bullet :in all)
(in-suite bullet)

(defun near (expected tolerance actual)
  (<= (abs (- actual expected)) tolerance))

(defun add-floor (world &rest options)
  (apply #'bullet:add-body world :floor '(:plane 0 0 1 0) (geometry:identity-pose) options))

(defun add-cube (world name x z &rest options)
  "Add a cube of 0.1 m and 1 kg."
  (apply #'bullet:add-body world name '(:box 0.1d0 0.1d0 0.1d0) (geometry:make-pose x 0 z)
         (append options '(:mass 1d0))))

(defun height (body)
  (geometry:pose-z (bullet:body-pose body)))

(defun distance (body)
  (geometry:pose-x (bullet:body-pose body)))

;;; Motion

(test free-fall-is-semi-implicit-euler
  (bullet:with-world (world)
    (let ((ball (bullet:add-body world :ball '(:sphere 0.05d0) (geometry:make-pose 0 0 10)
                                 :mass 2)))
      (bullet:step-world world 240)
      (is (= 1 (bullet:world-time world)))
      (is (near (- 10 (* 9.81d0 1/240 1/240 240 241 1/2)) 1d-9 (height ball)))
      (is (near -9.81d0 1d-9 (nth-value 2 (bullet:body-velocity ball)))))))

(test gravity-and-time-step-are-free
  (bullet:with-world (world :gravity -1 :time-step 1/100)
    (let ((ball (bullet:add-body world :ball '(:sphere 0.05d0) (geometry:make-pose 0 0 10)
                                 :mass 2)))
      (bullet:step-world world 50)
      (is (near 0.5d0 1d-12 (bullet:world-time world)))
      (is (near -0.5d0 1d-9 (nth-value 2 (bullet:body-velocity ball)))))))

(test box-comes-to-rest-and-sleeps
  (bullet:with-world (world)
    (add-floor world)
    (let ((cube (add-cube world :cube 0 0.1d0)))
      (is-false (bullet:at-rest-p world))
      (bullet:step-world world)
      (is-false (bullet:at-rest-p world))
      (bullet:step-world world 360)
      (is-true (bullet:at-rest-p world))
      (is-true (bullet:asleep-p cube))
      (is (near 0.05d0 1d-4 (height cube)))
      (bullet:wake cube)
      (is-false (bullet:asleep-p cube))
      (is-true (bullet:at-rest-p (bullet:step-world world 20)))
      (bullet:allow-sleep cube nil)
      (is-false (bullet:asleep-p (progn (bullet:step-world world 240) cube)))
      (bullet:allow-sleep cube t)
      (is-true (bullet:asleep-p (progn (bullet:step-world world 240) cube))))))

(test flight-is-no-rest-at-the-apex
  (bullet:with-world (world :gravity 0)
    (add-cube world :cube 0 1)
    (is-false (bullet:at-rest-p (bullet:step-world world 5)))
    (is-true (bullet:at-rest-p (bullet:step-world world 20)))))

(defun slide (friction seconds)
  "Return how far (m) a cube slides down a slope of 1 in 2 in SECONDS."
  (bullet:with-world (world)
    (let ((slope (geometry:make-pose 0 0 0 :pitch (atan 0.5d0))))
      (bullet:add-body world :slope '(:box 20 1 0.1d0) slope :friction 1)
      (let* ((start (geometry:compose slope (geometry:make-pose 0 0 0.1d0)))
             (cube (bullet:add-body world :cube '(:box 0.1d0 0.1d0 0.1d0) start :mass 1
                                                                          :friction friction)))
        (bullet:step-world world (round (* 240 seconds)))
        (geometry:pose-x (geometry:compose (geometry:inverse slope) (bullet:body-pose cube)))))))

(test friction-holds-up-to-its-coefficient
  (is (near 0 1d-3 (slide 0.525d0 2)))
  (is (> (slide 0.475d0 2) 0.3d0))
  (let ((acceleration (* 9.81d0 (- (sin (atan 0.5d0)) (* 0.3d0 (cos (atan 0.5d0)))))))
    (is (near (/ acceleration 2) (* 0.02d0 acceleration) (slide 0.3d0 1)))))

(test sphere-rolls-by-its-inertia
  (bullet:with-world (world)
    (let ((slope (geometry:make-pose 0 0 0 :pitch (atan 0.1d0))))
      (bullet:add-body world :slope '(:box 20 1 0.1d0) slope :friction 1)
      (let ((ball (bullet:add-body world :ball '(:sphere 0.05d0)
                                   (geometry:compose slope (geometry:make-pose 0 0 0.1d0))
                                   :mass 1 :friction 1)))
        (bullet:step-world world 24)
        (let ((speed (bullet:body-velocity ball)))
          (bullet:step-world world 240)
          (is (near (* 5/7 9.81d0 (sin (atan 0.1d0)) (cos (atan 0.1d0))) 0.01d0
                    (- (bullet:body-velocity ball) speed))))))))

(test inertia-is-that-of-the-shape
  (flet ((inertia-p (moments shape)
           (every (lambda (x y) (near x 1d-12 y)) moments (bullet::shape-inertia shape 2d0)))
         (at (x z &rest turn)
           (apply #'geometry:make-pose x 0 z turn)))
    (is-true (inertia-p '(13/6 10/6 5/6) '(:box 1 2 3)))
    (is-true (inertia-p '(0.8d0 0.8d0 0.8d0) '(:sphere 1)))
    (is-true (inertia-p '(2 2 1) '(:cylinder 1 3)))
    (is-true (inertia-p '(2 2 1) `(:compound (,(at 0 1) (:cylinder 1 1))
                                             (,(at 0 -1/2) (:cylinder 1 2)))))
    (is-true (inertia-p '(1 2 2) `(:compound (,(at 0 0 :pitch (/ pi 2)) (:cylinder 1 3)))))
    (is-true (inertia-p '(1/3 25/3 25/3)
                        `(:compound (,(at 2 0) (:box 1 1 1)) (,(at -2 0) (:box 1 1 1)))))))

(test kinematic-body-pushes
  (bullet:with-world (world)
    (add-floor world)
    (let ((cube (add-cube world :cube 0.2d0 0.05d0))
          (pusher (bullet:add-body world :pusher '(:box 0.1d0 0.1d0 0.05d0)
                                   (geometry:make-pose 0 0 0.05d0) :kind :kinematic)))
      (loop for i from 1 to 240
            do (bullet:move-body pusher (geometry:make-pose (* 0.2d0 i 1/240) 0 0.05d0))
               (bullet:step-world world))
      (is (near 0.3d0 5d-3 (distance cube)))
      (is (near 0.2d0 1d-3 (bullet:body-velocity pusher)))
      (bullet:step-world world)
      (is (near 0 1d-9 (bullet:body-velocity pusher))))))

(test kinematic-shelf-drags-what-sleeps-on-it
  (bullet:with-world (world)
    (let ((shelf (bullet:add-body world :shelf '(:box 0.5d0 0.5d0 0.1d0) (geometry:identity-pose)
                                  :kind :kinematic))
          (cube (add-cube world :cube 0 0.1d0)))
      (bullet:step-world world 480)
      (is-true (bullet:asleep-p cube))
      (loop for i from 1 to 240
            do (bullet:move-body shelf (geometry:make-pose (* 0.2d0 i 1/240) 0 0))
               (bullet:step-world world))
      (is (near 0.2d0 0.02d0 (distance cube)))
      (bullet:step-world world 480)
      (is-true (bullet:asleep-p cube))
      (bullet:move-body shelf (geometry:make-pose 50 0 0))
      (bullet:step-world world 120)
      (is (< (height cube) -0.5d0)))))

(test placing-teleports-at-rest
  (bullet:with-world (world)
    (let ((shelf (bullet:add-body world :shelf '(:box 0.5d0 0.5d0 0.1d0) (geometry:identity-pose)))
          (cube (add-cube world :cube 0 2)))
      (bullet:step-world world 60)
      (bullet:place-body cube (geometry:make-pose 0 0 0.1d0))
      (is (every #'zerop (multiple-value-list (bullet:body-velocity cube))))
      (bullet:step-world world 240)
      (is (near 0.1d0 1d-4 (height cube)))
      (is-true (bullet:asleep-p cube))
      (bullet:place-body shelf (geometry:make-pose 5 0 0))
      (is (every #'zerop (multiple-value-list (bullet:body-velocity shelf))))
      (bullet:step-world world 120)
      (is (< (height cube) -0.5d0)))))

(test placed-kinematic-body-drags-nothing
  (bullet:with-world (world)
    (let ((shelf (bullet:add-body world :shelf '(:box 2 2 0.1d0) (geometry:identity-pose)
                                  :kind :kinematic))
          (cube (add-cube world :cube 0 0.1d0)))
      (bullet:step-world world 60)
      (bullet:place-body shelf (geometry:make-pose 0.1d0 0 0))
      (bullet:step-world world)
      (is (near 0 1d-9 (bullet:body-velocity shelf)))
      (is (near 0.1d0 1d-12 (distance shelf)))
      (bullet:step-world world 60)
      (is (near 0 1d-4 (distance cube))))))

(test static-and-kinematic-bodies-pass-through-each-other
  (bullet:with-world (world)
    (bullet:add-body world :wall '(:box 1 1 1) (geometry:identity-pose))
    (let ((link (bullet:add-body world :link '(:box 1 1 1) (geometry:make-pose 0.5d0 0 0)
                                 :kind :kinematic)))
      (bullet:step-world world 10)
      (is (= 0.5d0 (distance link)))
      (is (= 0 (bullet:deepest-penetration world))))))

(test ignored-collisions-let-bodies-through
  (bullet:with-world (world)
    (let ((floor (add-floor world))
          (cube (add-cube world :cube 0 0.05d0)))
      (bullet:step-world world 240)
      (is-true (bullet:asleep-p cube))
      (dotimes (i 2) (bullet:ignore-collision cube floor t))
      (bullet:step-world world 24)
      (is (< (height cube) 0.02d0))
      (is (= 0 (bullet:deepest-penetration world)))
      (is (> (bullet:penetration cube floor) 0.03d0))
      (bullet:ignore-collision floor cube nil)
      (is (> (bullet:deepest-penetration world) 0.03d0))
      (bullet:step-world world 480)
      (is (near 0.05d0 1d-3 (height cube))))))

;;; Attachments

(test attached-box-follows-the-gripper
  (bullet:with-world (world)
    (add-floor world)
    (let* ((gripper (bullet:add-body world :gripper '(:box 0.05d0 0.05d0 0.05d0)
                                     (geometry:make-pose 0 0 0.62d0) :kind :kinematic))
           (cube (add-cube world :cube 0 0.55d0))
           (attachment (bullet:attach gripper cube)))
      (is (string= "#<ATTACHMENT GRIPPER holds CUBE>" (princ-to-string attachment)))
      (is (equal (list attachment) (bullet:attachments world)))
      (is (eq gripper (bullet:attachment-parent attachment)))
      (is (eq cube (bullet:attachment-child attachment)))
      (bullet:step-world world 240)
      (multiple-value-bind (force torque) (bullet:attachment-load attachment)
        (is (every (lambda (x y) (near x 1d-3 y)) '(0 0 9.81d0) force))
        (is (every (lambda (x) (near 0 1d-3 x)) torque)))
      (loop for i from 1 to 480
            for x = (- i (* (/ 240 pi) (sin (* pi i 1/240))))
            do (bullet:move-body gripper (geometry:make-pose (/ x 480) 0 0.62d0))
               (bullet:step-world world))
      (is (near 1 2d-3 (distance cube)))
      (is (near 0.55d0 1d-3 (height cube)))
      (is-true (bullet:at-rest-p world))
      (bullet:detach attachment)
      (bullet:detach attachment)
      (is-false (bullet:attachment-live-p attachment))
      (is (null (bullet:attachments world)))
      (is (string= "#<ATTACHMENT GRIPPER held CUBE>" (princ-to-string attachment)))
      (signals bullet:bullet-error (bullet:attachment-load attachment))
      (bullet:step-world world 480)
      (is (near 0.05d0 1d-3 (height cube)))
      (is-true (bullet:asleep-p cube)))))

(test attachment-bears-a-lever
  (bullet:with-world (world)
    (let* ((post (bullet:add-body world :post '(:box 0.1d0 0.1d0 0.1d0) (geometry:make-pose 0 0 1)))
           (cube (add-cube world :cube 0.3d0 1 :mass 2))
           (attachment (bullet:attach post cube)))
      (bullet:step-world world 240)
      (multiple-value-bind (force torque) (bullet:attachment-load attachment)
        (is (near 19.62d0 2d-2 (third force)))
        (is (near 0 1d-2 (second torque))))
      (is (near 0.3d0 1d-3 (distance cube))))))

(test attached-bodies-may-overlap
  (bullet:with-world (world)
    (let ((gripper (bullet:add-body world :gripper '(:box 0.1d0 0.1d0 0.1d0)
                                    (geometry:identity-pose) :kind :kinematic))
          (cube (add-cube world :cube 0.09d0 0)))
      (bullet:step-world world 1)
      (let ((x (distance cube))
            (attachment (bullet:attach gripper cube)))
        (bullet:step-world world 3)
        (is (near x 3d-3 (distance cube)))
        (is (every (lambda (x y) (near x 1d-2 y)) '(0 0 9.81d0)
                   (bullet:attachment-load attachment)))
        (is (= 0 (bullet:deepest-penetration world)))
        (bullet:detach attachment)
        (is (> (bullet:deepest-penetration world) 0))))))
