;;;; The convex hull of many points, as of a mesh, by few.

(in-package #:discrepancy-finder.bullet)

(define-raw %convex-hull "dfb_convex_hull" :int
  (count :int) (points :pointer) (most :int) (corners :pointer))

(defun convex-hull (points &key (vertices 40))
  "Return a list of at most VERTICES (4 to 40) of POINTS, a sequence of lists (x y z), whose convex
hull leaves as little as possible of that of all POINTS out: what (:hull ...) can be made of.
Signals BULLET-ERROR if POINTS are fewer than four, all in one plane, or not finite."
  (unless (typep vertices '(integer 4 40))
    (fail 'convex-hull "the number of vertices is ~s, but must be 4 to 40" vertices))
  (let ((numbers (point-numbers points 'convex-hull))
        (corners (make-array (* 3 vertices) :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (points-pointer numbers)
      (cffi:with-pointer-to-vector-data (corners-pointer corners)
        (let ((count (%convex-hull (length points) points-pointer vertices corners-pointer)))
          (declare (type (signed-byte 32) count))
          (when (minusp count)
            (fail 'convex-hull "~a" (if (eq (status-name count) :no-memory)
                                        "the memory is used up"
                                        "the points are fewer than four or all in one plane")))
          (loop for i below count
                collect (coerce (subseq corners (* 3 i) (+ 3 (* 3 i))) 'list)))))))
