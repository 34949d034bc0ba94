;;;; Tests of the Bullet layer: rays against closed forms and against a search by small steps.

(in-package #:discrepancy-finder.tests)

(in-suite bullet)

(defun at (x y z)
  (geometry:make-pose x y z))

(defun hit-of (world from to &rest options)
  "Return name of the body, point, normal and part of the way of the ray FROM TO, as one list."
  (multiple-value-bind (body point normal part)
      (apply #'bullet:cast-ray world (apply #'at from) (apply #'at to) options)
    (and body
         (list (bullet:body-name body)
               (subseq (geometry:pose-components point) 0 3) normal part))))

(defun same-hit-p (expected hit)
  (labels ((same (a b)
             (cond ((realp a) (and (realp b) (near a 1d-12 b)))
                   ((consp a) (and (consp b) (same (first a) (first b)) (same (rest a) (rest b))))
                   (t (eq a b)))))
    (same expected hit)))

(defmacro hits (expected world from to &rest options)
  `(let ((hit (hit-of ,world ,from ,to ,@options)))
     (is (same-hit-p ,expected hit) "~s" hit)))

(test rays-meet-boxes
  (bullet:with-world (world)
    (bullet:add-body world :box '(:box 2 4 6) (at 10 0 0))
    (hits '(:box (9 0 0) (-1 0 0) 1/2) world '(8 0 0) '(10 0 0))
    (hits '(:box (11 1 2) (1 0 0) 9/10) world '(20 1 2) '(10 1 2))
    (hits '(:box (10 2 0) (0 1 0) 8/10) world '(10 10 0) '(10 0 0))
    (hits '(:box (10 0 -3) (0 0 -1) 7/10) world '(10 0 -10) '(10 0 0))
    (hits '(:box (9 1/2 0) (-1 0 0) 1/2) world '(8 0 0) '(10 1 0))
    (hits '(:box (9 0 0) (-1 0 0) 1) world '(8 0 0) '(9 0 0))
    (is (null (hit-of world '(8 0 0) '(8.999 0 0))) "it ends before the box")
    (is (null (hit-of world '(8 0 0) '(0 0 0))) "it goes the other way")
    (is (null (hit-of world '(8 2.001 0) '(12 2.001 0))) "it passes beside the box")
    (hits '(:box (9 2 0) (-1 0 0) 1/4) world '(8 2 0) '(12 2 0))
    (hits '(:box (10 0 0) (-1 0 0) 0) world '(10 0 0) '(20 0 0))
    (hits '(:box (11 0 0) (-1 0 0) 0) world '(11 0 0) '(20 0 0))))

(test rays-meet-a-turned-box
  (bullet:with-world (world)
    (bullet:add-body world :box '(:box 2 2 2) (geometry:make-pose 5 0 0 :yaw (/ pi 4)))
    (let* ((half (sqrt 0.5d0)) (x (+ 5 (- (* 2 half)) 0.1d0)))
      (hits `(:box (,x 0.1d0 0) (,(- half) ,half 0) ,(/ x 5)) world '(0 0.1d0 0) '(5 0.1d0 0)))))

