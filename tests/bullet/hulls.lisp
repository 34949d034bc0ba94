;;;; Tests of the Bullet layer: convex hulls, and mass properties of shapes.

(in-package #:discrepancy-finder.tests)

(in-suite bullet)

(defun box-corners (x y z)
  (loop for sx in '(-1/2 1/2)
        nconc (loop for sy in '(-1/2 1/2)
                    nconc (loop for sz in '(-1/2 1/2)
                                collect (list (* sx x) (* sy y) (* sz z))))))

(defparameter *box-hull* (list* :hull (box-corners 0.2d0 0.3d0 0.4d0)))

(defparameter *octahedron*
  '(:hull (1 0 0) (-1 0 0) (0 1 0) (0 -1 0) (0 0 1) (0 0 -1)))

(defun points-on-a-ball (count radius)
  "Return COUNT points, in no order, on a ball."
  (let ((random (random-numbers 7)))
    (loop repeat count
          collect (loop for v = (list (funcall random) (funcall random) (funcall random))
                        for length = (sqrt (reduce #'+ (mapcar #'* v v)))
                        until (< 0.1d0 length 1)
                        finally (return (mapcar (lambda (x) (* radius (/ x length))) v))))))

(test rays-meet-hulls
  (bullet:with-world (world)
    (bullet:add-body world :octahedron *octahedron* (at 5 0 0))
    (is (near 0.4d0 1d-12 (fourth (hit-of world '(0 0 0) '(10 0 0)))) "at a corner")
    (let ((n (sqrt (/ 1d0 3))))
      (hits `(:octahedron (4.5d0 0.25d0 0.25d0) (,(- n) ,n ,n) 0.45d0) world
            '(0 0.25d0 0.25d0) '(10 0.25d0 0.25d0))
      (is (null (hit-of world '(0 0.501 0.5) '(10 0.501 0.5))))
      (hits '(:octahedron (5.1d0 0.1d0 0.1d0) (0 0 -1) 0) world '(5.1d0 0.1d0 0.1d0)
            '(5.1d0 0.1d0 9)))))

(test hull-of-a-box-is-the-box
  "To rays, in a compound, too."
  (let ((random (random-numbers 11))
        (turn (geometry:make-pose 0.1d0 0 0.2d0 :roll 1 :yaw 2)))
    (bullet:with-world (world)
      (bullet:with-world (other)
        (bullet:add-body world :a `(:compound (,turn ,*box-hull*)) (at 0 0 0))
        (bullet:add-body other :a `(:compound (,turn (:box 0.2d0 0.3d0 0.4d0))) (at 0 0 0))
        (flet ((place () (loop repeat 3 collect (* 0.5d0 (funcall random)))))
          (loop repeat 100
                for from = (place)
                for to = (place)
                for hit = (hit-of other from to)
                count hit into hits
                do (is (same-hit-p hit (hit-of world from to)))
                finally (is (< 10 hits 90))))))))

(test convex-hull-keeps-corners
  (let ((corners (mapcar (lambda (corner) (mapcar (lambda (x) (float x 1d0)) corner))
                         (box-corners 2 3 4)))
        (inner '((0 0 0) (0.5d0 0.5d0 0.5d0) (-0.9d0 1 1) (1 1/2 1/4))))
    (is (null (set-exclusive-or corners (bullet:convex-hull (append inner corners inner))
                                :test #'equal)))))

(test convex-hull-is-small-and-close
  (let* ((points (points-on-a-ball 2000 0.1d0))
         (hull (bullet:convex-hull points)))
    (is (= 40 (length hull)))
    (is (null (set-difference hull points :test #'equal)))
    (is (equal hull (bullet:convex-hull (coerce points 'vector))))
    (is (= 12 (length (bullet:convex-hull points :vertices 12))))
    (let ((volume (bullet:shape-volume `(:hull ,@hull))) (ball (* 4/3 pi 1d-3)))
      (is (< (* 0.8d0 ball) volume ball))
      (is (< (bullet:shape-volume `(:hull ,@(bullet:convex-hull points :vertices 12)))
             volume)))))

(test hulls-come-to-rest-on-their-faces
  (bullet:with-world (world)
    (let ((floor (add-floor world))
          (lower (bullet:add-body world :lower *box-hull* (at 0 0 0.21d0) :mass 1))
          (upper (bullet:add-body world :upper `(:compound (,(geometry:identity-pose) ,*box-hull*))
                                  (at 0 0 0.62d0) :mass 1)))
      (bullet:step-world world 480)
      (is-true (bullet:asleep-p upper))
      (is (near 0.2d0 1d-3 (height lower)))
      (is (near 0.6d0 1d-3 (height upper)))
      (is (near 0 1d-4 (bullet:penetration lower floor)))
      (is (near 0 1d-4 (bullet:pair-distance lower upper 1)))
      (bullet:place-body upper (at 0 0 0.55d0))
      (is (near 0.05d0 2d-3 (bullet:penetration lower upper))))))

(test flat-hulls-are-refused
  (bullet:with-world (world)
    (loop for points in `(() ((0 0 0) (1 0 0) (0 1 0))
                          ((0 0 0) (1 0 0) (0 1 0) (1 1 0)) ((0 0 0) (1 1 1) (2 2 2) (3 3 3))
                          ((0 0 0) (0 0 0) (0 0 0) (0 0 0)) ((0 0 0) (1 0 0) (0 1 0) (1 1 1d-6))
                          ((0 0 0) (1 0 0) (0 1 0) (0 0)) ((0 0 0) (1 0 0) (0 1 0) (0 0 "x"))
                          ((0 0 0) (1 0 0) (0 1 0) (0 0 ,(nan))))
          do (signals bullet:bullet-error (bullet:convex-hull points))
             (signals bullet:bullet-error
               (bullet:add-body world :hull `(:hull ,@points) (at 0 0 0)))
             (signals bullet:bullet-error
               (bullet:add-body world :hull `(:compound (,(at 0 0 0) (:hull ,@points)))
                                (at 0 0 0))))
    (refuses "convex-hull failed: the points are fewer than four or all in one plane."
             (bullet:convex-hull '((0 0 0))))
    (refuses "convex-hull failed: the number of vertices is 41, but must be 4 to 40."
             (bullet:convex-hull (points-on-a-ball 50 1) :vertices 41))
    (signals bullet:bullet-error
      (bullet:add-body world :hull `(:hull ,@(points-on-a-ball 41 1)) (at 0 0 0)))
    (is (null (bullet:world-bodies world)))))

;;; Mass

(defun all-near-p (expected tolerance actual)
  (every (lambda (x y) (near x tolerance y)) expected actual))

(test mass-properties-of-hulls-and-compounds
  (is (near 4/3 1d-12 (bullet:shape-volume *octahedron*)))
  (is (near 1/6 1d-12 (bullet:shape-volume '(:hull (0 0 0) (1 0 0) (0 1 0) (0 0 1)))))
  (is (near 0.024d0 1d-12 (bullet:shape-volume *box-hull*)))
  (is (all-near-p (bullet:shape-inertia '(:box 0.2d0 0.3d0 0.4d0) 2) 1d-12
                  (bullet:shape-inertia *box-hull* 2)))
  (is (all-near-p '(0.4d0 0.4d0 0.4d0) 1d-12 (bullet:shape-inertia *octahedron* 2)))
  (multiple-value-bind (moments pose)
      (bullet:mass-properties '(:hull (0 0 0) (1 0 0) (0 1 0) (0 0 1)) 1)
    (is (all-near-p '(1/4 1/4 1/4) 1d-12 (subseq (geometry:pose-components pose) 0 3)))
    ;; For mass 1 the mean of x^2 about the centre is 1/10 - 1/16 = 3/80, that of x y is
    ;; 1/20 - 1/16 = -1/80: it is 1/80 along (1 1 1) and 4/80 across, and 9/80 in all.
    (is (all-near-p '(5/80 5/80 8/80) 1d-9
                    (sort (copy-list moments) #'<)))))

(test mass-properties-do-not-depend-on-the-frame
  (let ((pose (geometry:make-pose 1 2 3 :roll 0.4d0 :pitch 0.5d0 :yaw 0.6d0)))
    (dolist (shape (list *box-hull* '(:box 0.2d0 0.3d0 0.4d0)))
      (multiple-value-bind (moments inertial)
          (bullet:mass-properties `(:compound (,pose ,shape)) 3)
        (is (all-near-p (sort (bullet:shape-inertia *box-hull* 3) #'<) 1d-9
                        (sort (copy-list moments) #'<)))
        (is (near 1 1d-12 (geometry:pose-x inertial)))
        (is (near 3 1d-12 (geometry:pose-z inertial)))))))

(test principal-axes-diagonalize
  (let ((random (random-numbers 5)))
    (dotimes (i 50)
      (destructuring-bind (a b c d e f) (loop repeat 6 collect (funcall random))
        (let ((ixx (+ 4 a)) (iyy (+ 4 b)) (izz (+ 4 c)))
          (multiple-value-bind (moments pose) (bullet:principal-axes ixx iyy izz d e f)
            (is (near (+ ixx iyy izz) 1d-9 (reduce #'+ moments)))
            (let ((axes (loop for axis in '((1d0 0d0 0d0) (0d0 1d0 0d0) (0d0 0d0 1d0))
                              collect (multiple-value-list (apply #'geometry:rotate pose axis)))))
              (loop for (x y z) in axes
                    for moment in moments
                    do (is (all-near-p (list (* moment x) (* moment y) (* moment z)) 1d-9
                                       (list (+ (* ixx x) (* d y) (* e z))
                                             (+ (* d x) (* iyy y) (* f z))
                                             (+ (* e x) (* f y) (* izz z)))))))))))
    (multiple-value-bind (moments pose) (bullet:principal-axes 3 1 2 0 0 0)
      (is (equal '(3d0 1d0 2d0) moments))
      (is (geometry:pose= (geometry:identity-pose) pose)))
    ;; with zeros on the diagonal
    (is (equal '(0d0 0d0 4d0) (bullet:principal-axes 0 0 4 0 0 0)))
    (is (all-near-p '(-2d0 0d0 2d0) 1d-12
                    (sort (bullet:principal-axes 0 0 0 0 2 0) #'<)))
    (signals bullet:bullet-error (bullet:principal-axes 1 1 1 0 (nan) 0))))
