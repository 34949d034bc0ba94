;;;; Smooth ways: through many configurations without stopping at each.
;;;;
;;;; The configurations of a way are joined by a smooth curve, whose slope at a configuration is
;;;; that of the parabola through it and its neighbours, and which is run from rest to rest at one
;;;; velocity profile.  So a hand moves in a straight line, or along with a
;;;; drawer, and what it holds feels no jerks in between.

(in-package #:discrepancy-finder.projection)

(defconstant +steps-a-chunk+ 8
  "Between points of the curve that are so many steps apart, joints move straight.")

(defun knot-slope (knots lengths number)
  "Return the slope of the curve at the knot NUMBER: how much of each position per unit of length."
  (flet ((chord (piece)
           (map 'vector (lambda (from to) (/ (- to from) (aref lengths piece)))
                (aref knots piece) (aref knots (1+ piece)))))
    (cond ((= number 0) (chord 0))
          ((= number (length lengths)) (chord (1- number)))
          (t (let* ((before (aref lengths (1- number))) (after (aref lengths number))
                    (part (/ after (+ before after))))
               (map 'vector (lambda (a b) (+ (* part a) (* (- 1 part) b)))
                    (chord (1- number)) (chord number)))))))

(defun curve-point (knots slopes piece length fraction)
  "Return the positions at FRACTION of the PIECE, a number, of the smooth curve through the vector
KNOTS with the vector SLOPES; LENGTH is that of the piece."
  (let* ((f fraction) (f2 (* f f)) (f3 (* f2 f)))
    (map '(simple-array double-float (*))
         (lambda (from to start end)
           (declare (double-float from to start end))
           (+ (* from (+ 1 (* -3 f2) (* 2 f3)))
              (* to (- (* 3 f2) (* 2 f3)))
              (* length (+ (* start (+ f (* -2 f2) f3))
                           (* end (- f3 f2))))))
         (aref knots piece) (aref knots (1+ piece))
         (aref slopes piece) (aref slopes (1+ piece)))))

(defun curve-function (knots lengths)
  "Return a function that returns the positions on the curve through KNOTS at a part, 0 to 1, of its
length; LENGTHS is the vector of those of its pieces, none 0."
  (let ((total (reduce #'+ lengths))
        (slopes (coerce (loop for number to (length lengths)
                              collect (knot-slope knots lengths number))
                        'vector)))
    (lambda (part)
      (let ((rest (* part total)))
        (loop for length across lengths
              for piece from 0
              do (when (or (= piece (1- (length lengths))) (<= rest length))
                   (return (curve-point knots slopes piece length (min 1d0 (/ rest length)))))
                 (decf rest length))))))

(defun distinct-knots (configurations)
  "Return the vector of CONFIGURATIONS without those that are as good as the one before."
  (let ((knots '()))
    (dolist (configuration configurations)
      (unless (and knots (< (longest-way (first knots) configuration) 1d-9))
        (push configuration knots)))
    (coerce (nreverse knots) 'vector)))

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
  (let* ((knots (distinct-knots (cons (copy-seq (joint-positions (projection-robot projection)))
                                      way)))
         (lengths (coerce (loop for index from 1 below (length knots)
                                collect (longest-way (aref knots (1- index)) (aref knots index)))
                          'vector))
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