(test rays-meet-spheres
  (bullet:with-world (world)
    (bullet:add-body world :ball '(:sphere 2) (at 0 0 10))
    (hits '(:ball (0 0 8) (0 0 -1) 8/10) world '(0 0 0) '(0 0 10))
    (let ((z (- 10 (sqrt 3d0))))
      (hits `(:ball (1 0 ,z) (1/2 0 ,(- (/ (sqrt 3d0) 2))) ,(/ z 20)) world '(1 0 0) '(1 0 20)))
    (is (null (hit-of world '(2.000001 0 0) '(2.000001 0 20))))
    (hits '(:ball (2 0 10) (1 0 0) 1/2) world '(2 0 0) '(2 0 20))
    (hits '(:ball (0 0 11) (0 0 -1) 0) world '(0 0 11) '(0 0 20))
    (is (null (hit-of world '(0 0 12.1) '(0 0 20))))))

(test rays-meet-cylinders
  (bullet:with-world (world)
    (bullet:add-body world :can '(:cylinder 3 10) (at 0 0 5))
    (hits '(:can (-3 0 1) (-1 0 0) 7/10) world '(-10 0 1) '(0 0 1))
    (hits '(:can (1 1 10) (0 0 1) 1/2) world '(1 1 20) '(1 1 0))
    (hits '(:can (2 0 10) (0 0 1) 1/4) world '(0 0 12) '(8 0 4))
    (is (null (hit-of world '(3.001 0 20) '(3.001 0 0))) "it runs down beside the wall")
    (is (null (hit-of world '(-4 0 9.5) '(-2.9 0 10.7))) "it passes above the rim, which is sharp")
    (hits '(:can (-3 0 9.9d0) (-1 0 0) 1/2) world '(-4 0 9.8) '(-2 0 10))
    (hits '(:can (0 0 5) (0 -1 0) 0) world '(0 0 5) '(0 9 5))))

(test rays-meet-planes-and-compounds
  (bullet:with-world (world)
    (add-floor world)
    (bullet:add-body world :pair `(:compound (,(at -1 0 0) (:sphere 1/2))
                                             (,(geometry:make-pose 1 0 0 :pitch (/ pi 2))
                                              (:cylinder 1/2 1)))
                     (at 0 0 5))
    (hits '(:floor (3 4 0) (0 0 1) 1/2) world '(3 4 1) '(3 4 -1))
    (hits '(:floor (0 0 -1) (0 0 -1) 0) world '(0 0 -1) '(0 0 1))
    (is (null (hit-of world '(0 0 1) '(9 0 1))))
    (hits '(:pair (-1.5d0 0 5) (-1 0 0) 0.85d0) world '(-10 0 5) '(0 0 5))
    (hits '(:pair (0.5d0 0 5) (-1 0 0) 1/4) world '(0 0 5) '(2 0 5))
    (hits '(:pair (1 0 5.5d0) (0 0 1) 0.45d0) world '(1 0 10) '(1 0 0))))

(test the-first-body-on-the-way-is-hit
  (bullet:with-world (world)
    (let ((bodies (loop for i from 0 below 5
                        collect (bullet:add-body world i (if (evenp i) '(:sphere 1) '(:box 2 2 2))
                                                 (at (* 10 (mod (* 2 i) 5)) 0 0)))))
      (loop for passed on (sort (copy-list bodies) #'<
                                :key (lambda (body) (geometry:pose-x (bullet:body-pose body))))
            for x from 0 by 10
            do (is (eq (first passed)
                       (bullet:cast-ray world (at -5 0 0) (at 100 0 0)
                                        :passed (set-difference bodies passed)))))
      (is (null (bullet:cast-ray world (at -5 0 0) (at 100 0 0) :passed bodies))))
    (bullet:add-body world :twin '(:sphere 1) (at 0 0 0))
    (is (eql 0 (first (hit-of world '(-5 0 0) '(0 0 0)))) "of equal ones the first")))

(test rays-see-bodies-where-they-are
  "Also such as have been moved since the last step."
  (bullet:with-world (world)
    (let ((link (bullet:add-body world :link '(:sphere 1) (at 0 0 0) :kind :kinematic)))
      (bullet:step-world world)
      (bullet:move-body link (at 0 50 0))
      (hits '(:link (-1 50 0) (-1 0 0) 9/10) world '(-10 50 0) '(0 50 0))
      (is (null (hit-of world '(-10 0 0) '(0 0 0))))
      (bullet:place-body link (at 0 0 0))
      (hits '(:link (-1 0 0) (-1 0 0) 9/10) world '(-10 0 0) '(0 0 0)))))

;;; Brute force

(defun random-numbers (seed)
  "Return a function of no arguments that returns numbers from -1 to 1, always the same ones."
  (lambda ()
    (setf seed (ldb (byte 48 0) (+ (* 25214903917 seed) 11)))
    (- (/ (ash seed -16) (expt 2d0 31)) 1)))

(defun inside-shape-p (shape x y z grown)
  "Return true if the point is in SHAPE, GROWN on all sides, by the definition of the shape."
  (ecase (first shape)
    (:box (every (lambda (size number) (<= (abs number) (+ (/ size 2) grown)))
                 (rest shape) (list x y z)))
    (:sphere (<= (sqrt (+ (* x x) (* y y) (* z z))) (+ (second shape) grown)))
    (:cylinder (and (<= (sqrt (+ (* x x) (* y y))) (+ (second shape) grown))
                    (<= (abs z) (+ (/ (third shape) 2) grown))))
    (:compound (loop for (pose part) in (rest shape)
                       thereis (inside-placed-p part pose x y z grown)))))

(defun inside-placed-p (shape pose x y z grown)
  (let ((point (geometry:compose (geometry:inverse pose)
                                 (geometry:quaternion-pose x y z 0d0 0d0 0d0 1d0))))
    (inside-shape-p shape (geometry:pose-x point) (geometry:pose-y point) (geometry:pose-z point)
                    grown)))

(defun on-ray (ray part)
  (loop for i below 3
        collect (+ (nth i ray) (* part (- (nth (+ 3 i) ray) (nth i ray))))))

(defun inside-world-p (world ray part &optional (grown 0))
  "Return true if the point at PART of the way of RAY is inside of a body of WORLD."
  (loop for body in (bullet:world-bodies world)
          thereis (destructuring-bind (x y z) (on-ray ray part)
                    (inside-placed-p (bullet:body-shape body) (bullet:body-pose body) x y z
                                     grown))))

(defun searched-part (world ray steps)
  "Return the first part of the way of RAY that is inside of a body of WORLD, or NIL if none of
STEPS places on it is."
  (loop for step from 0 to steps
        when (inside-world-p world ray (/ step steps 1d0))
          return (if (zerop step)
                     0d0
                     (let ((out (/ (1- step) steps 1d0)) (in (/ step steps 1d0)))
                       (loop repeat 60
                             for middle = (/ (+ out in) 2)
                             do (if (inside-world-p world ray middle)
                                    (setf in middle)
                                    (setf out middle)))
                       in))))

(defun random-world (world next)
  (flet ((size () (+ 0.6d0 (/ (funcall next) 2)))
         (place () (geometry:make-pose (* 3 (funcall next)) (* 3 (funcall next))
                                       (* 3 (funcall next)) :roll (* 3 (funcall next))
                                       :pitch (funcall next) :yaw (* 3 (funcall next)))))
    (dotimes (i 3)
      (bullet:add-body world (list :box i) (list :box (size) (size) (size)) (place))
      (bullet:add-body world (list :sphere i) (list :sphere (size)) (place))
      (bullet:add-body world (list :cylinder i) (list :cylinder (size) (size)) (place)))
    (bullet:add-body world :compound
                     (list :compound (list (at 1 0 0) (list :box (size) (size) (size)))
                           (list (geometry:make-pose -1 0 0 :roll 1) (list :cylinder (size) 1d0)))
                     (place))))

(test rays-agree-with-a-search-by-small-steps
  (let ((next (random-numbers 7)) (found 0) (missed 0))
    (dotimes (i 6)
      (bullet:with-world (world)
        (random-world world next)
        (let* ((rays (loop repeat 40
                           collect (loop repeat 6 collect (* 4 (funcall next)))))
               (vector (coerce (reduce #'append rays) '(simple-array double-float (*)))))
          (multiple-value-bind (bodies hits) (bullet:cast-rays world vector)
            (loop for ray in rays
                  for body across bodies
                  for at from 6 by 7
                  for part = (and body (aref hits at))
                  for searched = (searched-part world ray 400)
                  do (cond (searched
                            (incf found)
                            (is-true part)
                            (is (<= part (+ searched 1d-9)))
                            (is-true (or (near searched 1d-9 part)
                                         ;; A corner between two places of the search.
                                         (and (< part searched)
                                              (inside-world-p world ray part 1d-9)))))
                           (part
                            (is-true (inside-world-p world ray part 1d-9)))
                           (t (incf missed)))
                     (when (and part (> part 1d-6))
                       (is-false (inside-world-p world ray (- part 1d-6)))))))))
    (is (> found 40))
    (is (> missed 30))))

(test many-rays-are-the-same-as-single-ones
  (bullet:with-world (world)
    (let ((next (random-numbers 11)))
      (random-world world next)
      (let ((vector (make-array (* 6 25000) :element-type 'double-float)))
        (map-into vector (lambda () (* 4 (funcall next))))
        (let ((hash (bullet:state-hash world)))
          (multiple-value-bind (bodies hits) (bullet:cast-rays world vector)
            (is (= 25000 (length bodies)))
            (is (= (* 7 25000) (length hits)))
            (loop for i in '(0 1 9999 10000 10001 19999 20000 24999)
                  for (from to) = (loop for start in (list (* 6 i) (+ (* 6 i) 3))
                                        collect (coerce (subseq vector start (+ start 3)) 'list))
                  for (name point normal part) = (hit-of world from to)
                  do (is (equal name (and (aref bodies i) (bullet:body-name (aref bodies i)))))
                     (when name
                       (is (equal (append point normal (list part))
                                  (coerce (subseq hits (* 7 i) (* 7 (1+ i))) 'list)))))
            (multiple-value-bind (again again-hits) (bullet:cast-rays world vector)
              (is (equalp bodies again))
              (is (equalp hits again-hits) "the same bits")))
          (is (= hash (bullet:state-hash world))))))))

(test normals-have-unit-length-and-point-against-the-ray
  (bullet:with-world (world)
    (let ((next (random-numbers 5)))
      (random-world world next)
      (loop repeat 300
            for from = (loop repeat 3 collect (* 5 (funcall next)))
            for to = (loop repeat 3 collect (* 5 (funcall next)))
            for (name nil normal) = (hit-of world from to)
            when name
              do (is (near 1 1d-9 (reduce #'+ (mapcar #'* normal normal))))
                 (is (<= (reduce #'+ (mapcar #'* normal (mapcar #'- to from))) 1d-9))))))

(test impossible-rays-are-refused
  (bullet:with-world (world)
    (bullet:with-world (other)
      (let ((ball (bullet:add-body world :ball '(:sphere 1) (at 0 0 0)))
            (stranger (bullet:add-body other :stranger '(:sphere 1) (at 0 0 0)))
            (infinity sb-ext:double-float-positive-infinity)
            (reason "cast-ray failed: the ray is not from one finite position to another."))
        (refuses reason (bullet:cast-ray world (at 0 0 5) (at 0 0 5)))
        (refuses reason (bullet:cast-ray world (at 0 0 5) (at 0 0 5.0000000001d0)))
        (dolist (number (list (nan) infinity (- infinity) 1d10))
          (let ((pose (geometry:quaternion-pose 0d0 number 0d0 0d0 0d0 0d0 1d0)))
            (refuses reason (bullet:cast-ray world (at 0 0 5) pose))
            (refuses reason (bullet:cast-ray world pose (at 0 0 5)))
            (refuses "cast-rays failed: a ray is not from one finite position to another."
                     (bullet:cast-rays world (coerce (list 0d0 0d0 5d0 0d0 0d0 0d0
                                                           0d0 0d0 5d0 0d0 0d0 number)
                                                     '(simple-array double-float (*)))))))
        (refuses "cast-rays failed: the vector has 7 elements, but must have six for each ray."
                 (bullet:cast-rays world (make-array 7 :element-type 'double-float)))
        (refuses "cast-ray failed: body STRANGER is no body of this world."
                 (bullet:cast-ray world (at 0 0 5) (at 0 0 0) :passed (list ball stranger)))
        (is (equalp (list #() #())
                    (multiple-value-list
                     (bullet:cast-rays world (make-array 0 :element-type 'double-float)))))
        (is (eq ball (bullet:cast-ray world (at 0 0 5) (at 0 0 0)))))
      (bullet:close-world world)
      (refuses "cast-ray failed: the world is closed."
               (bullet:cast-ray world (at 0 0 5) (at 0 0 0)))
      (refuses "cast-rays failed: the world is closed."
               (bullet:cast-rays world (make-array 6 :element-type 'double-float))))))

(test rays-leave-no-memory-behind
  (bullet:with-world (world)
    (random-world world (random-numbers 3))
    (let ((vector (make-array (* 6 1000) :element-type 'double-float))
          (next (random-numbers 4)))
      (map-into vector (lambda () (* 4 (funcall next))))
      (flet ((cast (count)
               (loop repeat count do (bullet:cast-rays world vector))
               (sb-ext:gc :full t)))
        (cast 50)
        (let ((before (resident-megabytes)))
          (cast (if *long* 5000 300))
          (is (< (- (resident-megabytes) before) 30)))))))
