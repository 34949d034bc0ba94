;;;; Rays: which body a straight line meets first.  None changes a later bit.
;;;;
;;;; CAST-RAY is for one ray, CAST-RAYS for many.  Shapes are exact, edges of cylinders included.  A
;;;; body in which a ray begins is hit at once, with a normal against the ray; what is only touched
;;;; is hit; of two bodies hit at the same place it is the one that was added first.

(in-package #:discrepancy-finder.bullet)

(defconstant +rays-a-call+ 10000
  "An interrupt has to wait for the end of a foreign call, so that no call may take long.")

(defun cast-ray (world from to &key passed)
  "Return the first body of WORLD on the straight way from the position of the pose FROM to that of
the pose TO, and as further values where that is: a pose at the point, upright; the outward normal
of the surface, a list of three numbers; the part, 0 to 1, of the way.  Return NIL if there is none.
PASSED is a list of bodies that the ray passes through.  Signals BULLET-ERROR if the positions are
not finite, or not 1e-9 m apart, or a body is of another world."
  (check-type from geometry:pose)
  (check-type to geometry:pose)
  (let ((ids (body-ids world passed 'cast-ray))
        (body (make-array 1 :element-type '(signed-byte 32)))
        (hit (make-array 7 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (ids-pointer ids)
      (cffi:with-pointer-to-vector-data (body-pointer body)
        (cffi:with-pointer-to-vector-data (hit-pointer hit)
          (invoke ('cast-ray pointer world)
              (%cast-ray pointer (geometry:pose-x from) (geometry:pose-y from)
                         (geometry:pose-z from) (geometry:pose-x to) (geometry:pose-y to)
                         (geometry:pose-z to) (length ids) ids-pointer body-pointer hit-pointer)
            (:bad-number "the ray is not from one finite position to another")
            (:nothing (return-from cast-ray nil))))))
    (values (aref (world-body-vector world) (aref body 0))
            (geometry:quaternion-pose (aref hit 0) (aref hit 1) (aref hit 2) 0d0 0d0 0d0 1d0)
            (list (aref hit 3) (aref hit 4) (aref hit 5))
            (aref hit 6))))

(defun cast-rays (world rays &key passed)
  "Cast many rays in WORLD, 10000 in one foreign call.  RAYS is a vector of double floats, six for
each: where it begins and where it ends (m).  Return a vector with the first body on each, or NIL,
and a vector of double floats, seven for each: point (m), outward normal, part of the way; zeros
where there is no body.  PASSED is a list of bodies that the rays pass through.  Signals
BULLET-ERROR if an end is not finite, a ray shorter than 1e-9 m, or a body of another world."
  (declare (type (simple-array double-float (*)) rays))
  (multiple-value-bind (count rest) (floor (length rays) 6)
    (unless (zerop rest)
      (fail 'cast-rays "the vector has ~d elements, but must have six for each ray" (length rays)))
    (live-pointer world 'cast-rays)
    (let ((ids (body-ids world passed 'cast-rays))
          (numbers (make-array count :element-type '(signed-byte 32)))
          (hits (make-array (* 7 count) :element-type 'double-float))
          (bodies (world-body-vector world)))
      (cffi:with-pointer-to-vector-data (ids-pointer ids)
        (cffi:with-pointer-to-vector-data (rays-pointer rays)
          (cffi:with-pointer-to-vector-data (numbers-pointer numbers)
            (cffi:with-pointer-to-vector-data (hits-pointer hits)
              (loop for start from 0 below count by +rays-a-call+
                    do (invoke ('cast-rays pointer world)
                           (%cast-rays pointer (min +rays-a-call+ (- count start))
                                       (cffi:inc-pointer rays-pointer (* 8 6 start))
                                       (length ids) ids-pointer
                                       (cffi:inc-pointer numbers-pointer (* 4 start))
                                       (cffi:inc-pointer hits-pointer (* 8 7 start)))
                         (:bad-number
                          "a ray is not from one finite position to another")))))))
      (values (map 'simple-vector (lambda (number) (and (>= number 0) (aref bodies number)))
                   numbers)
              hits))))
