;;;; Queries: states of whole worlds, rest, penetrations.  None changes a later bit.
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

(defun body-ids (world bodies operation)
  "Return the ids of the list BODIES, which must be of WORLD, as a vector for the shim."
  (check-length bodies operation)
  (let ((ids (make-array (length bodies) :element-type '(signed-byte 32))))
    (loop for body in bodies
          for i from 0
          do (unless (and (body-p body) (eq (body-world body) world))
               (fail operation "~:[~a~;body ~a~] is no body of this world" (body-p body)
                     (if (body-p body) (body-name body) body)))
             (setf (aref ids i) (body-id body)))
    ids))

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
