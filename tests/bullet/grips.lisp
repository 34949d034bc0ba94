;;;; Tests of the Bullet layer: grips against the limit surface of soft fingers.

(in-package #:discrepancy-finder.tests)

(in-suite bullet)

(defun hold-and-drive (&key (mass 0.4d0) (beside 0d0) (above 0d0) (acceleration 0d0) (turn 0d0)
                         (capacity 20d0) (axis '(0 1 0)) (steps 120))
  "Hold an item that is gripped BESIDE and ABOVE its centre of mass for 1/4 s, then drive along x
with ACCELERATION and turn about z with the angular acceleration TURN.  Return the last utilization,
whether the item was lost, and whether it is still held."
  (bullet:with-world (world)
    (let* ((palm (bullet:add-body world :palm '(:box 0.05d0 0.05d0 0.05d0) (at 0 0 1)
                                  :kind :kinematic))
           (item (bullet:add-body world :item '(:box 0.06d0 0.06d0 0.2d0) (at 0.1d0 0 1)
                                  :mass mass))
           (grip (bullet:attach palm item :point (at beside 0 above) :axis axis
                                          :capacity capacity :torsion-radius 0.012d0)))
      (bullet:step-world world 60)
      (loop for i from 1 to steps
            for time = (/ i 240d0)
            do (bullet:move-body palm (geometry:make-pose (* 1/2 acceleration time time) 0 1
                                                          :yaw (* 1/2 turn time time)))
               (bullet:step-world world)
            until (bullet:attachment-lost-p grip))
      (values (bullet:attachment-utilization grip)
              (bullet:attachment-lost-p grip)
              (bullet:attachment-live-p grip)))))

(defun utilization (mass beside above acceleration capacity)
  "The closed form: gravity and acceleration on the item, its weight on the arm BESIDE, and the
inertia on the arm ABOVE."
  (let ((force (* mass (sqrt (+ (expt 9.81d0 2) (expt acceleration 2)))))
        (torque (* mass (abs (- (* 9.81d0 beside) (* acceleration above))))))
    (sqrt (+ (expt (/ force capacity) 2) (expt (/ torque (* capacity 0.012d0)) 2)))))

(test grip-utilization-is-the-limit-surface
  (loop for (mass beside above acceleration)
          in '((0.4d0 0d0 0d0 0d0) (1d0 0d0 0d0 0d0) (0.4d0 0.02d0 0d0 0d0)
               (0.4d0 0d0 0.05d0 0d0) (0.4d0 0d0 0d0 3d0) (0.4d0 0d0 -0.05d0 2d0)
               (0.4d0 0.02d0 0.05d0 2d0) (0.4d0 -0.02d0 0.05d0 3d0) (1d0 -0.005d0 0.02d0 1d0))
        for expected = (utilization mass beside above acceleration 1000d0)
        do (is (near expected (* 1d-3 expected)
                     (hold-and-drive :mass mass :beside beside :above above
                                     :acceleration acceleration :capacity 1000d0)))))

(test grip-is-lost-beyond-its-capacity
  (loop for (mass beside above acceleration)
          in '((0.4d0 0d0 0d0 0d0) (0.4d0 -0.02d0 0d0 0d0) (0.4d0 0d0 0.08d0 2d0)
               (1d0 -0.01d0 0.04d0 3d0))
        for limit = (utilization mass beside above acceleration 1d0)
        do (flet ((lost-p (capacity)
                    (multiple-value-bind (last lost live)
                        (hold-and-drive :mass mass :beside beside :above above
                                        :acceleration acceleration :capacity capacity)
                      (declare (ignore last))
                      (is (not (eq lost live)))
                      lost)))
             (is-true (lost-p (* 0.99d0 limit)))
             (is-false (lost-p (* 1.01d0 limit))))))

(test grip-holds-along-its-axis
  "Across the axis there is nothing to bear if gravity is along it."
  (is (near 0 1d-6 (hold-and-drive :axis '(0 0 1))))
  (is (near (/ (* 0.4d0 2) 20) 1d-4 (hold-and-drive :axis '(0 0 1) :acceleration 2d0))))

(test turning-loads-a-grip-by-the-lever
  "An item 0.1 m from the turning axis has that much times the angular acceleration."
  (let ((alpha 5d0) (inertia (* 0.4d0 (/ (+ 0.0036d0 0.0036d0) 12))))
    (is (near (sqrt (+ (expt (/ (* 0.4d0 alpha 0.1d0) 100) 2)
                       (expt (/ (* alpha inertia) (* 100 0.012d0)) 2)))
              2d-4
              (hold-and-drive :axis '(0 0 1) :turn alpha :capacity 100d0 :steps 6)))))

(test lost-child-keeps-its-velocity-and-falls
  (bullet:with-world (world)
    (add-floor world)
    (let* ((palm (bullet:add-body world :palm '(:box 0.05d0 0.05d0 0.05d0) (at 0 0 1)
                                  :kind :kinematic))
           (item (bullet:add-body world :item '(:box 0.06d0 0.06d0 0.06d0) (at 0.1d0 0 1)
                                  :mass 1))
           (grip (bullet:attach palm item :capacity 10)))
      (is (string= "#<ATTACHMENT PALM holds ITEM>" (princ-to-string grip)))
      (is-false (bullet:attachment-lost-p grip))
      (bullet:step-world world 24)
      (is (near 0.981d0 1d-3 (bullet:attachment-utilization grip)))
      (loop for i from 1
            do (bullet:move-body palm (at (* i i 1/57600) 0 1))
               (bullet:step-world world)
            until (bullet:attachment-lost-p grip)
            finally (is (< i 5)))
      (is (> (bullet:attachment-utilization grip) 1))
      (is (string= "#<ATTACHMENT PALM held ITEM>" (princ-to-string grip)))
      (is (null (bullet:attachments world)))
      (signals bullet:bullet-error (bullet:attachment-load grip))
      (bullet:detach grip)
      (is-true (bullet:attachment-lost-p grip))
      (is (> (bullet:body-velocity item) 0.005d0))
      (bullet:step-world world 480)
      (is (near 0.03d0 1d-3 (height item)))
      (is-true (bullet:asleep-p item))
      (let ((rigid (bullet:attach palm item)))
        (is (= 0 (bullet:attachment-utilization rigid)))
        (bullet:detach rigid)
        (is-false (bullet:attachment-lost-p rigid))))))

(test carried-child-keeps-its-place-in-the-hand
  (bullet:with-world (world)
    (let* ((palm (bullet:add-body world :palm '(:box 0.05d0 0.05d0 0.05d0) (at 0 0 1)
                                  :kind :kinematic))
           (item (bullet:add-body world :item '(:box 0.06d0 0.06d0 0.06d0) (at 0.1d0 0 1)
                                  :mass 1))
           (grip (bullet:attach palm item)))
      (loop for i from 1 to 240
            do (bullet:move-body palm (at (* 0.5d0 (- 1 (cos (* i 0.02d0)))) 0 1))
               (bullet:step-world world)
            maximize (abs (- (distance item) (distance palm) 0.1d0)) into most
            finally (is (< most 1d-6)))
      (is (near 9.81d0 1d-2 (third (bullet:attachment-load grip)))))))

(test wrong-grips-are-refused
  (bullet:with-world (world)
    (let ((palm (bullet:add-body world :palm '(:sphere 0.05d0) (at 0 0 1) :kind :kinematic))
          (item (add-cube world :item 0.2d0 1)))
      (refuses "attach failed: the axis of a grip must have length 1."
               (bullet:attach palm item :capacity 10 :axis '(0 1 1)))
      (refuses "attach failed: the capacity of a grip is 0, but must be a positive number, ~
from 1e-30 to 1e9." (bullet:attach palm item :capacity 0))
      (refuses "attach failed: the axis of a grip is (0 1), but must be a list of three numbers."
               (bullet:attach palm item :capacity 10 :axis '(0 1)))
      (loop for options in (list (list :capacity (nan)) '(:capacity -1)
                                 '(:capacity 1 :torsion-radius 0)
                                 (list :capacity 1 :axis (list 0 1 (nan))) '(:capacity "x"))
            do (signals bullet:bullet-error (apply #'bullet:attach palm item options)))
      (is (null (bullet:attachments world))))))
