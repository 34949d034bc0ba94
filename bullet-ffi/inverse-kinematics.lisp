;;;; Inverse kinematics: which positions of some joints take a tool to a pose.
;;;;
;;;; Damped least squares with joint limits, in the shim (kinematics.inc).  The first attempt begins
;;;; at START, the next ones at random positions; the generator is the solver's own and begins anew
;;;; at each call, so that equal calls have equal results.

(in-package #:discrepancy-finder.bullet)

(define-raw %inverse-kinematics "dfb_inverse_kinematics" :int
  (world :pointer) (mechanism :int) (link :int) (base :pointer) (tool :pointer) (target :pointer)
  (joint-count :int) (joints :pointer) (start :pointer) (position-only :int)
  (attempts :int) (first-attempt :int) (tolerance :double) (most :int)
  (solutions :pointer) (error :pointer))

(defun joint-indices (mechanism joints)
  "Return the sequence JOINTS of indices as a vector for the shim."
  (check-length joints 'inverse-kinematics)
  (let ((indices (make-array (length joints) :element-type '(signed-byte 32)))
        (count (length (mechanism-links mechanism))))
    (map-into indices
              (lambda (joint)
                (unless (and (typep joint 'fixnum) (< -1 joint count))
                  (fail 'inverse-kinematics "~s is no index of a joint of ~a" joint mechanism))
                joint)
              joints)))

(defun solve-for-target (mechanism base link tool target joints start position-only attempts
                         first-attempt tolerance most)
  "Return a vector with up to MOST solutions one after the other, how many there are, and the error
in m and in rad."
  (let ((numbers (make-array 23 :element-type 'double-float))
        (solutions (make-array (* most (length (mechanism-links mechanism)))
                               :element-type 'double-float)))
    (declare (type positions start))
    (write-pose base numbers)
    (write-pose tool numbers 7)
    (write-pose target numbers 14)
    (values
     solutions
     (cffi:with-pointer-to-vector-data (numbers-pointer numbers)
       (cffi:with-pointer-to-vector-data (joints-pointer joints)
         (cffi:with-pointer-to-vector-data (start-pointer start)
           (cffi:with-pointer-to-vector-data (solutions-pointer solutions)
             (invoke ('inverse-kinematics pointer (mechanism-world mechanism))
                 (%inverse-kinematics pointer (mechanism-id mechanism) link numbers-pointer
                                      (cffi:inc-pointer numbers-pointer 56)
                                      (cffi:inc-pointer numbers-pointer 112)
                                      (length joints) joints-pointer start-pointer
                                      (if position-only 1 0) attempts first-attempt tolerance
                                      most solutions-pointer
                                      (cffi:inc-pointer numbers-pointer 168))
               (:too-small "more than 32 joints vary")
               (:bad-number
                "a pose is not finite, or a position, or the tolerance is not positive"))))))
     (aref numbers 21)
     (aref numbers 22))))

(defun inverse-kinematics (mechanism &key (base (geometry:identity-pose)) link
                                       (tool (geometry:identity-pose)) target joints start
                                       position-only (restarts 20) (tolerance 1d-4) (attempt 0)
                                       count)
  "Return positions for all joints of MECHANISM that take TOOL, a pose in the frame of the link with
the index LINK, to the pose TARGET when the base is at the pose BASE: a copy of the positions START
in which the joints with the indices JOINTS, a sequence, are changed, each within its limits.  Or
return NIL if RESTARTS attempts after the first one find none.  The second and the third value are
how far TOOL is from TARGET then, or came to it at best: m and rad, together at most TOLERANCE.
With POSITION-ONLY the orientation is free.

The first attempt begins at START, and so tends to a solution near to it; with another ATTEMPT than
0, a natural number, it begins elsewhere.  With COUNT, return instead a list of up to COUNT
solutions, any two of which differ by 0.1 (rad or m) in a joint.  Signals BULLET-ERROR if an index
is none or a number not finite."
  (check-positions mechanism start 'inverse-kinematics)
  (unless (and (geometry:pose-p base) (geometry:pose-p tool) (geometry:pose-p target))
    (fail 'inverse-kinematics "the base, the tool and the target must be poses"))
  (let ((size (length (mechanism-links mechanism)))
        (indices (joint-indices mechanism joints))
        (restarts (if (typep restarts '(integer 0 10000)) restarts
                      (fail 'inverse-kinematics "~s is no number of restarts" restarts)))
        (attempt (if (typep attempt '(integer 0 10000)) attempt
                     (fail 'inverse-kinematics "~s is no number of an attempt" attempt)))
        (most (if (typep (or count 1) '(integer 1 1000)) (or count 1)
                  (fail 'inverse-kinematics "~s is no number of solutions" count))))
    (unless (and (typep link 'fixnum) (< -1 link size))
      (fail 'inverse-kinematics "~s is no index of a link of ~a" link mechanism))
    (multiple-value-bind (solutions found distance angle)
        (solve-for-target mechanism base link tool target indices start position-only
                          (1+ restarts) (* attempt (1+ restarts))
                          (number-of "the tolerance" tolerance 'inverse-kinematics :positive)
                          most)
      (flet ((solution (i)
               (subseq solutions (* i size) (* (1+ i) size))))
        (values (if count
                    (loop for i below found collect (solution i))
                    (and (plusp found) (solution 0)))
                distance angle)))))
