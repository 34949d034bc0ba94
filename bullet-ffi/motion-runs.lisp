;;;; Motions of mechanisms: many steps in few foreign calls.
;;;;
;;;; RUN-MOTION takes the base of a mechanism along given poses, and its joints straight from some
;;;; positions to others.  In both fidelities it looks for contacts of WATCHED bodies with
;;;; OBSTACLES, and stops before one; what is attached to a link goes with it, and is lost when its
;;;; grip is overloaded.
;;;;
;;;; :FULL   each step moves the bodies of the links and steps the world.
;;;; :FAST   steps are skipped while all loose dynamic bodies sleep, or have been at rest for 0.1 s
;;;;         (then they are put to sleep), and nothing that moves comes within 2 mm of one, nor a
;;;;         held body within 2 mm of anything but the mechanism itself.  In skipped steps held
;;;;         bodies move, and load their grips, by the equations that Bullet's constraint comes to.
;;;;         From the step in which something is lost, or comes close, the world is stepped until
;;;;         all rests again.

(in-package #:discrepancy-finder.bullet)

(define-raw %motion-begin "dfb_motion_begin" :int
  (world :pointer) (mechanism :int) (start :pointer) (goal :pointer)
  (via-count :int) (via :pointer) (base-moves :int) (fast :int)
  (contact-distance :double) (watched-count :int) (watched :pointer)
  (obstacle-count :int) (obstacles :pointer))
(define-raw %motion-continue "dfb_motion_continue" :int
  (world :pointer) (mechanism :int) (count :int) (bases :pointer) (fractions :pointer)
  (bodies :pointer))

(defmacro with-optional-vector ((pointer vector) &body body)
  "Evaluate BODY with POINTER bound to the data of VECTOR, or to the null pointer if it is NIL."
  (let ((function (gensym "FUNCTION")) (data (gensym "DATA")))
    `(flet ((,function (,pointer) ,@body))
       (declare (dynamic-extent #',function))
       (let ((,data ,vector))
         (if ,data
             (cffi:with-pointer-to-vector-data (,pointer (the positions ,data))
               (,function ,pointer))
             (,function (cffi:null-pointer)))))))

(defun begin-motion (mechanism start through goal base-moves fidelity contact-distance watched
                     obstacles)
  (let ((world (mechanism-world mechanism))
        (via (and through (apply #'concatenate 'positions through))))
    (cffi:with-pointer-to-vector-data (watched-pointer watched)
      (cffi:with-pointer-to-vector-data (obstacles-pointer obstacles)
        (with-optional-vector (start-pointer start)
          (with-optional-vector (goal-pointer goal)
            (with-optional-vector (via-pointer via)
              (invoke ('run-motion pointer world)
                  (%motion-begin pointer (mechanism-id mechanism) start-pointer goal-pointer
                                 (length through) via-pointer (if base-moves 1 0)
                                 (if (eq fidelity :fast) 1 0) contact-distance
                                 (length watched) watched-pointer
                                 (length obstacles) obstacles-pointer)
                (:bad-number
                 "a position of the start, the goal or in between is not finite")))))))))

(defun bad-motion ()
  (fail 'run-motion "a base is not a finite pose or a fraction is not finite"))

(defun continue-motion (mechanism steps bases fractions)
  "Do the STEPS of the motion that was begun; return how many were done and the bodies of the
contact, if any."
  (let ((world (mechanism-world mechanism))
        (ids (make-array 2 :element-type '(signed-byte 32) :initial-element -1))
        (done 0))
    (declare (type fixnum done steps))
    (cffi:with-pointer-to-vector-data (ids-pointer ids)
      (with-optional-vector (bases-pointer bases)
        (with-optional-vector (fractions-pointer fractions)
          (loop for count of-type fixnum = (min (- steps done) +steps-a-call+)
                until (zerop count)
                do (incf done
                         (invoke ('run-motion pointer world)
                             (let ((taken (%motion-continue
                                           pointer (mechanism-id mechanism) count
                                           (if bases
                                               (cffi:inc-pointer bases-pointer (* 56 done))
                                               bases-pointer)
                                           (if fractions
                                               (cffi:inc-pointer fractions-pointer (* 8 done))
                                               fractions-pointer)
                                           ids-pointer)))
                               (when (> taken 0) (incf (world-steps world) taken))
                               taken)
                           (:bad-number (bad-motion))))
                while (= -1 (aref ids 0))))))
    (flet ((body (index)
             (let ((id (aref ids index)))
               (and (>= id 0) (aref (world-body-vector world) id)))))
      (values done (body 0) (body 1)))))

(defun check-steps (vector size steps thing)
  (declare (type fixnum size steps))
  (unless (or (null vector)
              (and (typep vector 'positions) (>= (length vector) (* size steps))))
    (fail 'run-motion "the ~a are no vector of ~d double floats for each of ~d steps"
          thing size steps))
  ;; The shim looks at these numbers, too, but only when the motion has begun.
  (when vector
    (loop for i of-type fixnum below (* size steps)
          unless (in-range-p (aref (the positions vector) i) :finite)
            do (bad-motion))
    (when (= size 7)
      (dotimes (i steps)
        (unless (<= (abs (- 1 (loop for j from 3 below 7
                                    sum (expt (aref (the positions vector) (+ (* 7 i) j)) 2)
                                      of-type double-float)))
                    1d-6)
          (bad-motion))))))

(defun run-motion (mechanism &key steps bases fractions start through goal (fidelity :fast)
                               watched obstacles (contact-distance 0))
  "Move MECHANISM for a number of STEPS.  BASES has the pose of its base after each step, seven
double floats each (see POSE-COMPONENTS), or is NIL if the base stays; FRACTIONS the part of the
straight way of all joints from the positions START to GOAL, one double float each, or is NIL if the
joints stay.  START is by default where they are; joints that are not at START are put there first.
With THROUGH, a list of vectors of positions, the joints take a smooth curve through these, each
piece of which is the same part of the way.

WATCHED and OBSTACLES are lists of bodies.  A step in which a watched body (of a link, or attached
to one) would come as near as CONTACT-DISTANCE (m) to an obstacle is not done, and ends the motion:
the two are still apart then.  Two that were within 1 mm of that at the start may pass along each
other, up to 1 mm nearer than CONTACT-DISTANCE or 0.5 mm nearer than at the start.  Pairs that
ignore their collision do not count.

Return how many steps were done; :DONE or :CONTACT; and the watched body and the obstacle of the
contact.  FIDELITY is :FULL or :FAST, see the top of the file.  Signals BULLET-ERROR if a number is
not finite, a vector too short or a body of another world."
  (unless (typep steps '(integer 0 100000000))
    (fail 'run-motion "~s is no number of steps" steps))
  (unless (member fidelity '(:full :fast))
    (fail 'run-motion "the fidelity ~s is neither :full nor :fast" fidelity))
  (check-steps bases 7 steps "bases")
  (check-steps fractions 1 steps "fractions")
  (when start (check-positions mechanism start 'run-motion))
  (when goal (check-positions mechanism goal 'run-motion))
  (check-length through 'run-motion)
  (dolist (positions through)
    (check-positions mechanism positions 'run-motion))
  (let ((world (mechanism-world mechanism)))
    (begin-motion mechanism start through goal (not (null bases)) fidelity
                  (number-of "the contact distance" contact-distance 'run-motion :not-negative)
                  (body-ids world watched 'run-motion)
                  (body-ids world obstacles 'run-motion))
    (multiple-value-bind (done body obstacle) (continue-motion mechanism steps bases fractions)
      (values done (if body :contact :done) body obstacle))))
