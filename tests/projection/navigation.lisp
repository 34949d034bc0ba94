;;;; Tests of navigation: profiles, outlines, terrain, base paths, and going in the kitchen.

(in-package #:discrepancy-finder.tests)

(def-suite navigation :in all)
(in-suite navigation)

(test profiles-are-trapezoids
  (let ((long (projection::make-profile 3d0 1d0 1d0 2.5d0))
        (short (projection::make-profile 0.2d0 1d0 1d0 2.5d0)))
    (is (nearly 3.7d0 (projection::profile-duration long) 1d-12))
    (is (nearly 0.5 (projection::profile-distance long 1d0) 1d-12))
    (is (nearly 1.5 (projection::profile-distance long 2d0) 1d-12))
    (is (nearly (- 3 (* 1/2 2.5d0 1/100))
                (projection::profile-distance long (- (projection::profile-duration long) 0.1d0))
                1d-12))
    (is (nearly (sqrt (* 2 0.2d0 (/ 2.5d0 3.5d0))) (projection::profile-speed short) 1d-6)
        "a short move never reaches its speed")
    (dolist (profile (list long short (projection::make-profile 0d0 1d0 1d0)))
      (let ((fractions (projection::profile-fractions profile)))
        (is (every #'<= fractions (subseq fractions (min 1 (length fractions)))))
        (is-true (or (zerop (length fractions))
                     (= 1 (aref fractions (1- (length fractions))))))))))

(defun piece-of (shape &rest pose)
  (first (projection::shape-pieces shape (apply #'geometry:make-pose pose))))

(test outlines-are-as-far-apart-as-the-shapes
  (let ((box (piece-of '(:box 1d0 2d0 1d0) 0 0 0.5)))
    (is (nearly 0.5 (projection::separation box (piece-of '(:box 1d0 1d0 1d0) 1.5 0 0.5)) 1d-12))
    (is (nearly 0.1d0 (projection::separation box (piece-of '(:box 1d0 1d0 1d0) 1.5 0 0.5)
                                              0.4d0 0d0)
                1d-12))
    (is (minusp (projection::separation box (piece-of '(:cylinder 0.1d0 1d0) 0.55 0 0.5))))
    (is (nearly 0.05 (projection::separation box (piece-of '(:sphere 0.1d0) 0.65 0 0.5)) 3d-3))
    (is (nearly (- 1.5 0.5 (/ (sqrt 2d0) 2))
                (projection::separation box (piece-of '(:box 1d0 1d0 1d0) 1.5 0 0.5
                                                      :yaw (/ pi 4)))
                1d-9))
    (is-true (projection::heights-meet-p box (piece-of '(:box 1d0 1d0 1d0) 0 0 1.4)))
    (is-false (projection::heights-meet-p box (piece-of '(:box 1d0 1d0 1d0) 0 0 1.5)))
    (is (= 2 (length (projection::shape-pieces
                      (list :compound
                            (list (geometry:make-pose 0 0 0) '(:box 1d0 1d0 1d0))
                            (list (geometry:make-pose 0 0 1) '(:sphere 0.1d0)))
                      (geometry:make-pose 0 0 0)))))))

(defun sill-terrain ()
  "Return the terrain of a sill of 8 mm across x = 0, 10 cm wide, for a base of 0.67 m."
  (projection::make-terrain (list (piece-of '(:box 0.1d0 4d0 0.008d0) 0 0 0.004))
                            (projection::wheel-places (piece-of '(:box 0.67d0 0.67d0 0.3d0)
                                                                0 0 0.17))
                            0.05d0))

(test a-base-rises-and-pitches-at-a-sill
  (let ((terrain (sill-terrain)))
    (flet ((height (x)
             (geometry:pose-z (projection::ground-pose terrain (float x 1d0) 0d0 0d0 0d0))))
      (is (= 0 (height -1)))
      (is (= 0 (height 0)) "the sill is between the wheels")
      (is (nearly 0.004 (height 0.255) 1d-9) "two wheels are on it")
      (is (nearly 0.004 (height -0.255) 1d-9))
      (loop with step = 1/240
            for x from -0.6 to 0.6 by step
            maximize (abs (/ (+ (height (- x step)) (height (+ x step)) (* -2 (height x)))
                             (* step step)))
              into most
            finally (is (< 1 most (/ (* 5.8 0.004) (expt 0.05 2)))
                        "at 1 m/s the base is accelerated upwards by at most ~a m/s^2" most)))))

(defun largest-acceleration (bases)
  "Return the largest horizontal acceleration (m/s^2) between the steps of the motion BASES."
  (loop for step from 1 below (- (/ (length bases) 7) 2)
        maximize (flet ((second-difference (offset)
                          (flet ((value (shift) (aref bases (+ offset (* 7 (+ step shift))))))
                            (* 240 240 (+ (value -1) (value 1) (* -2 (value 0)))))))
                   (sqrt (+ (expt (second-difference 0) 2) (expt (second-difference 1) 2))))))

(test corners-are-driven-within-the-accelerations
  (let* ((gait (projection::make-gait 1d0 1d0 2.5d0 1d0))
         (goal (geometry:make-pose 2 2 0 :yaw 1))
         (path '((0d0 0d0 0d0) (2d0 0d0 0d0) (2d0 2d0 1d0))))
    (flet ((bases (free-p)
             (projection::path-bases gait path (sill-terrain) 0d0 free-p goal)))
      (let ((cut (bases (constantly t))) (stopped (bases (constantly nil))))
        (is (< (length cut) (length stopped)) "to stop at a corner takes longer")
        (dolist (motion (list cut stopped))
          (is (< (largest-acceleration motion) 2.6))
          (is (equalp (coerce (geometry:pose-components goal) 'vector)
                      (subseq motion (- (length motion) 7)))))
        (is (> (loop for i from 0 below (length stopped) by 7 maximize (aref stopped i)) 1.999))
        (is (zerop (length (projection::path-bases gait '((0d0 0d0 0d0) (0d0 0d0 0d0))
                                                   (sill-terrain) 0d0 (constantly t)
                                                   goal))))))))

;;; In the kitchen

(defun base-path (projection x y yaw)
  (projection:plan-base-path projection (geometry:make-pose x y 0 :yaw yaw)))

(test the-base-finds-its-way-around-the-table
  (projection:with-projection (projection (kitchen-scene)
                                          :poses (list :robot (geometry:make-pose -0.3 0.3 0)))
    (projection:settle projection)
    (let ((path (base-path projection 1.35 0 pi)))
      (is (< 2 (length path) 9) "the table is in the way")
      (is (equal path (base-path projection 1.35 0 pi)))
      (let ((footing (projection::projection-footing projection)))
        (loop for (from to) on path
              while to
              do (loop for i from 0 to 20
                       for place = (mapcar (lambda (a b) (+ a (* i 1/20 (- b a)))) from to)
                       do (is (plusp (projection::footing-clearance footing place)))))))
    (plan:perform (going-to 1.35 0 pi))
    (is (nearly 1.35d0 (geometry:pose-x (projection:observed-pose projection :robot)) 1d-9))
    (is (= 2 (length (base-path projection 1.4 0.2 3))) "straight where nothing is in the way")))

(test no-way-leads-through-a-wall
  "What is in the room is connected, what is outside is not; a search then sees no place twice."
  (projection:with-projection (kitchen (kitchen-scene))
    (flet ((connected-p (x y)
             (let* ((robot (projection:projection-robot kitchen))
                    (start (projection::base-place robot))
                    (goal (list (float x 1d0) (float y 1d0) 0d0))
                    (footing (projection::projection-footing kitchen)))
               (and (projection::connected-p
                     footing start goal
                     (projection::lattice-bounds footing start goal))
                    t))))
      (is (equal '(t t t nil nil)
                 (list (connected-p 1.5 1.5) (connected-p -1.4 0.2) (connected-p 1.4 0)
                       (connected-p 3.5 0) (connected-p 5 5)))))
    (multiple-value-bind (path reason)
        (projection:plan-base-path kitchen (geometry:make-pose 3.5 0 0))
      (is (null path))
      (is (eq :path reason)))))

(test a-place-that-is-taken-is-refused-by-the-name-of-what-is-there
  (projection:with-projection (projection (kitchen-scene) :joints '(("drawer_2_joint" . 0.4d0)))
    (signals-with (plan:navigation-pose-unreachable "would touch counter/drawer_2")
      (plan:perform (going-to -1.37 0.14 pi)))))

(test places-that-are-taken-are-refused
  (projection:with-projection (projection (kitchen-scene))
    (projection:settle projection)
    (dolist (place '((0.5 0 0) (-2.2 0 0) (2.4 0 0)))
      (is (not (projection:base-pose-free-p projection
                                            (apply (lambda (x y yaw)
                                                     (geometry:make-pose x y 0 :yaw yaw))
                                                   place)))
          "~a is taken" place)
      (signals plan:navigation-pose-unreachable (plan:perform (apply #'going-to place))))
    (is (projection:base-pose-free-p projection (geometry:make-pose -0.4 0 0)))
    (multiple-value-bind (path problem) (base-path projection 5 0 0)
      (is (null path))
      (is (eq :path problem) "outside of the room nothing is in the way but the walls"))))

(test an-open-drawer-is-in-the-way
  (flet ((free-p (position)
           (projection:with-projection (projection (kitchen-scene)
                                                   :poses (list :robot
                                                                (geometry:make-pose -0.3 0 0))
                                                   :joints (list (cons "drawer_2_joint"
                                                                       position)))
             (projection:settle projection)
             (projection:base-pose-free-p projection
                                          (geometry:make-pose -1.5 0 0 :yaw pi)))))
    (is-true (free-p 0))
    (is-false (free-p 0.35))))

(test the-base-stops-beside-its-goal-by-the-tolerances
  (projection:with-projection (projection (kitchen-scene)
                                          :parameters '(:base-stopping-error-x 0.01
                                                        :base-stopping-error-y -0.005
                                                        :base-stopping-error-yaw 0.02))
    (projection:settle projection)
    (plan:perform (going-to -0.4 0.5 (/ pi 2)))
    (let ((pose (projection:observed-pose projection :robot)))
      (is (nearly -0.395d0 (geometry:pose-x pose) 1d-9) "to the right of its goal")
      (is (nearly 0.51d0 (geometry:pose-y pose) 1d-9) "and ahead of it")
      (is (nearly (+ (/ pi 2) 0.02d0) (geometry:pose-yaw pose) 1d-9)))))

(test both-fidelities-drive-alike
  (flet ((result (fidelity)
           (projection:with-projection (projection (kitchen-scene) :fidelity fidelity)
             (projection:settle projection)
             (plan:perform (going-to -0.4 0.5 0))
             (list (geometry:pose-components (projection:observed-pose projection :robot))
                   (round (* 240 (projection:simulated-seconds projection)))))))
    (is (equal (result :fast) (result :full)))))

(test a-bold-base-is-stopped-by-what-it-meets
  (projection:with-projection (projection (kitchen-scene))
    (projection:settle projection)
    (multiple-value-bind (reason bodies)
        (projection:run-base projection (list (projection::base-place
                                               (projection::projection-robot projection))
                                              (list 0.5d0 0d0 0d0)))
      (is (eq :contact reason))
      (is (search "table" (bullet:body-name (second bodies)))))
    (is (zerop (projection::fixture-contact projection)))
    (plan:perform (going-to -0.6 0 0))
    (is (nearly -0.6d0 (geometry:pose-x (projection:observed-pose projection :robot)) 1d-9)
        "it gets away again")))
