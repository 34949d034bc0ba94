;;;; Sweeps: what a convex shape touches first on its way.  None changes a later bit.

(in-package #:discrepancy-finder.bullet)

(define-raw %sweep "dfb_sweep" :int
  (world :pointer) (shape :pointer) (from :pointer) (to :pointer)
  (passed-count :int) (passed :pointer) (body :pointer) (hit :pointer))

(defun pose-vector (pose)
  (coerce (geometry:pose-components pose) '(simple-array double-float (7))))

(defun sweep (world shape from to &key passed)
  "Move SHAPE, a box, sphere, cylinder or hull, in WORLD straight from the pose FROM to the pose TO,
turning evenly.  Return the first body that it touches, which part, 0 to 1, of the way it goes until
then, an upright pose where it touches, and the outward normal of the body there, a list of three
numbers; or NIL if there is none.  A body that the shape is in at first is touched at once, with a
normal against the way.  PASSED is a list of bodies that do not
count.  Signals BULLET-ERROR if SHAPE is another one or malformed, the positions are not finite or
not 1e-9 m apart, or a body is of another world."
  (check-type from geometry:pose)
  (check-type to geometry:pose)
  (live-pointer world 'sweep)
  (when (and (consp shape) (member (first shape) '(:plane :compound)))
    (fail 'sweep "the shape ~s is not convex and finite" shape))
  (let ((ids (body-ids world passed 'sweep))
        (start (pose-vector from))
        (goal (pose-vector to))
        (body (make-array 1 :element-type '(signed-byte 32)))
        (hit (make-array 7 :element-type 'double-float)))
    (with-shape (shape-pointer shape '("the sweep"))
      (cffi:with-pointer-to-vector-data (ids-pointer ids)
        (cffi:with-pointer-to-vector-data (start-pointer start)
          (cffi:with-pointer-to-vector-data (goal-pointer goal)
            (cffi:with-pointer-to-vector-data (body-pointer body)
              (cffi:with-pointer-to-vector-data (hit-pointer hit)
                (invoke ('sweep pointer world)
                    (%sweep pointer shape-pointer start-pointer goal-pointer (length ids)
                            ids-pointer body-pointer hit-pointer)
                  (:bad-number "the sweep is not from one finite pose to another one elsewhere")
                  (:nothing (return-from sweep nil)))))))))
    (values (aref (world-body-vector world) (aref body 0))
            (aref hit 6)
            (geometry:quaternion-pose (aref hit 0) (aref hit 1) (aref hit 2) 0d0 0d0 0d0 1d0)
            (list (aref hit 3) (aref hit 4) (aref hit 5)))))
