(in-package #:discrepancy-finder.tests)

(def-suite geometry :in all)
(in-suite geometry)

(defun nearly (a b &optional (tolerance 1d-12))
  (< (abs (- a b)) tolerance))

(defun poses-nearly-equal-p (a b)
  (every #'nearly (geometry:pose-components a) (geometry:pose-components b)))

(test yaw-of-a-pose
  (is (nearly 0.7d0 (geometry:pose-yaw (geometry:make-pose 1 2 3 :yaw 0.7d0))))
  (is (nearly -3d0 (geometry:pose-yaw (geometry:make-pose 0 0 0 :yaw -3)))))

(test fixed-axis-angles
  "Roll by 90 degrees, then yaw by 90 degrees, takes the y axis to z: URDF's convention."
  (let* ((half (/ pi 2))
         (turned (geometry:compose (geometry:make-pose 0 0 0 :roll half :yaw half)
                                   (geometry:make-pose 0 1 0))))
    (is (nearly 0 (geometry:pose-x turned)))
    (is (nearly 0 (geometry:pose-y turned)))
    (is (nearly 1 (geometry:pose-z turned)))))

(test poses-are-a-group
  (let ((a (geometry:make-pose 1 -2 0.5 :roll 0.1 :pitch 0.4 :yaw 2))
        (b (geometry:make-pose -3 0.25 7 :roll -1 :pitch 0.2 :yaw -0.3))
        (c (geometry:make-pose 0.1 0.2 0.3 :pitch 1)))
    (is (poses-nearly-equal-p (geometry:identity-pose)
                              (geometry:compose a (geometry:inverse a))))
    (is (poses-nearly-equal-p (geometry:compose (geometry:compose a b) c)
                              (geometry:compose a (geometry:compose b c))))
    (is (geometry:pose= a (geometry:components-pose (geometry:pose-components a))))
    (is (not (geometry:pose= a b)))))

(test compose-gives-the-outer-frame
  (let ((pose (geometry:compose (geometry:make-pose 1 1 0 :yaw (/ pi 2))
                                (geometry:make-pose 2 0 0))))
    (is (nearly 1 (geometry:pose-x pose)))
    (is (nearly 3 (geometry:pose-y pose)))
    (is (nearly 5 (geometry:planar-distance (geometry:make-pose 0 0 9)
                                            (geometry:make-pose 3 4 0))))))
