;;;; Distances between bodies, and who touches whom.  None changes a later bit.

(in-package #:discrepancy-finder.bullet)

(define-raw %pair-distance "dfb_pair_distance" :int
  (world :pointer) (a :int) (b :int) (limit :double) (distance :pointer))

(define-raw %contacts "dfb_contacts" :int
  (world :pointer) (body :int) (distance :double) (passed-count :int) (passed :pointer)
  (others :pointer) (numbers :pointer))
(define-raw %clearance "dfb_clearance" :int
  (world :pointer) (count :int) (bodies :pointer) (other-count :int) (others :pointer)
  (limit :double) (distance :pointer) (a :pointer) (b :pointer))

(defun pair-distance (a b limit)
  "Return the smallest distance (m) of the bodies A and B, or LIMIT if they are farther apart; minus
the depth if they penetrate each other.  Signals BULLET-ERROR if they are not two bodies of one
world."
  (let ((world (same-world a b 'pair-distance))
        (limit (number-of "the limit" limit 'pair-distance))
        (distance (make-array 1 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (distance-pointer distance)
      (invoke ('pair-distance pointer world)
          (%pair-distance pointer (body-id a) (body-id b) limit distance-pointer)))
    (aref distance 0)))

(defun touching-p (a b &key (distance 0))
  "Return true if the bodies A and B are not farther than DISTANCE (m) from each other.  Bodies that
rest on each other may be some micrometres apart.  Signals BULLET-ERROR if they are not two bodies
of one world."
  (let ((distance (number-of "the distance" distance 'touching-p)))
    (<= (pair-distance a b (+ distance 1d-3)) distance)))

(defun contacts (body &key (distance 0) passed)
  "Return a list, in the order in which the bodies were added, of a list (other depth point) for
each other body that is not farther than DISTANCE (m) from BODY: DEPTH is how deep it penetrates
(m), negative minus the distance, POINT an upright pose in the midst.  The bodies of the list PASSED
do not count.  Signals BULLET-ERROR if a body is of another world."
  (let* ((world (body-world body))
         (bodies (world-body-vector world))
         (distance (number-of "the distance" distance 'contacts))
         (passed-ids (body-ids world passed 'contacts))
         (others (make-array (length bodies) :element-type '(signed-byte 32)))
         (numbers (make-array (* 4 (length bodies)) :element-type 'double-float))
         (count 0))
    (cffi:with-pointer-to-vector-data (passed-pointer passed-ids)
      (cffi:with-pointer-to-vector-data (others-pointer others)
        (cffi:with-pointer-to-vector-data (numbers-pointer numbers)
          (setf count
                (invoke ('contacts pointer world)
                    (%contacts pointer (body-id body) distance (length passed-ids)
                               passed-pointer others-pointer numbers-pointer))))))
    (loop for i below count
          for (depth x y z) = (coerce (subseq numbers (* 4 i) (* 4 (1+ i))) 'list)
          collect (list (aref bodies (aref others i)) depth
                        (geometry:quaternion-pose x y z 0d0 0d0 0d0 1d0)))))

(defun clearance (bodies others limit)
  "Return the smallest distance (m) between one of BODIES and one of OTHERS, lists of bodies of one
world, and these two bodies; it is minus the depth of the deepest two if any penetrate each other.
Return LIMIT, NIL and NIL if none are nearer than LIMIT.  Signals BULLET-ERROR if a body is of
another world."
  (let ((limit (number-of "the limit" limit 'clearance)))
    (if (or (null bodies) (null others))
        (values limit nil nil)
        (let* ((world (body-world (first bodies)))
               (ids (body-ids world bodies 'clearance))
               (other-ids (body-ids world others 'clearance))
               (distance (make-array 1 :element-type 'double-float))
               (pair (make-array 2 :element-type '(signed-byte 32))))
          (cffi:with-pointer-to-vector-data (ids-pointer ids)
            (cffi:with-pointer-to-vector-data (others-pointer other-ids)
              (cffi:with-pointer-to-vector-data (distance-pointer distance)
                (cffi:with-pointer-to-vector-data (a pair)
                  (let ((b (cffi:inc-pointer a 4)))
                    (invoke ('clearance pointer world)
                        (%clearance pointer (length ids) ids-pointer (length other-ids)
                                    others-pointer limit distance-pointer a b)
                      (:nothing (return-from clearance (values limit nil nil)))))))))
          (flet ((body (index) (aref (world-body-vector world) (aref pair index))))
            (values (aref distance 0) (body 0) (body 1)))))))
