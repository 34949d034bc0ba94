;;;; Shapes.
;;;;
;;;; A shape is data, a list; its origin is the centre of mass of its body (lengths in m):
;;;;
;;;;   (:box x y z)                  full extents
;;;;   (:sphere r)
;;;;   (:cylinder r h)               along z
;;;;   (:plane nx ny nz d)           all points p with n.p <= d, n a unit vector; static bodies only
;;;;   (:compound (pose shape) ...)  a union of boxes, spheres and cylinders
;;;;
;;;; MAKE-SHAPE makes the foreign shape, SHAPE-INERTIA the principal moments of inertia.  Bullet's
;;;; own moments are those of the bounding box for cylinders and compounds, a third too much for a
;;;; rolling cup.

(in-package #:discrepancy-finder.bullet)

(defun malformed-shape (shape owner)
  (fail 'add-body "the shape ~s of ~a is malformed; it should be ~a" shape owner
        (case (if (consp shape) (first shape) shape)
          (:box "(:box x y z) with positive lengths")
          (:sphere "(:sphere radius) with a positive radius")
          (:cylinder "(:cylinder radius height) with positive lengths")
          (:plane "(:plane nx ny nz d) with a unit vector n")
          (:compound "(:compound (pose shape)...) of boxes, spheres and cylinders")
          (t "a list that begins with :box, :sphere, :cylinder, :plane or :compound"))))

(defun shape-numbers (shape owner count)
  "Return the COUNT numbers of SHAPE as a list of double floats."
  (unless (and (eql (ignore-errors (list-length shape)) (1+ count))
               (every #'realp (rest shape)))
    (malformed-shape shape owner))
  (loop for number in (rest shape)
        collect (number-of (format nil "a number of the shape ~s of ~a" shape owner)
                           number 'add-body)))

(defun make-shape (world shape owner)
  "Return the id in WORLD of a new foreign shape made of the list SHAPE.  OWNER is the body's name
for messages.  Signals BULLET-ERROR if SHAPE is malformed."
  (flet ((numbers (count) (shape-numbers shape owner count)))
    (macrolet ((make (call)
                 `(invoke ('add-body pointer world) ,call
                    ((:bad-number :bad-shape) (malformed-shape shape owner)))))
      (case (and (consp shape) (first shape))
        (:box (destructuring-bind (x y z) (numbers 3)
                (make (%shape-box pointer x y z))))
        (:sphere (destructuring-bind (radius) (numbers 1)
                   (make (%shape-sphere pointer radius))))
        (:cylinder (destructuring-bind (radius height) (numbers 2)
                     (make (%shape-cylinder pointer radius height))))
        (:plane (destructuring-bind (nx ny nz d) (numbers 4)
                  (make (%shape-plane pointer nx ny nz d))))
        (:compound (make-compound world shape owner))
        (t (malformed-shape shape owner))))))

(defun compound-parts (shape owner)
  "Return the list of the (pose shape) of the compound SHAPE."
  (flet ((part-p (part)
           (and (eql (ignore-errors (list-length part)) 2)
                (geometry:pose-p (first part))
                (consp (second part))
                (member (first (second part)) '(:box :sphere :cylinder)))))
    (unless (and (ignore-errors (list-length shape)) (rest shape) (every #'part-p (rest shape)))
      (malformed-shape shape owner))
    (rest shape)))

(defun make-compound (world shape owner)
  (let* ((parts (compound-parts shape owner))
         (count (length parts))
         (children (make-array count :element-type '(signed-byte 32)))
         (poses (make-array (* 7 count) :element-type 'double-float)))
    (loop for (pose part) in parts
          for i from 0
          do (setf (aref children i) (make-shape world part owner))
             (replace poses (geometry:pose-components pose) :start1 (* 7 i)))
    (cffi:with-pointer-to-vector-data (children-pointer children)
      (cffi:with-pointer-to-vector-data (poses-pointer poses)
        (invoke ('add-body pointer world)
            (%shape-compound pointer count children-pointer poses-pointer)
          (:bad-number
           (format nil "a pose in the compound shape of ~a is not a finite position with a unit ~
                        quaternion" owner)))))))

;;; Inertia

(defun shape-volume (shape)
  (destructuring-bind (kind . numbers) shape
    (ecase kind
      (:box (reduce #'* numbers))
      (:sphere (* 4/3 pi (expt (first numbers) 3)))
      (:cylinder (* pi (expt (first numbers) 2) (second numbers))))))

(defun turned-moments (pose moments)
  "Return the diagonal of the inertia tensor, in the frame of POSE's parent, of a body at the origin
of POSE whose principal MOMENTS are along the axes of POSE."
  (let ((diagonal (list 0d0 0d0 0d0)))
    (loop for moment in moments
          for axis in '((1d0 0d0 0d0) (0d0 1d0 0d0) (0d0 0d0 1d0))
          for tip = (geometry:compose
                     pose (apply #'geometry:make-pose axis))
          for turned = (list (- (geometry:pose-x tip) (geometry:pose-x pose))
                             (- (geometry:pose-y tip) (geometry:pose-y pose))
                             (- (geometry:pose-z tip) (geometry:pose-z pose)))
          do (setf diagonal (mapcar (lambda (sum r) (+ sum (* r r moment))) diagonal turned)))
    diagonal))

(defun compound-inertia (parts mass)
  "Return the diagonal of the inertia tensor, about the origin, of PARTS of equal density, which
overlap nowhere.  The products of inertia are left out."
  (let ((volume (loop for (nil part) in parts sum (shape-volume part)))
        (diagonal (list 0d0 0d0 0d0)))
    (loop for (pose part) in parts
          for share = (* mass (/ (shape-volume part) volume))
          for (x2 y2 z2) = (list (expt (geometry:pose-x pose) 2) (expt (geometry:pose-y pose) 2)
                                 (expt (geometry:pose-z pose) 2))
          do (setf diagonal (mapcar #'+ diagonal
                                    (turned-moments pose (shape-inertia part share))
                                    (list (* share (+ y2 z2)) (* share (+ x2 z2))
                                          (* share (+ x2 y2))))))
    diagonal))

(defun shape-inertia (shape mass)
  "Return the list of the three principal moments of inertia (kg m^2) of a body with a well-formed
SHAPE, which is no plane, and MASS (kg), evenly spread."
  (destructuring-bind (kind . numbers) shape
    (flet ((square (x) (* x x)))
      (mapcar
       (lambda (moment) (float moment 1d0))
       (ecase kind
         (:box (destructuring-bind (x y z) (mapcar #'square numbers)
                 (list (/ (* mass (+ y z)) 12) (/ (* mass (+ x z)) 12) (/ (* mass (+ x y)) 12))))
         (:sphere (let ((moment (* 2/5 mass (square (first numbers)))))
                    (list moment moment moment)))
         (:cylinder (destructuring-bind (r2 h2) (mapcar #'square numbers)
                      (let ((across (/ (* mass (+ (* 3 r2) h2)) 12)))
                        (list across across (/ (* mass r2) 2)))))
         (:compound (compound-inertia numbers mass)))))))
