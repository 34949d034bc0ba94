;;;; Queries: states of whole worlds, rest, penetrations, rays.  None changes a later bit.
;;;;
;;;; A state vector has thirteen double floats for each body, in the order in which the bodies were
;;;; added: position (m), quaternion x y z w, linear velocity (m/s), angular velocity (rad/s).

(in-package #:discrepancy-finder.bullet)

(defun make-state-vector (world)
  "Return a vector that READ-STATE can fill: thirteen double floats for each body of WORLD."
  (make-array (* 13 (length (world-body-vector world))) :element-type 'double-float))

(defun read-state (world vector)
  "Fill VECTOR, a state vector, with the states of all bodies of WORLD, in one foreign call; return
it.  Signals BULLET-ERROR if it is too short or WORLD is closed."
  (declare (optimize speed (safety 1)) (type (simple-array double-float (*)) vector))
  (let ((length (min (length vector) (1- (expt 2 31)))))
    (cffi:with-pointer-to-vector-data (states vector)
      (invoke ('read-state pointer world) (%state-read pointer states length)
        (:too-small (format nil "the vector has ~d elements for ~d bodies of 13 each"
                            length (length (world-body-vector world)))))))
  vector)

(defun state-hash (world)
  "Return the 64-bit FNV-1a hash of the bits of the state vector of WORLD, an integer.  Signals
BULLET-ERROR if WORLD is closed."
  (let ((hash (make-array 1 :element-type '(unsigned-byte 64))))
    (cffi:with-pointer-to-vector-data (hash-pointer hash)
      (invoke ('state-hash pointer world) (%state-hash pointer hash-pointer)))
    (aref hash 0)))

(defun at-rest-p (world)
  "Return true if each dynamic body of WORLD that is not attached sleeps, or was slower than 1 mm/s
and 0.01 rad/s after each of the last 10 steps.  Signals BULLET-ERROR if WORLD is closed."
  (= 1 (invoke ('at-rest-p pointer world) (%at-rest pointer))))

(defun penetration (a b)
  "Return how deep (m) the bodies A and B penetrate each other, 0 when they are apart, whether
or not they sleep or ignore their collision.  Signals BULLET-ERROR if they are not two
bodies of one world."
  (let ((world (same-world a b 'penetration))
        (depth (make-array 1 :element-type 'double-float)))
    (cffi:with-pointer-to-vector-data (depth-pointer depth)
      (invoke ('penetration pointer world)
          (%penetration pointer (body-id a) (body-id b) depth-pointer)))
    (aref depth 0)))

(defun deepest-penetration (world)
  "Return the depth (m) of the deepest penetration in WORLD and the two bodies, or 0 and twice NIL.
Pairs without a dynamic body, attached pairs and those that ignore their collision do not count.
Signals BULLET-ERROR if WORLD is closed."
  (let ((depth (make-array 1 :element-type 'double-float))
        (ids (make-array 2 :element-type '(signed-byte 32))))
    (cffi:with-pointer-to-vector-data (depth-pointer depth)
      (cffi:with-pointer-to-vector-data (a ids)
        (let ((b (cffi:inc-pointer a 4)))
          (invoke ('deepest-penetration pointer world)
              (%deepest-penetration pointer depth-pointer a b)
            (:nothing (return-from deepest-penetration (values 0d0 nil nil)))))))
    (flet ((body (index) (aref (world-body-vector world) (aref ids index))))
      (values (aref depth 0) (body 0) (body 1)))))

(defun point-numbers (point)
  "Return the three coordinates of POINT, a list of reals."
  (if (and (eql (ignore-errors (list-length point)) 3) (every #'realp point))
      (destructuring-bind (x y z) point
        (flet ((coordinate (value) (number-of "a coordinate of the ray" value 'cast-ray)))
          (values (coordinate x) (coordinate y) (coordinate z))))
      (fail 'cast-ray "the point ~s is no list of three numbers" point)))

(defun cast-ray (world from to)
  "Return the first body of WORLD on the segment between the points FROM and TO, which are lists of
three reals (m), and as further values the point where the segment enters it and the fraction of
the segment there; or NIL.  A body that holds FROM inside is not seen.  Signals BULLET-ERROR if a
coordinate is not finite, the segment has no length or WORLD is closed."
  (let ((hit (make-array 4 :element-type 'double-float)))
    (declare (dynamic-extent hit))
    (multiple-value-bind (fx fy fz) (point-numbers from)
      (declare (double-float fx fy fz))
      (multiple-value-bind (tx ty tz) (point-numbers to)
        (declare (double-float tx ty tz))
        (let ((id (cffi:with-pointer-to-vector-data (hit-pointer hit)
                    (invoke ('cast-ray pointer world)
                        (%ray pointer fx fy fz tx ty tz hit-pointer)
                      (:bad-number (format nil "the ray from ~s to ~s has no length" from to))
                      (:nothing (return-from cast-ray nil))))))
          (values (aref (world-body-vector world) id)
                  (list (aref hit 1) (aref hit 2) (aref hit 3))
                  (aref hit 0)))))))
