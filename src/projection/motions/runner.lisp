;;;; The motion runner: motions of the robot in the world.
;;;;
;;;; A motion of the base, of joints, or of both, is worked out for all of its steps; one call of
;;;; the Bullet layer then runs it, looks for contact, and checks the grips.  In the fidelity :FAST
;;;; it steps the world only while something can depend on it.  RUN-JOINTS and RUN-PATH move joints,
;;;; RUN-MOTION is what all motions end in.  They return NIL if the motion was done; else :CONTACT
;;;; and the list of the two bodies that would touch, and the robot stands where it stopped before.
;;;;
;;;; What must not touch anything is said by WATCH: :ALL links and held items; :LINKS, the links
;;;; only; :ALLOW-HAND, all but hands and held items; :NONE or :ALLOW-ALL, nothing; or a list of
;;;; bodies.

(in-package #:discrepancy-finder.projection)

(defun held-bodies (projection)
  "Return the bodies of the items that the robot of PROJECTION holds."
  (loop for (nil . item) in (held-items projection) collect (find-item projection item)))

(defun watched-bodies (projection watch)
  "Return the list of the bodies that must not touch anything by WATCH."
  (let ((robot (projection-robot projection)))
    (case watch
      (:all (append (link-bodies robot) (held-bodies projection)))
      (:links (link-bodies robot))
      (:allow-hand (set-difference (link-bodies robot)
                                   (loop for arm in (robot-arm-names robot)
                                         append (hand-bodies robot arm))))
      ((:none :allow-all) '())
      (t watch))))

(defun driven-over-p (projection solid)
  "Return true if the robot of PROJECTION drives over SOLID: if it is lower than a step."
  (and (solid-pieces solid)
       (<= (solid-top solid) (projection-parameter projection :step-height))))

(defun solid-fixtures (projection)
  "Return the list of the bodies of fixtures of PROJECTION that the robot does not drive over."
  (loop for solid in (projection-solids projection)
        unless (driven-over-p projection solid) collect (solid-body solid)))

(defun solid-bodies (projection)
  "Return the list of the bodies of PROJECTION that the robot must not touch: the fixtures, but for
what is so low that it drives over it, and the items that it does not hold."
  (let ((held (held-bodies projection)))
    (append (solid-fixtures projection)
            (loop for (nil . body) in (projection-items projection)
                  unless (member body held) collect body))))

(defun note-motion (robot done steps bases fractions goal)
  "Let ROBOT stand where it does after DONE of the STEPS of a motion."
  (unless (zerop done)
    (when bases
      (setf (base-pose robot)
            (let ((start (* 7 (1- done))))
              (quaternion-pose (aref bases start) (aref bases (+ start 1)) (aref bases (+ start 2))
                               (aref bases (+ start 3)) (aref bases (+ start 4))
                               (aref bases (+ start 5)) (aref bases (+ start 6))))))
    (when goal
      (setf (joint-positions robot)
            (if (= done steps)
                (copy-seq goal)
                (map 'doubles (lambda (from to) (interpolate from to (aref fractions (1- done))))
                     (joint-positions robot) goal))))))

(defun run-motion (projection steps &key bases fractions goal (watch :all) ignore)
  "Run a motion of a number of STEPS of PROJECTION's robot: the base goes through BASES, a vector of
seven numbers for each step, and the joints through the FRACTIONS, a vector of one number for each
step, of the way from where they are to the positions GOAL.  IGNORE is a list of bodies that may be
touched.  Return NIL, or :CONTACT and a list of two bodies."
  (let ((robot (projection-robot projection)))
    (multiple-value-bind (done reason body obstacle)
        (foreign:with-c-float-traps
          (let ((watched (watched-bodies projection watch)))
            (bullet:run-motion (robot-mechanism robot)
                               :steps steps :bases bases :fractions fractions
                               :start (joint-positions robot) :goal goal
                               :fidelity (projection-fidelity projection)
                               :watched watched
                               :obstacles (and watched
                                               (set-difference (solid-bodies projection)
                                                               ignore)))))
      (extend-trail projection bases done)
      (note-motion robot done steps bases fractions goal)
      (if (eq reason :contact)
          (values :contact (list body obstacle))
          nil))))

(defun contact-text (bodies)
  "Return a clause that says that the two BODIES touch."
  (format nil "~{~a touches ~a~}" (mapcar #'bullet:body-name bodies)))

;;; Joints

(defun longest-way (start goal)
  "Return the largest difference (m or rad) of the positions START and GOAL of a joint."
  (declare (type doubles start goal))
  (loop for from across start for to across goal maximize (abs (- to from))))

(defun run-to (projection goal &key speed acceleration (watch :all) ignore)
  "Move the joints of PROJECTION's robot to the positions GOAL, a vector, all at once: the one that
has the longest way sets the profile with SPEED and ACCELERATION, by default those of the scene."
  (let ((length (longest-way (joint-positions (projection-robot projection)) goal)))
    (unless (zerop length)
      (let ((fractions (profile-fractions
                        (make-profile length
                                      (or speed (projection-parameter projection :joint-speed))
                                      (or acceleration
                                          (projection-parameter projection
                                                                :joint-acceleration))))))
        (run-motion projection (length fractions)
                    :fractions fractions :goal goal :watch watch :ignore ignore)))))

(defun with-mimics (robot positions)
  "Return the vector POSITIONS with the joints that follow others where these have them."
  (loop for frame across (robot-frames robot)
        for number from 0
        for joint = (link-frame-joint frame)
        do (when (and joint (urdf-joint-mimic joint))
             (destructuring-bind (name multiplier offset) (urdf-joint-mimic joint)
               (setf (aref positions number)
                     (+ offset (* multiplier (aref positions (frame-number robot name))))))))
  positions)

(defun run-joints (projection goals &key speed acceleration (watch :all) ignore)
  "Move the joints in GOALS, a list of (role or name . position), of PROJECTION's robot to their
positions (m or rad), all at once."
  (let* ((robot (projection-robot projection))
         (goal (copy-seq (joint-positions robot))))
    (loop for (joint . position) in goals
          do (setf (aref goal (frame-number robot joint)) (float position 1d0)))
    (run-to projection (with-mimics robot goal)
            :speed speed :acceleration acceleration :watch watch :ignore ignore)))

(defun run-path (projection configurations &key speed acceleration (watch :all) ignore)
  "Move the joints of PROJECTION's robot through CONFIGURATIONS, a list of vectors of positions, one
after the other."
  (dolist (configuration configurations nil)
    (multiple-value-bind (reason bodies)
        (run-to projection configuration
                :speed speed :acceleration acceleration :watch watch :ignore ignore)
      (when reason
        (return (values reason bodies))))))

(defun move-joints (projection roles goals)
  "Move the joints with ROLES of PROJECTION's robot to GOALS (m or rad), all at once, whatever they
touch."
  (run-joints projection (mapcar #'cons roles goals) :watch :none))

;;; Time

(defun pass-time (projection steps)
  "Let PROJECTION run for a number of STEPS while the robot stands still."
  (unless (zerop steps)
    (if (projection-robot projection)
        (run-motion projection steps :watch :none)
        (foreign:with-c-float-traps
          (bullet:step-world (projection-world projection) steps)))))

(defun settle (projection &key (limit 2))
  "Let PROJECTION run until everything in it rests, for LIMIT seconds at the most.  Return true if
it rests."
  (let ((world (projection-world projection)))
    (foreign:with-c-float-traps
      (loop repeat (ceiling limit +time-step+)
            until (bullet:at-rest-p world)
            do (bullet:step-world world))
      (bullet:at-rest-p world))))
