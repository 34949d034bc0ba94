;;;; Smooth ways: through many configurations without stopping at each.
;;;;
;;;; The configurations of a way, equally far apart, are joined by a smooth curve, which is run from
;;;; rest to rest at one velocity profile.  So a hand moves in a straight line, or along with a
;;;; drawer, and what it holds feels no jerks in between.

(in-package #:discrepancy-finder.projection)

(defun settle-posture (robot)
  "Let ROBOT know where its joints are after a motion."
  (setf (joint-positions robot) (nth-value 1 (bullet:mechanism-posture (robot-mechanism robot)))))

(defun run-smoothly (projection way &key (watch :all) ignore)
  "Move the joints of PROJECTION's robot through the configurations of WAY, which are equally far
apart, without stopping.  Return NIL, or :CONTACT and the two bodies that would touch."
  (let* ((robot (projection-robot projection))
         (longest (loop for last = (joint-positions robot) then positions
                        for positions in way
                        maximize (longest-way last positions))))
    (unless (or (null way) (zerop longest))
      (let ((fractions (profile-fractions
                        (make-profile (* longest (length way))
                                      (projection-parameter projection :joint-speed)
                                      (projection-parameter projection :joint-acceleration))))
            (watched (watched-bodies projection watch)))
        (multiple-value-bind (done reason body obstacle)
            (foreign:with-c-float-traps
              (bullet:run-motion (robot-mechanism robot)
                                 :steps (length fractions) :fractions fractions
                                 :through (butlast way) :goal (first (last way))
                                 :fidelity (projection-fidelity projection)
                                 :watched watched
                                 :obstacles (and watched
                                                 (remove-if (lambda (body) (member body ignore))
                                                            (solid-bodies projection)))))
          (declare (ignore done))
          (settle-posture robot)
          (and (eq reason :contact)
               (values :contact (list body obstacle))))))))

;;; In parts, for what has to be looked after on the way

(defconstant +steps-a-part+ 24
  "A motion in parts is looked after whenever so many steps are done.")

(defun positions-between (knots part)
  "Return the positions at PART, 0 to 1, of the way through the vector KNOTS, straight in between."
  (let* ((pieces (1- (length knots)))
         (place (* part pieces))
         (piece (max 0 (min (1- pieces) (floor place))))
         (fraction (- place piece)))
    (map '(simple-array double-float (*))
         (lambda (from to) (interpolate from to fraction))
         (aref knots piece) (aref knots (1+ piece)))))

(defun run-in-parts (projection way fractions &key watched obstacles before after)
  "Move the joints of PROJECTION's robot through the configurations of WAY by the vector FRACTIONS
of parts of the way, one for each step.  BEFORE is called before each part of the motion with its
last fraction and the number of its steps, AFTER behind it with its last fraction; a true result of
AFTER ends the motion.  Return NIL if it was done, :CONTACT and two bodies, or what AFTER returned."
  (let* ((robot (projection-robot projection))
         (knots (coerce (cons (copy-seq (joint-positions robot)) way) 'vector))
         (steps (length fractions))
         (first 0d0))
    (loop for done from 0 below steps by +steps-a-part+
          for count = (min +steps-a-part+ (- steps done))
          for last = (aref fractions (+ done count -1))
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
                                      :steps count :fractions local
                                      :goal (positions-between knots last)
                                      :fidelity (projection-fidelity projection)
                                      :watched watched :obstacles obstacles))
               (declare (ignore run))
               (settle-posture robot)
               (when (eq reason :contact)
                 (return (values :contact (list body obstacle)))))
             (let ((result (and after (funcall after last))))
               (when result (return result)))
             (setf first last))))
