;;;; Smooth ways: through many configurations without stopping at each.
;;;;
;;;; The configurations of a way are joined by a smooth curve (of Catmull and Rom), which is run from
;;;; rest to rest at one velocity profile.  So a hand moves in a straight line, or along with a
;;;; drawer, and what it holds feels no jerks in between.

(in-package #:discrepancy-finder.projection)

(defconstant +steps-a-chunk+ 8
  "Between points of the curve that are so many steps apart, joints move straight.")

(defun curve-point (knots piece fraction)
  "Return the positions at FRACTION of the PIECE, a number, of the smooth curve through the vector
KNOTS."
  (let* ((last (1- (length knots)))
         (p0 (aref knots (max 0 (1- piece)))) (p1 (aref knots piece))
         (p2 (aref knots (1+ piece))) (p3 (aref knots (min last (+ piece 2))))
         (f fraction) (f2 (* f f)) (f3 (* f2 f)))
    (map '(simple-array double-float (*))
         (lambda (a b c d)
           (declare (double-float a b c d))
           (* 0.5d0 (+ (* 2 b) (* (- c a) f) (* (+ (* 2 a) (* -5 b) (* 4 c) (- d)) f2)
                       (* (+ (- a) (* 3 b) (* -3 c) d) f3))))
         p0 p1 p2 p3)))

(defun curve-function (knots lengths)
  "Return a function that returns the positions on the curve through KNOTS at a part, 0 to 1, of its
length; LENGTHS are those of its pieces."
  (let ((total (reduce #'+ lengths)))
    (lambda (part)
      (let ((rest (* part total)))
        (loop for length in lengths
              for piece from 0
              for last = (= piece (1- (length lengths)))
              do (when (or last (<= rest length))
                   (return (curve-point knots piece
                                        (if (zerop length) 1d0 (min 1d0 (/ rest length))))))
                 (decf rest length))))))

(defun run-curve (projection curve fractions &key watched obstacles before after)
  "Move the joints of PROJECTION's robot along CURVE, a function that returns positions at a part of
the way, by the vector FRACTIONS of parts, one for each step.  BEFORE is called before each chunk
with its last fraction and the number of its steps, AFTER behind it with its last fraction; a true
result of AFTER ends the motion.  Return NIL if it was done, :CONTACT and two bodies, or what AFTER
returned."
  (let ((robot (projection-robot projection)) (steps (length fractions)) (first 0d0))
    (loop for done from 0 below steps by +steps-a-chunk+
          for count = (min +steps-a-chunk+ (- steps done))
          for last = (aref fractions (+ done count -1))
          for start = (copy-seq (joint-positions robot))
          for goal = (funcall curve last)
          for local = (make-array count :element-type 'double-float)
          do (dotimes (index count)
               (setf (aref local index)
                     (if (> last first)
                         (/ (- (aref fractions (+ done index)) first) (- last first))
                         1d0)))
             (when before (funcall before last count))
             (multiple-value-bind (run reason body obstacle)
                 (foreign:with-c-float-traps
                   (bullet:run-motion (robot-mechanism robot)
                                      :steps count :fractions local :start start :goal goal
                                      :fidelity (projection-fidelity projection)
                                      :watched watched :obstacles obstacles))
               (when (plusp run)
                 (setf (joint-positions robot)
                       (map '(simple-array double-float (*))
                            (lambda (from to) (interpolate from to (aref local (1- run))))
                            start goal)))
               (when (eq reason :contact)
                 (return (values :contact (list body obstacle)))))
             (let ((result (and after (funcall after last))))
               (when result (return result)))
             (setf first last))))

(defun run-smoothly (projection way &key (watch :all) ignore)
  "Move the joints of PROJECTION's robot through the configurations of WAY without stopping.  Return
NIL, or :CONTACT and the two bodies that would touch."
  (let* ((knots (coerce (cons (copy-seq (joint-positions (projection-robot projection))) way)
                        'vector))
         (lengths (loop for index from 1 below (length knots)
                        collect (longest-way (aref knots (1- index)) (aref knots index))))
         (total (reduce #'+ lengths))
         (watched (watched-bodies projection watch)))
    (unless (zerop total)
      (run-curve projection (curve-function knots lengths)
                 (profile-fractions
                  (make-profile total (projection-parameter projection :joint-speed)
                                (projection-parameter projection :joint-acceleration)))
                 :watched watched
                 :obstacles (and watched
                                 (remove-if (lambda (body) (member body ignore))
                                            (solid-bodies projection)))))))
