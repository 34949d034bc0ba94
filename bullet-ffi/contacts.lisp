;;;; Distances between bodies, and who touches whom.  None changes a later bit.

(in-package #:discrepancy-finder.bullet)

(define-raw %pair-distance "dfb_pair_distance" :int
  (world :pointer) (a :int) (b :int) (limit :double) (distance :pointer))

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
